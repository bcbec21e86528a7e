"""What stays in corners against closed forms, and what rows and walls make of each other."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import styluscam as sc
from meridian import FIXTURES
from styluscam.advice.reach import gaps
from styluscam.advice.suggest import micrometres
from styluscam.advice.walls import Corners, Walls

NONE = Corners(np.zeros((0, 2, 3)), np.zeros(0), np.zeros(0))


def corner(low_deg: float, high_deg: float, radius: float = 0.0) -> Corners:
    """Between two planes that rise along +X."""
    slopes = np.radians([low_deg, high_deg])
    sides = np.stack([-np.sin(slopes), np.zeros(2), np.cos(slopes)], axis=1)
    return Corners(sides[None], np.array([radius]), np.array([1.0]))


@pytest.mark.parametrize("turn", (20.0, 60.0, 90.0))
def test_a_ball_in_an_edge(turn: float) -> None:
    ball = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    (gap,), (width,) = gaps(ball, corner(0.0, turn), 1.0)
    half = math.radians(turn / 2.0)
    # from the edge along a plane's normal to the ball of 6 mm that touches both planes
    away = 6.0 / math.cos(half)
    assert gap == pytest.approx(6.0 - math.sqrt(36.0 - (away * math.sin(half)) ** 2), rel=0.06)
    assert width == pytest.approx(2.0 * 6.0 * math.tan(half), rel=1e-3)


def test_a_valley_between_walls_is_a_corner_too() -> None:
    ball = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    sides = np.array([[[0.6, 0.0, 0.8], [0.0, 0.6, 0.8]]])
    half = 0.5 * math.acos(0.64)
    (gap,), _ = gaps(ball, Corners(sides, np.array([2.0]), np.ones(1)), 0.0)
    assert gap == pytest.approx(3.0 / math.cos(half) - 3.0, rel=1e-3)


@pytest.mark.parametrize("number", range(3))
def test_a_clothoid_over_a_fillet(number: int) -> None:
    check = json.loads((FIXTURES / "bridge_checks.json").read_text())["bridges"][number]
    tool = sc.Tool.from_dict({"profile": check["tool"]})
    (gap,), (width,) = gaps(tool, corner(0.0, check["wall_angle_deg"], check["fillet_radius"]), 0.0)
    assert gap == pytest.approx(check["gap_normal"], rel=0.02)
    assert width == pytest.approx(np.ptp(check["contacts_d"]), rel=0.15)


def test_a_tool_that_is_rounder_leaves_nothing() -> None:
    ball = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    assert gaps(ball, corner(0.0, 60.0, 6.0), 0.9)[0].tolist() == [0.0]
    assert gaps(ball, corner(0.0, 60.0, 6.0), 1.1)[0][0] > 0.0


def test_rows_are_distinguished_by_how_they_meet_the_walls() -> None:
    slopes, areas = np.radians([45.0, 45.0, 1.0]), np.ones(3)
    walls = Walls(slopes, np.radians([30.0, -60.0, 0.0]), areas, np.zeros((3, 3)), NONE, np.array([1, 2, 3]))
    angles, turns, found, *_ = walls.classes(rows_deg=30.0)
    assert sorted(zip(angles.round(6), turns.round(6), found, strict=True)) == [(1, 60, 1), (45, 0, 1), (45, 90, 1)]
    levels, still, areas, *_ = walls.classes()
    assert levels == pytest.approx([45.0]) and still.tolist() == [0.0] and areas.tolist() == [2.0]


@pytest.mark.parametrize(
    ("length", "text"), [(0.0, "0.00"), (2.5e-5, "0.03"), (0.0123, "12.3"), (0.09996, "100"), (3.0, "3000")]
)
def test_micrometres_are_plain_numbers(length: float, text: str) -> None:
    assert micrometres(length) == text
