"""What a page shows: a program, and whatever is known around it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.drawing.picture import arrays_of, program_picture, program_png
from styluscam.drawing.shapes import Around, Opposite, Travel, opposite_of, shapes_of, standing
from styluscam.judging.verification import Report
from styluscam.parts.part import Part
from styluscam.programs.contents import ToolRecord
from styluscam.programs.job import Job
from styluscam.programs.machine import Machine
from styluscam.programs.program import RAPID, Program
from styluscam.report.findings import placed, verdict_of
from styluscam.report.surface import Surface
from styluscam.tools.tool import Tool
from styluscam.types import Document, FloatArray, IntArray

LEANS = 1e-9
"""Sine of the angle by which a tool's axis may differ from +Z: rounding only."""

RAPIDS, UPRIGHT, CUT = 0, 1, 2
"""What moves are for, as a page colours them: rapids; straight down or up at a feed; any other at a feed."""

MOMENTS = 48
"""At which the sheet is looked at while it is formed."""

TRACED = "RS-274NGC, traced"
"""The reader of a text that is no machine's."""

SAME = 1e-6
"""mm: as the verifier distinguishes a plunge from a cut."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A program read from a text, with the job, the part and the report where there are any.

    ``gaps`` states in sentences what is not shown of a text that no machine read but the language's tracer; times are
    those of ``machine`` then too. ``frame`` holds the rows (3, 4) from the part's coordinates to the program's.
    """

    title: str
    file: str
    program: Program
    machine: Machine
    job: Job | None = None
    part: Part | None = None
    frame: FloatArray = field(default_factory=lambda: np.eye(3, 4))
    report: Report | None = None
    gaps: tuple[str, ...] | None = None
    scene: _engine.Scene | None = None

    @property
    def reader(self) -> str:
        """Who read the text: a machine's name, or :data:`TRACED`."""
        return self.machine.name if self.gaps is None else TRACED

    @classmethod
    def judged(cls, report: Report, machine: Machine, file: str) -> Subject:
        """A verified text; ``file`` is its name."""
        job = report.job
        title = str(job.document["title"] or job.name)
        frame = np.array(report.scene.frame)
        return cls(title, file, report.program, machine, job, job.part(), frame, report, scene=report.scene)

    @cached_property
    def surface(self) -> Surface | None:
        """The part in the program's coordinates."""
        return None if self.part is None else Surface.of(arrays_of(self.part), self.frame)

    @cached_property
    def around(self) -> Around:
        """The sheet of the job, flat and formed, what holds it, the die, and the tool on the other side."""
        if self.scene is None or self.job is None:
            return Around()
        return Around(shapes_of(self.job, self.scene), self._opposite())

    def _opposite(self) -> Opposite | None:
        """The tool of the text beside which this one was verified."""
        if self.report is None or self.report.beside is None or self.job is None:
            return None
        partner = self.job.engine.partner_of(self.report.channel)
        if partner is None:
            return None
        machine = self.job.machine(partner).engine
        other = Program(_engine.read_back(self.job.engine, machine, self.report.beside, partner))
        return opposite_of(self.job, self.report.channel, self.program, other)

    @cached_property
    def opposite_tips(self) -> FloatArray:
        """Where the tip of the other side's tool is at each point of the path, (N, 3), mm; (0, 3) where there is none."""
        if self.around.opposite is None:
            return np.zeros((0, 3))
        ends = self.around.opposite.tips(self.owners)
        starts = self.around.opposite.tips(np.maximum(self.owners - 1, 0))
        return np.asarray(starts + self._shares[:, None] * (ends - starts))

    @cached_property
    def standing(self) -> tuple[IntArray, FloatArray] | None:
        """The sheet as it stands behind points of the path (K,): its vertices above their formed height, (K, V), mm.

        None without a sheet, and for a tool from below.
        """
        if not self.around.shapes or self.scene is None or self.job is None or not len(self.positions):
            return None
        last = len(self.times) - 1
        even = np.searchsorted(self.times, np.linspace(0.0, self.times[-1], MOMENTS + 1))
        moments = np.unique(np.append(even.clip(0, last), last)).astype(np.int64)
        loaded = self.moves["tool"].astype(np.int64)
        loaded[loaded >= len(self.tools)] = -1
        travel = Travel(self.positions, [tool for _, tool in self.tools], loaded)
        heights = standing(self.job, self.scene, travel, moments)
        return None if heights is None else (moments, heights)

    @cached_property
    def _known(self) -> IntArray:
        """The points of the program's polyline that are known, (N,)."""
        return np.flatnonzero(np.isfinite(self.program.positions).all(axis=1))

    @cached_property
    def positions(self) -> FloatArray:
        """Along the path, (N, 3), mm: the ends of the moves, and between those of arcs."""
        return self.program.positions[self._known]

    @cached_property
    def owners(self) -> IntArray:
        """The move that leads to each point, (N,): an index that rises."""
        return self.program.polyline[1][self._known].astype(np.int64)

    @cached_property
    def moves(self) -> npt.NDArray[np.void]:
        """The program's record of that move, (N,)."""
        return self.program.moves[self.owners]

    @property
    def leans(self) -> bool:
        """Whether the tool's axis is anywhere another than +Z."""
        return bool((np.abs(self.program.moves["axis"][:, :2]) > LEANS).any())

    @cached_property
    def times(self) -> FloatArray:
        """When the tip is there, (N,), s, in whole microseconds; along an arc by its length."""
        if not len(self.positions):
            return np.zeros(0)
        ends = np.append(0.0, self.program.times(self.machine))
        times = ends[self.owners] + self._shares * (ends[self.owners + 1] - ends[self.owners])
        return np.asarray(np.rint(times * 1e6) / 1e6)

    @cached_property
    def _shares(self) -> FloatArray:
        """The share of its move that is behind each point, (N,), by length."""
        length_to = np.cumsum(np.linalg.norm(np.diff(self.positions, axis=0, prepend=self.positions[:1]), axis=1))
        last = np.searchsorted(self.owners, self.owners, side="right") - 1
        first = np.searchsorted(self.owners, self.owners) - 1
        begins = np.where(first >= 0, length_to[first], 0.0)
        length = length_to[last] - begins
        return np.asarray(np.divide(length_to - begins, length, out=np.ones(len(length_to)), where=length > 0.0))

    @cached_property
    def kinds(self) -> IntArray:
        """What the move is for, (N,): :data:`RAPIDS`, :data:`UPRIGHT` or :data:`CUT`."""
        steps = np.diff(self.positions, axis=0, prepend=self.positions[:1])
        upright = (np.abs(steps[:, :2]) <= SAME).all(axis=1)
        return np.where(self.moves["kind"] == RAPID, RAPIDS, np.where(upright, UPRIGHT, CUT))

    @cached_property
    def findings(self) -> list[Document]:
        """What verification found, each with its moment."""
        if self.report is None:
            return []
        return placed(self.report.findings, self.moves["line"], self.positions, self.times)

    @cached_property
    def tools(self) -> list[tuple[ToolRecord, Tool | None]]:
        """The program's tools as it records them, with the job's where there is one."""
        known = self.job.tools() if self.job is not None else {}
        return [(record, known.get(record.name)) for record in self.program.tools]

    def draw(self, path: Path) -> None:
        """Writes a picture, PNG."""
        program_picture(
            self.part, self.program, path, self.frame, self._first_tool(), title=self._heading(), around=self.around
        )

    def png(self) -> bytes:
        """The same picture's bytes."""
        return program_png(
            self.part, self.program, self.frame, self._first_tool(), title=self._heading(), around=self.around
        )

    def _heading(self) -> str:
        """The title, and the verdict where it is one to know before anything else."""
        if self.report is None or not self.report.findings:
            return self.title
        return f"{self.title}: {verdict_of(self.report).headline.lower()}"

    def _first_tool(self) -> Tool | None:
        return next((tool for _, tool in self.tools if tool is not None), None)
