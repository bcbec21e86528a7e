"""Pictures of parts and paths (extra ``plot``): shaded by the exact normals, drawn with matplotlib."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from styluscam.arguments import channel_of
from styluscam.drawing.canvas import FINER, INK, PNG, SECTION, SIZE, SOFT, new_figure, pane, save
from styluscam.drawing.decimation import thinned
from styluscam.drawing.raster import Raster, View, rasterise
from styluscam.drawing.shapes import Around, around_plan
from styluscam.drawing.sheet_pane import edges, moment, names, section_pane, tinted
from styluscam.drawing.solids import DIE, Solid
from styluscam.errors import GeometryError, PlanError
from styluscam.parts.arrays import PartArrays
from styluscam.parts.part import Part
from styluscam.programs.job import MAIN_CHANNEL
from styluscam.programs.planning import Plan
from styluscam.programs.program import RAPID, Program
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray, IntArray
from styluscam.words import clock

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import LineCollection
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure

MATERIALS = ((0.93, 0.76, 0.42), (0.80, 0.83, 0.87), (0.74, 0.56, 0.38), (0.36, 0.70, 0.63))
"""Of a tool, a part or sheet, a die, a tool from below: brass, steel, wood, verdigris; by the numbers of faces."""
PASTELS = (
    (0.96, 0.80, 0.66), (0.70, 0.83, 0.93), (0.78, 0.90, 0.70), (0.93, 0.75, 0.80), (0.84, 0.78, 0.93),
    (0.97, 0.91, 0.66), (0.68, 0.89, 0.86), (0.90, 0.83, 0.74),
)  # fmt: skip
"""Neighbours in the numbering differ."""
NO_FACE = -9
LIGHT = np.array([-0.45, 0.55, 0.70])
"""Towards the lamp: right, up and towards the eye."""
MOVES = 60_000
"""Of a path on one picture, about: more are no finer than its pixels."""
MARGIN = 0.03
"""Left and right of the titles, as a share of the width."""
LABEL = 40
"""Pixels that the numbers of a ruler need beside one another."""
LABELS = 60
"""Names on one picture at most: the largest faces get theirs."""


def part_picture(part: Part | PartArrays, path: str | Path) -> None:
    """Draws a part from above and from below, each face with its name where it is seen; PNG, 1200 x 800.

    Raises:
        StylusError: matplotlib is missing, or the file cannot be written.
        GeometryError: the part is nothing but an engine's mesh.
    """
    arrays = arrays_of(part)
    solid = Solid.of(arrays)
    views = [View(-58.0, 52.0, SIZE[0] // 2, 660), View(122.0, -30.0, SIZE[0] // 2, 660)]
    frames = [view.framed(solid.vertices, 42.0) for view in views]
    scale = min(view.scale for view in frames)
    frames = [View(v.azimuth_deg, v.elevation_deg, v.width, v.height, scale, v.middle) for v in frames]
    rasters = [rasterise(view.finer(FINER), solid.vertices, solid.triangles) for view in frames]
    labels = {face.id: face.name for face in arrays.faces}
    shown = _shares(rasters, solid.faces)

    figure = new_figure()
    for column, (view, raster) in enumerate(zip(frames, rasters, strict=True)):
        axes = pane(figure, (column * 600, 60, 600, 660))
        axes.imshow(_shaded(view, raster, solid, by_face=True), extent=(0, view.width, view.height, 0))
        _triad(axes, view)
        numbers = [face for face, best in shown.items() if best == column]
        _name_faces(axes, raster, solid.faces, {face: labels.get(face, f"Face{face}") for face in numbers})
        axes.text(300, 22, ("from above", "from below")[column], ha="center", va="center", color=SOFT, fontsize=11)
    low, high = solid.box
    size = " x ".join(f"{b - a:.4g}" for a, b in zip(low, high, strict=True))
    figure.text(0.5, 0.955, Path(arrays.source).name, ha="center", va="center", color=INK, fontsize=16, weight="bold")
    figure.text(0.5, 0.915, f"{size} mm, {len(labels)} faces", ha="center", va="center", color=SOFT, fontsize=12)
    unseen = [name for face, name in labels.items() if face not in shown]
    if unseen:
        listed = ", ".join(unseen[:12]) + (f" and {len(unseen) - 12} more" if len(unseen) > 12 else "")
        figure.text(0.5, 0.03, f"not seen from here: {listed}", ha="center", va="center", color=SOFT, fontsize=10)
    save(figure, Path(path))


def program_picture(
    part: Part | PartArrays | None,
    program: Program,
    path: str | Path,
    frame: npt.ArrayLike | None = None,
    tool: Tool | None = None,
    *,
    title: str = "",
    around: Around | None = None,
) -> None:
    """Draws a part and the path of a tool's tip over it, coloured by Z; PNG, 1200 x 800.

    ``frame`` holds the rows (3, 4) from the part's coordinates to the program's. What the part hides of the path
    is left out; rapids are thin. ``tool`` is drawn where it stands halfway. ``title`` goes before the program's own.
    With a sheet ``around`` it, the picture shows that instead of the part, formed and flat, with what holds it, the die and
    the tool on its other side, and a section through all of them.

    Raises:
        StylusError: matplotlib is missing, or the file cannot be written.
        GeometryError: the part is nothing but an engine's mesh; without a part, a program without moves.
    """
    save(_program_figure(part, program, frame, tool, title=title, around=around), Path(path))


def program_png(
    part: Part | PartArrays | None,
    program: Program,
    frame: npt.ArrayLike | None = None,
    tool: Tool | None = None,
    *,
    title: str = "",
    around: Around | None = None,
) -> bytes:
    """As :func:`program_picture`, the file's bytes."""
    data = io.BytesIO()
    _program_figure(part, program, frame, tool, title=title, around=around).savefig(data, **PNG)
    return data.getvalue()


