"""Posting a program that stands: parts of it, in the air, with stops, as a controller's text or as cutter locations."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from styluscam import _engine
from styluscam.errors import JobError
from styluscam.files import all_drawn_whole, read_gcode_text
from styluscam.programs.machine import Machine
from styluscam.programs.program import Program

VERDICT = "judged from this text"
"""How the note begins that belongs to the text which was verified, and to no other."""
ON_ANOTHER = "judged, not this text"
"""Replaces it, with as many letters."""
NOT_JUDGED = "this text was not judged"


@dataclass(frozen=True)
class Edits:
    """What is to be changed in a program before it is posted."""

    start: str = ""
    """Where to begin: ``L120``, a line of the whole program's text; an operation's id; ``ID:2``, its second level."""
    air_mm: float = 0.0
    """How much higher everything is, mm."""
    optional_stops: bool = False
    """Whether an optional stop stands before every operation but the first."""


def read_program(path: Path, machine: Machine | None, target: Machine) -> Program:
    """A program document (.json), or G-code as ``machine`` reads it, to be posted for ``target``."""
    if path.suffix.lower() == ".json":
        return Program.load(path)
    if machine is None:
        raise JobError(
            f"{path} is no program document (.json)",
            code="post-input",
            where=str(path),
            hint="for G-code name its machine with --as",
        )
    return Program(_engine.read_to_post(read_gcode_text(path), machine.engine, target.engine))


def edited(program: Program, machine: Machine, edits: Edits) -> Program:
    """The program with its edits; its header states them.

    Raises:
        JobError: there is no such line, operation or level, or the program cannot begin there.
    """
    notes = _not_judged(program.setup.notes)
    program = program.with_notes(notes)
    engine = program.engine
    if edits.start:
        first = _first_move(program, machine, edits.start)
        restarted = engine.restarted(first)
        if restarted is None:
            raise _no_start(
                edits.start, "the program cannot begin there: it is its very start, or inside a canned cycle"
            )
        engine = restarted
        notes.append(f"RESTART at {edits.start}: what was judged is the whole program, not this part")
    if edits.optional_stops:
        engine = engine.with_optional_stops()
    if edits.air_mm:
        engine = engine.raised(edits.air_mm)
        notes.append(f"AIR CUT: everything is {edits.air_mm:g} mm higher")
    return Program(engine.with_notes(notes))


def _not_judged(notes: list[str]) -> list[str]:
    """The notes with what is true of a new text instead of the verdict on another: lines are counted alike."""
    kept = [note.replace(VERDICT, ON_ANOTHER, 1) if note.startswith(VERDICT) else note for note in notes]
    return kept if kept != notes else [*kept, NOT_JUDGED]


def write(programs: dict[Path, tuple[Program, Machine]]) -> None:
    """Posts to files piece by piece: no text is ever whole in memory, and the files appear whole, all or none."""
    with all_drawn_whole(programs) as temporaries:
        for (program, machine), temporary in zip(programs.values(), temporaries, strict=True):
            _engine.post_to(program.engine, machine.engine, str(temporary))


def paired(program: Program, support: Program) -> tuple[Program, Program]:
    """Two programs that wait for one another before every operation: those of double-sided forming.

    Raises:
        JobError: they have not equally many operations.
    """
    pair = program.engine.paired(support.engine)
    if pair is None:
        raise JobError(
            f"the programs have {len(program.operations)} and {len(support.operations)} operations",
            code="post-pair",
            where="--support",
            hint="a pair has the same operations in the same order",
        )
    return Program(pair[0]), Program(pair[1])


def cl_text(program: Program) -> str:
    """Cutter location text (APT), mm; arcs as points within 0.001 mm."""
    return _engine.cl_text(program.engine)


def _first_move(program: Program, machine: Machine, start: str) -> int:
    line = re.fullmatch(r"[Ll](\d+)", start)
    if line:
        return _move_at_line(program, machine, int(line.group(1)), start)
    ids = [operation.id for operation in program.operations]
    name, _, level = start.rpartition(":") if start not in ids else (start, "", "")
    if name not in ids or (level and not level.isdigit()):
        raise _no_start(start, f"the program has no operation of this name; it has {', '.join(ids)}")
    operation = ids.index(name)
    if level:
        first = program.engine.level_start(operation, int(level))
        if first is None:
            raise _no_start(start, f"operation {name} has no level {level}")
        return first
    operations = program.moves["operation"]
    return int((operations == operation).argmax())


def _move_at_line(program: Program, machine: Machine, line: int, start: str) -> int:
    """The first move that arrives at this line of the whole text or after it."""
    lines = _engine.lines_of_moves(program.engine, machine.engine)
    for index, arrives in enumerate(lines):
        if arrives >= line:
            return index
    raise _no_start(start, "the program's last move comes before this line")


def _no_start(start: str, message: str) -> JobError:
    return JobError(f"{start}: {message}", code="post-start", where="--from", hint="give L and a line, or an operation")
