"""Levels, spirals and rows by scallop: what is measured of their texts, and what is found in them."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from styluscam.judging.results import Scallops

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
ASKED = 0.05
TOLERANCE = 0.002


def job(part: str, operation: dict[str, Any], *, sheet: bool = True) -> sc.Job:
    """A job of one operation with a ball of 10 mm, on a sheet of 1 mm, or milling."""
    document: dict[str, Any] = {
        "schema": 1,
        "part": {"file": str(FIXTURES / f"{part}.step"), "tolerance": 0.0005},
        "process": {"kind": "spif" if sheet else "milling"},
        "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}}},
        "machine": {"name": "linuxcnc"},
        "operations": [
            {
                "tool": "ball",
                "tolerance": TOLERANCE,
                "feeds": {"cut": 1000.0, "plunge": 200.0},
                "spindle": {"mode": "fixed", "rpm": 8000.0},
                **operation,
            }
        ],
    }
    if sheet:
        document["part"]["model_face"] = "tool"
        document["setup"] = {"sheet": {"thickness": 1.0}}
    return sc.Job.from_dict(document)


def verified(asked: sc.Job) -> sc.Report:
    report = sc.verify(sc.post(sc.plan(asked), "linuxcnc"), asked)
    assert report.ok and not report.findings, [finding.message for finding in report.findings]
    return report


def scallops(report: sc.Report) -> Scallops:
    (found,) = report.scallops(count=4000)
    assert len(found.heights) > 1000
    return found


def share_on_wall(found: Scallops) -> float:
    """The share of scallops on the wall between rim and fillet that are at least 0.8 of the one asked for."""
    on_wall = (found.points[:, 2] > -15.0) & (found.points[:, 2] < -3.0)
    return float((found.heights[on_wall] >= 0.8 * ASKED).mean())


@pytest.mark.parametrize(("part", "share"), [("cone_cup", 0.95), ("pyramid", 0.85)])
def test_levels_leave_the_scallop_that_is_asked_for(part: str, share: float) -> None:
    """Of the pyramid's ridges the lowest are lower: between its fillet, hardly wider than the tool, and its floor."""
    operation = {"kind": "z-level", "step": {"scallop": ASKED}, "step_min": 0.01}
    found = scallops(verified(job(part, operation)))
    assert found.highest <= 1.02 * ASKED
    assert share_on_wall(found) >= 0.95
    assert found.share_within(0.8 * ASKED, ASKED) >= share


def test_a_spiral_leaves_no_more() -> None:
    found = scallops(verified(job("cone_cup", {"kind": "spiral", "step": {"scallop": ASKED}, "step_min": 0.01})))
    assert found.highest <= 1.02 * ASKED
    assert share_on_wall(found) >= 0.95


def test_rows_lie_closer_where_the_scallop_asks_for_it() -> None:
    operation = {"kind": "zig-zag", "stepover": 3.0, "scallop": 0.02, "angle_deg": 20.0}
    found = scallops(verified(job("cap_r60", operation, sheet=False)))
    assert found.share_within(0.0, 1.02 * 0.02) >= 0.995
    assert found.share_within(0.8 * 0.02, 0.02) >= 0.6
    assert found.steps.min() < 0.7 * found.steps.max()


