"""Pockets of the corpus: ours beside FreeCAD's Adaptive at the same largest angle, and beside passes parallel to the walls.

Run: ``python bench/adaptive.py [--bound 60] [--freecad 1.1] [--tolerance 0.05] [NAME ...]``. All three are measured by
``sc.engagement`` and timed by ``Program.times`` on one machine: 500 mm/s^2, corners within 0.01 mm, one feed where a path cuts,
one on links, one lift.
The helices into the material are left out. Adaptive's stepover is found by bisection (``bench/freecad_adaptive.py``).
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import freecad_host as host
import numpy as np

import styluscam as sc

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from fixtures.pockets import POCKETS, RADIUS, Pocket

FEED, LINK, LIFT = 1500.0, 3000.0, 5.0
"""Cutting, links and rapids, mm/min; how far the tool is lifted where it goes over the stock, mm."""

MACHINE = sc.Machine.from_dict(
    {
        "extends": "linuxcnc",
        "name": "bench",
        "limits": {"rapid_rate": LINK, "acceleration": 500.0, "corner_tolerance": 0.01},
    }
)

ABOVE_DEG = 0.5
"""What the bound may be exceeded by."""

SAG = 0.001
"""How far polygons may be from arcs, mm, for Adaptive and for offsets."""

BEYOND = 2.5
"""How far a pocket is drawn beyond its open edges for planners that know none, in tool radii."""

Runs = Sequence[tuple[Any, str]]


@dataclass(frozen=True)
class Measured:
    """A path: time, s; lengths, mm; the largest angle, deg; what is exempt, mm."""

    seconds: float
    cut: float
    other: float
    most: float
    above: float
    entry: float

    @property
    def length(self) -> float:
        """All moves but the entries, mm."""
        return self.cut + self.other


def measured(runs: Runs, walls: Sequence[Any], bound: float) -> Measured:
    """What is measured of everybody's path."""
    engagement = sc.engagement(runs, RADIUS, None, walls)
    length = dict.fromkeys(("cut", "link", "rapid", "entry"), 0.0)
    most = above = 0.0
    for run in engagement:
        if run.distances.size:
            length[run.kind] += float(run.distances[-1])
        if run.kind in ("cut", "link"):
            most = max(most, run.max_deg)
            above += float(np.diff(run.distances, prepend=0.0)[run.angles_deg > bound + ABOVE_DEG].sum())
    rapid = sum(float(np.hypot(*(p[-1, :2] - p[0, :2]))) for p, kind in _arrays(runs) if kind == "rapid")
    return Measured(seconds(runs), length["cut"], length["link"] + rapid, most, above, length["entry"])


def seconds(runs: Runs) -> float:
    """The time on the machine, without the entries."""
    return float(sc.read_gcode(text(runs), MACHINE).times(MACHINE)[-1])


def text(runs: Runs) -> str:
    """The path as G-code."""
    lines = ["G21 G90 G17 G94 G54", "T1 M6", "S10000 M3"]
    at = None
    for points, kind in _arrays(runs):
        if kind == "entry":
            continue
        if at is None or np.hypot(*(points[0, :2] - at)) > 1e-6 or kind == "rapid":
            lines += over(points[-1 if kind == "rapid" else 0], at is None)
        if kind != "rapid":
            lines += [f"{move} F{FEED if kind == 'cut' else LINK:g}" for move in moves(points)]
        at = points[-1, :2]
    return "\n".join([*lines, "M2", ""])


def over(to: Any, first: bool) -> list[str]:
    """Up, over the stock and down; in the beginning the tool is there."""
    across = [f"G0 Z{LIFT:g}", f"G0 X{to[0]:.6f} Y{to[1]:.6f}", "G0 Z0"]
    return [f"G0 X{to[0]:.6f} Y{to[1]:.6f} Z0"] if first else across


