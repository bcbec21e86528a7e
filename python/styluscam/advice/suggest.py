"""Which tools of a library suit a part: ranked by what they bridge, then by the scallops that they leave.

What a tool bridges by more than the job's tolerance is a defect, and comes before any scallop; what every tool leaves in
sharp corners is none. Every tool follows the same passes, the job's: so the paths are equally long, and what differs is
the surface that they leave. Scallops and what stays in corners are measured with one measure, the root mean square of
what is left over the area, as a rough surface is: a deep groove counts more than many shallow ones. It only ranks; the
choice, and what the material and the machine stand, are the user's.
"""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from styluscam.advice import reach
from styluscam.advice.facts import Facts, OperationFacts, WallShare
from styluscam.advice.walls import BIN_DEG, Classes, Walls, walls_of
from styluscam.errors import Cancelled, JobError, PlanError, ToolError
from styluscam.programs import planning
from styluscam.programs.job import Job
from styluscam.programs.summary import BridgedFace, SurfaceSummary
from styluscam.tools.scallop import scallop_of_spacing
from styluscam.tools.tool import Tool
from styluscam.tools.toolfile import TOOL
from styluscam.types import Document, FloatArray, Progress

BEST = 3
"""Tools for which the job is planned, to see what they bridge."""

PATIENCE = 2
"""For each of them so many tools are planned at most: one that turns out to bridge more gives its turn to the next."""

MARGIN = 0.02
"""Of the part's curvature and of its area: less is the mesh's own coarseness."""

LEAST_SHARE = 0.1 * MARGIN
"""Of the area: where less is too hollow, that is the mesh's own coarseness too."""

LEAST_GAP = 5e-4
"""mm: less is no gap to speak of."""

SNUG = 1.01
"""What a tool may be wider than the narrow gaps: as the triangles know them."""

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
    gap_mm: float
    """Most that stays in a corner, as the profile has it."""
    fillet_gap_mm: float
    """The same where only fillets count: what stays in a sharp corner is no tool's fault."""
    tolerance_mm: float
    """The job's: what is bridged by more is a defect."""
    has_sharp_corners: bool
    scallop_square: float
    """Mean square over the area, mm^2."""
    gap_square: float
    """The same of what stays in corners."""
    reasons: tuple[str, ...]
    bridged: tuple[BridgedFace, ...] | None = None
    """What planning found bridged; None where the job was not planned with it."""
    failure: str = ""
    """Why the job cannot be planned with it."""

    @property
    def left_mm(self) -> float:
        """Root mean square of what it leaves over the area."""
        return math.sqrt(self.scallop_square + self.gap_square)

    @property
    def asked(self) -> bool:
        """Whether planning was tried."""
        return self.bridged is not None or bool(self.failure)

    @property
    def bridged_mm(self) -> float:
        """Most that stays anywhere: as planning found it, else as the profile has it."""
        if self.bridged is None:
            return self.gap_mm
        return max((bridge.excess for bridge in self.bridged), default=0.0)

    @property
    def bridges(self) -> bool:
        """Whether it leaves more than the tolerance where a rounder tool would not."""
        found = self.fillet_gap_mm if self.bridged is None or self.has_sharp_corners else self.bridged_mm
        return found > self.tolerance_mm

    @property
    def rank(self) -> tuple[bool, bool, bool, float, str]:
        """Sorts candidates, best first."""
        return bool(self.failure), self.over_rim > MARGIN, self.bridges, self.left_mm, self.tool.name

    def to_dict(self) -> Document:
        """For scripts; lengths in mm, shares from 0 to 1."""
        return {
            "name": self.tool.name,
            "title": self.tool.title,
            "description": self.tool.description,
            "profile": self.tool.to_dict()["profile"],
            "left_rms_mm": self.left_mm,
            "scallop_mean_mm": self.scallop_mm,
            "scallop_max_mm": self.worst_mm,
            "scallop_max_at_deg": self.worst_at_deg,
            "unreached_share": self.unreached,
            "over_rim_share": self.over_rim,
            "bridged_estimate_mm": self.gap_mm,
            "bridges": self.bridges,
            "bridged": None if self.bridged is None else [bridge.to_dict() for bridge in self.bridged],
            "failure": self.failure,
            "reasons": list(self.reasons),
        }


