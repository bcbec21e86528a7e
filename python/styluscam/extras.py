"""The optional extras of the package: what each brings, and one way to ask for it."""

from __future__ import annotations

import importlib
from types import ModuleType

from styluscam.errors import StylusError

EXTRAS = {
    "step": {"OCP.STEPControl": "cadquery-ocp-novtk"},
    "mesh": {"trimesh": "trimesh", "networkx": "networkx", "lxml": "lxml"},
    "plot": {"matplotlib": "matplotlib"},
    "report": {"jinja2": "jinja2", "matplotlib": "matplotlib"},
}
"""Modules by extra, with the name under which an index has them; as in ``pyproject.toml``."""


def hint(extra: str) -> str:
    """The command that installs an extra."""
    return f"pip install 'styluscam[{extra}]'"


def require(
    extra: str,
    what: str,
    *,
    modules: tuple[str, ...] = (),
    failure: type[StylusError] = StylusError,
    code: str = "",
    where: str = "",
) -> ModuleType:
    """Imports the modules of an extra (or those of ``modules``) and returns the first.

    ``what`` is the subject of the message: what cannot be done without the extra.

    Raises:
        StylusError: of class ``failure`` and with ``code`` (else ``extra-<extra>``): one of them cannot be imported; the
            message names it and how to install it.
    """
    imported = []
    for module in modules or tuple(EXTRAS[extra]):
        try:
            imported.append(importlib.import_module(module))
        except ImportError as error:
            message = f"{what} needs {EXTRAS[extra][module]}: {hint(extra)}"
            raise failure(message, code=code or f"extra-{extra}", where=where, hint=hint(extra)) from error
    return imported[0]
