"""Runs a script of this folder in the FreeCADs that the tests use, with the addon and the engine that is installed."""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import styluscam as sc

CHECKOUT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(CHECKOUT / "tests" / "oracles"))
import roots  # noqa: E402 - the FreeCAD that the tests use

VERSIONS = ("1.1", "1.0")

RESULT = "RESULT "
"""What stands before the JSON document that a script prints."""


def run(
    version: str,
    script: str,
    *args: str,
    python_path: Sequence[Path] = (),
    writable: Sequence[Path] = (),
    timeout: float = 1200.0,
) -> Any:
    """The JSON document that the script prints in FreeCAD.

    Raises:
        SystemExit: it prints none; the message is the end of what it prints.
    """
    with tempfile.TemporaryDirectory() as folder:
        engine = Path(folder) / "engine"
        shutil.copytree(Path(sc.__file__).parent, engine / "styluscam")
        done = roots.run_freecad(
            version,
            Path(__file__).with_name(script),
            *args,
            python_path=[engine, Path(__file__).parent, *python_path],
            mod_path=[CHECKOUT / "freecad_workbench"],
            binds=[roots.Bind.same(one, writable=True) for one in (Path(folder), *writable)],
            timeout=timeout,
        )
    lines = [line.removeprefix(RESULT) for line in done.stdout.splitlines() if line.startswith(RESULT)]
    if not lines:
        raise SystemExit(f"{script} in FreeCAD {version}:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return json.loads(lines[-1])
