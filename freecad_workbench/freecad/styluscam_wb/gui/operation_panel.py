# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of an operation in CAM's own task panel: tool, coolant, faces, and a form made from the engine's fields."""

from __future__ import annotations

from typing import Any

import Path.Op.Gui.Base as PathOpGui
from PySide import QtWidgets

from .. import defaults, ops
from . import faces
from .axes_view import AxesPreview
from .engagement_view import EngagementPreview
from .flank_view import FlankPreview
from .form import Form
from .messages import translated
from .notes import Notes
from .picture_switch import PictureSwitch


class OperationPage(PathOpGui.TaskPanelPage):
    """CAM makes one for an operation when its panel opens; the panel owns the transaction."""

    def getForm(self) -> Any:
        """The page's widget, with the names that CAM's base class looks for."""
        widget = QtWidgets.QWidget()
        widget.setObjectName("StylusCAM_Operation")
        layout = QtWidgets.QVBoxLayout(widget)
        rows = QtWidgets.QGridLayout()
        rows.setColumnStretch(1, 1)
        widget.toolController = QtWidgets.QComboBox()
        widget.coolantController = QtWidgets.QComboBox()
        widget.wholeModel = QtWidgets.QCheckBox(translated("Whole model"))
        widget.wholeModel.setToolTip(translated(ops.WHOLE_MODEL))
        texts = {
            "toolController": ("Tool", "Tool controller: the tool, its number and its feeds"),
            "coolantController": ("Coolant", "Coolant or lubricant during this operation"),
        }
        for row, (name, (title, text)) in enumerate(texts.items()):
            label, editor = QtWidgets.QLabel(translated(title)), getattr(widget, name)
            editor.setObjectName(name)
            for part in (label, editor):
                part.setToolTip(translated(text))
            rows.addWidget(label, row, 0)
            rows.addWidget(editor, row, 1)
        widget.wholeModel.setObjectName("WholeModel")
        rows.addWidget(widget.wholeModel, len(texts), 1)
        shown = (EngagementPreview(), AxesPreview(), FlankPreview())
        self._previews = [PictureSwitch(self.obj, self.job, one) for one in shown]
        for row, preview in enumerate(self._previews, len(texts) + 1):
            rows.addWidget(preview.widget, row, 1)
        layout.addLayout(rows)
        self._fields = Form(self.obj, layout)
        self._notes = Notes()
        layout.addWidget(self._notes.widget)
        layout.addStretch(1)
        return widget

    def setFields(self, obj: Any) -> None:
        """From the properties to the form."""
        self.setupToolController(obj, self.form.toolController)
        self.setupCoolant(obj, self.form.coolantController)
        self.form.wholeModel.setChecked(bool(obj.WholeModel))
        self._fields.read()
        self._notes.show(obj)
        self._follow()

    def getFields(self, obj: Any) -> None:
        """From the form to the properties."""
        before = obj.ToolController
        self.updateToolController(obj, self.form.toolController)
        if obj.ToolController != before:
            self._follow_tool(obj, before)
        self.updateCoolant(obj, self.form.coolantController)
        if obj.WholeModel != self.form.wholeModel.isChecked():
            obj.WholeModel = self.form.wholeModel.isChecked()
        self._fields.write()

    def _follow_tool(self, obj: Any, before: Any) -> None:
        """A new operation that is alone in its job changes its process with its tool."""
        others = [other for other in self.job.Operations.Group if ops.is_ours(other) and other != obj]
        if self.parent.deleteOnReject and not others:
            defaults.follow_tool(obj, before)
            self._fields.read()

    def onDirtyChanged(self, callback: Any) -> None:
        """CAM sets its callback, and takes it away before it closes the panel.

        A field that the keys leave later than that belongs to an operation that may have been taken back: it is not stored.
        """
        super().onDirtyChanged(callback)
        if callback is None:
            self._fields.release()
            for preview in self._previews:
                preview.release()

    def getSignalsForUpdate(self, obj: Any) -> list[Any]:
        """What is stored as soon as it is changed."""
        tool, coolant = (box.currentIndexChanged for box in (self.form.toolController, self.form.coolantController))
        return [tool, coolant, self.form.wholeModel.clicked, *self._fields.signals]

    def updateData(self, obj: Any, prop: str) -> None:
        """Follows what is changed elsewhere."""
        if prop in ("Path", "Notes"):
            self._notes.show(obj)
            self._fields.show_owned()
            self._follow()
            faces.show(obj)
        elif prop == "Base" and obj.Base and obj.WholeModel:
            obj.WholeModel = False  # who selects faces means these
        elif prop == "WholeModel":
            self.form.wholeModel.setChecked(bool(obj.WholeModel))
        elif hasattr(self, "_previews"):
            self._fields.read([prop])
            self._follow()

    def _follow(self) -> None:
        """What is shown of the path follows it."""
        for preview in self._previews:
            preview.follow()
