"""Holes that are bored along helices: each to its own depth and diameter, on every machine, and checked in the posted text."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

import rs274
import styluscam as sc
from meridian import FIXTURES

THROUGH = -0.5
"""Where a flat tool's tip is below the plate's lower face, which is at Z0, mm."""
BOTTOMS = {
    (8.0, 8.0): THROUGH,
    (52.0, 8.0): THROUGH,
    (8.0, 32.0): THROUGH,
    (52.0, 32.0): THROUGH,
    (20.0, 20.0): 4.0,
    (20.0, 32.0): 3.0,
    (30.0, 20.0): 4.0,
}
"""Of the holes of 5 mm by their axes: where the tip of a flat tool ends."""
HOLE = ["Face10"]
"""A blind hole of 5 mm."""
ROUNDED = 0.0015
"""What posted ends and centres may be off, mm."""


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


def job(machine: str = "linuxcnc", tool: float = 4.0, faces: Any = "all", profile: Any = None, **keys: Any) -> sc.Job:
    profile = profile or {"kind": "flat", "diameter": tool}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / "drilled.step"), "faces": faces},
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "clearance": 30.0, "retract": 14.0},
            "machine": {"name": machine},
            "tools": {"mill": {"number": 1, "length": 60.0, "profile": profile}},
            "operations": [
                {
                    "kind": "helix-bore",
                    "tool": "mill",
                    "pitch": 0.5,
                    "feeds": {"cut": 600.0, "plunge": 200.0},
                    "spindle": {"mode": "fixed", "rpm": 8000.0},
                    **keys,
                }
            ],
        }
    )


def text_of(asked: sc.Job, machine: str = "linuxcnc") -> str:
    return sc.post(sc.plan(asked), machine).text


def kinds(text: str, asked: sc.Job) -> set[str]:
    return {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]}


def bored(text: str, machine: str = "linuxcnc") -> dict[tuple[float, float], tuple[float, float, float]]:
    """By the holes' axes: the lowest tip, and the smallest and largest radius of the path at it, from the posted text."""
    found: dict[tuple[float, float], tuple[float, float, float]] = {}
    moves = sc.read_gcode(text, machine).moves
    for (x, y, z), centre in zip(moves["end"], moves["centre"], strict=True):
        if not np.isnan(centre[0]):
            at = (round(float(centre[0]), 2), round(float(centre[1]), 2))
            radius = math.hypot(x - centre[0], y - centre[1])
            lowest, least, most = found.get(at, (math.inf, math.inf, 0.0))
            found[at] = (min(lowest, float(z)), min(least, radius), max(most, radius))
    return found


@pytest.fixture(scope="module")
def text() -> str:
    return text_of(job(diameter=5.0))


def test_each_hole_is_bored_to_its_own_depth_and_diameter(text: str) -> None:
    found = bored(text)
    assert found.keys() == BOTTOMS.keys()
    for at, (lowest, least, most) in found.items():
        assert lowest == BOTTOMS[at]
        assert 0.5 - ROUNDED <= least <= most <= 0.5
    assert kinds(text, job(diameter=5.0)) == set()


def test_a_turn_falls_by_the_pitch_at_most_and_the_last_is_level(text: str) -> None:
    blind = text.split("X20.499 Y20\n", 1)[1].split("G0", 1)[0]
    heights = [float(z) for z in re.findall(r"Z(\S+)", blind)]
    assert heights == [13.0 - 0.5 * turn for turn in range(19)]
    assert re.search(r"Z4 I-0\.499 J0\nX20\.499 Y20 I-0\.499 J0\nG1 X20\n$", blind)
    uneven = job(pitch=0.6, max_ramp_deg=12.0, diameter=5.0)
    falls = text_of(uneven).split("X20.499 Y20\n", 1)[1].split("G0", 1)[0]
    heights = [float(z) for z in re.findall(r"Z(\S+)", falls)]
    assert len(heights) == 16 and np.allclose(np.diff(heights), -0.6)
    assert kinds(text_of(uneven), uneven) == set()


