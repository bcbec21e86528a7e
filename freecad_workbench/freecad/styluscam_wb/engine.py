# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engine (the Python package styluscam): imported when first needed; its absence is one sentence."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import FreeCAD


class EngineMissingError(RuntimeError):
    """The engine cannot be imported; the message states how to install it."""


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


def is_there() -> bool:
    """Whether the engine can be imported."""
    try:
        styluscam()
    except EngineMissingError:
        return False
    return True


def package_dir() -> str:
    """Where FreeCAD looks for Python packages that a user adds."""
    version = f"py{sys.version_info.major}{sys.version_info.minor}"
    return f"{FreeCAD.getUserAppDataDir()}AdditionalPythonPackages/{version}"


def program_of_path(sections: list[tuple[str, str | None, str, str]], tools: str, setup: str) -> Any:
    """A styluscam.Program from paths as text; tools and set-up are JSON."""
    sc = styluscam()
    return sc.Program.from_path(sections, tools, setup)


def sheet_raise(sheet: dict[str, Any]) -> float:
    """How far a sheet (thickness, law, model_face) lifts the tool over a horizontal face of the model, mm."""
    styluscam()
    from styluscam.offset.positions import sheet_raise as raise_of

    return raise_of(sheet)


def text_of(program: Any, machine: Any, notes: list[str]) -> str:
    """A styluscam.Program as a machine's text; the notes go into the header."""
    text: str = styluscam().post(program.with_notes(notes), machine).text
    return text


def _missing(error: ImportError) -> str:
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    command = f'{python} -m pip install --target "{package_dir()}" styluscam'
    return f"the StylusCAM engine cannot be loaded ({error}); install it with: {command}"
