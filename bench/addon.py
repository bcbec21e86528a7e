"""The FreeCAD addon: what it costs beside the engine, and its operations beside FreeCAD's own on the cap R60.

.venv/bin/python bench/addon.py            # rewrites the parts "addon" and "beside" of docs/performance.md
.venv/bin/python bench/addon.py cost       # only "addon"
.venv/bin/python bench/addon.py beside     # only "beside": some minutes
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import freecad_host
import opencamlib_debian
from page import machine, table, write

STEPOVER = 0.15
"""Distance of the rows (mm) that make more than 100,000 moves on the cap."""

PARTS = {
    "build": ("path", "assignment"),
    "read": ("checks", "text of the path", "program"),
}
"""What is counted as building a path, and as reading one for a post."""

OURS = ("zig-zag", "z-level")

NATIVE = (
    "Surface, line, 1 mm",
    "Surface, line, 0.25 mm",
    "Waterline, OCL Dropcutter, 1 mm",
    "Waterline, OCL Dropcutter, 0.25 mm",
)

LIMIT = 900.0
"""Seconds after which a case is given up."""


def cost_rows(version: str) -> list[list[str]]:
    seen = freecad_host.run(version, "freecad_addon.py", "--", str(STEPOVER))
    if not seen["same"]:
        raise SystemExit(f"FreeCAD {version} does not write the path that it reads")
    count = seen["commands"]
    again = seen["again"] | seen["tried"]

    def each(title: str, source: dict[str, list[float]], names: tuple[str, ...]) -> list[str]:
        wall, processor = (sum(source[name][clock] for name in names) for clock in (0, 1))
        per = [f"{1e6 * seconds / count:.2f}" for seconds in (wall, processor)]
        return [version, title, f"{wall:.3f}", f"{processor:.3f}", *per]

    return [
        each("build: text, FreeCAD's reading of it, into the document", again, PARTS["build"]),
        each("the same moves as one command each, made by Python", again, ("as commands", "assignment")),
        each("read for a post: checks, FreeCAD's text, the engine's program", seen["read"], PARTS["read"]),
        each("post", seen["read"], ("posting",)),
        each("apart: planning", again, ("planning",)),
        each("apart: verification", seen["read"], ("verification",)),
        [version, "apart: tessellation, the first time", *(f"{s:.3f}" for s in seen["first"]["tessellation"]), "", ""],
        [version, "apart: tessellation, known shape", *(f"{s:.6f}" for s in again["tessellation"]), "", ""],
        [version, f"{count:,} commands", "", "", "", ""],
    ]


def write_cost() -> None:
    rows = [row for version in freecad_host.VERSIONS for row in cost_rows(version)]
    heads = ["FreeCAD", "what", "s", "CPU s", "us a command", "CPU us a command"]
    text = f"Cap R60, ball D6, rows {STEPOVER} mm apart, the least of three; milling with the whole model.\n\n"
    write("addon", f"{header()}\n\n{text}{table(heads, rows)}")


def beside_rows(version: str) -> list[list[str]]:
    packages, reason = opencamlib_debian.unpacked(version)
    rows = []
    for case in (*OURS, *NATIVE):
        title = f"StylusCAM {case}" if case in OURS else f"FreeCAD {case}"
        if case in NATIVE and packages is None:
            rows.append([version, title, "not measured", "", "", "", "", ""])
            continue
        rows.append([version, title, *figures(version, case, packages)])
        print(" | ".join(rows[-1]), flush=True)
    if packages is None:
        print(f"FreeCAD {version}: {reason}")
    return rows


def figures(version: str, case: str, packages: Path | None) -> list[str]:
    """Seconds, CPU seconds, moves, lowest, highest and median error."""
    words = [case, str(packages)] if packages else [case]
    python_path = [packages, packages / opencamlib_debian.SITE] if packages else []
    try:
        seen: dict[str, Any] = freecad_host.run(
            version, "freecad_surface.py", "--", *words, python_path=python_path, timeout=LIMIT
        )
    except subprocess.TimeoutExpired:
        return [f"> {LIMIT:.0f}", "", "", "", "", ""]
    wall, processor = seen["seconds"]
    errors = [f"{seen[name]:+.1f}" for name in ("low", "high", "median")]
    return [f"{wall:.2f}", f"{processor:.2f}", f"{seen['moves']:,}", *errors]


def write_beside() -> None:
    rows = [row for version in freecad_host.VERSIONS for row in beside_rows(version)]
    heads = ["FreeCAD", "operation", "s", "CPU s", "passes' moves", "lowest, um", "highest, um", "median size, um"]
    text = (
        "Cap R60 on a plate of 120 x 120 mm, the whole model; FreeCAD's own ball end mill D6; rows 0.6 mm apart, 30 levels. "
        "From an operation that was made to its path in the document, nothing tessellated before. Error: distance from the "
        "exact offset surface (a sphere of R63 and a plane 3 mm up), every 0.05 mm along the passes; below 0 is a gouge. "
        "Lengths are FreeCAD's sample interval; its other settings are as it makes them."
    )
    write("beside", f"{header()}\n\n{text}\n\n{table(heads, rows)}")


def header() -> str:
    return f"Machine: {machine()}; load average {os.getloadavg()[0]:.1f} when the run ended."


def main() -> None:
    wanted = sys.argv[1:] or ["cost", "beside"]
    if "cost" in wanted:
        write_cost()
    if "beside" in wanted:
        write_beside()


if __name__ == "__main__":
    main()
