"""Fewer points for a drawing of a path, and how far the drawing is from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from styluscam.types import FloatArray, IntArray

FIRST = 1e-4
"""mm: the distance with which thinning begins; it doubles until enough points are gone."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """Points that stay: their ``indices``, and the largest distance of one that went from its chord, mm."""

    indices: IntArray
    error_mm: float


def thinned(points: FloatArray, keep: npt.NDArray[np.bool_], limit: int) -> Drawn:
    """At most ``limit`` of the points (N, 3), if those to ``keep`` (N,) are no more; the ends of the path stay."""
    alive = np.arange(len(points))
    if len(points) < 2:
        return Drawn(alive, 0.0)
    distance = FIRST
    keep = keep.copy()
    keep[[0, -1]] = True
    while len(alive) > limit and len(alive) > np.count_nonzero(keep):
        fewer = _pass(points, keep, alive, distance)
        if len(fewer) > 0.95 * len(alive):
            distance *= 2.0
        alive = fewer
    return Drawn(alive, _error(points, alive))


def _pass(points: FloatArray, keep: npt.NDArray[np.bool_], alive: IntArray, distance: float) -> IntArray:
    """Every other point goes where it is near the chord of its neighbours."""
    middle = np.arange(1, len(alive) - 1, 2)
    here, before, after = alive[middle], alive[middle - 1], alive[middle + 1]
    goes = ~keep[here] & (_from_chord(points[here], points[before], points[after]) <= distance)
    stays = np.ones(len(alive), dtype=bool)
    stays[middle[goes]] = False
    return alive[stays]


def _error(points: FloatArray, alive: IntArray) -> float:
    """The largest distance of any point from the chord that stands for it."""
    chord = np.clip(np.searchsorted(alive, np.arange(len(points)), side="right") - 1, 0, len(alive) - 2)
    return float(_from_chord(points, points[alive[chord]], points[alive[chord + 1]]).max())


def _from_chord(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    chord = ends - starts
    square = np.einsum("ij,ij->i", chord, chord)
    along = np.einsum("ij,ij->i", points - starts, chord)
    share = np.clip(np.divide(along, square, out=np.zeros_like(along), where=square > 0.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - starts - share[:, None] * chord, axis=1))