def _program_figure(
    part: Part | PartArrays | None,
    program: Program,
    frame: npt.ArrayLike | None,
    tool: Tool | None,
    *,
    title: str,
    around: Around | None,
) -> Figure:
    if around is not None and around.shapes:
        return _sheet_figure(program, tool, title, around)
    solid = Solid.none()
    if part is not None:
        solid = Solid.of(arrays_of(part), None if frame is None else np.asarray(frame, dtype=np.float64))
    view = View(-62.0, 54.0, SIZE[0] - 120, SIZE[1] - 80)
    box, stands = _path_box(program) if part is None else solid.box, _halfway(program, view)
    view = view.framed(_corners(box), 62.0)
    if tool is not None and stands is not None:
        tip, axis = stands
        solid += Solid.of_tool(tool, tip, _tool_height(tool, tip, box), axis=axis)
    raster = rasterise(view.finer(FINER), solid.vertices, solid.triangles)

    figure = new_figure()
    axes = pane(figure, (0, 0, view.width, view.height))
    if len(solid.triangles):
        axes.imshow(_shaded(view, raster, solid, by_face=False), extent=(0, view.width, view.height, 0))
    _rulers(axes, view, box)
    drawn = _path(axes, view, raster, program, box)
    _titles(figure, program, title)
    if drawn is not None:
        _scale(figure, drawn)
    return figure


def _tool_height(tool: Tool, tip: FloatArray, box: FloatArray) -> float:
    """How high a tool is drawn that has no length, mm."""
    return max(float(box[1, 2] + 0.2 * np.linalg.norm(box[1] - box[0]) - tip[2]), 2.0 * tool.diameter)


def _sheet_figure(program: Program, tool: Tool | None, title: str, around: Around) -> Figure:
    """Above the sheet as one looks at it, below the section through it."""
    box = around.box
    tip, other = moment(program, float(box[:, 1].mean()), around.opposite)
    opaque = [shape for shape in around.shapes if shape.look.opacity == 1.0]
    through = [shape for shape in around.shapes if shape.look.opacity < 1.0]
    solid = Solid.none()
    for shape in opaque:
        solid += Solid.of_shape(shape, DIE if shape.key == "die" else 1)
    view = View(-62.0, 54.0, SIZE[0] - 120, SIZE[1] - 80 - SECTION)
    view = view.framed(np.concatenate([shape.vertices for shape in around.shapes]), 56.0)
    if tool is not None and np.isfinite(tip).all():
        solid += Solid.of_tool(tool, tip, _tool_height(tool, tip, box))
    if around.opposite is not None and np.isfinite(other).all():
        below = around.opposite.tool
        solid += Solid.of_tool(below, other, float(np.linalg.norm(box[1] - box[0])) / 3.0, down=True)
    raster = rasterise(view.finer(FINER), solid.vertices, solid.triangles)

    figure = new_figure()
    axes = pane(figure, (0, SECTION, view.width, view.height))
    extent = (0, view.width, view.height, 0)
    axes.imshow(_shaded(view, raster, solid, by_face=False), extent=extent)
    for shape in opaque:
        edges(axes, view, raster, shape, box)
    for shape in through:
        axes.imshow(tinted(view, raster, shape, box), extent=extent)
        edges(axes, view, raster, shape, box)
    _rulers(axes, view, around.whole)
    drawn = _path(axes, view, raster, program, box)
    section_pane(figure, around, tool, (tip, other))
    names(figure, around, tool)
    _titles(figure, program, title)
    if drawn is not None:
        _scale(figure, drawn, bottom=0.44)
    return figure


