"""``styluscam machine`` and ``styluscam post``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc

NAMES = sc.Machine.names()


def test_list_states_how_well_each_is_known(cli: Any) -> None:
    ran = cli("machine", "list")
    assert ran.code == 0
    for name in NAMES:
        assert any(line.split()[:1] == [name] for line in ran.out.splitlines()), name
    assert "UNVERIFIED" in ran.out
    listed = json.loads(cli("machine", "list", "--json").out)
    assert [entry["name"] for entry in listed] == NAMES
    assert {entry["evidence"] for entry in listed} == {"read", "partly", "unverified"}


def test_show_names_what_was_read(cli: Any) -> None:
    out = cli("machine", "show", "fanuc").out
    assert "B-63844EN/02" in out and "unconfirmed" in out
    assert json.loads(cli("machine", "show", "fanuc", "--json").out)["name"] == "fanuc"


def test_a_new_machine_is_checked_and_compared(cli: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = cli("machine", "new", "shop", "--from", "fanuc")
    assert ran.code == 0 and "styluscam machine check shop.toml" in ran.out
    assert cli("machine", "new", "shop", "--from", "fanuc").code == 2
    ran = cli("machine", "check", "shop.toml")
    assert ran.code == 0 and "0 failed" in ran.out
    document = json.loads(cli("machine", "check", "shop.toml", "--json").out)
    assert document["ok"] and len(document["trials"]) > 30
    assert cli("machine", "diff", "fanuc", "fanuc").out == "no difference\n"
    assert "+ shop" in cli("machine", "diff", "fanuc", "shop.toml").out


WRONG = {
    "unknown key": ('[number]\npointt = "always"\n', ["number.pointt", "line 6", 'did you mean "point"']),
    "unknown machine": ('extends = "fanucc"\n', ['did you mean "fanuc"']),
    "unknown name": (
        '[templates]\nprogram_end = """\n{{ end }}\n{{ unit_word }}\n"""\n',
        ["line 2", "column 4", "units_word"],
    ),
    "not TOML": ("[number\n", ["line 5"]),
    "wrong kind": ('[line]\nmax_chars = "long"\n', ["line.max_chars", "line 6"]),
    "itself": ('extends = "ours.toml"\n', ["without end"]),
}


@pytest.mark.parametrize(("text", "words"), WRONG.values(), ids=WRONG)
def test_a_wrong_file_is_one_line_that_states_where(text: str, words: list[str], cli: Any, tmp_path: Path) -> None:
    head = f"schema = 1\n{text}" if text.startswith("extends") else 'schema = 1\nextends = "grbl"\n'
    body = 'name = "ours"\ndescription = "ours"\n'
    file = tmp_path / "ours.toml"
    file.write_text(head + body + ("" if text.startswith("extends") else text))
    ran = cli("machine", "check", file)
    assert ran.code == 2 and ran.out == ""
    assert ran.err.startswith("error: ") and ran.err.count("\n") == 1, ran.err
    assert "Traceback" not in ran.err
    for word in words:
        assert word in ran.err, (word, ran.err)


def test_a_template_that_contradicts_the_reader_fails_with_its_line(cli: Any, tmp_path: Path) -> None:
    file = tmp_path / "ours.toml"
    text = 'schema = 1\nextends = "grbl"\nname = "ours"\ndescription = "ours"\n[templates]\nprogram_end = "M6\\nM2"\n'
    file.write_text(text)
    ran = cli("machine", "check", file)
    assert ran.code == 1
    assert "FAILED" in ran.out and ": M6" in ran.out and "ours refuses this code" in ran.out


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two operations of three levels each."""
    step = {"kind": "rapid", "feed": 0.0}
    moves = []
    for operation in range(2):
        for z in (-1.0, -2.0, -3.0):
            moves.append({**step, "end": [0.0, 0.0, 5.0], "operation": operation})
            for end in ([0.0, 0.0, z], [20.0, 0.0, z], [20.0, 10.0, z]):
                moves.append({"kind": "feed", "feed": 600.0, "end": end, "operation": operation})
            moves.append({**step, "end": [20.0, 10.0, 5.0], "operation": operation})
    tool = {"name": "a", "number": 1, "length_offset": 1, "description": "ball D6", "reference": "tip",
            "reference_height": 0.0, "diameter": 6.0}  # fmt: skip
    document = {
        "schema": 1,
        "setup": {"title": "two", "wcs": "G54", "zero": "top", "part_min": [0, 0, 0], "part_max": [0, 0, 0],
                  "clearance": 8.0, "notes": []},
        "tools": [tool],
        "operations": [{"id": name, "kind": "z-level", "tool": 0} for name in ("rough", "fine")],
        "moves": moves,
        "events": [
            {"before": 0, "kind": "tool-change", "tool": 0},
            {"before": 0, "kind": "spindle-on", "rpm": 900.0, "direction": "clockwise"},
        ],
    }  # fmt: skip
    path = tmp_path_factory.mktemp("program") / "two.json"
    path.write_text(json.dumps(document))
    return path


