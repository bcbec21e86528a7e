"""FreeCAD, started few times: what the tests ask of it is computed in a handful of sessions and read from JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
import tomllib
from freecad_host import COARSE, EXAMPLE, INSIDE, JOB, STEP, Example, FreeCad, Session

import roots
import rs274
import styluscam as sc
from needed import needed


@pytest.fixture
def linuxcnc() -> Callable[[str], rs274.Interpretation]:
    """LinuxCNC's own interpreter: asserts that it takes a text."""

    def read(text: str) -> rs274.Interpretation:
        with needed("LinuxCNC's interpreter"):
            result = rs274.interpret(text)
        assert result.ok, result.error
        return result

    return read


@pytest.fixture(scope="session", params=["1.1", "1.0"])
def freecad(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, engine: Path, addon: Path
) -> FreeCad:
    """Each FreeCAD that the addon is made for."""
    with needed(f"FreeCAD {request.param}"):
        roots.freecadcmd(request.param)
    return FreeCad(request.param, engine, addon, tmp_path_factory.mktemp(f"freecad-{request.param}"))


@pytest.fixture(scope="session")
def example(freecad: FreeCad) -> Example:
    """The example, run as its first line states."""
    out = freecad.folder / "cone_cup.ngc"
    done = freecad.run(EXAMPLE, str(STEP), str(out))
    return Example(done, out.read_text(encoding="utf-8") if out.exists() else "")


@pytest.fixture(scope="session")
def session(freecad: FreeCad) -> Session:
    """All scenarios, in one FreeCAD."""
    return _session(freecad, "scenarios.py", ["--", str(EXAMPLE), str(STEP), str(freecad.folder), str(COARSE)])


@pytest.fixture(scope="session")
def mixed_job(freecad: FreeCad) -> Any:
    """A job of FreeCAD's operations and ours, in a FreeCAD of its own: it is posted for every machine."""
    arguments = ["--", str(EXAMPLE), str(STEP), str(freecad.folder), str(COARSE), "mixed job"]
    return _session(freecad, "scenarios.py", arguments)["mixed job"]


@pytest.fixture(scope="session")
def bare_session(freecad: FreeCad, session: Session) -> Session:
    """The document that the scenarios saved, opened where there is no engine."""
    return _session(freecad, "without_engine.py", ["--", str(session.document)], engine=False)


def _session(freecad: FreeCad, script: str, args: Sequence[str], engine: bool = True) -> Session:
    done = freecad.run(INSIDE / script, *args, engine=engine)
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    pairs = [json.loads(line.removeprefix("RESULT ")) for line in lines]
    return Session(done, dict(pairs), freecad.folder / "saved.FCStd")


Reference = Callable[..., sc.RunResult]


@pytest.fixture(scope="session")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Reference:
    """The command line's result of the same job; `changes` go into its only operation."""
    known: dict[str, sc.RunResult] = {}

    def run(machine: str = "linuxcnc", **changes: Any) -> sc.RunResult:
        key = json.dumps([machine, changes], sort_keys=True)
        if key not in known:
            document = tomllib.loads(JOB.read_text(encoding="utf-8"))
            document["operations"][0] |= changes
            if changes.get("kind") == "zig-zag":
                document["accept"] = ["punch"]  # rows alone form no sheet
                del document["operations"][0]["step"]
            document["machine"] = {"name": machine}
            document["part"]["file"] = str(STEP)
            document["output"] = {"file": str(tmp_path_factory.mktemp("reference") / "out.ngc")}
            known[key] = sc.run(sc.Job.from_dict(document))
        return known[key]

    return run
