"""What an operation's faces ask of a tool: how much of them has which wall angle, how hollow they are, and their corners."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.errors import GeometryError, JobError
from styluscam.parts.arrays import PartArrays
from styluscam.programs.job import Job
from styluscam.types import Document, FloatArray, IntArray, Progress

FLOOR_DEG = 5.0
"""Flatter areas are floors: levels lie so far apart there that none of their scallops is a surface."""

STEEP_DEG = 89.0
"""Steeper walls are vertical to levels."""

BIN_DEG = 2.5
"""Width of the classes of wall angles."""

TURN_DEG = 7.5
"""Width of the classes of directions of rows against the wall."""

CREASE_DEG = 2.0
"""Faces that meet at more than this are not tangent to each other."""

STRAIGHT_DEG = 170.0
"""A corner that turns more than this is a slot: its two sides have no common middle."""

ALIKE_DEG = 2.0
"""Corners whose sides differ by less are one."""

HOLLOWS = 12
"""Points of each hollow face from which its fillet is followed to both ends."""

HOLLOW = 1e-6
"""Curvature (1/mm) from which a point is hollow."""

REACH = 2.6
"""Of the fillet's radius times the sine of half a turn: what lies farther off (2 on a circle) is another fillet."""

ASIDE = 0.05
"""Sine of the angle by which a normal may deviate from the section in which a fillet is followed."""


@dataclass(frozen=True, eq=False)
class Corners:
    """Concave corners, sharp or rounded: K pairs of planes between which the surface turns."""

    sides: FloatArray
    """(K, 2, 3) normals of the two planes."""
    radii: FloatArray
    """(K,) mm: of the fillet between them; 0 where they meet in an edge."""
    lengths: FloatArray
    """(K,) mm, along the corner."""


class Classes(NamedTuple):
    """The walls in C classes, each a mean over its area."""

    angles: FloatArray
    """(C,) degrees."""
    turns: FloatArray
    """(C,) degrees: of rows against the wall."""
    areas: FloatArray
    """(C,) mm^2."""
    up: FloatArray
    """(C,) 1/mm: curvature up the wall, positive where convex."""
    level: FloatArray
    """(C,) 1/mm: curvature along the level line."""


@dataclass(frozen=True, eq=False)
class Walls:
    """The faces of an operation by position: N triangles, in the setup's frame, that face up."""

    slopes: FloatArray
    """(N,) rad."""
    azimuths: FloatArray
    """(N,) rad: where the wall looks, from +X."""
    areas: FloatArray
    """(N,) mm^2."""
    bends: FloatArray
    """(N, 3) 1/mm: curvature up the wall, twist, curvature along the level line; positive where convex."""
    corners: Corners
    ids: IntArray
    """(N,) number of the face."""

    @property
    def faces(self) -> list[int]:
        """Numbers of the faces."""
        return [int(face) for face in np.unique(self.ids)]

    @property
    def area(self) -> float:
        """Of all of it, mm^2."""
        return float(self.areas.sum())

    @property
    def crease_mm(self) -> float:
        """Length of sharp concave edges, mm: no tool reaches into one."""
        return float(self.corners.lengths[self.corners.radii == 0.0].sum())

    @property
    def floor_share(self) -> float:
        """Share of the area that is flatter than a wall."""
        return float(self.areas[np.degrees(self.slopes) < FLOOR_DEG].sum() / self.area)

    @property
    def smallest_hollow_mm(self) -> float | None:
        """The smallest concave radius up the walls or along them, mm; None where nothing is concave."""
        sharpest = float(self.bends[:, (0, 2)].min(initial=0.0))
        return -1.0 / sharpest if sharpest < -HOLLOW else None

    def classes(self, rows_deg: float | None = None) -> Classes:
        """Wall angles, turns, areas and curvatures, in classes of angles and turns, hollow, straight and round areas apart.

        Levels (``rows_deg`` None) have no floors and no turns. For rows the turn is the angle in plan between the wall's
        uphill direction and the direction from row to row: 0 where rows run level along the wall, 90 where they climb it.
        """
        angles, turns = np.degrees(self.slopes), np.zeros(len(self.slopes))
        if rows_deg is not None:
            across = np.degrees(self.azimuths) - rows_deg - 90.0
            turns = np.abs((across + 90.0) % 180.0 - 90.0)
        kept = (angles >= (FLOOR_DEG if rows_deg is None else 0.0)) & (angles < STEEP_DEG)
        angles, turns, areas = angles[kept], turns[kept], self.areas[kept]
        bent = np.sign(np.round(self.bends[kept, 0] / HOLLOW))
        keys = np.stack([np.floor(angles / BIN_DEG), np.floor(turns / TURN_DEG), bent], axis=1)
        _, number = np.unique(keys, axis=0, return_inverse=True)
        number = number.reshape(-1)
        sums: FloatArray = np.bincount(number, areas).astype(np.float64)

        def mean(values: FloatArray) -> FloatArray:
            return np.asarray(np.bincount(number, areas * values) / sums)

        return Classes(mean(angles), mean(turns), sums, mean(self.bends[kept, 0]), mean(self.bends[kept, 2]))


