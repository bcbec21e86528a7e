"""Run by FreeCAD: its Adaptive core on plane pockets, at the stepover with which a bound of the engagement holds.

freecad_adaptive.py -- IN OUT: a JSON list of pockets (``adaptive.asked``) and one of answers. The stepover is found by
bisection, once for the largest angle of the path and once for the angle that 99 % of its length stay below, both measured
by ``sc.engagement`` as everybody's. ``contours`` are the outlines offset inwards step by step, arcs kept.
"""

from __future__ import annotations

import json
import os
import sys
import time
import traceback
from pathlib import Path
from typing import Any

import numpy as np

import styluscam as sc

KINDS = {"Cutting": "cut", "LinkClear": "link", "LinkClearAtPrevPass": "link", "LinkNotClear": "rapid"}

STEPOVERS = {"max": (0.2, 0.165, 0.135, 0.11, 0.085, 0.065), "p99": (0.25, 0.225, 0.2, 0.165, 0.135)}
"""Tried in this order, in tool diameters, until the angle holds; smaller ones take minutes."""

HALVINGS = {"max": 3, "p99": 1}
"""Between the stepover that holds and the next larger one that does not."""

SMALLER = 0.01
"""By how much smaller than Adaptive's own radius its operation makes the helix, mm."""

NARROW = 1.0 / 8.0
"""Diameter of the helix, in tool diameters, where Adaptive's own, three quarters, has no room: the least that it takes."""

SECONDS = 300.0
"""After which a path is given up."""


def adaptive(asked: dict[str, Any], stepover: float) -> list[tuple[Any, str]]:
    """The path, as ``sc.engagement`` takes it: points with bulges and kind of each run.

    Raises:
        LookupError: the tool has no room for a helix.
        TimeoutError: it takes too long.
    """
    for helix in (0.0, 2.0 * NARROW * asked["radius"]):
        runs = entered(asked, stepover, helix)
        if runs:
            return runs
    raise LookupError("no entry: not even its smallest helix has room")


def entered(asked: dict[str, Any], stepover: float, helix: float) -> list[tuple[Any, str]]:
    """The path with a diameter of the helix, mm; at 0 Adaptive's own."""
    import area

    core = area.Adaptive2d()
    core.toolDiameter, core.stepOverFactor, core.stockToLeave = 2.0 * asked["radius"], stepover, 0.0
    core.tolerance, core.helixRampDiameter = asked["tolerance"], helix
    core.finishingProfile, core.forceInsideOut = asked["finishing"], asked["inside_out"]
    core.keepToolDownDistRatio = asked["keep_down"]
    core.opType = area.AdaptiveOperationType.ClearingInside
    end = time.perf_counter() + SECONDS
    found = core.Execute(
        *([closed(one) for one in asked[key]] for key in ("stock", "polygons")), lambda _: time.perf_counter() > end
    )
    if time.perf_counter() > end:
        raise TimeoutError(f"more than {SECONDS:g} s at a stepover of {stepover:g}")
    runs: list[tuple[Any, str]] = []
    for region in found:
        runs += runs_of(region, lambda kind: KINDS[str(area.AdaptiveMotionType(kind)).rpartition(".")[2]])
    return runs


def runs_of(region: Any, kind_of: Any) -> list[tuple[Any, str]]:
    """One region: once around the helix, as seen from above, and what follows."""
    centre, at = np.array(region.HelixCenterPoint), np.array(region.StartPoint)
    radius = float(np.hypot(*(at - centre)))
    runs: list[tuple[Any, str]] = []
    if radius > SMALLER:
        at = centre + (at - centre) * (radius - SMALLER) / radius
        runs.append((np.array([[*at, -1.0], [*(2.0 * centre - at), -1.0], [*at, 0.0]]), "entry"))
    for kind, points in region.AdaptivePaths:
        line = np.array([at, *points])
        line = line[np.r_[True, np.hypot(*np.diff(line, axis=0).T) > 1e-7]]
        if len(line) > 1:
            at = line[-1]
            runs.append((np.c_[line, np.zeros(len(line))], kind_of(kind)))
    return runs


