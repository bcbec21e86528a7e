"""Waterlines of parts that are hard on them: notches, needles, boxes that overlap, rough ground."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from conftest import Floats, Mesh, box, made_part, together
from numpy.typing import NDArray

import styluscam as sc

TOOLS = [
    {"kind": "ball", "diameter": 5.0},
    {"kind": "clothoid", "diameter": 6.0},
    {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0},
    {"kind": "flat", "diameter": 4.0},
    {"kind": "cone", "diameter": 6.0, "half_angle_deg": 30.0, "tip_radius": 0.0},
]
TOLERANCE = 0.005


def pits_and_bumps(rng: np.random.Generator) -> Mesh:
    return made_part(4, 0.8 + 1.2 * rng.random(8), rng.normal(0, 0.3, (8, 2)), 2.0, 60.0)


def tetrahedra(rng: np.random.Generator) -> Mesh:
    middles = rng.uniform(-10, 10, (25, 1, 3)) * [1, 1, 0.05]
    vertices = (middles + rng.normal(0, 1.5, (25, 4, 3))).reshape(-1, 3)
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    return vertices, (4 * np.arange(25)[:, None, None] + faces).reshape(-1, 3)


def boxes(rng: np.random.Generator) -> Mesh:
    turns, sides = rng.uniform(0, 6, 15), rng.uniform(0.2, 4, (15, 2))
    ring = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * sides[:, None, :]
    cos, sin = np.cos(turns)[:, None], np.sin(turns)[:, None]
    plan = np.stack([cos * ring[..., 0] - sin * ring[..., 1], sin * ring[..., 0] + cos * ring[..., 1]], -1)
    plan += rng.uniform(-10, 10, (15, 1, 2))
    levels = [np.zeros((15, 4, 1)), np.broadcast_to(rng.uniform(0.2, 2, (15, 1, 1)), (15, 4, 1))]
    vertices = np.concatenate([np.concatenate([plan, z], -1) for z in levels], axis=1).reshape(-1, 3)
    walls = [[[i, (i + 1) % 4, 4 + (i + 1) % 4], [i, 4 + (i + 1) % 4, 4 + i]] for i in range(4)]
    faces = np.array([[4, 5, 6], [4, 6, 7], *np.concatenate(walls).tolist()])
    return vertices, (8 * np.arange(15)[:, None, None] + faces).reshape(-1, 3)


def rough_ground(rng: np.random.Generator) -> Mesh:
    count = 25
    u = np.linspace(-10, 10, count)
    x, y = np.meshgrid(u, u)
    vertices = np.stack([x, y, rng.normal(0, 0.6, x.shape)], -1).reshape(-1, 3)
    first = np.arange(count * count).reshape(count, count)[:-1, :-1].reshape(-1, 1)
    return vertices, np.concatenate([np.add(first, ring) for ring in ([0, 1, count + 1], [0, count + 1, count])])


KINDS: list[Callable[[np.random.Generator], Mesh]] = [pits_and_bumps, tetrahedra, boxes, rough_ground]


def drawn(
    kind: Callable[[np.random.Generator], Mesh], rng: np.random.Generator
) -> tuple[sc.Part, sc.Tool, Floats, Floats]:
    """A part of some kind, a tool, and the corners of the part's box."""
    vertices, triangles = kind(rng)
    tool = sc.Tool.from_dict({"profile": TOOLS[rng.integers(len(TOOLS))]})
    return sc.Part.from_mesh(vertices, triangles), tool, vertices.min(axis=0), vertices.max(axis=0)