def walls_of(job: Job, index: int, progress: Progress | None = None) -> Walls:
    """Looks at the faces that an operation of a job selects.

    Raises:
        JobError: it names a face that the part does not have.
        GeometryError: the part keeps no arrays, or nothing that is selected faces up.
    """
    part = job.part(progress)
    if part.arrays is None:
        message = "a part made from arrays keeps none to look at: read it from a file"
        raise GeometryError(message, code="no-arrays", hint="use Part.read or Part.from_arrays")
    turn = np.array(_engine.Scene(job.engine, part.engine).frame)[:, :3]
    chosen, key = _selected(part.arrays, job.document, index)
    corners = part.arrays.vertices[part.arrays.triangles] @ turn.T
    normals = part.arrays.normals @ turn.T
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    middle = _unit(normals.mean(axis=1))
    up = chosen & (areas > 0.0) & (middle[:, 2] > 0.0)
    if not up.any():
        hint = f"check setup.up and {key}"
        raise GeometryError("no selected face faces up", code="no-faces", where=key, hint=hint)
    bends = _bends(corners[up], normals[up], middle[up])
    ids = part.arrays.face_ids
    creases = _creases(part.arrays.triangles, corners, normals, up)
    fillets = _fillets((corners[up], normals[up]), middle[up], areas[up], bends, ids[up])
    return Walls(
        np.arctan2(np.hypot(middle[up, 0], middle[up, 1]), middle[up, 2]),
        np.arctan2(middle[up, 1], middle[up, 0]),
        areas[up],
        bends,
        _alike([*creases, *fillets]),
        ids[up],
    )


def _selected(arrays: PartArrays, document: Document, index: int) -> tuple[npt.NDArray[np.bool_], str]:
    """Whether each triangle (T,) belongs to a face of the operation, and the key that selects it."""
    faces, key = document["operations"][index].get("faces"), f"operations[{index}].faces"
    if faces is None:
        faces, key = document["part"].get("faces", "all"), "part.faces"
    if isinstance(faces, str):
        return np.ones(len(arrays.triangles), dtype=np.bool_), key
    known = np.unique(arrays.face_ids)
    numbers = []
    for number, name in enumerate(faces):
        found = re.fullmatch(r"(?:Face)?(\d+)", name)
        if found is None or int(found[1]) not in known:
            message, hint = f"the part has no face {name!r}", "see styluscam part show"
            raise JobError(message, code="no-such-face", where=f"{key}[{number}]", hint=hint)
        numbers.append(int(found[1]))
    return np.isin(arrays.face_ids, numbers), key


