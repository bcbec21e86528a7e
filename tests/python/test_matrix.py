"""Strategies, processes and kinds of parts against each other: each program verifies whole, or is refused with what to do.

The parts are of fixtures/matrix/make.py, as a CAD user would send them: blocks, a die, an open surface, a sheet of 1 mm.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from meridian import FIXTURES

pytest.importorskip("OCP", reason="needs the step extra")

BALL = {"kind": "ball", "diameter": 10.0}
CLOTHOID = {"kind": "clothoid", "diameter": 10.0}
STEP, TOLERANCE = 2.0, 0.02

FIXED = [{"kind": "z-level", "step": {"height": STEP}}]
LISTED = [{"kind": "z-level", "step": {"list": [1.0, 1.5, 2.0]}}]
SCALLOP = [{"kind": "z-level", "step": {"scallop": 0.08}, "step_max": STEP}]
FLATS = [{"kind": "z-level", "step": {"height": STEP}, "levels_at_flats": True}]
RAMPS = [{"kind": "z-level", "step": {"height": STEP}, "ramp_angle_deg": 8.0, "direction": "same"}]
ARCS = [{"kind": "z-level", "step": {"height": STEP}, "fit": "arcs"}]
SPIRAL = [{"kind": "spiral", "step": {"height": STEP}}]
SPIRAL_ARCS = [{"kind": "spiral", "step": {"height": STEP}, "fit": "arcs"}]
ROWS = [{"kind": "zig-zag", "stepover": 3.0}]
BOTH = [*FIXED, {"kind": "zig-zag", "stepover": 3.0, "angle_deg": 45.0}]

SPIF, DSIF, MILLING = {"kind": "spif"}, {"kind": "dsif", "support_tool": "below"}, {"kind": "milling"}
MALE, FEMALE = {"kind": "tpif", "die": "male"}, {"kind": "tpif", "die": "female"}

BACK, SINE, GRBL = {"face": "back"}, {"law": "sine"}, {"machine": "grbl"}
FINE = {"mesh": 0.001}

VERIFIED: list[tuple[str, dict[str, Any], list[dict[str, Any]], dict[str, Any], tuple[float, float]]] = [
    # part, process, operations, more; most that is bridged, from and to, mm
    ("cone_cup", SPIF, FIXED, {}, (0.0, 0.001)),
    ("cone_cup", SPIF, SPIRAL, {"profile": CLOTHOID, **SINE, **GRBL}, (0.005, 0.05)),
    ("cone_cup", DSIF, FIXED, FINE, (0.0, 0.001)),
    ("cone_cup", MILLING, BOTH, GRBL, (0.0, 0.001)),
    ("two_cups", SPIF, FLATS, {}, (0.0, 0.001)),
    ("two_cups", SPIF, SPIRAL, GRBL, (0.0, 0.001)),
    ("two_cups", FEMALE, RAMPS, BACK, (0.0, 0.001)),
    ("two_cups", MILLING, LISTED, {}, (0.0, 0.001)),
    # between walls at the angle a a ball is 5 (1 / cos(a / 2) - 1) off their edge: 0.32 mm at the floor, 0.61 in a corner, of
    # which samples beside the edge see 0.57
    ("pyramid", SPIF, SPIRAL, {}, (0.55, 0.63)),
    ("pyramid", SPIF, BOTH, GRBL, (0.55, 0.63)),
    ("pyramid", MILLING, ARCS, {}, (0.55, 0.63)),
    ("ellipse", SPIF, SCALLOP, SINE, (0.3, 0.5)),
    ("ellipse", FEMALE, SPIRAL_ARCS, GRBL, (0.3, 0.5)),
    ("frustum_male", MALE, RAMPS, {}, (0.0, 0.001)),
    ("frustum_male", MALE, SPIRAL, {**SINE, **GRBL}, (0.0, 0.001)),
    ("frustum_male", MILLING, ROWS, {}, (0.0, 0.001)),
    ("freeform", SPIF, LISTED, {}, (0.0, 0.001)),
    ("freeform", FEMALE, ARCS, {**BACK, **GRBL}, (0.0, 0.001)),
    ("tray", SPIF, FLATS, {}, (0.0, 0.001)),
    ("tray", MILLING, SPIRAL, {}, (0.0, 0.001)),
]

REFUSED = [
    # part, process, operations, more; the finding or the error's code, and what it has to state
    ("cone_cup", SPIF, ROWS, {}, "punch", "form level by level"),
    ("cone_cup", MALE, FIXED, {}, "conflict", 'die = "female"'),
    ("frustum_male", SPIF, FIXED, {}, "solid-formed", 'die = "male"'),
    ("freeform", MALE, FIXED, {}, "conflict", "setup.up"),
    ("tray", SPIF, FIXED, BACK, "sheet-face", 'model_face = "tool"'),
    ("tray", SPIF, FIXED, {"thickness": 2.0}, "sheet-thickness", "thickness = 1.0"),
]


@lru_cache(maxsize=8)
def part_of(name: str, tolerance: float) -> sc.Part:
    return sc.Part.read(FIXTURES / "matrix" / f"{name}.step", tolerance=tolerance)


def job_of(
    folder: Path, name: str, process: dict[str, Any], operations: list[dict[str, Any]], more: dict[str, Any]
) -> sc.Job:
    """A job as it is written by hand: nothing is accepted, all faces are selected."""
    mesh = more.get("mesh", 0.004)
    face = more.get("face", "back" if process == MALE else "tool")
    sheet = {"thickness": more.get("thickness", 1.0), "law": more.get("law", "constant")}
    forms = process != MILLING
    spindle = {} if forms else {"spindle": {"mode": "fixed", "rpm": 8000.0}}
    machine = {"name": more.get("machine", "linuxcnc")}
    document: dict[str, Any] = {
        "schema": 1,
        "part": {"file": f"{name}.step", "tolerance": mesh} | ({"model_face": face} if forms else {}),
        "setup": {"sheet": sheet} if forms else {},
        "process": process,
        "tools": {"tool": {"profile": more.get("profile", BALL)}},
        "operations": [{"tool": "tool", "tolerance": TOLERANCE, **spindle, **operation} for operation in operations],
        "machine": machine,
    }
    if process == DSIF:
        document["machines"] = {"support": machine}
        document["tools"]["below"] = {"profile": BALL}
    return sc.Job.from_dict(document, folder=folder, part=part_of(name, mesh))


def name_of(case: Any) -> str:
    name, process, operations, more = case[:4]
    kinds = [operation["kind"] + ("-arcs" if "fit" in operation else "") for operation in operations]
    return "-".join([name, process.get("die", process["kind"]), *kinds, *map(str, more)])


@pytest.mark.parametrize("case", VERIFIED, ids=name_of)
def test_it_is_made_whole(case: Any, tmp_path: Path) -> None:
    *job, (least, most) = case
    result = sc.run(job_of(tmp_path, *job))
    report = result.report
    assert result.ok, [finding["message"] for finding in report.findings]
    assert report.gouge_max <= 0.001
    assert 0.0 < report.excess_max <= TOLERANCE
    bridged = [at["excess"] for operation in result.summary["operations"] for at in operation["bridged"]]
    assert least <= max(bridged, default=0.0) <= most


@pytest.mark.parametrize("case", REFUSED, ids=name_of)
def test_it_is_refused_with_what_to_do(case: Any, tmp_path: Path) -> None:
    *job, kind, words = case
    try:
        report = sc.run(job_of(tmp_path, *job)).report
    except sc.StylusError as error:
        found = {error.code: f"{error} {error.hint}"}
    else:
        assert not report.ok
        found = {f["kind"]: f["message"] for f in report.findings if f["severity"] == "error"}
    assert list(found) == [kind]
    assert words in found[kind]
