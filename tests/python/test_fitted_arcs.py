"""`fit = "arcs"`: lines and arcs within the same tolerance, far fewer than chords, on machines with and without arcs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roots
import rs274
import styluscam as sc
from long_cases import some_long

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
FACES = {"cone_cup": ["Face1", "Face2", "Face3", "Face4"], "cap_r60": ["Face1"], "vwaf": ["Face1", "Face2", "Face3"]}
KINDS: dict[str, dict[str, Any]] = {
    "levels": {"kind": "z-level", "step": {"height": 2.0}},
    "ramps": {"kind": "z-level", "step": {"height": 2.0}, "ramp_angle_deg": 5.0},
    "spiral": {"kind": "spiral", "step": {"height": 2.0}},
    "rows along X": {"kind": "zig-zag", "stepover": 4.0},
    "rows along Y": {"kind": "zig-zag", "stepover": 4.0, "angle_deg": 90.0},
}
RAPID = 0
GOUGE, TOLERANCE = 0.001, 0.005


def job(part: str, kind: str, machine: str = "linuxcnc", **keys: Any) -> sc.Job:
    operation = {**KINDS[kind], "tool": "ball", "spindle": {"mode": "fixed", "rpm": 8000.0}, **keys}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / f"{part}.step"), "faces": FACES.get(part, "all")},
            "setup": {"zero": "model"},
            "process": {"kind": "milling"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
            "operations": [operation],
            "machine": {"name": machine},
        }
    )


def facts(plan: sc.Plan) -> dict[str, sc.types.Fact]:
    return {fact.fact: fact for fact in plan.summary()[0].operations[0].facts}


def feeds(program: sc.Program) -> int:
    return int(np.count_nonzero(program.moves["kind"] != RAPID))


def is_sound(report: sc.Report) -> bool:
    return bool(report.ok) and not report.findings and report.gouge_max <= GOUGE and report.excess_max <= TOLERANCE


@pytest.mark.parametrize("part", some_long(["cone_cup", "cap_r60", "vwaf", "pyramid"], {"cap_r60", "pyramid"}))
@pytest.mark.parametrize("kind", KINDS)
def test_few_arcs_keep_the_tolerance(part: str, kind: str) -> None:
    asked = job(part, kind, fit="arcs")
    plan = sc.plan(asked)
    chords = sc.plan(job(part, kind))
    assert is_sound(sc.verify(sc.post(plan), asked))
    ratio = feeds(chords.programs["main"]) / feeds(plan.programs["main"])
    # between upright walls, of which the pyramid has more, passes are joined by chords
    assert ratio >= (4.0 if kind.startswith("rows") or part == "pyramid" else 5.0), ratio
    found = facts(plan)
    assert found["arcs"].value > 0 and found["chords_per_piece"].value > 0.9 * ratio
    assert "arcs" not in facts(chords)


@pytest.mark.parametrize("machine", ["grbl", "fanuc", "heidenhain"])
def test_each_machine_gets_the_arcs_that_it_has(machine: str) -> None:
    asked = job("cap_r60", "levels", machine, fit="arcs")
    plan = sc.plan(asked)
    posted = sc.post(plan)
    assert is_sound(sc.verify(posted, asked))
    # none of them becomes lines as it is posted
    read = sc.read_gcode(posted.text, sc.Machine.shipped(machine))
    arcs = [sum(np.isfinite(program.moves["centre"]).all(axis=1)) for program in (plan.programs["main"], read)]
    halves = 2 if machine == "fanuc" else 1
    assert arcs[0] > 10 and arcs[1] == halves * arcs[0]


def test_where_the_machine_has_no_arc_lines_are_planned_and_a_fact_states_it() -> None:
    asked = job("cap_r60", "rows along X", "heidenhain", fit="arcs")  # it has no arcs in upright planes
    plan = sc.plan(asked)
    assert "lines" in facts(plan)["arcs"].words and facts(plan)["arcs"].value == 0
    chords = sc.plan(job("cap_r60", "rows along X", "heidenhain"))
    # fitted from the other end where a row is turned round
    assert abs(feeds(plan.programs["main"]) / feeds(chords.programs["main"]) - 1.0) < 0.01
    assert is_sound(sc.verify(sc.post(plan), asked))


@pytest.mark.parametrize("sheet", ["levels", "spiral"])
def test_sheets_are_formed_along_arcs(sheet: str) -> None:
    document = job("cone_cup", sheet, fit="arcs").to_dict()
    document["part"]["model_face"] = "back"
    document["setup"] = {"zero": "model", "sheet": {"thickness": 1.0}}
    document["process"] = {"kind": "spif"}
    document["operations"][0]["step"] = {"height": 0.5}
    asked = sc.Job.from_dict(document)
    plan = sc.plan(asked)
    report = sc.verify(sc.post(plan), asked)
    assert report.ok and not [one for one in report.findings if one.severity != "note"]
    assert report.gouge_max <= GOUGE and report.excess_max <= TOLERANCE
    assert facts(plan)["chords_per_piece"].value > 10


def test_seeded_defects_of_arcs_are_found() -> None:
    asked = job("cone_cup", "levels", fit="arcs")
    text = sc.post(sc.plan(asked)).text
    assert is_sound(sc.verify(text, asked))
    lines = text.splitlines()
    circles = [number for number, line in enumerate(lines) if re.search(r"\bI-?\d", line)]
    middle = circles[len(circles) // 2]
    wider = re.sub(r"I(-?[\d.]+)", lambda found: f"I{float(found[1]) * 1.01:.4f}", lines[middle])
    assert wider != lines[middle]
    for spoiled in ("", wider):
        worse = "\n".join([*lines[:middle], spoiled, *lines[middle + 1 :]]) + "\n"
        report = sc.verify(worse, asked)
        assert not report.ok or [one for one in report.findings if one.severity != "note"], spoiled


def test_freecad_gets_arcs_and_gives_them_back() -> None:
    program = sc.plan(job("cap_r60", "rows along Y", fit="arcs")).programs["main"]
    text = program.path_text()
    assert "G19" in text and re.search(r"^G[23] ", text, re.MULTILINE)
    assert len(re.findall(r"^G[0-3] ", text, re.MULTILINE)) <= len(program.moves["kind"]) + 2


@pytest.mark.world
def test_linuxcnc_follows_the_arcs() -> None:
    for kind in ("levels", "rows along X"):
        plan = sc.plan(job("cap_r60", kind, fit="arcs"))
        try:
            found = rs274.interpret(sc.post(plan).text)
        except roots.Unavailable as reason:
            pytest.skip(f"NOT TESTED with LinuxCNC: {reason}")
        assert found.ok, found.error
        assert len(found.of("ARC_FEED")) == facts(plan)["arcs"].value
