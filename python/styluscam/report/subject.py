"""What a page shows: a program, and whatever is known around it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from styluscam.job import Job
from styluscam.judging import Report
from styluscam.machine import Machine
from styluscam.part import Part
from styluscam.picture import arrays_of, program_picture, program_png
from styluscam.program import RAPID, Program
from styluscam.report.findings import placed
from styluscam.report.surface import Surface
from styluscam.report.timing import end_times
from styluscam.tool import Tool
from styluscam.types import Document, FloatArray, IntArray

RAPIDS, UPRIGHT, CUT = 0, 1, 2
"""What moves are for, as a page colours them: rapids; straight down or up at a feed; any other at a feed."""

SAME = 1e-6
"""mm: as the judge tells a plunge from a cut."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A program read from a text, with the job, the part and the judgement where there are any.

    ``frame`` holds the rows (3, 4) from the part's coordinates to the program's.
    """

    title: str
    file: str
    program: Program
    machine: Machine
    job: Job | None = None
    part: Part | None = None
    frame: FloatArray = field(default_factory=lambda: np.eye(3, 4))
    report: Report | None = None

    @classmethod
    def judged(cls, report: Report, machine: Machine, file: str) -> Subject:
        """A judged text; ``file`` is its name."""
        job = report.job
        title = str(job.document["title"] or job.name)
        return cls(title, file, report.program, machine, job, job.part(), np.array(report.scene.frame), report)

    @cached_property
    def surface(self) -> Surface | None:
        """The part in the program's coordinates."""
        return None if self.part is None else Surface.of(arrays_of(self.part), self.frame)

    @cached_property
    def placed(self) -> IntArray:
        """The moves whose end is known, (N,)."""
        return np.flatnonzero(np.isfinite(self.program.positions).all(axis=1))

    @cached_property
    def ends(self) -> FloatArray:
        """Where those end, (N, 3), mm."""
        return self.program.positions[self.placed]

    @cached_property
    def times(self) -> FloatArray:
        """When, (N,), s, in whole microseconds."""
        return np.asarray(np.rint(end_times(self.program)[self.placed] * 1e6) / 1e6)

    @cached_property
    def kinds(self) -> IntArray:
        """What for, (N,): :data:`RAPIDS`, :data:`UPRIGHT` or :data:`CUT`."""
        way = np.diff(self.ends, axis=0, prepend=self.ends[:1])
        upright = (np.abs(way[:, :2]) <= SAME).all(axis=1)
        at_feed = np.where(upright, UPRIGHT, CUT)
        return np.where(self.program.moves["kind"][self.placed] == RAPID, RAPIDS, at_feed)

    @cached_property
    def findings(self) -> list[Document]:
        """What the judge found, each with its moment."""
        if self.report is None:
            return []
        return placed(self.report.findings, self.program.moves["line"][self.placed], self.ends, self.times)

    @cached_property
    def tools(self) -> list[tuple[Document, Tool | None]]:
        """The program's tools as it records them, with the job's where there is one."""
        known = self.job.tools() if self.job is not None else {}
        return [(record, known.get(str(record["name"]))) for record in self.program.tools]

    def draw(self, path: Path) -> None:
        """Writes a picture, PNG."""
        program_picture(self.part, self.program, path, self.frame, self._first_tool(), title=self.title)

    def png(self) -> bytes:
        """The same picture's bytes."""
        return program_png(self.part, self.program, self.frame, self._first_tool(), self.title)

    def _first_tool(self) -> Tool | None:
        return next((tool for _, tool in self.tools if tool is not None), None)
