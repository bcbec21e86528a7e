"""``styluscam post``: a program's text for a machine, whole or from somewhere on."""

from __future__ import annotations

import json as json_module
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files, posting
from styluscam.cli import console
from styluscam.cli.options import Debug, Force, Json, Quiet
from styluscam.cli.summary import shown_path
from styluscam.errors import JobError
from styluscam.machine import Machine
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
Air = Annotated[float, typer.Option("--air", metavar="MM", help="Everything so much higher, mm.", show_default=False)]
Stops = Annotated[bool, typer.Option("--optional-stops", help="An optional stop between operations.")]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="An option of the machine: units=inch.", show_default=False),
]
Cl = Annotated[bool, typer.Option("--cl", help="Write cutter locations (APT) in place of the machine's text.")]


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
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Post a program for a machine.

    The text is not judged: `styluscam verify` does that, and `styluscam run` writes nothing that it objects to.
    """
    if out.exists() and not force:
        raise JobError(
            f"{out} exists already", code="file-exists", where=str(out), hint="take another name, or --force"
        )
    files.require_writable([out], [program])
    target = Machine.find(machine).with_options(_options(options or []))
    source = posting.read_program(program, Machine.find(read_as) if read_as else None)
    edits = posting.Edits(start, air, optional_stops)
    work = posting.edited(source, target, edits)
    if cl:
        files.write_whole(out, posting.cl_text(work))
    else:
        posting.write(work, target, out)
    if json:
        console.say_json({"written": [str(out)], "machine": target.name, "moves": len(work.moves)})
    elif not quiet:
        console.say(f"written: {shown_path(out)} ({len(work.moves)} moves for {target.name}; not judged)")
    return 0


def _options(words: list[str]) -> Document:
    """``units=inch`` and the like; numbers and true or false are what they say."""
    options: Document = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name:
            raise JobError(f"--set {word}", code="usage", where="--set", hint="write NAME=VALUE, as in units=inch")
        try:
            options[name] = json_module.loads(value)
        except ValueError:
            options[name] = value
    return options
