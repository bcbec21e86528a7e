"""Curves that a reader finds in a part: its edges, and the rails of its ruled faces."""

from __future__ import annotations

import copy
from pathlib import Path

import numpy as np
import pytest

import styluscam as sc
from styluscam.errors import GeometryError
from styluscam.flank.rails import Rail
from styluscam.parts import cache
from styluscam.parts.ruled import rails_of, ruled_faces
from styluscam.parts.surfaces import Cone, Cylinder, Nurbs, Parametric, Plane
from styluscam.types import FloatArray

BLADE = Path(__file__).resolve().parents[2] / "fixtures" / "blade.step"
SHARES = np.linspace(0.0, 1.0, 33)


def bezier(poles: FloatArray, shares: FloatArray) -> FloatArray:
    a, b, c = poles
    t = shares[:, None]
    return np.asarray((1 - t) ** 2 * a + 2 * t * (1 - t) * b + t**2 * c)


def turned(poles: FloatArray, z: float, degrees: float, scale: float) -> FloatArray:
    sin, cos = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    x, y = scale * (poles[:, 0] - 30.0), scale * poles[:, 1]
    return np.stack([x * cos - y * sin, x * sin + y * cos, np.full(3, z)], axis=1)


@pytest.fixture(scope="module")
def blade() -> sc.Part:
    return sc.Part.read(BLADE)


def test_the_sides_of_a_blade_are_ruled_between_its_edges(blade: sc.Part) -> None:
    assert blade.arrays is not None
    found = ruled_faces(blade.arrays)
    assert sorted(found) == [1, 2], "not the plane ends"
    sides = [np.array([[0.0, 0.0], [22.0, y], [60.0, 0.0]]) for y in (16.0, -7.0)]
    curves = [(bezier(turned(s, 0.0, 0.0, 1.0), SHARES), bezier(turned(s, 30.0, 14.0, 0.85), SHARES)) for s in sides]
    for rails in found.values():
        points = sorted((rail.at(SHARES) for rail in rails), key=lambda p: float(p[0, 2]))
        off = min(
            max(float(np.abs(p - c[::step]).max()) for p, c in zip(points, pair, strict=True))
            for pair in curves
            for step in (1, -1)
        )
        assert off < 1e-9
    # and both are edges
    edges = [edge for edge in blade.arrays.edges if edge is not None]
    assert len(edges) == len(blade.arrays.edges) == 6
    for rails in found.values():
        for rail in rails:
            own = rail.at(SHARES)
            assert min(np.abs(edge.at(SHARES)[::step] - own).max() for edge in edges for step in (1, -1)) < 1e-9


def test_curves_are_kept_with_the_part(blade: sc.Part, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert blade.arrays is not None
    monkeypatch.setenv("STYLUSCAM_CACHE", str(tmp_path))
    cache.keep("blade", blade.arrays)
    kept = cache.kept("blade", "blade.step")
    assert kept is not None
    for before, after in zip(blade.arrays.edges, kept.edges, strict=True):
        assert before is not None and after is not None
        np.testing.assert_array_equal(before.poles, after.poles)
        np.testing.assert_array_equal(before.knots, after.knots)
    job = job_of(copy.deepcopy(blade))
    assert len(sc.plan(job).programs["main"].moves) > 20


def job_of(part: sc.Part) -> sc.Job:
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(BLADE), "faces": ["Face1"]},
            "process": {"kind": "milling"},
            "tools": {"mill": {"profile": {"kind": "flat", "diameter": 8.0}, "length": 60.0}},
            "operations": [{"kind": "flank", "tool": "mill", "spindle": {"mode": "fixed", "rpm": 8000.0}}],
            "machine": {"name": "linuxcnc-trunnion"},
        }
    )


def random_spline(random: np.random.Generator, degree: int, count: int) -> Rail:
    inner = np.sort(random.uniform(0.0, 1.0, count - degree - 1))
    if len(inner) > 3:
        inner[1] = inner[2]
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return Rail(degree, knots, random.normal(size=(count, 3)), random.uniform(0.5, 2.0, count))


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_a_part_of_a_spline_is_the_same_curve(degree: int) -> None:
    random = np.random.default_rng(degree)
    for count in (degree + 1, degree + 3, degree + 9):
        rail = random_spline(random, degree, count)
        for first, last in (
            (0.0, 1.0),
            (0.1, 0.9),
            (0.0, 0.5),
            (0.3, 1.0),
            (0.41, 0.47),
            (rail.knots[degree + 1], 0.97),
        ):
            if last - first < 0.01:
                continue
            part = rail.between(float(first), last)
            off = np.abs(part.at(SHARES) - rail.at(first + (last - first) * SHARES)).max()
            assert off < 1e-12, (count, first, last)


