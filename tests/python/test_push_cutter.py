"""Push-cutter and waterlines against closed forms, and against the drop-cutter on both sides of a touch."""

from __future__ import annotations

import numpy as np
import pytest

import styluscam as sc
from styluscam.types import FloatArray

BALL = {"kind": "ball", "diameter": 6.0}
FLOOR = [[-20.0, -20.0, 0.0], [20.0, -20.0, 0.0], [20.0, 20.0, 0.0], [-20.0, 20.0, 0.0]]
FLOOR_TRIANGLES = [[0, 1, 2], [0, 2, 3]]


def tool_of(profile: dict[str, object]) -> sc.Tool:
    return sc.Tool.from_dict({"profile": profile})


def on_floor(vertices: list[list[float]], triangles: list[list[int]]) -> sc.Part:
    """A mesh that stands on a plate of 40 x 40 mm."""
    return sc.Part.from_mesh(
        np.array(FLOOR + vertices), np.array(FLOOR_TRIANGLES + [[i + 4 for i in triangle] for triangle in triangles])
    )


def box() -> sc.Part:
    """A box of 10 x 10 x 5 mm on the plate."""
    corners = [[x, y, z] for z in (0.0, 5.0) for y in (-5.0, 5.0) for x in (-5.0, 5.0)]
    tops = [[4, 5, 7], [4, 7, 6]]
    walls = [[0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]]
    return on_floor(corners, tops + walls)


def outline(loop: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(loop[:, :2], axis=0), axis=1).sum())


@pytest.mark.parametrize(
    ("profile", "z", "gap"),
    [
        (BALL, 1.0, 3.0),
        (BALL, 2.0, 3.0),
        # over the wall the ball touches its upper edge: R^2 - (R - 5 + z)^2
        (BALL, 3.5, np.sqrt(9.0 - 1.5**2)),
        ({"kind": "flat", "diameter": 6.0}, 4.9, 3.0),
        ({"kind": "cone", "tip_radius": 0.0, "half_angle_deg": 45.0, "diameter": 6.0}, 4.0, 1.0),
    ],
)
def test_a_wall_stops_the_tool_where_it_stands(profile: dict[str, object], z: float, gap: float) -> None:
    travels = sc.push_cutter(box(), tool_of(profile), [[-15.0, 1.0], [0.3, 15.0]], [[2.0, 0.0], [0.0, -0.1]], z)
    assert np.abs(travels - (10.0 - gap)).max() < 1e-9


def test_what_meets_nothing_goes_on_and_what_does_not_stand_free_is_reported() -> None:
    travels = sc.push_cutter(box(), tool_of(BALL), [[-15.0, 9.0], [0.0, 0.0], [-15.0, 0.0]], [[1.0, 0.0]] * 3, 4.0)
    assert np.isposinf(travels[0])
    assert np.isnan(travels[1])
    # a floor at the tool's height lets it pass
    assert np.isposinf(sc.push_cutter(on_floor([], []), tool_of(BALL), [[-19.0, 0.0]], [[1.0, 0.0]], 0.0)[0])


def test_bad_pushes_are_refused() -> None:
    for xy, directions in (
        ([[0.0, 0.0]], [[0.0, 0.0]]),
        ([[np.nan, 0.0]], [[1.0, 0.0]]),
        ([[0.0, 0.0]], [[1.0, 0.0]] * 2),
    ):
        with pytest.raises(sc.GeometryError):
            sc.push_cutter(box(), tool_of(BALL), xy, directions, 1.0)


