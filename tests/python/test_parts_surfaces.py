"""Exact surfaces: closed forms and B-splines against the CAD kernel's own projection."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytest.importorskip("OCP", reason="needs the step extra")

from OCP.Geom import (
    Geom_BSplineSurface,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Plane,
    Geom_SphericalSurface,
    Geom_ToroidalSurface,
)
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface, GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Vec
from OCP.TColgp import TColgp_Array2OfPnt

from styluscam.parts.exact import nurbs_of
from styluscam.parts.surfaces import Cone, Cylinder, ExactSurface, Parametric, Plane, Sphere, Torus

LOCATION, AXIS = (3.0, -2.0, 5.0), (0.3, -0.5, 0.8)
FRAME = gp_Ax3(gp_Pnt(*LOCATION), gp_Dir(*AXIS))

CLOSED_FORMS = {
    "plane": (Plane(LOCATION, AXIS), Geom_Plane(FRAME)),
    "cylinder": (Cylinder(LOCATION, AXIS, 4.0), Geom_CylindricalSurface(FRAME, 4.0)),
    "cone": (Cone(LOCATION, AXIS, 20.0, 0.4), Geom_ConicalSurface(FRAME, 0.4, 20.0)),
    "cone narrowing": (Cone(LOCATION, AXIS, 20.0, -0.4), Geom_ConicalSurface(FRAME, -0.4, 20.0)),
    "sphere": (Sphere(LOCATION, 7.0), Geom_SphericalSurface(FRAME, 7.0)),
    "torus": (Torus(LOCATION, AXIS, 9.0, 2.5), Geom_ToroidalSurface(FRAME, 9.0, 2.5)),
    "spindle torus": (Torus(LOCATION, AXIS, 2.0, 6.0), Geom_ToroidalSurface(FRAME, 2.0, 6.0)),
}


def kernel_distance(surface: Any, point: np.ndarray) -> tuple[float, np.ndarray]:
    """Distance from the kernel's projection, and the foot point."""
    projection = GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), surface)
    foot = projection.NearestPoint()
    return projection.LowerDistance(), np.array([foot.X(), foot.Y(), foot.Z()])


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_closed_form_agrees_with_the_kernel(name: str) -> None:
    ours, theirs = CLOSED_FORMS[name]
    points = np.random.default_rng(1).uniform(-10.0, 10.0, (200, 3)) + LOCATION
    distances, normals = ours.distance(points), ours.normal(points)
    for point, distance, normal in zip(points, distances, normals, strict=True):
        expected, foot = kernel_distance(theirs, point)
        assert abs(distance) == pytest.approx(expected, abs=1e-9)
        assert point - distance * normal == pytest.approx(foot, abs=1e-7)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(200), abs=1e-12)


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_sign_turns_distance_and_normal(name: str) -> None:
    ours = CLOSED_FORMS[name][0]
    values = {k: v for k, v in vars(ours).items() if k != "sign"}
    turned = type(ours)(**values, sign=-1.0)
    points = np.random.default_rng(2).uniform(-10.0, 10.0, (20, 3))
    assert np.array_equal(turned.distance(points), -ours.distance(points))
    assert np.array_equal(turned.normal(points), -ours.normal(points))
    assert isinstance(ours, ExactSurface)


def test_positive_is_outside() -> None:
    centre = np.array([LOCATION])
    assert CLOSED_FORMS["sphere"][0].distance(centre)[0] == pytest.approx(-7.0)
    assert CLOSED_FORMS["cylinder"][0].distance(centre)[0] == pytest.approx(-4.0)
    assert CLOSED_FORMS["torus"][0].distance(centre)[0] == pytest.approx(6.5)


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_normals_are_finite_on_the_axis(name: str) -> None:
    axis = np.array(AXIS) / np.linalg.norm(AXIS)
    points = np.array(LOCATION) + np.outer(np.linspace(-3.0, 3.0, 7), axis)
    normals = CLOSED_FORMS[name][0].normal(points)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(7), abs=1e-9)


def test_past_its_apex_a_cone_is_as_far_as_the_apex() -> None:
    cone = Cone((0, 0, 0), (0, 0, 1), 0.0, 0.5)
    assert cone.distance(np.array([[0.0, 0.0, -3.0]]))[0] == pytest.approx(3.0)


