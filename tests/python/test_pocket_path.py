"""Paths that clear pockets: the bound as simulated, what is left, and what is cut into walls."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import styluscam as sc

RADIUS = 2.5


def rectangle(x: float, y: float) -> list[list[float]]:
    return [[-x, -y], [x, -y], [x, y], [-x, y]]


ELL = [[0.0, 0.0], [40.0, 0.0], [40.0, 15.0], [15.0, 15.0], [15.0, 40.0], [0.0, 40.0]]
HALF = [[12.0, 0.0, 1.0], [-12.0, 0.0, 1.0]]
POCKETS = {
    "square": (rectangle(12.0, 12.0), []),
    "ell": (ELL, []),
    "slot": (rectangle(20.0, 4.0), []),
    "round with an island": (HALF, [[[3.0, 0.0, 1.0], [-3.0, 0.0, 1.0]]]),
}


def length(points: np.ndarray, bulges: bool = True) -> float:
    chords = np.hypot(*np.diff(points[:, :2], axis=0).T)
    quarter = np.arctan(np.abs(points[:-1, 2])) if bulges else np.zeros(len(chords))
    return float((chords * np.where(quarter > 0, 2 * quarter / np.maximum(np.sin(2 * quarter), 1e-300), 1.0)).sum())


@pytest.mark.parametrize("name", POCKETS)
def test_the_simulated_angle_stays_below_the_bound_and_all_is_cleared(name):
    boundary, islands = POCKETS[name]
    path = sc.pocket_path(boundary, islands, tool_radius=RADIUS, engagement_deg=50.0, growth_deg=10.0)
    over = sum(int((run.angles_deg > 60.5).sum()) for run in path.engagement if run.kind != "entry")
    assert over == 0 and 55.0 < path.engagement_max_deg <= 60.5
    assert path.uncleared_area < 1e-3
    clearance = min(float(run.clearances.min()) for run in path.engagement if run.clearances.size)
    assert RADIUS - 1e-6 < clearance < RADIUS + 5e-3
    assert [exempt.reason for exempt in path.exempt] == ["entry"] and path.exempt[0].peak_deg == pytest.approx(360.0)
    (_, kind), *_ = path.runs
    assert kind == "entry" and {kind for _, kind in path.runs} <= {"entry", "cut", "link", "rapid"}


def test_runs_join_and_cut_no_less_than_the_area_asks_for():
    path = sc.pocket_path(rectangle(12.0, 12.0), tool_radius=RADIUS, engagement_deg=60.0)
    for (before, _), (after, _) in zip(path.runs, path.runs[1:], strict=False):
        assert np.allclose(before[-1, :2], after[0, :2], atol=1e-9)
    cut = sum(length(points) for points, kind in path.runs if kind == "cut")
    least = (24.0**2 - (2 * (RADIUS * 1.7)) ** 2) / (RADIUS * (1.0 - math.cos(math.radians(60.0))))
    assert least < cut < 2.5 * least


def centres(path: sc.PocketPath, step: float) -> np.ndarray:
    """Positions of the tool's centre on all that is cut."""
    found = []
    for points, kind in path.runs:
        for (x, y, bulge), (u, v, _) in itertools.pairwise(points):
            if kind in ("cut", "entry"):
                a, b, quarter = complex(x, y), complex(u, v), math.atan(bulge)
                span = abs(b - a) * (2 * quarter / math.sin(2 * quarter) if quarter else 1.0)
                shares = np.linspace(0.0, 1.0, 2 + int(span / step))
                # on the arc: sin(share * half) / sin(half) of the chord, turned
                half = 2 * quarter
                part = np.sin(shares * half) / math.sin(half) if abs(half) > 1e-9 else shares
                found.append(a + (b - a) * part * np.exp(1j * (shares - 1.0) * half))
    return np.concatenate(found)


