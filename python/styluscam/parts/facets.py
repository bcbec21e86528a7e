"""A triangle mesh as a surface: distances to its facets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from styluscam.parts.arrays import Ints, area_vectors
from styluscam.parts.surfaces import Floats, unit


@dataclass(frozen=True, eq=False)
class Facets:
    """A triangle mesh as an exact surface: distance to its nearest triangle, signed by that triangle's side."""

    vertices: Floats
    triangles: Ints

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return self._nearest(points)[0]

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface: that of the nearest triangle."""
        return unit(area_vectors(self.vertices, self.triangles[self._nearest(points)[1]]))

    def _nearest(self, points: Floats) -> tuple[Floats, Ints]:
        """Return signed distance and nearest triangle: bounding spheres leave few candidates for each point."""
        corners = self.vertices[self.triangles]
        centres = (corners.min(axis=1) + corners.max(axis=1)) / 2.0
        radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
        distances, nearest = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
        rows = max(1, 2_000_000 // len(corners))
        for start in range(0, len(points), rows):
            part = points[start : start + rows]
            apart = np.sqrt(((part[:, None] - centres) ** 2).sum(axis=2))
            which, candidate = np.nonzero(apart - radii <= (apart + radii).min(axis=1)[:, None])
            away = part[which] - _closest(part[which], corners[candidate])
            doubled = area_vectors(self.vertices, self.triangles[candidate])
            height = np.einsum("ij,ij->i", away, unit(doubled))
            # Among triangles that share the nearest point, the one seen most from above gives the right side.
            order = np.lexsort((-np.abs(height), np.round(np.linalg.norm(away, axis=1), 9), which))
            first = order[np.searchsorted(which[order], np.arange(len(part)))]
            size = np.linalg.norm(away[first], axis=1)
            distances[start : start + rows] = np.copysign(size, height[first])
            nearest[start : start + rows] = candidate[first]
        return distances, nearest


def _closest(points: Floats, corners: Floats) -> Floats:
    """Return the point of each triangle (N,3,3) nearest to the point beside it (N,3)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    squared = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    away = points - a
    v = np.einsum("ij,ij->i", np.cross(away, ac), normal) / squared
    w = np.einsum("ij,ij->i", np.cross(ab, away), normal) / squared
    best = a + v[:, None] * ab + w[:, None] * ac
    outside = (v < 0.0) | (w < 0.0) | (v + w > 1.0)
    gap = np.where(outside, np.inf, 0.0)
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        length = np.maximum(np.einsum("ij,ij->i", side, side), 1e-300)
        share = np.clip(np.einsum("ij,ij->i", points - start, side) / length, 0.0, 1.0)
        on_side = start + share[:, None] * side
        reach = np.linalg.norm(points - on_side, axis=1)
        better = outside & (reach < gap)
        best, gap = np.where(better[:, None], on_side, best), np.where(better, reach, gap)
    return np.asarray(best)
