# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a verification: verdict, worst figures, findings; a selected one is marked in the 3-D view."""

from __future__ import annotations

from typing import Any

import FreeCADGui
from PySide import QtCore, QtWidgets

from ..verification import Verified
from . import finding_mark, pictures
from .messages import translated
from .notes import ERROR

WARNED = "color: #1a1a1a; background: #f0c000; padding: 6px; border-radius: 3px;"
SOUND = "color: #ffffff; background: #1a6e35; padding: 6px; border-radius: 3px;"
STYLES = {"faulty": ERROR, "warned": WARNED, "sound": SOUND}
"""By the verdict's state."""

COLUMNS = ("Finding", "Value", "Line")


class FindingsPanel:
    """What FreeCAD's task view shows; `form` is its widget."""

    def __init__(self, verified: Verified) -> None:
        from styluscam.report.findings import verdict_of

        self._verified = verified
        self._job = verified.draft.job
        self._document = str(self._job.Document.Name)
        report = verified.report
        verdict = verdict_of(report)
        self.form = QtWidgets.QWidget()
        self.form.setObjectName("StylusCAM_Findings")
        self.form.setWindowTitle(translated("Verification"))
        rows = QtWidgets.QVBoxLayout(self.form)
        headline = _text("Verdict", verdict.headline)
        headline.setStyleSheet(STYLES[verdict.state])
        rows.addWidget(headline)
        figures = translated("Worst gouge {gouge:.4f} mm, worst excess {excess:.4f} mm")
        rows.addWidget(_text("Figures", figures.format(gouge=report.gouge_max, excess=report.excess_max)))
        self._list = self._filled_list()
        rows.addWidget(self._list, 1)
        self._message = _text("Message", verdict.explained)
        rows.addWidget(self._message)
        if verified.left_out:
            text = translated("Not verified, because they are not StylusCAM's: {labels}")
            rows.addWidget(_text("LeftOut", text.format(labels=", ".join(verified.left_out))))

    def _filled_list(self) -> Any:
        from styluscam.report.findings import measured, spoken

        tree = QtWidgets.QTreeWidget()
        tree.setObjectName("Findings")
        tree.setHeaderLabels([translated(title) for title in COLUMNS])
        tree.setRootIsDecorated(False)
        for finding in self._verified.report.findings:
            value = "" if finding.value is None else measured(finding.value, finding.unit)
            item = QtWidgets.QTreeWidgetItem([spoken(finding.kind), value, str(finding.line or "")])
            item.setToolTip(0, f"{finding.severity}, code {finding.kind}")
            icon = QtWidgets.QStyle.SP_MessageBoxCritical if finding.severity == "error" else _MILDER
            item.setIcon(0, tree.style().standardIcon(icon))
            tree.addTopLevelItem(item)
        for column in range(len(COLUMNS)):
            tree.resizeColumnToContents(column)
        tree.setVisible(bool(self._verified.report.findings))
        tree.currentItemChanged.connect(self._chosen)
        return tree

    def _chosen(self, item: Any, _: Any = None) -> None:
        """Shows a finding's message, and marks its position."""
        if item is None:
            return
        finding = self._verified.report.findings[self._list.indexOfTopLevelItem(item)]
        self._message.setText(finding.message)
        if finding.position is None or pictures.is_deleted(self._job):
            finding_mark.clear(self._document)
        else:
            finding_mark.mark(self._verified, list(finding.position), finding.line)

    def getStandardButtons(self) -> Any:
        """Only one."""
        return QtWidgets.QDialogButtonBox.Close

    def reject(self) -> bool:
        """Closes the panel; the marker goes with it."""
        finding_mark.clear(self._document)
        FreeCADGui.Control.closeDialog()
        return True


_MILDER = QtWidgets.QStyle.SP_MessageBoxWarning


def _text(name: str, text: str) -> Any:
    label = QtWidgets.QLabel(text)
    label.setObjectName(name)
    label.setWordWrap(True)
    label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
    return label
