"""Where levels begin, and how the tool gets from one to the next: seams and ramps, planned, posted and verified."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.programs.program import ROLES
from styluscam.types import FloatArray

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
RAPID, RAMP = 0, ROLES.index("ramp")
STEP = 0.5
STYLUS = {"kind": "clothoid", "diameter": 10.0}


def job(part: str, **keys: Any) -> sc.Job:
    """A cup or pyramid of sheet, formed from inside."""
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {
                "file": str(FIXTURES / f"{part}.step"),
                "model_face": "back",
            },
            "setup": {"sheet": {"thickness": 1.0}},
            "process": {"kind": "spif"},
            "tools": {"t": {"number": 1, "profile": STYLUS}},
            "operations": [{"kind": "z-level", "tool": "t", "step": {"height": STEP}, **keys}],
            "machine": {"name": "linuxcnc"},
        }
    )


def loops(program: sc.Program) -> list[FloatArray]:
    """The tips (N,3) along each level, in their order; ramps and what is not level are left out."""
    found: list[list[FloatArray]] = []
    for move in program.moves:
        at = move["end"]
        if move["kind"] == RAPID or move["role"] == RAMP:
            continue
        if found and abs(found[-1][-1][2] - at[2]) < 1e-9:
            found[-1].append(at)
        else:
            found.append([at])
    return [np.array(loop) for loop in found if len(loop) > 3]


def bearing_deg(loop: FloatArray) -> float:
    """The direction from the middle of a loop's box to where it begins."""
    middle = (loop.min(axis=0) + loop.max(axis=0)) / 2.0
    away = loop[0] - middle
    return math.degrees(math.atan2(away[1], away[0]))


def apart_deg(a: float, b: float) -> float:
    return abs((a - b + 180.0) % 360.0 - 180.0)


def verified(asked: sc.Job) -> sc.Program:
    """Planned, posted, read back; nothing is found."""
    plan = sc.plan(asked)
    report = sc.verify(sc.post(plan), asked)
    assert report.ok and report.findings == []
    return plan.programs["main"]


@pytest.mark.parametrize("direction", ["alternate", "same"])
@pytest.mark.parametrize("part", ["cone_cup", "pyramid"])
def test_all_loops_begin_in_one_direction(part: str, direction: str) -> None:
    program = verified(job(part, seam_direction_deg=70.0, direction=direction))
    found = loops(program)
    assert len(found) > 30
    assert max(apart_deg(bearing_deg(loop), 70.0) for loop in found) < 0.1


def test_beginnings_are_spread() -> None:
    found = loops(verified(job("cone_cup", seam_direction_deg=10.0, seam_spread_deg=137.5)))
    expected = [10.0 + 137.5 * number for number in range(len(found))]
    assert max(apart_deg(bearing_deg(loop), at) for loop, at in zip(found, expected, strict=True)) < 0.1


@pytest.mark.parametrize("direction", ["alternate", "same"])
@pytest.mark.parametrize(("part", "angle"), [("cone_cup", 3.0), ("cone_cup", 20.0), ("pyramid", 5.0)])
def test_ramps_lead_from_level_to_level(part: str, angle: float, direction: str) -> None:
    """A ramp for each step, at the angle or flatter, strictly falling; the tool does not leave the sheet between them.

    Where a ramp cannot be followed the tool goes straight down the wall: at most once here.
    """
    program = verified(job(part, ramp_angle_deg=angle, direction=direction))
    moves = program.moves
    levels = len(loops(program))
    is_ramp = moves["role"] == RAMP
    starts = np.flatnonzero(is_ramp & ~np.roll(is_ramp, 1))
    assert levels - 2 <= len(starts) <= levels - 1
    ends = moves["end"]
    steps = np.diff(ends, axis=0)[is_ramp[1:]]
    assert (steps[:, 2] < 0.0).all()
    for start in starts:
        end = start + int(np.argmin(is_ramp[start:]))
        run = np.linalg.norm(np.diff(ends[start - 1 : end, :2], axis=0), axis=1).sum()
        fall = ends[start - 1, 2] - ends[end - 1, 2]
        assert fall / run <= 1.05 * math.tan(math.radians(angle))  # the loop above is longer than the one it comes to
    assert np.count_nonzero(moves["kind"] == RAPID) <= 3


def test_each_level_is_whole_with_ramps() -> None:
    moves = verified(job("cone_cup", ramp_angle_deg=3.0)).moves
    is_ramp = moves["role"] == RAMP
    arrivals = np.flatnonzero(is_ramp & ~np.roll(is_ramp, -1))
    assert len(arrivals) > 30
    for arrival in arrivals:
        begin = moves["end"][arrival]
        level = moves["end"][arrival + 1 :]
        leaves = int(np.argmax(np.abs(level[:, 2] - begin[2]) > 1e-9))
        assert level[leaves - 1] == pytest.approx(begin, abs=1e-9)


def test_a_level_that_is_left_out_between_ramps_is_found() -> None:
    asked = job("cone_cup", ramp_angle_deg=3.0, step={"height": 1.0})
    lines = sc.post(sc.plan(asked)).text.splitlines()
    ramps = [number for number, line in enumerate(lines) if "role ramp" in line]
    blocks = [number for i, number in enumerate(ramps) if i == 0 or number - ramps[i - 1] > 40]
    cut = [line for number, line in enumerate(lines) if not blocks[9] <= number < blocks[10]]
    report = sc.verify("\n".join(cut) + "\n", asked)
    assert not report.ok or report.findings != []


@pytest.mark.parametrize(
    ("keys", "where"),
    [
        ({"ramp_angle_deg": 0.0}, "operations[0].ramp_angle_deg"),
        ({"ramp_angle_deg": 60.0}, "operations[0].ramp_angle_deg"),
        ({"seam_direction_deg": 400.0}, "operations[0].seam_direction_deg"),
        ({"seam_spread_deg": "far"}, "operations[0].seam_spread_deg"),
    ],
)
def test_what_is_out_of_range_is_named(keys: dict[str, Any], where: str) -> None:
    with pytest.raises(sc.JobError) as caught:
        job("cone_cup", **keys)
    assert caught.value.where == where


def test_rows_have_no_ramps() -> None:
    with pytest.raises(sc.JobError) as caught:
        sc.Job.from_dict(
            {
                "schema": 1,
                "part": {"file": str(FIXTURES / "cap_r60.step")},
                "setup": {"zero": "model"},
                "process": {"kind": "milling"},
                "tools": {"t": {"number": 1, "profile": STYLUS}},
                "operations": [{"kind": "zig-zag", "tool": "t", "stepover": 0.5, "ramp_angle_deg": 3.0}],
                "machine": {"name": "linuxcnc"},
            }
        )
    assert caught.value.code == "foreign-key"
