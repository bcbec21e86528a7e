"""Planning: seconds from a read part to a program, phase by phase, of the cap and of parts that were slow once.

.venv/bin/python bench/planning.py            # rewrites the part "planning" of docs/performance.md
.venv/bin/python bench/planning.py NAME ...   # only prints some cases, by the beginning of their names
"""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from page import machine, table, write

import styluscam as sc

Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]
FIXTURES = Path(__file__).resolve().parent.parent / "fixtures"
LIMIT = 120.0
"""Seconds after which a case is cancelled."""


def together(*meshes: Mesh) -> Mesh:
    firsts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([triangles + first for (_, triangles), first in zip(meshes, firsts, strict=False)]),
    )


def prism(outline: npt.NDArray[np.float64], low: float, high: float) -> Mesh:
    """Walls and top over a convex outline (N, 2)."""
    count = len(outline)
    bottom, top = (np.column_stack([outline, np.full(count, z)]) for z in (low, high))
    i = np.arange(count)
    j = (i + 1) % count
    fan = np.column_stack([np.zeros(count - 2, dtype=int), i[1:-1], i[2:]]) + count
    return np.vstack([bottom, top]), np.vstack(
        [np.column_stack([i, j, j + count]), np.column_stack([i, j + count, i + count]), fan]
    )


def circle(x: float, y: float, radius: float, sides: int) -> npt.NDArray[np.float64]:
    angle = 2.0 * np.pi * np.arange(sides) / sides
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])


def rectangle(x: float, y: float, width: float, depth: float) -> npt.NDArray[np.float64]:
    return np.array([[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]])


def floor(width: float, depth: float) -> Mesh:
    return np.array([[0, 0, 0], [width, 0, 0], [width, depth, 0], [0, depth, 0]], dtype=float), np.array(
        [[0, 1, 2], [0, 2, 3]]
    )


def bosses(rows: int, pitch: float, radius: float, sides: int, height: float = 5.0) -> Mesh:
    positions = itertools.product(range(rows), repeat=2)
    pins = (prism(circle((i + 0.5) * pitch, (j + 0.5) * pitch, radius, sides), 0.0, height) for i, j in positions)
    return together(floor(rows * pitch, rows * pitch), *pins)


def fins(count: int, gap: float) -> Mesh:
    walls = (prism(rectangle(5.0 + i * (1.0 + gap), 5.0, 1.0, 30.0), 0.0, 8.0) for i in range(count))
    return together(floor(10.0 + count * (1.0 + gap), 40.0), *walls)


def cone(facets: int) -> Mesh:
    ring = circle(0.0, 0.0, 30.0, facets)
    i = np.arange(facets)
    vertices = np.vstack([np.column_stack([ring, np.zeros(facets)]), [[0.0, 0.0, 30.0]]])
    return vertices, np.column_stack([i, (i + 1) % facets, np.full(facets, facets)])