def wavy_surface(periodic: bool = False) -> Geom_BSplineSurface:
    """A B-spline surface of degree 3 to 8 through a wave; or a periodic one that closes on itself."""
    if periodic:
        from OCP.GeomConvert import GeomConvert

        return GeomConvert.SurfaceToBSplineSurface_s(Geom_ToroidalSurface(FRAME, 9.0, 2.5))
    points = TColgp_Array2OfPnt(1, 12, 1, 9)
    for i in range(1, 13):
        for j in range(1, 10):
            points.SetValue(i, j, gp_Pnt(4.0 * i, 4.0 * j, 1.5 * np.sin(0.5 * i) * np.cos(0.4 * j)))
    return GeomAPI_PointsToBSplineSurface(points).Surface()


def tube() -> Geom_BSplineSurface:
    """A periodic B-spline surface without weights, as a loft between two closed splines is."""
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    poles, knots, lengthwise = TColgp_Array2OfPnt(1, 8, 1, 2), TColStd_Array1OfReal(1, 9), TColStd_Array1OfReal(1, 2)
    once, twice = TColStd_Array1OfInteger(1, 9), TColStd_Array1OfInteger(1, 2)
    once.Init(1)
    twice.Init(2)
    for i in range(8):
        for j in range(2):
            radius, angle = 20.0 - 8.0 * j, np.pi / 4.0 * i
            poles.SetValue(i + 1, j + 1, gp_Pnt(1.5 * radius * np.cos(angle), radius * np.sin(angle), -10.0 * j))
    for i in range(9):
        knots.SetValue(i + 1, float(i))
    for j in range(2):
        lengthwise.SetValue(j + 1, float(j))
    return Geom_BSplineSurface(poles, knots, lengthwise, once, twice, 3, 1, True, False)


def parametric(surface: Geom_BSplineSurface, count: int = 60) -> Parametric:
    """Our surface, seeded with a grid."""
    nurbs = nurbs_of(surface)
    u0, u1, v0, v1 = nurbs.bounds
    uv = np.array([(u, v) for u in np.linspace(u0, u1, count) for v in np.linspace(v0, v1, count)])
    return Parametric(nurbs, nurbs.bounds, nurbs(uv)[0], uv)


@pytest.mark.parametrize("made", [wavy_surface, lambda: wavy_surface(periodic=True), tube])
def test_nurbs_evaluates_as_the_kernel_does(made: Callable[[], Geom_BSplineSurface]) -> None:
    surface = made()
    nurbs = nurbs_of(surface)
    u0, u1, v0, v1 = nurbs.bounds
    uv = np.random.default_rng(3).uniform((u0, v0), (u1, v1), (200, 2))
    uv[:4] = [(u0, v0), (u0, v1), (u1, v0), (u1, v1)]
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    for (u, v), *ours in zip(uv, *nurbs(uv), strict=True):
        surface.D1(u, v, point, along_u, along_v)
        for mine, theirs in zip(ours, (point, along_u, along_v), strict=True):
            assert mine == pytest.approx([theirs.X(), theirs.Y(), theirs.Z()], abs=1e-10)


def test_feet_are_found_round_a_pole_and_across_a_seam() -> None:
    from OCP.Geom import Geom_SphericalSurface
    from OCP.GeomConvert import GeomConvert

    ours = parametric(GeomConvert.SurfaceToBSplineSurface_s(Geom_SphericalSurface(gp_Ax3(), 5.0)), 20)
    random = np.random.default_rng(5)
    directions = np.concatenate([random.normal(size=(300, 3)), random.normal(size=(300, 3)) * (0.1, 0.1, 1.0)])
    directions[:100, 1] *= 0.01  # beside the seam, and opposite
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    lifts = random.uniform(-1.0, 1.0, len(directions))
    assert np.abs(ours.distance((5.0 + lifts)[:, None] * directions) - lifts).max() < 1e-8
    assert np.abs(ours.normal((5.0 + lifts)[:, None] * directions) - directions).max() < 1e-4


def test_freeform_distance_agrees_with_the_kernel() -> None:
    surface = wavy_surface()
    ours = parametric(surface)
    u0, u1, v0, v1 = ours.bounds
    random = np.random.default_rng(4)
    uv = random.uniform((u0 + 0.1, v0 + 0.1), (u1 - 0.1, v1 - 0.1), (150, 2))
    heights = random.uniform(-0.5, 0.5, 150)
    points, along_u, along_v = ours.evaluate(uv)
    normals = np.cross(along_u, along_v)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    lifted = points + heights[:, None] * normals
    assert ours.distance(lifted) == pytest.approx(heights, abs=1e-9)
    assert ours.normal(lifted) == pytest.approx(normals, abs=1e-6)
    for point, height in zip(lifted[:40], heights[:40], strict=True):
        assert kernel_distance(surface, point)[0] == pytest.approx(abs(height), abs=1e-7)
