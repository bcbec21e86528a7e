"""``styluscam machine list`` and ``show``: the shipped controllers."""

from __future__ import annotations

from typing import Annotated

import typer

from styluscam.cli import console
from styluscam.cli.options import Debug, Json
from styluscam.machine import Machine
from styluscam.types import Document

app = typer.Typer(help="Look at machines.", rich_markup_mode=None)

Name = Annotated[str, typer.Argument(metavar="NAME", help="A shipped machine, or a machine file.", show_default=False)]


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("list")
def list_(json: Json = False, debug: Debug = False) -> int:
    """List the shipped machines."""
    machines = [Machine.shipped(name) for name in Machine.names()]
    if json:
        console.say_json([_document(machine) for machine in machines])
    else:
        console.fields([(machine.name, machine.description) for machine in machines])
    return 0


@app.command("show")
def show(name: Name, json: Json = False, debug: Debug = False) -> int:
    """Say what a machine is: shipped by name, else from a file."""
    machine = Machine.find(name)
    if json:
        console.say_json(_document(machine))
    else:
        console.fields(
            [
                ("name", machine.name),
                ("what", machine.description),
                ("last place", f"{machine.resolution_mm:g} mm"),
            ]
        )
    return 0


def _document(machine: Machine) -> Document:
    return {"name": machine.name, "description": machine.description, "resolution_mm": machine.resolution_mm}
