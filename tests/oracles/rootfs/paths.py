"""Which root file systems there are, what each holds, and where they lie."""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import hashlib
import json
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[3]


RECIPE = 1
"""Raise it when the steps of building change: every root is then built again."""


DISPLAY_PACKAGES = ("xvfb", "xauth", "openbox", "xdotool")


CAGE = (
    *("setpriv", "--pdeathsig", "KILL", "--"),
    *("unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child"),
)
"""Starts every command that mounts: its mounts and processes end with it, and it with us."""


@dataclasses.dataclass(frozen=True)
class Root:
    """What one root file system holds."""

    suite: str
    packages: tuple[str, ...]
    freecad: str = ""
    """The version of the FreeCAD in it, if any."""

    def stamp(self) -> str:
        """A hash that changes when the root has to be built again."""
        recipe = json.dumps([RECIPE, self.suite, sorted(self.packages)])
        return hashlib.sha256(recipe.encode()).hexdigest()


ROOTS: Mapping[str, Root] = {
    "trixie": Root(
        suite="trixie",
        freecad="1.0",
        packages=(
            "freecad",
            "linuxcnc-uspace",
            "python3-numpy",
            "python3-pip",
            "python3-venv",
            *DISPLAY_PACKAGES,
        ),
    ),
    "forky": Root(
        suite="forky",
        freecad="1.1",
        packages=("freecad", "python3-numpy", "python3-pip", *DISPLAY_PACKAGES),
    ),
    "browser": Root(suite="trixie", packages=("chromium", "fonts-dejavu-core")),
}


class RootsError(Exception):
    """A root file system cannot be built or entered; the text states why."""


class Unavailable(RootsError):
    """This machine cannot do it at all; the text states why in one sentence."""


def cache_dir() -> Path:
    """The only directory outside the checkout that is ever written to."""
    named = os.environ.get("STYLUSCAM_CACHE")
    return Path(named).expanduser().resolve() if named else Path.home() / ".cache" / "styluscam"


def roots_dir() -> Path:
    """The directory that holds the root file systems, their logs and their locks."""
    path = cache_dir() / "roots"
    path.mkdir(parents=True, exist_ok=True)
    return path


def say(text: str) -> None:
    """Prints a progress line; standard output stays free for the programs in the root."""
    print(f"roots: {text}", file=sys.stderr, flush=True)


@contextlib.contextmanager
def locked(name: str, kind: int) -> Iterator[int]:
    """Holds the file lock of that name: LOCK_SH to use a root, LOCK_EX to replace it."""
    handle = os.open(roots_dir() / f"{name}.lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        try:
            fcntl.flock(handle, kind | fcntl.LOCK_NB)
        except BlockingIOError:
            say(f"{name}: waiting for another process that holds its lock")
            fcntl.flock(handle, kind)
        yield handle
    finally:
        os.close(handle)
