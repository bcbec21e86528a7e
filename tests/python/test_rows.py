"""Rows of `zig-zag`: turns from row to row without a corner, on the faces or off the part, and what is found in spoiled ones."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
CHORD = 10.0
"""Largest angle between chords of a turn, degrees."""

TOLERANCE = 0.01
ROUNDED = {"turns": "rounded"}
LOOPED = {"turns": "looped", "turn_radius": 1.5}


FACES = {"cone_cup": ["Face1", "Face2", "Face3", "Face4"], "vwaf": ["Face1", "Face2", "Face3"]}


def job(part: str, machine: str = "linuxcnc", faces: Any = None, **keys: Any) -> sc.Job:
    """Rows 2 mm apart over the cups and walls of a part, or the faces that are named."""
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / f"{part}.step"), "faces": faces or FACES.get(part, "all")},
            "process": {"kind": "milling"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}}},
            "machine": {"name": machine},
            "operations": [
                {
                    "kind": "zig-zag",
                    "tool": "ball",
                    "stepover": 2.0,
                    "tolerance": TOLERANCE,
                    "spindle": {"mode": "fixed", "rpm": 8000.0},
                    **keys,
                }
            ],
        }
    )


def facts(plan: sc.Plan) -> dict[str, float]:
    return {fact.fact: fact.value for fact in plan.summary()[0].operations[0].facts}


def corners(plan: sc.Plan) -> np.ndarray:
    """Angles in plan between one feed move and the next, degrees, along what is no plunge; without links back along a row, to
    another stretch of it."""
    moves = plan.programs["main"].moves
    steps = np.diff(moves["end"][:, :2], axis=0)
    feeds = (moves["kind"][1:] != 0) & (np.hypot(*steps.T) > 1e-9)
    both = feeds[:-1] & feeds[1:]
    a, b = steps[:-1][both], steps[1:][both]
    cross, dot = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1)
    angles: np.ndarray = np.degrees(np.abs(np.arctan2(cross, dot)))
    return angles[angles < 179.9]


def verified(asked: sc.Job) -> tuple[sc.Plan, str]:
    plan = sc.plan(asked)
    posted = sc.post(plan)
    report = sc.verify(posted, asked)
    assert report.ok and not report.findings, [finding.message for finding in report.findings]
    assert report.gouge_max <= 0.001 and report.excess_max <= TOLERANCE
    return plan, posted.text


@pytest.mark.parametrize(
    ("part", "angle", "turns"),
    [
        ("cone_cup", 20.0, ROUNDED),
        ("vwaf", 20.0, ROUNDED),
        ("pyramid", 0.0, LOOPED),
        ("cap_r60", 0.0, LOOPED),
    ],
)
def test_turns_have_no_corner_and_stay_on_the_faces_or_off_the_part(part: str, angle: float, turns: Any) -> None:
    plan, _ = verified(job(part, angle_deg=angle, stepover=3.0, **turns))
    found = facts(plan)
    assert found["turns"] > 15 and found["straight_turns"] == 0
    # where ends lie too far apart the tool goes over clearance
    assert corners(plan).max() <= CHORD + 0.5
    straight = corners(sc.plan(job(part, angle_deg=angle, stepover=3.0)))
    assert (straight > 45.0).sum() > 15


@pytest.mark.parametrize(("turns", "radius"), [(ROUNDED, 1.0), (LOOPED, 1.5)], ids=["rounded", "looped"])
def test_turns_have_their_radius(turns: dict[str, Any], radius: float) -> None:
    """At a border across the rows, which end side by side there."""
    plan, _ = verified(job("pyramid", "grbl", faces="all", **turns))
    ends = plan.programs["main"].moves["end"]
    steps = np.diff(ends[:, :2], axis=0)
    heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    turning, lengths = np.diff(heading), np.hypot(*steps.T)
    on_arc = (np.abs(turning) > np.radians(3.0)) & (np.abs(lengths[:-1] - lengths[1:]) < 1e-6) & (lengths[1:] > 0.01)
    radii = lengths[1:][on_arc] / (2.0 * np.sin(0.5 * np.abs(turning[on_arc])))
    assert on_arc.sum() > 200
    # rows that were added between others lie closer
    assert (np.abs(radii - radius) < 1e-3).mean() > 0.9


def test_where_the_text_has_no_remarks_no_turn_leaves_the_faces() -> None:
    document = job("cone_cup", **LOOPED).to_dict()
    document["machine"]["options"] = {"comments": False}
    plan, _ = verified(sc.Job.from_dict(document))
    found = facts(plan)
    assert found["turns"] + found["straight_turns"] > 15 and found["straight_turns"] > found["turns"]


def test_spoiled_turns_are_found() -> None:
    asked = job("cone_cup", **ROUNDED)
    _, text = verified(asked)
    lines = text.splitlines()
    level = r"X\S+ Y\S+"  # at the rim, which is level
    turn = next(
        number
        for number in range(len(lines) // 2, len(lines))
        if all(re.fullmatch(level, line) for line in lines[number - 1 : number + 3])
    )
    height = float(re.findall(r"Z(-?[\d.]+)", "\n".join(lines[:turn]))[-1])
    for by, finding in ((-0.05, "gouge"), (0.05, "excess")):
        moved = [f"{lines[turn]} Z{height + by:.4f}", f"{lines[turn + 1]} Z{height:.4f}"]
        report = sc.verify("\n".join([*lines[:turn], *moved, *lines[turn + 2 :]]) + "\n", asked)
        assert finding in {one.kind for one in report.findings}


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"turns": "looped"}, "looped turns have a radius"),
        ({"turns": "rounded", "turn_radius": 2.0}, "radius of looped turns"),
    ],
)
def test_a_radius_belongs_to_loops(keys: dict[str, Any], words: str) -> None:
    with pytest.raises(sc.JobError, match=words):
        sc.plan(job("pyramid", **keys))


CROSS = {"cross": True, "angle_deg": 20.0, "cross_angle_deg": 60.0}


def without_row(text: str, angle_deg: float) -> str:
    """A text without one of the rows in a direction, near the part's middle: the tool goes over it at clearance."""
    moves = sc.read_gcode(text, "linuxcnc").moves
    across = np.array([-np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))])
    value = moves["end"][:, :2] @ across
    feeds = moves["kind"][1:] != 0
    along = np.flatnonzero(feeds & (np.abs(np.diff(value)) < 2e-3) & (np.abs(value[1:]) < 20.0)) + 1
    rows = [row for row in np.split(along, np.flatnonzero(np.diff(along) > 1) + 1) if len(row) > 20]
    row = min(rows, key=lambda row: abs(value[row[0]]))
    first, last = moves["line"][row[0]], moves["line"][row[-1]]
    lines = text.splitlines()
    x, y, z = moves["end"][row[-1]]
    over = ["G0 Z30.", f"X{x:.3f} Y{y:.3f}", f"Z{z + 1.0:.3f}", f"G1 Z{z:.3f} F300.", "F1500."]
    return "\n".join([*lines[: first - 1], *over, *lines[last:]]) + "\n"


