"""What changes a mesh but not its shape changes no answer; what moves the shape moves the answer with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
import pytest
from conftest import Floats
from numpy.typing import NDArray

import styluscam as sc

Triangles: TypeAlias = NDArray[np.int64]
EXACT = 1e-9
"""mm."""
FAR = np.array([1e4, -1e4, 1e4])
ANGLE = np.radians(37.0)
TURN = np.array([[np.cos(ANGLE), -np.sin(ANGLE)], [np.sin(ANGLE), np.cos(ANGLE)]])

TOOLS = {
    "ball": {"kind": "ball", "diameter": 5.0},
    "clothoid": {"kind": "clothoid", "diameter": 8.0, "tip_flat": 0.4},
    "bull-nose": {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0},
    "cone": {"kind": "cone", "tip_radius": 0.0, "half_angle_deg": 50.0, "diameter": 7.0},
    "flat": {"kind": "flat", "diameter": 4.0},
}


class Case(NamedTuple):
    """A mesh, positions (N, 2) and heights of waterlines, and how much higher all is than it was."""

    vertices: Floats
    triangles: Triangles
    positions: Floats
    raised: float = 0.0


# --- modifiers --------------------------------------------------------------------------------------------------


def turned(case: Case, rng: np.random.Generator) -> Case:
    vertices = case.vertices.copy()
    vertices[:, :2] = vertices[:, :2] @ TURN.T
    return case._replace(vertices=vertices, positions=case.positions @ TURN.T)


def mirrored(case: Case, rng: np.random.Generator) -> Case:
    flip = np.array([-1.0, 1.0, 1.0])
    return Case(case.vertices * flip, case.triangles[:, ::-1], case.positions * flip[:2])


def moved(case: Case, rng: np.random.Generator) -> Case:
    return Case(case.vertices + FAR, case.triangles, case.positions + FAR[:2], float(FAR[2]))


def shuffled(case: Case, rng: np.random.Generator) -> Case:
    order = rng.permutation(len(case.vertices))
    triangles = np.argsort(order)[case.triangles]
    # each triangle begins at any of its corners
    first = rng.integers(0, 3, len(triangles))
    triangles = np.take_along_axis(triangles, (np.arange(3) + first[:, None]) % 3, axis=1)
    return case._replace(vertices=case.vertices[order], triangles=rng.permutation(triangles))


def split_in_the_middle(case: Case, rng: np.random.Generator) -> Case:
    pieces = divided(case, np.full((len(case.triangles), 3), 0.5))
    _, first, welded = np.unique(np.round(pieces.vertices, 9), axis=0, return_index=True, return_inverse=True)
    return pieces._replace(vertices=pieces.vertices[first], triangles=welded.reshape(-1)[pieces.triangles])


def split_with_t_junctions(case: Case, rng: np.random.Generator) -> Case:
    """Each triangle at points of its own: a neighbour's corners lie inside its sides."""
    return divided(case, rng.uniform(0.05, 0.95, (len(case.triangles), 3)))


def divided(case: Case, shares: Floats) -> Case:
    """Four triangles for each, by a point on each side."""
    corners = case.vertices[case.triangles]
    points = corners + shares[:, :, None] * (np.roll(corners, -1, axis=1) - corners)
    (a, b, c), (p, q, r) = np.moveaxis(corners, 1, 0), np.moveaxis(points, 1, 0)
    pieces = np.stack([np.stack(piece, axis=1) for piece in ((a, p, r), (p, b, q), (r, q, c), (p, q, r))], axis=1)
    return case._replace(vertices=pieces.reshape(-1, 3), triangles=np.arange(12 * len(corners)).reshape(-1, 3))


def doubled(case: Case, rng: np.random.Generator) -> Case:
    return case._replace(triangles=np.concatenate([case.triangles, case.triangles[::-1]]))


def unwelded(case: Case, rng: np.random.Generator) -> Case:
    corners = case.vertices[case.triangles].reshape(-1, 3)
    return case._replace(vertices=corners, triangles=np.arange(len(corners)).reshape(-1, 3))


def inverted_in_part(case: Case, rng: np.random.Generator) -> Case:
    some = rng.random(len(case.triangles)) < 0.3
    return case._replace(triangles=np.where(some[:, None], case.triangles[:, ::-1], case.triangles))


def with_fins(case: Case, rng: np.random.Generator) -> Case:
    """Walls hang below every third side: three triangles meet there."""
    a, b = case.vertices[case.triangles[:, 0]], case.vertices[case.triangles[:, 1]]
    feet = 0.5 * (a + b) - [0.0, 0.0, 3.0]
    numbers = len(case.vertices) + np.arange(len(feet))
    fins = np.stack([case.triangles[:, 0], case.triangles[:, 1], numbers], axis=1)
    vertices, triangles = np.concatenate([case.vertices, feet]), np.concatenate([case.triangles, fins])
    return case._replace(vertices=vertices, triangles=triangles)


def with_slivers(case: Case, rng: np.random.Generator) -> Case:
    """A sliver 1e-9 mm thick lies along a side of each triangle."""
    corners = case.vertices[case.triangles]
    share = rng.uniform(0.1, 0.9, (len(corners), 1))
    along = corners[:, 0] + share * (corners[:, 1] - corners[:, 0])
    inward = corners[:, 2] - along
    tops = along + 1e-9 * inward / np.linalg.norm(inward, axis=1, keepdims=True)
    numbers = len(case.vertices) + np.arange(len(tops))
    slivers = np.stack([case.triangles[:, 0], case.triangles[:, 1], numbers], axis=1)
    vertices, triangles = np.concatenate([case.vertices, tops]), np.concatenate([slivers, case.triangles])
    return case._replace(vertices=vertices, triangles=triangles)


