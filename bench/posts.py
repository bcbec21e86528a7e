"""Posting and reading: every shipped machine, ten million moves in pieces, and whole jobs in FreeCAD beside its own post.

.venv/bin/python bench/posts.py     # rewrites the part "posts" of docs/performance.md
"""

from __future__ import annotations

import os
import re
import subprocess

import freecad_host
from page import machine, table, write


def example(name: str, *args: str) -> str:
    """What one of the engine's examples prints."""
    command = ["cargo", "run", "--release", "--quiet", "-p", "styluscam-post", "--example", name, "--", *args]
    return subprocess.run(command, cwd=freecad_host.CHECKOUT, check=True, capture_output=True, text=True).stdout


def rates() -> list[list[str]]:
    """Machine, and million moves a second posted and read."""
    found = re.findall(r"(\w+): (posts|reads) ([\d.]+) million", example("speed"))
    posted = {name: rate for name, what, rate in found if what == "posts"}
    read = {name: rate for name, what, rate in found if what == "reads"}
    return [[name, posted[name], read[name]] for name in posted]


def freecad(version: str) -> list[list[str]]:
    """Version, post, seconds and lines of a job of 50,000 commands."""
    rows = freecad_host.run(version, "freecad_posts.py")
    return [[version, post, f"{seconds:.3f}", f"{count:,}"] for post, seconds, count in rows]


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
        table(
            ["FreeCAD", "post", "s", "lines"], [row for version in freecad_host.VERSIONS for row in freecad(version)]
        ),
    ]
    write("posts", "\n".join(lines))


if __name__ == "__main__":
    main()
