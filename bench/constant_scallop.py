"""Contours of equal scallop beside rows and levels at the same scallop: what stands after the posted program, and how long it is.

.venv/bin/python bench/constant_scallop.py             # the table in docs/concepts/constant-scallop.md, written again
.venv/bin/python bench/constant_scallop.py NAME ...    # only prints the rows of some parts

A ball of 10 mm, as it sweeps along the lines of the posted text, is measured in numpy, with no part of the engine: at
points spread at random over what faces up, the distance to the nearest of the capsules that it sweeps. Points that the
tool cannot touch (the drop-cutter holds it higher) are not counted, but their area is.
"""

from __future__ import annotations

import argparse
import math
import re
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from page import table

import styluscam as sc

Floats = npt.NDArray[np.float64]

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "concepts" / "constant-scallop.md"
PARTS = {"cap": "cap_r60", "frustum": "matrix/frustum_male", "freeform": "matrix/freeform"}
SCALLOPS = (0.02, 0.05)
RADIUS = 5.0
TESSELLATION = 0.0005
TOLERANCE = 0.002
POINTS = 100_000
PIECE = 0.25
"""Lines are divided into pieces of this length at most, mm."""
CELL = 2.0
"""Side of the squares in plan whose points are looked at together, mm."""
AROUND = 1.5
"""Centres of the ball are looked for so far from where it would touch a point, mm; beside them nothing goes over it."""
OPEN = 1.5
"""More than so many times the scallop, and the tolerance, is not covered."""
STEEPEST = 0.05
"""What faces up: the least vertical part of its normal."""


def operations(scallop: float) -> dict[str, dict[str, Any]]:
    """The three strategies, of which rows and levels are spaced by the scallop as well."""
    chord = 2.0 * math.sqrt(2.0 * RADIUS * scallop - scallop * scallop)
    return {
        "constant-scallop": {"kind": "constant-scallop", "scallop": scallop},
        "zig-zag": {"kind": "zig-zag", "stepover": round(chord, 4), "scallop": scallop},
        "z-level": {"kind": "z-level", "step": {"scallop": scallop}},
    }


def job(part: str, *chosen: dict[str, Any]) -> sc.Job:
    """A job for a part of the fixtures."""
    common = {"tool": "ball", "tolerance": TOLERANCE, "feeds": {"cut": 1500.0, "plunge": 300.0}, "links": "low"}
    common["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(ROOT / "fixtures" / f"{part}.step"), "tolerance": TESSELLATION},
            "process": {"kind": "milling"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 2.0 * RADIUS}}},
            "machine": {"name": "linuxcnc", "options": {"decimals": 4}},
            "operations": [common | operation for operation in chosen],
        }
    )


def centres(text: str) -> tuple[Floats, Floats, float]:
    """The ball's centre along the feed moves of a text, from (N, 3) and to (N, 3), and the length of all its moves, mm."""
    current = dict.fromkeys("XYZ", math.nan)
    ends: list[tuple[list[float], list[float]]] = []
    length, motion = 0.0, 0
    for line in text.splitlines():
        words = re.findall(r"([GXYZ])(-?[\d.]+)", re.sub(r"\(.*?\)|;.*", "", line))
        codes = [float(value) for letter, value in words if letter == "G"]
        motion = next((int(code) for code in codes if code in (0.0, 1.0, 2.0, 3.0)), motion)
        if 53.0 in codes or not any(letter in "XYZ" for letter, _ in words):
            continue
        assert motion <= 1, f"an arc: {line}"
        before = list(current.values())
        current |= {letter: float(value) for letter, value in words if letter in current}
        after = list(current.values())
        if any(map(math.isnan, before)):
            continue
        length += math.dist(before, after)
        if motion == 1:
            ends.append((before, after))
    moves = np.array(ends)
    moves[:, :, 2] += RADIUS
    return moves[:, 0], moves[:, 1], length


