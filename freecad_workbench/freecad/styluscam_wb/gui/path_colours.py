# SPDX-License-Identifier: LGPL-2.1-or-later
"""An operation's path in colours by the kind of move, with a legend.

FreeCAD draws a path in two colours: rapids in one, moves at a feed in the other. Its own lines get ours, so that selecting,
line width and the shown range stay as they are; whenever FreeCAD writes its colours, ours follow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import FreeCAD
import numpy as np
from pivy import coin

from .. import ops
from . import legend, pictures, scene
from .command import Command, job_in_front
from .messages import translated
from .scene import Colour

if TYPE_CHECKING:
    from styluscam.types import FloatArray, IntArray

PROPERTY = "ColourByKind"
"""Of the view object."""

TOOL_TIP = "Colours the path by the kind of move; else rapids have one colour and feed moves another"

KEY = "path"

WIDTH = 2
"""Of a new path's lines, pixels: colours of thinner ones are hard to tell."""

UPRIGHT = 1e-4
"""mm: a move that goes no farther than this in X and Y is upright; the scene's numbers have seven digits."""

SAME_COLOUR = 0.5 / 255.0


@dataclass(frozen=True)
class Kind:
    """A kind of move."""

    name: str
    colour: Colour


KINDS = (
    Kind("rapid", (0xCB, 0x09, 0x51)),
    Kind("down at a feed", (0xC0, 0x8A, 0x00)),
    Kind("up at a feed", (0x8A, 0x2B, 0xF0)),
    Kind("cut, or link along the part", (0x2E, 0x93, 0xD8)),
)
"""Distinguished with any kind of colour vision; visible on light, grey and dark."""

RAPID, DOWN, UP, CUT = range(len(KINDS))


def kinds_of(points: FloatArray, index: IntArray, is_rapid: Any) -> IntArray:
    """The kind of each segment (S,) of polylines through points (N, 3), given as a scene gives them: indices, -1 after each."""
    starts = np.flatnonzero((index[:-1] >= 0) & (index[1:] >= 0))
    step = points[index[starts + 1]] - points[index[starts]]
    upright = (np.abs(step[:, :2]) <= UPRIGHT).all(axis=1)
    kinds = np.where(upright, np.where(step[:, 2] > 0.0, UP, DOWN), CUT)
    return np.asarray(np.where(is_rapid, RAPID, kinds))


class PathColours:
    """Keeps the colours of one operation's path."""

    def __init__(self, view_object: Any) -> None:
        self._view_object = view_object
        self._nodes: tuple[Any, Any, Any] | None = None
        self._sensor: Any = None
        self._written: Any = None

    def watch(self) -> None:
        """Follows FreeCAD's lines from now on; they are not there yet when a view is attached."""
        if self._nodes is not None:
            return
        self._nodes = drawn_lines(self._view_object)
        if self._nodes is not None:
            self._sensor = coin.SoFieldSensor(self._follow, None)
            self._sensor.attach(self._nodes[0].diffuseColor)
            self._follow()

    def _follow(self, *_: Any) -> None:
        """Colours the lines that FreeCAD has just coloured."""
        if self._nodes is None or not getattr(self._view_object, PROPERTY, False):
            return
        material, points, shape = self._nodes
        theirs = _array(material.diffuseColor)
        if self._written is not None and np.array_equal(theirs, self._written):
            return
        index = np.array(shape.coordIndex.getValues(), dtype=np.int64)
        count = len(index) - 2 * np.count_nonzero(index < 0)
        if not 0 < count <= len(theirs):
            return  # nothing is drawn, or half of it is written: it calls again
        # of a range of the path there may be more colours than segments, at the end
        is_rapid = np.abs(theirs[:count] - self._view_object.NormalColor[:3]).max(axis=1) > SAME_COLOUR
        kinds = kinds_of(_array(points.point), index, is_rapid)
        self._written = np.array([kind.colour for kind in KINDS], dtype=np.float32)[kinds] / np.float32(255.0)
        self._sensor.detach()
        material.diffuseColor.setValues(0, len(kinds), self._written)
        self._sensor.attach(material.diffuseColor)
        show_legend(self._view_object.Object.Document.Name)


def drawn_lines(view_object: Any) -> tuple[Any, Any, Any] | None:
    """The nodes with which FreeCAD draws a path: material, points, lines; None where it has others."""
    for found in _separators(view_object.RootNode):
        kinds = {scene.type_name(node): node for node in scene.children(found)}
        if {"Material", "Coordinate3", "SoBrepEdgeSet"} <= kinds.keys():
            return kinds["Material"], kinds["Coordinate3"], kinds["SoBrepEdgeSet"]
    return None


def _separators(node: Any) -> Any:
    for child in scene.children(node):
        yield child
        yield from _separators(child)


def _array(field: Any) -> FloatArray:
    """A field of triples as numbers (N, 3)."""
    return np.array([triple.getValue() for triple in field.getValues()], dtype=np.float32).reshape(-1, 3)


# --- what an operation's view calls -------------------------------------------------------------------------------


def begin(view_object: Any) -> PathColours:
    """What colours the path of an operation; who asks keeps it, and lets it watch."""
    if not hasattr(view_object, PROPERTY):
        view_object.addProperty("App::PropertyBool", PROPERTY, "Path", TOOL_TIP)
        setattr(view_object, PROPERTY, True)
        view_object.LineWidth = WIDTH
    return PathColours(view_object)


def changed(view_object: Any, prop: str) -> None:
    """Follows the view's properties."""
    if prop == PROPERTY:
        view_object.NormalColor = view_object.NormalColor  # FreeCAD writes its colours, and ours follow
    if prop in (PROPERTY, "Visibility"):
        show_legend(view_object.Object.Document.Name)


def show_legend(document: str) -> None:
    """Shows the legend while any path in these colours is seen, and takes it away with the last one."""
    views = pictures.views_of(document)
    if not views:
        return
    operations = filter(ops.is_ours, FreeCAD.getDocument(document).Objects)
    if any(_is_coloured(obj) for obj in operations):
        card = legend.Card(KEY, translated("Path"))
        for kind in KINDS:
            card.add_swatch(kind.colour, translated(kind.name))
        legend.show(views[0], card)
    else:
        legend.remove(views[0], KEY)


def _is_coloured(obj: Any) -> bool:
    view = obj.ViewObject
    is_drawn = view.Visibility and not pictures.is_hidden(obj)  # a picture may stand for it
    return bool(getattr(view, PROPERTY, False) and is_drawn and obj.Path.Size > 1)  # a comment at least


class ColourPaths(Command):
    """Switches between colours by kind and FreeCAD's own, for all paths of ours in the job in front."""

    name = "PathColours"
    icon = "path-colours"
    menu_text = "Path colours"
    tool_tip = "Colours the job's paths by the kind of move, with a legend; again for FreeCAD's own two colours"

    def IsActive(self) -> bool:
        """With an operation of ours."""
        return bool(_operations())

    def run(self) -> None:
        """Switches."""
        views = [obj.ViewObject for obj in _operations() if hasattr(obj.ViewObject, PROPERTY)]
        wanted = not all(getattr(view, PROPERTY) for view in views)
        for view in views:
            setattr(view, PROPERTY, wanted)


def _operations() -> list[Any]:
    job = job_in_front()
    return [obj for obj in job.Operations.Group if ops.is_ours(obj)] if job is not None else []


def commands() -> list[Command]:
    """The switch."""
    return [ColourPaths()]