@dataclass(frozen=True)
class Advice:
    """The ranking, best first, and what the part asks for."""

    candidates: tuple[Candidate, ...]
    facts: Facts
    notes: tuple[str, ...] = field(default=())

    def to_dict(self) -> Document:
        """For scripts."""
        return {
            "part": self.facts.to_dict(),
            "notes": list(self.notes),
            "tools": [candidate.to_dict() for candidate in self.candidates],
        }


def suggest(
    job: Job,
    tools: Sequence[Document],
    *,
    best: int = BEST,
    operation: str | None = None,
    progress: Progress | None = None,
) -> Advice:
    """Ranks tools for all operations of a job, or for one; for the ``best`` it is planned too, to see what they bridge.

    Raises:
        ToolError: no tools, or one that cannot be built.
        JobError, GeometryError: as reading and planning the job do, no such operation, or nothing but floors.
        Cancelled: by ``progress``.
    """
    if not tools:
        raise ToolError("no tools to choose from", code="no-tools", where="library", hint="name a --library")
    if operation is not None:
        job = _with_one(job, operation)
    asked = _asked_by(job, progress)
    found = []
    for number, document in enumerate(tools):
        if progress is not None and progress("comparing tools", number / len(tools)) is False:
            raise Cancelled("cancelled", code="cancelled")
        found.append(_compared(Tool.from_dict(document), asked))
    found.sort(key=lambda candidate: candidate.rank)
    for _ in range(PATIENCE * best):
        number = next((n for n, candidate in enumerate(found[:best]) if not candidate.asked), -1)
        if number < 0:
            break
        found[number] = _planned(found[number], job, asked, progress)
        found.sort(key=lambda candidate: candidate.rank)
    return Advice(tuple(found), _facts(asked), _notes(asked, job))


def _with_one(job: Job, operation: str) -> Job:
    """The job with one operation only."""
    names = job.engine.operation_ids()
    if operation not in names:
        hint = f"the job has {', '.join(names)}"
        raise JobError(f"no operation {operation!r}", code="no-such-operation", where="operations", hint=hint)
    return Job.from_dict(_with_only(job, {operation}), job.folder, job.target())


def _with_only(job: Job, names: set[str]) -> Document:
    """The job's document with the operations of these ids only, which they keep."""
    document = copy.deepcopy(job.document)
    sections = zip(job.engine.operation_ids(), document["operations"], strict=True)
    document["operations"] = [{**section, "id": name} for name, section in sections if name in names]
    return document


class _Passes:
    """How far an operation's passes lie apart, and which scallops that leaves."""

    def __init__(self, spacing: Document) -> None:
        self.pitch, self.words = float(spacing["pitch"]), str(spacing["words"])
        self.rows_deg = None if spacing["in"] == "height" else float(spacing["direction_deg"])

    def scallops(self, tool: Tool, walls: Classes) -> FloatArray:
        """Scallop height (mm) by class of walls: on the plane, and by what the part's curvature adds or takes."""
        if self.rows_deg is None:
            return self._of_levels(tool, walls)
        return self._of_rows(tool, walls)

    def _of_levels(self, tool: Tool, walls: Classes) -> FloatArray:
        """Where the wall turns, the passes lie no farther apart than from the slope 0 to twice the wall's."""
        slopes = np.radians(walls.angles)
        apart = np.minimum(self.pitch / np.sin(slopes), 2.0 * slopes / np.maximum(np.abs(walls.up), 1e-9))
        return np.asarray(np.maximum(scallop_of_spacing(tool, walls.angles, apart) + walls.up * apart**2 / 8.0, 0.0))

    def _of_rows(self, tool: Tool, walls: Classes) -> FloatArray:
        """p^2/8 (1/R + k) where vertical planes cut the wall, R between the tool's two radii and k the part's (Euler)."""
        slopes, turns = np.radians(walls.angles), np.radians(walls.turns)
        sin, cos = np.sin(slopes), np.cos(slopes)
        apart2 = self.pitch**2 / (1.0 - (sin * np.cos(turns)) ** 2)
        up2 = (np.cos(turns) * cos) ** 2 / (1.0 - (sin * np.cos(turns)) ** 2)
        meridian, around = _radii(tool, slopes)
        radius = np.where(np.isfinite(meridian), meridian, 1e9) * up2 + around * (1.0 - up2)
        bend = 1.0 / np.maximum(radius, 1e-9) + walls.up * up2 + walls.level * (1.0 - up2)
        return np.asarray(np.clip(apart2 * bend / 8.0, 0.0, np.sqrt(apart2) / 2.0))


