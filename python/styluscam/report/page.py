"""The report as one HTML file: everything inside, nothing loaded."""

from __future__ import annotations

import base64
import json

import numpy as np

from styluscam.drawing.decimation import thinned
from styluscam.drawing.shapes import OTHER_TOOL, TOOL, Look, Shape
from styluscam.drawing.toolplot import tool_svg
from styluscam.programs.contents import ToolRecord
from styluscam.programs.program import SAG
from styluscam.report import clearing, flank, plots, tables
from styluscam.report.columns import packed
from styluscam.report.findings import grouped, measured, spoken, verdict_of
from styluscam.report.heatmaps import HeatMap, Shown, shown_judged, shown_plain
from styluscam.report.subject import Subject
from styluscam.report.templates import PAGE, template
from styluscam.report.vendored import three
from styluscam.tools.outline import silhouette
from styluscam.tools.tool import Tool
from styluscam.types import Document, FloatArray, Progress

SCRIPTS = ("data", "colours", "stage", "part", "path", "tool", "shapes", "layers", "player", "findings", "main")
"""In the order in which they build upon each other."""

AXIS_STEP = 1e-5
"""To which the coordinates of the tool's axis are rounded for the drawing."""

SEGMENTS = 200_000
"""Of the path as it is drawn."""

LENGTH_STEP, UNIT_STEP = 1e-4, 1e-3
"""To which the part's points (mm) and its normals are rounded for the drawing."""

SHAPE_STEP, NORMAL_STEP = 1e-3, 1e-2
"""The same for blank, formed sheet, holders and die."""

STANDING_STEP = 0.02
"""mm: the same for the sheet while it is formed."""

VALUE_STEPS = {"mm": 1e-5, "°": 1e-2}
"""To which the numbers of heat maps are rounded."""

SHOWN_STEP = 0.5
"""Distance of levels, mm, for which a tool is drawn where no operation has levels."""

COLOURS = 64
"""Steps of the colour map."""