def posted(cli: Any, program: Path, tmp_path: Path, *options: str) -> list[str]:
    out = tmp_path / "out.ngc"
    ran = cli("post", program, "--machine", "linuxcnc", "--out", out, "--force", *options)
    assert ran.code == 0, ran.err
    return out.read_text().splitlines()


def test_a_restart_at_a_level_has_tool_spindle_and_a_safe_path(cli: Any, program: Path, tmp_path: Path) -> None:
    lines = posted(cli, program, tmp_path, "--from", "fine:2")
    code = [line for line in lines if not line.startswith("(")]
    assert any("RESTART at fine:2" in line for line in lines)
    start = code.index("T1 M6")
    assert code[start : start + 8] == ["T1 M6", "G43 H1", "S900 M3", "G0 Z8", "X0 Y0", "G1 Z-2 F600", "X20", "Y10"]


def test_a_restart_at_a_line_goes_on_with_that_line(cli: Any, program: Path, tmp_path: Path) -> None:
    whole = posted(cli, program, tmp_path)
    line = max(number for number, text in enumerate(whole, 1) if text == "Y10")
    rest = posted(cli, program, tmp_path, "--from", f"L{line}")
    assert rest[-4:] == whole[-4:] == ["Y10", "G0 Z5", "M5", "M2"]
    assert rest[-7:-4] == ["G0 Z8", "X20 Y0", "G1 Z-3 F600"]
    ran = cli("post", program, "--machine", "linuxcnc", "--out", tmp_path / "x.ngc", "--from", "L9999")
    assert ran.code == 2 and not (tmp_path / "x.ngc").exists()


def test_air_stops_options_and_cutter_locations(cli: Any, program: Path, tmp_path: Path) -> None:
    air = posted(cli, program, tmp_path, "--air", "50")
    assert "G1 Z49 F600" in air and any("AIR CUT" in line for line in air)
    assert posted(cli, program, tmp_path, "--optional-stops").count("M1") == 1
    inches = posted(cli, program, tmp_path, "--set", "units=inch", "--set", "block_numbers=true")
    assert any(line.startswith("N10 G20") for line in inches)
    text = "\n".join(posted(cli, program, tmp_path, "--cl"))
    assert "LOADTL/1" in text and "GOTO/20,10,-3" in text and text.endswith("FINI")


def test_gcode_of_one_machine_becomes_that_of_another(cli: Any, program: Path, tmp_path: Path) -> None:
    whole = tmp_path / "whole.ngc"
    whole.write_text("\n".join(posted(cli, program, tmp_path)) + "\n")
    out = tmp_path / "part.h"
    ran = cli("post", whole, "--as", "linuxcnc", "--machine", "heidenhain", "--out", out)
    assert ran.code == 0, ran.err
    theirs = sc.read_gcode(out.read_text(), sc.Machine.shipped("heidenhain"))
    ours = sc.read_gcode(whole.read_text(), sc.Machine.shipped("linuxcnc"))
    assert (theirs.moves["end"][-10:] == ours.moves["end"][-10:]).all()


def test_pairs_wait_for_one_another(cli: Any, program: Path, tmp_path: Path) -> None:
    machine = tmp_path / "dsif.toml"
    machine.write_text(
        'schema = 1\nextends = "linuxcnc"\nname = "dsif"\ndescription = "one side"\n'
        '[templates]\nsync = "M101 P{{ mark }}"\n[reader]\npassed = ["M101"]\n'
    )
    assert cli("machine", "check", machine).code == 0
    names = [tmp_path / "main.ngc", tmp_path / "support.ngc"]
    options = ("--support", program, "--support-out", names[1])
    ran = cli("post", program, "--machine", machine, "--out", names[0], *options)
    assert ran.code == 0, ran.err
    marks = [[line for line in name.read_text().splitlines() if line.startswith("M101")] for name in names]
    assert marks == [["M101 P1", "M101 P2"]] * 2
    ran = cli("post", program, "--machine", "linuxcnc", "--out", tmp_path / "x.ngc", "--support", program,
              "--support-out", tmp_path / "y.ngc")  # fmt: skip
    assert ran.code == 2 and "waiting for another program" in ran.err and not (tmp_path / "y.ngc").exists()


