# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is drawn over a document's model on demand: one picture of each key, gone when what it shows has changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import FreeCAD
import FreeCADGui

from .. import ops
from . import legend, scene

VIEW_3D = "Gui::View3DInventor"

NOTHING = -1
"""The choice of a switch that draws none of its children."""


@dataclass
class Picture:
    """Nodes and a legend in all 3-D views of a document."""

    document: str
    """Its name."""
    key: str
    node: Any
    card: legend.Card | None = None
    hidden: list[Any] = field(default_factory=list)
    """Objects that it stands for: not drawn meanwhile; their property Visibility stays."""
    after: Callable[[], None] | None = None
    """Called when it was shown, and when it was taken away."""
    operation: Any = None
    """What it is of, if that is one operation."""
    _places: list[Any] = field(default_factory=list)
    _switched_off: list[tuple[Any, int]] = field(default_factory=list)

    def show(self) -> None:
        """Draws it."""
        for view in views_of(self.document):
            graph = view.getSceneGraph()
            graph.addChild(self.node)
            self._places.append(graph)
        if self.card is not None and self._places:
            legend.show(views_of(self.document)[0], self.card)
        for obj in self.hidden:
            switch = scene.mode_switch(obj.ViewObject)
            if switch is not None and obj.ViewObject.Visibility:
                self._switched_off.append((switch, switch.whichChild.getValue()))
                switch.whichChild = NOTHING
        self._tell()

    def remove(self) -> None:
        """Takes it away; what it stood for is drawn again."""
        for graph in self._places:
            if graph.findChild(self.node) >= 0:
                graph.removeChild(self.node)
        self._places.clear()
        for view in views_of(self.document):
            legend.remove(view, self.key)
        for switch, before in self._switched_off:
            if switch.whichChild.getValue() == NOTHING:
                switch.whichChild = before
        self._switched_off.clear()
        self._tell()

    def _tell(self) -> None:
        if self.after is not None:
            self.after()


_shown: dict[tuple[str, str], Picture] = {}


class _Observer:
    """Takes pictures away that no longer show what there is."""

    def slotChangedObject(self, obj: Any, prop: str) -> None:
        """A path or a model has changed."""
        if (prop == "Path" and ops.is_ours(obj)) or (prop == "Shape" and is_hidden(obj)):
            remove_all(obj.Document.Name)

    def slotDeletedDocument(self, document: Any) -> None:
        """Its views are gone as well."""
        for key in [key for key in _shown if key[0] == document.Name]:
            del _shown[key]


_observer: list[_Observer] = []


def show(picture: Picture) -> None:
    """Shows a picture in place of one of the same key."""
    if not _observer:
        _observer.append(_Observer())
        FreeCAD.addDocumentObserver(_observer[0])
    remove(picture.document, picture.key)
    _shown[picture.document, picture.key] = picture
    picture.show()


def remove(document: str, key: str) -> bool:
    """Takes a picture away; whether there was one."""
    picture = _shown.pop((document, key), None)
    if picture is not None:
        picture.remove()
    return picture is not None


def remove_all(document: str) -> None:
    """Takes all pictures of a document away."""
    for name, key in list(_shown):
        if name == document:
            remove(name, key)


def shown(document: str, key: str) -> Picture | None:
    """The picture of a key, if it is there."""
    return _shown.get((document, key))


def views_of(document: str) -> list[Any]:
    """The 3-D views of a document."""
    if document not in FreeCAD.listDocuments():
        return []
    return list(FreeCADGui.getDocument(document).mdiViewsOfType(VIEW_3D))


def is_deleted(obj: Any) -> bool:
    """Whether an object is gone, while something still holds it: FreeCAD refuses every look at it then."""
    try:
        return not obj.Document
    except ReferenceError:
        return True


def stands_for(job: Any) -> list[Any]:
    """The model of a job, and what it is a clone of: all that is drawn in the same position."""
    models = list(job.Model.Group)
    return [*models, *(source for model in models for source in getattr(model, "Objects", ()))]


def is_hidden(obj: Any) -> bool:
    """Whether a picture stands for an object."""
    return any(obj in picture.hidden for picture in _shown.values())
