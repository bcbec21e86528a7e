"""``styluscam doctor``: what is installed, and whether the engine works."""

from __future__ import annotations

import importlib
import importlib.metadata
import platform

import numpy as np

from styluscam._engine import __version__
from styluscam.cli import console
from styluscam.cli.failures import FAULT
from styluscam.cli.options import Debug, Json
from styluscam.extras import EXTRAS, hint
from styluscam.offset.positions import drop_cutter
from styluscam.parts.part import Part
from styluscam.tools.tool import Tool
from styluscam.types import Document


def doctor(json: Json = False, debug: Debug = False) -> int:
    """Check versions, extras and the engine."""
    works = _engine_works()
    extras = {
        name: {module: _version(module, index) for module, index in parts.items()} for name, parts in EXTRAS.items()
    }
    document: Document = {
        "styluscam": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "engine_ok": works,
        "packages": {name: _version(name, name) for name in ("numpy", "typer", "rich")},
        "extras": extras,
    }
    if json:
        console.say_json(document)
    else:
        console.fields(_lines(document))
    return 0 if works else FAULT


def _lines(document: Document) -> list[tuple[str, str]]:
    rows = [(name, str(document[name])) for name in ("styluscam", "python", "platform")]
    rows.append(("engine", "works" if document["engine_ok"] else "gives a wrong answer: install the wheel again"))
    rows += list(document["packages"].items())
    for extra, parts in document["extras"].items():
        missing = [module for module, version in parts.items() if version is None]
        there = ", ".join(f"{module.partition('.')[0]} {version}" for module, version in parts.items() if version)
        cure = f"not there: {', '.join(missing)}; {hint(extra)}" if missing else ""
        rows.append((f"extra {extra}", "; ".join(text for text in (there, cure) if text)))
    return rows


def _version(module: str, index: str) -> str | None:
    """The version of a package that can be imported; None where it cannot."""
    try:
        importlib.import_module(module)
    except ImportError:
        return None
    try:
        return importlib.metadata.version(index)
    except importlib.metadata.PackageNotFoundError:
        return "of unknown version"


def _engine_works() -> bool:
    """A ball on a plane must stand with its tip on it."""
    plane = Part.from_mesh([[-50, -50, 1], [50, -50, 1], [0, 50, 1]], [[0, 1, 2]])
    ball = Tool.from_dict({"profile": {"kind": "ball", "diameter": 10.0}})
    return bool(np.allclose(drop_cutter(plane, ball, [[0.0, 0.0]]), 1.0, rtol=0.0, atol=1e-9))
