"""Refining, checking, welding: on meshes made by hand, without a CAD kernel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from styluscam.errors import GeometryError
from styluscam.parts.assembly import check_areas
from styluscam.parts.progress import AttemptSteps
from styluscam.parts.surfaces import Cylinder, Parametric, Plane, Sphere
from styluscam.parts.tessellation import (
    Deviation,
    FaceMesh,
    Tessellation,
    deviation,
    is_closed,
    refine,
    refine_until,
    weld,
)

OCTAHEDRON = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
EIGHT = np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (1, 0, 5), (2, 1, 5), (3, 2, 5), (0, 3, 5)])


def sphere_mesh(radius: float = 10.0) -> FaceMesh:
    return FaceMesh(radius * OCTAHEDRON, EIGHT)


def dense_deviation(mesh: FaceMesh, radius: float, order: int = 24) -> float:
    """Depth of the mesh below a sphere by far denser sampling."""
    weights = np.array([(i, j, order - i - j) for i in range(order + 1) for j in range(order + 1 - i)]) / order
    points = (weights @ mesh.nodes[mesh.triangles]).reshape(-1, 3)
    return float((radius - np.linalg.norm(points, axis=1)).max())


@pytest.mark.parametrize("tolerance", [0.3, 0.01])
def test_refined_sphere_holds_and_stays_watertight(tolerance: float) -> None:
    mesh, left = refine(sphere_mesh(), Sphere((0, 0, 0), 10.0), tolerance)
    true = dense_deviation(mesh, 10.0)
    assert true <= left.inward <= 1.08 * true
    assert left.inward <= tolerance
    assert left.outward == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(mesh.nodes, axis=1) == pytest.approx(10.0, abs=1e-12)
    assert is_closed(mesh.triangles)
    assert left == deviation(mesh, Sphere((0, 0, 0), 10.0))


def test_hole_deviates_outward_shaft_inward() -> None:
    angles = np.radians([0.0, 10.0, 10.0])
    mesh = FaceMesh(np.stack([5 * np.cos(angles), 5 * np.sin(angles), [0.0, 0.0, 3.0]], axis=1), np.array([[0, 1, 2]]))
    sagitta = 5.0 * (1.0 - np.cos(np.radians(5.0)))
    shaft, hole = (deviation(mesh, Cylinder((0, 0, 0), (0, 0, 1), 5.0, sign)) for sign in (1.0, -1.0))
    assert (shaft.inward, shaft.outward) == (pytest.approx(sagitta / 0.93), pytest.approx(0.0, abs=1e-14))
    assert (hole.inward, hole.outward) == (pytest.approx(0.0, abs=1e-14), pytest.approx(sagitta / 0.93))


def test_plane_deviation_is_that_of_its_corners() -> None:
    mesh = FaceMesh(np.array([(0, 0, 0.002), (1, 0, 0), (0, 1, -0.003)]), np.array([[0, 1, 2]]))
    found = deviation(mesh, Plane((0, 0, 0), (0, 0, 1)))
    assert (found.inward, found.outward) == (pytest.approx(0.003), pytest.approx(0.002))


def test_a_border_that_does_not_hold_is_left_to_the_mesher() -> None:
    mesh = FaceMesh(sphere_mesh().nodes, EIGHT[:4])  # the upper half: its equator is a border
    refined, left = refine(mesh, Sphere((0, 0, 0), 10.0), 0.1)
    assert refined is mesh
    assert left.inward > 2.0
    assert left.outward == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("count", [12, 24])
def test_border_sides_are_not_split(count: int) -> None:
    """The sides on the equator are the worst that is left, yet a neighbour shares them."""
    angles = 2.0 * np.pi * np.arange(count) / count
    tolerance = 1.15 * 10.0 * (1.0 - np.cos(np.pi / count))
    equator = 10.0 * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    fan = np.stack([np.arange(count), (np.arange(count) + 1) % count, np.full(count, count)], axis=1)
    mesh = FaceMesh(np.concatenate([equator, [[0.0, 0.0, 10.0]]]), fan)
    refined, left = refine(mesh, Sphere((0, 0, 0), 10.0), tolerance)
    assert len(refined.nodes) > 3 * count
    assert np.count_nonzero(np.abs(refined.nodes[:, 2]) < 1e-9) == count
    assert left.worst <= tolerance


def test_corners_off_the_surface_are_not_refined_without_end() -> None:
    mesh = FaceMesh(sphere_mesh(10.1).nodes, EIGHT)
    refined, left = refine(mesh, Sphere((0, 0, 0), 10.0), 0.01)
    assert left.outward >= 0.1
    sound, _ = refine(sphere_mesh(), Sphere((0, 0, 0), 10.0), 0.01)
    assert len(refined.triangles) < 1.1 * len(sound.triangles)


def ring(deflection: float, radius: float = 10.0) -> FaceMesh:
    """A cylinder's side, its borders within the deflection."""
    count = int(np.ceil(np.pi / np.arccos(1.0 - deflection / radius)))
    angles = 2.0 * np.pi * np.arange(count) / count
    circle = radius * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    i, j = np.arange(count), (np.arange(count) + 1) % count
    triangles = np.concatenate([np.stack([i, j, j + count], axis=1), np.stack([i, j + count, i + count], axis=1)])
    return FaceMesh(np.concatenate([circle, circle + np.array([0, 0, 20])]), triangles)


