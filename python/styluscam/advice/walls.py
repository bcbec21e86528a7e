"""What an operation's faces ask of a tool: how much of them has which wall angle, how hollow they are, and their corners.

The engine finds walls and corners. Their classes are made here: they are statistics of the advice alone, by which tools are
compared with a hundred walls instead of a hundred thousand triangles; nothing that is planned or checked depends on them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from styluscam import _engine
from styluscam.programs.job import Job
from styluscam.types import FloatArray, IntArray

FLOOR_DEG = 5.0
"""Flatter areas are floors: levels lie so far apart there that none of their scallops is a surface."""

STEEP_DEG = 89.0
"""Steeper walls are vertical to levels."""

BIN_DEG = 2.5
"""Width of the classes of wall angles."""

TURN_DEG = 7.5
"""Width of the classes of directions of rows against the wall."""

HOLLOW = 1e-6
"""Curvature (1/mm) from which a wall is hollow or round, not straight."""


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
    """(N,) rad: where the wall faces, from +X."""
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


def walls_of(job: Job, index: int, scene: _engine.Scene) -> Walls:
    """The walls of the faces that an operation of a job selects, and their corners, as the engine finds them.

    Raises:
        JobError: the operation names a face that the part does not have; nothing selected faces up (``no-faces``).
    """
    (slopes, azimuths, areas, bends, ids), corners = scene.walls(job.engine, index)
    return Walls(slopes, azimuths, areas, bends, Corners(*corners), ids)
