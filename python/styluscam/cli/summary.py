"""The short summary: what a person at the machine checks first stands first."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from styluscam.programs.summary import (
    BridgedFace,
    End,
    OperationSummary,
    ReachedFace,
    Summary,
    SurfaceSummary,
    ToolLine,
)
from styluscam.types import Document
from styluscam.words import clock, counted, position


def lines_of(summary: Summary, job: Document) -> list[tuple[str, str]]:
    """Names and values: zero, offset, box, depth, tools, sheet, units and machine; then operations and figures."""
    rows = [
        ("zero", summary.zero),
        ("work offset", summary.wcs),
        ("part box", _box(summary)),
        *([("stock", summary.stock)] if summary.stock else []),
        ("deepest Z", f"{summary.deepest_z:.3f}"),
        *(("tool", _tool(tool)) for tool in summary.tools),
        *_standing_spindle(job),
        *_sheet(job),
        *(("part", change.words) for change in summary.changes),
        ("units", f"{summary.units} in the program; here mm"),
        ("machine", summary.machine),
    ]
    for operation in summary.operations:
        rows += _operation(operation)
    counted = "acceleration counted" if summary.accelerates else "without acceleration"
    rows.append(("length", f"{summary.length:.0f} mm at feed, {clock(summary.duration)}, {counted}"))
    if summary.gouge_max is not None:
        rows.append(("worst gouge", f"{summary.gouge_max:.4f} mm"))
        rows.append(("worst excess", f"{summary.excess_max:.4f} mm where the tool should touch"))
    return rows


def rows_of(summaries: Mapping[str, Summary], job: Document) -> list[tuple[str, str]]:
    """As :func:`lines_of` for each channel, named where there are several."""
    rows: list[tuple[str, str]] = []
    for channel, summary in summaries.items():
        rows += [("channel", channel)] if len(summaries) > 1 else []
        rows += lines_of(summary, job)
    return rows


def title(job: Document) -> str:
    """The job's name, or its part's."""
    return str(job["title"] or Path(job["part"]["file"]).name)


def shown_path(path: Path) -> str:
    """A path as short as it can be from here."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(path)


def _box(summary: Summary) -> str:
    pairs = zip("XYZ", summary.part_min, summary.part_max, strict=True)
    return ", ".join(f"{axis} {low:.3f} to {high:.3f}" for axis, low, high in pairs)


def _sheet(job: Document) -> list[tuple[str, str]]:
    """Which face of the sheet the model shows: a flipped one is a fault that no check of numbers can see."""
    sheet, face = job["setup"].get("sheet"), job["part"].get("model_face")
    if not sheet or not face:
        return []
    meaning = {"tool": "facing the tool", "back": "away from the tool", "mid": "its middle"}
    return [("sheet", f"{sheet['thickness']:g} mm, {sheet['law']} law; the model is its {face} face ({meaning[face]})")]


def _standing_spindle(job: Document) -> list[tuple[str, str]]:
    """That a cutter does not turn, which is a stylus's way and no cutter's."""
    if job["process"]["kind"] != "milling":
        return []
    operations = job["operations"]
    standing = sum(operation["spindle"]["mode"] == "off" for operation in operations)
    words = f"OFF in {standing} of {counted(len(operations), 'operation')}, as stated: the program does not cut"
    return [("spindle", words)] if standing else []


def _tool(tool: ToolLine) -> str:
    return f"T{tool.number} H{tool.length_offset}: {tool.description}, programmed at its {tool.reference}"


def _operation(operation: OperationSummary) -> list[tuple[str, str]]:
    rows = [("operation", f"{operation.id}: {operation.kind}, {operation.words}")]
    if not isinstance(operation, SurfaceSummary):
        return rows  # it follows no faces
    faces = ", ".join(f"Face{number}" for number in operation.faces[:12])
    more = len(operation.faces) - 12
    rows += [
        ("faces", f"{faces} and {more} more" if more > 0 else faces),
        ("wall angle", f"{operation.wall_angle_max_deg:.1f} deg at most"),
    ]
    if operation.ends:
        rows.append(("ends at", _end(operation.ends)))
    rows += _worst("reached", operation.reached, _lost_area, _reached)
    if (coarse := operation.reached_coarsely) is not None:
        rows.append(("reached", f"areas are estimated from triangles of {coarse:.3g} mm"))
    rows += _worst("bridged", operation.bridged, lambda one: one.excess, _bridged)
    rows += _worst("undercut", operation.undercut, lambda one: float(one[1]), _undercut)
    return rows


def _worst(
    name: str, faces: list[Any], lost: Callable[[Any], float], words: Callable[[Any], str]
) -> list[tuple[str, str]]:
    """A row for each face that loses something, in the order of their numbers; of many only the worst, and how many more."""
    losing = [face for face in faces if lost(face) > 0.0]
    shown = losing if len(losing) <= SHOWN + 1 else sorted(losing, key=lost, reverse=True)[:SHOWN]
    rows = [(name, words(face)) for face in losing if face in shown]
    more = len(losing) - len(rows)
    return (
        [*rows, (name, f"and {counted(more, 'more face')}, none of them worse: --json has them all")] if more else rows
    )


def _bridged(bridge: BridgedFace) -> str:
    return f"Face{bridge.face} by up to {bridge.excess:.3f} mm at {position(bridge.at)}"


def _undercut(face: tuple[int, float]) -> str:
    return f"Face{face[0]}, {face[1]:.1f} mm2 are not reached"


def _end(end: End) -> str:
    which = "the part's foot" if end.at_foot else "z_bottom"
    lowest = f"the lowest {end.untouched:.3f} mm of the walls are touched only by a deeper z_bottom"
    return f"Z{end.z:.3f}, {which}: {lowest}"


LOST = {"bridged": "bridged", "interferes": "beside something in the way", "rim": "touched by the tool's rim alone"}
"""What is reported of a face that the tool does not touch wholly at its own slope, by key of the plan."""

LEAST_AREA = 0.05
"""mm^2: areas are shown with one decimal."""


SHOWN = 8
"""Faces that are listed one by one."""


def _lost_area(face: ReachedFace) -> float:
    """mm^2; 0 for what is too little to be shown."""
    return sum(float(face[key]) for key in LOST) if _lost(face) else 0.0


def _lost(face: ReachedFace) -> list[str]:
    return [f"{face[key]:.1f} {words}" for key, words in LOST.items() if face[key] >= LEAST_AREA]


def _reached(face: ReachedFace) -> str:
    whole = sum(face[key] for key in (*LOST, "contact", "undercut"))
    return f"Face{face.face}, {face.contact:.1f} of {whole:.1f} mm2; {', '.join(_lost(face))}"
