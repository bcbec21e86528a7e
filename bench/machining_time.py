"""Machining time beside FreeCAD's own operations: ten parts of the corpus, roughing and finishing.

Run: ``python bench/machining_time.py [--keep FOLDER] [NAME ...]``; without names ``docs/performance.md`` is written again.
Parts are the first ten by name of the STEP solids of ``fixtures/corpus/slice`` that milling does whole, on which FreeCAD's
operations give a path. Both programs cut the same box with the same tools, feeds, rapids and heights.

Roughing: FreeCAD's Adaptive, model aware, as FreeCAD makes it, one operation for each of the levels of ours, so that both
clear the same layers; ours is ``pocket`` with ``clears = "stock"`` and, as its bound, the largest angle of Adaptive's cuts,
but no more than a right angle. Beside it: in one direction, with feeds that rise, and with the angle that 99 % of the length
of Adaptive's cuts stay below. Finishing: of each program the fastest operation with which 99 % of what the ball can touch, and
does not stand upright, is left with 1.1 times the scallop asked for, or less. Of FreeCAD 3D Surface and Waterline are tried,
with smaller steps until they hold.

The verifier measures the engagement, gouges and what is left of both, from G-code in one frame, and ``Program.times`` the time.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import freecad_host as host
import numpy as np
import opencamlib_debian
from constant_scallop import Ground
from page import machine, table, write

import styluscam as sc
from styluscam.errors import StylusError

SLICE = Path(__file__).resolve().parents[1] / "fixtures" / "corpus" / "slice"

FREECAD = "1.1"
"""The first with an Adaptive that knows the model."""

FEED, PLUNGE, RAPID, SPEED = 1500.0, 300.0, 6000.0, 10_000.0
"""Feeds and rapids, mm/min; spindle, rev/min."""

SIDES, TOP, CLEARANCE, RETRACT = 2.0, 1.0, 5.0, 1.0
"""By how much the box is larger than the part; heights of clearance and retract over it, mm."""

DIAMETERS = (12.0, 10.0, 8.0, 6.0, 4.0, 3.0, 2.0)
"""Of the tools: the first that is no more than so much of the part's smaller side in plan, or the last."""
SHARE = 0.15

LEFT = 0.3
"""Stock that roughing leaves, mm."""

SLICED = 0.001
"""FreeCAD slices the part so far above a level floor, mm: on it, it may take the floor for a wall."""

SCALLOP, WITHIN = 0.02, 1.1
"""Asked for, mm; how many times it 99 % of the points may have."""

TOLERANCE = 0.005
"""Of finishing, mm."""

DEVIATION = 0.001
"""Of the triangles that ours reads, mm."""

LOWEST, HIGHEST = 10.0, 90.0
"""Of the bound, deg: past a right angle nothing is proven."""

INTERVAL = 0.25
"""FreeCAD's sample interval in finishing, mm: with its own, 1 mm, gouges are many times as deep."""

STEPS = (1.0, 0.3)
"""The largest and the smallest step of FreeCAD's finishing, in widths at which the ball leaves the scallop on a plane."""
HALVINGS = 4
"""Of the range between one that holds and one that does not."""

SECONDS = 300.0
"""After which a computation is given up."""

COUNT = 10
"""Parts."""

WORKERS = 2
"""Parts at a time."""

POINTS = 20_000
"""On a part, at which it is measured what finishing leaves."""

RAPIDS = 0
"""What the engine's arrays call a rapid."""

MACHINE = sc.Machine.from_dict(
    {
        "extends": "linuxcnc",
        "name": "bench",
        "limits": {"rapid_rate": RAPID, "acceleration": 500.0, "corner_tolerance": 0.01},
    }
)


class NoPathError(Exception):
    """An operation of FreeCAD's gives none: the part is left out."""


class FailureError(Exception):
    """An operation of ours gives none: it is not better."""


