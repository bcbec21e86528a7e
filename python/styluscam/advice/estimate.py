"""What a plan will take, estimated before it is made: from areas, distances and the size of the facets."""

from __future__ import annotations

import json
from dataclasses import dataclass

from styluscam.programs.job import Job
from styluscam.types import Progress

LONG = 60.0
"""Seconds from which a plan is reported to take long."""


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
    key: str
    """The key that decides: ``stepover`` or ``step``."""
    pitch: float
    """Its value."""

    def sentence(self) -> str:
        """The estimate, and what shortens it."""
        return (
            f"{self.id}: about {self.length / 1000.0:,.0f} m of path and {self.points:,.0f} moves, planned in about "
            f"{self.seconds / 60.0:,.0f} min. A {self.key} of {2.0 * self.pitch:g} mm (now {self.pitch:g} mm) halves that; "
            "a larger smallest_feature, a looser tolerance or fewer faces shorten it too"
        )


def estimate(job: Job, progress: Progress | None = None) -> list[Estimate]:
    """What planning each operation of a job will take; nothing for a part that is nothing but an engine's mesh."""
    part = job.part(progress)
    if part.arrays is None:
        return []
    return [Estimate(**one) for one in json.loads(job.engine.estimates(part.engine))]


def too_long(job: Job, progress: Progress | None = None) -> list[str]:
    """A sentence for each operation that will take long to plan."""
    return [each.sentence() for each in estimate(job, progress) if each.seconds > LONG]
