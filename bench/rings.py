"""A truth about tools and triangles of a method of its own, for numpy.

A tool is the hull of rings: torus-shaped parts (radius and height of the middle, radius of the section) that each hold an
interval of slopes. Its distance from a point has a closed form; over a triangle it is convex, and searched by golden sections.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
SECTIONS = 70
HALVINGS = 44


def distances(rings: Floats, points: Floats) -> Floats:
    """Signed distances (N,) of points (N, 3), tips at the origin, from tools (N, rings, 5).

    A ring is (radius, height, section, first slope, last slope). Of each interval of slopes the supporting plane nearest to
    the point's direction leaves the largest gap, and the largest of all is the distance.
    """
    radius, height, section, first, last = np.moveaxis(rings, 2, 0)
    across = np.hypot(points[:, 0], points[:, 1])[:, None] - radius
    below = height - points[:, 2][:, None]
    # the slope of the direction, on the branch around the middle of the interval
    middle = 0.5 * (first + last)
    slope = np.arctan2(across, below)
    slope = np.clip(middle + (slope - middle + np.pi) % (2.0 * np.pi) - np.pi, first, last)
    return np.max(across * np.sin(slope) + below * np.cos(slope) - section, axis=1)


def nearest(rings: Floats, triangles: Floats) -> Floats:
    """The least distance (N,) of triangles (N, 3, 3) from tools whose tips are at the origin: how far they enter, if negative."""
    a, b, c = np.moveaxis(triangles, 1, 0)

    def along(s: Floats) -> Floats:
        start = a + (b - a) * s[:, None]
        return golden(lambda t: distances(rings, start + (c - a) * (t * (1.0 - s))[:, None]), len(a))

    return golden(along, len(a))


def golden(function: Callable[[Floats], Floats], count: int) -> Floats:
    """The least values (N,) of convex functions from 0 to 1, all at once."""
    low, high = np.zeros(count), np.ones(count)
    least = np.minimum(function(low), function(high))
    p, q = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_p, at_q = function(p), function(q)
    for _ in range(SECTIONS):
        least = np.minimum(least, np.minimum(at_p, at_q))
        left = at_p < at_q
        low, high = np.where(left, low, p), np.where(left, q, high)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        at_new = function(new)
        p, q, at_p, at_q = (
            np.where(left, new, q),
            np.where(left, p, new),
            np.where(left, at_new, at_q),
            np.where(left, at_p, at_new),
        )
    return np.minimum(least, np.minimum(at_p, at_q))


def missing(rings: Floats, triangles: Floats, most: float) -> Floats:
    """By how much (N,) the tools must rise until they are free: up to `most`."""
    low, high = np.zeros(len(triangles)), np.full(len(triangles), most)
    for _ in range(HALVINGS):
        lift = 0.5 * (low + high)
        lowered = triangles - np.stack([np.zeros_like(lift), np.zeros_like(lift), lift], axis=1)[:, None, :]
        enters = nearest(rings, lowered) < -1e-9
        low, high = np.where(enters, lift, low), np.where(enters, high, lift)
    return high
