"""What the selected faces of a job ask of a tool: how much of them has which wall angle, and how hollow they are."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.errors import GeometryError
from styluscam.job import Job
from styluscam.parts import PartArrays
from styluscam.types import Document, FloatArray, IntArray, Progress

FLOOR_DEG = 5.0
"""Flatter places are floors: levels lie so far apart there that none of their scallops is a surface."""

STEEP_DEG = 89.0
"""Steeper walls are vertical to levels."""

BIN_DEG = 2.5
"""Width of the classes of wall angles."""

CREASE_DEG = 2.0
"""Faces that meet at more than this are not tangent to each other."""


@dataclass(frozen=True, eq=False)
class Walls:
    """The selected faces by place: N triangles, in the setup's frame, that look up."""

    slopes: FloatArray
    """(N,) rad."""
    areas: FloatArray
    """(N,) mm^2."""
    bends: FloatArray
    """(N, 3) 1/mm: curvature up the wall, twist, curvature along the level line; positive where convex."""
    crease_mm: float
    """Length of sharp concave edges between selected faces, mm: no tool reaches into one."""

    @property
    def floor_share(self) -> float:
        """Share of the area that is flatter than a wall."""
        return float(self.areas[np.degrees(self.slopes) < FLOOR_DEG].sum() / self.areas.sum())

    @property
    def smallest_hollow_mm(self) -> float | None:
        """The smallest concave radius up the walls or along them, mm; None where nothing is concave."""
        sharpest = float(self.bends[:, (0, 2)].min(initial=0.0))
        return -1.0 / sharpest if sharpest < -1e-6 else None

    def classes(self, floors: bool) -> tuple[FloatArray, FloatArray]:
        """Wall angles (degrees) and their areas (mm^2), in classes; without floors unless they are asked for."""
        angles = np.degrees(self.slopes)
        low = 0.0 if floors else FLOOR_DEG
        kept = (angles >= low) & (angles < STEEP_DEG)
        number = np.floor(angles[kept] / BIN_DEG).astype(np.int64)
        areas: FloatArray = np.bincount(number, self.areas[kept]).astype(np.float64)
        means = np.bincount(number, self.areas[kept] * angles[kept]) / np.where(areas > 0.0, areas, 1.0)
        return means[areas > 0.0], areas[areas > 0.0]


def walls_of(job: Job, progress: Progress | None = None) -> Walls:
    """Looks at the faces that a job selects.

    Raises:
        GeometryError: the part keeps no arrays, or nothing that is selected looks up.
    """
    part = job.part(progress)
    if part.arrays is None:
        message = "a part made from arrays keeps none to look at: read it from a file"
        raise GeometryError(message, code="no-arrays", hint="use Part.read or Part.from_arrays")
    turn = np.array(_engine.Scene(job.engine, part.engine).frame)[:, :3]
    chosen = _selected(part.arrays, job.document)
    corners = part.arrays.vertices[part.arrays.triangles[chosen]] @ turn.T
    normals = part.arrays.normals[chosen] @ turn.T
    twice = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = 0.5 * np.linalg.norm(twice, axis=1)
    middle = normals.mean(axis=1)
    middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)
    up = (areas > 0.0) & (middle[:, 2] > 0.0)
    if not up.any():
        hint = "check setup.up and part.faces"
        raise GeometryError("no selected face looks up", code="no-faces", where="part.faces", hint=hint)
    corners, normals, middle = corners[up], normals[up], middle[up]
    slopes = np.arctan2(np.hypot(middle[:, 0], middle[:, 1]), middle[:, 2])
    crease = _crease(part.arrays.triangles[chosen][up], corners, middle)
    return Walls(slopes, areas[up], _bends(corners, normals, middle), crease)


def _selected(arrays: PartArrays, document: Document) -> npt.NDArray[np.bool_]:
    """Whether each triangle (T,) belongs to a selected face."""
    faces = document["part"].get("faces", "all")
    numbers = [int(found[1]) for name in faces if (found := re.fullmatch(r"Face(\d+)", str(name)))]
    if isinstance(faces, str) or not numbers:
        return np.ones(len(arrays.triangles), dtype=np.bool_)
    return np.isin(arrays.face_ids, numbers)


def _bends(corners: FloatArray, normals: FloatArray, middle: FloatArray) -> FloatArray:
    """Curvatures (N, 3) of the exact surface, from how its normals turn along the edges of each triangle."""
    level = np.stack([-middle[:, 1], middle[:, 0], np.zeros(len(middle))], axis=1)
    size = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(size > 1e-9, level / np.maximum(size, 1e-9), [1.0, 0.0, 0.0])
    steep = np.cross(level, middle)
    edges = np.roll(corners, -1, axis=1) - corners
    turns = np.roll(normals, -1, axis=1) - normals
    u, v = np.einsum("nek,nk->ne", edges, steep), np.einsum("nek,nk->ne", edges, level)
    known = np.einsum("nek,nek->ne", edges, turns)
    rows = np.stack([u * u, 2.0 * u * v, v * v], axis=2)
    length = np.maximum((edges**2).sum(axis=2), 1e-18)
    rows, known = rows / length[..., None], known / length
    sound = np.abs(np.linalg.det(rows)) > 1e-6
    bends = np.zeros((len(corners), 3))
    bends[sound] = np.linalg.solve(rows[sound], known[sound][..., None])[..., 0]
    return bends


def _crease(triangles: IntArray, corners: FloatArray, middle: FloatArray) -> float:
    """Length of the edges at which two triangles meet in a concave corner, mm."""
    pairs = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    key = np.sort(pairs, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, owner = key[order], owner[order]
    twin = np.flatnonzero((key[1:] == key[:-1]).all(axis=1))
    a, b = owner[twin], owner[twin + 1]
    angle = np.degrees(np.arccos(np.clip(np.einsum("nk,nk->n", middle[a], middle[b]), -1.0, 1.0)))
    across = corners[b].mean(axis=1) - corners[a].mean(axis=1)
    hollow = np.einsum("nk,nk->n", across, middle[b] - middle[a]) < 0.0
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).ravel()[order][twin]
    return float(lengths[hollow & (angle > CREASE_DEG)].sum())
