"""Which tools of a library suit a part: ranked by the scallops that they leave and by what they cannot reach.

Every tool follows the same passes, the job's: so the paths are equally long, and what differs is the surface that they
leave. It only ranks; the choice, and what the material and the machine stand, are the user's.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from styluscam import planning
from styluscam.errors import Cancelled, JobError, StylusError, ToolError
from styluscam.job import Job
from styluscam.scallop import scallop_of_step
from styluscam.tool import Tool
from styluscam.types import Document, FloatArray, Progress
from styluscam.walls import Walls, walls_of

BEST = 3
"""Tools for which the job is planned, to see what they bridge."""

MARGIN = 0.02
"""Of the part's curvature and of its area: less is the mesh's own coarseness."""

TURNS = 24
"""Directions of a lace against the wall over which its scallops are averaged."""

FLAT_RAD = 1e-3
"""A floor's slope: tools are asked here instead of at 0, where a flat is a whole interval of radii."""


@dataclass(frozen=True)
class Candidate:
    """A tool of the ranking."""

    tool: Tool
    scallop_mm: float
    """Mean over the walls' area."""
    worst_mm: float
    """Largest, over the classes of wall angles."""
    worst_at_deg: float
    unreached: float
    """Share of the area that is more hollow than the tool is round."""
    over_rim: float
    """Share of the area steeper than the profile's end."""
    reasons: tuple[str, ...]
    bridged: tuple[Document, ...] | None = None
    """What planning found bridged; None where the job was not planned with it."""

    def to_dict(self) -> Document:
        """For scripts; lengths in mm, shares from 0 to 1."""
        return {
            "name": self.tool.name,
            "title": self.tool.title,
            "description": self.tool.description,
            "profile": self.tool.to_dict()["profile"],
            "scallop_mean_mm": self.scallop_mm,
            "scallop_max_mm": self.worst_mm,
            "scallop_max_at_deg": self.worst_at_deg,
            "unreached_share": self.unreached,
            "over_rim_share": self.over_rim,
            "bridged": None if self.bridged is None else list(self.bridged),
            "reasons": list(self.reasons),
        }


@dataclass(frozen=True)
class Advice:
    """The ranking, best first, and what the part asks for."""

    candidates: tuple[Candidate, ...]
    facts: Document
    notes: tuple[str, ...] = field(default=())

    def to_dict(self) -> Document:
        """For scripts."""
        return {
            "part": self.facts,
            "notes": list(self.notes),
            "tools": [candidate.to_dict() for candidate in self.candidates],
        }


def suggest(job: Job, tools: Sequence[Document], *, best: int = BEST, progress: Progress | None = None) -> Advice:
    """Ranks tools for a job; for the ``best`` of them it is planned too, to see what they bridge.

    Raises:
        ToolError: no tools, or one that cannot be built.
        JobError, GeometryError: as reading the part does, or the job has nothing but floors.
        Cancelled: by ``progress``.
    """
    if not tools:
        raise ToolError("no tools to choose from", code="no-tools", where="library", hint="name a --library")
    asked = _Asked.of(job, progress)
    found = []
    for number, document in enumerate(tools):
        if progress is not None and progress("comparing tools", number / len(tools)) is False:
            raise Cancelled("cancelled", code="cancelled")
        found.append(_judged(Tool.from_dict(document), asked))
    reached = min(candidate.unreached for candidate in found) + MARGIN
    found.sort(key=lambda c: (c.unreached > reached, c.over_rim > MARGIN, c.scallop_mm, c.tool.name))
    planned = [_planned(candidate, job, progress) for candidate in found[:best]]
    return Advice(tuple(planned + found[best:]), _facts(asked), _notes(asked))