def crossed(points: Floats, loops: list[Floats]) -> NDArray[np.int64]:
    """How often the ray from each point towards +X crosses the loops."""
    counts = np.zeros(len(points), dtype=np.int64)
    x, y = points.T[:, :, None]
    for loop in loops:
        (ax, ay), (bx, by) = loop[:-1, :2].T, loop[1:, :2].T
        between = (ay > y) != (by > y)
        at = ax + (y - ay) / np.where(by == ay, 1.0, by - ay) * (bx - ax)
        counts += (between & (x < at)).sum(axis=1)
    return counts


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("seed", range(3))
def test_loops_close_gouge_nothing_and_part_the_plan(kind: Callable[[np.random.Generator], Mesh], seed: int) -> None:
    rng = np.random.default_rng(seed)
    part, tool, low, high = drawn(kind, rng)
    heights = low[2] + (high[2] - low[2]) * np.array([0.013, 0.31, 0.62, 0.93])
    points = rng.uniform(low[:2] - 3, high[:2] + 3, (2000, 2))
    tips = np.nan_to_num(sc.drop_cutter(part, tool, points), nan=-np.inf)
    sheet = {"thickness": TOLERANCE, "law": "constant", "model_face": "back"}
    grown = np.nan_to_num(sc.drop_cutter(part, tool, points, sheet), nan=-np.inf)
    for z, loops in zip(heights, sc.waterlines(part, tool, heights, tolerance=TOLERANCE), strict=True):
        assert loops
        for loop in loops:
            assert (loop[0] == loop[-1]).all()
            share = np.linspace(0, 1, 8)[:, None, None]
            path = (loop[:-1] + share * np.diff(loop, axis=0)).reshape(-1, 3)
            assert (np.nan_to_num(sc.drop_cutter(part, tool, path[:, :2]), nan=-np.inf) <= z + 1e-9).all()
        is_inside = crossed(points, loops) % 2 == 1
        assert is_inside[tips > z + 1e-9].all()
        # free positions within the loops are within the tolerance of the level
        assert (grown[is_inside & (tips <= z)] > z - TOLERANCE).all()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("seed", range(3))
def test_points_lie_on_the_level_of_the_envelope(kind: Callable[[np.random.Generator], Mesh], seed: int) -> None:
    """The envelope that is half the tolerance clear of the part: to 1e-9 mm, beside a wall across it."""
    part, tool, low, high = drawn(kind, np.random.default_rng(seed))
    sheet = {"thickness": 0.5 * TOLERANCE, "law": "constant", "model_face": "back"}
    heights = low[2] + (high[2] - low[2]) * np.array([0.21, 0.52, 0.83])
    turns = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    about = np.concatenate([[[0.0, 0.0]], 1e-8 * np.stack([np.cos(turns), np.sin(turns)], -1)])
    for z, loops in zip(heights, sc.waterlines(part, tool, heights, tolerance=TOLERANCE), strict=True):
        points = np.concatenate(loops)[:, :2]
        tips = sc.drop_cutter(part, tool, (points[:, None] + about).reshape(-1, 2), sheet).reshape(len(points), -1)
        tips = np.nan_to_num(tips, nan=-np.inf)
        assert (tips.max(axis=1) >= z - 1e-9).all()
        assert (tips.min(axis=1) <= z + 2e-9).all()


@pytest.mark.parametrize("diameter", [1.5, 3.0, 5.0])
def test_acute_notches_are_followed(small_part: Mesh, diameter: float) -> None:
    part = sc.Part.from_mesh(*small_part)
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": diameter}})
    for loops in sc.waterlines(part, tool, np.linspace(0.05, 1.95, 20)):
        assert loops
        assert all((loop[0] == loop[-1]).all() for loop in loops)


@pytest.mark.parametrize("profile", TOOLS, ids=lambda profile: profile["kind"])
@pytest.mark.parametrize("off", [0.0, 1e4, 1e5])
def test_a_box_far_from_the_origin_keeps_its_loop(profile: dict[str, float], off: float) -> None:
    corners, sides = box([0.0, 0.0, 0.0], [20.0, 20.0, 10.0])
    tool = sc.Tool.from_dict({"profile": profile})
    near = sc.waterline(sc.Part.from_mesh(corners, sides), tool, 7.0)
    (loop,) = sc.waterline(sc.Part.from_mesh(np.add(corners, [off, -off, 0.0]), sides), tool, 7.0)
    assert (loop[0] == loop[-1]).all()
    assert len(near) == 1
    # the grid lies anew: as many points, but for one or two
    assert abs(len(loop) - len(near[0])) <= 2
    np.testing.assert_allclose(np.ptp(loop, axis=0), np.ptp(near[0], axis=0), atol=TOLERANCE)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, np.inf, 1.0])
def test_a_tolerance_that_is_none_is_refused(small_part: Mesh, tolerance: float) -> None:
    tool = sc.Tool.from_dict({"profile": TOOLS[0]})
    with pytest.raises(sc.PlanError, match="a tenth of the tool's diameter"):
        sc.waterline(sc.Part.from_mesh(*small_part), tool, 0.5, tolerance=tolerance)


