# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nodes of the 3-D view made from arrays: lines, coloured faces, markers. Lengths mm, colours 0 to 255."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from pivy import coin

if TYPE_CHECKING:
    from styluscam.types import FloatArray, IntArray

Colour = tuple[int, int, int]

NEARER = 0.9995
"""What is drawn on a surface takes the depths up to this share of all: lines on faces stay visible."""

CREASE = 0.5
"""Angle (rad) between facets from which on their edge stays sharp."""

MARKER, RING = (0xFF, 0xE0, 0x00), (0x10, 0x10, 0x10)
"""A yellow point in a black ring: visible on light and dark."""


def separator(name: str, *nodes: Any) -> Any:
    """A named separator of these nodes; FreeCAD's own picking passes through it."""
    group = coin.SoSeparator()
    group.setName(name)
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    for node in (pick, *nodes):
        group.addChild(node)
    return group


def coordinates(points: FloatArray) -> Any:
    """Points (N, 3)."""
    node = coin.SoCoordinate3()
    node.point.setValues(0, len(points), np.ascontiguousarray(points, dtype=np.float32))
    node.point.setNum(len(points))
    return node


def through(runs: list[IntArray]) -> IntArray:
    """Polylines, each the indices of its points, as a scene has them: -1 after each."""
    return np.concatenate([np.append(run, -1) for run in runs])


def between(pairs: IntArray) -> IntArray:
    """Lines between two points each, given as indices (N, 2)."""
    return np.concatenate([pairs, np.full((len(pairs), 1), -1)], axis=1).reshape(-1)


def lines(points: FloatArray, index: IntArray, colour: Colour, width: float) -> list[Any]:
    """Polylines through points (N, 3); drawn before the surfaces that they lie on."""
    return [_in_front(), _plain(), _one_colour(), _base_colour(colour), *_line_set(points, index, width)]


def coloured_lines(points: FloatArray, index: IntArray, colours: IntArray, width: float) -> list[Any]:
    """The same with a colour (N, 3) at each point, and the colours between them along the lines."""
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    return [_in_front(), _plain(), packed(colours), binding, *_line_set(points, index, width)]


def _line_set(points: FloatArray, index: IntArray, width: float) -> list[Any]:
    style = coin.SoDrawStyle()
    style.lineWidth = width
    shape = coin.SoIndexedLineSet()
    shape.coordIndex.setValues(0, len(index), index.astype(np.int32))
    shape.coordIndex.setNum(len(index))
    return [style, coordinates(points), shape]


def faces(
    points: FloatArray,
    triangles: IntArray,
    normals: FloatArray,
    colours: IntArray,
    transparency: float = 0.0,
    *,
    covers: bool = False,
) -> list[Any]:
    """Triangles (T, 3) of vertices (V, 3) with unit normals (V, 3) and colours (V, 3) of their own; 1: nothing is seen.

    With `covers` they are seen where they lie on faces of the model.
    """
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.shapeType = coin.SoShapeHints.UNKNOWN_SHAPE_TYPE  # both sides are lit
    normal = coin.SoNormal()
    normal.vector.setValues(0, len(normals), np.ascontiguousarray(normals, dtype=np.float32))
    by_vertex, of_vertex = coin.SoNormalBinding(), coin.SoMaterialBinding()
    by_vertex.value = coin.SoNormalBinding.PER_VERTEX_INDEXED
    of_vertex.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    behind = coin.SoPolygonOffset()  # lines on the faces are drawn over them, and what one looks through before them
    behind.factor, behind.units = (1.0, 2.0) if transparency == 0.0 and not covers else (-1.0, -2.0)
    return [
        behind,
        hints,
        packed(colours, transparency),
        of_vertex,
        normal,
        by_vertex,
        coordinates(points),
        _face_set(triangles),
    ]


def packed(colours: IntArray, transparency: float = 0.0) -> Any:
    """Colours (V, 3) as one node."""
    red, green, blue = np.asarray(colours, dtype=np.uint32).T
    node = coin.SoPackedColor()
    values = (red << 24 | green << 16 | blue << 8 | np.uint32(round(0xFF * (1.0 - transparency)))).tolist()
    node.orderedRGBA.setValues(0, len(values), values)
    node.orderedRGBA.setNum(len(values))
    return node


def solid(points: FloatArray, triangles: IntArray, colour: Colour, transparency: float) -> list[Any]:
    """Triangles (T, 3) of points (N, 3) in one colour."""
    material, hints = coin.SoMaterial(), coin.SoShapeHints()
    material.diffuseColor = _shares(colour)
    material.transparency = transparency
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.shapeType = coin.SoShapeHints.SOLID  # its far side is not drawn
    hints.creaseAngle = CREASE
    return [material, hints, coordinates(points), _face_set(triangles)]


def marker(point: Any) -> Any:
    """A point that is seen through everything."""
    front = coin.SoAnnotation()
    at = coin.SoCoordinate3()
    at.point.setValue(*(float(value) for value in point))
    for node in (_plain(), _one_colour(), at):
        front.addChild(node)
    kinds = ((RING, coin.SoMarkerSet.CIRCLE_FILLED_9_9), (MARKER, coin.SoMarkerSet.CIRCLE_FILLED_5_5))
    for colour, kind in kinds:
        front.addChild(_base_colour(colour))
        shape = coin.SoMarkerSet()
        shape.markerIndex = kind
        front.addChild(shape)
    return front


def _face_set(triangles: IntArray) -> Any:
    shape = coin.SoIndexedFaceSet()
    index = np.full((len(triangles), 4), -1, dtype=np.int32)
    index[:, :3] = triangles
    shape.coordIndex.setValues(0, index.size, index.reshape(-1))
    shape.coordIndex.setNum(index.size)
    return shape


def _in_front() -> Any:
    depth = coin.SoDepthBuffer()
    depth.range = (0.0, NEARER)
    return depth


def _plain() -> Any:
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    return light


def _one_colour() -> Any:
    """Undoes a binding of colours to vertices."""
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.OVERALL
    return binding


def _base_colour(colour: Colour) -> Any:
    node = coin.SoBaseColor()
    node.rgb = _shares(colour)
    return node


def _shares(colour: Colour) -> tuple[float, float, float]:
    red, green, blue = colour
    return red / 255.0, green / 255.0, blue / 255.0


# --- looking around ----------------------------------------------------------------------------------------------


def children(node: Any) -> Iterator[Any]:
    """Those of a group; none of what is no group."""
    if node.isOfType(coin.SoGroup.getClassTypeId()):
        yield from (node.getChild(index) for index in range(node.getNumChildren()))


def type_name(node: Any) -> str:
    """FreeCAD's nodes are of classes that Python does not know."""
    return str(node.getTypeId().getName().getString())


def mode_switch(view_object: Any) -> Any:
    """The switch by which FreeCAD shows and hides an object; None where there is none."""
    return next((node for node in children(view_object.RootNode) if type_name(node) == "Switch"), None)
