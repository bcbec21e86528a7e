# SPDX-License-Identifier: LGPL-2.1-or-later
"""How an operation appears in the window: its icon, its path, its panel on a double click."""

from __future__ import annotations

import gc
from pathlib import Path as FilePath
from typing import Any

import FreeCADGui
import Path.Op.Gui.Base as PathOpGui

from .. import defaults, ops, properties, rails
from . import edges, labels, operation_panel, path_colours
from .command import ICONS

GENERIC = "operation"
"""The icon of kinds that have none of their own."""


class ElementGate:
    """Lets faces be selected, and edges for an operation that takes them; nothing else."""

    def __init__(self, obj: Any) -> None:
        self._obj = obj

    def allow(self, document: Any, obj: Any, sub: str) -> bool:
        """Whether an element may be selected."""
        kinds = ("Face",) if rails.field_of(self._obj) is None else ("Face", "Edge")
        return sub.rpartition(".")[2].startswith(kinds)


class ViewProviderStylus(PathOpGui.ViewProvider):
    """CAM's view provider of operations with our icon, our page and a selection of faces and edges."""

    _colours: Any = None
    """There while FreeCAD shows the operation."""

    def attach(self, vobj: Any) -> None:
        """FreeCAD begins to show the operation: its path in colours by kind."""
        super().attach(vobj)
        self._colours = path_colours.begin(vobj)

    def onChanged(self, vobj: Any, prop: str) -> None:
        """Follows the view's properties."""
        if self._colours is not None:
            self._colours.watch()
        path_colours.changed(vobj, prop)

    def updateData(self, obj: Any, prop: str) -> None:
        """Follows the operation's properties."""
        super().updateData(obj, prop)
        if self._colours is not None:
            self._colours.watch()

    def getIcon(self) -> str:
        """The kind's icon; CAM's own where the operation is switched off."""
        if not self.Object.Active:
            return str(super().getIcon())
        return icon_of(self.Object)

    def getSelectionFactory(self) -> Any:
        """What begins the selection of faces and edges when the panel opens."""
        return lambda: FreeCADGui.Selection.addSelectionGate(ElementGate(self.Object))

    def setEdit(self, vobj: Any = None, mode: int = 0) -> bool:
        """Opens the panel; what is wrong with it is shown, and the panel stays closed."""
        from . import messages

        # panels that were closed are cycles of objects: what is left of their widgets in Python would be taken for new widgets
        # at the same addresses, and using these raises "already deleted"
        gc.collect()
        with messages.shown("StylusCAM"):
            self.OpIcon = icon_of((vobj or self.vobj).Object)
            return bool(super().setEdit(vobj, mode))
        return False

    def setupTaskPanel(self, panel: Any) -> None:
        """A new operation without faces begins with all of them."""
        is_new = panel.deleteOnReject
        super().setupTaskPanel(panel)
        if is_new and not self.Object.Base:
            self.Object.WholeModel = True


def icon_of(obj: Any) -> str:
    """The file of an operation's icon."""
    own: FilePath = ICONS / f"{GENERIC}-{properties.kind_of(obj)}.svg"
    return str(own if own.is_file() else ICONS / f"{GENERIC}.svg")


def attach(obj: Any) -> None:
    """Gives an operation that was made without a window its view."""
    view = obj.ViewObject
    if not isinstance(view.Proxy, ViewProviderStylus):
        view.Proxy = ViewProviderStylus(view, _resources(obj.Label))
        view.Proxy.setDeleteObjectsOnReject(False)


def create(kind: str, title: str, job: Any) -> Any:
    """A new operation of a kind in a job, its panel open.

    Raises:
        EngineMissingError, mistakes.OperationError: it cannot be made; the document is as it was.
    """
    document = job.Document
    document.openTransaction(f"Create {title}")
    try:
        obj = ops.Create(title.replace(" ", ""), parentJob=job)
        obj.Label = labels.unique(title, document, obj)
        defaults.fill(obj, kind)
        if edges.take(obj, job):
            FreeCADGui.Selection.clearSelection()  # CAM's page of base geometry takes faces only
    except BaseException:
        document.abortTransaction()
        raise
    obj.ViewObject.Proxy.OpName = title
    obj.ViewObject.Proxy.setDeleteObjectsOnReject(True)
    obj.ViewObject.Visibility = True
    document.commitTransaction()
    obj.ViewObject.Document.setEdit(obj.ViewObject, 0)
    return obj


def _resources(title: str) -> Any:
    """What CAM's view provider is made from."""
    words = {"menuText": title, "accelKey": None, "toolTip": ""}
    return PathOpGui.CommandResources(title, ops.Create, operation_panel.OperationPage, "CAM_OpActive", *words.values())
