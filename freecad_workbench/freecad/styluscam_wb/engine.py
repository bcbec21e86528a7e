# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engine (the Python package styluscam): imported when first needed; its absence is one sentence."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

from . import compat


class EngineMissingError(RuntimeError):
    """The engine cannot be imported; the message says how to install it."""


def styluscam() -> ModuleType:
    """The engine's package.

    Raises:
        EngineMissingError: it is not installed for FreeCAD's Python, or does not load there.
    """
    try:
        import styluscam
    except ImportError as error:
        raise EngineMissingError(_missing(error)) from error
    return styluscam


def program_of(document: str) -> Any:
    """A styluscam.Program from its document's JSON."""
    sc = styluscam()
    return sc.Program(sc._engine.Program.from_json(document))


def text_of(program: Any, machine: str, notes: list[str]) -> str:
    """A styluscam.Program as a shipped machine's text; the notes go into the header."""
    sc = styluscam()
    text: str = sc._engine.post(program.engine.with_notes(notes), sc.Machine.shipped(machine).engine)
    return text


def _missing(error: ImportError) -> str:
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    command = f'{python} -m pip install --target "{compat.package_dir()}" styluscam'
    return f"the StylusCAM engine cannot be loaded ({error}); install it with: {command}"
