"""How near a moving cylinder or cone can come to a ruled surface at all: with all freedoms of its axis.

The axis sweeps a ruled surface, here two splines of free control points; what stands over points of the strip is made least by
its largest (least squares whose weights grow where heights are large, after Lawson), from the positions of `flank_positions` on.

python bench/flank_best.py [--steps 300]
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

import styluscam as sc
from styluscam import _engine
from styluscam.flank.rails import Rail, RailLike
from styluscam.types import FloatArray

PIECES, BEYOND = 20, 0.08
"""Pieces of each spline, and how far they go on beyond both ends of a part of the strip, as a share of the strip."""
ALONG, ACROSS = 81, 13
STATIONS = 1201
TURN = math.radians(20.0)
Rails = tuple[RailLike, RailLike]


def straight(direction: list[float], z: float) -> Callable[[FloatArray], FloatArray]:
    return lambda u: np.outer(60.0 * (u - 0.5), direction) + np.array([0.0, 0.0, z])


HP20: Rails = (straight([1.0, 0.0, 0.0], 0.0), straight([math.cos(TURN), math.sin(TURN), 0.0], 30.0))
CV: Rails = (
    {"poles": [(0, 0, 0), (30, 15, 0), (60, 0, 0)]},
    {"poles": [(0, 5, 30), (30, 28, 30), (60, -8, 30)]},
)
FLAT = ({"kind": "flat", "diameter": 10.0}, {"kind": "flat", "diameter": 20.0})
CONE = {"kind": "tapered-ball", "tip_radius": 3.0, "half_angle_deg": 5.0, "diameter": 16.0}


def basis(t: FloatArray, first: float, last: float) -> FloatArray:
    """Uniform cubic B-splines (M, PIECES + 3) at places from the first to the last."""
    at = np.clip((t - first) / (last - first) * PIECES, 0.0, PIECES - 1e-9)
    piece = at.astype(int)
    f = at - piece
    weights = np.stack([(1 - f) ** 3, 3 * f**3 - 6 * f**2 + 4, -3 * f**3 + 3 * f**2 + 3 * f + 1, f**3], axis=1) / 6.0
    found = np.zeros((len(t), PIECES + 3))
    for i in range(4):
        found[np.arange(len(t)), piece + i] = weights[:, i]
    return found


class Strip:
    """Points of a strip, and what an axis leaves over them."""

    def __init__(self, rails: Rails, positions: sc.FlankPositions, part: tuple[float, float]) -> None:
        self.engine = _engine.RuledStrip(Rail.of(rails[0]).columns, Rail.of(rails[1]).columns, "right")
        u, v = np.linspace(*part, ALONG), np.linspace(0.0, 1.0, ACROSS)
        self.shares = np.ascontiguousarray(np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2))
        self.points, self.normals = self.engine.points(self.shares)
        flank = positions._flank
        self.sine, self.cosine = math.sin(flank.half_angle), math.cos(flank.half_angle)
        self.ball = flank.radius / self.cosine
        self.shape = flank.radius / self.cosine**2, flank.growth
        self.ends = part[0] - BEYOND, part[1] + BEYOND
        self.t = np.linspace(*self.ends, STATIONS)
        self.at_stations = basis(self.t, *self.ends)
        self.near: npt.NDArray[np.int_] | None = None

    def distances(self, a: FloatArray, b: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Of points from the flank on axes through a towards b; how far up, and unit vectors from the axis."""
        along = b - a
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        from_axis = points - a
        up = (from_axis * along).sum(axis=-1)
        beside = from_axis - up[..., None] * along
        radius = np.linalg.norm(beside, axis=-1)
        return radius * self.cosine - up * self.sine - self.ball, up, beside / radius[..., None]

    def heights(self, poles: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What is left over each point, and its derivatives by the control points (2, PIECES + 3, 3)."""
        stations = self.at_stations @ poles
        near = self.nearest(stations)
        step = self.t[1] - self.t[0]
        three = [self.distances(stations[0][near + i], stations[1][near + i], self.points)[0] for i in (-1, 0, 1)]
        bend = np.maximum(three[0] - 2.0 * three[1] + three[2], 1e-15)
        t = self.t[near] + step * np.clip(0.5 * (three[0] - three[2]) / bend, -1.0, 1.0)
        weights = basis(t, *self.ends)
        a, b = weights @ poles
        found, up, outwards = self.distances(a, b, self.points)
        length = np.linalg.norm(b - a, axis=1)
        share = up / length
        # of a cone the point of the axis beside which the ball lies that touches there
        along = (b - a) / length[:, None]
        lean = self.cosine * outwards - self.sine * along
        higher = (
            share + np.linalg.norm(self.points - a - up[:, None] * along, axis=1) * self.sine / self.cosine / length
        )
        grown = self.sine * higher[:, None] * along
        rates = np.stack([-(1 - higher)[:, None] * lean + grown, -higher[:, None] * lean - grown], axis=1)
        return found, rates[:, :, None, :] * weights[:, None, :, None]

    def nearest(self, stations: FloatArray) -> npt.NDArray[np.int_]:
        """The station that is nearest to each point: of all at first, then of those about the last one."""
        if self.near is None:
            found = [self.distances(stations[0], stations[1], point)[0].argmin() for point in self.points]
            self.near = np.clip(np.array(found), 1, STATIONS - 2)
        while True:
            three = [
                self.distances(stations[0][self.near + i], stations[1][self.near + i], self.points)[0]
                for i in (-1, 0, 1)
            ]
            moved = np.clip(self.near + np.argmin(three, axis=0) - 1, 1, STATIONS - 2)
            if (moved == self.near).all():
                return self.near
            self.near = moved

    def measured(self, poles: FloatArray) -> tuple[float, float]:
        """How deep it enters and what it leaves, um, as the package measures it."""
        a, b = (np.ascontiguousarray(side) for side in self.at_stations @ poles)
        left = self.engine.left(a, b, self.shape, self.shares)
        return max(0.0, -1e3 * float(np.nanmin(left))), max(0.0, 1e3 * float(np.nanmax(left)))


def best(strip: Strip, positions: sc.FlankPositions, steps: int) -> FloatArray:
    """Control points whose largest height is least."""
    t = np.linspace(0.0, 1.0, len(positions.tips))
    inside = (t >= strip.ends[0]) & (t <= strip.ends[1])
    weights = basis(t[inside], *strip.ends)
    bends = np.zeros((PIECES + 1, PIECES + 3))
    for i in range(PIECES + 1):
        bends[i, i : i + 3] = 1.0, -2.0, 1.0
    # beyond the first and the last position the axis goes on straight
    through = weights.T @ weights + 1e-6 * bends.T @ bends
    poles = np.linalg.solve(through, weights.T @ positions._beside_rails[inside].transpose(1, 0, 2))
    height, rates = strip.heights(poles)
    counts, least, damping = np.full(len(height), 1.0 / len(height)), (float(np.abs(height).max()), poles), 1e-6
    for _ in range(steps):
        # heights that are far from the largest count less and less, but never nothing
        counts = counts * (0.05 + np.abs(height) / np.abs(height).max())
        counts /= counts.sum()
        rows = rates.reshape(len(height), -1)
        normal, right = rows.T @ (rows * counts[:, None]), rows.T @ (counts * height)
        largest = normal.diagonal().max()
        # a step that does not lower the squares is tried shorter
        while damping < 1.0:
            step = np.linalg.solve(normal + np.eye(len(normal)) * damping * largest, right).reshape(poles.shape)
            tried = strip.heights(poles - step)
            if (counts * tried[0] ** 2).sum() < (counts * height**2).sum():
                break
            damping *= 10.0
        else:
            damping = 1e-3
            continue
        poles, (height, rates), damping = poles - step, tried, max(0.3 * damping, 1e-8)
        if np.abs(height).max() < least[0]:
            # another station may have come nearer than those about the last one
            strip.near = None
            height, rates = strip.heights(poles)
        if np.abs(height).max() < least[0]:
            least = float(np.abs(height).max()), poles
    return least[1]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=200)
    asked = parser.parse_args()
    cases: list[tuple[str, Rails, dict[str, Any]]] = [
        ("HP20, r 5", HP20, FLAT[0]),
        ("HP20, r 10", HP20, FLAT[1]),
        ("CV, r 5", CV, FLAT[0]),
        ("CV, r 10", CV, FLAT[1]),
        ("HP20, cone r 3, 5 deg", HP20, CONE),
        ("CV, cone r 3, 5 deg", CV, CONE),
    ]
    for name, rails, profile in cases:
        positions = sc.flank_positions(*rails, {"profile": profile}, STATIONS, side="right")
        error = positions.error
        for title, part in (("middle half", (0.25, 0.75)), ("whole", (0.0, 1.0))):
            strip, inner = Strip(rails, positions, part), error.between(*part)
            found = strip.measured(best(strip, positions, asked.steps))
            print(
                f"{name}, {title}: over / under, um: swept {1e3 * inner.over:.2f} / {1e3 * inner.under:.2f},"
                f" best {found[0]:.2f} / {found[1]:.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
