"""Draws the pictures of docs/concepts into docs/images, from what the engine computes.

.venv/bin/python docs/concept_pictures.py [NAME ...]
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import trimesh
from concept_drawing import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    PART,
    PART_EDGE,
    PINK,
    SKY,
    SOFT,
    arc,
    draw_section,
    draw_tool,
    drawn_out,
    labelled,
    mesh_of,
    note,
    plain,
)
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from PIL import Image
from region_picture import regions

import styluscam as sc
from styluscam.parts.surfaces import Sphere
from styluscam.types import FloatArray

HERE = Path(__file__).parent
IMAGES = HERE / "images"
COLOURS = 96
"""Of a picture's palette."""


def slope_matching() -> Figure:
    """A clothoid at three contacts, and the points of its profile that touch there."""
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0}})
    section = [(-16.0, 0.0), *arc((0.0, 14.0), 14.0, 0.0, 62.0)]
    end = section[-1]
    section.append((end[0] + 5.0 * np.cos(np.radians(62.0)), end[1] + 5.0 * np.sin(np.radians(62.0))))
    slopes = np.radians([0.0, 30.0, 55.0])
    contacts = np.array([(-10.0, 0.0, 0.0), *((14.0 * np.sin(a), 0.0, 14.0 - 14.0 * np.cos(a)) for a in slopes[1:])])
    normals = np.array([(-np.sin(a), 0.0, np.cos(a)) for a in slopes])
    tips = np.asarray(sc.slope_matched_offset(tool, contacts, normals))
    figure, (pane, curve) = plt.subplots(1, 2, figsize=(11.0, 4.6), width_ratios=(1.75, 1.0))
    draw_section(pane, section, -2.5)
    for number, (contact, normal, tip, colour) in enumerate(
        zip(contacts, normals, tips, (BLUE, GREEN, ORANGE), strict=True)
    ):
        draw_tool(pane, tool, (tip[0], tip[2]), 13.5, colour)
        pane.plot(contact[0], contact[2], "s", color=INK, ms=5, zorder=7)
        away = {"arrowstyle": "-|>", "color": INK, "lw": 1.4}
        ahead = (contact[0] + 3.2 * normal[0], contact[2] + 3.2 * normal[2])
        pane.annotate("", ahead, (contact[0], contact[2]), arrowprops=away, zorder=8)
        pane.text(contact[0] + 0.5, contact[2] - 1.3, f"$P_{number + 1}$", fontsize=12)
        pane.text(tip[0] - 1.6, tip[2] + 0.55, f"$CL_{number + 1}$" if number else "", fontsize=12, color=colour)
    plain(pane, (-17.0, 17.5), (-3.0, 14.2))
    pane.set_title("equal slopes touch: the normal of the part is the normal of the profile", fontsize=11)
    all_slopes = np.linspace(0.0, tool.max_slope, 200)
    curve.plot(tool.radius_at(all_slopes), tool.height_at(all_slopes), color=INK, lw=2)
    for slope, colour in zip(slopes, (BLUE, GREEN, ORANGE), strict=True):
        r, z = float(tool.radius_at([slope])[0]), float(tool.height_at([slope])[0])
        reach = 1.1 * np.array([np.cos(slope), np.sin(slope)])
        curve.plot([r - reach[0], r + reach[0]], [z - reach[1], z + reach[1]], color=colour, lw=2.2)
        curve.plot(r, z, "o", color=colour, ms=6)
        curve.text(
            r + 0.35,
            z - (0.34 if slope else -0.22),
            rf"$\varphi$ = {np.degrees(slope):.0f}°",
            color=colour,
            fontsize=11,
        )
    labelled(curve, "radius r, mm", "height z, mm")
    curve.set_aspect("equal")
    curve.set_xlim(-1.2, 6.2)
    curve.set_ylim(-0.7, 3.2)
    curve.set_title("the profile by slope: clothoid D10", fontsize=11)
    return figure


