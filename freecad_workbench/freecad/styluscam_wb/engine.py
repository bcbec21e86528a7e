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


def program_of_path(sections: list[tuple[str, str | None, str, str]], tools: str, setup: str) -> Any:
    """A styluscam.Program from paths as text; tools and set-up are JSON."""
    sc = styluscam()
    return sc.Program.from_path(sections, tools, setup)


def text_of(program: Any, machine: Any, notes: list[str]) -> str:
    """A styluscam.Program as a machine's text; the notes go into the header."""
    text: str = styluscam().post(program.with_notes(notes), machine).text
    return text


def _missing(error: ImportError) -> str:
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    command = f'{python} -m pip install --target "{compat.package_dir()}" styluscam'
    return f"the StylusCAM engine cannot be loaded ({error}); install it with: {command}"
