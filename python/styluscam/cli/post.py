"""``styluscam post``: a program's text for a machine, whole or from somewhere on."""

from __future__ import annotations

import json as json_module
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.cli import console
from styluscam.cli.options import Debug, Force, Json, Quiet
from styluscam.cli.summary import shown_path
from styluscam.errors import JobError
from styluscam.programs import posting
from styluscam.programs.machine import Machine
from styluscam.types import Document

Source = Annotated[
    Path,
    typer.Argument(metavar="PROGRAM.json|FILE.ngc", help="A program, or G-code (with --as).", show_default=False),
]
For = Annotated[
    str, typer.Option("--machine", "-m", metavar="NAME|FILE", help="The machine to post for.", show_default=False)
]
As = Annotated[
    str | None,
    typer.Option("--as", metavar="NAME|FILE", help="The machine that the G-code was for.", show_default=False),
]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="The file to write.", show_default=False)]
Start = Annotated[
    str,
    typer.Option(
        "--from",
        metavar="L120|ID|ID:LEVEL",
        help="Begin at a line of the whole text, an operation, or a level of it.",
        show_default=False,
    ),
]
Air = Annotated[float, typer.Option("--air", metavar="MM", help="Raise all moves by this, mm.", show_default=False)]
Stops = Annotated[bool, typer.Option("--optional-stops", help="An optional stop between operations.")]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="An option of the machine: units=inch.", show_default=False),
]
Support = Annotated[
    Path | None,
    typer.Option(
        "--support",
        metavar="PROGRAM.json",
        help="Program of the second channel, synchronised with this one.",
        show_default=False,
    ),
]
SupportMachine = Annotated[
    str | None,
    typer.Option(
        "--support-machine",
        metavar="NAME|FILE",
        help="Machine of the second program (default: the same).",
        show_default=False,
    ),
]
SupportOut = Annotated[
    Path | None,
    typer.Option(
        "--support-out", metavar="FILE", help="The file for the text of the second program.", show_default=False
    ),
]
Cl = Annotated[bool, typer.Option("--cl", help="Write cutter locations (APT) instead of the machine's text.")]

HIGHEST = 1000.0
"""mm: above the work there is no more air."""


def post(
    program: Source,
    machine: For,
    out: Out,
    *,
    read_as: As = None,
    start: Start = "",
    air: Air = 0.0,
    optional_stops: Stops = False,
    options: Set = None,
    cl: Cl = False,
    support: Support = None,
    support_machine: SupportMachine = None,
    support_out: SupportOut = None,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Post a program for a machine.

    The text is not verified: `styluscam verify` does that, and `styluscam run` writes only verified text.
    """
    _require_agreement(air, support, support_out, is_part=bool(start or air or cl))
    outputs = [path for path in (out, support_out) if path is not None]
    for path in outputs:
        files.require_new(path, force, JobError, "choose another name")
    files.require_writable(outputs, [path for path in (program, support) if path is not None])
    target = Machine.find(machine).with_options(_options(options or []))
    source = posting.read_program(program, Machine.find(read_as) if read_as else None, target)
    edits = posting.Edits(start, air, optional_stops)
    work = posting.edited(source, target, edits)
    if cl:
        files.write_whole(out, posting.cl_text(work))
    elif support is not None and support_out is not None:
        partner = Machine.find(support_machine) if support_machine else target
        work, other = posting.paired(work, posting.read_program(support, None, partner))
        posting.write({out: (work, target), support_out: (other, partner)})
    else:
        posting.write({out: (work, target)})
    if json:
        console.say_json({"written": [str(path) for path in outputs], "machine": target.name, "moves": len(work.moves)})
    elif not quiet:
        names = ", ".join(shown_path(path) for path in outputs)
        console.say(f"written: {names} ({len(work.moves)} moves for {target.name}; not verified)")
    return 0


def _require_agreement(air: float, support: Path | None, support_out: Path | None, *, is_part: bool) -> None:
    """Refuses options that contradict each other; `is_part`: not the whole program as it is, as the machine's text.

    Raises:
        JobError: they do, or `air` (mm) is out of range.
    """
    if not 0.0 <= air <= HIGHEST:
        raise JobError(
            f"--air {air:g} is out of range", code="usage", where="--air", hint=f"give a height of 0 to {HIGHEST:g} mm"
        )
    if support is not None and is_part:
        raise JobError(
            "two synchronised programs are posted whole, as the machines' text",
            code="usage",
            where="--support",
            hint="leave --from, --air and --cl out",
        )
    if (support is None) != (support_out is None):
        raise JobError(
            "two synchronised programs need two output files",
            code="usage",
            where="--support",
            hint="give --support and --support-out",
        )


def _options(words: list[str]) -> Document:
    """``units=inch`` and the like; numbers, true and false are read as such."""
    options: Document = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name:
            raise JobError(
                f"--set {word}: an option and its value expected",
                code="usage",
                where="--set",
                hint="write NAME=VALUE, as in units=inch",
            )
        try:
            options[name] = json_module.loads(value)
        except ValueError:
            options[name] = value
    return options
