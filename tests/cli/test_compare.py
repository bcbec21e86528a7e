"""`styluscam compare`: two programs for one job, side by side."""

from __future__ import annotations

import re

import pytest

from .conftest import changed


@pytest.fixture(scope="module")
def programs(coarse, tmp_path_factory):
    """A job, a sound program for it, and one that enters the part."""
    run = coarse()
    other = tmp_path_factory.mktemp("other") / "other.ngc"
    other.write_text(changed(run.gcode.read_text(), ("M2\n", "G0 Z10\nG0 X0 Y0\nG1 Z-25.5 F300\nG1 X1\nG0 Z10\nM2\n")))
    return run.job, run.gcode, other


def test_both_stand_side_by_side(cli, programs):
    job, sound, faulty = programs
    ran = cli("compare", sound, faulty, "--job", job)
    assert ran.code == 1 and ran.err == ""
    rows = {re.split(r"\s{2,}", line)[0]: re.split(r"\s{2,}", line)[1:] for line in ran.out.splitlines()[2:]}
    for name in (
        "time",
        "length at feed",
        "blocks that move",
        "lowest Z",
        "worst gouge",
        "worst excess",
        "scallop",
        "covered",
    ):
        assert len(rows[name]) == 2, ran.out
    assert rows["worst gouge"][0] == "0.0000 mm" and float(rows["worst gouge"][1].split()[0]) > 0.3
    assert int(rows["blocks that move"][1]) == int(rows["blocks that move"][0]) + 5


def test_json_and_a_page(cli, programs, tmp_path):
    job, sound, faulty = programs
    page = tmp_path / "both.html"
    ran = cli("compare", sound, faulty, "--job", job, "--out", page, "--json")
    assert ran.code == 1 and ran.err == ""
    first, second = ran.json["programs"]
    assert first["file"] == str(sound) and first["report"]["ok"] and not second["report"]["ok"]
    assert first["figures"]["covered"] == pytest.approx(second["figures"]["covered"], abs=0.05)
    assert len(first["coverage"]) == 4 and ran.json["written"] == [str(page)]
    text = page.read_text()
    assert text.count('src="data:image/png') == 2 and "other.ngc" in text and "<script" not in text


def test_a_program_with_itself(cli, programs):
    job, sound, _ = programs
    assert cli("compare", sound, sound, "--job", job, "--quiet").code == 0


def test_bad_input_is_stated_in_one_line(cli, programs, tmp_path):
    job, sound, _ = programs
    for arguments, word in (
        ([sound, tmp_path / "none.ngc", "--job", job], "none.ngc"),
        ([sound, sound, "--job", tmp_path / "none.toml"], "none.toml"),
        ([sound, sound, "--job", job, "--out", sound], "is read by this very job"),
        ([sound, sound], "--job"),
    ):
        ran = cli("compare", *arguments)
        assert ran.code == 2 and ran.err.count("\n") == 1 and word in ran.err, ran.err
