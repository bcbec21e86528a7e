"""Measures drop-cutter beside OpenCAMLib, and the main job by phase; writes docs/performance.md between its markers.

    python bench/drop_cutter.py [--large] [--repeats 3] [--dry]

Nothing here is a test: figures are the best of a few repeats, wall time and CPU time of all threads.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from meshes import positions, wavy
from opencamlib_peer import answer, peer_python
from page import machine, table, write

import styluscam as sc
from styluscam.judging.verification import judge_plan

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parent

PROFILES = {"ball D6": {"kind": "ball", "diameter": 6.0}, "clothoid D8": {"kind": "clothoid", "diameter": 8.0}}
ORDERS = ("raster", "random")
THREADS = (1, 2)
POINTS = 800_000
PEER_POINTS = {20_000: 400, 200_000: 60}


def best(work: Callable[[], object], repeats: int) -> tuple[float, float]:
    """Least wall and CPU seconds of some repeats."""
    walls, cpus = [], []
    for _ in range(repeats):
        wall, cpu = time.perf_counter(), time.process_time()
        work()
        walls.append(time.perf_counter() - wall)
        cpus.append(time.process_time() - cpu)
    return min(walls), min(cpus)


# --- ours -------------------------------------------------------------------------------------------------------


def ours(triangles: int, repeats: int) -> list[dict[str, Any]]:
    """All figures of one mesh with the number of threads that this process has."""
    arrays = wavy(triangles)
    part = sc.Part.from_mesh(*arrays)
    rows = []
    for name, profile in PROFILES.items():
        tool = sc.Tool.from_dict({"profile": profile})
        first, first_cpu = index_time(arrays, tool, repeats)
        for order in ORDERS:
            chosen = positions(order, POINTS)
            setup, setup_cpu = best(lambda t=tool, p=chosen: sc.drop_cutter(part, t, p[:1]), repeats)
            wall, cpu = best(lambda t=tool, p=chosen: sc.drop_cutter(part, t, p), repeats)
            rows.append(
                {
                    "tool": name,
                    "order": order,
                    "points": len(chosen),
                    "setup": setup,
                    "setup_cpu": setup_cpu,
                    "index": first - setup,
                    "index_cpu": first_cpu - setup_cpu,
                    "wall": wall,
                    "cpu": cpu,
                }
            )
    return rows


def index_time(arrays: Any, tool: sc.Tool, repeats: int) -> tuple[float, float]:
    """Seconds of a part's first call, with one point: the index is built then."""
    parts = [sc.Part.from_mesh(*arrays) for _ in range(repeats)]
    return best(lambda: sc.drop_cutter(parts.pop(), tool, np.array([[50.0, 50.0]])), repeats)


def ours_in_process(triangles: int, threads: int, repeats: int) -> list[dict[str, Any]]:
    """The same in a process of its own: the engine takes its threads once."""
    command = [sys.executable, __file__, "--ours", str(triangles), "--repeats", str(repeats)]
    done = subprocess.run(
        command, env={**os.environ, "RAYON_NUM_THREADS": str(threads)}, capture_output=True, text=True, check=True
    )
    rows: list[dict[str, Any]] = json.loads(done.stdout)
    return rows


def main_job(repeats: int) -> list[tuple[str, float, float]]:
    """Seconds of the main job's phases: wall and CPU."""
    job = sc.Job.read(CHECKOUT / "examples" / "first-light" / "job.toml")

    def read() -> None:
        job._part = None
        job.part()

    phases = [("read STEP, tessellate, check", *best(read, repeats))]
    phases.append(("plan", *best(lambda: sc.plan(job), repeats)))
    plan = sc.plan(job)
    phases.append(("post", *best(lambda: sc.post(plan), repeats)))
    text = sc.post(plan).text
    phases.append(("read back and verify", *best(lambda: judge_plan(plan, text), repeats)))
    with tempfile.TemporaryDirectory() as folder:
        whole = sc.Job.from_dict({**job.to_dict(), "output": {"file": f"{folder}/out.ngc"}}, job.folder, job.part())
        phases.append(("plan, post, verify, write: all", *best(lambda: sc.run(whole), repeats)))
    return phases


# --- the peer ---------------------------------------------------------------------------------------------------


def peer(python: Path, triangles: int, order: str, threads: int, repeats: int) -> dict[str, Any]:
    """OpenCAMLib's figures of one case."""
    words = [triangles, order, PEER_POINTS[triangles], threads, repeats]
    found: dict[str, Any] = answer(python, "opencamlib_worker.py", *map(str, words))
    return found


def largest_difference(triangles: int, found: dict[str, Any]) -> float:
    """How far the two programs' tips are apart, mm: both must have done the same work."""
    part = sc.Part.from_mesh(*wavy(triangles))
    tips = sc.drop_cutter(part, sc.Tool.from_dict({"profile": PROFILES["ball D6"]}), np.array(found["positions"]))
    return float(np.abs(tips - np.array(found["tips"])).max())


