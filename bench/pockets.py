"""Pockets of the corpus at four angles: the engagement as simulated, what is left, length, links, time; as a table.

Run: ``python bench/pockets.py [--direction either] [--angles 45,90] [NAME ...]``. Angles and walls are the verifier's;
what is cleared is the planner's account; ``plan`` is the time of planning alone, ``all`` with the measurement of the angles.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

import styluscam as sc

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from fixtures.pockets import ANGLES_DEG, POCKETS, RADIUS, Pocket

ABOVE_DEG = 0.5
"""What the bound may be exceeded by."""


def lengths(path: sc.PocketPath) -> dict[str, float]:
    """Length by kind of run, mm."""
    total = dict.fromkeys(("cut", "link", "rapid", "entry"), 0.0)
    for points, kind in path.runs:
        chords = np.hypot(*np.diff(points[:, :2], axis=0).T)
        half = 2.0 * np.arctan(np.abs(points[:-1, 2]))
        total[kind] += float((chords * np.where(half > 1e-9, half / np.maximum(np.sin(half), 1e-12), 1.0)).sum())
    return total


def over(path: sc.PocketPath, bound: float) -> float:
    """Length of cuts and links with more than the bound, mm."""
    total = 0.0
    for run in path.engagement:
        if run.kind in ("cut", "link") and run.distances.size > 1:
            step = np.diff(run.distances, prepend=0.0)
            total += float(step[run.angles_deg > bound + ABOVE_DEG].sum())
    return total


def contour_parallel(corner: list[float], angle: float) -> tuple[float, float, float]:
    """Plain passes parallel to the walls of an upright rectangle about the origin, inside out with the stepover of ``angle``.

    Largest angle, deg, length of the path, and length of it with more than the bound, mm.
    """
    x, y = corner
    step = RADIUS * (1.0 - math.cos(math.radians(angle)))
    rings = [(x - RADIUS - i * step, y - RADIUS - i * step) for i in range(int((min(x, y) - RADIUS) / step) + 1)]
    path = [
        [sx * u, sy * v, 0.0] for u, v in reversed(rings) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))
    ]
    u, v = rings[-1]
    first = np.array([[-u, -v, 0.0], [u, -v, 0.0], [u, v, 0.0], [-u, v, 0.0], [-u, -v, 0.0]])
    runs = [(first, "entry"), (np.array(path), "cut")]
    walls = [np.array([[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]])]
    _, run = sc.engagement(runs, RADIUS, None, walls)
    above = np.diff(run.distances, prepend=0.0)[run.angles_deg > angle + ABOVE_DEG]
    return run.max_deg, float(run.distances[-1]), float(above.sum())


def row(name: str, pocket: Pocket, angle: float, direction: str = "climb") -> str:
    """One line of the table."""
    begin = time.perf_counter()
    planned: list[float] = []

    def progress(phase: str, _fraction: float) -> None:
        if phase == "measuring the engagement" and not planned:
            planned.append(time.perf_counter() - begin)

    path = sc.pocket_path(
        pocket.boundary,
        pocket.islands,
        tool_radius=RADIUS,
        engagement_deg=angle,
        open_edges=pocket.open_edges,
        direction=direction,
        progress=progress,
    )
    seconds = time.perf_counter() - begin
    total = lengths(path)
    moved = total["cut"] + total["link"] + total["rapid"]
    cut_area = path.reachable_area - path.uncleared_area
    share = total["cut"] * RADIUS * (1.0 - math.cos(math.radians(angle))) / cut_area
    clear = min((float(run.clearances.min()) for run in path.engagement if run.clearances.size), default=math.inf)
    overcut = 0.0 if pocket.open_edges else max(0.0, RADIUS - clear)
    return (
        f"{name:18} {angle:3.0f} {path.engagement_max_deg:7.2f} {over(path, angle):6.2f} {len(path.exempt):3d} "
        f"{100.0 * cut_area / path.reachable_area:8.3f} {1e3 * overcut:6.2f} {share:6.2f} "
        f"{100.0 * (moved - total['cut']) / moved:5.0f} {sum(k == 'rapid' for _, k in path.runs):4d} "
        f"{planned[0] if planned else seconds:6.2f} {seconds:6.2f}"
    )


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(POCKETS))
    parser.add_argument("--direction", default="climb")
    parser.add_argument("--angles", default=",".join(map(str, ANGLES_DEG)))
    parser.add_argument(
        "--contours", action="store_true", help="plain passes parallel to the walls of the upright rectangles"
    )
    asked = parser.parse_args()
    if asked.contours:
        for name in ("square-12", "square-30", "square-80", "rectangle-60x20", "rectangle-120x15"):
            for angle in map(float, asked.angles.split(",")):
                most, length, above = contour_parallel(POCKETS[name].boundary[2], angle)
                print(f"{name:18} {angle:3.0f} {most:7.2f} deg {length:8.1f} mm, {above:6.1f} mm above")
        return
    print("pocket               b max deg   over ent  cleared cut um  ratio link% lift   plan    all")
    for angle in map(float, asked.angles.split(",")):
        for name in asked.names or POCKETS:
            try:
                print(row(name, POCKETS[name], angle, asked.direction), flush=True)
            except sc.StylusError as error:
                print(f"{name:18} {angle:3.0f} refused: {error}", flush=True)


if __name__ == "__main__":
    main()
