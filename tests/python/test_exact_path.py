"""The posted path against the exact envelope: read back from the text, at its vertices and between them."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from conftest import CELL, Floats, box, job_document, made_part, milling_document, together

import styluscam as sc
from meridian import Meridian
from styluscam.programs.program import FEED, RAPID

SHEET = 1.0
LOWEST, HIGHEST = -0.001, 0.005
"""Where the posted path may lie along the exact envelope's normal, mm."""


@pytest.fixture(scope="session")
def planned(part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]) -> Callable[..., sc.Plan]:
    """Plans a coarse job, each once."""

    @lru_cache(maxsize=32)
    def plan(part: str, kind: str, tool: str, machine: str = "linuxcnc") -> sc.Plan:
        document = job_document(part, kind, meridian_of(part).document["tools"][tool], machine=machine)
        return sc.plan(sc.Job.from_dict(document, part=part_of(part)))

    return plan


def cutting(program: sc.Program) -> tuple[Floats, Floats]:
    """From and to (N, 3) of the moves along the surface: at feed, and not the plunge that follows a rapid."""
    kinds, ends = program.moves["kind"], program.moves["end"]
    cuts = np.flatnonzero((kinds[1:] == FEED) & (kinds[:-1] == FEED)) + 1
    return ends[cuts - 1], ends[cuts]


def clearances(program: sc.Program, meridian: Meridian, tool: str) -> dict[float, Floats]:
    """Distance from the exact envelope along its normal, by share of the path along each move."""
    begins, ends = cutting(program)
    top = meridian.document["box"][1][2] + SHEET
    found = {}
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        tips = begins + share * (ends - begins) + [0.0, 0.0, top]
        found[share] = meridian.envelope(tips[:, :2], tool, "constant").clearance(tips[:, 2])
    return found


@pytest.mark.parametrize("machine", ("linuxcnc", "grbl"))
@pytest.mark.parametrize("tool", ("ball-10", "clothoid-10"))
@pytest.mark.parametrize("kind", ("z-level", "zig-zag"))
@pytest.mark.parametrize("part", ("cone_cup", "cap_r60", "vwaf"))
def test_posted_path_lies_within_1_under_and_5_over(
    part: str,
    kind: str,
    tool: str,
    machine: str,
    planned: Callable[..., sc.Plan],
    meridian_of: Callable[[str], Meridian],
) -> None:
    plan = planned(part, kind, tool, machine)
    read = sc.read_gcode(sc.post(plan).text, plan.machine)
    found = clearances(read, meridian_of(part), tool)
    assert len(found[0.0]) > 500
    for share, clearance in found.items():
        assert clearance.min() > LOWEST, share
        assert clearance.max() < HIGHEST, share
    # half a unit of the posted last digit between the program and its text, which begins by going up
    wanted = plan.programs["main"].positions
    assert (read.moves["kind"][: -len(wanted)] == RAPID).all()
    assert np.abs(read.positions[-len(wanted) :] - wanted).max() <= 0.5 * plan.machine.resolution_mm + 1e-12


def test_a_moved_path_is_off_the_envelope(
    planned: Callable[..., sc.Plan], meridian_of: Callable[[str], Meridian]
) -> None:
    meridian = meridian_of("cone_cup")
    tips = np.concatenate(cutting(planned("cone_cup", "z-level", "ball-10").programs["main"]))
    tips[:, 2] += meridian.document["box"][1][2] + SHEET
    for shift, bad in ((0.0, 0), (-0.006, -1), (0.009, 1)):
        clearance = meridian.envelope(tips[:, :2], "ball-10", "constant").clearance(tips[:, 2] + shift)
        assert (clearance.min() <= LOWEST) == (bad < 0)
        assert (clearance.max() >= HIGHEST) == (bad > 0)


@pytest.mark.parametrize("machine", ("linuxcnc", "grbl"))
def test_a_run_writes_the_text_that_was_verified(
    machine: str, tmp_path: Path, part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]
) -> None:
    document = job_document("cone_cup", "z-level", {"kind": "clothoid", "diameter": 10.0}, machine=machine)
    result = sc.run(sc.Job.from_dict(document, folder=tmp_path, part=part_of("cone_cup")))
    assert result.report.ok
    assert result.report.gouge_max < -LOWEST
    assert sorted(result.written) == sorted(tmp_path.iterdir())
    gcode = next(path for path in result.written if path.suffix == ".ngc")
    assert gcode.read_text() == result.posted.text
    read = sc.read_gcode(gcode.read_text(), result.plan.machine)
    for clearance in clearances(read, meridian_of("cone_cup"), "clothoid-10").values():
        assert clearance.min() > LOWEST
        assert clearance.max() < HIGHEST
    # the verifier looked at the same path: its figures are those of these probes
    assert result.summary["excess_max"] < HIGHEST
    assert sc.Program.load(next(p for p in result.written if p != gcode)).engine.same_moves(
        result.plan.engine.programs["main"]
    )


