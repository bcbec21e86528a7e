"""`styluscam run` and `plan`: what is written, what is printed, and what other interpreters make of it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.cli.summary import lines_of
from styluscam.programs.summary import Summary

from .conftest import CHECKOUT, COARSE_CUP, FIXTURES, changed

HALF_OF_THE_LAST_DIGIT = 0.0005  # mm: shipped machines post three decimals
PRINTED = 0.00005  # mm: rs274 prints four

OPERATION = 'kind = "{}"\ntool = "stylus"\n{}\n'
ZIG_ZAG = (
    OPERATION.format("z-level", "step = { height = 4.0 }"),
    OPERATION.format("zig-zag", "stepover = 10.0\nangle_deg = 30.0"),
)
INTO_FLAT_SHEET = ("schema = 1", 'schema = 1\naccept = ["punch"]')
"""Rows finish what levels form; alone they are for trying out."""
ROWS = (ZIG_ZAG, INTO_FLAT_SHEET)
GRBL = ('name = "linuxcnc"', 'name = "grbl"')
PROFILE = 'profile = { kind = "clothoid", diameter = 10.0 }'
BALL = ('kind = "clothoid"', 'kind = "ball"')
COMBINATIONS = {
    f"{'zig-zag' if rows else 'z-level'}-{'grbl' if grbl else 'linuxcnc'}-{'ball' if ball else 'clothoid'}": tuple(
        change for change, wanted in ((ZIG_ZAG, rows), (INTO_FLAT_SHEET, rows), (GRBL, grbl), (BALL, ball)) if wanted
    )
    for rows in (False, True)
    for grbl in (False, True)
    for ball in (False, True)
}


@pytest.mark.parametrize("changes", COMBINATIONS.values(), ids=COMBINATIONS)
def test_every_combination_runs_and_is_verified(coarse, cli, changes):
    run = coarse(*changes)
    assert run.ran.code == 0, run.ran.out
    document = run.ran.json
    accepted = {"punch"} if ZIG_ZAG in changes else set()
    assert document["ok"] and {finding["kind"] for finding in document["report"]["findings"]} == accepted
    assert document["report"]["gouge_max"] <= 0.001
    assert [Path(path).name for path in document["written"]] == ["cup.ngc", "cup.program.json"]
    again = cli("verify", run.gcode, "--job", run.job, "--json")
    assert again.code == 0 and again.json["gouge_max"] == document["report"]["gouge_max"]


@pytest.mark.world
@pytest.mark.parametrize("changes", COMBINATIONS.values(), ids=COMBINATIONS)
def test_linuxcnc_moves_as_planned(coarse, changes):
    from rs274 import interpret

    run = coarse(*changes)
    printed = interpret(run.gcode.read_text())
    assert printed.returncode == 0 and printed.ok, printed.error
    planned = sc.Program.load(run.folder / "cup.program.json").moves
    # the tool's position before the program is not known: the first rapid is posted as Z, then X and Y
    up, *spoken = printed.moves
    assert up.kind == "STRAIGHT_TRAVERSE" and up.mm[2] == pytest.approx(
        planned["end"][0, 2], abs=HALF_OF_THE_LAST_DIGIT
    )
    kinds = np.array([call.kind == "STRAIGHT_FEED" for call in spoken])
    assert np.array_equal(kinds, planned["kind"] == 1)
    ends = np.array([call.mm for call in spoken])
    assert np.abs(ends - planned["end"]).max() <= HALF_OF_THE_LAST_DIGIT + PRINTED
    feeds = np.array([call.feed for call in spoken])
    cutting = planned["kind"] == 1
    assert np.array_equal(feeds[cutting], planned["feed"][cutting])


PROFILES = {
    "flat": '{ kind = "flat", diameter = 6.0 }',
    "cone": '{ kind = "cone", half_angle_deg = 45.0, diameter = 8.0 }',
    "tapered ball": '{ kind = "tapered-ball", tip_radius = 1.5, half_angle_deg = 10.0, diameter = 8.0 }',
    "points": '{ kind = "points", points = [[0, 0], [1, 0.1], [2, 0.42], [3, 1.0], [4, 2.0], [4.6, 3.0], [5, 5.0]] }',
    "formula": '{ kind = "formula", r = "3*sin(t)", z = "6*cos(t)", t = [0.0, 1.5707963267948966] }',
}


STEP_WITHIN_THE_TOOL_RADIUS = (("step = { height = 4.0 }", "step = { height = 2.5 }"),)
"""The flat tool and the formula's have a radius of 3 mm, and a step beyond it is a punch."""


