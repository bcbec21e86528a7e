# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a tool is along an operation's path, by time or by length: the posted text of it, read back as the machine reads it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from . import documents, engine
from .verification import draft_of

if TYPE_CHECKING:
    from styluscam.report import Subject
    from styluscam.types import FloatArray


@dataclass(frozen=True)
class Moment:
    """The tool's tip (x, y, z) in document coordinates, mm; the feed there, mm/min, None of a rapid; the line of the text."""

    tip: tuple[float, float, float]
    feed: float | None
    line: int


@dataclass(frozen=True, eq=False)
class MotionTrack:
    """A path as positions over time and length."""

    subject: Subject

    @property
    def times(self) -> FloatArray:
        """When the tip is at each position, (N,), s, as the machine goes."""
        return self.subject.times

    @cached_property
    def lengths(self) -> FloatArray:
        """The length of the path to each position, (N,), mm; rapids count."""
        steps = np.diff(self.subject.positions, axis=0, prepend=self.subject.positions[:1])
        return np.asarray(np.cumsum(np.linalg.norm(steps, axis=1)))

    def at(self, along: FloatArray, value: float) -> Moment:
        """The moment at a time or a length; `along` is `times` or `lengths`."""
        from styluscam.programs.program import RAPID

        index = int(np.clip(np.searchsorted(along, value), 0, len(along) - 1))
        x, y, z = (float(np.interp(value, along, self.subject.positions[:, k])) for k in range(3))
        move = self.subject.moves[index]
        return Moment((x, y, z), None if move["kind"] == RAPID else float(move["feed"]), int(move["line"]))


def track_of(job: Any, operation: Any) -> MotionTrack:
    """The track of one operation.

    Raises:
        PostError, MotionError, ToolError, styluscam.StylusError: it cannot be posted, or has no moves.
    """
    from styluscam.report import Subject

    draft = draft_of(job, [operation], documents.machine_of(job))
    program = engine.styluscam().read_gcode(draft.text_to_verify(), draft.target)
    return MotionTrack(Subject(operation.Label, operation.Label, program, draft.target))
