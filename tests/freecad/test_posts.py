"""Whole CAM jobs through FreeCAD's post mechanism."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_posts_are_listed_and_cost_no_start(bare_session: Any) -> None:
    seen = bare_session["started"]
    assert not seen["early"], "starting FreeCAD must not import CAM"
    assert {"styluscam_linuxcnc", "styluscam_grbl"} <= set(seen["posts"])


def test_two_tools_are_changed_in_order(session: Any, linuxcnc: Any) -> None:
    text = session["two tools"]["post"]["text"]
    assert [line for line in text.splitlines() if "M6" in line] == ["T1 M6", "T2 M6"]
    assert "judged from this text" in text
    linuxcnc(text)


def test_operations_of_two_sheets_are_no_program(session: Any) -> None:
    assert "differ in SheetThickness" in session["two tools"]["differ"]["refused"]


def test_a_straight_native_operation_is_posted_and_stated_not_to_be_verified(session: Any, linuxcnc: Any) -> None:
    text = session["native straight"]["post"]["text"]
    assert "not judged" in text
    assert "X1 Y2" in text
    linuxcnc(text)


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("native arc", ["G2 X1 Y1 I1 J0 F600"]),
        ("native cycle", ["G98 G81 X0 Y0 Z-1 R2 F300", "X5 Y0", "G80", "M10"]),
        ("native probe", ["G38.2 Z-5 F120"]),
    ],
)
def test_native_commands_are_posted_as_they_are(session: Any, name: str, lines: list[str]) -> None:
    text = session[name]["post"]["text"].splitlines()
    assert "not judged" in "\n".join(text)
    assert [line for line in text if line in lines] == lines


def test_a_fourth_axis_is_refused_and_its_operation_named(session: Any) -> None:
    refused = session["native axis"]["post"]["refused"]
    assert refused.startswith("Own lines: line") and "no such word" in refused


def test_work_offsets_go_to_files_of_their_own(session: Any, linuxcnc: Any) -> None:
    seen = session["two fixtures"]
    assert "several work offsets in one program cannot be verified" in seen["together"]["refused"]
    assert sorted(seen["apart"]) == ["G54", "G55"]
    for offset, text in seen["apart"].items():
        assert offset in text.splitlines()
        assert "T1 M6" in text.splitlines()
        linuxcnc(text)


def moves_of(text: str, linuxcnc: Any) -> list[Any]:
    """Traverses, feeds and arcs as LinuxCNC's interpreter makes them, without those that go nowhere."""
    out: list[Any] = []
    at = None
    for call in linuxcnc(text).calls:
        if call.kind not in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"):
            continue
        point = (call.x, call.y, call.z)
        if call.kind == "ARC_FEED" or point != at:
            out.append((call.kind, point))
        at = point
    return out


def test_a_native_job_moves_as_by_freecads_own_post(session: Any, linuxcnc: Any) -> None:
    texts = session["native job"]["texts"]
    ours, theirs = moves_of(texts["ours"], linuxcnc), moves_of(texts["theirs"], linuxcnc)
    assert [kind for kind, _ in ours] == [kind for kind, _ in theirs]
    assert len(ours) > 1000 and sum(kind == "ARC_FEED" for kind, _ in ours) > 10
    # each is rounded to three decimals; halves go up here and to the even digit there
    farthest = max(
        abs(a - b) for (_, one), (_, other) in zip(ours, theirs, strict=True) for a, b in zip(one, other, strict=True)
    )
    assert farthest < 0.00101
    for code in ("G81", "G82", "G83"):
        assert any(code in line.split() for line in texts["ours"].splitlines()), code


def test_a_machine_file_of_the_user_is_a_post(session: Any) -> None:
    native = session["native job"]["texts"]
    shop, fanuc = (native[name].splitlines() for name in ("shop", "fanuc"))
    assert shop[-2:] == ["M2", "%"] and fanuc[-2:] == ["M30", "%"]
    moves = [line for line in fanuc if line[:1] in "GXYZ"]
    assert len(moves) > 500 and [line for line in shop if line[:1] in "GXYZ"] == moves


def test_arguments_of_the_post(session: Any, linuxcnc: Any) -> None:
    texts = session["native job"]["texts"]
    lines = texts["arguments"].splitlines()
    assert all(line.startswith("N") for line in lines), lines[:3]
    assert "G20" in lines[0]
    assert any(len(word.partition(".")[2]) == 5 for line in lines for word in line.split() if word[0] in "XYZ")
    linuxcnc(texts["arguments"])
    assert "does not know the argument --no-heder; it knows --inches" in texts["unknown argument"]


def positions(text: str, machine: str) -> Any:
    return sc.read_gcode(text, sc.Machine.shipped(machine)).positions


@pytest.mark.parametrize("machine", sc.Machine.names())
def test_a_job_of_native_operations_and_ours_is_posted(mixed_job: Any, machine: str) -> None:
    """Each machine gets all of it in one text, or refuses two tools in one program and gets a text for each."""
    seen = mixed_job
    assert seen["operations"] == ["ObjectPocket", *["ObjectDrilling"] * 3, "ObjectStylus"]
    expected = positions(seen["texts"]["linuxcnc"], "linuxcnc")
    texts = [seen["texts"][machine]]
    if machine in seen["apart"]:
        assert "this machine takes one tool per program: post one program per tool" in texts[0]
        texts = seen["apart"][machine]
        assert len(texts) > 1
    found = np.concatenate([positions(text, machine) for text in texts])
    assert len(found) > 200
    for extreme in (np.min, np.max):
        assert extreme(found, axis=0) == pytest.approx(extreme(expected, axis=0), abs=0.003)


def test_holes_are_drilled_by_cycles_where_a_machine_has_them(mixed_job: Any) -> None:
    """And by moves elsewhere: three kinds of holes, twice each, to the same depths."""
    texts = mixed_job["texts"]
    for code in ("G81", "G82", "G83"):
        assert code in texts["linuxcnc"] and code not in texts["fluidnc"]
    depths = [positions(texts[machine], machine)[:, 2] for machine in ("linuxcnc", "fluidnc")]
    lowest = [np.count_nonzero(np.isclose(depth, depth.min())) for depth in depths]
    assert lowest[0] == lowest[1] > 0


@pytest.mark.parametrize("machine", ["grbl", "fanuc", "heidenhain", "siemens", "okuma", "marlin"])
def test_native_jobs_read_back_on_other_machines(session: Any, machine: str) -> None:
    text = session["native job"]["texts"][machine]
    program = sc.read_gcode(text, sc.Machine.shipped(machine))
    expected = sc.read_gcode(session["native job"]["texts"]["ours"], sc.Machine.shipped("linuxcnc"))
    for axis in range(3):
        for extreme in (min, max):
            found = extreme(program.positions[:, axis])
            assert abs(found - extreme(expected.positions[:, axis])) < 0.003
