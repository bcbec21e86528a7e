"""Posting and reading: every shipped machine, ten million moves in pieces, and whole jobs in FreeCAD beside its own post.

.venv/bin/python bench/posts.py     # rewrites the part "posts" of docs/performance.md
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from page import machine, table, write

import styluscam as sc

CHECKOUT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(CHECKOUT / "tests" / "oracles"))
import roots  # noqa: E402 - the FreeCAD that the tests use

INSIDE = Path(__file__).with_name("freecad_posts.py")
VERSIONS = ("1.1", "1.0")


def example(name: str, *args: str) -> str:
    """What one of the engine's examples prints."""
    command = ["cargo", "run", "--release", "--quiet", "-p", "styluscam-post", "--example", name, "--", *args]
    return subprocess.run(command, cwd=CHECKOUT, check=True, capture_output=True, text=True).stdout


def rates() -> list[list[str]]:
    """Machine, and million moves a second posted and read."""
    found = re.findall(r"(\w+): (posts|reads) ([\d.]+) million", example("speed"))
    posted = {name: rate for name, what, rate in found if what == "posts"}
    read = {name: rate for name, what, rate in found if what == "reads"}
    return [[name, posted[name], read[name]] for name in posted]


def freecad(version: str) -> list[list[str]]:
    """Version, post, seconds and lines of a job of 50,000 commands."""
    with tempfile.TemporaryDirectory() as folder:
        engine = Path(folder) / "engine"
        shutil.copytree(Path(sc.__file__).parent, engine / "styluscam")
        done = roots.run_freecad(
            version,
            INSIDE,
            python_path=[engine],
            mod_path=[CHECKOUT / "freecad_workbench"],
            binds=[roots.Bind.same(Path(folder), writable=True)],
            timeout=600,
        )
    lines = [line.removeprefix("RESULT ") for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if not lines:
        raise SystemExit(done.stdout[-2000:] + done.stderr[-2000:])
    return [[version, post, f"{seconds:.3f}", f"{count:,}"] for post, seconds, count in json.loads(lines[0])]


def main() -> None:
    load = os.getloadavg()[0]
    stream = example("stream", "10000000").strip().replace("\n", "; ")
    lines = [
        f"Machine: {machine()}; load average {load:.1f} when the run began. Two million short feed moves, one thread.",
        "",
        table(["machine", "posted, million moves/s", "read, million lines/s"], rates()),
        "",
        f"Ten million moves, posted in pieces: {stream}.",
        "",
        "A job of 50,000 commands in FreeCAD, the best of three; `linuxcnc` is FreeCAD's own post:",
        "",
        table(["FreeCAD", "post", "s", "lines"], [row for version in VERSIONS for row in freecad(version)]),
    ]
    write("posts", "\n".join(lines))


if __name__ == "__main__":
    main()
