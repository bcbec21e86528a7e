"""Where things are, and what a session in FreeCAD gives back."""

from __future__ import annotations

import importlib
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import roots

CHECKOUT = Path(__file__).resolve().parents[2]
ADDON = CHECKOUT / "freecad_workbench"
EXAMPLE = CHECKOUT / "examples" / "first-light" / "freecad_job.py"
JOB = EXAMPLE.with_name("job.toml")
STEP = CHECKOUT / "fixtures" / "cone_cup.step"
INSIDE = Path(__file__).parent / "inside"

COARSE = 5.0
"""Step and stepover (mm) where a test needs a path and not this job's: planning is then quick."""


def addon_module(name: str) -> ModuleType:
    """A module of the addon that imports nothing of FreeCAD's."""
    if str(ADDON) not in sys.path:
        sys.path.append(str(ADDON))
    return importlib.import_module(f"freecad.styluscam_wb.{name}")


@dataclass(frozen=True)
class FreeCad:
    """One version, ready to run scripts."""

    version: str
    engine: Path
    addon: Path
    folder: Path

    def run(
        self, script: Path, *args: str, engine: bool = True, timeout: float = 400.0
    ) -> subprocess.CompletedProcess[str]:
        """Runs a script with the addon, and with the engine unless it is to do without."""
        return roots.run_freecad(
            self.version,
            script,
            *args,
            python_path=[self.engine] if engine else [],
            mod_path=[self.addon],
            binds=[roots.Bind.same(self.folder, writable=True)],
            timeout=timeout,
        )


@dataclass(frozen=True)
class Example:
    """What the example left behind."""

    done: subprocess.CompletedProcess[str]
    text: str


@dataclass(frozen=True)
class Session:
    """What `inside/scenarios.py` found."""

    done: subprocess.CompletedProcess[str]
    results: dict[str, Any]
    document: Path

    def __getitem__(self, name: str) -> Any:
        """A scenario's result; its traceback where it broke."""
        assert name in self.results, f"the session ended early:\n{self.done.stdout[-3000:]}\n{self.done.stderr[-3000:]}"
        result = self.results[name]
        assert "broke" not in result, result["broke"]
        return result
