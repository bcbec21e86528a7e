"""Pictures by which one chooses a tool (extra ``plot``): its profile to scale, its curvature, the scallops it leaves."""

from __future__ import annotations

import contextlib
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from styluscam.errors import ToolError
from styluscam.extras import require
from styluscam.files import drawn_whole
from styluscam.tools.outline import polyline, silhouette
from styluscam.tools.scallop import scallop_of_step
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE, DPI = (12.0, 6.0), 100
"""Inches, and pixels per inch of a PNG."""

INK, SOFT, GRID = "#1f2933", "#69758a", "#e4e8ee"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7a4ea3", "#1f2933")
"""Distinct with any kind of colour vision (Okabe and Ito); as many tools fit in one picture."""
DASHES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)))
"""Beside the colours, for prints without any."""

WALLS_DEG = np.concatenate([np.arange(1.0, 10.0, 0.5), np.arange(10.0, 84.0, 1.0), np.arange(84.0, 89.91, 0.1)])
"""Wall angles at which scallops are computed; besides them, the one at which a profile ends."""

WHOLE = 0.2
"""Of the profiles' width for the whole tools beside them, where one has a holder."""

RIM_DEG = 0.01
"""Beyond a profile's end its rim cuts: what it leaves begins here."""

WIDE = 30.0
"""Ratio of the largest to the smallest radius of curvature from which the axis is logarithmic."""

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "svg.fonttype": "path",
    "svg.hashsalt": "styluscam",
    "path.simplify": True,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
}


@dataclass(frozen=True)
class _Drawn:
    """A tool with its looks."""

    tool: Tool
    label: str
    colour: str
    dash: Any