def pieces(start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Lines divided."""
    counts = np.maximum(1, np.ceil(np.linalg.norm(end - start, axis=1) / PIECE)).astype(int)
    line = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    shares = np.stack([number, number + 1], axis=1) / counts[line, None]
    first, second = (start[line] + share[:, None] * (end - start)[line] for share in shares.T)
    return first, second


def squares(points: Floats) -> Iterator[npt.NDArray[np.int64]]:
    """The points' numbers, square by square."""
    cells = np.floor(points[:, :2] / CELL).astype(np.int64)
    order = np.lexsort(cells.T)
    parts = np.flatnonzero(np.any(np.diff(cells[order], axis=0), axis=1)) + 1
    yield from np.split(order, parts)


def left(points: Floats, normals: Floats, start: Floats, end: Floats) -> Floats:
    """What the ball leaves at points of the part, mm; infinite where it goes over none."""
    start, end = pieces(start, end)
    order = np.argsort(start[:, 0])
    start, end = start[order], end[order]
    wanted = points + RADIUS * normals
    found = np.full(len(points), np.inf)
    for chosen in squares(wanted):
        at = wanted[chosen]
        low, high = at.min(axis=0) - AROUND - PIECE, at.max(axis=0) + AROUND + PIECE
        near = np.arange(*np.searchsorted(start[:, 0], [low[0], high[0]]))
        near = near[((start[near] > low) & (start[near] < high)).all(axis=1)]
        if near.size == 0:
            continue
        for some in np.array_split(chosen, math.ceil(len(chosen) * near.size / 4e6)):
            found[some] = distances(points[some], start[near], end[near]).min(axis=1) - RADIUS
    return found


def distances(points: Floats, start: Floats, end: Floats) -> Floats:
    """From points (N, 3) to lines (M, 3), (N, M)."""
    along = end - start
    squared = np.maximum((along * along).sum(axis=1), 1e-18)
    share = np.clip((points @ along.T - (start * along).sum(axis=1)) / squared, 0.0, 1.0)
    away = points[:, None, :] - start[None] - share[:, :, None] * along[None]
    return np.asarray(np.sqrt((away * away).sum(axis=2)))


@dataclass(frozen=True)
class Ground:
    """Points spread over what faces up of a part."""

    points: Floats
    normals: Floats
    touched: npt.NDArray[np.bool_]
    """Whether the tool can touch them."""
    area: float
    """Of all of them, mm^2."""

    @classmethod
    def of(cls, part: str, radius: float = RADIUS, tolerance: float = TESSELLATION, count: int = POINTS) -> Ground:
        shape = sc.Part.read(ROOT / "fixtures" / f"{part}.step", tolerance=tolerance)
        tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 2.0 * radius}})
        corners = np.asarray(shape.arrays.vertices)[np.asarray(shape.arrays.triangles)]
        normals = np.asarray(shape.arrays.normals)
        areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        areas[normals[:, :, 2].mean(axis=1) < STEEPEST] = 0.0
        random = np.random.default_rng(2)
        chosen = random.choice(len(areas), size=count, p=areas / areas.sum())
        root, share = np.sqrt(random.random(count)), random.random(count)
        weights = np.stack([1.0 - root, root * (1.0 - share), root * share], axis=1)[:, :, None]
        points, directions = (weights * corners[chosen]).sum(axis=1), (weights * normals[chosen]).sum(axis=1)
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        tips = points + radius * (directions - np.array([0.0, 0.0, 1.0]))
        touched = tips[:, 2] >= sc.drop_cutter(shape, tool, tips[:, :2]) - 0.003
        return cls(points, directions, touched, float(areas.sum()))


HEADS = (
    "part",
    "asked um",
    "strategy",
    "p50",
    "p90",
    "p99",
    "max",
    "over 1.1 mm2",
    "open mm2",
    "m",
    "min",
    "plan s",
    "findings",
)


def row(name: str, ground: Ground, strategy: str, scallop: float, *chosen: dict[str, Any]) -> list[str]:
    """One line of the table."""
    asked = job(PARTS[name], *chosen)
    begin = time.perf_counter()
    plan = sc.plan(asked)
    seconds = time.perf_counter() - begin
    machine = asked.machine()
    posted = sc.post(plan, machine)
    report = sc.verify(posted, asked)
    kinds = sorted({f"{finding.severity} {finding.kind}" for finding in report.findings})
    start, end, length = centres(posted.text)
    stands = left(ground.points, ground.normals, start, end)[ground.touched]
    share = ground.area / len(ground.touched)
    ratios = [
        f"{value / scallop:.2f}"
        for value in (*np.percentile(stands, (50.0, 90.0, 99.0), method="higher"), stands.max())
    ]
    areas = [f"{share * (stands > times * scallop + TOLERANCE).sum():.1f}" for times in (1.1, OPEN)]
    minutes = sc.read_gcode(posted.text, machine).engine.times(machine.engine)[1] / 60.0
    figures = [f"{length / 1000.0:.2f}", f"{minutes:.1f}", f"{seconds:.1f}"]
    return [name, f"{1000.0 * scallop:.0f}", strategy, *ratios, *areas, *figures, ", ".join(kinds) or "none"]


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(PARTS))
    names = parser.parse_args().names or list(PARTS)
    rows = []
    for name in names:
        ground = Ground.of(PARTS[name])
        bridged = ground.area * (1.0 - ground.touched.mean())
        print(f"{name}: {ground.area:.0f} mm2, of which {bridged:.1f} cannot be touched", file=sys.stderr)
        for scallop in SCALLOPS:
            for strategy, operation in operations(scallop).items():
                rows.append(row(name, ground, strategy, scallop, operation))
                print("  ".join(rows[-1]), file=sys.stderr)
    if names != list(PARTS):
        print(table(HEADS, rows))
        return
    head, rest = PAGE.read_text(encoding="utf-8").split("<!-- measured: begin -->")
    tail = rest.split("<!-- measured: end -->")[1]
    text = f"{head}<!-- measured: begin -->\n\n{table(HEADS, rows)}\n\n<!-- measured: end -->{tail}"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