def moves(points: Any) -> list[str]:
    """Lines and arcs."""
    found = []
    for (x, y, bulge), (u, v, _) in itertools.pairwise(points):
        if math.hypot(u - x, v - y) < 1e-6:
            continue
        word, centre = "G1", ""
        if abs(bulge) > 1e-9:
            # from the chord's middle to the centre: to the left of the chord, for an arc to the left of less than a half
            away = (1.0 - bulge * bulge) / (4.0 * bulge)
            i, j = 0.5 * (u - x) - away * (v - y), 0.5 * (v - y) + away * (u - x)
            word, centre = ("G3" if bulge > 0.0 else "G2"), f" I{i:.6f} J{j:.6f}"
        found.append(f"{word} X{u:.6f} Y{v:.6f}{centre}")
    return found


def _arrays(runs: Runs) -> list[tuple[Any, str]]:
    return [(np.asarray(points, float), kind) for points, kind in runs]


# What other planners are asked


def polygon(outline: Sequence[Sequence[float]]) -> list[list[float]]:
    """Arcs as chords."""
    points: list[list[float]] = []
    for i, (x, y, *rest) in enumerate(outline):
        u, v = outline[(i + 1) % len(outline)][:2]
        points.append([x, y])
        bulge = rest[0] if rest else 0.0
        if abs(bulge) < 1e-9:
            continue
        angle = 4.0 * math.atan(bulge)
        radius = 0.5 * math.hypot(u - x, v - y) / abs(math.sin(0.5 * angle))
        count = math.ceil(abs(angle) / (2.0 * math.acos(1.0 - SAG / radius)))
        away = (1.0 - bulge * bulge) / (4.0 * bulge)
        centre = complex(0.5 * (x + u) - away * (v - y), 0.5 * (y + v) + away * (u - x))
        turn = complex(math.cos(angle / count), math.sin(angle / count))
        spot = complex(x, y) - centre
        for _ in range(count - 1):
            spot *= turn
            points.append([(centre + spot).real, (centre + spot).imag])
    return points


def moved_out(pocket: Pocket, edges: Sequence[int], by: float) -> list[list[float]]:
    """The boundary of a box with some edges moved outwards."""
    points = np.array(pocket.boundary, float)[:, :2]
    for edge in edges:
        one, other = edge, (edge + 1) % len(points)
        along = (points[other] - points[one]) / np.hypot(*(points[other] - points[one]))
        points[[one, other]] += by * np.array([along[1], -along[0]])
    return points.tolist()


def asked(name: str, bound: float, options: argparse.Namespace) -> dict[str, Any]:
    """What FreeCAD gets of a pocket."""
    pocket = POCKETS[name]
    outer = polygon(pocket.boundary)
    low, high = np.min(outer, axis=0) - 10.0, np.max(outer, axis=0) + 10.0
    stock = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]
    if pocket.open_edges:
        closed_edges = [i for i in range(len(outer)) if i not in pocket.open_edges]
        stock = moved_out(pocket, closed_edges, 10.0)
        outer = moved_out(pocket, pocket.open_edges, BEYOND * RADIUS)
    return {
        "name": name,
        "radius": RADIUS,
        "bound": bound,
        "step": RADIUS * (1.0 - math.cos(math.radians(bound))),
        "stock": [stock],
        "polygons": [outer, *(polygon(one) for one in pocket.islands)],
        "walls": [pocket.boundary, *pocket.islands],
        "tolerance": options.tolerance,
        "finishing": options.finishing,
        "inside_out": False,
        "keep_down": 3.0,
    }