class _Passes:
    """How far the job's passes lie apart, and which scallops that leaves."""

    def __init__(self, document: Document) -> None:
        operation = document["operations"][0]
        self.lace = operation["kind"] != "z-level"
        height = (operation.get("step") or {}).get("height")
        wide = operation.get("stepover") if self.lace else height
        self.pitch = float(wide if wide is not None else 0.5)
        self.words = f"{'rows' if self.lace else 'levels'} {self.pitch:g} mm apart"

    def scallops(self, tool: Tool, angles_deg: FloatArray) -> FloatArray:
        """Scallop height (mm) by wall angle (degrees)."""
        if not self.lace:
            return scallop_of_step(tool, angles_deg, self.pitch)
        return self._of_lace(tool, np.radians(angles_deg))

    def _of_lace(self, tool: Tool, slopes: FloatArray) -> FloatArray:
        """Of vertical planes in all directions against the wall, on average: p^2/8 R, R between the tool's two radii."""
        turn = (np.arange(TURNS) + 0.5) * (np.pi / 2.0) / TURNS
        sin, cos = np.sin(slopes)[:, None], np.cos(slopes)[:, None]
        apart2 = self.pitch**2 / (1.0 - (sin * np.cos(turn)) ** 2)
        up2 = (np.cos(turn) * cos) ** 2 / (1.0 - (sin * np.cos(turn)) ** 2)
        meridian, around = _radii(tool, slopes)
        radius = np.where(np.isfinite(meridian), meridian, 1e9)[:, None] * up2 + around[:, None] * (1.0 - up2)
        return np.asarray(np.minimum(apart2 / np.maximum(8.0 * radius, 1e-9), np.sqrt(apart2) / 2.0).mean(axis=1))


@dataclass(frozen=True, eq=False)
class _Asked:
    """What the job asks of a tool."""

    walls: Walls
    passes: _Passes
    angles: FloatArray
    """Classes of wall angles, degrees."""
    shares: FloatArray
    """Of the walls' area, by class."""
    ball: float
    """Radius (mm) of the ball by which the sheet rounds every tool."""
    thickness: float
    """Of the sheet, mm; 0 without one."""

    @classmethod
    def of(cls, job: Job, progress: Progress | None) -> _Asked:
        walls, passes = walls_of(job, progress), _Passes(job.document)
        angles, areas = walls.classes(floors=passes.lace)
        if not len(angles):
            hint = "levels make no sense there: try a zig-zag"
            raise JobError("the selected faces have no walls", code="no-walls", where="part.faces", hint=hint)
        sheet = job.document["setup"].get("sheet") or {}
        thickness = float(sheet.get("thickness", 0.0))
        share = {"tool": 0.0, "mid": 0.5, "back": 1.0}.get(job.document["part"].get("model_face"), 0.0)
        ball = share * thickness if sheet.get("law", "constant") == "constant" else 0.0
        return cls(walls, passes, angles, areas / areas.sum(), ball, thickness)