@pytest.mark.parametrize(
    ("keys", "feed"),
    [({}, 600.0 * 0.499 / 2.499), ({"feed_at": "axis"}, 600.0), ({"radial_stock_to_leave": 0.2}, 600 * 0.299 / 2.299)],
)
def test_the_feed_is_that_of_the_rim_unless_stated(keys: dict[str, Any], feed: float) -> None:
    asked = job(diameter=5.0, pitch=0.2, **keys)
    found = text_of(asked)
    posted = {float(word) for word in re.findall(r"F(\S+)", found)}
    assert len(posted) == 1
    assert posted.pop() == pytest.approx(feed, rel=2e-3)
    assert kinds(found, asked) == set()
    other = "axis" if not keys.get("feed_at") else "rim"
    assert kinds(found, job(diameter=5.0, pitch=0.2, **{**keys, "feed_at": other})) == {"feed-differs"}


MACHINES = sorted(file.stem for file in (FIXTURES.parent / "rust" / "post" / "machines").glob("*.toml"))


@pytest.mark.parametrize("machine", MACHINES)
def test_every_machine_posts_it_with_arcs_or_lines_and_its_text_is_found_sound(machine: str) -> None:
    asked = job(machine, faces=HOLE)
    found = text_of(asked, machine)
    assert kinds(found, asked) == set()
    circles = len(re.findall(r"\bI\S+ J|^\d* ?C [XY]", found, re.MULTILINE))
    # with rotary axes all is lines, and a control without helices has the level turn alone
    expected = {"fanuc-five-axis": [0], "linuxcnc-trunnion": [0], "heidenhain": [1, 2]}
    assert circles in expected.get(machine, range(19, 100))


def test_linuxcnc_turns_in_the_same_circles(text: str) -> None:
    found = rs274.interpret(text)
    assert found.ok, found.error
    lowest: dict[tuple[float, float], float] = {}
    for call in found.of("STRAIGHT_FEED"):  # back to the axis
        x, y, z = (round(value, 3) for value in call.mm)
        lowest[x, y] = z
    assert lowest == BOTTOMS


@pytest.mark.parametrize("tool", [2.0, 1.2])
def test_a_narrow_tool_leaves_no_core(tool: float) -> None:
    asked = job(tool=tool, pitch=0.25)
    found = text_of(asked)
    rings = bored(found)
    wide = rings[40.0, 20.0]  # the counterbore of 11 mm, and the hole of 6.8 mm under it
    assert wide[1] < tool / 2 and wide[2] == pytest.approx(5.5 - tool / 2, abs=ROUNDED)
    assert kinds(found, asked) == set()


def test_a_counterbore_is_bored_before_what_is_below_it() -> None:
    found = text_of(job(tool=4.0))
    at = [match.start() for match in re.finditer(r"X4[13]\.\d+ Y20 Z", found)]
    wide, narrow = found.index("X43.499 Y20 Z"), found.index("X41.399 Y20 Z")
    assert at and wide < narrow
    assert kinds(found, job(tool=4.0)) == set()