# --- bridged positions ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tool", ("ball-10", "clothoid-10"))
@pytest.mark.parametrize("part", ("cone_cup", "cap_r60", "vwaf"))
def test_bridged_positions_have_the_exact_gap(
    part: str, tool: str, planned: Callable[..., sc.Plan], meridian_of: Callable[[str], Meridian]
) -> None:
    answers = [b for b in meridian_of(part).document["bridges"] if b["tool"] == tool and b["sheet"] == "constant"]
    summary, _ = planned(part, "z-level", tool).summary()
    (operation,) = summary["operations"]
    exact = max(b["gap_normal"] for b in answers)
    if exact <= HIGHEST:
        assert operation["bridged"] == []
        return
    worst = operation["bridged"][0]
    assert worst["excess"] == pytest.approx(exact, rel=0.05, abs=0.002)
    (position,) = [b["gap_normal_at"] for b in answers if b["gap_normal"] == exact]
    x, y, z = worst["at"]
    assert np.hypot(x, y) == pytest.approx(position["d"], abs=1.5)
    assert z + meridian_of(part).document["box"][1][2] + SHEET == pytest.approx(position["z"], abs=1.5)


# --- waterlines -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("part", ("cone_cup", "cap_r60", "vwaf", "pyramid"))
def test_waterlines_are_circles_of_the_exact_radius(
    part: str, part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]
) -> None:
    meridian = meridian_of(part)
    for entry in meridian.document["waterlines"]:
        if (entry["tool"], entry["sheet"]) not in (("ball-6", "none"), ("clothoid-10", "constant")):
            continue
        tool = sc.Tool.from_dict({"profile": meridian.document["tools"][entry["tool"]]})
        for level in entry["levels"][2 if entry["sheet"] == "none" else 4 :: 9]:
            loops = sc.waterline(part_of(part), tool, level["z"], meridian.document["sheets"][entry["sheet"]])
            # others run round the block
            (loop,) = (found for found in loops if np.abs(found[:, :2]).max() < meridian.document["box"][1][0])
            assert (loop[0] == loop[-1]).all()
            assert (loop[:, 2] == level["z"]).all()
            steps = np.linspace(0.0, 1.0, 5)[:-1, None, None]
            tips = (loop[:-1] + steps * (loop[1:] - loop[:-1])).reshape(-1, 3)
            clearance = meridian.envelope(tips[:, :2], entry["tool"], entry["sheet"]).clearance(tips[:, 2])
            assert clearance.min() > -1e-6, level["z"]
            assert clearance.max() < 0.005, level["z"]
            # where nothing is bridged the slope is known, and with it the radius
            slope = np.radians(level["contacts"][0]["slope_deg"])
            off = (meridian.distance(loop[:, :2]) - level["d"]) * np.sin(slope)
            assert np.abs(off).max() < 0.005
            # counterclockwise inside a cup, clockwise round a hill: the higher ground on the right
            assert np.sign(area(loop)) == (-1 if part == "cap_r60" else 1)