def plan_picture(plan: Plan, path: str | Path, channel: str = MAIN_CHANNEL) -> None:
    """As :func:`program_picture`, for a plan's part and the program of a channel.

    Raises:
        PlanError: the plan has no such channel.
    """
    channel_of(channel, plan.programs, PlanError)
    program = plan.programs[channel]
    tools = plan.job.tools()
    tool = tools[program.tools[0].name] if program.tools else None
    frame = plan.settings[channel].scene.frame
    program_picture(plan.job.part(), program, path, frame, tool, around=around_plan(plan, channel))


def arrays_of(part: Part | PartArrays) -> PartArrays:
    """What there is to draw of a part.

    Raises:
        GeometryError: the part is nothing but an engine's mesh.
    """
    arrays = part.arrays if isinstance(part, Part) else part
    if arrays is None:
        message = "a part made from arrays keeps none to draw: read it from a file"
        raise GeometryError(message, code="no-arrays", hint="use Part.read or Part.from_arrays")
    return arrays


# --- the part ------------------------------------------------------------------------------------------------------


def _shaded(view: View, raster: Raster, solid: Solid, by_face: bool) -> npt.NDArray[np.float64]:
    """The image (H, W, 4): lit surfaces, dark lines where faces meet, nothing where there is no part."""
    hit = raster.triangle >= 0
    triangle = raster.triangle[hit]
    normals = np.einsum("pk,pkc->pc", raster.weights[hit], solid.normals[triangle]) @ view.axes.T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    normals *= np.where(normals[:, 2:] < 0.0, -1.0, 1.0)
    faces = solid.faces[triangle]
    base = np.array(PASTELS)[faces % len(PASTELS)] if by_face else np.array(MATERIALS)[np.minimum(faces, 1)]
    image = np.zeros((*hit.shape, 4))
    image[hit, :3] = np.clip(base * _light(normals)[:, None] + _gloss(normals)[:, None], 0.0, 1.0)
    image[hit, 3] = 1.0
    edge = _borders(np.where(hit, solid.faces[np.where(hit, raster.triangle, 0)], NO_FACE))
    image[edge] = np.where(hit[edge][:, None], image[edge] * [0.35, 0.37, 0.40, 1.0], [0.3, 0.33, 0.37, 1.0])
    return _averaged(image)


def _light(normals: FloatArray) -> FloatArray:
    lamp = LIGHT / np.linalg.norm(LIGHT)
    return np.asarray(0.46 + 0.42 * np.clip(normals @ lamp, 0.0, None) + 0.16 * normals[:, 2])


def _gloss(normals: FloatArray) -> FloatArray:
    half = LIGHT / np.linalg.norm(LIGHT) + np.array([0.0, 0.0, 1.0])
    return np.asarray(0.10 * np.clip(normals @ (half / np.linalg.norm(half)), 0.0, None) ** 24)


def _borders(faces: IntArray) -> npt.NDArray[np.bool_]:
    """Pixels (H, W) beside another face."""
    edge = np.zeros(faces.shape, dtype=bool)
    for axis in (0, 1):
        differs = np.diff(faces, axis=axis) != 0
        ahead = (slice(1, None), slice(None)) if axis == 0 else (slice(None), slice(1, None))
        behind = (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))
        edge[ahead] |= differs
        edge[behind] |= differs
    return edge


