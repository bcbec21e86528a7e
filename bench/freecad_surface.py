"""Run by FreeCAD: ours beside its own Surface and Waterline on the cap R60, seconds and error of each path.

freecad_surface.py -- CASE [FOLDER]: the native cases need OpenCAMLib; libraries that it is linked to may be in the folder.
"""

from __future__ import annotations

import ctypes
import os
import sys
import traceback
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import freecad_cap as cap
import numpy as np

RADIUS, CENTRE, BALL, HALF = 60.0, np.array([0.0, 0.0, -30.0]), 3.0, 60.0
"""The sphere, the tool, and half of the plate's side, mm; the plate's top is at Z 0."""

ROWS, LEVELS = 0.6, 30
"""Distance of rows, mm; levels of the cap's 30 mm."""

PITCH = 0.05
"""Distance of the points at which a path's error is taken, mm."""

FLAT = 1e-3
"""A feed move shorter than this in plan, mm, is a plunge or a retract and no pass."""


def error_of(path: Any) -> tuple[float, float, float, int]:
    """Lowest, highest and median distance of a path's passes from the exact offset surface, um; moves.

    The ball's centre is to be 3 mm off the sphere or the plate, whichever is nearer: outside of both offset bodies the
    distance from them is the smaller one of the two, and below 0 inside of either.
    """
    starts, ends = passes(path)
    lengths = np.linalg.norm(ends - starts, axis=1)
    counts = np.maximum(np.ceil(lengths / PITCH).astype(int), 1)
    index = np.repeat(np.arange(len(counts)), counts)
    share = (np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts) + 1) / counts[index]
    points = starts[index] + share[:, None] * (ends - starts)[index]
    points = points[(np.abs(points[:, :2]) <= HALF).all(axis=1)]  # beside the plate there is nothing to touch
    centres = points + np.array([0.0, 0.0, BALL])
    off = np.minimum(np.linalg.norm(centres - CENTRE, axis=1) - RADIUS - BALL, centres[:, 2] - BALL) * 1e3
    return float(off.min()), float(off.max()), float(np.median(np.abs(off))), len(counts)


def passes(path: Any) -> tuple[Any, Any]:
    """Starts and ends of the straight feed moves that are no plunges, (N,3) each."""
    at, starts, ends = [0.0, 0.0, 0.0], [], []
    for command in path.Commands:
        if command.Name not in ("G0", "G1", "G00", "G01"):
            if command.Name in ("G2", "G3", "G02", "G03"):
                raise RuntimeError("arcs in the path: their error is not measured here")
            continue
        words = command.Parameters
        to = [words.get(axis, value) for axis, value in zip("XYZ", at, strict=True)]
        if command.Name in ("G1", "G01") and np.hypot(to[0] - at[0], to[1] - at[1]) > FLAT:
            starts.append(at)
            ends.append(to)
        at = to
    return np.array(starts), np.array(ends)


def zig_zag(job: Any) -> Any:
    return cap.ours(job, "zig-zag", Stepover=ROWS)


def z_level(job: Any) -> Any:
    return cap.ours(job, "z-level", Step=30.0 / LEVELS)


def surface(interval: float) -> Callable[[Any], Any]:
    def made(job: Any) -> Any:
        from Path.Op import Surface

        operation = native(job, Surface)
        operation.CutPattern, operation.StepOver = "Line", 100.0 * ROWS / (2.0 * BALL)
        operation.SampleInterval = interval
        return operation

    return made


def waterline(algorithm: str, interval: float) -> Callable[[Any], Any]:
    def made(job: Any) -> Any:
        from Path.Op import Waterline

        operation = native(job, Waterline)
        operation.Algorithm, operation.LayerMode = algorithm, "Multi-pass"
        operation.SampleInterval = interval
        operation.setExpression("StepDown", None)
        operation.StepDown = 30.0 / LEVELS
        return operation

    return made


def native(job: Any, module: Any) -> Any:
    """An operation of FreeCAD's own on the whole model, down to the plate's top."""
    operation = module.Create("Native", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    operation.setExpression("FinalDepth", None)
    operation.setExpression("StartDepth", None)
    operation.StartDepth, operation.FinalDepth = 30.0, 0.0
    return operation


CASES: dict[str, Callable[[Any], Any]] = {
    "zig-zag": zig_zag,
    "z-level": z_level,
    "Surface, line, 1 mm": surface(1.0),
    "Surface, line, 0.25 mm": surface(0.25),
    "Waterline, OCL Dropcutter, 1 mm": waterline("OCL Dropcutter", 1.0),
    "Waterline, OCL Dropcutter, 0.25 mm": waterline("OCL Dropcutter", 0.25),
    "Waterline, OCL Adaptive, 1 mm": waterline("OCL Adaptive", 1.0),
}


def measured(name: str, folder: str = "") -> dict[str, Any]:
    """Seconds from a new operation to its path, in a fresh document; its error."""
    boost = "libboost_python{}{}.so.*".format(*sys.version_info)
    for library in FilePath(folder).glob(f"usr/lib/*/{boost}") if folder else ():
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    document = cap.new_document("Beside")
    job = cap.job_of(document)
    operation = CASES[name](job)
    watch = cap.Stopwatch()
    watch.timed("all", lambda: cap.recompute(operation))
    low, high, median, moves = error_of(operation.Path)
    return {"seconds": watch.taken()["all"], "low": low, "high": high, "median": median, "moves": moves}


try:
    cap.result(measured(*sys.argv[sys.argv.index("--") + 1 :]))
except BaseException:
    traceback.print_exc(file=sys.stdout)
finally:
    sys.stdout.flush()
    os._exit(0)