@pytest.mark.parametrize("strategy", [STEP_WITHIN_THE_TOOL_RADIUS, ROWS], ids=["z-level", "zig-zag"])
@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_kinks_cones_flats_points_and_formulas_run_and_are_verified(coarse, profile, strategy):
    run = coarse((PROFILE, f"profile = {profile}"), *strategy)
    assert run.ran.code == 0, run.ran.out[-2000:]
    assert run.ran.json["report"]["gouge_max"] <= 0.001


def test_tools_come_from_libraries_and_files(coarse, tmp_path, cli):
    shipped = coarse((PROFILE, 'library = "clothoid:medium"'))
    assert shipped.ran.code == 0, shipped.ran.out[-2000:]
    assert shipped.ran.json["summary"]["tools"][0]["description"] == "clothoid D12"
    assert cli("tool", "new", tmp_path / "mine.json", "--kind", "bull-nose").code == 0
    own = coarse((PROFILE, f'library = "{tmp_path}/mine.json"'))
    assert own.ran.json["summary"]["tools"][0]["description"] == "bull-nose D10"
    wrong = coarse((PROFILE, 'library = "clothiod:medium"'))
    assert wrong.ran.code == 2 and wrong.ran.json["error"]["where"] == "tools.stylus.library"
    assert "did you mean" in wrong.ran.json["error"]["message"] + wrong.ran.json["error"]["hint"]


def test_rows_stay_between_the_heights_asked_for(coarse):
    heights = ('tool = "stylus"', 'tool = "stylus"\nz_top = -4.0\nz_bottom = -8.0')
    moves = sc.Program.load(coarse(*ROWS, heights).folder / "cup.program.json").moves
    tips = moves["end"][moves["kind"] == 1, 2]
    assert -8.0 <= tips.min() < -7.9
    assert -4.1 < tips.max() <= -4.0 + 0.005


def test_summary_states_first_what_is_mis_zeroed(coarse, cli):
    run = coarse()
    ran = cli("run", run.job)
    assert ran.code == 0 and ran.err == ""
    lines = ran.out.splitlines()
    assert lines[0] == "Coarse cup"
    printed = [line.split("  ")[0] for line in lines[1:]]
    assert printed[:8] == ["zero", "work offset", "part box", "deepest Z", "tool", "sheet", "units", "machine"]
    for word in ("operation", "faces", "wall angle", "bridged", "length", "worst gouge", "worst excess", "written"):
        assert word in printed
    assert "Z top of the sheet" in lines[1] and "G54" in lines[2]
    assert "X -50.000 to 50.000, Y -50.000 to 50.000, Z -31.000 to -1.000" in lines[3]
    assert "T1 H1: clothoid D10, programmed at its tip" in lines[5]
    assert len(lines) < 26


def test_of_many_faces_the_summary_lists_the_worst(coarse):
    """And how many more; none of those loses more than one that is listed."""
    run = coarse()
    job, summary = sc.Job.read(run.job).document, run.ran.json["summary"]
    operation = summary["operations"][0]
    sides = {"contact": 9.0, "bridged": 0.0, "rim": 0.0, "undercut": 0.0}
    faces = [{"face": number, **sides, "interferes": float(number % 10)} for number in range(1, 31)]
    many = {**summary, "operations": [{**operation, "reached": faces, "bridged": [], "undercut": []}]}
    rows = [value for name, value in lines_of(Summary.of(many), job) if name == "reached"]
    assert [row.split(",")[0] for row in rows[:-1]] == [f"Face{n}" for n in (7, 8, 9, 17, 18, 19, 28, 29)]
    assert rows[-1].startswith("and 19 more faces")
    few = {**summary, "operations": [{**many["operations"][0], "reached": faces[:9]}]}
    assert len([name for name, _ in lines_of(Summary.of(few), job) if name == "reached"]) == 9


def test_summary_equals_the_header(coarse):
    run = coarse()
    header = run.gcode.read_text()
    summary = run.ran.json["summary"]
    assert f"deepest Z of a tip: {summary['deepest_z']:.3f}" in header
    assert f"worst gouge {summary['gouge_max']:.4f} mm, worst excess {summary['excess_max']:.4f} mm" in header


def test_quiet_prints_nothing(coarse, cli):
    ran = cli("run", coarse().job, "--quiet")
    assert (ran.code, ran.out, ran.err) == (0, "", "")


def test_quiet_prints_warnings(tmp_path, cli):
    job = tmp_path / "job.toml"
    too_steep = ("thickness = 1.0", "thickness = 1.0\nmax_wall_angle_deg = 30.0")
    job.write_text('accept = ["wall-angle"]\n' + changed(COARSE_CUP, too_steep))
    ran = cli("run", job, "--quiet")
    assert ran.code == 0 and ran.out == "" and "warning: " in ran.err and "a wall is at" in ran.err
    ran = cli("verify", tmp_path / "cup.ngc", "--job", job, "--quiet")
    assert ran.code == 0 and ran.out == "" and "a wall is at" in ran.err