def _averaged(image: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Blocks of pixels become one; colour counts as much as it covers."""
    height, width = image.shape[0] // FINER, image.shape[1] // FINER
    image = image.copy()
    image[..., :3] *= image[..., 3:]
    small: npt.NDArray[np.float64] = image.reshape(height, FINER, width, FINER, 4).mean(axis=(1, 3))
    small[..., :3] /= np.maximum(small[..., 3:], 1e-9)
    return np.clip(small, 0.0, 1.0)


# --- names of faces ------------------------------------------------------------------------------------------------


def _shares(rasters: Sequence[Raster], faces: IntArray) -> dict[int, int]:
    """Each visible face, largest first, with the picture that shows most of it."""
    size = int(faces.max()) + 1
    counts = np.array([np.bincount(faces[r.triangle[r.triangle >= 0]], minlength=size) for r in rasters])
    order = np.argsort(-counts.max(axis=0), kind="stable")
    visible = [int(face) for face in order if counts[:, face].max() > 8 * FINER * FINER]
    return {face: int(counts[:, face].argmax()) for face in visible}


def _name_faces(axes: Axes, raster: Raster, faces: IntArray, names: dict[int, str]) -> None:
    """Each face's name on it where it fits, else beside it with a line to it; names do not overlap."""
    seen = np.where(raster.triangle >= 0, faces[np.where(raster.triangle >= 0, raster.triangle, 0)], 0)
    coarse = 4 * FINER
    seen = seen[coarse // 2 :: coarse, coarse // 2 :: coarse]
    spots = {face: _spot(seen == face) for face in list(names)[:LABELS]}
    limits = (axes.get_xlim()[1], axes.get_ylim()[0])
    taken = [(4.0 * spot[0][0] + 2.0, 4.0 * spot[0][1] + 2.0, 2.0, 2.0) for spot in spots.values() if spot is not None]
    for face, spot in spots.items():
        if spot is None:
            continue
        x, y, room = 4.0 * spot[0][0] + 2.0, 4.0 * spot[0][1] + 2.0, 4.0 * spot[1]
        half = (4.2 * len(names[face]) + 4.0, 10.0)
        taken.remove((x, y, 2.0, 2.0))
        at = _free_spot((x, y), room, half, taken, limits)
        taken += [(x, y, 2.0, 2.0), (at[0], at[1], *half)]
        style = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": SOFT, "linewidth": 0.6, "alpha": 0.92}
        if at != (x, y):
            axes.plot([x, at[0]], [y, at[1]], color=INK, linewidth=0.8, zorder=3)
            axes.plot([x], [y], marker="o", markersize=3.0, color=INK, zorder=4)
        axes.text(*at, names[face], ha="center", va="center", fontsize=9, color=INK, bbox=style, zorder=5)


def _spot(mask: npt.NDArray[np.bool_]) -> tuple[tuple[int, int], int] | None:
    """The column and row farthest inside a mask, and how far inside that is."""
    if not mask.any():
        return None
    depth, inside = 0, np.pad(mask, 1)
    last = inside
    while inside.any():
        last, depth = inside, depth + 1
        cross = inside[1:-1, :-2] & inside[1:-1, 2:] & inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, 1:-1]
        inside = np.pad(cross, 1)
    rows, columns = np.nonzero(last[1:-1, 1:-1])
    nearest = int(np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2))
    return (int(columns[nearest]), int(rows[nearest])), depth


def _free_spot(
    spot: tuple[float, float],
    room: float,
    half: tuple[float, float],
    taken: list[tuple[float, float, float, float]],
    limits: tuple[float, float],
) -> tuple[float, float]:
    """The spot itself, or the nearest spot around it that is free."""

    def free(x: float, y: float) -> bool:
        inside = half[0] < x < limits[0] - half[0] and half[1] < y < limits[1] - half[1]
        return inside and all(
            abs(x - tx) > half[0] + tw + 3 or abs(y - ty) > half[1] + th + 3 for tx, ty, tw, th in taken
        )

    if room >= half[1] and free(*spot):
        return spot
    for radius in range(26, 400, 12):
        for turn in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
            x, y = spot[0] + 1.4 * radius * np.cos(turn), spot[1] + radius * np.sin(turn)
            if free(x, y):
                return float(x), float(y)
    return spot


