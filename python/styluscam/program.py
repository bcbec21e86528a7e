"""Programs: moves and events, machine-independent."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.errors import JobError
from styluscam.files import read_text, write_whole
from styluscam.types import Document, FloatArray

MOVE = np.dtype(
    [("kind", "u1"), ("end", "f8", 3), ("feed", "f8"), ("operation", "u4"), ("line", "u4")],
)
RAPID, FEED = 0, 1
"""Kinds of moves."""


class Program:
    """Straight moves of the tool's tip in work coordinates, and what happens between them."""

    def __init__(self, engine: _engine.Program) -> None:
        self.engine = engine
        self.events: list[Document]
        self.tools: list[Document]
        self.operations: list[Document]
        self.setup: Document
        self.events, self.tools, self.operations, self.setup = json.loads(engine.records())

    @cached_property
    def moves(self) -> npt.NDArray[np.void]:
        """Structured array of :data:`MOVE`: kind, end (mm), feed (mm/min), operation, line of the text (0: none)."""
        kind, end, feed, operation, line = self.engine.columns()
        moves = np.zeros(len(kind), dtype=MOVE)
        for name, column in zip(MOVE.names or (), (kind, end, feed, operation, line), strict=True):
            moves[name] = column
        return moves

    @property
    def positions(self) -> FloatArray:
        """The polyline of all moves' ends, (N, 3), mm."""
        ends: FloatArray = self.moves["end"]
        return ends

    @property
    def length(self) -> float:
        """Path length at feed, mm."""
        return self.engine.statistics()[0]

    @property
    def duration(self) -> float:
        """Time at the programmed feeds, rapids at 3000 mm/min, s; acceleration is not counted."""
        return self.engine.statistics()[1]

    def save(self, path: str | Path) -> None:
        """Writes the program as JSON, whole or not at all."""
        write_whole(Path(path), self.engine.to_json())

    @classmethod
    def load(cls, path: str | Path) -> Program:
        """Reads what :meth:`save` wrote."""
        text = read_text(path, JobError)
        return cls(_engine.Program.from_json(text))