def test_a_level_that_is_missing_is_a_scallop() -> None:
    asked = job("cone_cup", {"kind": "z-level", "step": {"scallop": ASKED}})
    text = next(iter(sc.post(sc.plan(asked), "linuxcnc").files.values()))
    levels = sorted({float(z) for z in re.findall(r"Z(-\d+\.\d+)", text)})
    gone = levels[len(levels) // 2]
    lines = text.splitlines()
    first = next(i for i, line in enumerate(lines) if f"Z{gone:.4f}".rstrip("0") in line or f"Z{gone}" in line)
    rest = next(i for i, line in enumerate(lines[first + 1 :], first + 1) if re.search(r"Z-?\d", line))
    report = sc.verify("\n".join(lines[:first] + lines[rest:]), asked)
    assert "scallop" in {finding.kind for finding in report.findings if finding.severity == "error"}


def test_steps_by_list_count_from_the_sheet() -> None:
    steps = [0.25, 0.5, 1.0]
    report = verified(job("cone_cup", {"kind": "z-level", "step": {"list": steps}}))
    posted = {round(float(z), 3) for z in re.findall(r"Z(-\d+\.\d+)", report.text)}
    assert {-0.25, -0.75, -1.75, -2.75, -3.75} <= posted
    assert not {-0.5, -1.0, -1.25, -2.0} & posted
    evenly = job("cone_cup", {"kind": "z-level", "step": {"list": [0.5]}})
    against = sc.verify(report.text, evenly)
    assert "missing-level" in {finding.kind for finding in against.findings}


def terraces(folder: Path) -> Path:
    """A hill with a shoulder: walls of 45 degrees from Z-3 to a level shoulder at Z-1.3, and on to a top at Z0."""
    rings = [(16.0, -3.0), (14.3, -1.3), (10.0, -1.3), (8.7, 0.0)]
    corners = [(x * half, y * half, z) for half, z in rings for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    triangles = [(12, 13, 14), (12, 14, 15)]
    for ring in range(3):
        for i in range(4):
            a, b = 4 * ring + i, 4 * ring + (i + 1) % 4
            triangles += [(a, b, b + 4), (a, b + 4, a + 4)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    path = folder / "terraces.obj"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def levels_of(report: sc.Report) -> list[float]:
    """Heights at which the tip goes 40 mm or more in all, from the top down."""
    ends = report.program.moves["end"]
    lengths: dict[float, float] = {}
    for start, end in pairwise(ends):
        if start[2] == end[2]:
            lengths[float(end[2])] = lengths.get(float(end[2]), 0.0) + math.dist(start, end)
    return sorted((z for z, length in lengths.items() if length >= 40.0), reverse=True)


@pytest.mark.parametrize("at_flats", [False, True])
def test_a_level_stands_on_every_floor_if_that_is_asked_for(at_flats: bool, tmp_path: Path) -> None:
    asked = {"kind": "z-level", "step": {"height": 1.0}, "levels_at_flats": at_flats, "tolerance": TOLERANCE}
    document = job("cone_cup", asked, sheet=False).to_dict()
    document["part"] = {"file": str(terraces(tmp_path)), "units": "mm"}
    asked_job = sc.Job.from_dict(document)
    report = verified(asked_job)
    on_shoulder = [z for z in levels_of(report) if -1.3 <= z <= -1.29]
    assert len(on_shoulder) == int(at_flats), levels_of(report)


@pytest.mark.parametrize("step", [{"list": [100.0]}, {"height": 25.0}, {"list": [1.0, 8.0]}])
def test_no_step_lets_the_tool_punch_the_sheet(step: dict[str, Any]) -> None:
    asked = job("cone_cup", {"kind": "z-level", "step": step})
    report = sc.verify(sc.post(sc.plan(asked)), asked)
    assert "punch" in {finding.kind for finding in report.findings if finding.severity == "error"}


@pytest.mark.parametrize("fit", ["lines", "arcs"])
def test_turns_between_two_steps_of_a_list_punch_nothing(fit: str) -> None:
    verified(job("cone_cup", {"kind": "spiral", "step": {"list": [1.0, 2.0, 1.5]}, "fit": fit}))


def test_a_spindle_rolls_along_levels_of_any_step() -> None:
    rolling = {"direction": "same", "spindle": {"mode": "rolling"}}
    verified(job("cone_cup", {"kind": "z-level", "step": {"list": [1.0, 2.0]}, **rolling}))


@pytest.mark.parametrize(
    ("operation", "where", "message"),
    [
        ({"kind": "z-level", "step": {"list": []}}, "operations[0].step.list", "no step"),
        ({"kind": "z-level", "step": {"list": [0.5] * 1001}}, "operations[0].step.list", "at most 1000"),
        ({"kind": "z-level", "step": {"list": [0.5, 0.0]}}, "operations[0].step.list", "allowed is"),
        ({"kind": "z-level", "step": {"height": 0.5}, "step_min": 0.1}, "operations[0].step_min", "scallop"),
        (
            {"kind": "spiral", "step": {"scallop": 0.01}, "step_min": 2.0, "step_max": 1.0},
            "operations[0].step_min",
            "above",
        ),
        ({"kind": "zig-zag", "stepover": 1.0, "stepover_min": 0.1}, "operations[0].stepover_min", "scallop"),
        (
            {"kind": "zig-zag", "stepover": 1.0, "scallop": 0.01, "stepover_min": 2.0},
            "operations[0].stepover_min",
            "above",
        ),
    ],
)
def test_steps_that_contradict_each_other_are_refused(operation: dict[str, Any], where: str, message: str) -> None:
    with pytest.raises(sc.JobError, match=message) as refused:
        job("cone_cup", operation)
    assert refused.value.where == where


def test_a_count_below_one_is_refused() -> None:
    report = verified(job("cone_cup", {"kind": "z-level", "step": {"height": 2.0}}))
    with pytest.raises(sc.GeometryError, match="at least 1"):
        report.scallops(count=0)
