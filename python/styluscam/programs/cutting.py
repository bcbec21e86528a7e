"""Feeds and speeds of a cut: from tables of cutting data, the engagement and the machine's limits."""

from __future__ import annotations

import json
from dataclasses import dataclass

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, file_of, json_of, word_of
from styluscam.errors import JobError
from styluscam.files import read_text
from styluscam.programs.machine import Machine, MachineLike
from styluscam.records import Record
from styluscam.tools.tool import Tool, ToolLike


@dataclass(frozen=True, slots=True, eq=False)
class CuttingData(Record):
    """Speed of the spindle and feeds of a cut, and what they follow from.

    Attributes:
        rpm: speed of the spindle, rev/min.
        feed: along the path, mm/min.
        plunge: straight down, mm/min.
        speed_m_min: cutting speed on ``diameter``, m/min.
        diameter: that cuts, at the depth of cut, mm.
        feed_per_tooth: mm; per revolution in drilling and tapping.
        chip: the thickest, mm.
        reasons: sentences.
        sources: where the table's numbers are stated.
    """

    rpm: float
    feed: float
    plunge: float
    speed_m_min: float
    diameter: float
    feed_per_tooth: float
    chip: float
    reasons: list[str]
    sources: list[str]


def cutting_data(
    tool: ToolLike,
    material: str,
    work: str = "rough-milling",
    *,
    cutter_material: str | None = None,
    flutes: int | None = None,
    width: float | None = None,
    angle_deg: float | None = None,
    depth: float | None = None,
    pitch: float | None = None,
    machine: MachineLike | None = None,
    min_rpm: float | None = None,
    max_rpm: float | None = None,
    max_feed: float | None = None,
    table: FileName | None = None,
) -> CuttingData:
    """Feeds and speeds of a tool in a material.

    The chip is kept as thick as the table allows: with less than half of the diameter engaged, or where a slope of the
    profile cuts, the feed is raised. Where a number is a range, its lower end counts.

    Args:
        tool: as :meth:`Tool.of` takes it.
        material: of the workpiece, by its name in the table: ``styluscam material cutting`` lists them.
        work: ``"rough-milling"``, ``"finish-milling"``, ``"drilling"`` or ``"tapping"``.
        cutter_material: ``"hss"`` or ``"carbide"``; the tool's when left out.
        flutes: the number of cutting edges; the tool's when left out.
        width: of cut, across the path, mm; half of the diameter or more when this and ``angle_deg`` are left out.
        angle_deg: the engagement angle, degrees.
        depth: of cut, along the axis, mm; the tool cuts with its largest diameter when left out.
        pitch: of the thread, mm, in tapping.
        machine: whose limits hold.
        min_rpm: of the spindle, rev/min; goes before the machine's.
        max_rpm: of the spindle, rev/min; goes before the machine's.
        max_feed: mm/min; goes before the machine's.
        table: a file with a table of your own (TOML), which goes before the shipped one.

    Raises:
        JobError: an unknown material, cutter or work, with those that are known; a size beyond the table's; a table
            that is wrong.
    """
    made = Tool.of(tool)
    known = made.to_dict()
    limits = {} if machine is None else limits_of(Machine.of(machine))
    own = {"min_rpm": min_rpm, "max_rpm": max_rpm, "max_feed": max_feed}
    request = {
        "material": word_of(material, "material", "the name of a material", JobError),
        "work": word_of(work, "work", "the name of a work", JobError),
        "cutter_material": _cutter_of(known.get("cutter_material") if cutter_material is None else cutter_material),
        "flutes": known.get("flutes") if flutes is None else flutes,
        "pitch": pitch,
        "engagement": {"width": width, "angle_deg": angle_deg, "depth": depth},
        "limits": limits | {key: value for key, value in own.items() if value is not None},
    }
    asked = json_of(request, "request", JobError)
    text = None if table is None else table_text(table)
    return CuttingData(**json.loads(_engine.cutting_data(made._engine, asked, text)))


def _cutter_of(stated: str | None) -> str:
    """What a tool is made of.

    Raises:
        JobError: it is not stated.
    """
    if stated is not None:
        return stated
    message, hint = "the tool's file does not state what it is made of", 'write cutter_material = "carbide" or "hss"'
    raise JobError(message, code="missing", where="cutter_material", hint=hint)


def limits_of(machine: Machine) -> dict[str, float]:
    """Of what a machine's file states, what limits a cut: rev/min, mm/min."""
    stated = machine.document.get("limits", {})
    return {key: stated[key] for key in ("min_rpm", "max_rpm", "max_feed") if stated.get(key) is not None}


def table_text(path: FileName) -> str:
    """The text of a table of one's own, checked.

    Raises:
        JobError: it cannot be read, or is wrong: the error names the file and the entry.
    """
    file = file_of(path, "table", A_FILE, JobError)
    text = read_text(file, JobError)
    try:
        _engine.cutting_table(text)
    except JobError as error:
        where = f"{file}: {error.where}"
        raise JobError(f"{where}: {error}", code=error.code, where=where, hint=error.hint) from error
    return text


@dataclass(frozen=True, slots=True, eq=False)
class CuttingEntry(Record):
    """What a cutter stands in a work.

    Attributes:
        cutter: ``"hss"`` or ``"carbide"``.
        work: the kinds of work that it is for.
        speed_m_min: lowest and highest cutting speed, m/min; None where ``rpm`` (rev/min) is stated instead.
        chips: diameters and feeds per tooth, in drilling per revolution, mm.
        chip_by_depth: depths in diameters, and shares of the chip there.
        sources: where the numbers are stated.
    """

    cutter: str
    work: list[str]
    speed_m_min: tuple[float, float] | None
    rpm: float | None
    chips: list[tuple[float, float]]
    chip_by_depth: list[tuple[float, float]]
    sources: list[str]


@dataclass(frozen=True, slots=True, eq=False)
class CuttingMaterial(Record):
    """A material of workpieces, and what is known of cutting it."""

    name: str
    title: str
    also: list[str]
    data: list[CuttingEntry]


def cutting_materials(table: FileName | None = None) -> list[CuttingMaterial]:
    """The materials of the shipped table, behind those of a table of one's own."""
    document = json.loads(_engine.cutting_table(None if table is None else table_text(table)))
    return [
        CuttingMaterial(
            one["name"], one["title"], one.get("also", []), [CuttingEntry(**entry) for entry in one["data"]]
        )
        for one in document
    ]