def terrain(count: int, size: float) -> Mesh:
    x, y = np.meshgrid(np.linspace(0.0, size, count), np.linspace(0.0, size, count))
    z = (
        3.0 * np.sin(x / 9.0) * np.cos(y / 7.0)
        + 0.6 * np.sin(x / 1.7 + y / 2.3)
        + 0.1 * np.random.default_rng(7).random(x.shape)
    )
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), np.vstack(
        [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    )


def job(kind: str, profile: dict[str, Any], pitch: float, **operation: Any) -> dict[str, Any]:
    along = {"step": {"height": pitch}} if kind == "z-level" else {"stepover": pitch}
    return {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "tools": {"tool": {"profile": profile}},
        "operations": [
            {"kind": kind, "tool": "tool", "spindle": {"mode": "fixed", "rpm": 8000.0}, **along, **operation}
        ],
        "machine": {"name": "linuxcnc"},
    }


def tool(kind: str, diameter: float) -> dict[str, Any]:
    return {"kind": kind, "diameter": diameter}


def made(mesh: Mesh) -> Callable[[], sc.Part]:
    return lambda: sc.Part.from_mesh(*mesh)


def cap() -> sc.Part:
    return sc.Part.read(FIXTURES / "cap_r60.step")


def cases() -> Iterator[tuple[str, Callable[[], sc.Part], dict[str, Any]]]:
    """Names, parts and jobs."""
    yield "cap R60, ball D6, rows 0.5 mm", cap, job("zig-zag", tool("ball", 6.0), 0.5)
    yield "cap R60, ball D6, levels 0.5 mm", cap, job("z-level", tool("ball", 6.0), 0.5)
    pins = made(bosses(8, 6.0, 1.0, 24, 10.0))
    for kind in ("flat", "ball", "clothoid"):
        yield f"64 pins, {kind} D2, levels", pins, job("z-level", tool(kind, 2.0), 1.0)
    yield "64 pins, clothoid D2, rows", pins, job("zig-zag", tool("clothoid", 2.0), 0.5)
    for kind in ("ball", "clothoid"):
        yield f"fins 0.05 mm apart, {kind} D2, levels", made(fins(20, 0.05)), job("z-level", tool(kind, 2.0), 0.5)
    yield "fins 0.05 mm apart, flat D2, rows", made(fins(20, 0.05)), job("zig-zag", tool("flat", 2.0), 0.5)
    yield "cone of 8,000 facets, ball D6, levels", made(cone(8000)), job("z-level", tool("ball", 6.0), 1.0)
    yield "cone of 8,000 facets, clothoid D6, levels", made(cone(8000)), job("z-level", tool("clothoid", 6.0), 1.0)
    yield "1,600 bosses, flat D2, one level", made(bosses(40, 5.0, 1.0, 12)), job("z-level", tool("flat", 2.0), 3.0)
    yield "6,400 bosses, flat D2, one level", made(bosses(80, 5.0, 1.0, 12)), job("z-level", tool("flat", 2.0), 3.0)
    yield (
        "terrain 100 x 100 mm, 80,000 facets, rows 0.5 mm",
        made(terrain(200, 100.0)),
        job("zig-zag", tool("ball", 6.0), 0.5),
    )
    loose = job("zig-zag", tool("ball", 6.0), 0.5, tolerance=0.05)
    yield "the same, tolerance 0.05 mm", made(terrain(200, 100.0)), loose
    plate = together(floor(10_000.0, 10_000.0), prism(circle(5000.0, 5000.0, 500.0, 64), 0.0, 20.0))
    yield "plate of 10 m, flat D20, rows 15 mm", made(plate), job("zig-zag", tool("flat", 20.0), 15.0)


class Phases:
    """Seconds by phase, and how long a cancelled plan went on."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.begun = self.last = time.perf_counter()
        self.processor = time.process_time()
        self.phase = ""

    def __call__(self, phase: str, fraction: float) -> bool:
        now = time.perf_counter()
        self.seconds[self.phase] = self.seconds.get(self.phase, 0.0) + now - self.last
        self.last, self.phase = now, phase
        return now - self.begun < LIMIT

    def slowest(self) -> str:
        worst = sorted(self.seconds.items(), key=lambda item: -item[1])[:3]
        return ", ".join(f"{phase or 'begin'} {seconds:.2f}" for phase, seconds in worst if seconds >= 0.05)


def measured(part: sc.Part, document: dict[str, Any]) -> list[str]:
    """Seconds, seconds of all threads together, moves and the slowest phases of a plan."""
    asked = sc.Job.from_dict(document, part=part)
    phases = Phases()
    try:
        plan = sc.plan(asked, progress=phases)
    except sc.Cancelled:
        return [f"> {LIMIT:.0f}", f"{time.process_time() - phases.processor:.2f}", "", phases.slowest()]
    except sc.StylusError as error:
        return [f"{time.perf_counter() - phases.begun:.2f}", "", "refused", str(error)[:80]]
    seconds, processor = time.perf_counter() - phases.begun, time.process_time() - phases.processor
    phases("", 1.0)
    return [f"{seconds:.2f}", f"{processor:.2f}", f"{len(plan.programs['main'].moves):,}", phases.slowest()]


def main() -> None:
    wanted = sys.argv[1:]
    rows = []
    for name, part, document in cases():
        if wanted and not any(name.startswith(begin) for begin in wanted):
            continue
        read = part()
        rows.append([name, *measured(read, document)])
        print(" | ".join(rows[-1]), flush=True)
    if not wanted:
        heads = ["case", "s", "of both threads", "moves", "slowest phases, s"]
        text = "Seconds from a read part to a program.\n\n" + table(heads, rows)
        write("planning", f"{text}\n\n{machine()}")


if __name__ == "__main__":
    main()