def report_page(subject: Subject, progress: Progress | None = None) -> str:
    """The page's text. The same subject gives the same text.

    Raises:
        StylusError: jinja2 or matplotlib are missing.
        GeometryError: a part that keeps no triangles to draw, or a program without moves.
    """
    shown = _shown(subject, progress)
    verdict = verdict_of(subject.report, subject.gaps is not None)
    return str(
        template("report.html.jinja").render(
            subject=subject,
            verdict=verdict,
            figures=tables.in_words(tables.figures(subject)),
            findings=subject.findings,
            groups=grouped(subject.report),
            spoken=spoken,
            measured=measured,
            faces=tables.faces(subject),
            maps=shown.maps if shown is not None else (),
            layers=_layers(subject),
            plots=_plots(subject, shown),
            pockets=_pockets(subject),
            flanks=_flanks(subject),
            tools=_tool_pictures(subject),
            still=_still(subject),
            job=tables.job_rows(subject.job.document) if subject.job is not None else {},
            versions=tables.versions(subject),
            style=(PAGE / "style.css").read_text(encoding="utf-8"),
            three=three(),
            script="\n".join((PAGE / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS),
            data=_json(_data(subject, shown)),
        )
    )


def _json(data: Document) -> str:
    """JSON that can stand in a script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def _shown(subject: Subject, progress: Progress | None) -> Shown | None:
    if subject.surface is None:
        return None
    if subject.report is None:
        return shown_plain(subject.surface)
    return shown_judged(subject.surface, subject.report, progress)


def _plots(subject: Subject, shown: Shown | None) -> list[plots.Plot]:
    series = [plots.Series(subject.times, subject.positions[:, 2], subject.moves["feed"], subject.moves["kind"])]
    drawn = [plots.height_over_time(series), plots.feed_over_time(series)] if len(subject.positions) else []
    if shown is not None and len(shown.scallops):
        drawn.append(plots.scallop_histogram(shown.scallops, shown.weights))
    return drawn


def _pockets(subject: Subject) -> list[tuple[str, list[plots.Plot]]]:
    """Each operation that clears stock, by its id, with its plots."""
    found = subject.report.engagement if subject.report is not None else []
    return [(one.operation, clearing.over_length(one)) for one in found if len(one.distances)]


def _flanks(subject: Subject) -> list[tuple[str, list[plots.Plot]]]:
    """Each operation that mills with the side of its tool, by its id, with the maps of its surfaces."""
    if subject.report is None:
        return []
    documents = subject.report.to_dict().get("flanks", [])
    found = zip(subject.report.flanks, documents, strict=True)
    return [(one.operation, flank.surfaces(one, document["faces"])) for one, document in found]


def _tool_pictures(subject: Subject) -> list[tuple[str, str]]:
    """Name and SVG of each tool that is known."""
    step = min(_level_distances(subject), default=SHOWN_STEP)
    known = [(record, tool) for record, tool in subject.tools if tool is not None]
    return [(_tool_name(record), plots.element(tool_svg([tool], step))) for record, tool in known]


def _level_distances(subject: Subject) -> list[float]:
    """How far the levels of each operation that has any lie apart, mm."""
    if subject.job is None:
        return []
    spacings = [subject.job.engine.spacing(index) for index in range(len(_operations(subject)))]
    known = [json.loads(spacing) for spacing in spacings if spacing is not None]
    return [float(spacing["pitch"]) for spacing in known if spacing["in"] == "height"]


def _operations(subject: Subject) -> list[Document]:
    return list(subject.job.document["operations"]) if subject.job is not None else []


def _still(subject: Subject) -> str:
    """The picture for print, and for browsers without 3-D: a data URI."""
    return "data:image/png;base64," + base64.b64encode(subject.png()).decode("ascii")


# --- what the script works with ------------------------------------------------------------------------------------


def _data(subject: Subject, shown: Shown | None) -> Document:
    return {
        "part": None if shown is None else _part(shown),
        "path": _path(subject),
        "tools": [_tool(record, tool) for record, tool in subject.tools],
        "shapes": [_shape(shape) for shape in subject.around.shapes],
        "standing": _standing(subject),
        "opposite": _opposite(subject),
        "operations": [[one.id or one.kind, one.tool] for one in subject.program.operations],
        "findings": [{key: finding[key] for key in ("position", "time", "kind")} for finding in subject.findings],
        "colours": {"map": _colour_map("viridis"), "path": _colour_map("plasma")},
    }


def _part(shown: Shown) -> Document:
    vertices = shown.vertices
    return {
        "points": packed(shown.points, LENGTH_STEP),
        "borders": packed(shown.borders),
        "at": packed(vertices.at),
        "normals": packed(vertices.normals, UNIT_STEP),
        "triangles": packed(vertices.triangles),
        "merged": shown.merged,
        "maps": [_map(one) for one in shown.maps],
    }


def _map(one: HeatMap) -> Document:
    keys = ("key", "title", "unit", "low", "high", "limit", "over", "unformed", "note")
    cut = bool((one.values > one.high).any())
    return {**{key: getattr(one, key) for key in keys}, "cut": cut, "values": packed(one.values, VALUE_STEPS[one.unit])}


def _path(subject: Subject) -> Document:
    """The path twice: thinned for the drawing, exact for the readout."""
    moves, known = subject.moves, len(np.unique(subject.owners))
    changes = np.zeros(len(moves), dtype=bool)
    for column in (subject.kinds, moves["operation"], moves["feed"]):
        changes[:-1] |= column[1:] != column[:-1]
    drawn = thinned(subject.positions, changes, SEGMENTS)
    return {
        "places": packed(subject.positions),
        "axes": packed(moves["axis"], AXIS_STEP) if subject.leans else None,
        "times": packed(subject.times),
        "kinds": packed(subject.kinds),
        "moves": packed(subject.owners),
        "feeds": packed(moves["feed"]),
        "lines": packed(moves["line"]),
        "operations": packed(moves["operation"]),
        "drawn": packed(drawn.indices),
        "drawnError": drawn.error_mm,
        "sag": SAG if len(moves) > known else 0.0,
        "count": len(subject.program.moves),
        "unknown": len(subject.program.moves) - known,
    }


def _layers(subject: Subject) -> list[tuple[str, str, str]]:
    """What can be hidden around the path of a sheet: key, name and colour."""
    around = subject.around
    if not around.shapes:
        return []
    rows: list[tuple[str, str, Look]] = [(shape.key, shape.words, shape.look) for shape in around.shapes]
    rows.append(("tool", "tool", TOOL))
    if around.opposite is not None:
        rows.append(("opposite", f"tool on the other side: {around.opposite.name}", OTHER_TOOL))
    return [(key, words, "#" + bytes(look.colour).hex()) for key, words, look in rows]


def _shape(shape: Shape) -> Document:
    return {
        "key": shape.key,
        "colour": shape.look.colour,
        "opacity": shape.look.opacity,
        "vertices": packed(shape.vertices, SHAPE_STEP),
        "normals": packed(shape.normals, NORMAL_STEP),
        "triangles": packed(shape.triangles),
        "edges": packed(shape.edges),
    }


def _standing(subject: Subject) -> Document | None:
    """The formed sheet while it is formed: above its formed height, one column for each vertex; and how far a clamp went down."""
    found = subject.standing
    if found is None or subject.job is None:
        return None
    moments, heights = found
    clamp = (subject.job.document["setup"].get("fixture") or {}).get("clamp") or {}
    flat = float(subject.around.box[1, 2])
    lowest = np.minimum(np.minimum.accumulate(subject.positions[:, 2])[moments] - flat, 0.0)
    frame = lowest if clamp.get("follows") else np.zeros(len(moments))
    return {"at": packed(moments), "above": packed(heights, STANDING_STEP), "clamp": packed(frame, STANDING_STEP)}


def _opposite(subject: Subject) -> Document | None:
    """The tool on the other side of the sheet: its meridian, and its tip at every point of the path."""
    opposite = subject.around.opposite
    if opposite is None:
        return None
    profile = _meridian(opposite.tool).round(5).tolist()
    return {
        "name": opposite.name,
        "profile": profile,
        "colour": OTHER_TOOL.colour,
        "tips": packed(subject.opposite_tips, LENGTH_STEP),
    }


def _tool(record: ToolRecord, tool: Tool | None) -> Document:
    """What it is called, and its meridian from tip to top: radii and heights."""
    return {"name": _tool_name(record), "profile": [] if tool is None else _meridian(tool).round(5).tolist()}


def _tool_name(record: ToolRecord) -> str:
    return f"T{record.number}: {record.description}" if record.description else f"T{record.number}"


def _meridian(tool: Tool) -> FloatArray:
    document = tool.to_dict()
    rim = float(tool.height_at(tool.max_slope))
    return silhouette(tool, document, rim + 3.0 * tool.diameter)


def _colour_map(name: str) -> list[list[int]]:
    """Even steps for the eye, readable with any kind of colour vision; the pale end is left off."""
    from matplotlib import colormaps

    return [[round(255 * part) for part in rgb[:3]] for rgb in colormaps[name](np.linspace(0.0, 0.96, COLOURS))]