def _triad(axes: Axes, view: View) -> None:
    """Where X, Y and Z point."""
    x, y = 46.0, view.height - 46.0
    for vector, name, color in zip(np.eye(3), "XYZ", ("#c0392b", "#2e8b57", "#2563eb"), strict=True):
        right, up, _ = view.axes @ vector
        style = {"arrowstyle": "-|>", "color": color, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x + 32.0 * right, y - 32.0 * up), (x, y), arrowprops=style)
        axes.text(x + 42.0 * right, y - 42.0 * up, name, color=color, ha="center", va="center", fontsize=9)


def _path_box(program: Program) -> FloatArray:
    """Lower and upper corner (2, 3) of where the program goes, mm; a little more where that is flat."""
    ends, kinds = _places(program)
    known = np.isfinite(ends).all(axis=1)
    at_feed = known & (kinds != RAPID)
    ends = ends[at_feed if at_feed.any() else known]
    if not len(ends):
        raise GeometryError("the program has no moves: nothing to draw", code="nothing-to-draw", hint="check the file")
    box = np.array([ends.min(axis=0), ends.max(axis=0)])
    least = max(0.02 * float(np.linalg.norm(box[1] - box[0])), 1e-3)
    flat = np.maximum(least - (box[1] - box[0]), 0.0) / 2.0
    return np.asarray(box + np.array([-flat, flat]))


# --- the path ------------------------------------------------------------------------------------------------------


