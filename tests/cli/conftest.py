"""The command line in this process, parts that are read in no time, and jobs that are planned in no time."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from styluscam.cli import invoke

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parents[1]
FIXTURES = CHECKOUT / "fixtures"

COARSE_CUP = f"""
schema = 1
title = "Coarse cup"

[part]
file = {json.dumps(str(FIXTURES / "cone_cup.step"))}
faces = ["Face1", "Face2", "Face3", "Face4"]
model_face = "back"
tolerance = 0.001

[setup]
zero = "sheet-top"

[setup.sheet]
thickness = 1.0

[tools.stylus]
number = 1
reference = "tip"
profile = {{ kind = "clothoid", diameter = 10.0 }}

[[operations]]
id = "cup"
kind = "z-level"
tool = "stylus"
step = {{ height = 4.0 }}
tolerance = 0.005
smallest_feature = 4.0

[machine]
name = "linuxcnc"

[output]
file = "cup.ngc"
program = "cup.program.json"
"""
"""The main job, but coarse."""


@dataclasses.dataclass(frozen=True)
class Ran:
    """What a command line gave back."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """The one document on stdout."""
        return json.loads(self.out)


def _read(descriptor: int) -> str:
    os.lseek(descriptor, 0, os.SEEK_SET)
    with os.fdopen(os.dup(descriptor), encoding="utf-8") as file:
        return file.read()


@contextlib.contextmanager
def _files() -> Iterator[tuple[int, int]]:
    """The process's stdout and stderr go to files meanwhile: C code writes there too."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        sys.stdout.flush()
        sys.stderr.flush()
        kept = os.dup(1), os.dup(2)
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        try:
            yield out.fileno(), err.fileno()
        finally:
            for number, descriptor in enumerate(kept, start=1):
                os.dup2(descriptor, number)
                os.close(descriptor)


def run_cli(*arguments: str | Path) -> Ran:
    """Runs a command line in this process."""
    words: Sequence[str] = [str(argument) for argument in arguments]
    with _files() as (out, err):
        errors = io.TextIOWrapper(os.fdopen(os.dup(2), "wb", buffering=0), encoding="utf-8", write_through=True)
        with contextlib.redirect_stderr(errors):
            code = invoke(words)
        errors.close()
        return Ran(code, _read(out), _read(err))


@pytest.fixture(scope="session", autouse=True)
def read_once() -> Iterator[None]:
    """A fixture part is read once per session and tolerance: that takes longer than planning it."""
    from styluscam.parts.reading import read_part
    from styluscam.programs import job

    known: dict[tuple[str, float], sc.Part] = {}

    def read(file: str | Path, tolerance: float = 0.001, units: str | None = None, progress: Any = None) -> sc.Part:
        path = Path(file).resolve()
        if path.parent != FIXTURES:
            return sc.Part.from_arrays(read_part(file, tolerance, units, progress))
        if (path.name, tolerance) not in known:
            known[path.name, tolerance] = sc.Part.from_arrays(read_part(path, tolerance, units, progress))
        return known[path.name, tolerance]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(job.Part, "read", read)
        yield


@pytest.fixture(scope="session")
def cli() -> Callable[..., Ran]:
    """Runs a command line in this process."""
    return run_cli


@pytest.fixture(scope="session")
def box_step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box of 60 x 40 x 20 mm: six faces, read in no time."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

    path = tmp_path_factory.mktemp("box") / "box.step"
    write_step(BRepPrimAPI_MakeBox(60.0, 40.0, 20.0).Shape(), path)
    return path


def write_step(shape: Any, path: Path) -> None:
    """Writes a shape as STEP, without the kernel's chatter."""
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    from styluscam.parts.kernel import quiet_kernel

    with quiet_kernel():
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))


@dataclasses.dataclass(frozen=True)
class CoarseRun:
    """A coarse run of the cup."""

    folder: Path
    ran: Ran

    @property
    def job(self) -> Path:
        return self.folder / "job.toml"

    @property
    def gcode(self) -> Path:
        return self.folder / "cup.ngc"


@pytest.fixture(scope="session")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., CoarseRun]:
    """Runs the coarse cup with some words replaced; each choice of words once."""
    done: dict[tuple[tuple[str, str], ...], CoarseRun] = {}

    def run(*changes: tuple[str, str]) -> CoarseRun:
        if changes not in done:
            folder = tmp_path_factory.mktemp("coarse")
            (folder / "job.toml").write_text(changed(COARSE_CUP, *changes))
            done[changes] = CoarseRun(folder, run_cli("run", folder / "job.toml", "--json"))
        return done[changes]

    return run


def changed(text: str, *changes: tuple[str, str]) -> str:
    """The text with words replaced, each of which must be there."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text
