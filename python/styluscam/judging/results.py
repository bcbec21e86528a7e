"""What verification finds, as records: findings, their groups, and what is left on each face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from styluscam.records import Record
from styluscam.types import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Finding(Record):
    """One thing that the verifier found in a text, with its worst point. Lengths mm.

    Attributes:
        kind: a stable name, as ``gouge``.
        severity: ``error``, ``warning`` or ``note``.
        line: of the worst point, from 1; 0 where it has none.
        first_line, last_line: over which it lasts.
        moves: how many, and length_mm: how long they are.
        position: of the tool's tip at the worst point, work coordinates; None where it has none.
        value_mm: the value where it is a length, else None.
        value: at the worst point, in ``unit``; None where nothing is measured.
        limit: what is allowed, in ``unit``.
        unit: of value and limit: mm, mm/min, rev/min, s or deg.
        message: what, where, why, what to do.
    """

    kind: str
    severity: str
    line: int
    first_line: int
    last_line: int
    moves: int
    length_mm: float
    position: list[float] | None
    value_mm: float | None
    value: float | None
    limit: float | None
    unit: str
    message: str


@dataclass(frozen=True, slots=True, eq=False)
class Group(Record):
    """Findings of a kind in one region of the part, by their worst one; attributes as those of :class:`Finding`.

    Attributes:
        count: findings in it.
        regions: separate ones of the part in which they lie; more than one where these are too many to be listed apart.
        box: around the tips at all of them, lower and upper corner, mm; None where there are none.
        findings: indices of those that the report lists.
    """

    kind: str
    severity: str
    count: int
    regions: int
    box: list[list[float]] | None
    line: int
    first_line: int
    last_line: int
    moves: int
    length_mm: float
    position: list[float] | None
    value: float | None
    limit: float | None
    unit: str
    message: str
    findings: list[int]


@dataclass(frozen=True, slots=True, eq=False)
class FaceCoverage(Record):
    """What a program leaves on a face.

    Attributes:
        face: its number.
        area: mm^2.
        flat: share of the area that needs no forming because the blank lies there.
        carried: share that needs none because it goes down flat with the passes around it.
        covered: share of the rest that the tool comes to.
        scallop: largest where it is covered, mm.
        mean: of the scallops, mm.
        left: most that is left, mm; None where nothing touches the face.
        at: where that is, work coordinates, mm; None where nothing touches it.
        points: looked at.
    """

    face: int
    area: float
    flat: float
    carried: float
    covered: float
    scallop: float
    mean: float
    left: float | None
    at: list[float] | None
    points: int

    @property
    def to_form(self) -> float:
        """The area that the tool must touch, mm^2."""
        return self.area * max(0.0, 1.0 - self.flat - self.carried)


@dataclass(frozen=True, slots=True, eq=False)
class Scallops(Record):
    """What stands between the neighbouring passes of an operation. Lengths mm.

    Attributes:
        operation: its id.
        heights: (N,), above the floor of the passes.
        points: (N, 3), where they are highest, work coordinates.
        steps: (N,), distance of the two passes in height, or across rows.
        lengths: (N,), of the ridge that each stands for.
    """

    operation: str
    heights: FloatArray
    points: FloatArray
    steps: FloatArray
    lengths: FloatArray

    @property
    def highest(self) -> float:
        """The highest, mm; 0 where there is none."""
        return float(self.heights.max(initial=0.0))

    def share_within(self, low: float, high: float) -> float:
        """The share of the ridges' length whose height lies between two heights, mm; 0 where there is none."""
        within = (self.heights >= low) & (self.heights <= high)
        return float(self.lengths[within].sum() / max(self.lengths.sum(), np.finfo(np.float64).tiny))