def envelope() -> Figure:
    """Slope-matched tips and the envelope over a groove that is narrower than the tool."""
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 8.0}})
    section = [
        (-13.0, 0.0),
        (-4.5, 0.0),
        *arc((0.0, -2.2), 2.0, -55.0, 55.0),
        (4.5, 0.0),
        (9.0, 0.0),
        (9.0, 3.0),
        (16.0, 3.0),
    ]
    part = drawn_out(section)
    x = np.linspace(-12.0, 15.0, 4001)
    tips = sc.drop_cutter(part, tool, np.stack([x, 0.0 * x], axis=1))
    figure, pane = plt.subplots(figsize=(11.0, 5.0))
    draw_section(pane, section, -6.0)
    for i, ((ax, az), (bx, bz)) in enumerate(pairwise(section)):
        normal = np.array([az - bz, 0.0, bx - ax])
        if normal[2] <= 0.0:
            continue
        ends = np.array([(ax, 0.0, az), (bx, 0.0, bz)])
        matched = np.asarray(sc.slope_matched_offset(tool, ends, np.array([normal, normal]) / np.linalg.norm(normal)))
        pane.plot(
            matched[:, 0],
            matched[:, 2],
            color=ORANGE,
            lw=2.0,
            ls=(0, (4, 2)),
            zorder=4,
            label=None if i else "slope-matched tips",
        )
    pane.plot(x, tips, color=BLUE, lw=2.4, zorder=5, label="envelope: lowest free tips")
    low = int(np.argmin(np.abs(x)))
    draw_tool(pane, tool, (0.0, float(tips[low])), 6.5, BLUE)
    at = float(x[np.argmin(np.abs(x - 6.4))])
    draw_tool(pane, tool, (at, float(np.interp(at, x, tips))), 6.5, GREEN)
    note(pane, "bridged: the groove is\nnarrower than the tool", (0.0, -3.9), (-7.6, -4.2), INK)
    note(pane, "where only matching slopes counted,\nthe tool would cut the walls", (0.9, -4.15), (8.6, -4.6), ORANGE)
    note(pane, "the step's edge\nkeeps it off", (9.0, 3.0), (12.6, 4.9), GREEN)
    plain(pane, (-13.0, 16.0), (-6.0, 6.8))
    pane.legend(loc="upper left", frameon=False, fontsize=10.5)
    return figure