def closed(points: list[list[float]]) -> list[list[float]]:
    """An outline that ends where it begins."""
    return [*points, points[0]]


def angles(runs: list[tuple[Any, str]], asked: dict[str, Any]) -> dict[str, float]:
    """The largest angle of cuts and links, and the one that 99 % of their length stay below, deg."""
    found = [run for run in sc.engagement(runs, asked["radius"], None, asked["walls"]) if run.kind in ("cut", "link")]
    degrees = np.concatenate([run.angles_deg for run in found])
    length = np.concatenate([np.diff(run.distances, prepend=0.0) for run in found])
    order = np.argsort(degrees)
    share = np.cumsum(length[order]) / length.sum()
    return {
        "max": float(degrees.max()),
        "p99": float(degrees[order][min(np.searchsorted(share, 0.99), len(order) - 1)]),
    }


class Search:
    """Paths of one pocket by stepover."""

    def __init__(self, asked: dict[str, Any]) -> None:
        self.asked = asked
        self.known: dict[float, tuple[list[tuple[Any, str]], dict[str, float]]] = {}

    def holds(self, stepover: float, key: str) -> bool:
        """Whether the angle stays below the bound."""
        if stepover not in self.known:
            runs = adaptive(self.asked, stepover)
            self.known[stepover] = (runs, angles(runs, self.asked))
        return self.known[stepover][1][key] <= self.asked["bound"]

    def largest(self, key: str) -> float | None:
        """The largest stepover that was found to hold the bound; none where no one does."""
        above = None
        for stepover in STEPOVERS[key]:
            if self.holds(stepover, key):
                break
            above = stepover
        else:
            return None
        for _ in range(HALVINGS[key] if above else 0):
            middle = 0.5 * (stepover + above)
            stepover, above = (middle, above) if self.holds(middle, key) else (stepover, middle)
        return stepover

    def answer(self, key: str) -> dict[str, Any]:
        """The path that was found, or why there is none."""
        try:
            stepover = self.largest(key)
        except Exception as error:
            return {"error": f"{type(error).__name__}: {error}"}
        if stepover is None:
            stepover, (_, found) = min(self.known.items(), key=lambda one: one[1][1][key])
            return {"error": f"not below {found[key]:.1f} deg, at a stepover of {stepover:g}"}
        runs, found = self.known[stepover]
        return {"stepover": stepover, **found, "runs": [(points.tolist(), kind) for points, kind in runs]}


def contours(asked: dict[str, Any]) -> list[list[list[list[float]]]]:
    """The outlines offset inwards by the radius and any number of steps: rings of points, kind and centre, by distance."""
    import area

    levels: list[Any] = []
    while not levels or levels[-1]:
        region = area.Area()
        for outline in asked["polygons"]:
            curve = area.Curve()
            for point in closed(outline):
                curve.append(area.Point(*point))
            region.append(curve)
        region.Reorder()
        region.Offset(asked["radius"] + len(levels) * asked["step"])
        levels.append(
            [[[v.p.x, v.p.y, v.type, v.c.x, v.c.y] for v in curve.getVertices()] for curve in region.getCurves()]
        )
    return levels[:-1]


def main(source: str, target: str) -> None:
    """Answers all that is asked."""
    answers = []
    for asked in json.loads(Path(source).read_text(encoding="utf-8")):
        asked["walls"] = [np.array(one) for one in asked["walls"]]
        search = Search(asked)
        answers.append({key: search.answer(key) for key in ("max", "p99")} | {"contours": contours(asked)})
        answers[-1]["tried"] = sorted(
            (stepover, found["max"], found["p99"]) for stepover, (_, found) in search.known.items()
        )
        print(asked["name"], answers[-1]["tried"], flush=True)
    Path(target).write_text(json.dumps(answers), encoding="utf-8")
    print("RESULT", json.dumps(len(answers)))


try:
    main(*sys.argv[sys.argv.index("--") + 1 :])
except BaseException:
    traceback.print_exc(file=sys.stdout)
finally:
    sys.stdout.flush()
    os._exit(0)
