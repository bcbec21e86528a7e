"""Where FreeCAD's program without a window is."""

from __future__ import annotations

import os
import shlex
import shutil
from pathlib import Path

from styluscam.errors import StylusError

VARIABLE = "STYLUSCAM_FREECADCMD"
"""Names the command: a file, or words as a shell reads them."""

NAMES = ("freecadcmd", "FreeCADCmd")
"""As distributions call it, and as FreeCAD does."""


def freecad_command() -> list[str]:
    """The command that starts FreeCAD without a window: of the environment, else one on the PATH.

    Raises:
        StylusError: there is none.
    """
    named = os.environ.get(VARIABLE, "").strip()
    if named:
        return _named(named)
    for name in NAMES:
        path = shutil.which(name)
        if path:
            return [path]
    raise StylusError(
        f"FreeCAD is not found: neither {' nor '.join(NAMES)} is on the PATH",
        code="freecad-missing",
        where=VARIABLE,
        hint=f"install FreeCAD 1.0 or later, or set {VARIABLE} to its freecadcmd",
    )


def _named(named: str) -> list[str]:
    if Path(named).is_file():  # with spaces in it, as on Windows
        words = [named]
    else:
        try:
            words = shlex.split(named)
        except ValueError as error:
            raise _unusable(named, f"it cannot be read: {error}") from error
    program = shutil.which(words[0]) if words else None
    if program is None:
        raise _unusable(named, "there is no such program")
    return [program, *words[1:]]


def _unusable(named: str, why: str) -> StylusError:
    message = f"{VARIABLE}={named}: {why}"
    return StylusError(message, code="freecad-missing", where=VARIABLE, hint="set it to FreeCAD's freecadcmd")