def _axes(middle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Up the wall and along the level line (N, 3) each: unit vectors in the surface."""
    level = np.stack([-middle[:, 1], middle[:, 0], np.zeros(len(middle))], axis=1)
    size = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(size > 1e-9, level / np.maximum(size, 1e-9), [1.0, 0.0, 0.0])
    return np.cross(level, middle), level


def _bends(corners: FloatArray, normals: FloatArray, middle: FloatArray) -> FloatArray:
    """Curvatures (N, 3) of the exact surface, from how its normals turn along the edges of each triangle."""
    steep, level = _axes(middle)
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


_Corner = tuple[FloatArray, float, float]
"""Two normals (2, 3), radius and length (mm) of a corner."""


def _creases(
    triangles: IntArray, corners: FloatArray, normals: FloatArray, chosen: npt.NDArray[np.bool_]
) -> list[_Corner]:
    """The edges at which two triangles, one of them selected at least, meet in a concave corner."""
    pairs = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    key = np.sort(pairs, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    twin = np.flatnonzero((key[order][1:] == key[order][:-1]).all(axis=1))
    first, second = order[twin], order[twin + 1]
    a, b = owner[first], owner[second]
    beside = _unit((normals + np.roll(normals, -1, axis=1)).reshape(-1, 3))
    looks = np.stack([beside[first], beside[second]], axis=1)
    angle = np.degrees(np.arccos(np.clip(np.einsum("nk,nk->n", looks[:, 0], looks[:, 1]), -1.0, 1.0)))
    across = corners[b].mean(axis=1) - corners[a].mean(axis=1)
    hollow = np.einsum("nk,nk->n", across, looks[:, 1] - looks[:, 0]) < 0.0
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).ravel()[first]
    kept = hollow & (angle > CREASE_DEG) & (chosen[a] | chosen[b])
    return [(sides, 0.0, float(length)) for sides, length in zip(looks[kept], lengths[kept], strict=True)]


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12))


def _fillets(
    mesh: tuple[FloatArray, FloatArray], middle: FloatArray, areas: FloatArray, bends: FloatArray, faces: IntArray
) -> list[_Corner]:
    """Hollow faces as corners: from some points of each, as far as the face turns to both sides of them.

    ``mesh`` holds corners and normals, (N, 3, 3) each.
    """
    steep, level = _axes(middle)
    values, vectors = np.linalg.eigh(np.stack([bends[:, (0, 1)], bends[:, (1, 2)]], axis=1))
    across = vectors[:, :1, 0] * steep + vectors[:, 1:, 0] * level
    bend, found = values[:, 0], []
    for face in np.unique(faces[bend < -HOLLOW]):
        own = np.flatnonzero((faces == face) & (bend < -HOLLOW))
        centres, looks = (array[own].reshape(-1, 3) for array in mesh)
        picked = own[:: -(-len(own) // HOLLOWS)]
        for i in picked:
            radius = -1.0 / float(bend[i])
            turn = np.arctan2(looks @ across[i], looks @ middle[i])
            beside = np.abs(looks @ np.cross(middle[i], across[i])) < ASIDE
            offsets = centres - mesh[0][i].mean(axis=0)
            along = np.hypot(offsets @ across[i], offsets @ middle[i])
            beside &= along < REACH * radius * np.abs(np.sin(0.5 * turn)) + 1e-3 * radius
            if not beside.any():
                continue
            turn, ends = turn[beside], looks[beside]
            angle = float(np.ptp(turn))
            if np.degrees(angle) > CREASE_DEG:
                length = float(areas[own].sum()) / len(picked) / (radius * angle)
                found.append((ends[[int(np.argmin(turn)), int(np.argmax(turn))]], radius, length))
    return found


def _alike(found: list[_Corner]) -> Corners:
    """Corners between planes of the same slopes, at the same angle and of the same radius, put together."""
    if not found:
        return Corners(np.zeros((0, 2, 3)), np.zeros(0), np.zeros(0))
    sides = np.stack([corner[0] for corner in found])
    radii, lengths = np.array([corner[1] for corner in found]), np.array([corner[2] for corner in found])
    slopes = np.sort(np.degrees(np.arccos(np.clip(sides[:, :, 2], -1.0, 1.0))), axis=1)
    angles = np.degrees(np.arccos(np.clip(np.einsum("nk,nk->n", sides[:, 0], sides[:, 1]), -1.0, 1.0)))
    size = np.log1p(radii) / 0.1
    keys = np.round(np.column_stack([slopes / ALIKE_DEG, angles / ALIKE_DEG, size]))
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    sums = np.bincount(number.reshape(-1), lengths)
    sharp = angles[first] < STRAIGHT_DEG
    return Corners(sides[first][sharp], radii[first][sharp], sums[sharp])
