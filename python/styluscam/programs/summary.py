"""What a plan amounts to, as records: lengths mm, times s, angles degrees, areas mm^2."""

from __future__ import annotations

from dataclasses import dataclass

from styluscam.records import Record
from styluscam.types import Document


@dataclass(frozen=True, slots=True, eq=False)
class ToolLine(Record):
    """A tool as the operator must find it.

    Attributes:
        number: in the tool table.
        length_offset: number of its length offset.
        description: what it is.
        reference: which of its points is programmed: ``tip``, or ``center, 5 above the tip``.
    """

    number: int
    length_offset: int
    description: str
    reference: str


@dataclass(frozen=True, slots=True, eq=False)
class Fact(Record):
    """A figure of an operation.

    Attributes:
        fact: a stable name, as ``levels``.
        value: how many, or how much in ``unit``.
        unit: empty for counts.
        words: the same in words.
    """

    fact: str
    value: float
    unit: str
    words: str


@dataclass(frozen=True, slots=True, eq=False)
class End(Record):
    """Where an operation ends although the tool could touch its faces farther down.

    Attributes:
        z: lowest tip.
        at_foot: whether that is the part's foot, and nothing that the job states.
        untouched: most of the faces' lowest parts that is touched only from farther down.
    """

    z: float
    at_foot: bool
    untouched: float


@dataclass(frozen=True, slots=True, eq=False)
class ReachedFace(Record):
    """What becomes of a face: areas by what the tool does there at the face's own slope.

    Attributes:
        face: its number.
        contact: it touches.
        bridged: it bridges.
        interferes: something beside is in its way.
        rim: it touches with its rim alone.
        undercut: the face faces down.
    """

    face: int
    contact: float
    bridged: float
    interferes: float
    rim: float
    undercut: float


@dataclass(frozen=True, slots=True, eq=False)
class BridgedFace(Record):
    """A face with positions that the tool cannot touch.

    Attributes:
        face: its number.
        excess: most that stays there.
        at: where, work coordinates.
    """

    face: int
    excess: float
    at: list[float]


@dataclass(frozen=True, slots=True, eq=False)
class OperationSummary(Record):
    """What an operation amounts to.

    Attributes:
        id: its name in the job.
        kind: as the job has it.
        words: its extent.
        facts: its figures.
    """

    id: str
    kind: str
    words: str
    facts: list[Fact]


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceSummary(OperationSummary):
    """An operation whose tool follows faces.

    Attributes:
        faces: their numbers.
        wall_angle_max_deg: the largest wall angle of those faces.
        ends: where it ends although the tool could touch the faces farther down; None where it does not.
        reached: what becomes of each face.
        reached_coarsely: size of the triangles from which that is estimated; None where it is as fine as meant.
        bridged: faces with positions that the tool cannot touch, worst first.
        undercut: number and area of faces that face down in part.
    """

    faces: list[int]
    wall_angle_max_deg: float
    ends: End | None
    reached: list[ReachedFace]
    reached_coarsely: float | None
    bridged: list[BridgedFace]
    undercut: list[list[float]]


@dataclass(frozen=True, slots=True, eq=False)
class Summary(Record):
    """A job in numbers.

    Attributes:
        zero: the zero point, in words.
        wcs: the work offset.
        part_min, part_max: corners of the part's box, work coordinates.
        stock: the stock, in words; None where the job states none.
        deepest_z: lowest posted coordinate at feed, of the programmed point.
        machine: its name.
        units: ``mm`` or ``inch``: of the text.
        tools: in their order.
        changes: what was changed of the part in the file before it was planned.
        operations: in their order; :class:`SurfaceSummary` where the tool follows faces.
        length: at feed.
        duration: of the whole program.
        accelerates: whether the machine's acceleration is counted in it.
        tessellation: checked deviation of the part's triangles, inward and outward.
        gouge_max: deepest gouge in the verified text; None before it is verified.
        excess_max: largest excess along its contact tracks; None before.
        ok: whether the verifier found nothing; None before.
    """

    zero: str
    wcs: str
    part_min: list[float]
    part_max: list[float]
    stock: str | None
    deepest_z: float
    machine: str
    units: str
    tools: list[ToolLine]
    changes: list[Fact]
    operations: list[OperationSummary]
    length: float
    duration: float
    accelerates: bool
    tessellation: list[float]
    gouge_max: float | None
    excess_max: float | None
    ok: bool | None

    @classmethod
    def of(cls, document: Document) -> Summary:
        """From what the engine reports."""
        tools = [ToolLine(**tool) for tool in document["tools"]]
        operations = [_operation(operation) for operation in document["operations"]]
        changes = [Fact(**change) for change in document["changes"]]
        return cls(**{**document, "tools": tools, "changes": changes, "operations": operations})


def _operation(document: Document) -> OperationSummary:
    facts = [Fact(**fact) for fact in document["facts"]]
    if "faces" not in document:
        return OperationSummary(**{**document, "facts": facts})
    ends = document["ends"]
    typed = {
        "facts": facts,
        "ends": None if ends is None else End(**ends),
        "reached": [ReachedFace(**face) for face in document["reached"]],
        "bridged": [BridgedFace(**face) for face in document["bridged"]],
    }
    return SurfaceSummary(**{**document, **typed})
