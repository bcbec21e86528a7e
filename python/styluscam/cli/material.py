"""``styluscam material list``: how steep a wall sheets of known materials bear, and where that is told."""

from __future__ import annotations

import json as json_module
from typing import Any

import typer

from styluscam import _engine
from styluscam.cli import console
from styluscam.cli.options import Debug, Json

app = typer.Typer(help="Look at the materials of sheets.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("list")
def list_(json: Json = False, debug: Debug = False) -> int:
    """List the shipped materials: the wall angle that each bears in one pass, by thickness, with its source."""
    materials = json_module.loads(_engine.materials())
    if json:
        console.say_json(materials)
        return 0
    for number, material in enumerate(materials):
        if number:
            console.say()
        console.say(f"{material['name']}: {material['title']}")
        console.fields(
            [(f"  {_thickness(angle)}", f"{_angle(angle)}: {angle['source']}") for angle in material["angles"]]
        )
    return 0


def _thickness(angle: dict[str, Any]) -> str:
    return "any thickness" if angle["thickness"] is None else f"{angle['thickness']:g} mm"


def _angle(angle: dict[str, Any]) -> str:
    sure, most = angle["sure_deg"], angle["most_deg"]
    return f"{most:g} deg" if sure is None else f"{sure:g} to {most:g} deg"
