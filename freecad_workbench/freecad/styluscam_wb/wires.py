# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sketches, wires and edges as the closed polylines that bound an operation's passes."""

from __future__ import annotations

from typing import Any

DEVIATION = 0.001
"""Curves become chords no farther off than this, mm."""

JOINED = 1e-4
"""Corners no farther apart are one, mm."""

PROPERTY = "BoundaryWires"
"""The property that links them."""

TEXT = (
    "Sketches, wires, or edges of objects that bound the passes in plan; one inside another is an island. "
    f"Curves become chords within {DEVIATION:g} mm"
)


class WireError(ValueError):
    """Linked edges that close no loop; the message names the object."""


def loops(obj: Any) -> list[list[list[float]]]:
    """The closed polylines in plan that an operation links, [x, y] mm.

    Raises:
        WireError: edges that do not close, or an object without any.
    """
    found = []
    for linked, names in getattr(obj, PROPERTY, None) or ():
        named = [name for name in names if name]
        edges = [linked.Shape.getElement(name) for name in named] if named else linked.Shape.Edges
        found += _loops(linked.Label, edges)
    return found


def _loops(label: str, edges: list[Any]) -> list[list[list[float]]]:
    import Part

    if not edges:
        raise WireError(f"{label} has no edge that could bound passes: link a sketch, a wire or edges")
    found = []
    for chain in Part.sortEdges(edges):
        wire = Part.Wire(chain)
        if not wire.isClosed():
            raise WireError(f"the edges of {label} do not close: close the sketch, or link all edges of the outline")
        points = [[point.x, point.y] for edge in wire.OrderedEdges for point in _points(edge)]
        found.append([p for p, before in zip(points, [points[-1], *points], strict=False) if _apart(p, before)])
    return found


def _points(edge: Any) -> list[Any]:
    points = edge.discretize(Deflection=DEVIATION)
    return points[::-1] if edge.Orientation == "Reversed" else points


def _apart(one: list[float], other: list[float]) -> bool:
    return max(abs(one[0] - other[0]), abs(one[1] - other[1])) > JOINED
