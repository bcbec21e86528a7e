"""What a part and a job ask of a tool, as records for people and scripts."""

from __future__ import annotations

from dataclasses import dataclass

from styluscam.records import Record


@dataclass(frozen=True, slots=True, eq=False)
class OperationFacts(Record):
    """What an operation asks for: its passes in words, its faces."""

    id: str
    passes: str
    faces: list[int]
    area_mm2: float


@dataclass(frozen=True, slots=True, eq=False)
class WallShare(Record):
    """Share of the area near a wall angle."""

    angle_deg: float
    share: float


@dataclass(frozen=True, slots=True, eq=False)
class Facts(Record):
    """What a part and a job's passes ask of a tool."""

    passes: str
    """In words, of all operations."""
    operations: tuple[OperationFacts, ...]
    walls: tuple[WallShare, ...]
    floor_share: float
    smallest_concave_radius_mm: float | None
    fitting_radius_mm: float | None
    """Up to which a tool fits nearly all fillets and gaps; None where nothing bounds it."""
    sharp_concave_edges_mm: float
    """Their length."""
