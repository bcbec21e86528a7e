# SPDX-License-Identifier: LGPL-2.1-or-later
"""The edges around FreeCAD's faces: for the engine's mesher, and as curves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from styluscam.flank.rails import Rail
    from styluscam.parts.surfaces import ExactSurface, Vector
    from styluscam.parts.trimmed import Edge, EdgeUse, Face, Model


SLITS = ("Internal", "External")
"""Orientations of edges that are no border: the face is on both of their sides."""


def model_of(faces: Sequence[Any], surfaces: Sequence[ExactSurface]) -> Model | None:
    """A shape's faces within their edges; None where a surface is not elementary, or an edge lacks its curves."""
    import Part

    from styluscam.parts.surfaces import Elementary
    from styluscam.parts.trimmed import Model

    if not all(isinstance(surface, Elementary) for surface in surfaces):
        return None
    edges = _Edges()
    try:
        described = [_face(face, edges) for face in faces]
        return Model([_edge(shape) for shape in edges.shapes], described)
    except (Part.OCCError, RuntimeError, TypeError, ValueError):
        return None


def curves_of(shape: Any) -> tuple[Rail | None, ...]:
    """The curves of a shape's edges from end to end, Edge1's first; None for an edge without one."""
    return tuple(_curve(edge) for edge in shape.Edges)


def _curve(edge: Any) -> Rail | None:
    import Part

    from styluscam.flank.rails import Rail

    if edge.Degenerated:
        return None
    try:
        curve = edge.Curve.toBSpline(*edge.ParameterRange)
        if curve.isPeriodic():
            curve.setNotPeriodic()
    except (Part.OCCError, AttributeError, RuntimeError, TypeError):
        return None
    poles = np.array([_xyz(pole) for pole in curve.getPoles()])
    return Rail(int(curve.Degree), np.array(curve.KnotSequence), poles, np.array(curve.getWeights()))


class _Edges:
    """The edges seen so far, each once, whichever way it is run."""

    def __init__(self) -> None:
        self.shapes: list[Any] = []
        self._by_hash: dict[int, list[int]] = {}

    def index(self, shape: Any) -> int:
        """An edge's number; a new one for an edge that was not seen."""
        known = self._by_hash.setdefault(shape.hashCode(), [])
        for number in known:
            if self.shapes[number].isSame(shape):
                return number
        known.append(len(self.shapes))
        self.shapes.append(shape)
        return known[-1]


def _edge(shape: Any) -> Edge:
    """An edge's curve; raises ValueError where it has no ends."""
    import Part

    from styluscam.parts.trimmed import Edge

    vertices = (shape.firstVertex(), shape.lastVertex())
    if any(vertex.isNull() for vertex in vertices):
        raise ValueError("an edge without ends")
    ends = (_xyz(vertices[0].Point), _xyz(vertices[1].Point))
    if shape.Degenerated:
        return Edge(lambda _: ends[0], (0.0, 1.0), ends, 0.0)
    curve = shape.Curve
    radius = None
    if isinstance(curve, (Part.Line, Part.LineSegment)):
        radius = 0.0
    elif isinstance(curve, Part.Circle):
        radius = float(curve.Radius)
    return Edge(lambda t: _xyz(shape.valueAt(t)), tuple(shape.ParameterRange), ends, radius)


def _face(face: Any, edges: _Edges) -> Face:
    from styluscam.parts.trimmed import Face

    u0, u1, v0, v1 = face.ParameterRange
    uses: list[EdgeUse] = []
    for wire in face.Wires:
        for edge in wire.Edges:
            use = _use(face, edge, edges)
            uses.append(use)
            if edge.Orientation in SLITS:
                uses.append(use)
            elif edge.isSeam(face):
                uses.append(_use(face, edge.reversed(), edges))
    return Face(lambda u, v: _xyz(face.valueAt(u, v)), ((u0 + u1) / 2.0, (v0 + v1) / 2.0), uses, face.Area)


def _use(face: Any, edge: Any, edges: _Edges) -> EdgeUse:
    from styluscam.parts.trimmed import GUIDES, EdgeUse

    curve, first, last = face.curveOnSurface(edge)
    at = [curve.value(t) for t in np.linspace(first, last, GUIDES).tolist()]
    return EdgeUse(edges.index(edge), [(point.x, point.y) for point in at])


def _xyz(vector: Any) -> Vector:
    return (vector.x, vector.y, vector.z)
