"""The addon's modules that need no FreeCAD import without it."""

from __future__ import annotations

import subprocess
import sys

from freecad_host import ADDON

PURE = ("schema", "fields", "posts")
"""Modules that need neither FreeCAD nor the engine."""


def test_modules_without_freecad_import_without_it() -> None:
    lines = [f"import sys; sys.path.insert(0, {str(ADDON)!r})"]
    lines += [f"import freecad.styluscam_wb.{name}" for name in PURE]
    lines += ["assert not {'FreeCAD', 'styluscam', 'Path'} & set(sys.modules)"]
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