def surface_between(first: Rail, second: Rail) -> Parametric:
    poles = np.stack([first.poles, second.poles], axis=1)
    weights = np.stack([first.weights, second.weights], axis=1)
    nurbs = Nurbs(first.degree, 1, first.knots, np.array([0.0, 0.0, 1.0, 1.0]), poles, weights)
    return Parametric(nurbs, nurbs.bounds, np.zeros((0, 3)), np.zeros((0, 2)))


def test_a_trimmed_surface_has_the_rails_of_its_face() -> None:
    base = np.array([[0.0, 0.0, 0.0], [15.0, 8.0, 0.0], [40.0, -3.0, 0.0], [60.0, 0.0, 0.0]])
    knots = np.array([0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0])
    first = Rail(2, knots, base, np.ones(4))
    second = Rail(2, knots, base[:, [0, 1, 2]] + [2.0, 5.0, 30.0], np.ones(4))
    surface = surface_between(first, second)
    uv = np.array([[u, v] for u in (0.2, 0.5, 0.7) for v in (0.25, 0.75)])
    trimmed = Parametric(surface.evaluate, surface.bounds, surface.evaluate(uv)[0], uv)
    found = rails_of(trimmed, trimmed.seed_points)
    assert found is not None
    for rail, v in zip(found, (0.25, 0.75), strict=True):
        inside = 0.2 + 0.5 * SHARES
        np.testing.assert_allclose(rail.at(SHARES), (1 - v) * first.at(inside) + v * second.at(inside), atol=1e-12)


@pytest.mark.parametrize("semi_angle", [0.0, 0.2, -0.1])
def test_arcs_are_the_rails_of_cylinders_and_cones(semi_angle: float) -> None:
    axis = np.array([0.0, 0.6, 0.8])
    arguments = ((1.0, 2.0, 3.0), tuple(axis), 10.0)
    surface = Cone(*arguments, semi_angle) if semi_angle else Cylinder(*arguments)
    across = np.array([1.0, 0.0, 0.0])
    beside = np.cross(axis, across)
    angles, heights = np.meshgrid(np.radians(np.linspace(-150.0, 120.0, 91)), [2.0, 9.0, 12.0])
    radii = 10.0 + np.tan(semi_angle) * heights
    around = np.cos(angles)[..., None] * across + np.sin(angles)[..., None] * beside
    points = (np.array([1.0, 2.0, 3.0]) + heights[..., None] * axis + radii[..., None] * around).reshape(-1, 3)
    found = rails_of(surface, points)
    assert found is not None
    for rail, height in zip(found, (2.0, 12.0), strict=True):
        own = rail.at(SHARES)
        assert np.abs(surface.distance(own)).max() < 1e-8
        np.testing.assert_allclose((own - [1.0, 2.0, 3.0]) @ axis, height, atol=1e-8)
        length = np.linalg.norm(np.diff(rail.at(np.linspace(0, 1, 2001)), axis=0), axis=1).sum()
        assert abs(length - (10.0 + np.tan(semi_angle) * height) * np.radians(270.0)) < 1e-3


def test_what_goes_all_around_begins_where_it_ends() -> None:
    angles, heights = np.meshgrid(np.radians(np.arange(0.0, 360.0, 10.0)), [0.0, 9.0])
    points = np.stack([5.0 * np.cos(angles), 5.0 * np.sin(angles), heights], axis=-1).reshape(-1, 3)
    rails = rails_of(Cylinder((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 5.0), points)
    assert rails is not None
    for rail in rails:
        around = rail.at(np.linspace(0.0, 1.0, 721))
        np.testing.assert_allclose(around[0], around[-1], atol=1e-9)
        assert abs(np.linalg.norm(np.diff(around, axis=0), axis=1).sum() - 10.0 * np.pi) < 1e-3


def test_surfaces_that_bend_both_ways_and_planes_have_none() -> None:
    poles = np.array([[[x, y, 0.05 * x * x - 0.04 * y * y] for y in (0.0, 10.0, 20.0)] for x in (0.0, 10.0, 20.0)])
    knots = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    nurbs = Nurbs(2, 2, knots, knots, poles, np.ones((3, 3)))
    uv = np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]])
    bent = Parametric(nurbs, nurbs.bounds, nurbs(uv)[0], uv)
    assert rails_of(bent, bent.seed_points) is None
    assert rails_of(Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), bent.seed_points) is None


def test_a_rail_that_is_none_is_refused() -> None:
    with pytest.raises(GeometryError):
        Rail.of(np.zeros((3, 3)))