@pytest.mark.parametrize(
    ("part", "turns"),
    [("cap_r60", {}), ("cone_cup", ROUNDED)],
    ids=["straight", "rounded"],
)
def test_rows_cross_each_other_and_a_missing_one_of_either_set_is_found(part: str, turns: dict[str, Any]) -> None:
    asked = job(part, stepover=3.0, **CROSS, **turns)
    plan, text = verified(asked)
    single = sc.plan(job(part, stepover=3.0, angle_deg=20.0, **turns))
    assert facts(plan)["rows"] == pytest.approx(2 * facts(single)["rows"], abs=8)
    if turns:
        assert facts(plan)["turns"] > 1.5 * facts(single)["turns"] and corners(plan).max() <= CHORD + 0.5
    for angle in (20.0, 80.0):
        found = sc.verify(without_row(text, angle), asked).findings
        assert {one.kind for one in found} & {"missing-pass", "missing-row"}, (angle, [one.message for one in found])


def test_an_angle_between_sets_needs_two() -> None:
    with pytest.raises(sc.JobError, match="second set of rows"):
        sc.plan(job("pyramid", cross_angle_deg=45.0))


def test_an_operation_of_which_only_a_plunge_is_left_is_found() -> None:
    asked = job("cone_cup")
    lines = sc.post(sc.plan(asked)).text.splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("G1 Z"))
    last = max(number for number, line in enumerate(lines) if line.startswith("G0 Z"))
    text = "\n".join([*lines[: first + 1], *lines[last:], ""])
    found = sc.verify(text, asked).to_dict()["findings"]
    (missing,) = [finding for finding in found if finding["kind"] == "missing-pass"]
    assert missing["severity"] == "error" and "no feed of it goes across" in missing["message"]