@dataclass(frozen=True)
class Part:
    """A part of the corpus and its tools."""

    name: str

    @property
    def file(self) -> Path:
        return SLICE / f"{self.name}.step"

    @cached_property
    def box(self) -> Any:
        """Lowest and highest corner, mm."""
        vertices = np.asarray(sc.Part.read(self.file, tolerance=0.01).arrays.vertices)
        return np.array([vertices.min(axis=0), vertices.max(axis=0)])

    @property
    def diameter(self) -> float:
        most = SHARE * float((self.box[1] - self.box[0])[:2].min())
        return next((one for one in DIAMETERS if one <= most), DIAMETERS[-1])

    @property
    def top(self) -> float:
        return float(self.box[1, 2]) + TOP

    @cached_property
    def ground(self) -> Ground:
        return Ground.of(f"corpus/slice/{self.name}", 0.5 * self.diameter, DEVIATION, POINTS)

    def job(self, shape: str, operation: dict[str, Any]) -> sc.Job:
        """A job of one operation."""
        common = {
            "tool": "a",
            "feeds": {"cut": FEED, "plunge": PLUNGE},
            "spindle": {"mode": "fixed", "rpm": SPEED},
            "fit": "arcs",
        }
        stock = {"kind": "box", "sides": SIDES, "top": TOP}
        return sc.Job.from_dict(
            {
                "schema": 1,
                "part": {"file": str(self.file), "faces": "all", "tolerance": DEVIATION},
                "process": {"kind": "milling", "max_unreached": 1.0},  # what the tool is too wide for, both leave
                "setup": {"zero": "model", "clearance": CLEARANCE, "retract": RETRACT, "stock": stock},
                "tools": {"a": {"number": 1, "profile": {"kind": shape, "diameter": self.diameter}}},
                "operations": [common | operation],
                "machine": {"name": "linuxcnc"},
            }
        )

    def native(self, shape: str, operation: str, cases: list[list[dict[str, Any]]]) -> Iterator[str]:
        """G-code of FreeCAD's moves, for each of the cases that it finishes in time."""
        packages, reason = opencamlib_debian.unpacked(FREECAD)
        if packages is None:
            raise SystemExit(reason)
        heights = {"ClearanceHeight": self.top + CLEARANCE, "SafeHeight": self.top + RETRACT}
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            asked = {
                "part": str(self.file),
                "sides": SIDES,
                "top": TOP,
                "shape": shape,
                "diameter": self.diameter,
                "feed": FEED,
                "plunge": PLUNGE,
                "rapid": RAPID,
                "spindle": SPEED,
                "operation": operation,
                "cases": [[heights | one for one in case] for case in cases],
                "output": name,
            }
            (folder / "in.json").write_text(json.dumps(asked), encoding="utf-8")
            path = [packages, packages / opencamlib_debian.SITE]
            words = [str(folder / "in.json"), str(packages)]
            try:
                errors = host.run(
                    FREECAD,
                    "freecad_machining.py",
                    "--",
                    *words,
                    python_path=path,
                    writable=[folder],
                    timeout=SECONDS + 20.0,
                )
                for number, message in errors.items():
                    print(f"  {self.name}: {operation} {number}: {message}", file=sys.stderr)
            except subprocess.TimeoutExpired:
                print(f"  {self.name}: {operation} takes more than {SECONDS:g} s", file=sys.stderr)
            except SystemExit as error:  # FreeCAD ended without an answer
                print(f"  {self.name}: {operation}: {str(error)[-300:]}", file=sys.stderr)
            for number in range(len(cases)):
                file = folder / f"{number}.ngc"
                text = file.read_text(encoding="utf-8") if file.exists() else ""
                yield text if "X" in text else ""  # Waterline may give heights alone


