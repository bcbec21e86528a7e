"""The engagement along a program: angles of straight cuts by hand, layer by layer, and of a planned pocket by its bound."""

from __future__ import annotations

import math

import numpy as np
import pytest
from test_pocket_operation import job

import styluscam as sc
from styluscam.judging.engagement_map import EngagementMap, Stock, engagement_map

RADIUS = 3.0
FLAT = {"profile": {"kind": "flat", "diameter": 2.0 * RADIUS}}
BOX = Stock((-40.0, -40.0), (40.0, 40.0), 0.0)


def measured(*lines: str, stock: Stock = BOX, tool: dict[str, object] = FLAT) -> EngagementMap:
    text = "\n".join(["G21 G90 G17 G94 G54", "T1 M6", "S8000 M3", "F600", *lines, "M2", ""])
    return engagement_map(sc.read_gcode(text, "linuxcnc"), sc.Tool.from_dict(tool), stock)


def angle_at(found: EngagementMap, x: float, y: float, z: float) -> float:
    """The angle where the tip passes nearest."""
    away = np.linalg.norm(found.points - [x, y, z], axis=1)
    assert away.min() < 0.1
    return float(found.angles_deg[away.argmin()])


def beside(step: float) -> float:
    return math.degrees(math.acos(1.0 - step / RADIUS))


SLOT = ("G0 X-60 Y0 Z5", "G0 Z-1", "G1 X60")
NEXT = ("G0 Z5", "G0 X-60 Y1", "G0 Z-1", "G1 X60")


def test_a_slot_and_a_pass_beside_it() -> None:
    found = measured(*SLOT, *NEXT)
    assert angle_at(found, 0.0, 0.0, -1.0) == pytest.approx(180.0, abs=2.0)
    assert angle_at(found, 0.0, 1.0, -1.0) == pytest.approx(beside(1.0), abs=0.1)
    assert found.points[:, 2] == pytest.approx(-1.0)
    assert list(found.ends) == [len(found.points) // 2, len(found.points)]


def test_each_layer_begins_with_material_again() -> None:
    found = measured(*SLOT, "G0 Z5", "G0 X-60 Y0", "G0 Z-2", "G1 X60")
    assert angle_at(found, 0.0, 0.0, -1.0) == pytest.approx(180.0, abs=2.0)
    assert angle_at(found, 0.0, 0.0, -2.0) == pytest.approx(180.0, abs=2.0)
    again = measured(*SLOT, "G0 Z5", "G0 X-60 Y0", "G0 Z-1", "G1 X60")
    assert again.angles_deg[again.ends[0] :].max() == 0.0


def test_a_ball_has_its_radius_at_the_top_of_the_layer() -> None:
    ball = {"profile": {"kind": "ball", "diameter": 2.0 * RADIUS}}
    found = measured(*SLOT, *NEXT, tool=ball)
    wide = math.sqrt(RADIUS**2 - (RADIUS - 1.0) ** 2)
    assert angle_at(found, 0.0, 1.0, -1.0) == pytest.approx(math.degrees(math.acos(1.0 - 1.0 / wide)), abs=0.5)


def test_a_helix_is_an_entry_of_falling_height_and_a_hole_is_no_material() -> None:
    helix = ("G0 X2 Y0 Z5", "G1 Z0", "G3 X2 Y0 Z-1 I-2 J0", "G3 X2 Y0 I-2 J0")
    found = measured(*helix)
    falling = found.points[found.is_entry == 1]
    assert np.hypot(falling[:, 0], falling[:, 1]) == pytest.approx(2.0, abs=1e-6)
    turned = np.arctan2(falling[:, 1], falling[:, 0]) % (2.0 * math.pi)
    inner = (turned > 0.1) & (turned < 6.1)
    assert falling[inner, 2] == pytest.approx(-turned[inner] / (2.0 * math.pi), abs=1e-3)
    assert found.angles_deg[found.is_entry == 0].max() == 0.0  # the last turn finds nothing
    assert found.worst is not None
    drilled = Stock(BOX.low, BOX.high, BOX.top, [(0.0, 0.0, 10.1)])
    assert measured(*helix, stock=drilled).angles_deg.max() == 0.0


def test_a_thinned_map_keeps_every_peak() -> None:
    found = measured(*SLOT, *NEXT)
    few = found.thinned(40)
    assert len(few.points) <= 44
    assert few.angles_deg.max() == found.angles_deg.max()
    assert few.points[0] == pytest.approx(found.points[0])
    assert few.points[-1] == pytest.approx(found.points[-1])
    assert few.points[few.ends[0]] == pytest.approx(found.points[found.ends[0]])
    assert few.angles_deg[few.ends[0] + 5 : -5].max() == pytest.approx(beside(1.0), abs=0.1)
    assert found.thinned(10**6) is found


def test_a_planned_pocket_keeps_its_bound_and_cuts_on_both_levels() -> None:
    asked = job()
    (text,) = sc.post(sc.plan(asked)).files.values()
    stock = Stock((0.0, 0.0), (20.0, 16.0), 6.0)
    found = engagement_map(sc.read_gcode(text, "linuxcnc"), asked.tools()["mill"], stock)
    bounded = found.angles_deg[found.is_entry == 0]
    assert 79.0 < bounded.max() < 80.5
    assert set(found.points[found.is_entry == 0, 2].round(2)) == {4.0, 2.0}
    assert found.angles_deg[found.is_entry == 1].max() > 100.0