def heights_of_ball(radius: float, distance: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Height and rise of a ball at a distance from its axis."""
    height = radius - np.sqrt(radius**2 - distance**2)
    return height, np.minimum(distance / np.sqrt(np.maximum(radius**2 - distance**2, 1e-12)), 16.0)


def bounds() -> Figure:
    """What no tip over a group of triangles exceeds, by its box alone and by its box and plane."""
    ball = 4.0
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 2.0 * ball}})
    across = np.linspace(-3.0, 3.0, 13)
    section = [(float(x), float(0.9 * x + 0.22 * np.cos(2.6 * x))) for x in across]
    points = np.array(section)
    low, high = float(points[0, 0]), float(points[-1, 0])
    rise = float(np.polyfit(points[:, 0], points[:, 1], 1)[0])
    lift = float(np.max(points[:, 1] - rise * points[:, 0]))
    x = np.linspace(-8.5, 8.5, 1200)
    tips = sc.drop_cutter(drawn_out(section), tool, np.stack([x, 0.0 * x], axis=1))
    # the contact on the plane, clamped into the box, and the tangent there
    touch = np.clip(ball * rise / np.hypot(1.0, rise), low - x, high - x)
    reached = np.abs(touch) < ball
    height, steep = heights_of_ball(ball, np.where(reached, np.abs(touch), 0.0))
    tangent = rise - np.sign(touch) * steep
    rest = np.maximum(tangent * (high - x - touch), tangent * (low - x - touch))
    in_box = np.where(reached, lift + rise * (x + touch) - height + rest, np.nan)
    by_box = np.where(
        reached, points[:, 1].max() - heights_of_ball(ball, np.clip(np.maximum(low - x, x - high), 0, 3.999))[0], np.nan
    )
    figure, pane = plt.subplots(figsize=(11.0, 5.4))
    draw_section(pane, section, -4.4)
    pane.add_patch(
        Rectangle((low, -3.2), high - low, points[:, 1].max() + 3.2, fill=False, ec=SOFT, lw=1.2, ls=":", zorder=2)
    )
    pane.plot([low, high], [lift + rise * low, lift + rise * high], color=SOFT, lw=1.6, zorder=2)
    pane.plot(x, by_box, color=PINK, lw=1.8, ls=(0, (2, 1.5)), label="bound by the box alone")
    pane.plot(x, in_box, color=ORANGE, lw=2.0, ls=(0, (5, 2)), label="bound by box and plane")
    pane.plot(x, tips, color=BLUE, lw=2.4, label="highest tip over the group")
    note(pane, "plane over the group", (low + 1.1, lift + rise * (low + 1.1)), (-4.8, -0.5), SOFT)
    note(pane, "box", (high, -2.2), (4.6, -2.6), SOFT)
    plain(pane, (-8.6, 8.6), (-4.4, 3.6))
    pane.set_aspect("auto")
    pane.legend(loc="upper left", frameon=False, fontsize=10.5)
    return figure


def star(lobes: int = 5, height: float = 8.0) -> sc.Part:
    """A hill with lobes whose walls lean, on a floor."""
    angles = np.linspace(0.0, 2.0 * np.pi, 181)[:-1]
    radius = 9.0 + 2.2 * np.cos(lobes * angles)
    rings = [(22.0 + 0.0 * radius, 0.0), (radius, 0.0), (0.45 * radius, height)]
    points = [(r * np.cos(a), r * np.sin(a), z) for rim, z in rings for r, a in zip(rim, angles, strict=True)]
    count = len(angles)
    triangles = []
    for ring in (0, count):
        for i in range(count):
            a, b = ring + i, ring + (i + 1) % count
            triangles += [(a, b, b + count), (a, b + count, a + count)]
    top = len(points)
    points.append((0.0, 0.0, height))
    triangles += [(2 * count + i, 2 * count + (i + 1) % count, top) for i in range(count)]
    return sc.Part.from_mesh(np.array(points), np.array(triangles))


def push_cutter() -> Figure:
    """A tool that is pushed along lines at one height until it touches."""
    part, z = star(), 2.0
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 5.0}})
    beside = np.arange(-13.0, 13.1, 1.3)
    begin = np.stack([np.full_like(beside, -20.0), beside], axis=1)
    ways = sc.push_cutter(part, tool, begin, np.tile([1.0, 0.0], (len(beside), 1)), z)
    figure, pane = plt.subplots(figsize=(8.4, 6.4))
    angles = np.linspace(0.0, 2.0 * np.pi, 361)
    for height, colour, dashes in ((z, PART_EDGE, "-"), (z + 2.5, SOFT, ":")):
        radius = (9.0 + 2.2 * np.cos(5 * angles)) * (1.0 - 0.55 * height / 8.0)
        pane.fill(radius * np.cos(angles), radius * np.sin(angles), fc=PART, ec=colour, ls=dashes, lw=1.2, zorder=1)
    for loop in sc.waterline(part, tool, z):
        pane.plot(loop[:, 0], loop[:, 1], color=BLUE, lw=1.8, zorder=4, label="waterline of the tip")
    for number, ((x, y), way) in enumerate(zip(begin, ways, strict=True)):
        stops = bool(np.isfinite(way))
        end = x + way if stops else 20.0
        pane.annotate(
            "",
            (end, y),
            (x, y),
            arrowprops={"arrowstyle": "-|>", "color": ORANGE if stops else SOFT, "lw": 1.0},
            zorder=3,
        )
        if stops:
            pane.plot(
                end, y, "o", color=ORANGE, ms=5, zorder=6, label="first touch" if number == len(ways) // 2 else None
            )
        if stops and number in {4, 10, 14}:
            pane.add_patch(Circle((end, y), 2.5, facecolor=SKY, alpha=0.35, edgecolor=BLUE, zorder=2))
    plain(pane, (-20.5, 20.5), (-14.5, 16.0))
    pane.legend(loc="upper right", frameon=False, fontsize=10.5, ncol=2)
    return figure


def hills() -> tuple[FloatArray, FloatArray]:
    """Vertices and triangles of two smooth hills on a plain."""
    across = np.linspace(-16.0, 16.0, 161)
    x, y = np.meshgrid(across, across)
    z = 7.0 * np.exp(-((x + 4.5) ** 2 + (y + 1.5) ** 2) / 26.0) + 5.2 * np.exp(
        -((x - 5.5) ** 2 + (y - 2.5) ** 2) / 14.0
    )
    index = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles


def waterlines() -> Figure:
    """From the nodes of a grid to loops, and loops at many heights."""
    part, level = sc.Part.from_mesh(*hills()), 3.25
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 4.0}})
    nodes = np.arange(-13.0, 13.1, 2.0)
    grid = np.stack(np.meshgrid(nodes, nodes), axis=-1).reshape(-1, 2)
    above = sc.drop_cutter(part, tool, grid) > level
    figure, (pane, all_levels) = plt.subplots(1, 2, figsize=(11.4, 5.6))
    for at in nodes:
        pane.axhline(at, color="#e4e8ee", lw=0.9, zorder=0)
        pane.axvline(at, color="#e4e8ee", lw=0.9, zorder=0)
    pane.plot(*grid[above].T, "o", color=ORANGE, ms=6, label="tip above the level")
    pane.plot(*grid[~above].T, "o", mfc="white", mec=SOFT, ms=5, label="tip below it")
    loops = sc.waterline(part, tool, level)
    for number, loop in enumerate(loops):
        pane.plot(loop[:, 0], loop[:, 1], color=BLUE, lw=2.0, label=None if number else "waterline")
        crossings = [cut for axis in (0, 1) for at in nodes for cut in crossed(loop, axis, float(at))]
        pane.plot(
            *np.array(crossings).T, "s", color=BLUE, ms=4, label=None if number else "exact crossing of a grid line"
        )
    plain(pane, (-13.6, 13.6), (-13.6, 16.8))
    pane.legend(loc="upper center", frameon=False, fontsize=9.5, ncol=2)
    heights = np.arange(0.5, 7.0, 0.5)
    for z, level_loops in zip(heights, sc.waterlines(part, tool, heights), strict=True):
        for loop in level_loops:
            all_levels.plot(loop[:, 0], loop[:, 1], color=mpl.colormaps["viridis"](0.9 * z / 7.0), lw=1.6)
    plain(all_levels, (-13.6, 13.6), (-13.6, 16.8))
    all_levels.set_title("levels 0.5 mm apart", fontsize=11, y=0.93)
    return figure


def basin() -> sc.Part:
    """A shallow basin with two deep pockets in its floor, from heights over a grid of 100 x 60 mm."""
    x, y = np.meshgrid(np.arange(-50.0, 50.5, 0.5), np.arange(-30.0, 30.5, 0.5))
    z = np.clip(np.maximum(np.abs(x) - 42.0, np.abs(y) - 22.0), -4.0, 0.0)
    for middle in (-20.0, 20.0):
        z += np.clip(np.hypot(x - middle, y) - 14.0, -8.0, 0.0)
    across = x.shape[1]
    corner = (np.arange(x.shape[0] - 1)[:, None] * across + np.arange(across - 1)).ravel()
    first = np.column_stack([corner, corner + 1, corner + across + 1])
    second = np.column_stack([corner, corner + across + 1, corner + across])
    return sc.Part.from_mesh(np.column_stack([x.ravel(), y.ravel(), z.ravel()]), np.concatenate([first, second]))


def spirals() -> Figure:
    """Pairs of points of two loops with the turn between them, and the descents of a basin with two pockets."""
    figure, (pane, descents) = plt.subplots(1, 2, figsize=(11.4, 4.6), width_ratios=(1.0, 1.35))
    turns = np.radians(np.linspace(0.0, 360.0, 37))
    share = np.linspace(0.0, 1.0, 37)[:, None]
    outer = np.stack([11.0 * np.cos(turns), 8.0 * np.sin(turns)], axis=1)
    inner = np.stack([7.0 * np.cos(turns), 4.6 * np.sin(turns)], axis=1)
    for above, below in zip(outer, inner, strict=True):
        pane.plot(*np.array([above, below]).T, color="#c9d1dc", lw=0.9, zorder=1)
    pane.plot(*outer.T, color=BLUE, lw=1.6, marker="o", ms=3, label="loop of a level")
    pane.plot(*inner.T, color=SKY, lw=1.6, marker="o", ms=3, label="loop of the next level")
    pane.plot(*(outer + share * (inner - outer)).T, color=ORANGE, lw=2.2, label="turn between them")
    plain(pane, (-13.0, 13.0), (-10.0, 13.5))
    pane.legend(loc="upper center", frameon=False, fontsize=9.5, ncol=2)
    document = {
        "schema": 1,
        "part": {"file": "basin.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
        "operations": [{"kind": "spiral", "tool": "ball", "step": {"height": 1.0}, "spindle": {"mode": "off"}}],
        "machine": {"name": "linuxcnc"},
    }
    moves = sc.plan(sc.Job.from_dict(document, part=basin())).programs["main"].moves
    starts = np.flatnonzero(np.diff((moves["kind"] == 1).astype(int)) == 1) + 1
    for number, run in enumerate(np.split(moves["end"], starts)[1:]):
        down = run[moves["kind"][starts[number] : starts[number] + len(run)] == 1]
        colour = (BLUE, ORANGE, GREEN, PINK)[number % 4]
        descents.plot(down[:, 0], down[:, 1], color=colour, lw=1.0)
        descents.plot(*down[0, :2], "o", color=colour, ms=6)
    plain(descents, (-52.0, 52.0), (-31.0, 36.0))
    descents.set_title("each part of a wall has one descent; dots: where they begin", fontsize=11, y=0.93)
    return figure


def rows() -> Figure:
    """Turns between rows of three kinds, seen from above, at the rim of the cup of the fixtures."""
    kinds = {"straight": {}, "rounded": {}, "looped": {"turn_radius": 2.0}}
    figure, axes = plt.subplots(1, 3, figsize=(11.0, 3.7), sharey=True)
    for axis, (turns, keys) in zip(axes, kinds.items(), strict=True):
        cup = HERE.parent / "fixtures" / "cone_cup.step"
        document = milling_job(cup, {"kind": "ball", "diameter": 6.0}, 0.005)
        document["part"] = {"file": str(cup), "faces": [f"Face{number}" for number in range(1, 5)]}
        document["operations"][0].update({"stepover": 3.0, "turns": turns, **keys})
        moves = sc.plan(document).programs["main"].moves
        start, end, feeds = moves["end"][:-1], moves["end"][1:], moves["kind"][1:] != 0
        for is_turn, colour in ((False, BLUE), (True, ORANGE)):
            chosen = feeds & ((np.abs(end[:, 1] - start[:, 1]) > 1e-6) == is_turn)
            lines = np.stack([start[chosen, :2], end[chosen, :2]], axis=1)
            axis.add_collection(LineCollection(list(lines), colors=colour, linewidths=1.6))
        axis.set(xlim=(10.0, 47.0), ylim=(2.0, 32.0), aspect="equal")
        labelled(axis, "X, mm", "Y, mm")
        axis.set_title(turns, fontsize=10.5)
    return figure


def meshing() -> Figure:
    """A face of a sphere laid out on the map, and its triangles in space."""
    radius, deviation, low, high = 10.0, 0.03, float(np.radians(20.0)), float(np.radians(80.0))
    sphere = Sphere((0.0, 0.0, 0.0), radius)
    engine = sphere.engine((0.0, 0.0, 1.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    corners = np.array([(0.0, low), (1.6, low), (1.6, high), (0.0, high), (0.0, low)])
    share = np.linspace(0.0, 1.0, 13)
    edges = []
    for start, end in pairwise(corners):
        u, v = (start + share[:, None] * (end - start)).T
        points = radius * np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=1)
        guides = [tuple(start + k / 4.0 * (end - start)) for k in range(5)]
        edges.append((points, share.tolist(), guides))
    meshed = engine.mesh(edges, deviation)
    assert meshed is not None
    nodes, triangles = meshed
    figure = plt.figure(figsize=(11.4, 4.9))
    flat, space = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="3d")
    latitude, longitude = np.arcsin(nodes[:, 2] / radius), np.arctan2(nodes[:, 1], nodes[:, 0])
    north = np.arcsinh(np.tan(latitude))
    flat.triplot(longitude, north, triangles, color=BLUE, lw=0.8)
    border = np.concatenate([points for points, _, _ in edges])
    flat.plot(
        np.arctan2(border[:, 1], border[:, 0]),
        np.arcsinh(np.tan(np.arcsin(np.clip(border[:, 2] / radius, -1, 1)))),
        color=ORANGE,
        lw=2.0,
    )
    labelled(flat, "longitude u", "arsinh(tan v)")
    flat.set_aspect("equal")
    flat.set_title("on the map: rows in step, fewer points further north", fontsize=11)
    space.plot_trisurf(*nodes.T, triangles=triangles, color="#cfe3f1", edgecolor=BLUE, linewidth=0.5, shade=False)
    space.plot(*border.T, color=ORANGE, lw=2.0)
    space.set_axis_off()
    space.set_box_aspect((9.4, 9.4, 6.5), zoom=1.1)
    space.view_init(elev=28.0, azim=42.0)
    space.set_title("in space: all triangles leave the sphere equally far", fontsize=11)
    return figure


def crossed(loop: FloatArray, axis: int, at: float) -> list[FloatArray]:
    """Where a loop crosses a line of the grid."""
    first, last = loop[:-1, :2], loop[1:, :2]
    over = (first[:, axis] - at) * (last[:, axis] - at) < 0.0
    share = (at - first[over, axis]) / (last[over, axis] - first[over, axis])
    return list(first[over] + share[:, None] * (last[over] - first[over]))


def milling_job(file: Path, profile: dict[str, Any], tolerance: float) -> dict[str, Any]:
    """A job of rows over a mesh."""
    common = {"tool": "tool", "tolerance": tolerance, "spindle": {"mode": "off"}}
    return {
        "schema": 1,
        "part": {"file": str(file), "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"tool": {"profile": profile}},
        "operations": [{"kind": "zig-zag", "stepover": 4.0} | common],
        "machine": {"name": "linuxcnc"},
    }


def row_of(document: dict[str, Any]) -> FloatArray:
    """The points of one row of a job, near the middle of its part."""
    moves = sc.plan(sc.Job.from_dict(document)).programs["main"].moves
    ends = np.asarray(moves["end"])[np.asarray(moves["kind"]) == 1]
    across, counts = np.unique(np.round(ends[:, 1], 4), return_counts=True)
    middle = across[np.argmin(np.where(counts > 10, np.abs(across), np.inf))]
    row = ends[np.abs(ends[:, 1] - middle) < 1e-3]
    return np.asarray(row[np.argsort(row[:, 0])])


def fitting() -> Figure:
    """A row over two hills: its chords, and what they leave between themselves and the envelope."""
    tolerance, ball = 0.05, {"kind": "ball", "diameter": 4.0}
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "hills.stl"
        trimesh.Trimesh(*hills(), process=False).export(file)
        row = row_of(milling_job(file, ball, tolerance))
    x = np.linspace(max(row[0, 0], -14.0), min(row[-1, 0], 14.0), 8001)
    places = np.stack([x, np.full_like(x, row[0, 1])], axis=1)
    exact = sc.drop_cutter(sc.Part.from_mesh(*hills()), {"profile": ball}, places)
    row = row[(row[:, 0] >= x[0]) & (row[:, 0] <= x[-1])]
    x, exact = (values[(x >= row[0, 0]) & (x <= row[-1, 0])] for values in (x, exact))
    over = (np.interp(x, row[:, 0], row[:, 2]) - exact) / np.hypot(1.0, np.gradient(exact, x)) * 1e3
    figure, (path, left) = plt.subplots(2, 1, figsize=(11.0, 5.8), sharex=True, height_ratios=(1.0, 1.3))
    path.plot(x, exact, color=BLUE, lw=3.5, alpha=0.35, label="envelope")
    path.plot(row[:, 0], row[:, 2], "-o", color=INK, lw=1.0, ms=3.5, label="posted chords")
    labelled(path, "", "tip height, mm")
    path.legend(frameon=False, loc="lower center", ncol=2)
    left.axhspan(0.0, 1e3 * tolerance, color=GREEN, alpha=0.10)
    left.axhline(0.0, color=INK, lw=1.0)
    left.axhline(1e3 * tolerance, color=GREEN, lw=1.4, ls=(0, (5, 2)))
    left.axhline(500.0 * tolerance, color=SOFT, lw=1.0, ls=":")
    left.plot(x, over, color=ORANGE, lw=1.4)
    left.text(x[-1] + 0.3, 1e3 * tolerance + 1.0, "tolerance", color=GREEN, va="bottom")
    left.text(x[-1] + 0.3, 500.0 * tolerance + 1.0, "planned surface", color=SOFT, va="bottom")
    left.text(x[-1] + 0.3, 1.0, "envelope: deeper\nis a gouge", va="bottom")
    left.set_xlim(x[0] - 0.8, x[-1] + 4.6)
    labelled(left, "position along the row, mm", "path above the envelope,\nalong the normal, µm")
    left.set_ylim(-4.0, 1e3 * tolerance + 9.0)
    return figure


def distance_to(tool: sc.Tool, points: FloatArray) -> FloatArray:
    """Signed distance of points (N, 2) in section, seen from the tip, to the tool: the largest gap of a touching plane."""
    slopes = np.linspace(0.0, tool.max_slope, 4001)
    r, z = tool.radius_at(slopes), tool.height_at(slopes)
    gaps = (np.abs(points[:, :1]) - r) * np.sin(slopes) - (points[:, 1:] - z) * np.cos(slopes)
    return np.asarray(gaps.max(axis=1))


def verifier() -> Figure:
    """The clearance between a tool on its move and an edge: convex, so that tangents bound it."""
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0}})
    ridge = (0.0, 4.0)
    section = [(-18.0, 0.0), (-3.4, 0.0), ridge, (3.4, 0.0), (18.0, 0.0)]
    first, last = np.array((-12.0, 3.2)), np.array((12.0, 4.4))
    share = np.linspace(0.0, 1.0, 801)
    tips = first + share[:, None] * (last - first)
    clearance = distance_to(tool, ridge - tips)
    deepest = int(np.argmin(clearance))
    figure, (pane, curve) = plt.subplots(1, 2, figsize=(11.6, 4.9), width_ratios=(1.35, 1.0))
    draw_section(pane, section, -2.0)
    for at, colour in ((0, SOFT), (deepest, ORANGE), (len(share) - 1, SOFT)):
        draw_tool(pane, tool, (float(tips[at, 0]), float(tips[at, 1])), 11.0, colour, alpha=0.16)
    pane.plot(*np.array([first, last]).T, color=BLUE, lw=1.6, ls=(0, (5, 2)), zorder=5)
    note(pane, "the move of the tip", (-7.5, 3.42), (-9.0, 1.5), BLUE)
    note(pane, "the tool cuts\nthe ridge", ridge, (-1.2, 8.4), ORANGE)
    plain(pane, (-18.0, 18.0), (-2.0, 11.4))
    curve.plot(share, clearance, color=INK, lw=2.2)
    for at in (0.2, 0.83):
        number = int(at * (len(share) - 1))
        rate = np.gradient(clearance, share)[number]
        line = clearance[number] + rate * (share - share[number])
        shown = (line > -1.7) & (line < 7.0)
        curve.plot(share[shown], line[shown], color=SKY, lw=1.6)
        curve.plot(share[number], clearance[number], "o", color=BLUE, ms=6)
    curve.plot(share[deepest], clearance[deepest], "o", color=ORANGE, ms=7)
    curve.axhline(0.0, color=SOFT, lw=1.0)
    curve.text(
        0.02,
        -2.45,
        f"deepest {-clearance[deepest]:.3f} mm; the verifier reports {reported(section, first, last):.3f} mm",
        fontsize=9.5,
        color=ORANGE,
    )
    note(curve, "tangents lie below", (0.37, -0.75), (0.5, 3.6), BLUE)
    labelled(curve, "share of the move", "clearance, mm")
    curve.set_ylim(-2.8, 7.2)
    return figure


def reported(section: list[tuple[float, float]], first: FloatArray, last: FloatArray) -> float:
    """The gouge that the verifier reports for one move over a part, mm."""
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "ridge.stl"
        trimesh.Trimesh(*mesh_of(section), process=False).export(file)
        job = sc.Job.from_dict(milling_job(file, {"kind": "clothoid", "diameter": 10.0}, 0.02))
        text = "G21 G90 G17 G94 G40 G49 G80 G54 G61\nT1 M6\nG43 H1\nS1000 M3\n"
        text += f"G0 X{first[0]} Y0 Z20\nG1 Z{first[1]} F100\nX{last[0]} Z{last[1]}\nG0 Z20\nM2\n"
        return float(sc.verify(text, job).gouge_max)


REFUSED = "0.08*r^2 + 0.03*(1 - cos(3*r))"
PROVEN = "0.1*r^2 - r^3/60 + r^4/600"


def cells(first: float, last: float, most: float = 0.02) -> list[tuple[float, float, float, float]]:
    """Cells of r with bounds of the second derivative of PROVEN, halved while it may be negative."""
    low, high = 0.2 - 0.1 * last + 0.02 * first**2, 0.2 - 0.1 * first + 0.02 * last**2
    here = [(first, last, low, high)]
    if low >= 0.0 or last - first < most:
        return here
    middle = 0.5 * (first + last)
    return here + cells(first, middle) + cells(middle, last)


def convexity() -> Figure:
    """A formula that is refused, with the engine's words, and one that is proven."""
    r = np.linspace(0.0, 5.0, 800)
    figure, (bent, proof) = plt.subplots(1, 2, figsize=(11.4, 4.7))
    bent.plot(r, 0.16 * r + 0.09 * np.sin(3.0 * r), color=ORANGE, lw=2.2)
    try:
        sc.Tool.from_dict({"profile": {"kind": "formula", "z": REFUSED, "diameter": 10.0}})
    except sc.StylusError as refusal:
        words = str(refusal)
    at = float(words.split("=")[1].split(":", maxsplit=1)[0])
    note(
        bent,
        f"refused at r = {at:g} mm:\nthe slope falls",
        (at, 0.16 * at + 0.09 * np.sin(3.0 * at)),
        (1.2, 0.66),
        ORANGE,
    )
    labelled(bent, "radius r, mm", "dz/dr")
    bent.set_title(f"z = {REFUSED}", fontsize=10.5)
    sc.Tool.from_dict({"profile": {"kind": "formula", "z": PROVEN, "diameter": 10.0}})
    for first, last, low, high in cells(0.0, 5.0):
        proven = low >= 0.0
        style: dict[str, Any] = {"fc": GREEN, "alpha": 0.28} if proven else {"fc": "none", "ec": SOFT, "ls": ":"}
        proof.add_patch(Rectangle((first, low), last - first, high - low, **style))
    proof.plot(r, 0.2 - 0.1 * r + 0.02 * r * r, color=INK, lw=2.2)
    proof.axhline(0.0, color=SOFT, lw=1.2)
    proof.set_ylim(-0.36, 0.76)
    labelled(proof, "radius r, mm", "second derivative, 1/mm")
    proof.set_title(f"z = {PROVEN}", fontsize=10.5)
    proof.text(0.08, 0.58, "dotted: may be negative, halved", color=SOFT)
    note(proof, "proven: nowhere negative", (1.6, 0.07), (1.22, -0.2), GREEN)
    return figure


PICTURES: dict[str, Callable[[], Figure]] = {
    "slope-matching": slope_matching,
    "meshing": meshing,
    "envelope": envelope,
    "bounds": bounds,
    "push-cutter": push_cutter,
    "waterlines": waterlines,
    "rows": rows,
    "spirals": spirals,
    "regions": regions,
    "fitting": fitting,
    "verifier": verifier,
    "convexity": convexity,
}


def main(names: list[str]) -> None:
    """Draws those named, or all."""
    style: Any = {"font.family": "DejaVu Sans", "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": SOFT}
    mpl.rcParams.update(style)
    for name in names or PICTURES:
        figure = PICTURES[name]()
        path = IMAGES / f"concept-{name}.png"
        figure.tight_layout()
        figure.savefig(path, dpi=100)
        plt.close(figure)
        with Image.open(path) as picture:
            small = picture.convert("RGB").quantize(COLOURS)
        small.save(path, optimize=True)


if __name__ == "__main__":
    main(sys.argv[1:])