@dataclass(frozen=True)
class Program:
    """A program, measured. Lengths mm, times s."""

    what: str
    text: str
    job: sc.Job

    @cached_property
    def report(self) -> sc.Report:
        return sc.verify(self.text, self.job, MACHINE)

    @cached_property
    def errors(self) -> Counter[str]:
        """Findings of the verifier that refuse the program, by kind."""
        return Counter(one["kind"] for one in self.report.to_dict()["findings"] if one["severity"] == "error")

    @cached_property
    def path(self) -> sc.Program:
        return sc.read_gcode(self.text, MACHINE)

    @cached_property
    def times(self) -> Any:
        """Of each move."""
        return np.diff(self.path.times(MACHINE), prepend=0.0)

    @property
    def seconds(self) -> float:
        return float(self.times.sum())

    @cached_property
    def angles(self) -> tuple[float, float]:
        """The angle that 99 % of the length of cuts and links stay below, and the largest one, deg."""
        (found,) = self.report.engagement
        degrees, length = found.bounded_deg, np.diff(found.distances, prepend=0.0)
        cut = np.isfinite(degrees) & (degrees > 0.0)
        degrees, length = degrees[cut], length[cut]
        order = np.argsort(degrees)
        share = np.cumsum(length[order]) / length.sum()
        return float(degrees[order][min(np.searchsorted(share, 0.99), len(order) - 1)]), float(degrees.max())

    def left(self, ground: Ground) -> float:
        """What 99 % of the points are left with, mm."""
        stands = self.report.left(ground.points[ground.touched])
        return float(np.percentile(stands, 99.0, method="higher"))

    def shares(self) -> str:
        """Where the time goes."""
        moves = self.path.moves
        steps = np.abs(np.diff(moves["end"], axis=0, prepend=moves["end"][:1]))
        rapid, steep = moves["kind"] == RAPIDS, steps[:, 2] > np.hypot(steps[:, 0], steps[:, 1])
        seconds = [float(self.times[which].sum()) for which in (rapid, ~rapid & steep)]
        line = f"{self.what}: {self.seconds:.0f} s, rapids {seconds[0]:.0f}, steep feeds {seconds[1]:.0f}, {len(moves)} moves"
        feeds = float(np.hypot(steps[~rapid, 0], steps[~rapid, 1]).sum())
        line += f", feeds {feeds:.0f} mm in plan"
        if "report" in self.__dict__:
            for found in self.report.engagement:
                length = dict.fromkeys(("cut", "link", "entry"), 0.0)
                for kind, begin, end in zip(found.moves.kinds, found.moves.starts, found.moves.ends, strict=True):
                    length[str(kind)] += end - begin
                same, angles = np.diff(found.of_move) == 0, found.angles_deg
                air = np.diff(found.distances)[same & (np.maximum(angles[1:], angles[:-1]) <= 0.0)].sum()
                line += "".join(f", {kind} {value:.0f}" for kind, value in (length | {"air": air}).items())
            line += f"; {dict(self.errors)}"
        return line


def framed(ours: str, moves: str) -> str:
    """FreeCAD's moves between what ours begins and ends with."""
    lines = ours.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("(operation"))
    last = max(i for i, line in enumerate(lines) if line[:1] in set("GXYZ"))
    return "\n".join([*lines[: first + 1], *moves.splitlines(), *lines[last + 1 :], ""])


def posted(part: Part, shape: str, operation: dict[str, Any]) -> Program:
    """Ours."""
    job, what = part.job(shape, operation), operation["kind"]
    if what == "zig-zag" and "scallop" not in operation:
        what = "even zig-zag"
    if "z_bottom" in operation and what == "constant-scallop":
        what += " beyond the edges"
    try:
        return Program(what, sc.post(sc.plan(job), MACHINE).text, job)
    except StylusError as error:
        raise FailureError(f"{what}: {error}") from None


def roughing(part: Part, bound: float, **more: Any) -> Program:
    """Ours."""
    height = float(part.box[1, 2] - part.box[0, 2])
    step = height / math.ceil(height / part.diameter)
    common = {"radial_stock_to_leave": LEFT, "axial_stock_to_leave": LEFT, "tolerance": 0.05, "entry_angle_deg": 5.0}
    operation = {"kind": "pocket", "clears": "stock", "engagement_deg": bound, "step": {"height": round(step, 4)}}
    operation["link_feed"] = RAPID
    return posted(part, "flat", common | operation | {"z_bottom": round(float(part.box[0, 2]), 4)} | more)


def levels(program: Program) -> list[float]:
    """The heights of its layers, from the top down: where it feeds along more than a millimetre."""
    moves = program.path.moves
    steps = np.abs(np.diff(moves["end"], axis=0, prepend=moves["end"][:1]))
    flat = (moves["kind"] != RAPIDS) & (steps[:, 2] < 1e-6)
    heights, which = np.unique(moves["end"][flat, 2].round(4), return_inverse=True)
    length = np.bincount(which, np.hypot(steps[flat, 0], steps[flat, 1]))
    return heights[length > 1.0][::-1].tolist()


def adaptive(part: Part, ours: Program) -> Program:
    """FreeCAD's Adaptive at the levels of ours.

    Raises:
        NoPathError: it has none.
    """
    floors = levels(ours)
    settings = [
        {
            "StartDepth": above,
            "FinalDepth": floor,
            "StepDown": above - floor + SLICED,
            "ModelAwareExperiment": True,
            "StockToLeave": LEFT,
            "ZStockToLeave": LEFT - SLICED,
        }
        for above, floor in zip([part.top, *floors[:-1]], floors, strict=True)
    ]
    (moves,) = part.native("endmill", "Adaptive", [settings])
    if not moves:
        raise NoPathError("Adaptive gives no path")
    return Program("Adaptive", framed(ours.text, moves), ours.job)


