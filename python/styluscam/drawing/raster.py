"""Triangles to pixels: a parallel projection with a depth buffer, in numpy.

Pictures need to know, at every pixel, which face is seen and how far away it is: to shade it with the exact normals, to
put a name on a face where it is visible, and to hide a path behind a wall.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from styluscam.types import FloatArray, IntArray

FRAGMENTS = 2_000_000
"""Fragments worked on at a time: bounds the memory."""


@dataclass(frozen=True)
class View:
    """A parallel projection onto an image: where the eye is, pixels per mm, and what lies in the image's middle."""

    azimuth_deg: float
    elevation_deg: float
    width: int
    height: int
    scale: float = 1.0
    middle: tuple[float, float] = (0.0, 0.0)

    @property
    def axes(self) -> FloatArray:
        """Unit vectors to the right, up and towards the eye, as rows (3, 3)."""
        a, e = np.radians([self.azimuth_deg, self.elevation_deg])
        towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.array([right, np.cross(towards, right), towards])

    def framed(self, points: FloatArray, margin: float) -> View:
        """The same view, scaled so that ``points`` (N, 3) fill the image up to a ``margin`` in pixels."""
        flat = points @ self.axes[:2].T
        low, high = flat.min(axis=0), flat.max(axis=0)
        room = np.array([self.width, self.height]) - 2.0 * margin
        scale = float((room / np.maximum(high - low, 1e-9)).min())
        x, y = (low + high) / 2.0
        return View(self.azimuth_deg, self.elevation_deg, self.width, self.height, scale, (float(x), float(y)))

    def project(self, points: FloatArray) -> FloatArray:
        """Pixels to the right and down, and mm towards the eye, of points (N, 3)."""
        seen = np.asarray(points) @ self.axes.T
        x = (seen[..., 0] - self.middle[0]) * self.scale + self.width / 2.0
        y = self.height / 2.0 - (seen[..., 1] - self.middle[1]) * self.scale
        return np.stack([x, y, seen[..., 2]], axis=-1)

    def finer(self, factor: int) -> View:
        """The same view with so many times the pixels."""
        size = self.width * factor, self.height * factor
        return View(self.azimuth_deg, self.elevation_deg, *size, self.scale * factor, self.middle)


@dataclass(frozen=True, eq=False)
class Raster:
    """What is seen at each pixel: triangle (-1: nothing), mm towards the eye, and where in the triangle."""

    triangle: IntArray
    depth: FloatArray
    weights: FloatArray

    def hides(self, points: FloatArray, slack: float) -> npt.NDArray[np.bool_]:
        """Whether projected points (N, 3) lie more than ``slack`` mm behind what is seen there."""
        height, width = self.depth.shape
        x, y = (np.floor(points[:, k]).astype(np.int64) for k in (0, 1))
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        hidden = np.zeros(len(points), dtype=bool)
        hidden[inside] = self.depth[y[inside], x[inside]] > points[inside, 2] + slack
        return hidden


def rasterise(view: View, vertices: FloatArray, triangles: IntArray) -> Raster:
    """The triangles (T, 3) as ``view`` shows them; those that turn their back are seen too."""
    corners = view.project(vertices)[triangles]
    depth = np.full(view.width * view.height, -np.inf)
    seen = np.full(view.width * view.height, -1, dtype=np.int64)
    for index, x, y in _fragments(corners, view.width, view.height):
        towards = np.einsum("fk,fk->f", _weights(corners[index], x, y), corners[index, :, 2])
        pixel = y * view.width + x
        np.maximum.at(depth, pixel, towards)
        nearest = towards >= depth[pixel]
        seen[pixel[nearest]] = index[nearest]
    weights = np.zeros((len(seen), 3))
    hit = np.flatnonzero(seen >= 0)
    weights[hit] = _weights(corners[seen[hit]], hit % view.width, hit // view.width)
    shape = view.height, view.width
    return Raster(seen.reshape(shape), depth.reshape(shape), weights.reshape(*shape, 3))


def _fragments(corners: FloatArray, width: int, height: int) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
    """Triangle, column and row of each pixel whose middle a triangle covers; in parts."""
    low = np.clip(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), 0, height).astype(np.int64)
    high = np.clip(np.ceil(corners[:, :, 1].max(axis=1) - 0.5), 0, height).astype(np.int64)
    wide = np.clip(np.ptp(corners[:, :, 0], axis=1), 1.0, width)
    cost = np.cumsum((high - low) * (wide + 4.0))
    total = float(cost[-1]) if len(cost) else 0.0
    parts = np.searchsorted(cost, np.arange(FRAGMENTS, total + FRAGMENTS, FRAGMENTS))
    start = 0
    for stop in np.minimum(parts + 1, len(corners)):
        if stop > start:
            index, row = _ranges(np.arange(start, stop), low[start:stop], high[start:stop])
            left, right = _spans(corners[index], np.asarray(row + 0.5, dtype=np.float64))
            first = np.clip(np.ceil(left - 0.5), 0, width).astype(np.int64)
            last = np.clip(np.ceil(right - 0.5), 0, width).astype(np.int64)
            span, column = _ranges(np.arange(len(index)), first, np.maximum(first, last))
            yield index[span], column, row[span]
        start = int(stop)


def _ranges(owner: IntArray, low: IntArray, high: IntArray) -> tuple[IntArray, IntArray]:
    """All whole numbers from ``low`` up to ``high``, that excluded, each with its owner."""
    count = high - low
    ends = np.cumsum(count)
    total = int(ends[-1]) if len(ends) else 0
    offset = np.arange(total) - np.repeat(ends - count, count)
    return np.repeat(owner, count), np.repeat(low, count) + offset


def _spans(corners: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where triangles (N, 3, 3) begin and end along the rows ``y`` (N,)."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        # from its upper end always: neighbours find the same border, and no pixel between them is missed
        swap = (corners[:, a, 1] > corners[:, b, 1])[:, None]
        p, q = np.where(swap, corners[:, b], corners[:, a]), np.where(swap, corners[:, a], corners[:, b])
        crosses = (p[:, 1] <= y) & (y < q[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            x = p[:, 0] + (y - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0])
        left = np.where(crosses, np.minimum(left, x), left)
        right = np.where(crosses, np.maximum(right, x), right)
    empty = left > right
    return np.where(empty, 0.0, left), np.where(empty, 0.0, right)


def _weights(corners: FloatArray, x: IntArray, y: IntArray) -> FloatArray:
    """Barycentric weights (N, 3) of the middles of pixels in projected triangles (N, 3, 3)."""
    a, b, c = corners[:, 0, :2], corners[:, 1, :2], corners[:, 2, :2]
    at = np.stack([x + 0.5, y + 0.5], axis=1)
    area = _cross(b - a, c - a)
    area = np.where(np.abs(area) < 1e-12, 1e-12, area)
    second, third = _cross(at - a, c - a) / area, _cross(b - a, at - a) / area
    return np.stack([1.0 - second - third, second, third], axis=1)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