def test_every_place_that_the_tool_can_reach_is_swept():
    half, fillet = 8.0, RADIUS * 1.05
    path = sc.pocket_path(rectangle(half, half), tool_radius=RADIUS, engagement_deg=75.0)
    line = np.concatenate([np.linspace(-half, half, 65)[1:-1], [0.002 - half, half - 0.002]])
    x, y = (axis.ravel() for axis in np.meshgrid(line, line))
    corner = np.hypot(np.maximum(abs(x) - half + fillet, 0), np.maximum(abs(y) - half + fillet, 0))
    reached = (x + 1j * y)[corner < fillet - 0.002]
    least = np.full(len(reached), np.inf)
    for some in np.array_split(centres(path, 0.04), 40):
        least = np.minimum(least, abs(reached[:, None] - some[None, :]).min(axis=1))
    assert len(reached) > 3500 and (least < RADIUS + 1e-3).all(), float(least.max())


def test_both_ways_need_less_linking_than_one():
    shares, cuts = [], []
    for direction in ("climb", "either"):
        path = sc.pocket_path(ELL, tool_radius=4.0, engagement_deg=75.0, direction=direction)
        moves = {kind: sum(length(p) for p, k in path.runs if k == kind) for kind in ("cut", "link", "rapid")}
        shares.append(1.0 - moves["cut"] / sum(moves.values()))
        cuts.append(moves["cut"])
        assert path.engagement_max_deg < 75.5 and path.uncleared_area < 1e-3
    assert shares[1] < 0.8 * shares[0] and cuts[1] == pytest.approx(cuts[0], rel=0.02)


def test_conventional_is_the_mirror_of_climb():
    mirrored = [[-x, y] for x, y in reversed(ELL)]
    climb = sc.pocket_path(ELL, tool_radius=4.0, engagement_deg=75.0)
    other = sc.pocket_path(mirrored, tool_radius=4.0, engagement_deg=75.0, direction="conventional")
    totals = [sum(length(points) for points, kind in path.runs if kind == "cut") for path in (climb, other)]
    assert totals[0] == pytest.approx(totals[1], rel=0.05)
    assert other.engagement_max_deg < 75.5 and other.uncleared_area < 1e-3


def test_an_open_edge_needs_no_entry_and_stock_is_all_that_counts():
    path = sc.pocket_path(rectangle(15.0, 10.0), tool_radius=RADIUS, engagement_deg=60.0, open_edges=[1])
    assert not path.exempt and path.engagement_max_deg < 60.5 and path.uncleared_area < 1e-3
    far = max(float(points[:, 0].max()) for points, _ in path.runs)
    assert 15.0 < far < 15.0 + 2.5 * RADIUS
    rest = [[5.0, -10.0], [15.0, -10.0], [15.0, 10.0], [5.0, 10.0]]
    less = sc.pocket_path(rectangle(15.0, 10.0), tool_radius=RADIUS, engagement_deg=60.0, stock=rest)
    assert less.engagement_max_deg < 60.5 and min(float(points[:, 0].min()) for points, _ in less.runs) > -10.0


@pytest.mark.parametrize(
    ("boundary", "more", "failure", "where"),
    [
        (rectangle(2.0, 10.0), {}, sc.PlanError, "tool_radius"),
        (rectangle(10.0, 10.0), {"growth_deg": 40.0}, sc.GeometryError, "engagement_deg"),
        (rectangle(10.0, 10.0), {"open_edges": [4]}, sc.GeometryError, "open_edges"),
        (rectangle(10.0, 10.0), {"open_edges": 3}, sc.GeometryError, "open_edges"),
        (rectangle(10.0, 10.0), {"islands": 3}, sc.GeometryError, "islands"),
        (rectangle(10.0, 10.0), {"growth_deg": -20.0}, sc.GeometryError, "growth_deg"),
        (rectangle(10.0, 10.0), {"direction": "up"}, sc.GeometryError, "direction"),
        (rectangle(10.0, 10.0), {"stock": [[50.0, 0.0], [60.0, 0.0], [60.0, 9.0]]}, sc.PlanError, "stock"),
        (rectangle(3000.0, 10.0), {}, sc.GeometryError, "tool_radius"),
        (rectangle(10.0, 2e6), {}, sc.GeometryError, "boundary[0]"),
        (rectangle(10.0, 10.0), {"stock": rectangle(5000.0, 10.0)}, sc.GeometryError, "stock[0]"),
        ([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]], {}, sc.GeometryError, "boundary"),
        ([[0.0, 0.0], [10.0, math.inf], [20.0, 0.0]], {}, sc.GeometryError, "boundary[1]"),
    ],
)
def test_what_cannot_be_planned_is_refused_by_name(boundary, more, failure, where):
    with pytest.raises(failure) as refused:
        sc.pocket_path(boundary, tool_radius=RADIUS, engagement_deg=60.0, **more)
    assert refused.value.where == where