def test_missing_output_folders_are_made(tmp_path, cli):
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, ('"cup.ngc"', '"new/folder/cup.ngc"'), ('"cup.program.json"', '"other/p.json"')))
    assert cli("run", job, "--quiet").code == 0
    assert (tmp_path / "new/folder/cup.ngc").is_file() and (tmp_path / "other/p.json").is_file()


@pytest.fixture
def objecting(tmp_path, monkeypatch):
    """A job whose posted text has one coordinate moved: the verifier objects."""
    from styluscam.programs import running

    post = running.post

    def spoilt(*args, **kwargs):
        posted = post(*args, **kwargs)
        return sc.Posted({name: text.replace("G1 Z-4 ", "G1 Z-4.3 ", 1) for name, text in posted.files.items()})

    monkeypatch.setattr(running, "post", spoilt)
    job = tmp_path / "job.toml"
    job.write_text(COARSE_CUP)
    return job


def test_nothing_is_written_where_the_verifier_objects(objecting, cli):
    ran = cli("run", objecting)
    assert ran.code == 1
    assert [path.name for path in objecting.parent.iterdir()] == ["job.toml"]
    assert "line " in ran.err and "gouge" not in ran.out.splitlines()[0]
    assert ran.err.splitlines()[-1].startswith("no program was written")
    as_json = cli("run", objecting, "--json")
    assert as_json.code == 1 and not as_json.json["ok"] and as_json.json["written"] == []
    assert as_json.json["report"]["findings"][0]["line"] > 0


def test_findings_can_be_overruled_by_name(objecting, cli):
    ran = cli("run", objecting, "--write-despite-findings")
    assert ran.code == 1 and "no program was written" not in ran.err
    assert (objecting.parent / "cup.ngc").is_file()


def test_plan_writes_nothing_but_what_is_asked_for(tmp_path, cli):
    job = tmp_path / "job.toml"
    job.write_text(COARSE_CUP)
    ran = cli("plan", job)
    assert ran.code == 0 and "planned only" in ran.out and "worst gouge" not in ran.out
    assert list(tmp_path.iterdir()) == [job]
    ran = cli("plan", job, "--program", tmp_path / "p.json", "--json")
    assert ran.code == 0 and ran.json["summary"]["operations"][0]["facts"][0]["value"] > 4
    assert sc.Program.load(tmp_path / "p.json").length == pytest.approx(ran.json["summary"]["length"])


def test_pictures_are_drawn(tmp_path, cli):
    from matplotlib.image import imread

    job = tmp_path / "job.toml"
    job.write_text(COARSE_CUP)
    assert cli("run", job, "--picture", tmp_path / "pics/cup.png", "--quiet").code == 0
    image = imread(tmp_path / "pics/cup.png")
    assert image.shape[:2] == (800, 1200)
    assert image[..., :3].std() > 0.05


def test_ctrl_c_ends_with_130_and_no_file(tmp_path):
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, ("height = 4.0", "height = 0.002")))
    environment = os.environ | {"PYTHONPATH": str(CHECKOUT / "python")}
    command = [sys.executable, "-m", "styluscam", "run", str(job)]
    started = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)
    time.sleep(6.0)
    assert started.poll() is None, "the job was done before it could be interrupted"
    started.send_signal(signal.SIGINT)
    out, err = started.communicate(timeout=30)
    assert started.returncode == 130
    assert (out, err.splitlines()[-1]) == ("", "error: interrupted")
    assert list(tmp_path.iterdir()) == [job]


def test_json_of_a_cancelled_run(coarse, cli, monkeypatch):
    from styluscam.cli import run

    def cancelled(*args, **kwargs):
        raise sc.Cancelled("cancelled", code="cancelled")

    job = coarse().job  # before: the session keeps what this run gives
    monkeypatch.setattr(run.running, "run", cancelled)
    ran = cli("run", job, "--json")
    assert ran.code == 3
    assert json.loads(ran.out)["error"]["class"] == "Cancelled"
    assert ran.err == ""


@pytest.mark.parametrize(
    ("keys", "stands"), [({"spindle": {"mode": "off"}}, True), ({"spindle": {"mode": "fixed", "rpm": 8000.0}}, False)]
)
def test_summary_states_a_spindle_that_stands_where_the_tool_mills(keys: dict[str, Any], stands: bool) -> None:
    operation = {"kind": "zig-zag", "tool": "ball", "stepover": 2.0, **keys}
    job = sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / "cone_cup.step"), "faces": ["Face1"]},
            "process": {"kind": "milling"},
            "tools": {"ball": {"profile": {"kind": "ball", "diameter": 10.0}}},
            "operations": [operation],
            "machine": {"name": "grbl"},
        }
    )
    summary = sc.plan(job).summary()[0]
    assert ("spindle" in dict(lines_of(summary, job.document))) is stands
