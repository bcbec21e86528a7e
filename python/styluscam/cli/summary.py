"""The short summary: what a person at the machine checks first stands first."""

from __future__ import annotations

from pathlib import Path

from styluscam.types import Document
from styluscam.words import clock, place


def lines_of(summary: Document, job: Document) -> list[tuple[str, str]]:
    """Names and values: zero, offset, box, depth, tools, sheet, units and machine; then operations and figures."""
    rows = [
        ("zero", summary["zero"]),
        ("work offset", summary["wcs"]),
        ("part box", _box(summary)),
        ("deepest Z", f"{summary['deepest_z']:.3f}"),
        *(("tool", _tool(tool)) for tool in summary["tools"]),
        *_sheet(job),
        ("units", f"{summary['units']} in the program; here mm"),
        ("machine", summary["machine"]),
    ]
    for operation in summary["operations"]:
        rows += _operation(operation)
    counted = "acceleration counted" if summary["accelerates"] else "without acceleration"
    rows.append(("length", f"{summary['length']:.0f} mm at feed, {clock(summary['duration'])}, {counted}"))
    if summary["gouge_max"] is not None:
        rows.append(("worst gouge", f"{summary['gouge_max']:.4f} mm"))
        rows.append(("worst excess", f"{summary['excess_max']:.4f} mm where the tool should touch"))
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


def _box(summary: Document) -> str:
    pairs = zip("XYZ", summary["part_min"], summary["part_max"], strict=True)
    return ", ".join(f"{axis} {low:.3f} to {high:.3f}" for axis, low, high in pairs)


def _sheet(job: Document) -> list[tuple[str, str]]:
    """Which face of the sheet the model shows: a flipped one is a fault that no check of numbers can see."""
    sheet, face = job["setup"].get("sheet"), job["part"].get("model_face")
    if not sheet or not face:
        return []
    meaning = {"tool": "facing the tool", "back": "away from the tool", "mid": "its middle"}
    law = sheet.get("law", "constant")
    return [("sheet", f"{sheet['thickness']:g} mm, {law} law; the model is its {face} face ({meaning[face]})")]


def _tool(tool: Document) -> str:
    return f"T{tool['number']} H{tool['length_offset']}: {tool['description']}, programmed at its {tool['reference']}"


def _operation(operation: Document) -> list[tuple[str, str]]:
    level = operation["kind"] == "z-level"
    what = f"{_count(operation['passes'], 'loop')} on {_count(operation['groups'], 'level')}"
    if not level:
        what = f"{_count(operation['passes'], 'pass', 'passes')} on {_count(operation['groups'], 'row')}"
    faces = ", ".join(f"Face{number}" for number in operation["faces"][:12])
    more = len(operation["faces"]) - 12
    rows = [
        ("operation", f"{operation['id']}: {operation['kind']}, {what}"),
        ("faces", f"{faces} and {more} more" if more > 0 else faces),
        ("wall angle", f"{operation['wall_angle_max_deg']:.1f} deg at most"),
    ]
    if operation["ends"]:
        rows.append(("ends at", _end(operation["ends"])))
    rows += [("reached", _reached(face)) for face in operation["reached"] if _lost(face)]
    if (coarse := operation["reached_coarsely"]) is not None:
        rows.append(("reached", f"areas are estimated from triangles of {coarse:.3g} mm"))
    for bridge in operation["bridged"]:
        rows.append(("bridged", f"Face{bridge['face']} by up to {bridge['excess']:.3f} mm at {place(bridge['at'])}"))
    for face, area in operation["undercut"]:
        rows.append(("undercut", f"Face{face}, {area:.1f} mm2 are not reached"))
    return rows


def _end(end: Document) -> str:
    which = "the part's foot" if end["at_foot"] else "z_bottom"
    lowest = f"the lowest {end['untouched']:.3f} mm of the walls are touched only by a deeper z_bottom"
    return f"Z{end['z']:.3f}, {which}: {lowest}"


LOST = {"bridged": "bridged", "interferes": "beside something in the way", "rim": "touched by the tool's rim alone"}
"""What is said of a face that the tool does not touch wholly at its own slope, by key of the plan."""

LEAST_AREA = 0.05
"""mm^2: areas are shown with one decimal."""


def _lost(face: Document) -> list[str]:
    return [f"{face[key]:.1f} {said}" for key, said in LOST.items() if face[key] >= LEAST_AREA]


def _reached(face: Document) -> str:
    whole = sum(face[key] for key in (*LOST, "contact", "undercut"))
    return f"Face{face['face']}, {face['contact']:.1f} of {whole:.1f} mm2; {', '.join(_lost(face))}"


def _count(number: int, one: str, many: str = "") -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"
