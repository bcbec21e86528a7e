"""The report of a million moves over 200,000 triangles: how long it takes to make, how large it is, how soon it is open.

.venv/bin/python bench/report.py     # rewrites the part "report" of docs/performance.md
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from meshes import SIDE, wavy
from numpy.typing import NDArray
from page import machine, table, write

CHECKOUT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(CHECKOUT / "tests"), str(CHECKOUT / "tests" / "oracles")]

from gui.browser import browser  # noqa: E402

import styluscam as sc  # noqa: E402
from styluscam.report import Subject, report_page  # noqa: E402

TRIANGLES, ROWS = 200_000, 1000
STEPOVER = SIDE / (ROWS - 1)
ABOVE = 0.002
"""mm: what rounding to 0.001 mm and the chords between the points need."""

JOB = {
    "schema": 1,
    "part": {"file": "wavy.stl", "units": "mm"},
    "process": {"kind": "milling"},
    "tools": {"ball": {"profile": {"kind": "ball", "diameter": 6.0}}},
    "operations": [
        {"kind": "zig-zag", "tool": "ball", "stepover": STEPOVER, "tolerance": 0.01, "spindle": {"mode": "off"}}
    ],
    "machine": {"name": "linuxcnc"},
}
SEEK = """(() => { const p = window.styluscam.player; const begun = performance.now();
for (let i = 0; i < 1000; i++) p.seek(p.path.duration * i / 1000);
return (performance.now() - begun) / 1000; })()"""


def write_part(path: Path) -> None:
    vertices, triangles = wavy(TRIANGLES)
    record = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    record["corners"] = vertices[triangles]
    path.write_bytes(b"\0" * 80 + np.uint32(len(triangles)).tobytes() + record.tobytes())


def program(job: sc.Job) -> str:
    """Rows over the part, a million points."""
    along = np.round(np.linspace(0.0, SIDE, ROWS), 3)
    x = np.tile(along, (ROWS, 1))
    x[1::2] = x[1::2, ::-1]
    tips = positions(job, np.column_stack([x.reshape(-1), np.repeat(along, ROWS)]))
    start = tips[0]
    lines = ["G21 G90 G17 G94", "G54", "G64 P0.001 Q0", "T1 M6", "G43 H1", "G0 Z16", f"G0 X{start[0]} Y{start[1]}"]
    lines += [f"G1 Z{start[2]:.3f} F600", "F2000", *(f"X{a:.3f} Y{b:.3f} Z{c:.3f}" for a, b, c in tips)]
    return "\n".join([*lines, "G0 Z16", "M2", ""])


def positions(job: sc.Job, xy: NDArray[np.float64]) -> NDArray[np.float64]:
    heights = sc.drop_cutter(job.part(), job.tools()["ball"], xy)
    return np.column_stack([xy, np.ceil(1000.0 * (heights + ABOVE)) / 1000.0])


def main() -> None:
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_part(folder / "wavy.stl")
        job = sc.Job.from_dict(JOB, folder)
        text = program(job)
        begun = time.monotonic()
        report = sc.verify(text, job)
        verified = time.monotonic()
        report.coverage()
        covered = time.monotonic()
        page = report_page(Subject.judged(report, job.machine(), "wavy.ngc"))
        made = time.monotonic()
        (folder / "wavy.html").write_text(page, encoding="utf-8")
        with browser(folder) as tab:
            tab.size(1400, 900)
            opened = tab.open(folder / "wavy.html")
            seek = tab.run(SEEK)
    rows = [
        ["verify", f"{verified - begun:.1f} s"],
        ["coverage", f"{covered - verified:.1f} s"],
        ["page, with what is left at 300,000 points", f"{made - covered:.1f} s"],
        ["size of the page", f"{len(page) / 1e6:.1f} MB"],
        ["open in headless Chromium, drawn without a graphics card", f"{opened:.1f} s"],
        ["to another moment of the path, without drawing", f"{seek:.3f} ms"],
    ]
    size = f"{len(report.program.moves):,} moves, {TRIANGLES:,} triangles"
    about = f"{size}. {machine()}; load average {load:.1f} when the run began."
    write("report", f"{about}\n\n{table(['what', 'takes'], rows)}")


if __name__ == "__main__":
    main()
