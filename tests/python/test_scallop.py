"""Scallops compared with closed forms and the published tables; profiles here are formulas, not the engine's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import styluscam as sc
from styluscam.tools import starters
from styluscam.tools.scallop import scallop_of_rows, scallop_of_spacing, scallop_of_step, spacing_of_scallop

WALLS = np.array([15.0, 30.0, 45.0, 60.0, 75.0])


@dataclass(frozen=True)
class Closed:
    """A profile in closed form: radius and height by slope."""

    radius: object
    height: object
    max_slope: float = np.pi / 2.0
    flat: float = 0.0

    def radius_range_at(self, slope):
        slope = np.asarray(slope, dtype=float)
        outer = self.flat + self.radius(slope)
        return np.where(slope == 0.0, 0.0, outer), outer

    def height_at(self, slope):
        return self.height(np.asarray(slope, dtype=float))


def ball(radius, flat=0.0):
    return Closed(lambda s: radius * np.sin(s), lambda s: 2.0 * radius * np.sin(s / 2.0) ** 2, flat=flat)


PARABOLA = Closed(lambda s: 8.0 * np.tan(s), lambda s: 4.0 * np.tan(s) ** 2, np.radians(80.0))
ELLIPSE = Closed(
    lambda s: 36.0 * np.sin(s) / np.hypot(4.0 * np.cos(s), 6.0 * np.sin(s)),
    lambda s: 4.0 - 16.0 * np.cos(s) / np.hypot(4.0 * np.cos(s), 6.0 * np.sin(s)),
)
CUBIC = Closed(lambda s: np.sqrt(20.0 * np.tan(s)), lambda s: np.sqrt(20.0 * np.tan(s)) ** 3 / 60.0, np.radians(80.0))
CONE = Closed(np.sin, lambda s: 1.0 - np.cos(s), np.radians(70.0))
"""A tip of radius 1 that ends where a cone of 20 degrees a side would begin."""


@pytest.mark.parametrize(
    ("profile", "published"),
    [
        ({"kind": "parabola", "apex_radius": 8.0, "diameter": 80.0}, [14.683, 11.049, 7.813]),
        ({"kind": "power", "coefficient": 1.0 / 60.0, "exponent": 3.0, "diameter": 30.0}, [15.914, 19.795, 18.409]),
        ({"kind": "ball", "diameter": 10.0}, [1e3 * (5.0 - np.sqrt(24.75))] * 3),
    ],
)
def test_rows_up_the_wall_have_the_published_scallops(profile, published):
    tool = sc.Tool.from_dict({"profile": profile})
    found = scallop_of_rows(tool, np.array([20.0, 45.0, 60.0]), 1.0)
    assert found * 1e3 == pytest.approx(published, abs=6e-4)


def test_rows_farther_apart_than_the_tool_is_wide_touch_not_all():
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    assert np.isnan(scallop_of_rows(tool, 45.0, 10.1))


@pytest.mark.parametrize(
    ("step", "published"),
    [
        (0.2, [14.951, 4.002, 2.000, 1.334, 1.072]),
        (0.5, [94.188, 25.063, 12.516, 8.340, 6.703]),
        (1.0, [388.281, 101.021, 50.253, 33.445, 26.867]),
    ],
)
def test_ball_has_the_published_scallops(step, published):
    for tool in (ball(5.0), sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})):
        found = scallop_of_step(tool, WALLS, step)
        assert found * 1e3 == pytest.approx(published, abs=6e-4)
        p = step / np.sin(np.radians(WALLS))
        assert found == pytest.approx(5.0 - np.sqrt(25.0 - p * p / 4.0), abs=1e-12)


def test_steps_for_ten_micrometres_are_the_published_ones():
    steps = np.array([0.1636, 0.3161, 0.4470, 0.5474, 0.6106])
    assert (scallop_of_step(ball(5.0), WALLS, steps - 6e-5) < 0.01).all()
    assert (scallop_of_step(ball(5.0), WALLS, steps + 6e-5) > 0.01).all()


@pytest.mark.parametrize(
    ("tool", "published"),
    [
        (ball(5.0), [25.063, 25.063, 25.063]),
        (PARABOLA, [12.965, 5.524, 1.953]),
        (ELLIPSE, [17.078, 28.852, 37.584]),
        (CUBIC, [27.866, 19.747, 9.194]),
    ],
    ids=["ball", "parabola", "ellipse", "cubic"],
)
def test_other_profiles_have_the_published_scallops(tool, published):
    assert scallop_of_spacing(tool, [20.0, 45.0, 60.0], 1.0) * 1e3 == pytest.approx(published, abs=6e-4)


def test_parabola_is_its_closed_form():
    a = np.radians(WALLS[:4])
    p = 0.7
    assert scallop_of_spacing(PARABOLA, WALLS[:4], p) == pytest.approx(
        (p * np.cos(a)) ** 2 * np.cos(a) / 64.0, abs=1e-12
    )


@pytest.mark.parametrize(
    ("profile", "tool"),
    [
        ({"kind": "parabola", "apex_radius": 8.0, "diameter": 60.0}, PARABOLA),
        ({"kind": "ellipse", "radial": 6.0, "axial": 4.0}, ELLIPSE),
        ({"kind": "power", "coefficient": 1.0 / 60.0, "exponent": 3.0, "diameter": 21.0}, CUBIC),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else "",
)
def test_the_engine_s_kinds_leave_the_same(profile, tool):
    found = scallop_of_spacing(sc.Tool.from_dict({"profile": profile}), [20.0, 45.0, 60.0], 1.0)
    assert found == pytest.approx(scallop_of_spacing(tool, [20.0, 45.0, 60.0], 1.0), abs=1e-9)


@pytest.mark.parametrize("leave", (scallop_of_spacing, scallop_of_step, scallop_of_rows))
@pytest.mark.parametrize(
    ("wall", "apart"), [(0.0, 1.0), (90.0, 1.0), (-5.0, 1.0), (45.0, 0.0), (45.0, -1.0), (45.0, np.nan)]
)
def test_what_is_no_wall_or_no_spacing_is_refused(leave, wall, apart):
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    with pytest.raises(sc.ToolError, match="out of range"):
        leave(tool, [30.0, wall], apart)


def test_small_spacings_see_the_radius_of_curvature():
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0}})
    walls, p = np.array([20.0, 45.0, 60.0]), 0.02
    rho = tool.curvature_radius_at(np.radians(walls))
    assert scallop_of_spacing(tool, walls, p) == pytest.approx(p * p / (8.0 * rho), rel=1e-4)


def test_a_flat_leaves_nothing_on_a_floor_that_it_covers():
    flat = ball(2.0, flat=3.0)
    # walls so gentle that the flat bridges them: a sharp corner and the flat's far end meet the wall last
    assert scallop_of_spacing(flat, 1e-9, 5.9) == pytest.approx(0.0, abs=1e-9)
    assert scallop_of_spacing(flat, 1e-9, 6.5) == pytest.approx(2.0 - np.sqrt(4.0 - 0.25**2), abs=1e-7)


def test_a_straight_flank_leaves_nothing_on_a_wall_of_its_slope():
    def radius(s):
        return np.where(s >= CONE.max_slope, 5.0, np.sin(s))

    def height(s):
        straight = 1.0 - np.cos(CONE.max_slope) + (5.0 - np.sin(CONE.max_slope)) * np.tan(CONE.max_slope)
        return np.where(s >= CONE.max_slope, straight, 1.0 - np.cos(s))

    class Cone(Closed):
        def radius_range_at(self, slope):
            slope = np.asarray(slope, dtype=float)
            return np.sin(slope), radius(slope)

    cone = Cone(radius, height, CONE.max_slope)
    length = (5.0 - np.sin(CONE.max_slope)) / np.cos(CONE.max_slope)
    assert scallop_of_spacing(cone, 70.0, 0.9 * length) == pytest.approx(0.0, abs=1e-9)
    assert scallop_of_spacing(cone, 70.0, 1.1 * length) > 0.01
    # a gentler wall is met by the flank's foot, where the round tip ends: its scallop has a straight side
    assert 0.0 < scallop_of_spacing(cone, 60.0, 0.5) < scallop_of_spacing(CONE, 60.0, 0.5)


def test_an_edge_leaves_a_saw_tooth():
    """A cylinder with a sharp edge against a wall of angle a: two lines at right angles, h = p sin a cos a."""
    cylinder = Closed(np.zeros_like, np.zeros_like, flat=5.0)
    a = np.radians(WALLS)
    expected = 0.3 * np.sin(a) * np.cos(a)
    assert scallop_of_spacing(cylinder, WALLS, 0.3) == pytest.approx(expected, abs=1e-12)


def test_passes_too_far_apart_leave_a_strip_untouched():
    assert np.isnan(scallop_of_spacing(ball(5.0), 10.0, 10.2))
    assert scallop_of_spacing(ball(5.0), 0.001, 9.999) == pytest.approx(5.0 - np.sqrt(25.0 - 4.9995**2), abs=1e-3)


def test_shapes_follow_the_arguments():
    assert scallop_of_spacing(ball(5.0), 30.0, 0.5).shape == ()
    assert scallop_of_step(ball(5.0), WALLS[:, None], [0.2, 0.5]).shape == (5, 2)


@pytest.mark.parametrize("kind", ["ball", "clothoid", "cone"])
def test_the_spacing_of_a_scallop_is_the_inverse(kind: str) -> None:
    tool = sc.Tool.from_dict({"profile": starters.profiles()[kind]})
    walls, heights = np.array([15.0, 45.0, 75.0]), np.array([0.001, 0.01, 0.05])
    spacing = spacing_of_scallop(tool, walls, heights)
    assert scallop_of_spacing(tool, walls, spacing) == pytest.approx(heights, rel=1e-9)
    with pytest.raises(sc.ToolError, match="height = 0"):
        spacing_of_scallop(tool, 45.0, 0.0)