@pytest.mark.parametrize(
    ("before", "after", "finding"),
    [
        ("X20.499 Y32 I-0.499 J0\n", "", "missing-hole"),
        ("X20.499 Y32 Z7 I-0.499 J0\n", "", "steep-entry"),
        ("X20.499 Y32 Z3 I-0.499 J0\n", "G1 Z3\nG3 ", "steep-entry"),
        ("G3 X20.499 Y32 Z12.5", "G2 X20.499 Y32 Z12.5", "cut-direction"),
        ("M3", "M4", "spindle-differs"),
        ("X20.499 Y32 Z3 I-0.499 J0\nX20.499 Y32 I-0.499", "X20.499 Y32 Z3 I-0.499 J0\nX20.499 Y32 I-0.489", "excess"),
        ("X20.499 Y32 Z7 I-0.499 J0", "X20.499 Y32 Z7 I-0.489 J0", "excess"),
        ("X20.499 Y32 Z7 I-0.499 J0", "X20.499 Y32 Z7 I-0.503 J0", "gouge"),
        ("Z3 I-0.499 J0\nX20.499", "Z2.99 I-0.499 J0\nX20.499", "extra-hole"),
        ("Z13\n", "Z11.9\n", "rapid-plunge"),
        ("F119.9", "F600", "feed-differs"),
        ("G1 X20\n", "G1 X22\n", "gouge"),
        ("G1 X20\n", "G1 X20\nG4 P1\n", "dwell"),
        ("G1 X20\n", "G1 X20\nX35\n", "gouge"),
        ("G0 Z42\nX8.499\n", "G0 Z42\nX14\nG1 Z12.5\nX15\nG0 Z42\nX8.499\n", "extra-hole"),
    ],
)
def test_what_is_wrong_in_the_text_is_found(text: str, before: str, after: str, finding: str) -> None:
    assert before in text
    assert finding in kinds(text.replace(before, after, 1), job(diameter=5.0))


def test_a_hole_and_a_ring_that_are_left_out_are_found(text: str) -> None:
    hole = re.search(r"X8\.499\n(?:.*\n)*?G0 Z42\n", text)
    assert hole and "missing-hole" in kinds(text.replace(hole[0], "", 1), job(diameter=5.0))
    asked = job(tool=1.2, pitch=0.25, faces=HOLE)
    narrow = text_of(asked)
    rings = re.findall(r"X2[01]\.\d+\nZ13\n(?:.*\n)*?G0 Z42\n", narrow)
    assert len(rings) == 3 and kinds(narrow, asked) == set()
    assert kinds(narrow.replace("".join(rings[:2]), "", 1), asked) == {"uncleared"}
    assert kinds(narrow.replace(rings[2], "", 1), asked) == {"excess"}


@pytest.mark.parametrize(
    ("keys", "code", "where"),
    [
        ({"faces": "HOLE", "tool": 5.0}, "narrow-hole", "operations[0].tool"),
        ({"tool": 12.0}, "narrow-hole", "operations[0].tool"),
        ({"diameter": 6.0}, "wide-hole", "operations[0].diameter"),
        ({"faces": ["Face1"]}, "no-hole", "operations[0].faces"),
        ({"pitch": 1.0, "diameter": 5.0}, "steep-helix", "operations[0].pitch"),
        ({"tool": 2.0, "helix_distance": 2.5}, "conflict", "operations[0].helix_distance"),
        ({"axial_stock_to_leave": 0.1}, "conflict", "operations[0].axial_stock_to_leave"),
        ({"fit": "arcs"}, "conflict", "operations[0].fit"),
    ],
)
def test_what_cannot_be_bored_is_refused_with_what_to_do(keys: dict[str, Any], code: str, where: str) -> None:
    if keys.get("faces") == "HOLE":
        keys = keys | {"faces": HOLE}
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(**keys))
    assert (refused.value.code, refused.value.where) == (code, where)
    assert refused.value.hint


def test_the_pitch_that_a_refusal_names_is_taken() -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(pitch=1.0, diameter=5.0))
    pitch = float(re.findall(r"pitch = ([\d.]+)", str(refused.value.hint))[0])
    assert sc.plan(job(pitch=pitch, diameter=5.0)).programs["main"].moves.size


def test_stock_above_a_stated_beginning_is_found() -> None:
    document = job(faces=HOLE).to_dict()
    document["setup"] |= {"stock": {"kind": "box", "top": 3.0, "sides": 1.0}, "retract": 17.0}
    for keys, found in (({}, set()), ({"z_top": 12.0}, {"stock-above"})):
        document["operations"][0] |= keys
        asked = sc.Job.from_dict(document)
        text = sc.post(sc.plan(asked), "linuxcnc").text
        assert {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]} == found