def tool_picture(tools: Sequence[Tool], path: str | Path, step_mm: float = 0.5) -> None:
    """Draws tools: profiles over each other to scale, radius of curvature by slope, scallop by wall angle.

    ``step_mm`` is the step down between Z-levels, for the scallops. The ending chooses SVG or PNG (1200 x 600).

    Raises:
        ToolError: no tool or too many, a step that is no length, an ending that is neither.
        StylusError: matplotlib is missing, or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in (".svg", ".png"):
        hint = f"call it {path.stem}.svg"
        raise ToolError(f"{path}: pictures of tools end in .svg or .png", code="ending", where=str(path), hint=hint)
    with _drawn(tools, step_mm) as figure:
        _save(figure, path)


def tool_svg(tools: Sequence[Tool], step_mm: float = 0.5) -> str:
    """As :func:`tool_picture`, the text of the SVG file."""
    text = io.StringIO()
    with _drawn(tools, step_mm) as figure:
        figure.savefig(text, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    return text.getvalue()


@contextlib.contextmanager
def _drawn(tools: Sequence[Tool], step_mm: float) -> Iterator[Figure]:
    """The picture of some tools, in the style in which it is to be saved."""
    if not 1 <= len(tools) <= len(COLOURS):
        message = f"{len(tools)} tools: a picture shows 1 to {len(COLOURS)}"
        raise ToolError(message, code="out-of-range", where="tools", hint="leave some out")
    if not 0.0 < step_mm <= 100.0:
        raise ToolError(f"step_mm = {step_mm:g}: above 0 and up to 100 mm", code="out-of-range", where="step_mm")
    figure = _figure()
    from matplotlib import rc_context

    with rc_context(STYLE):
        _draw(figure, _looks(tools), step_mm)
        yield figure


def _looks(tools: Sequence[Tool]) -> list[_Drawn]:
    return [
        _Drawn(tool, _label(tool), COLOURS[i], DASHES[i % len(DASHES)] if len(tools) > 1 else "-")
        for i, tool in enumerate(tools)
    ]


def _label(tool: Tool) -> str:
    return f"{tool.name} ({tool.description})" if tool.name else tool.description


def _figure() -> Figure:
    require("plot", "a picture")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def _draw(figure: Figure, tools: list[_Drawn], step_mm: float) -> None:
    rows = (len(tools) + 1) // 2 if len(tools) > 1 else 1
    top = 0.875 - 0.042 * (rows - 1)
    _legend(figure, tools)
    bottom, middle = 0.105, 0.095
    height = (top - bottom - middle) / 2.0
    held = any(drawn.tool.to_dict().get("holder") for drawn in tools)
    width = 0.425 * (1.0 - WHOLE) if held else 0.425
    _profiles(figure.add_axes((0.055, bottom, width, top - bottom)), tools)
    if held:
        _whole(figure.add_axes((0.065 + width, bottom, 0.425 - width, top - bottom)), tools)
    curvature = figure.add_axes((0.565, bottom + height + middle, 0.415, height))
    scallops = figure.add_axes((0.565, bottom, 0.415, height), sharex=curvature)
    _curvature(curvature, tools)
    _scallops(scallops, tools, step_mm)


def _legend(figure: Figure, tools: list[_Drawn]) -> None:
    """One tool: its name as a title. Several: two columns of lines and names."""
    from matplotlib.lines import Line2D

    if len(tools) == 1:
        tool = tools[0].tool
        figure.text(
            0.03, 0.948, tool.name or tool.description, va="center", fontsize=16, weight="bold", parse_math=False
        )
        facts = _facts(tool) if not tool.name else f"{tool.description}, {_facts(tool)}"
        line = f"{tool.title}; {facts}" if tool.title else facts
        figure.text(
            0.98, 0.948, line if len(line) < 96 else facts, ha="right", va="center", color=SOFT, parse_math=False
        )
        return
    for number, drawn in enumerate(tools):
        x, y = (0.03, 0.52)[number % 2], 0.958 - 0.045 * (number // 2)
        sample = Line2D([x, x + 0.032], [y, y], color=drawn.colour, linestyle=drawn.dash, linewidth=2.4)
        figure.add_artist(sample)
        label = drawn.label if len(drawn.label) <= 62 else drawn.label[:60] + "..."
        figure.text(x + 0.04, y, label, va="center", fontsize=10.5, parse_math=False)


def _facts(tool: Tool) -> str:
    height = float(tool.height_at(tool.max_slope))
    if height == 0.0:
        return "flat: its sharp corner does the work"
    return f"{height:.3g} mm high, slopes to {np.degrees(tool.max_slope):.3g}°"


# --- the profile ---------------------------------------------------------------------------------------------------


def _profiles(axes: Axes, tools: list[_Drawn]) -> None:
    """Sections through the axis, tips at the origin; the shanks are cut off."""
    widest = max(max(drawn.tool.diameter, _shank(drawn.tool)) for drawn in tools)
    highest = max(_height(drawn.tool) for drawn in tools)
    box = axes.get_position()
    ratio = box.height * SIZE[1] / (box.width * SIZE[0])
    width = max(1.12 * widest, (1.12 * highest + 0.2 * widest) / ratio)
    bottom, top = -0.07 * width * ratio, 0.93 * width * ratio
    for drawn in tools:
        right = _section(drawn.tool, top)
        outline = np.concatenate([right[::-1] * [-1.0, 1.0], right])
        axes.fill(*outline.T, color=drawn.colour, alpha=0.13 if len(tools) == 1 else 0.1 / len(tools), linewidth=0)
        axes.plot(*outline.T, color=drawn.colour, linestyle=drawn.dash, linewidth=2.0, solid_joinstyle="round")
        flat = float(drawn.tool.radius_range_at(0.0)[1])
        if flat > 0.0:
            axes.plot([-flat, flat], [0.0, 0.0], color=drawn.colour, linewidth=4.0, solid_capstyle="butt", zorder=4)
        if len(tools) == 1:
            _base_line(axes, drawn)
    axes.axvline(0.0, color=SOFT, linewidth=0.8, linestyle=(0, (8, 3, 1.5, 3)), zorder=1)
    axes.set(xlim=(-width / 2.0, width / 2.0), ylim=(bottom, top), aspect="equal")
    _clean(axes, "radius, mm", "height over the tip, mm")
    axes.xaxis.set_major_formatter(lambda value, _: f"{abs(value):g}")


def _section(tool: Tool, top: float) -> FloatArray:
    """Radii and heights (N, 2) from the tip over base and shank up to a height."""
    document = tool.to_dict()
    return silhouette(tool, {key: document[key] for key in ("base", "shank_diameter") if key in document}, top)


def _whole(axes: Axes, tools: list[_Drawn]) -> None:
    """The whole tools, shanks and holders, to a scale of their own."""
    for drawn in tools:
        right = silhouette(drawn.tool, drawn.tool.to_dict(), 2.0 * _height(drawn.tool))
        outline = np.concatenate([right[::-1] * [-1.0, 1.0], right])
        axes.fill(*outline.T, color=drawn.colour, alpha=0.13 / len(tools), linewidth=0)
        axes.plot(*outline.T, color=drawn.colour, linestyle=drawn.dash, linewidth=1.2, solid_joinstyle="round")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12, 0.03)
    axes.axis("off")


def _shank(tool: Tool) -> float:
    return float(tool.to_dict().get("shank_diameter") or tool.diameter)


def _height(tool: Tool) -> float:
    """Of profile and base, mm."""
    base = tool.to_dict().get("base") or {}
    return float(tool.height_at(tool.max_slope)) + float(base.get("height", 0.0))


def _base_line(axes: Axes, drawn: _Drawn) -> None:
    """Where the profile ends."""
    rim = polyline(drawn.tool)[-1]
    axes.plot([-rim[0], rim[0]], [rim[1], rim[1]], color=drawn.colour, linewidth=0.9, linestyle=(0, (4, 3)), zorder=2)


# --- curvature and scallops ----------------------------------------------------------------------------------------


def _curvature(axes: Axes, tools: list[_Drawn]) -> None:
    """Radius of curvature by slope; straight parts and edges have none and are marked at the frame."""
    curves = [_radii(drawn.tool) for drawn in tools]
    finite = np.concatenate([radii[np.isfinite(radii) & (radii > 0.0)] for _, radii in curves])
    low, high = (finite.min(), finite.max()) if len(finite) else (1.0, 1.0)
    logarithmic = high > WIDE * low
    if logarithmic:
        low, high = max(low, high / 1e3) / 1.5, min(high, 100.0 * float(np.median(finite))) * 1.5
        axes.set_yscale("log")
    else:
        low, high = 0.0, 1.25 * high
    straight = [_straight(drawn.tool) for drawn in tools]
    for drawn, (slopes, radii), flat in zip(tools, curves, straight, strict=True):
        shown = np.where(np.isfinite(radii) & (radii > 0.0), radii, np.nan)
        axes.plot(np.degrees(slopes), shown, color=drawn.colour, linestyle=drawn.dash, linewidth=2.0)
        edges = np.where(radii == 0.0, low, np.nan)
        axes.plot(np.degrees(slopes), edges, color=drawn.colour, linewidth=6.0, alpha=0.5, solid_capstyle="butt")
        axes.plot(flat, [0.97 * high] * len(flat), "^", color=drawn.colour, markersize=7.0, clip_on=False, zorder=4)
    axes.set_ylim(low, high)
    if logarithmic:
        _decades(axes)
    _clean(axes, "", "radius of\ncurvature, mm")
    axes.tick_params(labelbottom=False)
    marks = ["triangle: a straight part"] if any(straight) else []
    marks += ["bar: a sharp edge"] if any((radii == 0.0).any() for _, radii in curves) else []
    axes.set_title("by slope of the profile" + (f" ({', '.join(marks)})" if marks else ""), **_title())


def _straight(tool: Tool) -> list[float]:
    """Slopes (degrees) of the straight parts."""
    return [math.degrees(part.slopes[0]) for part in tool.outline() if part.straight]


def _radii(tool: Tool) -> tuple[FloatArray, FloatArray]:
    """Slopes (rad) and radii of curvature, mm: 0 at an edge, where the slope turns at one point."""
    top = float(tool.max_slope)
    slopes = np.concatenate([np.geomspace(1e-3, 0.02, 25), np.linspace(0.02, 1.0, 361)[1:]]) * top
    slopes = np.concatenate([slopes, [top + 2e-9, np.pi / 2.0]]) if top < np.pi / 2.0 - 1e-6 else slopes
    radii = np.asarray(tool.curvature_radius_at(np.minimum(slopes, top)))
    still = np.abs(np.gradient(tool.radius_at(np.minimum(slopes, top)))) < 1e-12
    raised = np.abs(np.gradient(tool.height_at(np.minimum(slopes, top)))) < 1e-12
    return slopes, np.where((still & raised) | (slopes > top + 1e-9), 0.0, radii)


def _scallops(axes: Axes, tools: list[_Drawn], step_mm: float) -> None:
    """Scallop between Z-levels by wall angle, in micrometres; beyond the profile's last slope its rim cuts: thin."""
    ends = [float(np.degrees(drawn.tool.max_slope)) for drawn in tools]
    walls = [np.unique(np.append(WALLS_DEG, [end, end + RIM_DEG])) for end in ends]
    walls = [angles[(angles >= WALLS_DEG[0]) & (angles <= WALLS_DEG[-1])] for angles in walls]
    heights = [1e3 * scallop_of_step(drawn.tool, angles, step_mm) for drawn, angles in zip(tools, walls, strict=True)]
    seen = np.concatenate([height[angles >= 12.0] for height, angles in zip(heights, walls, strict=True)])
    seen = seen[np.isfinite(seen) & (seen > 1e-3)]
    axes.set_yscale("log")
    for drawn, angles, height, end in zip(tools, walls, heights, ends, strict=True):
        for part, width in ((angles <= end + 1e-9, 2.0), (angles > end - 1e-9, 0.9)):
            axes.plot(angles, np.where(part, height, np.nan), color=drawn.colour, linestyle=drawn.dash, linewidth=width)
    if len(seen):
        axes.set_ylim(max(seen.min(), 0.01) / 1.6, seen.max() * 1.6)
    _decades(axes)
    axes.set_xlim(0.0, 90.0)
    axes.set_xticks(range(0, 91, 15))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}°")
    _clean(axes, "slope of the profile, wall angle", "scallop, µm")
    thin = "" if all(drawn.tool.max_slope > np.radians(89.0) for drawn in tools) else "; thin: cut by the rim"
    axes.set_title(f"by wall angle, Z-levels {step_mm:g} mm apart{thin}", **_title())


def _decades(axes: Axes) -> None:
    """Plain numbers on a logarithmic axis, between the powers of ten too where there are few of those."""
    from matplotlib.ticker import LogLocator, NullFormatter

    low, high = axes.get_ylim()
    subs = (1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,)
    axes.yaxis.set_major_locator(LogLocator(10.0, subs=subs, numticks=12))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())


def _title() -> dict[str, Any]:
    return {"loc": "right", "fontsize": 10, "color": SOFT, "pad": 5}


def _clean(axes: Axes, x: str, y: str) -> None:
    axes.set_xlabel(x, fontsize=10.5)
    axes.set_ylabel(y, fontsize=10.5)
    axes.grid(True, which="major", color=GRID, linewidth=0.9)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=9.5, length=3)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _save(figure: Figure, path: Path) -> None:
    """Writes the picture to a temporary name and renames it; the same tools give the same bytes."""
    kind = path.suffix.lower()[1:]
    with drawn_whole(path) as name:
        figure.savefig(name, format=kind, dpi=DPI, metadata={"Software": None} if kind == "png" else {"Date": None})