# --- the report -------------------------------------------------------------------------------------------------


def rate(row: dict[str, Any], clock: str = "wall") -> float:
    """Points a second, set-up left out."""
    setup = row["setup" if clock == "wall" else "setup_cpu"]
    return float(row["points"] / max(row[clock] - setup, 1e-9))


def figure(value: float) -> str:
    """With three digits and thin groups."""
    digits = max(0, 2 - int(np.floor(np.log10(max(value, 1e-9)))))
    return f"{round(value, digits):,.{digits}f}" if value < 100 else f"{float(f'{value:.3g}'):,.0f}"


HEADS = [
    "triangles", "tool", "order", "threads", "points/s", "per CPU s", "OpenCAMLib points/s", "per CPU s", "ratio",
]  # fmt: skip
"""Of the table of rates."""


@dataclass
class Rates:
    """What the rows of the tables are made of."""

    rows: list[list[str]] = field(default_factory=list)
    setups: list[list[str]] = field(default_factory=list)
    version: str = ""
    """OpenCAMLib's."""
    differences: list[float] = field(default_factory=list)
    """Between the two programs' tips, mm."""

    def add(self, triangles: int, threads: int, repeats: int, python: Path | None) -> None:
        """Measures one size with that many threads."""
        found = ours_in_process(triangles, threads, repeats)
        lows = (min(row[clock] for row in found) for clock in ("index", "index_cpu", "setup", "setup_cpu"))
        self.setups.append([f"{triangles:,}", str(threads), *(f"{1e3 * low:.0f}" for low in lows)])
        for row in found:
            line = [
                f"{triangles:,}",
                row["tool"],
                row["order"],
                str(threads),
                figure(rate(row)),
                figure(rate(row, "cpu")),
            ]
            if python and triangles in PEER_POINTS and row["tool"] == "ball D6":
                other = peer(python, triangles, row["order"], threads, repeats)
                self.version = other["version"]
                self.differences.append(largest_difference(triangles, other))
                line += [figure(rate(other)), figure(rate(other, "cpu")), f"{figure(rate(row) / rate(other))} x"]
            else:
                line += ["", "", ""]
            self.rows.append(line)
            print(" ".join(line), file=sys.stderr)


def measured(large: bool, repeats: int) -> str:
    """The section between the markers."""
    load = os.getloadavg()[0]
    python, reason = peer_python()
    rates = Rates()
    for triangles in [20_000, 200_000, *([2_000_000] if large else [])]:
        for threads in THREADS:
            rates.add(triangles, threads, repeats, python)
    peers = f"OpenCAMLib {rates.version}" if rates.version else f"OpenCAMLib was left out: {reason}"
    parts = [
        f"Machine: {machine()}; load average {load:.1f} when the run began. styluscam {sc.__version__}, "
        f"Python {platform.python_version()}, numpy {np.__version__}{',' if rates.version else '.'} {peers}.",
        f"Best of {repeats}. Wall-clock rates suffer from other work on the machine; CPU time less.",
        "### Drop-cutter",
        f"Wavy surface of 100 x 100 mm; ours {POINTS:,} points a call, OpenCAMLib "
        + " and ".join(f"{n} at {t:,}" for t, n in PEER_POINTS.items())
        + " triangles (`BatchDropCutter`). Set-up is measured by a call with one point and left out on both sides.",
        table(HEADS, rates.rows),
    ]
    if rates.differences:
        parts.append(f"Largest difference between the two programs' ball tips: {max(rates.differences):.1e} mm.")
    phases = [[name, f"{wall:.3f}", f"{cpu:.3f}"] for name, wall, cpu in main_job(repeats)]
    parts += [
        "### Set-up",
        "The index with neighbours is built once for a part, at its first call; facets and boxes are made ready for the tool "
        "at each.",
        table(["triangles", "threads", "index wall ms", "CPU ms", "tool wall ms", "CPU ms"], rates.setups),
        "### The main job",
        "`examples/first-light/job.toml`, Z-levels of 0.5 mm.",
        table(["phase", "wall s", "CPU s"], phases),
    ]
    return "\n\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="2 million triangles too, ours only")
    parser.add_argument("--repeats", type=int, default=3, help="of each measurement; the best counts")
    parser.add_argument("--dry", action="store_true", help="print only")
    parser.add_argument("--ours", type=int, metavar="TRIANGLES", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.ours:
        print(json.dumps(ours(options.ours, options.repeats)))
        return
    section = measured(options.large, options.repeats)
    print(section)
    if not options.dry:
        write("measured", section)


if __name__ == "__main__":
    main()