@dataclass(frozen=True, eq=False)
class _Asked:
    """What an operation asks of a tool."""

    name: str
    walls: Walls
    passes: _Passes
    classes: Classes
    """Of the walls, as the passes see them."""
    ball: float
    """Radius (mm) of the ball by which the sheet rounds every tool."""
    thickness: float
    """Of the sheet, mm; 0 without one."""
    tolerance: float
    """Of the path, mm."""
    fits: float
    """Radius (mm) up to which a tool fits nearly all of the part's fillets and gaps; infinite where nothing bounds it."""


def _asked_by(job: Job, progress: Progress | None) -> list[_Asked]:
    """What the operations ask that have walls."""
    document, found = job.document, []
    sheet = document["setup"].get("sheet") or {}
    thickness = float(sheet.get("thickness", 0.0))
    scene = job.scene(progress)
    ball, bound = scene.sheet_ball, scene.fitting_radius
    fits = math.inf if bound is None else bound
    for index, name in enumerate(job.engine.operation_ids()):
        spacing = job.engine.spacing(index)
        if spacing is None:
            continue  # its passes do not lie in step: no scallop follows from the profile alone
        try:
            walls = walls_of(job, index, scene)
        except JobError as error:
            if error.code != "no-faces":
                raise
            continue  # upright walls alone: no profile leaves more there than another
        passes = _Passes(json.loads(spacing))
        classes = walls.classes(passes.rows_deg)
        if len(classes.areas):
            tolerance = float(document["operations"][index]["tolerance"])
            found.append(_Asked(name, walls, passes, classes, ball, thickness, tolerance, fits))
    if not found:
        hint = "rows over floors can be compared; for upright walls any tool will do that fits their gaps and fillets"
        message = "the selected faces have no sloping walls: no profile leaves more there than another"
        raise JobError(message, code="no-walls", where="part.faces", hint=hint)
    return found


