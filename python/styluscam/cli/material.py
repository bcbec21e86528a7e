"""``styluscam material list``: how steep a wall sheets of known materials withstand, with sources."""

from __future__ import annotations

import json as json_module
from dataclasses import dataclass

import typer

from styluscam import _engine
from styluscam.cli import console
from styluscam.cli.options import Debug, Json
from styluscam.records import Record
from styluscam.types import Document


@dataclass(frozen=True, slots=True, eq=False)
class WallAngle(Record):
    """Wall angles (degrees) formed in one pass at a thickness (mm; None: any): the largest and, if known, a sure one."""

    thickness: float | None
    most_deg: float
    sure_deg: float | None
    source: str


@dataclass(frozen=True, slots=True, eq=False)
class Material(Record):
    """A shipped material."""

    name: str
    title: str
    angles: tuple[WallAngle, ...]

    @classmethod
    def of(cls, document: Document) -> Material:
        """From the engine's document."""
        return cls(**{**document, "angles": tuple(WallAngle(**angle) for angle in document["angles"])})


app = typer.Typer(help="List materials of sheets.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("list")
def list_(json: Json = False, debug: Debug = False) -> int:
    """List the shipped materials: the wall angle that each withstands in one pass, by thickness, with its source."""
    materials = [Material.of(document) for document in json_module.loads(_engine.materials())]
    if json:
        console.say_json(materials)
        return 0
    for number, material in enumerate(materials):
        if number:
            console.say()
        console.say(f"{material.name}: {material.title}")
        console.fields([(f"  {_thickness(angle)}", f"{_angle(angle)}: {angle.source}") for angle in material.angles])
    return 0


def _thickness(angle: WallAngle) -> str:
    return "any thickness" if angle.thickness is None else f"{angle.thickness:g} mm"


def _angle(angle: WallAngle) -> str:
    return f"{angle.most_deg:g} deg" if angle.sure_deg is None else f"{angle.sure_deg:g} to {angle.most_deg:g} deg"