def finishing(part: Part) -> list[Program]:
    """Ours that give a path."""
    chord = 2.0 * math.sqrt(part.diameter * SCALLOP - SCALLOP * SCALLOP)
    common = {"tolerance": TOLERANCE, "links": "low"}
    beyond = round(float(part.box[0, 2]) - 0.5 * part.diameter, 4)
    found = []
    for operation in (
        {"kind": "constant-scallop", "scallop": SCALLOP},
        {"kind": "constant-scallop", "scallop": SCALLOP, "z_bottom": beyond},
        {"kind": "zig-zag", "stepover": round(chord, 4), "scallop": SCALLOP},
        {"kind": "zig-zag", "stepover": round(chord, 4)},
        {"kind": "z-level", "step": {"scallop": SCALLOP}},
    ):
        try:
            found.append(posted(part, "ball", common | operation))
        except FailureError as error:
            print(f"  {part.name}: {error}", file=sys.stderr)
    return found


def variants(part: Part) -> dict[str, tuple[str, Any]]:
    """FreeCAD's operations and their settings by step, mm."""
    low, high, radius = *(float(z) for z in part.box[:, 2]), 0.5 * part.diameter

    def surface(beyond: float, depth: float) -> Any:
        return lambda step: {
            "StartDepth": high,
            "FinalDepth": depth,
            "CutPattern": "ZigZag",
            "StepOver": 100.0 * step / part.diameter,
            "BoundaryAdjustment": beyond,
            "SampleInterval": INTERVAL,
            "OptimizeStepOverTransitions": True,
        }

    def waterline(step: float) -> dict[str, Any]:
        depths = {"StartDepth": high, "FinalDepth": low, "StepDown": step}
        return depths | {"LayerMode": "Multi-pass", "SampleInterval": INTERVAL}

    return {
        "Surface to the edges": ("Surface", surface(radius, low)),
        "Surface beyond the edges": ("Surface", surface(2.0 * radius, low - radius)),
        "Waterline": ("Waterline", waterline),
    }


def stepped(part: Part, title: str, frame: Program) -> Program | None:
    """FreeCAD's operation with the largest step that holds, or else with the smallest one; none without a path."""
    operation, settings = variants(part)[title]
    chord = 2.0 * math.sqrt(part.diameter * SCALLOP - SCALLOP * SCALLOP)

    def tried(steps: list[float]) -> dict[float, Program]:
        texts = part.native("ballend", operation, [[settings(step * chord)] for step in steps])
        return {
            step: Program(f"{title} {step * chord:.3f} mm", framed(frame.text, text), frame.job)
            for step, text in zip(steps, texts, strict=True)
            if text
        }

    def holds(one: Program | None) -> bool:
        return one is not None and one.left(part.ground) <= WITHIN * SCALLOP

    above, best = STEPS
    known = tried([above, best])
    if holds(known.get(above)) or not holds(known.get(best)):
        return known.get(above if holds(known.get(above)) else best)
    for _ in range(HALVINGS):
        middle = math.sqrt(best * above)
        known |= tried([middle])
        best, above = (middle, above) if holds(known.get(middle)) else (best, middle)
    return known[best]


def fastest(part: Part, programs: list[Program], sound: bool) -> Program:
    """The fastest of those that hold the scallop, or the one that leaves least; of ours only those that the verifier accepts."""
    programs = [one for one in programs if not (sound and one.errors)]
    if not programs:
        raise FailureError("no finishing of ours that the verifier accepts")
    left = {one.what: one.left(part.ground) for one in programs}
    holding = [one for one in programs if left[one.what] <= WITHIN * SCALLOP]
    return min(holding, key=lambda one: one.seconds) if holding else min(programs, key=lambda one: left[one.what])