def area(loop: Floats) -> float:
    """Signed area in plan, positive counterclockwise, mm^2."""
    x, y = loop[:, 0], loop[:, 1]
    return float(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


# --- levels -----------------------------------------------------------------------------------------------------


def level_runs(program: sc.Program) -> list[Floats]:
    """Stretches of the path at one height, in order."""
    begins, ends = cutting(program)
    flat = begins[:, 2] == ends[:, 2]
    runs: list[list[Floats]] = []
    last = None
    for begin, end in zip(begins[flat], ends[flat], strict=True):
        if last is None or (last != begin).any():
            runs.append([begin])
        runs[-1].append(end)
        last = end
    return [np.array(run) for run in runs if len(run) > 4]


@pytest.mark.parametrize("direction", ("alternate", "same"))
def test_levels_go_down_by_half_millimetres_to_the_floor(direction: str, part_of: Callable[[str], sc.Part]) -> None:
    document = job_document(
        "cone_cup", "z-level", {"kind": "ball", "diameter": 10.0}, step={"height": 0.5}, direction=direction
    )
    program = sc.plan(sc.Job.from_dict(document, part=part_of("cone_cup"))).programs["main"]
    loops = level_runs(program)
    heights = [loop[0, 2] for loop in loops]
    assert heights == sorted(heights, reverse=True)
    assert len(set(heights)) == len(heights) == 50
    # zero is the sheet's top, and so is the rim's; the last one stands just above the floor
    assert np.allclose(heights[:-1], -0.5 * np.arange(1, 50), atol=1e-9)
    assert -25.0 < heights[-1] < -25.0 + HIGHEST
    for loop in loops:
        assert (loop[0] == loop[-1]).all()
    turns = np.sign([area(loop) for loop in loops])
    assert (turns == ([1, -1] * 25 if direction == "alternate" else [1] * 50)).all()


def test_rows_alternate(planned: Callable[..., sc.Plan]) -> None:
    begins, ends = cutting(planned("cap_r60", "zig-zag", "ball-10").programs["main"])
    along, across = np.array([np.cos(np.pi / 6), 0.5]), np.array([-0.5, np.cos(np.pi / 6)])
    step = (ends - begins)[:, :2]
    in_row = np.abs(step @ across) < 0.002
    row = np.round(begins[in_row, :2] @ across, 1)  # rows for a strip between two others are rows as well
    sense = np.sign(step[in_row] @ along)
    # as they are followed: a row, or its stretch on one side of what keeps the tool off, until another begins
    firsts = np.flatnonzero(np.diff(row, prepend=np.inf) != 0.0)
    followed = [(row[i], sense[i]) for i in firsts]
    pitch = np.median(np.abs(np.diff([r for r, _ in followed])))
    beside = [(a, b) for a, b in itertools.pairwise(followed) if abs(a[0] - b[0]) < 1.5 * pitch]
    assert len(beside) > 30 and len(beside) > 0.9 * len(followed)
    assert all(a[1] == -b[1] for a, b in beside)


def test_no_loop_is_lost_above_the_smallest_feature() -> None:
    wall, depth, ball = 70.0, 3.0, 1.0
    rng = np.random.default_rng(5)
    sizes = np.linspace(1.02, 2.8, 64)
    rng.shuffle(sizes)
    # a plane wall at slope a stands off a ball's tip, level with it, by R (1/sin a - 1/tan a) in plan
    a = np.radians(wall)
    off = 0.5 * ball * (1 / np.sin(a) - 1 / np.tan(a))
    # pits: the loop at half depth holds a disc of `sizes`; bumps need not be as large
    pits = np.arange(64) % 2 == 1
    half = np.where(pits, 0.5 * sizes + off, 0.5 * sizes)
    half = np.maximum(half, 0.5 * depth / np.tan(a) + 0.01)
    free = 0.5 * CELL - half - 0.5 * depth / np.tan(a) - 0.05
    shifts = rng.uniform(-1.0, 1.0, (64, 2)) * np.minimum(free, 0.6)[:, None]
    part = sc.Part.from_mesh(*made_part(8, half, shifts, depth, wall))
    document = milling_document(
        "z-level",
        {"kind": "ball", "diameter": ball},
        step={"height": 3.0},
        z_top=4.5,
        z_bottom=-1.5,
        smallest_feature=1.0,
    )
    runs = level_runs(sc.plan(sc.Job.from_dict(document, part=part)).programs["main"])
    loops = [run for run in runs if (run.min(axis=0) > 0.0)[:2].all() and (run.max(axis=0)[:2] < 8 * CELL).all()]
    middles = CELL * (np.stack([np.arange(64) % 8, np.arange(64) // 8], axis=1) + 0.5) + shifts
    for height, wanted in ((1.5, middles[~pits]), (-1.5, middles[pits])):
        found = np.array([0.5 * (loop.min(axis=0) + loop.max(axis=0))[:2] for loop in loops if loop[0, 2] == height])
        assert len(found) == 32, height
        distances = np.linalg.norm(found[:, None] - wanted[None], axis=2)
        assert (distances.min(axis=0) < 0.01).all()


def test_a_level_at_a_floor_goes_round_what_stands_on_it() -> None:
    """Steps of 2.5 mm from the top of a boss meet the floor that it stands on, and pass just over it."""
    part = sc.Part.from_mesh(*together(box([0, 0, -10], [40, 40, 0]), box([15, 15, 0], [25, 25, 5])))
    document = milling_document("z-level", {"kind": "flat", "diameter": 4.0}, step={"height": 2.5}, z_bottom=-5.0)
    runs = level_runs(sc.plan(sc.Job.from_dict(document, part=part)).programs["main"])
    (round_boss,) = [run for run in runs if abs(run[0, 2]) < 1.0]
    assert 0.0 < round_boss[0, 2] < 0.006
    assert np.ptp(round_boss, axis=0)[:2] == pytest.approx([14.0, 14.0], abs=0.01)


def test_the_tool_does_not_roll_over_the_border_of_an_open_surface() -> None:
    part = sc.Part.from_mesh([[0, 0, 0], [20, 0, 0], [20, 20, 0], [0, 20, 0]], [[0, 1, 2], [0, 2, 3]])
    ball = {"kind": "ball", "diameter": 4.0}
    rows = milling_document("zig-zag", ball, stepover=5.0, angle_deg=0.0)
    begins, ends = cutting(sc.plan(sc.Job.from_dict(rows, part=part)).programs["main"])
    assert min(begins[:, 2].min(), ends[:, 2].min()) > LOWEST
    levels = milling_document("z-level", ball, step={"height": 0.5}, z_top=0.0, z_bottom=-1.5)
    with pytest.raises(sc.PlanError):
        sc.plan(sc.Job.from_dict(levels, part=part))


def test_the_tool_is_carried_over_the_part_at_clearance_height(planned: Callable[..., sc.Plan]) -> None:
    program = planned("cone_cup", "zig-zag", "ball-10").programs["main"]
    kinds, ends = program.moves["kind"], program.moves["end"]
    across = np.flatnonzero((kinds[1:] == RAPID) & (np.linalg.norm(np.diff(ends[:, :2], axis=0), axis=1) > 1e-9)) + 1
    assert (ends[across, 2] == program.setup["clearance"]).all()
    assert program.setup["clearance"] == pytest.approx(10.0)
    assert kinds[0] == RAPID
    assert kinds[-1] == RAPID
