"""FreeCAD's window, started once for each set of scenarios: what they found is read from a file."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from window_host import INSIDE, Window, WindowSession

import roots
from needed import needed


@pytest.fixture(scope="session", params=["1.1", "1.0"])
def window(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, engine: Path, addon: Path
) -> Window:
    """Each FreeCAD that the addon is made for, with a window."""
    with needed(f"a window of FreeCAD {request.param}"):
        roots.ready_window(request.param)
    return Window(request.param, engine, addon, tmp_path_factory.mktemp(f"window-{request.param}"))


@pytest.fixture(scope="session")
def scenarios(window: Window) -> Callable[..., WindowSession]:
    """The results of a script of `inside`, run once in each version for each name of a variant.

    `only` names scenarios of the script; a variant's settings are those of `Window.run`: without the engine, with preferences.
    """
    known: dict[str, WindowSession] = {}

    def of(script: str, variant: str = "", only: Sequence[str] = (), **settings: Any) -> WindowSession:
        name = f"{script}-{variant}" if variant else script
        if name not in known:
            folder = window.folder / name
            folder.mkdir()
            done = window.run(INSIDE / f"{script}.py", *only, folder=folder, **settings)
            path = folder / "results.jsonl"
            lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
            known[name] = WindowSession(done, folder, dict(json.loads(line) for line in lines))
        return known[name]

    return of
