"""Where things are, and what a session in FreeCAD's window gives back."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import roots

CHECKOUT = Path(__file__).resolve().parents[2]
INSIDE = Path(__file__).parent / "inside"


@dataclass(frozen=True)
class Window:
    """One version of FreeCAD with a window, the addon installed as a user does it, ready to run scripts."""

    version: str
    engine: Path
    addon: Path
    folder: Path

    def run(
        self,
        script: Path,
        *args: str,
        folder: Path,
        engine: bool = True,
        addon: Path | None = None,
        preferences: roots.Preferences = roots.PREFERENCES,
        theme: str = "",
        timeout: float = 300.0,
    ) -> subprocess.CompletedProcess[str]:
        """Runs a script of scenarios, with another addon where one is named; results and pictures go to `folder`."""
        return roots.run_window(
            self.version,
            script,
            *args,
            folder=folder,
            python_path=[self.engine] if engine else [],
            binds=roots.installed(self.version, [addon or self.addon]),
            preferences=preferences,
            theme=theme,
            timeout=timeout,
        )


@dataclass(frozen=True)
class WindowSession:
    """What the scenarios of one script found."""

    done: subprocess.CompletedProcess[str]
    folder: Path
    results: dict[str, Any]

    def __getitem__(self, name: str) -> Any:
        """A scenario's result; its traceback where it broke."""
        ended = (
            f"the session ended early:\n{self.done.stdout[-3000:]}\n{self.done.stderr[-3000:]}\n{self.errors[-3000:]}"
        )
        assert name in self.results, ended
        result = self.results[name]
        broke = isinstance(result, dict) and "broke" in result
        assert not broke, f"{result['broke']}\n{self.errors[-3000:]}"
        return result

    @property
    def errors(self) -> str:
        """What FreeCAD wrote to its error stream and report view."""
        texts = [path.read_text(encoding="utf-8") for path in sorted(self.folder.glob("*.txt"))]
        return "\n".join([self.done.stdout, self.done.stderr, *texts])