def _halfway(program: Program, view: View) -> tuple[FloatArray, FloatArray] | None:
    """Tip and axis halfway along the path, and at that depth where the tool hides least: at the back."""
    ends, moves = program.polyline
    kept = (program.moves["kind"][moves] != RAPID) & np.isfinite(ends).all(axis=1)
    ends, axes = ends[kept], program.moves["axis"][moves][kept]
    if not len(ends):
        return None
    level = ends[len(ends) // 3]
    same = ends[np.abs(ends[:, 2] - level[2]) < 1e-6]
    right, _, towards = view.axes
    tip = np.asarray(same[int(np.argmax(same @ (0.6 * right - towards)))])
    return tip, axes[int(np.argmin(np.linalg.norm(ends - tip, axis=1)))]


def _corners(box: FloatArray) -> FloatArray:
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def _places(program: Program) -> tuple[FloatArray, npt.NDArray[np.uint8]]:
    """Positions along the path and the kind of the move that leads to each."""
    positions, moves = program.polyline
    return positions, program.moves["kind"][moves]


def _path(axes: Axes, view: View, raster: Raster, program: Program, box: FloatArray) -> LineCollection | None:
    """Draws what is seen of the moves; the lines by Z, for their scale."""
    from matplotlib.collections import LineCollection

    ends, kinds = _places(program)
    placed = np.isfinite(ends).all(axis=1)
    ends, kinds = ends[placed], kinds[placed]
    if len(ends) < 2:
        return None
    stays = thinned(ends, np.append(kinds[1:] != kinds[:-1], True), MOVES).indices
    ends, kinds = ends[stays], kinds[stays]
    size = float(np.linalg.norm(box[1] - box[0]))
    starts, stops, rapid = _pieces(ends, kinds[1:] == RAPID, size / 150.0)
    middles = (starts + stops) / 2.0
    hidden = raster.hides(view.finer(FINER).project(middles), size / 250.0)
    lines = np.stack([view.project(starts)[:, :2], view.project(stops)[:, :2]], axis=1)
    thin = rapid & ~hidden & (middles[:, 2] <= box[1, 2] + 0.2 * size)
    axes.add_collection(LineCollection(list(lines[thin]), colors=SOFT, linewidths=0.5, alpha=0.6, zorder=2))
    fat = ~rapid & ~hidden
    depth = middles[~rapid, 2]
    drawn = LineCollection(list(lines[fat]), cmap=_colours(), linewidths=_width(lines[fat]), capstyle="round", zorder=3)
    drawn.set_array(middles[fat, 2])
    drawn.set_clim(*((depth.min(), depth.max()) if len(depth) else (0.0, 1.0)))
    axes.add_collection(drawn)
    return drawn


def _colours() -> Colormap:
    """Turbo without its dark ends, which look alike on steel."""
    from matplotlib import colormaps
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("depth", colormaps["turbo"](np.linspace(0.07, 0.93, 64)))


def _width(lines: FloatArray) -> float:
    """Points: long paths get thin lines, so that neighbours stay apart."""
    pixels = float(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum())
    return float(np.clip(30_000.0 / max(pixels, 1.0), 0.6, 1.5))


def _pieces(
    ends: FloatArray, rapid: npt.NDArray[np.bool_], longest: float
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Starts and ends of the moves, cut so that a wall can hide a part of one."""
    count = np.maximum(1, np.ceil(np.linalg.norm(np.diff(ends, axis=0), axis=1) / longest)).astype(np.int64)
    move = np.repeat(np.arange(len(count)), count)
    step = np.arange(len(move)) - np.repeat(np.cumsum(count) - count, count)
    step_to = ends[move + 1] - ends[move]
    share = count[move][:, None]
    return ends[move] + step_to * step[:, None] / share, ends[move] + step_to * (step[:, None] + 1) / share, rapid[move]


def _rulers(axes: Axes, view: View, box: FloatArray) -> None:
    """Ticks along three edges of the part's box, on the side of the reader."""
    from matplotlib.ticker import MaxNLocator

    middle = view.project(box.mean(axis=0)[None])[0, :2]
    for axis, start in ((0, (0, 0, 0)), (1, (1, 0, 0)), (2, (0, 0, 0))):
        ends = np.array([[box[start[k], k] for k in range(3)]] * 2)
        ends[:, axis] = box[:, axis]
        a, b = view.project(ends)[:, :2]
        along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-9)
        out = np.array([along[1], -along[0]])
        out *= 1.0 if np.dot(out, (a + b) / 2.0 - middle) > 0.0 else -1.0
        axes.plot(*np.array([a, b]).T + 6.0 * out[:, None], color=SOFT, linewidth=0.9)
        side = "right" if out[0] < -0.75 else "left" if out[0] > 0.75 else "center"
        low, high = box[:, axis]
        pixels = float(np.linalg.norm(b - a))
        steps = MaxNLocator(max(2, int(pixels / 70)), steps=[1, 2, 5, 10]).tick_values(low, high)
        ticks = [tick for tick in steps if low <= tick <= high]
        if pixels < LABEL:  # a flat program: one number is enough
            ticks = ticks[len(ticks) // 2 :][:1]
        for tick in ticks:
            at = a + (b - a) * (tick - low) / max(high - low, 1e-9)
            axes.plot(*np.array([at + 6.0 * out, at + 11.0 * out]).T, color=SOFT, linewidth=0.9)
            x, y = at + (14.0 if side != "center" else 22.0) * out
            axes.text(x, y, f"{tick:g}", ha=side, va="center", fontsize=10, color=INK)
        x, y = (a + b) / 2.0 + 48.0 * out
        axes.text(x, y, f"{'XYZ'[axis]} mm", ha=side, va="center", fontsize=11, color=INK, weight="bold")


def _titles(figure: Figure, program: Program, title: str) -> None:
    tools = ", ".join(dict.fromkeys(tool.description for tool in program.tools))
    strategies = ", ".join(dict.fromkeys(operation.kind for operation in program.operations))
    extent = f"{program.length / 1000.0:.3g} m in {clock(program.duration)} at the ordered feeds"
    facts = [strategies, tools, extent]
    title = title or program.setup.title
    _heading(figure, 0.955, title, 18.0, color=INK, weight="bold")
    _heading(figure, 0.912, ", ".join(fact for fact in facts if fact), 12.5, color=SOFT)


def _heading(figure: Figure, height: float, text: str, size: float, *, color: str, weight: str = "normal") -> None:
    """A line at the left margin, smaller where it would cross the right one."""
    line = figure.text(MARGIN, height, text, ha="left", va="center", color=color, fontsize=size, weight=weight)
    room = (1.0 - 2.0 * MARGIN) * figure.bbox.width
    line.set_fontsize(size * min(1.0, room / max(line.get_window_extent().width, 1.0)))


def _scale(figure: Figure, drawn: LineCollection, bottom: float = 0.16) -> None:
    """What the colours mean."""
    bar = figure.colorbar(drawn, cax=figure.add_axes((0.915, bottom, 0.016, 0.78 - bottom)))
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=10, colors=INK, length=3)
    bar.ax.set_title("Z of the tip\nmm", fontsize=11, color=INK, pad=10)
