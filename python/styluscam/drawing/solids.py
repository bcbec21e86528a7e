"""Triangles that a picture shows: parts, sheets, dies, tools."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from styluscam.drawing.shapes import Shape
from styluscam.parts.arrays import PartArrays
from styluscam.tools.outline import silhouette
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray

TOOL, OTHER_TOOL, DIE = 0, -1, -2
"""Numbers of faces that are not the part's."""

SIDES = 96
"""Of a tool."""

UPRIGHT = 1e-12
"""By which the Z of a unit vector that is +Z may differ from 1."""

HALF = 0.5
"""An axis whose X is smaller is not near X."""


@dataclass(frozen=True, eq=False)
class Solid:
    """What is drawn: triangles with normals at their corners (T, 3, 3) and a face number each."""

    vertices: FloatArray
    triangles: IntArray
    normals: FloatArray
    faces: IntArray

    @classmethod
    def of(cls, arrays: PartArrays, frame: FloatArray | None = None) -> Solid:
        """A part, moved by the rows (3, 4) of ``frame``."""
        if frame is None:
            return cls(arrays.vertices, arrays.triangles, arrays.normals, arrays.face_ids)
        turn = frame[:, :3]
        return cls(arrays.vertices @ turn.T + frame[:, 3], arrays.triangles, arrays.normals @ turn.T, arrays.face_ids)

    @classmethod
    def of_shape(cls, shape: Shape, face: int) -> Solid:
        """A shape as one face."""
        faces = np.full(len(shape.triangles), face, dtype=np.int64)
        return cls(shape.vertices, shape.triangles, shape.normals[shape.triangles], faces)

    @classmethod
    def none(cls) -> Solid:
        """Nothing, to which others can be added."""
        none = np.zeros((0, 3), dtype=np.int64)
        return cls(np.zeros((0, 3)), none, np.zeros((0, 3, 3)), none[:, 0])

    @classmethod
    def of_tool(
        cls, tool: Tool, tip: FloatArray, height: float, *, axis: FloatArray | None = None, down: bool = False
    ) -> Solid:
        """A tool standing at ``tip`` (3,), with its shank and holder; ``height`` mm high where it has no length.

        ``axis`` (3,) is its direction from there up, +Z when left out; ``down``: it comes from below.
        """
        turn = np.diag([1.0, -1.0, -1.0]) if down else _leaning(axis)
        vertices, triangles, normals = revolved(silhouette(tool, tool.to_dict(), height))
        face = np.full(len(triangles), OTHER_TOOL if down else TOOL, dtype=np.int64)
        return cls(vertices @ turn + tip, triangles, normals @ turn, face)

    def __add__(self, other: Solid) -> Solid:
        """Both."""
        return Solid(
            np.concatenate([self.vertices, other.vertices]),
            np.concatenate([self.triangles, other.triangles + len(self.vertices)]),
            np.concatenate([self.normals, other.normals]),
            np.concatenate([self.faces, other.faces]),
        )

    @property
    def box(self) -> FloatArray:
        """Lower and upper corner, (2, 3)."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])


def _leaning(axis: FloatArray | None) -> FloatArray:
    """What a row is multiplied by so that +Z becomes an axis, (3, 3)."""
    if axis is None or abs(axis[2] - 1.0) < UPRIGHT:
        return np.eye(3)
    aside = np.array([1.0, 0.0, 0.0]) if abs(axis[0]) < HALF else np.array([0.0, 1.0, 0.0])
    first = aside - axis * (aside @ axis)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first), axis])


def revolved(meridian: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
    """Radii and heights (N, 2) turned about Z: vertices, triangles, normals at their corners."""
    meridian = np.concatenate([meridian, [[0.0, meridian[-1, 1]]]]) if meridian[-1, 0] > 0.0 else meridian
    meridian = meridian[np.append(True, np.linalg.norm(np.diff(meridian, axis=0), axis=1) > 0.0)]
    turns = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)[:-1]
    circle = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    rings = len(meridian)
    flat = np.repeat(meridian[:, 1, None], SIDES, axis=1)[..., None]
    vertices = np.concatenate([meridian[:, 0, None, None] * circle, flat], axis=2).reshape(-1, 3)
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(rings - 1), np.arange(SIDES), indexing="ij"))
    k = (j + 1) % SIDES
    a, b, c, d = i * SIDES + j, i * SIDES + k, (i + 1) * SIDES + k, (i + 1) * SIDES + j
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    steps = np.diff(meridian, axis=0)
    out = np.stack([steps[:, 1], -steps[:, 0]], axis=1) / np.linalg.norm(steps, axis=1)[:, None]
    piece, side = np.tile(i, 2)[:, None], triangles % SIDES
    radial = out[piece, 0][..., None] * circle[side]
    normals = np.concatenate([radial, np.broadcast_to(out[piece, 1], side.shape)[..., None]], axis=2)
    return vertices, triangles, normals
