"""``styluscam material list`` and ``cutting``: what sheets of known materials withstand, what cutters stand, with sources."""

from __future__ import annotations

import json as json_module
from dataclasses import dataclass
from typing import Annotated

import typer

from styluscam import _engine
from styluscam.cli import console
from styluscam.cli.options import CuttingTable, Debug, Json
from styluscam.programs.cutting import CuttingEntry, cutting_materials
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


app = typer.Typer(help="List materials of sheets and of workpieces.", rich_markup_mode=None)

Toml = Annotated[bool, typer.Option("--toml", help="Print the shipped tables as TOML, to begin one of your own with.")]


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


@app.command("cutting")
def cutting(table: CuttingTable = None, toml: Toml = False, json: Json = False, debug: Debug = False) -> int:
    """List the materials of workpieces: what cutters of high-speed steel and carbide stand in each, with its source."""
    if toml:
        console.say("\n".join(_engine.shipped_cutting_tables()))
        return 0
    materials = cutting_materials(table)
    if json:
        console.say_json(materials)
        return 0
    for number, material in enumerate(materials):
        if number:
            console.say()
        console.say(f"{material.name}: {material.title}" if material.title else material.name)
        rows = [(f"  {entry.cutter}, {', '.join(entry.work)}", _cut(entry)) for entry in material.data]
        console.fields(rows)
    return 0


def _cut(entry: CuttingEntry) -> str:
    if entry.speed_m_min is None:
        speed = f"{entry.rpm:g} rev/min"
    else:
        speed = " to ".join(dict.fromkeys(f"{value:.3g}" for value in entry.speed_m_min)) + " m/min"
    ends = [entry.chips[0], entry.chips[-1]] if len(entry.chips) > 1 else entry.chips
    chips = " to ".join(f"{chip:.3g} mm at {diameter:.3g} mm" for diameter, chip in ends)
    return "; ".join([speed, *([chips] if chips else []), *entry.sources])


def _thickness(angle: WallAngle) -> str:
    return "any thickness" if angle.thickness is None else f"{angle.thickness:g} mm"


def _angle(angle: WallAngle) -> str:
    return f"{angle.most_deg:g} deg" if angle.sure_deg is None else f"{angle.sure_deg:g} to {angle.most_deg:g} deg"
