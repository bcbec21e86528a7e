"""Builds and enters root file systems in which foreign programs (FreeCAD, LinuxCNC, a browser) check our work.

Everything is in `${STYLUSCAM_CACHE:-~/.cache/styluscam}`; nothing is installed on the host.

    python3 tests/oracles/roots.py ensure trixie forky browser
    python3 tests/oracles/roots.py enter trixie --bind /tmp/job:/job:rw -- freecadcmd /job/x.py
    python3 tests/oracles/roots.py doctor
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from rootfs.building import ensure, is_current, why_no_build, why_not
from rootfs.entering import INSIDE, Bind, enter, run
from rootfs.freecad import (
    FREECADCMD_ENV,
    FreeCadCmd,
    freecad_words,
    freecadcmd,
    host_commands,
    host_version,
    install_wheel,
    run_freecad,
)
from rootfs.paths import ROOTS, Root, RootsError, Unavailable, cache_dir, roots_dir, say
from rootfs.user_data import installed, user_data
from rootfs.window import PREFERENCES, Preferences, ready_window, run_window

__all__ = [
    "FREECADCMD_ENV",
    "INSIDE",
    "PREFERENCES",
    "ROOTS",
    "Bind",
    "FreeCadCmd",
    "Preferences",
    "Root",
    "RootsError",
    "Unavailable",
    "ensure",
    "freecad_words",
    "freecadcmd",
    "install_wheel",
    "installed",
    "ready_window",
    "roots_dir",
    "run",
    "run_freecad",
    "run_window",
    "user_data",
    "why_not",
]


VERSION_SCRIPT = """\
import os, sys
try:
    import FreeCAD
    import numpy
    version = ".".join(FreeCAD.Version()[:3])
    print(f"FreeCAD {version} Python {sys.version.split()[0]} numpy {numpy.__version__}")
except BaseException as error:
    print(f"failed: {error!r}")
sys.stdout.flush()
os._exit(0)
"""


def program_line(name: str) -> str:
    """What the program that a root is for reports of itself."""
    if ROOTS[name].freecad:
        return freecad_line(name)
    done = run(name, ["chromium", "--version"], timeout=120)
    return done.stdout.strip() or f"failed: {done.stderr.strip()[-300:]}"


def freecad_line(name: str) -> str:
    """What the FreeCAD in a root reports of itself: `FreeCAD 1.0.0 Python 3.13.5 numpy 2.2.4`."""
    script = f"printf %s {shlex.quote(VERSION_SCRIPT)} > v.py && exec freecadcmd v.py"
    done = run(name, ["sh", "-c", script], timeout=120)
    lines = [line for line in done.stdout.splitlines() if line.startswith(("FreeCAD ", "failed: "))]
    return lines[-1] if lines else f"failed: {done.stderr.strip()[-300:]}"


def _size(path: Path) -> str:
    """How much disk a tree takes, as du reports it."""
    done = subprocess.run(["du", "-sh", str(path)], capture_output=True, text=True, check=False)
    return done.stdout.split("\t")[0]


def doctor() -> int:
    """Prints what is there and whether it works; 1 when something is missing or wrong."""
    print(f"cache     {cache_dir()}")
    print(f"entering  {why_not() or 'works'}")
    print(f"building  {why_no_build() or 'works'}")
    try:
        for command in host_commands():
            print(f"host      {shlex.join(command)}: FreeCAD {host_version(command)}")
    except Unavailable as error:
        print(f"host      {error}")
    wrong = 0
    for name, root in ROOTS.items():
        if not is_current(name):
            there = "out of date" if (roots_dir() / name).exists() else "not built"
            print(f"{name:9} {there}: roots.py ensure {name}")
            wrong += 1
            continue
        line = program_line(name) if not why_not() else "failed: cannot be entered here"
        expected = f"FreeCAD {root.freecad}." if root.freecad else "Chromium "
        good = line.startswith(expected)
        wrong += not good
        verdict = "" if good else f"  WRONG: expected {expected}"
        print(f"{name:9} {_size(roots_dir() / name):>5}  {line}{verdict}")
    return 1 if wrong else 0


def _parser() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    build = commands.add_parser("ensure", help="build roots that are missing or out of date")
    build.add_argument("names", nargs="+", choices=sorted(ROOTS))
    inside = commands.add_parser("enter", help="run the command that follows -- inside a root")
    inside.add_argument("name", choices=sorted(ROOTS))
    inside.add_argument("--bind", action="append", default=[], metavar="SRC:DST[:rw]")
    inside.add_argument("--env", action="append", default=[], metavar="KEY=VALUE")
    inside.add_argument("--cwd", default="/tmp")
    commands.add_parser("doctor", help="say what is there and whether it works")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    cut = words.index("--") if "--" in words else len(words)
    options, argv = _parser().parse_args(words[:cut]), words[cut + 1 :]
    try:
        if options.command == "doctor":
            return doctor()
        if options.command == "ensure":
            for name in options.names:
                say(f"{name}: {ensure(name)}")
            return 0
        environment = dict(pair.partition("=")[::2] for pair in options.env)
        return enter(
            options.name,
            argv or ["bash"],
            [Bind.parse(text) for text in options.bind],
            options.cwd,
            environment,
        )
    except RootsError as error:
        say(f"error: {error}")
    return 2


if __name__ == "__main__":
    sys.exit(main())