@pytest.mark.parametrize(
    "profile",
    [BALL, {"kind": "clothoid", "diameter": 8.0}, {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0}],
)
def test_the_drop_cutter_agrees_on_both_sides_of_a_touch(profile: dict[str, object]) -> None:
    axis = np.linspace(-20.0, 20.0, 41)
    x, y = np.meshgrid(axis, axis)
    heights = 3.0 * np.sin(x / 2.7) * np.cos(y / 3.1) + np.sin(x + 0.7 * y)
    corner = np.arange(40 * 41).reshape(40, 41)[:, :-1].reshape(-1)
    triangles = np.concatenate(
        [np.stack([corner, corner + 1, corner + 42], 1), np.stack([corner, corner + 42, corner + 41], 1)]
    )
    part, tool = sc.Part.from_mesh(np.stack([x, y, heights], -1).reshape(-1, 3), triangles), tool_of(profile)
    random = np.random.default_rng(5)
    angles = random.uniform(0.0, 2.0 * np.pi, 400)
    directions = np.stack([np.cos(angles), np.sin(angles)], 1)
    starts = random.uniform(-12.0, 12.0, (400, 2))
    travels = sc.push_cutter(part, tool, starts, directions, 1.0)
    tips = sc.drop_cutter(part, tool, starts)
    assert (np.isnan(travels) == (tips > 1.0)).all()
    met = np.isfinite(travels)
    assert met.sum() > 60

    def at(more: float) -> FloatArray:
        beyond = starts[met] + (travels[met] + more)[:, None] * directions[met]
        return sc.drop_cutter(part, tool, beyond, floor=-50.0)

    assert (at(-1e-7) <= 1.0 + 1e-9).all()
    assert (at(1e-6) > 1.0).all()


def test_waterlines_round_walls_keep_their_distance() -> None:
    for z in (4.0, 2.0, 0.1):
        (loop,) = sc.waterline(box(), tool_of(BALL), z, tolerance=0.005)
        assert (loop[0] == loop[-1]).all()
        reach = np.sqrt(9.0 - (z - 2.0) ** 2) if z > 2.0 else 3.0
        beside = np.maximum(np.abs(loop[:, :2]) - 5.0, 0.0)
        off = np.hypot(*beside.T) - reach
        assert off.min() > -1e-9
        assert off.max() < 0.005


@pytest.mark.parametrize("depth", [1e-1, 1e-3, 1e-5, 1e-7])
def test_a_ridge_without_width_is_found_however_little_of_it_stands_up(depth: float) -> None:
    ridge = on_floor([[-10.0, 3.03, 1.0], [10.0, 3.03, 1.0], [0.0, 3.03, 0.0]], [[0, 1, 2]])
    loops = sc.waterline(ridge, tool_of(BALL), 1.0 - depth)
    assert len(loops) == 1
    assert (loops[0][0] == loops[0][-1]).all()
    assert outline(loops[0]) > 40.0


def test_floors_at_the_level_have_no_loop_of_their_own() -> None:
    assert sc.waterline(on_floor([], []), tool_of(BALL), 0.0) == []


@pytest.mark.parametrize(
    "profile",
    [{"kind": "flat", "diameter": 6.0}, {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0}, BALL],
    ids=lambda profile: profile["kind"],
)
def test_the_path_to_a_touch_is_free_over_rough_ground(profile: dict[str, object]) -> None:
    """Edges that dip under the tip end there: only one side of the position where they do keeps the tool off."""
    rng = np.random.default_rng(8)
    u = np.linspace(-30.0, 30.0, 31)
    x, y = np.meshgrid(u, u)
    vertices = np.stack([x, y, rng.uniform(0.0, 5.0, x.shape)], -1).reshape(-1, 3)
    first = np.arange(31 * 31).reshape(31, 31)[:-1, :-1].reshape(-1, 1)
    triangles = np.concatenate([np.add(first, ring) for ring in ([0, 1, 32], [0, 32, 31])])
    part, tool = sc.Part.from_mesh(vertices, triangles), tool_of(profile)
    points = rng.uniform(-36.0, 36.0, (20_000, 2))
    angle = rng.uniform(0.0, 2.0 * np.pi, len(points))
    directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    travels = sc.push_cutter(part, tool, points, directions, 3.3)
    touches = np.isfinite(travels)
    assert touches.sum() > 1000
    share = rng.uniform(0.0, 1.0 - 1e-9, (touches.sum(), 30))
    on_path = points[touches][:, None] + (share * travels[touches][:, None])[..., None] * directions[touches][:, None]
    tips = sc.drop_cutter(part, tool, on_path.reshape(-1, 2), floor=-1.0)
    assert tips.max() <= 3.3 + 1e-9
