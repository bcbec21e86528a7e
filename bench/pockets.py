"""Pockets of the corpus at four angles: the engagement as simulated, what is left, length, links, time; as a table.

Run: ``python bench/pockets.py [NAME ...]``. Angles and walls are the verifier's; what is left is the planner's account.
"""

from __future__ import annotations

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


def row(name: str, pocket: Pocket, angle: float) -> str:
    """One line of the table."""
    begin = time.perf_counter()
    path = sc.pocket_path(
        pocket.boundary, pocket.islands, tool_radius=RADIUS, engagement_deg=angle, open_edges=pocket.open_edges
    )
    seconds = time.perf_counter() - begin
    total = lengths(path)
    moved = total["cut"] + total["link"] + total["rapid"]
    cut_area = path.reachable_area - path.uncleared_area
    share = total["cut"] * RADIUS * (1.0 - math.cos(math.radians(angle))) / cut_area
    clear = min((float(run.clearances.min()) for run in path.engagement if run.clearances.size), default=math.inf)
    overcut = 0.0 if pocket.open_edges else max(0.0, RADIUS - clear)
    entries = [exempt for exempt in path.exempt if exempt.reason == "entry"]
    return (
        f"{name:18} {angle:3.0f} {path.engagement_max_deg:7.2f} {over(path, angle):7.2f} {len(entries):3d} "
        f"{100.0 * path.uncleared_area / (cut_area + path.uncleared_area):8.4f} {1e3 * overcut:6.2f} "
        f"{share:6.2f} {100.0 * (moved - total['cut']) / moved:5.0f} {sum(k == 'rapid' for _, k in path.runs):4d} {seconds:7.2f}"
    )


def main() -> None:
    """The table."""
    names = sys.argv[1:] or list(POCKETS)
    print("pocket               b max deg over mm ent   left % cut um  ratio link% lift       s")
    for name in names:
        for angle in ANGLES_DEG:
            try:
                print(row(name, POCKETS[name], angle), flush=True)
            except sc.StylusError as error:
                print(f"{name:18} {angle:3.0f} refused: {error}", flush=True)


if __name__ == "__main__":
    main()
