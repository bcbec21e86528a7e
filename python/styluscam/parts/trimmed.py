"""Faces on elementary surfaces within their edges, as a CAD kernel describes them, and their triangles by the engine.

An edge gets its points once, and both faces beside it take them: their triangles fit together. A model with other surfaces
than planes, cylinders, cones, spheres and tori is left to the kernel's own mesher, whole.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from styluscam.parts.arrays import surface_area
from styluscam.parts.assembly import AREA_SHARE
from styluscam.parts.surfaces import Elementary, ExactSurface, Floats, Plane, Vector, unit
from styluscam.parts.tessellation import FaceMesh

# Largest turn (rad) between neighbouring segments of an edge: it decides only on arcs below 65 times the deflection.
ANGLE = 0.35
# So often the engine's mesher is tried; where its edges still do not hold the tolerance, the kernel's is.
OWN_ATTEMPTS = 2
# What edges may be off, and the insides, as parts of the deflection. A chord takes all of its part in its middle, where a
# triangle inside adds its own; the insides' bound is missed by some 4 % of the triangles, which are split afterwards.
ON_EDGES, INSIDE = 0.85, 0.98
# An edge that is no line and no circle begins with so many segments, and is halved so often at most.
SEGMENTS, HALVINGS = 4, 14
# At so many even fractions an edge's parameters on its face are asked for.
GUIDES = 5
# What a convex face's triangles may be off, as a part of the tolerance, where hollow faces are in the model as well:
# planning pays for the sum of both sides, and the hollow ones take all of theirs.
CONVEX_BESIDE_HOLLOW = 0.45

Evaluated = Callable[[float], Vector]


@dataclass(frozen=True)
class Edge:
    """An edge: `value(t)` is its point, mm, for t between the two of `span`; `ends` are its vertices.

    `radius` is that of a circle's arc; 0 a line's or a pole's, which needs no points between its ends; None any other's.
    """

    value: Evaluated
    span: tuple[float, float]
    ends: tuple[Vector, Vector]
    radius: float | None


@dataclass(frozen=True)
class EdgeUse:
    """An edge, by index, beside a face, and its parameters on the face at GUIDES even fractions; a seam is used twice."""

    edge: int
    guides: list[tuple[float, float]]


@dataclass(frozen=True)
class Face:
    """A face: its surface's points by the kernel's parameters, one pair of these within it, what is around it, its area."""

    value: Callable[[float, float], Vector]
    middle: tuple[float, float]
    uses: Sequence[EdgeUse]
    area: float


@dataclass(frozen=True)
class Model:
    """All faces of a model, and the edges that they share."""

    edges: Sequence[Edge]
    faces: Sequence[Face]

    def meshes(self, surfaces: Sequence[ExactSurface], deflection: float) -> list[FaceMesh] | None:
        """Return each face's triangles, whose edges are within `deflection` mm, and nearly all of whose insides are.

        Of convex faces beside hollow ones a part of that, see :func:`shares`. None where a face's edges do not close, or do not
        enclose its area.
        """
        of_faces = shares(surfaces)
        of_edges = [1.0] * len(self.edges)
        for face, share in zip(self.faces, of_faces, strict=True):
            for use in face.uses:
                of_edges[use.edge] = min(of_edges[use.edge], share)
        points = [
            edge_points(edge, ON_EDGES * share * deflection) for edge, share in zip(self.edges, of_edges, strict=True)
        ]
        found = []
        for face, surface, share in zip(self.faces, surfaces, of_faces, strict=True):
            assert isinstance(surface, Elementary)
            mesh = _face_mesh(face, surface, points, INSIDE * share * deflection)
            if mesh is None:
                return None
            found.append(mesh)
        return found


def shares(surfaces: Sequence[ExactSurface]) -> list[float]:
    """Return what part of the tolerance each face's triangles should keep to."""
    bent = [surface for surface in surfaces if not isinstance(surface, Plane)]
    both = {surface.sign > 0.0 for surface in bent if isinstance(surface, Elementary)} == {True, False}
    is_convex = [isinstance(s, Elementary) and not isinstance(s, Plane) and s.sign > 0.0 for s in surfaces]
    return [CONVEX_BESIDE_HOLLOW if both and convex else 1.0 for convex in is_convex]


