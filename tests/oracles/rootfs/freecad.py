"""FreeCAD without a window: the host's or that of a root file system, and wheels for it."""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from rootfs.building import ensure
from rootfs.entering import Bind, ready
from rootfs.paths import CHECKOUT, ROOTS, RootsError, Unavailable, cache_dir, roots_dir

FREECADCMD_ENV = "STYLUSCAM_FREECADCMD"


WHEELS_KEPT = 7 * 24 * 3600.0
"""Seconds after its last use that an unzipped wheel stays in the cache."""


@dataclasses.dataclass(frozen=True)
class FreeCadCmd:
    """A FreeCAD without a window: a command of the host's, or the one in a root."""

    version: str
    command: tuple[str, ...]
    root: str | None


@functools.cache
def host_version(command: tuple[str, ...]) -> str | None:
    """The `1.1` of a FreeCAD on the host, or None when it does not answer."""
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60, check=False)
        found = re.search(r"FreeCAD (\d+\.\d+)", done.stdout)
        return found[1] if found else None
    return None


def host_commands() -> Iterator[tuple[str, ...]]:
    """The FreeCADs that a person may have installed, the named one first."""
    named = os.environ.get(FREECADCMD_ENV)
    if named:
        command = tuple(shlex.split(named))
        if host_version(command) is None:
            raise Unavailable(f"{FREECADCMD_ENV}={named} does not answer --version.")
        yield command
    for name in ("freecadcmd", "FreeCADCmd"):
        path = shutil.which(name)
        if path:
            yield (path,)


def freecadcmd(version: str) -> FreeCadCmd:
    """Finds FreeCAD `1.0` or `1.1`: the host's when its version matches, else the root's.

    Raises Unavailable with a one-sentence reason when this machine can have neither.
    """
    for command in host_commands():
        if host_version(command) == version:
            return FreeCadCmd(version, command, None)
    for name, root in ROOTS.items():
        if root.freecad == version:
            try:
                ready(name)
            except Unavailable as error:
                raise Unavailable(f"No FreeCAD {version} on this host: {error}") from error
            return FreeCadCmd(version, ("freecadcmd",), name)
    raise Unavailable(f"No FreeCAD {version} on this host, and no root file system has it.")


def freecad_argv(
    version: str,
    script: Path,
    *args: str,
    python_path: Sequence[Path] = (),
    mod_path: Sequence[Path] = (),
    binds: Sequence[Bind] = (),
) -> list[str]:
    """The command that runs a script in FreeCAD; every path is the same inside and outside.

    `python_path` takes directories to import from (an unzipped wheel), `mod_path` takes addon
    directories themselves (the one with package.xml, not its parent). Only they, the checkout and
    the script's directory are seen inside, read-only: give a folder to write as
    `binds=[Bind.same(directory, writable=True)]`. FreeCAD hides exceptions: the script has to end
    with flushing and `os._exit(code)`.
    """
    script = script.resolve()
    pythons = [path.resolve() for path in python_path]
    mods = [path.resolve() for path in mod_path]
    options: list[str] = []
    for path in pythons:
        options += ["-P", str(path)]
    for path in mods:
        options += ["-M", str(path)]
    return [*freecad_words(version, [script.parent, *pythons, *mods], binds), *options, str(script), *args]


def freecad_words(version: str, seen: Sequence[Path] = (), binds: Sequence[Bind] = ()) -> list[str]:
    """The words that start FreeCAD, to which its arguments are added; `seen` and `binds` as for freecad_argv."""
    found = freecadcmd(version)
    if found.root is None:
        home = cache_dir() / "freecad-user" / version
        home.mkdir(parents=True, exist_ok=True)
        return ["env", f"FREECAD_USER_HOME={home}", *found.command]
    shown = [CHECKOUT, *(path for path in seen if not path.is_relative_to(CHECKOUT))]
    everything = [*(Bind.same(path) for path in dict.fromkeys(shown)), *binds]
    options = [word for bind in everything for word in ("--bind", str(bind))]
    here = str(Path(__file__).resolve().parents[1] / "roots.py")
    return [sys.executable, here, "enter", found.root, *options, "--", *found.command]


def run_freecad(
    version: str,
    script: Path,
    *args: str,
    python_path: Sequence[Path] = (),
    mod_path: Sequence[Path] = (),
    binds: Sequence[Bind] = (),
    timeout: float | None = None,
) -> subprocess.CompletedProcess[str]:
    """Runs a script in FreeCAD, its output captured; the arguments are those of freecad_argv.

    FreeCAD ends with 0 after an uncaught exception and after a script that is not there: here it is 1.
    """
    command = freecad_argv(version, script, *args, python_path=python_path, mod_path=mod_path, binds=binds)
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=timeout,
        check=False,
    )
    if done.returncode == 0 and "Exception while processing file" in done.stdout + done.stderr:
        done.returncode = 1
    return done


def _root_python(name: str) -> tuple[int, int]:
    """The version of a root's Python, read from its files."""
    link = (roots_dir() / name / "usr/bin/python3").readlink().name
    found = re.fullmatch(r"python(\d+)\.(\d+)", link)
    if not found:
        raise RootsError(f"{name}: python3 is a link to {link}, which names no version.")
    return int(found[1]), int(found[2])


def install_wheel(root_name: str, wheel_path: Path) -> Path:
    """Unzips a wheel into the cache and returns the directory to give as `python_path`.

    The directory is keyed by the wheel's contents, so it is never stale. A wheel made for a newer
    Python than the root's, or for one exact other Python, is refused.
    """
    ensure(root_name)
    tags = wheel_path.name.removesuffix(".whl").split("-")[-3:]
    found = re.match(r"cp(\d)(\d+)", tags[0])
    if found:
        wanted, have = (int(found[1]), int(found[2])), _root_python(root_name)
        if wanted > have or (tags[1] != "abi3" and wanted != have):
            raise RootsError(f"{wheel_path.name} does not fit the Python {have[0]}.{have[1]} of {root_name}.")
    digest = hashlib.sha256(wheel_path.read_bytes()).hexdigest()[:16]
    target = cache_dir() / "wheels" / digest
    if not target.is_dir():
        _drop_old_wheels(target.parent)
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=target.parent, prefix="partial-") as partial:
            with zipfile.ZipFile(wheel_path) as archive:
                archive.extractall(Path(partial) / digest)
            _rename_unless_there(Path(partial) / digest, target)
    os.utime(target)
    return target


def _rename_unless_there(source: Path, target: Path) -> None:
    """Moves a finished directory into place; one that another process put there first stays."""
    try:
        source.rename(target)
    except OSError:
        if not target.is_dir():
            raise


def _drop_old_wheels(directory: Path) -> None:
    """Deletes unzipped wheels that nobody used for a week."""
    for entry in directory.glob("*"):
        if time.time() - entry.stat().st_mtime > WHEELS_KEPT:
            shutil.rmtree(entry, ignore_errors=True)