def _radii(tool: Tool, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Radii of curvature (mm) up the wall and along it, by slope; 0 up the wall where an edge cuts."""
    asked = np.clip(slopes, FLAT_RAD, tool.max_slope)
    inner, outer = tool.radius_range_at(asked)
    meridian = np.where(outer > inner, np.inf, tool.curvature_radius_at(asked))
    edge = slopes > tool.max_slope + 1e-9
    return np.where(edge, 0.0, meridian), outer / np.sin(np.maximum(slopes, FLAT_RAD))


def _compared(tool: Tool, asked: list[_Asked]) -> Candidate:
    """What the profile alone shows of a tool, over all operations by their area."""
    heights = np.concatenate([_heights(tool, each) for each in asked])
    angles = np.concatenate([each.classes.angles for each in asked])
    shares = np.concatenate([each.classes.areas for each in asked])
    shares /= shares.sum()
    worst = int(np.argmax(heights))
    over = float(shares[np.radians(angles) > tool.max_slope + 1e-6].sum())
    missed = [_unreached(tool, each.walls, each.ball) for each in asked]
    whole = sum(each.walls.area for each in asked)
    corners = [_corner(tool, each, area) for each, (area, _) in zip(asked, missed, strict=True)]
    gap, where = max(((each.gap, each.where) for each in corners), key=lambda found: found[0])
    candidate = Candidate(
        tool,
        scallop_mm=float(heights @ shares),
        worst_mm=float(heights[worst]),
        worst_at_deg=float(angles[worst]),
        unreached=sum(area for area, _ in missed) / whole,
        over_rim=over,
        gap_mm=gap,
        fillet_gap_mm=max(each.in_fillets for each in corners),
        tolerance_mm=min(each.tolerance for each in asked),
        has_sharp_corners=any(each.walls.crease_mm > 0.0 for each in asked),
        scallop_square=float(heights**2 @ shares),
        gap_square=sum(each.square for each in corners) / whole,
        reasons=(),
    )
    hollow = next((slope for _, slope in missed if slope is not None), None)
    return replace(candidate, reasons=_reasons(candidate, hollow, where, asked))


def _heights(tool: Tool, asked: _Asked) -> FloatArray:
    """Scallops (mm) by class."""
    heights = asked.passes.scallops(tool, asked.classes)
    # where passes lie farther apart than the tool is wide, what is left is at least as high as the tool is round
    return np.where(np.isfinite(heights), heights, max(float(np.nanmax(heights, initial=0.0)), tool.diameter))


def _unreached(tool: Tool, walls: Walls, ball: float) -> tuple[float, float | None]:
    """Area (mm^2) that is more hollow than tool and sheet are round, and the slope (rad) where most of it is."""
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
    return float(missed.sum()), float(np.average(walls.slopes[~free], weights=missed))


class _Corner(NamedTuple):
    """What stays in an operation's corners."""

    gap: float
    """The largest, mm."""
    in_fillets: float
    """The largest in a fillet, mm."""
    square: float
    """Sum of gap^2 over the corners' areas, mm^4."""
    where: str
    """The corner of the largest."""


def _corner(tool: Tool, asked: _Asked, missed: float) -> _Corner:
    """What stays in corners: fillets count where the tool is too flat for some of the area (``missed``, mm^2)."""
    corners = asked.walls.corners
    if not len(corners.radii):
        return _Corner(0.0, 0.0, 0.0, "")
    gaps, widths = reach.gaps(tool, corners, asked.ball)
    gaps = np.where((corners.radii == 0.0) | (missed > LEAST_SHARE * asked.walls.area), gaps, 0.0)
    areas = corners.lengths * widths
    areas *= min(1.0, asked.walls.area / max(float(areas.sum()), 1e-12))
    worst = int(np.argmax(gaps))
    low, high = np.sort(np.degrees(np.arccos(np.clip(corners.sides[worst, :, 2], 0.0, 1.0))))
    radius = float(corners.radii[worst])
    kind = f"fillet of {radius:.3g} mm" if radius else "sharp corner"
    in_fillets = float(gaps[corners.radii > 0.0].max(initial=0.0))
    where = f"the {kind} between {low:.3g} and {high:.3g} deg"
    return _Corner(float(gaps[worst]), in_fillets, float(gaps**2 @ areas), where)


def _reasons(candidate: Candidate, hollow: float | None, corner: str, asked: list[_Asked]) -> tuple[str, ...]:
    tool, over, unreached = candidate.tool, candidate.over_rim, candidate.unreached
    most = max(asked, key=lambda each: float(each.classes.areas.max()))
    common = float(most.classes.angles[int(np.argmax(most.classes.areas))])
    radius = float(_radii(tool, np.radians([common]))[0][0])
    sentences = [f"scallops of {micrometres(candidate.scallop_mm)} um on average"]
    if over <= MARGIN:
        shape = "straight" if not math.isfinite(radius) else f"round with {radius:.3g} mm" if radius else "a sharp edge"
        sentences.append(f"{shape} at {common:.3g} deg, where most of the walls are")
    else:
        sentences.append(
            f"ends at {math.degrees(tool.max_slope):.3g} deg: its rim forms {100.0 * over:.2g} % of the walls"
        )
    if hollow is not None and unreached > LEAST_SHARE:
        sentences.append(f"too flat for {100.0 * unreached:.2g} % of the area, near {math.degrees(hollow):.2g} deg")
    if tool.diameter > 2.0 * SNUG * most.fits:
        sentences.append(f"wider than the part's narrow gaps: up to {2.0 * most.fits:.3g} mm fits nearly all")
    if candidate.gap_mm > LEAST_GAP:
        sentences.append(f"its profile leaves {candidate.gap_mm:.3f} mm in {corner}")
    if radius < 2.0 * most.thickness:
        sentences.append(f"sharper than two sheet thicknesses ({2.0 * most.thickness:g} mm): it may tear the sheet")
    return tuple(sentences)


def micrometres(length_mm: float) -> str:
    """A length in micrometres to three digits, without a power of ten."""
    value = 1e3 * length_mm
    return f"{value:.{0 if value >= 99.95 else 1 if value >= 9.995 else 2}f}"


def _planned(candidate: Candidate, job: Job, asked: list[_Asked], progress: Progress | None) -> Candidate:
    """The same with what planning the operations that are asked about with this tool found bridged."""
    document = _with_only(job, {each.name for each in asked})
    for name in {operation["tool"] for operation in document["operations"]}:
        section = document["tools"][name]
        for key in (*TOOL, "library"):
            section.pop(key, None)
        section |= candidate.tool.to_dict()
        section["reference"] = "tip"
    try:
        work = Job.from_dict(document, job.folder, job.target())
        plan = planning.plan(work, progress=progress)
    except (JobError, PlanError, ToolError) as error:
        failure = str(error)
        reasons = (*candidate.reasons, f"the job cannot be planned with it: {failure}")
        return replace(candidate, failure=failure, reasons=reasons)
    operations = [one for channel in plan.programs for one in plan.summary(channel=channel)[0].operations]
    following = [one for one in operations if isinstance(one, SurfaceSummary)]
    bridged = [bridge for operation in following for bridge in operation.bridged]
    faces = sorted({bridge.face for bridge in bridged})
    worst = max(bridged, key=lambda bridge: bridge.excess, default=None)
    square = _square_of(candidate, 0.0 if worst is None else worst.excess, faces, asked)
    result = "planned: it bridges nothing"
    if worst is not None:
        result = f"planned: it bridges up to {worst.excess:.3f} mm in Face{worst.face}"
        result += f" ({len(faces)} faces in all)" if len(faces) > 1 else ""
    return replace(candidate, bridged=tuple(bridged), gap_square=square, reasons=(*candidate.reasons, result))


def _square_of(candidate: Candidate, excess: float, faces: list[int], asked: list[_Asked]) -> float:
    """Mean square (mm^2) of what planning found bridged: as in the corners, or where those are not to blame, all over."""
    if candidate.gap_mm > LEAST_GAP:
        return candidate.gap_square * (excess / candidate.gap_mm) ** 2
    within = sum(float(each.walls.areas[np.isin(each.walls.ids, faces)].sum()) for each in asked)
    return excess**2 * within / sum(each.walls.area for each in asked)


def _facts(asked: list[_Asked]) -> Facts:
    angles, areas = _angles(asked)
    hollows = [hollow for each in asked if (hollow := each.walls.smallest_hollow_mm) is not None]
    area = sum(each.walls.area for each in asked)
    shares = zip(angles, areas / areas.sum(), strict=True)
    return Facts(
        passes="; ".join(dict.fromkeys(each.passes.words for each in asked)),
        operations=tuple(
            OperationFacts(each.name, each.passes.words, each.walls.faces, each.walls.area) for each in asked
        ),
        walls=tuple(WallShare(float(angle), float(share)) for angle, share in shares),
        floor_share=sum(each.walls.floor_share * each.walls.area for each in asked) / area,
        smallest_concave_radius_mm=min(hollows, default=None),
        fitting_radius_mm=asked[0].fits if math.isfinite(asked[0].fits) else None,
        sharp_concave_edges_mm=max(each.walls.crease_mm for each in asked),
    )


def _angles(asked: list[_Asked]) -> tuple[FloatArray, FloatArray]:
    """Wall angles (degrees) of all operations, floors included, in classes, and their areas (mm^2)."""
    found = [each.walls.classes(0.0) for each in asked]
    angles, areas = np.concatenate([each.angles for each in found]), np.concatenate([each.areas for each in found])
    _, number = np.unique(np.floor(angles / BIN_DEG), return_inverse=True)
    sums: FloatArray = np.bincount(number, areas).astype(np.float64)
    return np.bincount(number, angles * areas) / sums, sums


def _notes(asked: list[_Asked], job: Job) -> tuple[str, ...]:
    sentences = []
    for each in asked:
        walls, name = each.walls, f"{each.name}: " if len(asked) > 1 else ""
        if walls.floor_share > MARGIN and each.passes.rows_deg is None:
            share = 100.0 * walls.floor_share
            sentences.append(f"{name}{share:.2g} % of the area is floor: levels leave it, and it does not count")
        if walls.crease_mm > 0.0:
            sentences.append(
                f"{name}{walls.crease_mm:.0f} mm of sharp concave edges: every tool leaves something in them"
            )
    left_out = [name for name in job.engine.operation_ids() if name not in {each.name for each in asked}]
    if left_out:
        sentences.append(f"upright walls or floors alone, where tools do not differ: {', '.join(left_out)}")
    tools = {operation["tool"] for operation in job.document["operations"]}
    if len(tools) > 1:
        sentences.append(f"each tool is asked to do the work of {len(tools)}: --operation ranks for one operation")
    return tuple(sentences)
