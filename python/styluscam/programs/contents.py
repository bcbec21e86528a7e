"""What a program states beside its moves, as records: lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

from styluscam.records import Record


@dataclass(frozen=True, slots=True, eq=False)
class ToolRecord(Record):
    """A tool of a program.

    Attributes:
        name: in its job.
        number: in the machine's tool table.
        length_offset: number of its length offset.
        description: what it is, for the operator.
        reference: which of its points is programmed: ``tip`` or ``center``.
        reference_height: of that point over the tip.
        diameter: the largest.
    """

    name: str
    number: int
    length_offset: int
    description: str
    reference: str
    reference_height: float
    diameter: float


@dataclass(frozen=True, slots=True, eq=False)
class OperationRecord(Record):
    """An operation of a program.

    Attributes:
        id: by which reports name it.
        kind: ``z-level``, ``zig-zag``...
        tool: index into the program's tools.
    """

    id: str
    kind: str
    tool: int


@dataclass(frozen=True, slots=True, eq=False)
class SetupRecord(Record):
    """Where a program's zero is, and what surrounds it.

    Attributes:
        title: of the job.
        wcs: work offset.
        zero: the zero point in words.
        part_min: lower corner of the part's box in work coordinates.
        part_max: the upper one.
        clearance: height at which rapids cross.
        notes: lines for the header.
    """

    title: str
    wcs: str
    zero: str
    part_min: list[float]
    part_max: list[float]
    clearance: float
    notes: list[str]
