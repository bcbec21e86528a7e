"""The material after 100,000 and a million moves over 200 x 200 mm at 0.05 mm: how long it takes, and how much memory.

.venv/bin/python bench/simulation.py     # rewrites the part "simulation" of docs/performance.md
"""

from __future__ import annotations

import os
import resource
import time
from collections.abc import Callable
from typing import Any, TypeVar

from meshes import wavy
from page import machine, table, write

import styluscam as sc

TRIANGLES = 200_000
CASES = (("ball", 0.8), ("clothoid", 0.8), ("ball", 0.08), ("clothoid", 0.08))
"""Kind of tool (D6) and mm from row to row."""

T = TypeVar("T")


def verified(part: sc.Part, kind: str, stepover: float) -> sc.Report:
    document: dict[str, Any] = {
        "schema": 1,
        "part": {"file": "wavy.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "tools": {"tool": {"profile": {"kind": kind, "diameter": 6.0}}},
        "operations": [
            {"kind": "zig-zag", "tool": "tool", "stepover": stepover, "spindle": {"mode": "fixed", "rpm": 8000.0}}
        ],
        "machine": {"name": "linuxcnc"},
    }
    job = sc.Job.from_dict(document, part=part)
    return sc.verify(sc.post(sc.plan(job), job.machine()), job)


def timed(work: Callable[[], T]) -> tuple[T, str, str]:
    """What it gave, with wall-clock and CPU seconds."""
    wall, cpu = time.perf_counter(), time.process_time()
    result = work()
    return result, f"{time.perf_counter() - wall:.1f}", f"{time.process_time() - cpu:.1f}"


def memory() -> str:
    """The most that was used so far, GB."""
    return f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f}"


def row(part: sc.Part, kind: str, stepover: float) -> list[str]:
    report = verified(part, kind, stepover)
    found, *simulating = timed(lambda: sc.simulate(report, 0.05))
    most = memory()
    _, *comparing = timed(found.compare)
    mesh, *drawing = timed(lambda: found.mesh(0.005))
    moves = f"{len(report.program.moves):,}"
    return [
        f"{kind} D6",
        moves,
        f"{found.heights.size:,}",
        *simulating,
        most,
        *comparing,
        f"{len(mesh[1]):,}",
        drawing[0],
    ]


def main() -> None:
    load = os.getloadavg()[0]
    vertices, triangles = wavy(TRIANGLES)
    part = sc.Part.from_mesh(vertices * [2.0, 2.0, 1.0], triangles)
    heads = ["tool", "moves", "nodes", "simulate, s", "CPU s", "GB", "compare, s", "CPU s", "triangles", "mesh, s"]
    rows = [row(part, *case) for case in CASES]
    lines = [
        f"Machine: {machine()}; load average {load:.1f} when the run began. Wavy surface of 200 x 200 mm, "
        f"{TRIANGLES:,} triangles, zig-zag rows; heights 0.05 mm apart, distances of all of them to the part, the mesh within "
        "0.005 mm of them. GB is the most that the process held up to the end of the simulation, program and report with it, "
        "cases one after the other.",
        "",
        table(heads, rows),
    ]
    write("simulation", "\n".join(lines))


if __name__ == "__main__":
    main()
