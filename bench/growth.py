"""How the cost grows with the triangles: drop-cutter, index, memory, waterlines; a table and docs/images/growth.png.

    python bench/growth.py [--most 5000000] [--repeats 2] [--dry]

Each size has a process of its own, so that its peak memory is its own.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from meshes import positions, wavy
from page import PAGE, machine, table, write

import styluscam as sc

SIZES = (20_000, 50_000, 200_000, 500_000, 2_000_000, 5_000_000)
POINTS = 800_000
LEVELS = 10
PROFILES = {"ball D6": {"kind": "ball", "diameter": 6.0}, "clothoid D8": {"kind": "clothoid", "diameter": 8.0}}
PICTURE = PAGE.parent / "images" / "growth.png"


def peak_bytes() -> int:
    """The most memory that this process ever had (Linux counts it in KiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def seconds(work: Callable[[], object], repeats: int = 1) -> float:
    least = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        least = min(least, time.perf_counter() - begin)
    return least


def measured(triangles: int, repeats: int) -> dict[str, Any]:
    """All figures of one size, in this process."""
    vertices, faces = wavy(triangles)
    tools = {name: sc.Tool.from_dict({"profile": profile}) for name, profile in PROFILES.items()}
    xy = positions("raster", POINTS)
    before = peak_bytes()
    part = sc.Part.from_mesh(vertices, faces)
    first = seconds(lambda: sc.drop_cutter(part, tools["ball D6"], xy[:1]))
    figures: dict[str, Any] = {"triangles": len(faces)}
    for name, tool in tools.items():
        ready = seconds(lambda tool=tool: sc.drop_cutter(part, tool, xy[:1]), repeats)
        whole = seconds(lambda tool=tool: sc.drop_cutter(part, tool, xy), repeats)
        figures[name] = {"rate": len(xy) / (whole - ready), "ready": ready}
    figures["index"] = first - figures["ball D6"]["ready"]
    figures["bytes"] = (peak_bytes() - before) / len(faces)
    levels = np.linspace(-2.0, 6.0, LEVELS)
    figures["levels"] = seconds(lambda: sc.waterlines(part, tools["ball D6"], levels))
    figures["peak"] = peak_bytes()
    return figures


def apart(triangles: int, repeats: int) -> dict[str, Any]:
    """The same in a process of its own."""
    command = [sys.executable, __file__, "--one", str(triangles), "--repeats", str(repeats)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def page(rows: list[dict[str, Any]]) -> str:
    heads = ["triangles", *(f"{name}, points/s" for name in PROFILES), "index s", "tool ms", "bytes a triangle"]
    heads += [f"{LEVELS} waterlines s", "peak of all GB"]
    body = [
        [
            f"{row['triangles']:,}",
            *(f"{row[name]['rate']:,.0f}" for name in PROFILES),
            f"{row['index']:.3f}",
            f"{1e3 * row['ball D6']['ready']:.0f}",
            f"{row['bytes']:.0f}",
            f"{row['levels']:.2f}",
            f"{row['peak'] / 1e9:.2f}",
        ]
        for row in rows
    ]
    words = (
        f"Machine: {machine()}. The wavy surface of 100 x 100 mm, {POINTS:,} positions 0.1 mm apart in raster order, "
        'all threads, wall time. "Bytes a triangle" is what a call needs at most on top of the arrays given: part, '
        "index, tool, positions; the last column is the whole process, Python and the arrays among it."
    )
    return f"{words}\n\n{table(heads, body)}\n\n![cost against triangles](images/growth.png)"


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    mpl.use("agg")
    from matplotlib import pyplot as plt

    sizes = [row["triangles"] for row in rows]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
    for name in PROFILES:
        left.plot(sizes, [1e6 / row[name]["rate"] for row in rows], marker="o", label=name)
    left.set(xscale="log", xlabel="triangles", ylabel="drop-cutter, µs a point", ylim=(0.0, None))
    left.legend()
    right.plot(sizes, [row["index"] for row in rows], marker="o", label="index, s")
    right.plot(sizes, [row["levels"] for row in rows], marker="o", label=f"{LEVELS} waterlines, s")
    right.plot(sizes, [row["peak"] / 1e9 for row in rows], marker="o", label="peak memory, GB")
    right.set(xscale="log", yscale="log", xlabel="triangles")
    right.legend()
    for axes in (left, right):
        axes.grid(visible=True, alpha=0.3)
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=SIZES[-1], help="largest number of triangles")
    parser.add_argument("--repeats", type=int, default=2, help="of each measurement; the best counts")
    parser.add_argument("--dry", action="store_true", help="print only")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        print(json.dumps(measured(given.one, given.repeats)))
        return
    rows = [apart(size, given.repeats) for size in SIZES if size <= given.most]
    print(page(rows))
    if not given.dry:
        PICTURE.parent.mkdir(exist_ok=True)
        draw(rows, PICTURE)
        write("growth", page(rows))


if __name__ == "__main__":
    main()
