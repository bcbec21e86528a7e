"""Climb and conventional: on which side of the tool the material stands."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc

SPINDLE = {"mode": "fixed", "rpm": 8000.0}
COUNTER = {**SPINDLE, "direction": "counterclockwise"}


def boss() -> sc.Part:
    """A block of 20 x 20 x 10 mm on a plate of 60 x 60 mm, its walls leaning by 45 degrees."""
    rings = [(30.0, 0.0), (20.0, 0.0), (10.0, 10.0)]
    vertices = np.array([(x * r, y * r, z) for r, z in rings for x, y in [(1, 1), (-1, 1), (-1, -1), (1, -1)]])
    walls = [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    others = [(4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    return sc.Part.from_mesh(vertices, np.array([*walls, *others, (8, 9, 10), (8, 10, 11)]))


def job(kind: dict[str, Any], direction: str, spindle: dict[str, Any] | None = None) -> sc.Job:
    operation = {**kind, "tool": "ball", "direction": direction, "spindle": spindle or SPINDLE}
    document = {
        "schema": 1,
        "part": {"file": "boss.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 4.0}}},
        "operations": [operation],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=boss())


LEVELS = {"kind": "z-level", "step": {"height": 2.0}, "z_bottom": 0.5}
ROWS = {"kind": "zig-zag", "stepover": 2.0}


def turning(of: sc.Job) -> set[float]:
    """The senses of the loops about the boss: 1 counterclockwise."""
    moves = sc.plan(of).programs["main"].moves
    feeds = moves[moves["kind"] == 1]
    levels = [feeds[np.abs(feeds["end"][:, 2] - z) < 1e-9]["end"][:, :2] for z in np.unique(feeds["end"][:, 2])]
    area = [(loop[:-1, 0] * loop[1:, 1] - loop[:-1, 1] * loop[1:, 0]).sum() for loop in levels if len(loop) > 4]
    return {float(np.sign(one)) for one in area}


def test_climb_keeps_the_material_on_the_right_of_a_clockwise_tool() -> None:
    assert turning(job(LEVELS, "climb")) == {-1.0}  # clockwise round a boss: it stands on the right
    assert turning(job(LEVELS, "conventional")) == {1.0}
    assert turning(job(LEVELS, "climb", COUNTER)) == {1.0}
    assert turning(job(LEVELS, "conventional", COUNTER)) == {-1.0}
    assert turning(job(LEVELS, "alternate")) == {-1.0, 1.0}
    assert turning(job(LEVELS, "same")) == {-1.0}


def along(of: sc.Job) -> float:
    """How far the passes at feed go along X in all, less what they go back, as a share."""
    moves = sc.plan(of).programs["main"].moves
    ends = moves["end"]
    feeds = np.flatnonzero((moves["kind"] == 1) & (np.roll(moves["kind"], 1) == 1))
    steps = (ends[feeds] - ends[feeds - 1])[:, 0]
    return float(steps.sum() / np.abs(steps).sum())


def test_rows_leave_the_material_on_the_right_in_climb() -> None:
    # they go on towards +Y: what stands is on the left of +X, and on the right of -X
    assert along(job(ROWS, "climb")) < -0.9
    assert along(job(ROWS, "conventional")) > 0.9
    assert along(job(ROWS, "climb", COUNTER)) > 0.9


@pytest.mark.parametrize("direction", ["climb", "conventional"])
@pytest.mark.parametrize("kind", [LEVELS, ROWS])
def test_programs_verify(kind: dict[str, Any], direction: str) -> None:
    of = job(kind, direction)
    report = sc.verify(sc.post(sc.plan(of)), of)
    assert report.ok, [one["message"] for one in report.findings]


def test_a_tool_that_stands_neither_climbs_nor_not() -> None:
    with pytest.raises(sc.JobError, match="the spindle is off") as error:
        job(LEVELS, "climb", {"mode": "off"})
    assert error.value.where == "operations[0].direction"


def test_a_spiral_runs_one_way() -> None:
    spiral = {"kind": "spiral", "step": {"height": 2.0}, "z_bottom": 0.5}
    assert job(spiral, "climb")
    with pytest.raises(sc.JobError, match="higher ground on its right"):
        job(spiral, "conventional")
    with pytest.raises(sc.JobError, match="higher ground on its right"):
        job(spiral, "climb", COUNTER)
