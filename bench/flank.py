"""Flank positions on a family of random ruled surfaces: what the swept surface leaves, beside what other methods leave.

python bench/flank.py [--count 200] [--members 20,27] [--seed 1]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from typing import Any, get_args

import numpy as np

import styluscam as sc
from styluscam.flank.positions import Method
from styluscam.flank.rails import RailLike

POSITIONS = 120
LEAST = 1e-6
"""Errors below this count as none, mm: 8,000 positions would be needed for chords to matter less."""
JUMP = 5.0
RESIDUAL = 1e-10


def family(seed: int, count: int) -> Iterator[tuple[tuple[RailLike, RailLike], float, Any]]:
    """Rails, radius and side: twisted by 0 to 40 deg, 30 to 100 mm long, 10 to 40 mm high, Bezier curves of degrees 1 to 4."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        twist, length = np.radians(random.uniform(0, 40)), random.uniform(30, 100)
        height, radius, degree = random.uniform(10, 40), random.uniform(2, 12), random.integers(1, 5)
        base = np.linspace(-0.5, 0.5, degree + 1)[:, None] * np.array([length, 0, 0])
        bend = np.zeros((degree + 1, 3))
        bend[1:-1, 1] = random.uniform(-0.15, 0.15, max(degree - 1, 0)) * length
        scale = length * np.array([1, 1, 0.3])
        first = base + bend + random.uniform(-0.03, 0.03, (degree + 1, 3)) * scale
        turn = np.array([[np.cos(twist), np.sin(twist), 0], [-np.sin(twist), np.cos(twist), 0], [0, 0, 1]])
        second = (base + bend + random.uniform(-0.03, 0.03, (degree + 1, 3)) * scale) @ turn
        aside = random.uniform(-0.1, 0.1) * length, random.uniform(-0.1, 0.1) * length, height
        yield ({"poles": first}, {"poles": second + np.array(aside)}), radius, ["left", "right"][random.integers(2)]


def worst(positions: sc.FlankPositions) -> float:
    error = positions.error
    return max(error.over, error.under)


def steadiness(positions: sc.FlankPositions) -> tuple[float, float]:
    """The largest turn of the axis beside the mean, and what is left of touching both rails, mm."""
    turns = np.linalg.norm(np.diff(positions.axes, axis=0), axis=1)
    aside = np.cross(positions.contacts - positions.tips[:, None], positions.axes[:, None])
    residual = np.abs(np.linalg.norm(aside, axis=2) - positions.radius).max()
    return float(turns.max() / max(turns.mean(), 1e-12)), float(residual)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--members", default="")
    asked = parser.parse_args()
    chosen = {int(number) for number in asked.members.split(",") if number}
    worse, refused, errors, seconds = 0, 0, [], 0.0
    for number, (rails, radius, side) in enumerate(family(asked.seed, asked.count)):
        if chosen and number not in chosen:
            continue
        left = {}
        for method in get_args(Method):
            tool = {"profile": {"kind": "flat", "diameter": 2 * radius}}
            start = time.perf_counter()
            try:
                found = sc.flank_positions(*rails, tool, POSITIONS, side=side, method=method)
            except sc.GeometryError as error:
                if method == "swept":
                    print(number, error)
                continue
            if method == "swept":
                seconds += time.perf_counter() - start
                jump, residual = steadiness(found)
            left[method] = worst(found)
        if "swept" not in left:
            refused += 1
            continue
        swept = left.pop("swept")
        errors.append(swept)
        if swept > max(min(left.values()), LEAST) or jump > JUMP or residual > RESIDUAL:
            worse += 1
            others = ", ".join(f"{method} {1e3 * error:.4f}" for method, error in left.items())
            print(
                f"{number}: r {radius:.1f}, swept {1e3 * swept:.4f} um, {others}; jump {jump:.1f}, residual {residual:.1e}"
            )
    print(f"{len(errors)} strips, {refused} refused; worse than another method or unsteady: {worse}")
    print(
        f"largest error {1e3 * max(errors):.1f} um, median {1e3 * float(np.median(errors)):.3f} um; {seconds:.1f} s for positions"
    )


if __name__ == "__main__":
    main()