def test_mesher_that_misses_its_bound_is_asked_again() -> None:
    asked: list[float] = []

    def mesh_at(deflection: float) -> list[FaceMesh]:
        asked.append(deflection)
        return [ring(3.0 * deflection)]

    found = refine_until(mesh_at, [Cylinder((0, 0, 0), (0, 0, 1), 10.0)], 0.01)
    assert 2 <= len(asked) == found.rounds <= 3
    assert asked == sorted(asked, reverse=True)
    assert 0.002 < found.deviations[0].inward <= 0.01


def test_the_check_is_seen_to_move() -> None:
    shares: list[float] = []
    refine_until(
        lambda d: [ring(d), sphere_mesh()],
        [Cylinder((0, 0, 0), (0, 0, 1), 10.0), Sphere((0, 0, 0), 10.0)],
        0.01,
        checked=shares.append,
    )
    assert shares == sorted(shares) and len(shares) > 5 and 0.5 < shares[-1] <= 1.0
    reported: list[tuple[str, float]] = []
    steps = AttemptSteps(lambda phase, fraction: reported.append((phase, fraction)))
    for _ in range(3):
        steps.begin()
        for share in np.linspace(0.0, 1.0, 2000):
            steps.checked(share)
    fractions = [fraction for _, fraction in reported]
    assert fractions == sorted(fractions) and fractions[0] == pytest.approx(0.3) and 0.88 < fractions[-1] < 0.9
    assert len(reported) < 130 and {phase for phase, _ in reported} == {"mesh", "check"}


def test_mesher_that_never_holds_is_an_error() -> None:
    with pytest.raises(GeometryError, match="Face1: its mesh stays") as caught:
        refine_until(lambda _: [ring(0.5)], [Cylinder((0, 0, 0), (0, 0, 1), 10.0)], 0.01, "a.step")
    assert caught.value.code == "part-tolerance-missed"
    assert caught.value.where == "a.step:Face1"


def test_edges_off_the_surface_are_allowed_what_they_are_off() -> None:
    """A file whose edges lie 2.6 um off its surfaces is not made better by refusing it: it is reported."""
    found = refine_until(lambda d: [ring(d)], [Cylinder((0, 0, 0), (0, 0, 1), 10.0026)], 0.001)
    assert found.edge_gaps == (pytest.approx(0.0026, abs=1e-6),)
    assert 0.0026 < found.deviations[0].inward <= 0.001 + 1.25 * 0.0026
    exact = refine_until(lambda d: [ring(d)], [Cylinder((0, 0, 0), (0, 0, 1), 10.0)], 0.001)
    assert exact.edge_gaps[0] < 1e-9 and exact.deviations[0].inward <= 0.001


def test_edges_nowhere_near_the_surface_are_named_as_such() -> None:
    with pytest.raises(GeometryError, match="a gap to its neighbours") as caught:
        refine_until(lambda d: [ring(d)], [Cylinder((0, 0, 0), (0, 0, 1), 10.3)], 0.01, "a.step")
    assert caught.value.code == "part-inexact-edges" and caught.value.where == "a.step:Face1"
    assert refine_until(lambda d: [ring(d)], [Cylinder((0, 0, 0), (0, 0, 1), 10.3)], 0.4).edge_gaps[0] > 0.29


def square(overlap: float = 0.0, missing: float = 0.0) -> FaceMesh:
    """A square of 1 mm^2, of which a part is covered twice, or not at all."""
    nodes = np.array([(0, 0, 0), (1, 0, 0), (1, 1 - missing, 0), (0, 1 - missing, 0), (1, 1 - overlap, 0)], dtype=float)
    triangles = [(0, 1, 2), (0, 2, 3)] + ([(2, 3, 4)] if overlap else [])
    return FaceMesh(nodes, np.array(triangles))


@pytest.mark.parametrize(
    ("mesh", "reported"),
    [
        (square(), ""),
        (square(overlap=0.08), "overlap, they cover 4.0 % more"),
        (square(overlap=0.9), "lie over each other"),
        (square(missing=0.04), "a part of it would not be machined"),
    ],
)
def test_triangles_that_overlap_a_little_are_a_note(mesh: FaceMesh, reported: str) -> None:
    found = Tessellation((mesh,), (Deviation(0.0, 0.0),), (0.0,), 1e-3, 1)
    areas = [(1.0, (0.5, 0.5, 0.0))]
    if reported.startswith("overlap"):
        assert reported in check_areas(Path("a.step"), found, areas)[0]
    elif reported:
        with pytest.raises(GeometryError, match=reported) as caught:
            check_areas(Path("a.step"), found, areas)
        assert caught.value.where == "a.step:Face1" and caught.value.hint
    else:
        assert check_areas(Path("a.step"), found, areas) == ()
    coarse = [(1.04 if not reported else 1.0, (0.5, 0.5, 0.0))]
    if not reported:  # a quadrature of few points is not the face's fault
        assert check_areas(Path("a.step"), found, coarse, lambda _: 1.0) == ()