def test_a_lathe_turns_in_x_and_z(cli: Any, tmp_path: Path) -> None:
    machine = tmp_path / "lathe.toml"
    machine.write_text(
        'schema = 1\nextends = "linuxcnc"\nname = "lathe"\ndescription = "spinning"\ncycle = false\n'
        '[motion]\nlathe = "diameter"\n'
    )
    ran = cli("machine", "check", machine)
    assert ran.code == 0, ran.out
    assert "0 failed" in ran.out


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--from", "finer"], "no operation"),
        (["--from", "fine:9"], "no level 9"),
        (["--set", "unit=inch"], "did you mean"),
        (["--set", "units"], "NAME=VALUE"),
        (["--machine", "linuxcn"], "did you mean"),
    ],
)
def test_wrong_options_are_one_line(options: list[str], word: str, cli: Any, program: Path, tmp_path: Path) -> None:
    out = tmp_path / "x.ngc"
    ran = cli("post", program, "--machine", "linuxcnc", "--out", out, *options)
    assert ran.code == 2 and ran.err.count("\n") == 1 and word in ran.err, ran.err
    assert not out.exists()


def test_a_text_that_nobody_verified_states_so(cli: Any, program: Path, tmp_path: Path) -> None:
    document = json.loads(program.read_text())
    document["setup"]["notes"] = ["judged from this text: passed, worst gouge 0.0000 mm"]
    verified = tmp_path / "verified.json"
    verified.write_text(json.dumps(document))
    assert "(judged, not this text: passed, worst gouge 0.0000 mm)" in posted(cli, verified, tmp_path, "--air", "5")
    assert "(this text was not judged)" in posted(cli, program, tmp_path)


def test_an_optional_stop_stands_with_spindle_and_coolant_off(cli: Any, program: Path, tmp_path: Path) -> None:
    lines = posted(cli, program, tmp_path, "--optional-stops")
    stop = lines.index("M1")
    assert "M5" in lines[:stop] and not any("M3" in line for line in lines[lines.index("M5") : stop])


def test_the_length_offset_of_a_text_is_kept_and_none_is_made_up(cli: Any, tmp_path: Path) -> None:
    text = (
        "%\nO0001\nG21\nG90 G94 G17 G40 G49 G80\nG54\nT1 M6\nG0 G43 Z10. H21\nX0. Y0.\nG1 Z-1. F100.\nG0 Z10.\nM30\n%\n"
    )
    (tmp_path / "old.nc").write_text(text)
    out = tmp_path / "new.nc"
    ran = cli("post", tmp_path / "old.nc", "--as", "fanuc", "-m", "haas", "-o", out)
    assert ran.code == 0 and "G43 Z10. H21" in out.read_text(), ran.err
    (tmp_path / "bare.ngc").write_text("G21 G90 G94 G17 G40 G49 G80 G54\nT1 M6\nG0 Z10\nX0 Y0\nG1 Z-1 F100\nM2\n")
    ran = cli("post", tmp_path / "bare.ngc", "--as", "linuxcnc", "-m", "fanuc", "-o", tmp_path / "bare.nc")
    assert ran.code == 2 and "length offset" in ran.err
    ran = cli("post", tmp_path / "bare.ngc", "--as", "linuxcnc", "-m", "grbl", "-o", tmp_path / "bare.nc")
    assert ran.code == 0, ran.err


def test_a_text_that_names_no_tool_gets_one(cli: Any, tmp_path: Path) -> None:
    (tmp_path / "old.gcode").write_text("; machine: x\nG21\nG90\nG0 Z10 F3000\nG0 X0 Y0\nG1 Z-1 F100\nG0 Z10 F3000\n")
    ran = cli("post", tmp_path / "old.gcode", "--as", "marlin", "-m", "grbl", "-o", tmp_path / "new.nc")
    assert ran.code == 0 and "T1" in (tmp_path / "new.nc").read_text().split(), ran.err
    assert "(machine: x)" not in (tmp_path / "new.nc").read_text()