@dataclass(frozen=True)
class Compared:
    """A part's programs."""

    part: Part
    rough: tuple[Program, Program]
    others: tuple[Program, ...]
    """Ours: with the angle of 99 % of Adaptive's length as its bound; climb milling only; with feeds that rise."""
    finish: tuple[Program, Program]

    @property
    def seconds(self) -> tuple[float, float]:
        ours, native = (rough.seconds + finish.seconds for rough, finish in zip(self.rough, self.finish, strict=True))
        return ours, native

    @property
    def better(self) -> bool:
        """Ours takes less, and the verifier accepts all of it."""
        ours, native = self.seconds
        return ours < native and not self.rough[0].errors and not self.finish[0].errors

    def row(self) -> list[str]:
        ours, native = self.seconds
        (rough, adaptive), (finish, other) = self.rough, self.finish
        of_both = [" / ".join(f"{one.angles[i]:.0f}" for one in (rough, adaptive)) for i in (0, 1)]
        left = " / ".join(f"{1000.0 * one.left(self.part.ground):.0f}" for one in (finish, other))
        gouges = " / ".join(
            f"{1000.0 * max(a.report.gouge_max, b.report.gouge_max):.0f}" for a, b in zip(*self.pairs, strict=True)
        )
        uncleared = " / ".join(str(one.errors["uncleared"]) for one in (rough, adaptive))
        return [
            self.part.name,
            f"{self.part.diameter:g}",
            f"{ours / 60.0:.1f}",
            f"{native / 60.0:.1f}",
            f"{ours / native:.2f}" + ("" if self.better else " (no)"),
            f"{rough.seconds / 60.0:.1f} / {adaptive.seconds / 60.0:.1f}",
            " / ".join(f"{one.seconds / 60.0:.1f}" for one in self.others),
            f"{finish.seconds / 60.0:.1f} / {other.seconds / 60.0:.1f}",
            *of_both,
            left,
            gouges,
            uncleared,
            f"{finish.what} / {other.what}",
        ]

    @property
    def pairs(self) -> tuple[tuple[Program, Program], tuple[Program, Program]]:
        return self.rough, self.finish


HEADS = (
    "part",
    "tools D",
    "ours min",
    "FreeCAD min",
    "ratio",
    "roughing",
    "ours at the 99 % angle / climb / `max_feed`",
    "finishing",
    "engagement 99 % deg",
    "largest",
    "left 99 % um",
    "gouge um",
    "uncleared",
    "finishing by",
)


def compared(part: Part) -> Compared:
    """Both programs on a part.

    Raises:
        NoPathError, FailureError: one of them has none.
    """
    native = adaptive(part, roughing(part, 60.0))
    within, largest = (round(min(max(angle, LOWEST), HIGHEST), 1) for angle in native.angles)
    ours = roughing(part, largest)
    others = (
        roughing(part, within),
        roughing(part, largest, direction="climb"),
        roughing(part, largest, max_feed=RAPID),
    )
    mine = finishing(part)
    if not mine:
        raise FailureError("no finishing of ours")
    theirs = [one for one in (stepped(part, title, mine[0]) for title in variants(part)) if one]
    if not theirs:
        raise NoPathError("neither Surface nor Waterline gives a path")
    chosen = fastest(part, mine, sound=True), fastest(part, theirs, sound=False)
    return Compared(part, (ours, native), others, chosen)


def candidates() -> list[str]:
    """Names in order."""
    parts = json.loads((SLICE / "parts.json").read_text(encoding="utf-8"))
    return sorted(
        one["name"] for one in parts if one["format"] == "step" and one["body"] == "solid" and one["expect"] == ["done"]
    )


def figures(name: str, keep: Path | None) -> tuple[list[str], list[str], bool]:
    """The line of the table, none of a part that is left out; notes on it; whether ours is better."""
    begun = time.perf_counter()
    try:
        found = compared(Part(name))
        row = found.row()
    except NoPathError as error:
        return [], [f"left out: {error}"], False
    except FailureError as error:
        return [name, *[""] * 3, f"(no) {error}", *[""] * (len(HEADS) - 5)], [], False
    programs = (*found.rough, *found.others, *found.finish)
    for number, one in enumerate(programs if keep else ()):
        (keep / f"{name}-{number}.ngc").write_text(one.text, encoding="utf-8")
    return row, [f"{time.perf_counter() - begun:.0f} s", *(one.shares() for one in programs)], found.better


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--keep", type=Path, help="folder for the programs")
    options = parser.parse_args()
    if options.keep is not None:
        options.keep.mkdir(parents=True, exist_ok=True)
    rows: list[list[str]] = []
    better = 0
    opencamlib_debian.unpacked(FREECAD)  # once, before all ask for it
    with ProcessPoolExecutor(WORKERS) as pool:
        asked = [(name, options.keep) for name in options.names or candidates()]
        for name, (row, notes, won) in zip(
            (one[0] for one in asked), pool.map(figures, *zip(*asked, strict=True)), strict=True
        ):
            print("\n  ".join([" | ".join(row) or name, *notes]), flush=True)
            if row:
                rows.append(row)
                better += won
            if len(rows) == COUNT:
                pool.shutdown(wait=False, cancel_futures=True)
                break
    verdict = f"Less time on {better} of {len(rows)}."
    print(verdict)
    if not options.names:
        write("machining", f"Machine: {machine()}. {verdict}\n\n{table(HEADS, rows)}")


if __name__ == "__main__":
    main()
