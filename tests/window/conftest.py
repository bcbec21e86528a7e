"""FreeCAD's window, started once for each set of scenarios: what they found is read from a file."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from window_host import INSIDE, Window, WindowSession

import roots
import styluscam as sc


@contextlib.contextmanager
def needed(what: str) -> Iterator[None]:
    """Fails where everything must be tested; elsewhere reports loudly what was not."""
    try:
        yield
    except roots.Unavailable as reason:
        if os.environ.get("CI"):
            pytest.fail(f"{what} is needed: {reason}")
        pytest.skip(f"NOT TESTED with {what}: {reason}")


@pytest.fixture(scope="session")
def engine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package that these tests import, alone in a directory: its engine is for every Python."""
    folder = tmp_path_factory.mktemp("engine")
    package = Path(sc.__file__).parent
    shutil.copytree(package, folder / "styluscam", ignore=shutil.ignore_patterns("__pycache__"))
    return folder


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
