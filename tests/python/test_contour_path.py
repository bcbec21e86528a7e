"""Milling along one profile: the strip beside it, cleared within the bound, and nothing else."""

from __future__ import annotations

import math

import numpy as np
import pytest

import styluscam as sc

RADIUS, WIDTH = 2.0, 3.0
BEND = [(0.0, 0.0), (30.0, 0.0), (30.0, 25.0)]
DISC = [(10.0, 0.0, 1.0), (-10.0, 0.0, 1.0)]


def distances(path: sc.PocketPath, profile: list[tuple[float, float]]) -> np.ndarray:
    """Distance of every measured position of a cut from a polyline, mm."""
    at = np.concatenate([run.points for run in path.engagement if run.kind == "cut"])
    nearest = np.full(len(at), np.inf)
    for a, b in zip(np.array(profile[:-1]), np.array(profile[1:]), strict=True):
        share = np.clip(((at - a) @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
        nearest = np.minimum(nearest, np.hypot(*(at - a - share[:, None] * (b - a)).T))
    return nearest


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_open_profile_is_followed_on_its_side_within_the_bound(side: str) -> None:
    path = sc.contour_path(BEND, width=WIDTH, tool_radius=RADIUS, engagement_deg=60.0, side=side)
    assert 50.0 < path.engagement_max_deg < 60.5 and path.uncleared_area < 1e-3
    assert not path.exempt  # from the air
    # along both sides; around the convex corner and beyond the ends quarters of a disc
    ends = 2 * 0.25 * math.pi * WIDTH**2
    corner = {"left": WIDTH * (30.0 + 25.0 - WIDTH), "right": WIDTH * 55.0 + 0.25 * math.pi * WIDTH**2}[side]
    rounded = {"left": (1.0 - 0.25 * math.pi) * (1.05 * RADIUS) ** 2, "right": 0.0}[side]
    assert path.reachable_area == pytest.approx(corner + ends - rounded, rel=2e-3)
    away = distances(path, BEND)
    assert RADIUS < away.min() < RADIUS + 5e-3 and away.max() < RADIUS + WIDTH + 0.1
    # all of it on the side that was asked for
    at = np.concatenate([run.points for run in path.engagement if run.kind == "cut"])
    beside = at[(at[:, 0] > 5.0) & (at[:, 0] < 20.0) & (np.abs(at[:, 1]) < RADIUS + WIDTH)]
    assert len(beside) and (np.sign(beside[:, 1]) == (1.0 if side == "left" else -1.0)).all()


@pytest.mark.parametrize("direction", ["climb", "conventional"])
@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_a_closed_profile_is_followed_inside_and_outside(side: str, sign: float, direction: str) -> None:
    path = sc.contour_path(
        DISC, width=WIDTH, tool_radius=RADIUS, engagement_deg=60.0, side=side, closed=True, direction=direction
    )
    assert path.engagement_max_deg < 60.5 and path.uncleared_area < 1e-3 and not path.exempt
    assert path.reachable_area == pytest.approx(math.pi * abs((10.0 + sign * WIDTH) ** 2 - 100.0), rel=2e-3)
    away = np.hypot(*np.concatenate([run.points for run in path.engagement if run.kind == "cut"]).T)
    nearest = away.min() if sign > 0 else away.max()
    assert 0.0 < sign * (nearest - 10.0) - RADIUS < 5e-3


def test_only_the_stock_that_is_there_is_cut() -> None:
    stock = [(2.0, -1.0), (12.0, -1.0), (12.0, 9.0), (2.0, 9.0)]
    path = sc.contour_path(BEND, width=WIDTH, tool_radius=RADIUS, engagement_deg=60.0, stock=stock)
    assert path.reachable_area == pytest.approx(10.0 * WIDTH, rel=2e-3)


@pytest.mark.parametrize(
    ("profile", "keys", "where"),
    [
        (BEND, {"width": 0.0}, "width"),
        (BEND, {"width": math.nan}, "width"),
        (BEND, {"side": "outside"}, "side"),
        ([(0.0, 0.0), (0.0, 0.0)], {}, "profile"),
        ([(0.0, math.inf), (1.0, 0.0)], {}, "profile"),
        ([(0.0, 0.0)], {}, "profile"),
        ([(0.0, 0.0), (40.0, 0.0), (40.0, 20.0), (20.0, -10.0)], {}, "profile"),  # crosses itself
        (BEND, {"width": 1e-3}, "width"),
        ([(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)], {"closed": True}, "profile"),
    ],
)
def test_what_is_no_profile_is_refused_by_name(
    profile: list[tuple[float, float]], keys: dict[str, object], where: str
) -> None:
    asked = {"width": WIDTH, "tool_radius": RADIUS, "engagement_deg": 60.0} | keys
    with pytest.raises(sc.GeometryError, match=where):
        sc.contour_path(profile, **asked)  # type: ignore[arg-type]


def test_a_profile_without_a_length_is_called_that() -> None:
    with pytest.raises(sc.GeometryError, match="no length: 1 points"):
        sc.contour_path([(0.0, 0.0)], width=WIDTH, tool_radius=RADIUS, engagement_deg=60.0)


def test_the_narrowest_strip_is_planned() -> None:
    path = sc.contour_path([(0.0, 0.0), (20.0, 0.0)], width=0.01, tool_radius=RADIUS, engagement_deg=60.0)
    assert 0.1 < path.reachable_area < 0.2 and path.engagement_max_deg < 60.5