def test_weld_merges_across_rounding_and_drops_collapsed() -> None:
    shift = np.array([0.4e-9, -0.4e-9, 0.5e-9])
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
    points[3:] += shift
    triangles = np.array([(0, 1, 2), (3, 4, 5), (1, 3, 4)])
    vertices, welded, kept = weld(points, triangles)
    assert len(vertices) == 4
    assert kept.tolist() == [0, 1]
    assert len(np.unique(welded)) == 4
    assert np.array_equal(vertices[welded[0]], points[:3])


def test_closed_means_each_edge_twice_in_opposite_directions() -> None:
    assert is_closed(EIGHT)
    assert not is_closed(EIGHT[1:])
    turned = EIGHT.copy()
    turned[3] = turned[3, ::-1]
    assert not is_closed(turned)
    assert not is_closed(np.concatenate([EIGHT, EIGHT]))
    assert not is_closed(np.zeros((0, 3), dtype=np.int64))


def test_a_surface_that_swings_about_a_triangle_is_seen_and_followed() -> None:
    """Corners and the middles of all sides lie on the surface: only the samples between them see it."""

    def wave(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        u, v = uv.T
        one, none = np.ones(len(u)), np.zeros(len(u))
        height = 0.2 * np.sin(2 * np.pi * u) * np.sin(2 * np.pi * v)
        slope_u = 0.4 * np.pi * np.cos(2 * np.pi * u) * np.sin(2 * np.pi * v)
        slope_v = 0.4 * np.pi * np.sin(2 * np.pi * u) * np.cos(2 * np.pi * v)
        along = (np.stack([4 * u, 4 * v, height], axis=1), np.stack([4 * one, none, slope_u], axis=1))
        return (*along, np.stack([none, 4 * one, slope_v], axis=1))

    count = 5
    grid = np.array([(i, j) for i in range(count) for j in range(count)], dtype=float)
    quads = [(i * count + j, (i + 1) * count + j) for i in range(count - 1) for j in range(count - 1)]
    triangles = np.array([t for a, b in quads for t in ((a, b, b + 1), (a, b + 1, a + 1))])
    nodes = wave(grid)[0]
    surface = Parametric(wave, (0.0, 4.0, 0.0, 4.0), nodes, grid)
    mesh = FaceMesh(nodes, triangles, grid)
    assert np.abs(nodes[:, 2]).max() < 1e-12
    assert deviation(mesh, surface).worst > 0.1
    refined, left = refine(mesh, surface, 0.01)
    assert len(refined.triangles) < 40_000
    weights = np.random.default_rng(6).dirichlet((1.0, 1.0, 1.0), size=len(refined.triangles))
    points = np.einsum("tk,tkd->td", weights, refined.nodes[refined.triangles])
    height = points[:, 2] - 0.2 * np.sin(np.pi / 2 * points[:, 0]) * np.sin(np.pi / 2 * points[:, 1])
    assert np.abs(height).max() < 0.0111  # measured along Z, where the surface slopes by 17 degrees at most
    assert left.worst <= 0.01


def test_slivers_along_a_side_that_the_surface_crosses_at_its_samples_are_refined() -> None:
    """The longest side of a sliver bows nowhere where it is sampled: it has to go with the sides that do."""

    def wave(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        u, v = uv.T
        one, none, ends = np.ones(len(u)), np.zeros(len(u)), u * (4.0 - u) / 4.0  # nothing at the border
        near = 0.1 * np.exp(-((v / 0.3) ** 2)) * ends
        height, slope = near * ends * np.sin(np.pi * u), near * (2.0 - u) * np.sin(np.pi * u)
        along_u = np.stack([one, none, slope + near * ends * np.pi * np.cos(np.pi * u)], axis=1)
        return np.stack([u, v, height], axis=1), along_u, np.stack([none, one, -2.0 * v / 0.09 * height], axis=1)

    plan = np.array(
        [(0.0, 0.0), (4.0, 0.0), (2.0, 3.0), (2.0, -3.0), (1.2, 0.0)]
    )  # the last lies between the first two
    mesh = FaceMesh(wave(plan)[0], np.array([(0, 1, 2), (0, 4, 1), (0, 3, 4), (4, 3, 1)]), plan)
    refined, left = refine(mesh, Parametric(wave, (-1.0, 5.0, -4.0, 4.0), mesh.nodes, plan), 0.002)
    assert left.worst <= 0.002
    assert len(refined.triangles) < 20_000
