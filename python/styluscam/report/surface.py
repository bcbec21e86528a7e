"""The part as a page shows it: triangles in work coordinates, finer where a map is to be drawn on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from styluscam.parts.arrays import PartArrays
from styluscam.types import FloatArray, IntArray

Mask = npt.NDArray[np.bool_]

SHARP = float(np.cos(np.radians(30.0)))
"""Between the normals of facets, from which on their edge is drawn."""

PATTERNS: tuple[tuple[tuple[int, int, int], ...], ...] = (
    ((0, 1, 2),),
    ((0, 3, 2), (3, 1, 2)),
    ((0, 1, 4), (0, 4, 2)),
    ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    ((0, 1, 5), (5, 1, 2)),
    ((5, 0, 3), (2, 5, 3), (2, 3, 1)),
    ((4, 2, 5), (1, 4, 5), (1, 5, 0)),
    ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
)
"""What a triangle becomes, by which of its sides are halved (bits 0 to 2: from each corner to the next): corners 0 to 2,
middles of the sides 3 to 5."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Points (P, 3), mm; triangles (T, 3) of them with normals at their corners (T, 3, 3) and a face each (T,)."""

    points: FloatArray
    triangles: IntArray
    normals: FloatArray
    faces: IntArray
    smooth: bool
    """Whether the normals are those of the model's surfaces, not of facets."""

    @classmethod
    def of(cls, arrays: PartArrays, frame: FloatArray) -> Surface:
        """A part, moved by the rows (3, 4) of ``frame``."""
        turn = frame[:, :3]
        smooth = not arrays.is_mesh
        points = arrays.vertices @ turn.T + frame[:, 3]
        return cls(points, arrays.triangles, arrays.normals @ turn.T, arrays.face_ids, smooth)

    @property
    def areas(self) -> FloatArray:
        """Of the triangles, (T,), mm^2."""
        return np.asarray(np.linalg.norm(self._doubled(), axis=1) / 2.0)

    @property
    def looks_up(self) -> Mask:
        """The triangles (T,) that do not face down, as the engine's ``looking_up`` has it."""
        doubled = self._doubled()
        return np.asarray(doubled[:, 2] >= -1e-4 * np.linalg.norm(doubled, axis=1))

    def _ends(self) -> IntArray:
        """The points at both ends of each side, (T, 3, 2), the lower number first."""
        ends = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=-1)
        return np.asarray(np.sort(ends, axis=-1), dtype=np.int64)

    def _doubled(self) -> FloatArray:
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def borders(self) -> IntArray:
        """Pairs of points (E, 2) between which faces meet, or end; facets of a mesh where they make a sharp edge."""
        ends = self._ends().reshape(-1, 2)
        key = ends[:, 0] * len(self.points) + ends[:, 1]
        order = np.argsort(key, kind="stable")
        of, key = order // 3, key[order]
        twin = np.flatnonzero(key[1:] == key[:-1])
        normals = self._doubled()
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        differ = self.faces[of[twin]] != self.faces[of[twin + 1]]
        if not self.smooth:
            differ |= np.einsum("ij,ij->i", normals[of[twin]], normals[of[twin + 1]]) < SHARP
        single = np.ones(len(key), dtype=bool)
        single[twin] = single[twin + 1] = False
        borders: IntArray = ends[order[np.concatenate([np.flatnonzero(single), twin[differ]])]]
        return borders

    def longest_side(self, selected: Mask) -> float:
        """Of the selected triangles (T,), mm."""
        return float(_sides(self.points, self.triangles[selected]).max(initial=0.0))

    def coarsened(self, limit: int) -> tuple[Surface, float]:
        """At most ``limit`` points, and the size of the cells in which those that were there became one, mm; 0: none did."""
        surface, cell = self, 0.0
        while len(surface.points) > limit:
            cell = 1.2 * cell or float(np.sqrt(self.areas.sum() / limit))
            surface = self._merged(cell)
        return surface, cell

    def _merged(self, cell: float) -> Surface:
        """With the points of each cell merged into the first of them; triangles without area are gone."""
        cells = np.floor((self.points - self.points.min(axis=0)) / cell).astype(np.int64)
        _, first, owner = np.unique(cells, axis=0, return_index=True, return_inverse=True)
        triangles = owner.reshape(-1)[self.triangles]
        a, b, c = triangles.T
        stays = (a != b) & (b != c) & (c != a)
        merged = Surface(self.points[first], triangles[stays], self.normals[stays], self.faces[stays], self.smooth)
        return merged if self.smooth else merged._faceted()

    def _faceted(self) -> Surface:
        """With the normals of its facets."""
        normals = self._doubled()
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        return Surface(self.points, self.triangles, np.repeat(normals[:, None], 3, axis=1), self.faces, self.smooth)

    def refined(self, selected: Mask, spacing: float, limit: int) -> tuple[Surface, Mask]:
        """Sides of selected triangles (T,) are halved until none is longer than ``spacing`` mm, or ``limit`` is reached.

        Neighbours are divided with them: no gaps. The finer surface comes with what is selected of it.
        """
        surface = self
        while True:
            sides = np.where(selected[:, None], _sides(surface.points, surface.triangles), 0.0)
            # the longest go first: what room there is serves all alike
            long = sides > max(spacing, sides.max(initial=0.0) / 2.0)
            room = limit - len(surface.points)
            if not long.any() or room <= 0:
                return surface, selected
            surface, parent = surface._halved(long, room)
            selected = selected[parent]

    def _halved(self, long: Mask, room: int) -> tuple[Surface, IntArray]:
        """With long sides (T, 3) halved, the longest of them where there is ``room`` for so many points.

        Comes with the triangle that each new one is a part of.
        """
        ends = self._ends()
        key = ends[..., 0] * len(self.points) + ends[..., 1]
        halved, first = np.unique(key[long], return_index=True)
        if len(halved) > room:
            lengths = _sides(self.points, self.triangles)[long][first]
            halved = np.sort(halved[np.argsort(-lengths, kind="stable")[:room]])
        at = np.minimum(np.searchsorted(halved, key), len(halved) - 1)
        marked = halved[at] == key
        middles = (self.points[halved // len(self.points)] + self.points[halved % len(self.points)]) / 2.0
        nodes = np.concatenate([self.triangles, at + len(self.points)], axis=1)
        between = self.normals + np.roll(self.normals, -1, axis=1)
        between /= np.maximum(np.linalg.norm(between, axis=2, keepdims=True), 1e-12)
        normals = np.concatenate([self.normals, between], axis=1)
        pattern = marked @ np.array([1, 2, 4])
        parts = [
            (np.flatnonzero(pattern == number), list(corners))
            for number, pieces in enumerate(PATTERNS)
            for corners in pieces
        ]
        parent = np.concatenate([of for of, _ in parts])
        order = np.argsort(parent, kind="stable")
        surface = Surface(
            np.concatenate([self.points, middles]),
            np.concatenate([nodes[of][:, corners] for of, corners in parts])[order],
            np.concatenate([normals[of][:, corners] for of, corners in parts])[order],
            self.faces[parent[order]],
            self.smooth,
        )
        return surface, parent[order]


@dataclass(frozen=True, eq=False)
class Vertices:
    """A surface for a graphics card: one normal for each vertex."""

    at: IntArray
    """The point of each vertex, (V,)."""
    normals: FloatArray
    """(V, 3)."""
    triangles: IntArray
    """(T, 3), of vertices."""
    faces: IntArray
    """The face of each vertex, (V,)."""


def vertices_of(surface: Surface) -> Vertices:
    """Corners of one face at one point become one vertex; those of facets stay apart, so that edges stay sharp."""
    corners = surface.triangles.reshape(-1)
    faces = np.repeat(surface.faces, 3)
    normals = surface.normals.reshape(-1, 3)
    if not surface.smooth:
        triangles = np.arange(len(corners)).reshape(-1, 3)
        return Vertices(corners, normals, triangles, faces)
    _, first, vertex = np.unique(faces * len(surface.points) + corners, return_index=True, return_inverse=True)
    vertex = vertex.reshape(-1)
    order = np.argsort(first)  # in the order of the triangles: neighbours stay near each other
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    vertex, first = rank[vertex], first[order]
    summed: FloatArray = np.zeros((len(first), 3))
    np.add.at(summed, vertex, normals)
    summed /= np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-12)
    return Vertices(corners[first], summed, vertex.reshape(-1, 3), faces[first])


def _sides(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Lengths (T, 3) of the sides from each corner to the next."""
    corners = points[triangles]
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))
