"""Counts gouges of single triangles, OpenCAMLib's and ours, by one truth; writes docs/performance.md between its markers.

python bench/gouges.py [--triangles 2000] [--dry]
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from opencamlib_peer import answer, peer_python
from page import table, write
from rings import Floats, missing, nearest

import styluscam as sc

BY_CUTTER = 40
FLOOR = -1000.0
LENGTH = 1000.0
THEIRS, OURS = 1e-4, 1e-9
"""A gouge is deeper than this, mm."""
RIGHT = 0.5 * np.pi


class Cutter(NamedTuple):
    """One shape: for OpenCAMLib, for us (if a kind of profile is that shape), and as rings for the truth."""

    peer: list[Any]
    profile: dict[str, Any] | None
    rings: list[tuple[float, float, float, float, float]]


def side(tip: float, section: float, radius: float, half_angle: float) -> float:
    """Height at which a cone that touches a ring at the tip has a radius."""
    return (radius - tip) / np.tan(half_angle) + section - section / np.sin(half_angle)


def cylinder(rng: np.random.Generator, d: float) -> Cutter:
    return Cutter(["CylCutter", d, LENGTH], {"kind": "flat", "diameter": d}, [(0.5 * d, 0.0, 0.0, 0.0, RIGHT)])


def ball(rng: np.random.Generator, d: float) -> Cutter:
    return Cutter(["BallCutter", d, LENGTH], {"kind": "ball", "diameter": d}, [(0.0, 0.5 * d, 0.5 * d, 0.0, RIGHT)])


def bull(rng: np.random.Generator, d: float) -> Cutter:
    r = d * rng.uniform(0.02, 0.45)
    profile = {"kind": "bull-nose", "diameter": d, "corner_radius": r}
    return Cutter(["BullCutter", d, r, LENGTH], profile, [(0.5 * d - r, r, r, 0.0, RIGHT)])


def cone(rng: np.random.Generator, d: float) -> Cutter:
    a = np.radians(rng.uniform(10.0, 80.0))
    profile = {"kind": "cone", "tip_radius": 0.0, "half_angle_deg": np.degrees(a), "diameter": d}
    rings = [(0.0, 0.0, 0.0, 0.0, RIGHT - a), (0.5 * d, side(0.0, 0.0, 0.5 * d, a), 0.0, RIGHT - a, RIGHT)]
    return Cutter(["ConeCutter", d, a, LENGTH], profile, rings)


def ball_cone(rng: np.random.Generator, d: float) -> Cutter:
    a, r = np.radians(rng.uniform(5.0, 60.0)), 0.5 * d * rng.uniform(0.1, 0.7)
    profile = {"kind": "tapered-ball", "tip_radius": r, "half_angle_deg": np.degrees(a), "diameter": d}
    rings = [(0.0, r, r, 0.0, RIGHT - a), (0.5 * d, side(0.0, r, 0.5 * d, a), 0.0, RIGHT - a, RIGHT)]
    return Cutter(["BallConeCutter", 2.0 * r, d, a], profile, rings)


def bull_cone(rng: np.random.Generator, d: float) -> Cutter:
    a, tip = np.radians(rng.uniform(5.0, 60.0)), 0.5 * d * rng.uniform(0.2, 0.7)
    r = tip * rng.uniform(0.1, 0.8)
    flat = tip - r
    profile = {"kind": "tapered-ball", "tip_radius": r, "half_angle_deg": np.degrees(a), "diameter": d}
    rings = [(flat, r, r, 0.0, RIGHT - a), (0.5 * d, side(flat, r, 0.5 * d, a), 0.0, RIGHT - a, RIGHT)]
    return Cutter(["BullConeCutter", 2.0 * tip, r, d, a], {**profile, "tip_flat": flat}, rings)


def cone_cone(rng: np.random.Generator, d: float) -> Cutter:
    a, b, r = np.radians(rng.uniform(50.0, 80.0)), np.radians(rng.uniform(10.0, 45.0)), 0.5 * d * rng.uniform(0.2, 0.7)
    low = side(0.0, 0.0, r, a)
    rings = [
        (0.0, 0.0, 0.0, 0.0, RIGHT - a),
        (r, low, 0.0, RIGHT - a, RIGHT - b),
        (0.5 * d, low + side(r, 0.0, 0.5 * d, b), 0.0, RIGHT - b, RIGHT),
    ]
    return Cutter(["ConeConeCutter", 2.0 * r, a, d, b], None, rings)


def cylinder_cone(rng: np.random.Generator, d: float) -> Cutter:
    a, r = np.radians(rng.uniform(5.0, 75.0)), 0.5 * d * rng.uniform(0.1, 0.7)
    profile = {"kind": "v", "tip_diameter": 2.0 * r, "angle_deg": 2.0 * np.degrees(a), "diameter": d}
    rings = [(r, 0.0, 0.0, 0.0, RIGHT - a), (0.5 * d, side(r, 0.0, 0.5 * d, a), 0.0, RIGHT - a, RIGHT)]
    return Cutter(["CylConeCutter", 2.0 * r, d, a], profile, rings)


CUTTERS: dict[str, Callable[[np.random.Generator, float], Cutter]] = {
    "CylCutter": cylinder,
    "BallCutter": ball,
    "BullCutter": bull,
    "ConeCutter": cone,
    "BallConeCutter": ball_cone,
    "BullConeCutter": bull_cone,
    "ConeConeCutter": cone_cone,
    "CylConeCutter": cylinder_cone,
}


def triangles(rng: np.random.Generator, count: int) -> Floats:
    """Corners (N, 3, 3): any, slivers, upright and level ones, 0.1 to 50 mm large."""
    corners = rng.uniform(-1.0, 1.0, (count, 3, 3)) * np.exp(rng.uniform(np.log(0.1), np.log(50.0), (count, 1, 1)))
    kind, share = rng.integers(0, 6, count), rng.uniform(-0.2, 1.2, (count, 1))
    between = corners[:, 0] + share * (corners[:, 1] - corners[:, 0])
    corners[kind == 0, 2] = (between + 1e-4 * corners[:, 2])[kind == 0]
    corners[kind == 1, 2, :2] = between[kind == 1, :2]
    corners[kind == 2, :, 2] = corners[kind == 2, :1, 2]
    return corners


def positions(rng: np.random.Generator, corners: Floats, diameters: Floats) -> Floats:
    """Positions (N, 2) at most a tool's radius away from a random point of the triangle, corners and edges more often."""
    shares = rng.dirichlet((0.3, 0.3, 0.3), len(corners))
    away = 0.5 * diameters * rng.choice([0.0, 1.0], len(corners), p=[0.1, 0.9]) * rng.uniform(0.0, 1.05, len(corners))
    angle = rng.uniform(0.0, 2.0 * np.pi, len(corners))
    on = np.einsum("ni,nij->nj", shares, corners)[:, :2]
    return on + away[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def our_tips(cutters: list[Cutter], of: list[int], corners: Floats, xy: Floats) -> Floats:
    tools = [sc.Tool.from_dict({"profile": cutter.profile}) for cutter in cutters]
    parts = (sc.Part.from_mesh(triangle, [[0, 1, 2]]) for triangle in corners)
    each = zip(parts, of, xy, strict=True)
    return np.array(
        [sc.drop_cutter(part, tools[number], [position], floor=FLOOR)[0] for part, number, position in each]
    )


def depths(rings: Floats, corners: Floats, xy: Floats, tips: Floats) -> Floats:
    """How deep (N,) the triangles' deepest points are in the tools."""
    return -nearest(rings, corners - np.column_stack([xy, tips])[:, None, :])


def row(name: str, count: int, python: Path | None) -> tuple[list[str], str]:
    """A line of the table, and OpenCAMLib's version."""
    rng = np.random.default_rng(list(CUTTERS).index(name))
    diameters = np.exp(rng.uniform(np.log(1.0), np.log(20.0), -(-count // BY_CUTTER)))
    cutters = [CUTTERS[name](rng, float(d)) for d in diameters]
    of = [i // BY_CUTTER for i in range(count)]
    corners = triangles(rng, count)
    xy = positions(rng, corners, diameters[of])
    rings = np.array([cutters[i].rings for i in of])
    line, version = [name, f"{count:,}"], ""
    if python:
        question = {
            "cutters": [cutter.peer for cutter in cutters],
            "cutter": of,
            "triangles": corners.tolist(),
            "positions": xy.tolist(),
            "floor": FLOOR,
        }
        found = answer(python, "opencamlib_gouges.py", question=json.dumps(question))
        version, tips = found["version"], np.array(found["tips"])
        deep = depths(rings, corners, xy, tips)
        bad = deep > THEIRS
        lift = missing(rings[bad], corners[bad] - np.column_stack([xy, tips])[bad][:, None, :], -2.0 * FLOOR)
        line += [f"{bad.sum():,}", f"{100.0 * bad.mean():.1f} %", f"{max(deep.max(), 0.0):.2g}"]
        line.append(f"{lift.max(initial=0.0):.2g}")
    else:
        line += [""] * 4
    if cutters[0].profile is None:
        return [*line, "no such kind", ""], version
    deep = depths(rings, corners, xy, our_tips(cutters, of, corners, xy))
    return [*line, str((deep > OURS).sum()), f"{max(deep.max(), 0.0):.0e}"], version


def measured(count: int) -> str:
    python, reason = peer_python()
    rows, versions = zip(*(row(name, count, python) for name in CUTTERS), strict=True)
    heads = [
        "cutter",
        "triangles",
        "OpenCAMLib: gouges",
        "share",
        "deepest, mm",
        "too low by, mm",
        "ours: gouges",
        "deepest, mm",
    ]
    who = f"OpenCAMLib {versions[0]}" if python else f"OpenCAMLib was left out: {reason}"
    return "\n\n".join(
        [
            f"{who} (`dropCutter`) and styluscam {sc.__version__}, the same random triangles, positions and tools of 1 to 20 mm, "
            "checked against one truth that is neither's (`bench/rings.py`). A gouge is a triangle of which a point lies deeper "
            f"in the tool than {THEIRS:g} mm (OpenCAMLib) or {OURS:g} mm (ours); beside it, by how much the tip is too low, to "
            f"{-FLOOR:,.0f} mm where nothing was found under the tool at all.",
            table(heads, rows),
            "Two cones on one another are convex, but no kind of our profiles has their corner.",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--triangles", type=int, default=2000, help="of each cutter")
    parser.add_argument("--dry", action="store_true", help="print only")
    options = parser.parse_args()
    section = measured(options.triangles)
    print(section)
    if not options.dry:
        write("gouges", section)


if __name__ == "__main__":
    main()
