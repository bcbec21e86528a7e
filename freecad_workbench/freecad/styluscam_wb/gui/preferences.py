# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our page in FreeCAD's preferences, and the command that opens it."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import machines, settings
from . import messages
from .command import ICONS, Command
from .messages import translated

GROUP = "StylusCAM"
"""The page's group in FreeCAD's dialog."""

GROUP_ICON = "preferences/preferences-styluscam"
"""The group's icon: FreeCAD looks for this file name in its folders, so that it lies in one of its own."""

VERIFICATION = (
    "Reads each posted program back and compares it with the model, and writes it only if no error is found. "
    "Without it the program's header states that it was not verified"
)

FOLDER = (
    "Each machine file NAME.toml in this folder is a post of every job. Without a folder of your own it is the one in "
    "FreeCAD's user data"
)

MACHINE = (
    "The machine for which the jobs of the command New job are posted, and whose decimals and units planning takes into "
    "account; not stated: CAM's own default post"
)


def register() -> None:
    """Adds the page to FreeCAD's preferences."""
    FreeCADGui.addIconPath(str((ICONS / GROUP_ICON).parent))
    FreeCADGui.addPreferencePage(Page, GROUP)


class Page:
    """FreeCAD makes one when its dialog opens, and asks it to load and to save."""

    def __init__(self, _parent: Any = None) -> None:
        from PySide import QtWidgets

        self.form: Any = QtWidgets.QWidget()
        self.form.setObjectName("StylusCAM_Preferences")
        self.form.setWindowTitle(translated("General"))
        layout = QtWidgets.QVBoxLayout(self.form)
        layout.addWidget(self._machines())
        layout.addWidget(self._programs())
        layout.addStretch(1)

    def _machines(self) -> Any:
        from PySide import QtWidgets

        self._folder, self._browse = QtWidgets.QLineEdit(), QtWidgets.QPushButton(translated("Choose..."))
        self._folder.setPlaceholderText(str(settings.default_machine_folder()))
        self._folder.textChanged.connect(self._show_problem)
        self._browse.clicked.connect(self._choose_folder)
        self._problem = QtWidgets.QLabel()
        self._problem.setWordWrap(True)
        self._problem.setStyleSheet(messages.ERROR)
        self._machine = QtWidgets.QComboBox()
        rows: list[tuple[str, str, list[tuple[Any, str]]]] = [
            (
                "Folder of machine files",
                FOLDER,
                [(self._folder, "MachineFolder"), (self._browse, "ChooseMachineFolder")],
            ),
            ("Machine of new jobs", MACHINE, [(self._machine, "DefaultMachine")]),
        ]
        box = QtWidgets.QGroupBox(translated("Machines"))
        grid = QtWidgets.QGridLayout(box)
        grid.setColumnStretch(1, 1)
        for number, (title, text, widgets) in enumerate(rows):
            label = QtWidgets.QLabel(translated(title))
            label.setToolTip(translated(text))
            grid.addWidget(label, 2 * number, 0)
            for column, (widget, name) in enumerate(widgets):
                widget.setObjectName(name)
                widget.setToolTip(translated(text))
                grid.addWidget(widget, 2 * number, 1 + column, 1, 3 - len(widgets))
        grid.addWidget(self._problem, 1, 0, 1, 3)
        return box

    def _programs(self) -> Any:
        from PySide import QtWidgets

        self._verifies = QtWidgets.QCheckBox(translated("Verify programs before they are written"))
        self._verifies.setObjectName(settings.VERIFIES)
        self._verifies.setToolTip(translated(VERIFICATION))
        box = QtWidgets.QGroupBox(translated("Programs"))
        QtWidgets.QVBoxLayout(box).addWidget(self._verifies)
        return box

    def loadSettings(self) -> None:
        """From the parameters to the page."""
        self._folder.setText(settings.chosen_machine_folder())
        self._verifies.setChecked(settings.verifies())
        self._show_machines()
        self._show_problem()

    def saveSettings(self) -> None:
        """From the page to the parameters; a folder that is none is reported, and the earlier one stays."""
        settings.set_verifies(self._verifies.isChecked())
        settings.choose_machine(self._machine.currentData())
        with messages.shown("StylusCAM"):
            settings.choose_machine_folder(self._folder.text())
            machines.write_user_posts()

    def _show_machines(self) -> None:
        names = ["", *machines.names()]
        chosen = settings.machine()
        if chosen not in names:
            names.append(chosen)  # its file is gone
        self._machine.clear()
        for name in names:
            self._machine.addItem(name or translated("not stated"), name)
        self._machine.setCurrentIndex(names.index(chosen))

    def _show_problem(self) -> None:
        problem = settings.machine_folder_problem(self._folder.text())
        self._problem.setText(problem)
        self._problem.setVisible(bool(problem))

    def _choose_folder(self) -> None:
        from PySide import QtWidgets

        title = translated("Folder of machine files")
        start = self._folder.text() or str(settings.default_machine_folder())
        if chosen := QtWidgets.QFileDialog.getExistingDirectory(self.form, title, start):
            self._folder.setText(chosen)


class Preferences(Command):
    """Opens the page."""

    name = "Preferences"
    icon = GROUP_ICON
    menu_text = "Preferences"
    tool_tip = "The folder of your machine files, the machine of new jobs, verification"

    def IsActive(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """Opens it; the dialog blocks until it is closed."""
        FreeCADGui.showPreferences(GROUP, 0)
