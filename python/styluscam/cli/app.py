"""The commands, and what every one of them has in common: exit codes, errors in one line, a clean stdout."""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Annotated, NoReturn

import typer

from styluscam._engine import __version__
from styluscam.cli import (
    compare,
    console,
    doctor,
    freecad,
    machine,
    material,
    new,
    part,
    plan,
    post,
    run,
    schema,
    suggest,
    tool,
    verify,
    view,
)
from styluscam.cli.failures import failure_of
from styluscam.errors import StylusError

app = typer.Typer(
    name="styluscam",
    help="Toolpaths for tools of any convex shape: from CAD faces to verified G-code.",
    epilog="Exit codes: 0 done, 1 verification found an error, 2 the input is wrong, 3 cancelled (130 by Ctrl-C), "
    "4 an internal error.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
app.command("run")(run.run)
app.command("plan")(plan.plan)
app.command("post")(post.post)
app.command("new")(new.new)
app.command("verify")(verify.verify)
app.command("view")(view.view)
app.command("compare")(compare.compare)
app.command("schema")(schema.schema)
app.command("doctor")(doctor.doctor)
app.add_typer(freecad.app, name="freecad")
app.add_typer(part.app, name="part")
app.add_typer(machine.app, name="machine")
app.add_typer(material.app, name="material")
tool.app.command("suggest")(suggest.suggest)
app.add_typer(tool.app, name="tool")


def _print_version(wanted: bool) -> None:
    if wanted:
        console.say(f"styluscam {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _top(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


def main() -> NoReturn:
    """The entry point: runs the command line and ends the process with its exit code.

    It ends without the interpreter's teardown, which frees the CAD kernel object by object in 0.3 s: all files are
    closed by then.
    """
    code = invoke(sys.argv[1:])
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # closed, gone, or never there
            stream.flush()
    os._exit(code)


def invoke(arguments: Sequence[str]) -> int:
    """Runs a command line; the exit code. Nothing is raised."""
    with console.shielded(), warnings.catch_warnings():
        if "--debug" not in arguments:
            warnings.simplefilter("ignore")
            logging.disable(logging.WARNING)
        try:
            return _dispatch(list(arguments))
        except BaseException as error:
            return _failed(error, arguments)
        finally:
            logging.disable(logging.NOTSET)


def _dispatch(arguments: list[str]) -> int:
    code = app(arguments, prog_name="styluscam", standalone_mode=False)
    if code == 130:  # Ctrl-C in newer typer
        raise KeyboardInterrupt
    return int(code or 0)


def _failed(error: BaseException, arguments: Sequence[str]) -> int:
    if isinstance(error, SystemExit):
        return int(error.code or 0) if isinstance(error.code, int | None) else 2
    failure = failure_of(error)
    if "--debug" in arguments:
        console.complain("".join(traceback.format_exception(error)))
    if "--json" in arguments:
        try:
            console.say_json(failure.to_dict())
        except StylusError:  # stdout itself is what failed
            console.complain(failure.line)
    else:
        console.complain(failure.line)
    return failure.exit_code