def _radii(tool: Tool, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Radii of curvature (mm) up the wall and along it, by slope; 0 up the wall where an edge cuts."""
    asked = np.clip(slopes, FLAT_RAD, tool.max_slope)
    inner, outer = tool.radius_range_at(asked)
    meridian = np.where(outer > inner, np.inf, tool.curvature_radius_at(asked))
    edge = slopes > tool.max_slope + 1e-9
    return np.where(edge, 0.0, meridian), outer / np.sin(np.maximum(slopes, FLAT_RAD))


def _judged(tool: Tool, asked: _Asked) -> Candidate:
    heights = asked.passes.scallops(tool, asked.angles)
    # where passes lie farther apart than the tool is wide, what is left is at least as high as the tool is round
    heights = np.where(np.isfinite(heights), heights, max(float(np.nanmax(heights, initial=0.0)), tool.diameter))
    worst = int(np.argmax(heights))
    over = float(asked.shares[np.radians(asked.angles) > tool.max_slope + 1e-6].sum())
    unreached, hollow = _unreached(tool, asked.walls, asked.ball)
    candidate = Candidate(
        tool, float(heights @ asked.shares), float(heights[worst]), float(asked.angles[worst]), unreached, over, ()
    )
    return replace(candidate, reasons=_reasons(candidate, hollow, asked))


def _unreached(tool: Tool, walls: Walls, ball: float) -> tuple[float, float | None]:
    """Share of the area that is more hollow than tool and sheet are round, and the slope (rad) where most of it is."""
    meridian, around = _radii(tool, walls.slopes)
    up, twist, level = (walls.bends * (1.0 - MARGIN)).T
    with np.errstate(divide="ignore"):
        up = up + 1.0 / (meridian + ball)
        level = level + 1.0 / (around + ball)
    free = (up >= -1e-6) & (level >= -1e-6)
    free &= np.where(np.isinf(up), True, up * level - twist**2 >= -1e-9)
    if free.all():
        return 0.0, None
    missed = walls.areas[~free]
    return float(missed.sum() / walls.areas.sum()), float(np.average(walls.slopes[~free], weights=missed))


def _reasons(candidate: Candidate, hollow: float | None, asked: _Asked) -> tuple[str, ...]:
    tool, over, unreached = candidate.tool, candidate.over_rim, candidate.unreached
    common = float(asked.angles[int(np.argmax(asked.shares))])
    radius = float(_radii(tool, np.radians([common]))[0][0])
    said = [f"scallops of {1e3 * candidate.scallop_mm:.3g} um on average"]
    if over <= MARGIN:
        shape = "straight" if not math.isfinite(radius) else f"round with {radius:.3g} mm" if radius else "a sharp edge"
        said.append(f"{shape} at {common:.3g} deg, where most of the walls are")
    else:
        said.append(f"ends at {math.degrees(tool.max_slope):.3g} deg: its rim forms {100.0 * over:.2g} % of the walls")
    if hollow is not None and unreached > MARGIN / 10.0:
        said.append(f"too flat for {100.0 * unreached:.2g} % of the area, near {math.degrees(hollow):.2g} deg")
    if radius < 2.0 * asked.thickness:
        said.append(f"sharper than two sheet thicknesses ({2.0 * asked.thickness:g} mm): it may tear the sheet")
    return tuple(said)


def _planned(candidate: Candidate, job: Job, progress: Progress | None) -> Candidate:
    """The same with what planning the job with this tool found bridged."""
    document = copy.deepcopy(job.document)
    for name in {operation["tool"] for operation in document["operations"]}:
        section = document["tools"][name]
        for key in ("profile", "base", "shank_diameter", "length", "holder", "library"):
            section.pop(key, None)
        section |= candidate.tool.to_dict()
        section["reference"] = "tip"
    try:
        work = Job.from_dict(document, job.folder, job.part())
        figures, _ = planning.plan(work, progress=progress).summary()
    except Cancelled:
        raise
    except StylusError as error:
        return _with(candidate, None, f"the job cannot be planned with it: {error}")
    bridged = [bridge for operation in figures["operations"] for bridge in operation["bridged"]]
    if not bridged:
        return _with(candidate, (), "bridges nothing")
    worst = max(bridged, key=lambda bridge: float(bridge["excess"]))
    faces = len({bridge["face"] for bridge in bridged})
    said = f"bridges up to {worst['excess']:.3f} mm in Face{worst['face']}"
    return _with(candidate, tuple(bridged), said + (f" ({faces} faces in all)" if faces > 1 else ""))


def _with(candidate: Candidate, bridged: tuple[Document, ...] | None, reason: str) -> Candidate:
    return replace(candidate, bridged=bridged, reasons=(*candidate.reasons, reason))


def _facts(asked: _Asked) -> Document:
    walls = asked.walls
    angles, areas = walls.classes(floors=True)
    return {
        "passes": asked.passes.words,
        "walls": [
            {"angle_deg": float(angle), "share": float(area)}
            for angle, area in zip(angles, areas / areas.sum(), strict=True)
        ],
        "floor_share": walls.floor_share,
        "smallest_concave_radius_mm": walls.smallest_hollow_mm,
        "sharp_concave_edges_mm": walls.crease_mm,
    }


def _notes(asked: _Asked) -> tuple[str, ...]:
    walls, said = asked.walls, []
    if walls.floor_share > MARGIN and not asked.passes.lace:
        said.append(f"{100.0 * walls.floor_share:.2g} % of the area is floor: levels leave it, and it does not count")
    if walls.crease_mm > 0.0:
        said.append(f"{walls.crease_mm:.0f} mm of sharp concave edges: no tool reaches into them")
    return tuple(said)
