"""What a plan will take, estimated before it is made: from areas, distances and the size of the facets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from styluscam.programs.job import Job
from styluscam.types import Progress

LONG = 60.0
"""Seconds from which a plan is reported to take long."""

SECONDS_PER_POINT = {"zig-zag": 15e-6, "z-level": 80e-6}
"""On two threads of a machine of 2024, within a factor of three: levels look for each point, rows know where it is."""

SECONDS_PER_FACET = 5e-6
SECONDS_PER_NODE = 2e-6
NODES = 4e6
"""Nodes of the grid that finds levels, at most."""

UP = {"+x": (0, 1.0), "-x": (0, -1.0), "+y": (1, 1.0), "-y": (1, -1.0), "+z": (2, 1.0), "-z": (2, -1.0)}


@dataclass(frozen=True)
class Estimate:
    """What planning an operation will take, roughly. Lengths mm."""

    id: str
    kind: str
    length: float
    """Of the path over the part."""
    points: float
    """Moves of the program."""
    seconds: float
    pitch: tuple[str, float]
    """What decides: ``stepover`` or ``step``, and its value."""

    def sentence(self) -> str:
        """The estimate, and what shortens it."""
        key, value = self.pitch
        return (
            f"{self.id}: about {self.length / 1000.0:,.0f} m of path and {self.points:,.0f} moves, planned in about "
            f"{self.seconds / 60.0:,.0f} min. A {key} of {2.0 * value:g} mm (now {value:g} mm) halves that; "
            "a larger smallest_feature, a looser tolerance or fewer faces shorten it too"
        )


def estimate(job: Job, progress: Progress | None = None) -> list[Estimate]:
    """What planning each operation of a job will take; nothing for a part that is nothing but an engine's mesh."""
    arrays = job.part(progress).arrays
    if arrays is None:
        return []
    a, b, c = (arrays.vertices[arrays.triangles[:, k]] for k in range(3))
    double = np.cross(b - a, c - a)
    axis, sign = UP.get(str(job.document["setup"].get("up", "+z")), UP["+z"])
    upright = 0.5 * sign * double[:, axis]
    area = 0.5 * np.linalg.norm(double, axis=1)
    flat = np.delete(arrays.vertices, axis, axis=1)
    box = float(np.prod(np.ptp(flat, axis=0)))
    found = []
    for index, operation in enumerate(job.document["operations"]):
        selected = _selected(operation.get("faces", job.document["part"]["faces"]), arrays.face_ids) & (
            upright > -1e-9 * area
        )
        found.append(_of_operation(operation, index, upright[selected], area[selected], box))
    return found


def too_long(job: Job, progress: Progress | None = None) -> list[str]:
    """A sentence for each operation that will take long to plan."""
    return [each.sentence() for each in estimate(job, progress) if each.seconds > LONG]


def _selected(selection: object, face_ids: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """The triangles of faces that are named; all of them where a rule chooses."""
    if not isinstance(selection, list):
        return np.ones(len(face_ids), dtype=bool)
    numbers = [int(str(face).removeprefix("Face")) for face in selection if str(face).removeprefix("Face").isdecimal()]
    return np.isin(face_ids, numbers)


def _of_operation(
    operation: dict[str, Any],
    index: int,
    upright: npt.NDArray[np.float64],
    area: npt.NDArray[np.float64],
    box: float,
) -> Estimate:
    kind = str(operation["kind"])
    spacing = float(operation["smallest_feature"]) / np.sqrt(2.0)
    if kind == "z-level":
        key, pitch = "step", float(operation["step"]["height"])
        across = float(np.sqrt(np.maximum(area**2 - upright**2, 0.0)).sum())
        nodes = min(box / spacing**2, NODES)
    else:
        key, pitch = "stepover", float(operation["stepover"])
        across, nodes = float(upright.sum()), 0.0
    length = across / pitch
    # facets of this size take a chord or two; curved ones are small already
    facet = float(np.sqrt(2.0 * area.mean())) if len(area) else 1.0
    points = length / max(facet, 0.5 * spacing)
    seconds = points * SECONDS_PER_POINT.get(kind, SECONDS_PER_POINT["z-level"])
    seconds += SECONDS_PER_FACET * len(area) + SECONDS_PER_NODE * nodes
    name = str(operation.get("id") or f"{kind}-{index + 1}")
    return Estimate(name, kind, length, points, seconds, (key, pitch))