@pytest.mark.parametrize(
    "boundary",
    [
        [[0.0, 0.0], [30.0, 20.0], [30.0, 0.0], [0.0, 20.0]],  # crosses itself
        [[0.0, 0.0], [0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [30.0, 20.0], [0.0, 20.0]],  # points twice
        [
            [0.0, 0.0],
            [15.0, 0.0],
            [15.0, 8.0],
            [15.0, 0.0],
            [30.0, 0.0],
            [30.0, 20.0],
            [0.0, 20.0],
        ],  # a wall without width
        [[0.0, 0.0, 1e-9], [30.0, 0.0, 0.0], [30.0, 20.0, -1e-6], [0.0, 20.0, 0.0]],  # arcs of huge radii
    ],
)
def test_odd_outlines_have_a_path_within_the_bound(boundary):
    path = sc.pocket_path(boundary, tool_radius=RADIUS, engagement_deg=60.0)
    assert path.engagement_max_deg < 60.5 and any(kind == "cut" for _, kind in path.runs)


@pytest.mark.parametrize(("radius", "bound"), [(0.3, 40.0), (0.15, 60.0), (0.05, 90.0)])
def test_the_bound_holds_for_small_tools_far_from_the_origin(radius, bound):
    # 10, 4.5 and 4.6 deg above it, before pockets were planned as large as the arithmetic needs them
    tooth = radius * np.array([[0, 0], [16, 0], [16, 6], [6, 6], [6, 16], [3, 8], [0, 16]]) + np.array([300.0, -700.0])
    path = sc.pocket_path(tooth, tool_radius=radius, engagement_deg=bound)
    assert path.engagement_max_deg < bound + 0.5 and path.uncleared_area < 1e-3 * path.reachable_area
    clearance = min(float(run.clearances.min()) for run in path.engagement if run.clearances.size)
    assert radius - 1e-6 < clearance < radius + 5e-3


def test_a_pocket_of_10_m_is_a_small_one_four_times_as_large_and_far_from_the_origin():
    small = sc.pocket_path(rectangle(1250.0, 240.0), tool_radius=100.0, engagement_deg=60.0)
    boundary = np.array(rectangle(5000.0, 960.0)) + np.array([9000.0, -40_000.0])
    large = sc.pocket_path(boundary, tool_radius=400.0, engagement_deg=60.0)
    assert [kind for _, kind in large.runs] == [kind for _, kind in small.runs]
    for (ours, _), (theirs, _) in zip(large.runs, small.runs, strict=True):
        assert np.allclose(ours[:, :2] - [9000.0, -40_000.0], 4.0 * theirs[:, :2], rtol=0.0, atol=1e-9)
    assert large.engagement_max_deg < 60.5 and large.uncleared_area < 1e-3 * large.reachable_area


def test_a_tool_that_is_too_large_is_named_with_its_own_radius():
    with pytest.raises(sc.PlanError, match=r"radius 0\.3 mm, with corners of 0\.015 mm"):
        sc.pocket_path(rectangle(0.2, 0.2), tool_radius=0.3, engagement_deg=60.0)