def with_nothings(case: Case, rng: np.random.Generator) -> Case:
    """Triangles without area: corners repeated, and corners in a line."""
    a, b, c = case.triangles.T
    middles = 0.5 * (case.vertices[a] + case.vertices[b])
    numbers = len(case.vertices) + np.arange(len(middles))
    nothings = np.concatenate(
        [np.stack([a, a, c], axis=1), np.stack([b, b, b], axis=1), np.stack([a, numbers, b], axis=1)]
    )
    vertices, triangles = np.concatenate([case.vertices, middles]), np.concatenate([nothings, case.triangles])
    return case._replace(vertices=vertices, triangles=triangles)


def far_away(case: Case, rng: np.random.Generator) -> Case:
    """100 m from the origin: coordinates are good to 1.5e-11 mm there."""
    off = np.array([-1e5, 1e5, 0.0])
    return Case(case.vertices + off, case.triangles, case.positions + off[:2])


CONNECTED = (turned, mirrored, moved, shuffled, split_in_the_middle, inverted_in_part, with_nothings, far_away)
DISCONNECTED = (split_with_t_junctions, doubled, unwelded, with_fins, with_slivers)
"""No two triangles share a side, or more than two do."""
MODIFIERS = (*CONNECTED, *DISCONNECTED)


# --- cases ------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def plate(small_part: tuple[Floats, Triangles]) -> Case:
    """Pits and bumps, and positions on and beside them."""
    vertices, triangles = small_part
    low, high = vertices.min(axis=0)[:2] - 3.0, vertices.max(axis=0)[:2] + 3.0
    return Case(vertices, triangles, np.random.default_rng(3).uniform(low, high, (5000, 2)))


@pytest.fixture(scope="module")
def rubble() -> Case:
    """Random heights, needles among them, on a lopsided grid."""
    rng = np.random.default_rng(4)
    rows, columns = 14, 20
    x, y = np.meshgrid(np.cumsum(rng.uniform(0.3, 1.2, columns)), np.cumsum(rng.uniform(0.3, 1.2, rows)))
    z = rng.uniform(0.0, 2.0, x.shape) + 4.0 * (rng.random(x.shape) < 0.05)
    corner = np.arange(rows * columns).reshape(rows, columns)[:-1, :-1].reshape(-1)
    right, up = corner + 1, corner + columns
    triangles = np.concatenate([np.stack([corner, right, up + 1], axis=1), np.stack([corner, up + 1, up], axis=1)])
    positions = rng.uniform([-2.0, -2.0], [x.max() + 2.0, y.max() + 2.0], (5000, 2))
    return Case(np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles.astype(np.int64), positions)


def tips(case: Case, tool: str) -> Floats:
    part = sc.Part.from_mesh(case.vertices, case.triangles)
    return sc.drop_cutter(part, sc.Tool.from_dict({"profile": TOOLS[tool]}), case.positions) - case.raised


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("modifier", MODIFIERS, ids=lambda modifier: modifier.__name__)
@pytest.mark.parametrize("name", ("plate", "rubble"))
def test_drop_cutter_moves_with_the_shape(
    name: str, modifier: Callable[[Case, np.random.Generator], Case], tool: str, request: pytest.FixtureRequest
) -> None:
    case: Case = request.getfixturevalue(name)
    before, after = tips(case, tool), tips(modifier(case, np.random.default_rng(5)), tool)
    assert 1000 < np.isfinite(before).sum() < len(before)
    # positions are rounded out there, and beside a rim heights are a hundred times as steep
    atol = 1e-8 if modifier is far_away else EXACT
    np.testing.assert_allclose(after, before, rtol=0.0, atol=atol)


# --- waterlines -------------------------------------------------------------------------------------------------

LEVEL = 0.7
TOLERANCE = 0.005


def loops(case: Case) -> list[Floats]:
    """Shortest first."""
    part = sc.Part.from_mesh(case.vertices, case.triangles)
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 1.5}})
    return sorted(sc.waterline(part, tool, LEVEL + case.raised, tolerance=TOLERANCE), key=length)


def length(loop: Floats) -> float:
    return float(np.hypot(*np.diff(loop[:, :2], axis=0).T).sum())


def area(loop: Floats) -> float:
    x, y = (loop[:, :2] - loop[0, :2]).T
    return abs(float(0.5 * (x[:-1] * y[1:] - x[1:] * y[:-1]).sum()))


@pytest.mark.parametrize("modifier", MODIFIERS, ids=lambda modifier: modifier.__name__)
def test_waterlines_go_round_the_same(modifier: Callable[[Case, np.random.Generator], Case], plate: Case) -> None:
    """Points are where the grid has them, so that lengths and areas are compared, to what the tolerance allows."""
    before, after = loops(plate), loops(modifier(plate, np.random.default_rng(5)))
    assert len(after) == len(before) == 4
    for modified, original in zip(after, before, strict=True):
        assert (modified[0] == modified[-1]).all()
        assert abs(length(modified) - length(original)) < 2.0 * np.pi * TOLERANCE
        assert abs(area(modified) - area(original)) < TOLERANCE * length(original)


@pytest.mark.parametrize("modifier", (shuffled, inverted_in_part), ids=lambda modifier: modifier.__name__)
def test_the_order_of_triangles_does_not_move_a_waterline(
    modifier: Callable[[Case, np.random.Generator], Case], plate: Case
) -> None:
    before, after = loops(plate), loops(modifier(plate, np.random.default_rng(5)))
    for modified, original in zip(after, before, strict=True):
        np.testing.assert_allclose(modified, original, rtol=0.0, atol=EXACT)