def test_many_waterlines_are_those_of_single_calls(small_part: Mesh) -> None:
    part = sc.Part.from_mesh(*small_part)
    tool = sc.Tool.from_dict({"profile": TOOLS[1]})
    heights = [1.7, -0.6, 0.3]
    together = sc.waterlines(part, tool, heights)
    for z, loops in zip(heights, together, strict=True):
        single = sc.waterline(part, tool, z)
        assert [loop.tobytes() for loop in loops] == [loop.tobytes() for loop in single]
    assert sc.waterlines(part, tool, []) == []
    assert sc.waterlines(part, tool, [50.0]) == [[]]


@pytest.mark.parametrize("heights", [[np.nan], [0.0, np.inf], [1e300]])
def test_heights_are_finite(small_part: Mesh, heights: list[float]) -> None:
    tool = sc.Tool.from_dict({"profile": TOOLS[0]})
    with pytest.raises(sc.GeometryError, match="height within"):
        sc.waterlines(sc.Part.from_mesh(*small_part), tool, heights)


STEPPED = together(box([0.0, 0.0, 0.0], [40.0, 40.0, 10.0]), box([15.0, 15.0, 10.0], [25.0, 25.0, 15.0]))


@pytest.mark.parametrize("profile", TOOLS[:4], ids=lambda profile: str(profile["kind"]))
@pytest.mark.parametrize("over", [0.0, -1e-12, 1e-6, 0.4 * TOLERANCE, 0.6 * TOLERANCE])
def test_a_level_at_a_floor_runs_on_it(profile: dict[str, float], over: float) -> None:
    """Round the boss that stands on the floor, not round the floor; between the two heights the tool is free."""
    part, tool = sc.Part.from_mesh(*STEPPED), sc.Tool.from_dict({"profile": profile})
    (loop,) = sc.waterline(part, tool, 10.0 + over)
    assert (loop[0] == loop[-1]).all()
    assert (np.abs(loop[:, :2] - 20.0).max(axis=0) < 5.0 + 0.5 * tool.diameter + TOLERANCE).all()
    assert (loop[:, 2] == loop[0, 2]).all()
    assert 10.0 - 1e-9 < loop[0, 2] < 10.0 + TOLERANCE
    assert (sc.drop_cutter(part, tool, loop[:, :2]) <= loop[:, 2]).all()
    assert sc.waterline(part, tool, 15.0 + over) == []


@pytest.mark.parametrize("height", [10.0, 100.0, 300.0])
def test_a_floor_as_rough_as_single_precision_is_one(height: float) -> None:
    rng = np.random.default_rng(3)
    u = np.linspace(0.0, 40.0, 41)
    x, y = np.meshgrid(u, u)
    unit = np.spacing(np.float32(height))
    vertices = np.stack([x, y, height + unit * rng.integers(0, 2, x.shape)], -1).reshape(-1, 3)
    first = np.arange(41 * 41).reshape(41, 41)[:-1, :-1].reshape(-1, 1)
    floor = vertices, np.concatenate([np.add(first, ring) for ring in ([0, 1, 42], [0, 42, 41])])
    part = sc.Part.from_mesh(*together(floor, box([15.0, 15.0, height], [25.0, 25.0, height + 5.0])))
    tool = sc.Tool.from_dict({"profile": TOOLS[0]})
    (loop,) = sc.waterline(part, tool, height)
    assert (np.abs(loop[:, :2] - 20.0).max(axis=0) < 5.0 + 2.5 + TOLERANCE).all()
    assert height < loop[0, 2] < height + TOLERANCE


@pytest.mark.parametrize("profile", TOOLS, ids=lambda profile: str(profile["kind"]))
def test_a_level_under_a_floor_goes_round_it(profile: dict[str, float]) -> None:
    part, tool = sc.Part.from_mesh(*STEPPED), sc.Tool.from_dict({"profile": profile})
    (loop,) = sc.waterline(part, tool, 9.999)
    assert (np.ptp(loop[:, :2], axis=0) > 40.0).all()
    assert (loop[:, 2] == 9.999).all()
