# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user prefers, in FreeCAD's parameters under `GROUP`; the page that edits it is `gui/preferences.py`."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD

GROUP = "User parameter:BaseApp/Preferences/Mod/StylusCAM"
"""FreeCAD's group of our parameters."""

MACHINE_FOLDER = "MachineFolder"
"""Text: the folder of the user's machine files; empty means the one in FreeCAD's user data."""

MACHINE = "Machine"
"""Text: the machine for which jobs of our own command are posted; empty means CAM's own default."""

VERIFIES = "VerifyBeforeWriting"
"""Yes or no: whether a program is verified before it is written."""


class SettingError(ValueError):
    """A value that cannot be one; the message states which, why, and what to do."""


def machine_folder() -> FilePath:
    """Where the user's machine files are looked for."""
    chosen = chosen_machine_folder()
    return FilePath(chosen) if chosen else default_machine_folder()


def default_machine_folder() -> FilePath:
    """Where they are looked for unless a folder is chosen."""
    return FilePath(FreeCAD.getUserAppDataDir()) / "StylusCAM" / "machines"


def chosen_machine_folder() -> str:
    """The folder that a user has chosen, or nothing."""
    return str(_group().GetString(MACHINE_FOLDER, ""))


def choose_machine_folder(text: str) -> None:
    """Stores the folder; an empty text means the default.

    Raises:
        SettingError: there is no such folder, or it is not stated from the root on.
    """
    text = text.strip()
    if problem := machine_folder_problem(text):
        raise SettingError(problem)
    _group().SetString(MACHINE_FOLDER, text)


def machine_folder_problem(text: str) -> str:
    """Why a text is no folder of machine files; nothing where it is one."""
    path = FilePath(text.strip())
    if not text.strip() or (path.is_absolute() and path.is_dir()):
        return ""
    why = "is not a folder" if path.exists() else "does not exist"
    if not path.is_absolute():
        why = "must be stated from the root on"
    return f"the folder of machine files {text.strip()} {why}: choose one, or leave the line empty for the default"


def machine() -> str:
    """The machine of new jobs, or nothing."""
    return str(_group().GetString(MACHINE, ""))


def choose_machine(name: str) -> None:
    """Stores it; nothing means CAM's own default."""
    _group().SetString(MACHINE, name)


def verifies() -> bool:
    """Whether a program is verified before it is written."""
    return bool(_group().GetBool(VERIFIES, True))


def set_verifies(value: bool) -> None:
    """Stores it."""
    _group().SetBool(VERIFIES, value)


def _group() -> Any:
    return FreeCAD.ParamGet(GROUP)
