"""Programs: moves and events, machine-independent."""

from __future__ import annotations

import json
from functools import cached_property

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, file_of, refused
from styluscam.errors import JobError
from styluscam.files import read_text, write_whole
from styluscam.programs.contents import OperationRecord, SetupRecord, ToolRecord
from styluscam.programs.machine import Machine, MachineLike
from styluscam.types import Document, FloatArray
from styluscam.words import clock, counted

MOVE = np.dtype(
    [
        ("kind", "u1"),
        ("end", "f8", 3),
        ("axis", "f8", 3),
        ("centre", "f8", 3),
        ("plane", "u1"),
        ("turns", "u4"),
        ("feed", "f8"),
        ("feed_mode", "u1"),
        ("role", "u1"),
        ("operation", "u4"),
        ("tool", "u4"),
        ("line", "u4"),
    ],
)
RAPID, FEED, CLOCKWISE, COUNTERCLOCKWISE = 0, 1, 2, 3
"""Kinds of moves: rapids, lines and arcs at a feed."""
ROLES = (None, "cut", "lead", "ramp", "link")
"""Names of a move's role by its number; a text states them in remarks, `(role lead)`, and none where it has none."""
SAG = 0.001
"""How far the polyline of :attr:`Program.positions` may be from an arc, mm."""


class Program:
    """Lines and arcs of the tool's tip in work coordinates, and what happens between them."""

    def __init__(self, engine: _engine.Program) -> None:
        """Programs come from :meth:`load`, :meth:`from_json`, :func:`styluscam.plan` and :func:`styluscam.read_gcode`."""
        if not isinstance(engine, _engine.Program):
            raise refused("program", engine, "a program of the engine", JobError, "Program.load(path) reads a file")
        self.engine = engine
        events, tools, operations, setup = json.loads(engine.records())
        self.events: list[Document] = events
        """In order: each has ``before`` (the index of the next move) and ``kind``, and what its kind states."""
        self.tools = [ToolRecord(**tool) for tool in tools]
        self.operations = [OperationRecord(**operation) for operation in operations]
        self.setup = SetupRecord(**setup)

    def __repr__(self) -> str:
        """How many moves it has, how long it is and how long it takes."""
        return f"<Program: {self.extent}>"

    @property
    def extent(self) -> str:
        """Operations, moves, length and time in words."""
        operations, moves = counted(len(self.operations), "operation"), counted(self.engine.move_count, "move")
        return f"{operations}, {moves}, {self.length:.0f} mm at feed, {clock(self.duration)}"

    def __eq__(self, other: object) -> bool:
        """Whether all moves, events and records are the same."""
        return self.engine.to_json() == other.engine.to_json() if isinstance(other, Program) else NotImplemented

    def __hash__(self) -> int:
        """As equality compares, by count and length of the moves."""
        return hash((self.engine.move_count, *self.engine.statistics()))

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        return {"engine": self.engine.to_json()}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        Program.__init__(self, _engine.Program.from_json(state["engine"]))

    @cached_property
    def moves(self) -> npt.NDArray[np.void]:
        """Structured array of :data:`MOVE`, one element for each move.

        ``kind`` (:data:`RAPID` to :data:`COUNTERCLOCKWISE`), ``end`` (position of the tip, mm) and ``axis`` (the tool's axis
        there, a unit vector from the tip up), ``feed`` with its ``feed_mode`` (94: mm/min; 95: mm/rev; 93: 1/min),
        ``role`` (:data:`ROLES`), ``operation`` and ``tool`` (indices into :attr:`operations` and :attr:`tools`), ``line``
        of the text (0: none). Of arcs also ``centre`` (mm; NaN of other moves), ``plane`` (17, 18 or 19, as in G17) and
        ``turns`` beyond the first.
        """
        columns = self.engine.columns()
        moves = np.zeros(len(columns[0]), dtype=MOVE)
        for name, column in zip(MOVE.names or (), columns, strict=True):
            moves[name] = column
        return moves

    @cached_property
    def polyline(self) -> tuple[FloatArray, npt.NDArray[np.uint32]]:
        """Points along the program, (M, 3), mm, and the index of the move that each belongs to, (M,).

        The ends of all moves, and along arcs as many more as keep every chord within :data:`SAG` of them.
        """
        return self.engine.polyline(SAG)

    @property
    def positions(self) -> FloatArray:
        """The points of :attr:`polyline`, (M, 3), mm: without arcs the ends of all moves."""
        return self.polyline[0]

    @property
    def length(self) -> float:
        """Path length at feed, mm."""
        return self.engine.statistics()[0]

    @property
    def duration(self) -> float:
        """Time at the programmed feeds, rapids at 3000 mm/min, s; acceleration is not counted."""
        return self.engine.statistics()[1]

    def times(self, machine: MachineLike) -> FloatArray:
        """The time at the end of every move on a machine, (N,), s, with its acceleration and its rate of blocks.

        What the machine file does not state is taken for unlimited. Tool changes and the path to the first position count 0.
        """
        return self.engine.times(Machine.of(machine).engine)[0]

    def with_notes(self, notes: list[str]) -> Program:
        """The same program with these lines in its header."""
        if isinstance(notes, str) or not all(isinstance(note, str) for note in notes):
            raise refused("notes", notes, "a list of lines", JobError)
        return Program(self.engine.with_notes(notes))

    @classmethod
    def from_path(cls, sections: list[tuple[str, str | None, str, str]], tools: str, setup: str) -> Program:
        """From FreeCAD's path commands, object by object.

        A section is a label, an operation's kind (None for what is no operation), the coolant around it ("None",
        "Flood" or "Mist"), and what ``Path.toGCode()`` gives (mm, mm/s). ``tools`` (records) and ``setup`` (a record) are
        JSON. Codes that nobody knows are kept as they stand, as long as they move no axis.

        Raises:
            JobError: a command that cannot be read; the message names its section.
        """
        return cls(_engine.program_of_path(sections, tools, setup))

    def path_text(self) -> str:
        """The moves as FreeCAD's path commands, one a line, for its ``Path.Path(text)`` (mm, mm/s, six decimals).

        Arcs are G2 and G3, with G18 and G19 where they turn in another plane. Where the tool leans, straight moves state its axis
        by the unit vector I, J, K. What happens between the moves is left out.

        Raises:
            JobError: an arc of a tool that leans, or with an unknown start, or a feed that is not in mm/min.
        """
        return _engine.path_text(self.engine)

    def save(self, path: FileName) -> None:
        """Writes the program as JSON, whole or not at all."""
        write_whole(file_of(path, "path", A_FILE, JobError), self.engine.to_json())

    @classmethod
    def from_json(cls, text: str) -> Program:
        """From a program document.

        Raises:
            JobError: it is none.
        """
        if not isinstance(text, str):
            raise refused("text", text, "the text of a program document", JobError)
        return cls(_engine.Program.from_json(text))

    @classmethod
    def load(cls, path: FileName) -> Program:
        """Reads what :meth:`save` wrote."""
        return cls.from_json(read_text(file_of(path, "path", A_FILE, JobError), JobError))