def answers(names: Sequence[str], bound: float, options: argparse.Namespace) -> list[dict[str, Any]]:
    """What FreeCAD makes of the pockets."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.json", Path(folder) / "out.json"
        source.write_text(json.dumps([asked(name, bound, options) for name in names]), encoding="utf-8")
        host.run(
            options.freecad,
            "freecad_adaptive.py",
            "--",
            str(source),
            str(target),
            writable=[Path(folder)],
            timeout=36000.0,
        )
        return json.loads(target.read_text(encoding="utf-8"))


def contour_runs(levels: Sequence[Sequence[Sequence[Sequence[float]]]]) -> Runs:
    """Passes parallel to the walls, inside out: each begins at its corner nearest to the end of the last one.

    From one to the next straight at depth where that is no farther than two radii, else over the stock.
    """
    runs: list[tuple[Any, str]] = []
    at = None
    for level in reversed(levels):
        rest = [ring_points(ring) for ring in level]
        while rest:
            far = [np.hypot(*(ring[:-1, :2] - at).T).min() if at is not None else 0.0 for ring in rest]
            ring = rest.pop(int(np.argmin(far)))
            first = int(np.argmin(np.hypot(*(ring[:-1, :2] - at).T))) if at is not None else 0
            ring = np.r_[ring[first:-1], ring[:first], ring[first : first + 1]]
            if at is None:
                runs.append((ring, "entry"))
            else:
                kind = "link" if min(far) <= 2.0 * RADIUS else "rapid"
                runs.append((np.array([[*at, 0.0], [*ring[0, :2], 0.0]]), kind))
            runs.append((ring, "cut"))
            at = ring[-1, :2]
    return runs


def ring_points(ring: Sequence[Sequence[float]]) -> Any:
    """A closed ring of points with bulges; vertices state how they are come to: 0 straight, 1 to the left, -1 to the right."""
    points = [[x, y, 0.0] for x, y, *_ in ring]
    for i, (x, y, kind, u, v) in enumerate(ring[1:]):
        if kind:
            start = complex(points[i][0] - u, points[i][1] - v)
            angle = math.atan2((complex(x - u, y - v) / start).imag, (complex(x - u, y - v) / start).real)
            angle = angle % (2.0 * math.pi) if kind > 0 else -((-angle) % (2.0 * math.pi))
            points[i][2] = math.tan(0.25 * angle)
    return np.array(points)


# The table


def row(name: str, bound: float, answer: dict[str, Any]) -> tuple[str, dict[str, bool | None]]:
    """One line, and whether ours is faster than Adaptive at the same largest angle, and at the same angle of 99 %."""
    pocket = POCKETS[name]
    walls = [pocket.boundary, *pocket.islands]
    path = sc.pocket_path(
        pocket.boundary, pocket.islands, tool_radius=RADIUS, engagement_deg=bound, open_edges=pocket.open_edges
    )
    ours = measured(path.runs, walls, bound)
    found = {
        key: None if "error" in answer[key] else measured(answer[key]["runs"], walls, bound) for key in ("max", "p99")
    }
    plain = measured(contour_runs(answer["contours"]), walls, bound)
    faster = {key: None if other is None else ours.seconds < other.seconds for key, other in found.items()}
    line = f"{name:17} {ours.most:5.1f}"
    for key, one in (("", ours), ("max", found["max"]), ("p99", found["p99"]), ("", plain)):
        step = f" {100.0 * answer[key]['stepover']:4.1f}" if key and one else "    -" if key else ""
        line += step + (
            f" {one.seconds:6.1f} {one.length:6.0f} {100.0 * one.other / one.length:3.0f} {one.most:5.1f}"
            if one
            else "      -      -   -     -"
        )
    return line, faster


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--bound", type=float, default=60.0)
    parser.add_argument("--freecad", default=host.VERSIONS[0])
    parser.add_argument(
        "--tolerance",
        type=float,
        default=0.05,
        help="Adaptive's, mm; 0.1 is FreeCAD's own, with which its angle varies more",
    )
    parser.add_argument("--finishing", action="store_true", help="Adaptive with its pass along the walls")
    options = parser.parse_args()
    names = options.names or list(POCKETS)
    print(HEADER)
    verdicts: list[dict[str, bool | None]] = []
    for name in names:
        (answer,) = answers([name], options.bound, options)
        line, verdict = row(name, options.bound, answer)
        verdicts.append(verdict)
        print(line, flush=True)
        for key in ("max", "p99"):
            if "error" in answer[key]:
                print(f"  {key}: {answer[key]['error']}", flush=True)
    for key, words in (("max", "largest angle"), ("p99", "angle of 99 % of the length")):
        counted = [one[key] for one in verdicts if one[key] is not None]
        without = len(verdicts) - len(counted)
        print(
            f"at the same {words}: faster in {sum(counted)} of {len(counted)}; {without} without a path of Adaptive's"
        )


COLUMNS = "      s     mm  %l   deg"
HEADER = "\n".join(
    (
        "                  ours                          Adaptive, same max            Adaptive, same 99 %           parallel",
        f"pocket              deg{COLUMNS}  st%{COLUMNS}  st%{COLUMNS}{COLUMNS}",
    )
)


if __name__ == "__main__":
    main()