def edge_points(edge: Edge, deflection: float) -> tuple[Floats, list[float]]:
    """Return points (N,3) along an edge whose chords are within `deflection` mm of it, and their fractions of its span."""
    if edge.radius == 0.0:
        fractions = [0.0, 1.0]
    elif edge.radius is not None:
        first, last = edge.span
        turn = 2.0 * math.acos(max(1.0 - deflection / edge.radius, 0.0))
        count = max(1, math.ceil(abs(last - first) / min(turn, ANGLE) - 1e-9))
        fractions = [i / count for i in range(count + 1)]
    else:
        fractions = _halved(edge, deflection)
    points = [edge.ends[0], *(_at(edge, fraction) for fraction in fractions[1:-1]), edge.ends[1]]
    return np.array(points), fractions


def _at(edge: Edge, fraction: float) -> Vector:
    first, last = edge.span
    return edge.value(first + fraction * (last - first))


def _halved(edge: Edge, deflection: float) -> list[float]:
    """Return fractions of an edge's span, from a few by halving what its chords leave out or turn too far."""
    fractions = np.linspace(0.0, 1.0, SEGMENTS + 1)
    for _ in range(HALVINGS):
        inner = fractions[:-1, None] + np.diff(fractions)[:, None] * np.array([0.0, 0.25, 0.5, 0.75, 1.0])
        points = np.array([_at(edge, t) for t in inner.reshape(-1).tolist()]).reshape(-1, 5, 3)
        bows = _off_chord(points) > deflection
        legs = unit(np.diff(points, axis=1).reshape(-1, 3)).reshape(-1, 4, 3)
        turns = np.einsum("ij,ij->i", legs[:, 0], legs[:, -1]) < math.cos(0.75 * ANGLE)
        # within a tenth of the deflection even a sharp turn is flat
        split = bows | (turns & (_off_chord(points) > 0.1 * deflection))
        if not split.any():
            break
        fractions = np.sort(np.concatenate([fractions, (fractions[:-1] + np.diff(fractions) / 2.0)[split]]))
    return [float(fraction) for fraction in fractions]


def _off_chord(points: Floats) -> Floats:
    """Return how far the points (S,5,3) of each segment are from its chord at most, (S,) mm."""
    chord = points[:, -1] - points[:, 0]
    away = points[:, 1:-1] - points[:, :1]
    square = np.maximum(np.einsum("ij,ij->i", chord, chord), 1e-300)
    share = np.clip(np.einsum("ijk,ik->ij", away, chord) / square[:, None], 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * chord[:, None], axis=2).max(axis=1))


def _face_mesh(
    face: Face, surface: Elementary, points: Sequence[tuple[Floats, list[float]]], deviation: float
) -> FaceMesh | None:
    engine = surface.engine(*_directions(face, surface))
    found = engine.mesh([(*points[use.edge], use.guides) for use in face.uses], deviation)
    if found is None:
        return None
    nodes, triangles = found
    meshed = surface_area(nodes, triangles)
    around = [np.linalg.norm(np.diff(points[use.edge][0], axis=0), axis=1).sum() for use in face.uses]
    slack = AREA_SHARE * face.area + float(sum(around)) * deviation + 1e-6
    return FaceMesh(nodes, triangles) if abs(meshed - face.area) <= slack else None


def _directions(face: Face, surface: Elementary) -> tuple[Vector, tuple[Vector, Vector]]:
    """Return the axis about which the kernel counts angles on a face, and where it counts from and to.

    Points a half turn apart lie on both sides of the axis, whichever nappe of a cone the face is on.
    """
    v = face.middle[1]
    start, quarter, half, rest = (np.array(face.value(k * math.pi / 2.0, v)) for k in range(4))
    from_axis, to = start - half, quarter - rest
    axis = getattr(surface, "axis", None)
    if axis is None:  # of a sphere: the way to the pole of the upper latitudes
        axis = tuple(np.array(face.value(0.0, math.pi / 2.0)) - np.array(surface.location))
    return axis, (tuple(from_axis), tuple(to))
