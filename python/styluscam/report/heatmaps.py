"""Numbers drawn on the part: what is left over, gouges, wall angle, thickness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from styluscam.judging.verification import Report
from styluscam.report.flank import face_of, left_on
from styluscam.report.surface import Mask, Surface, Vertices, vertices_of
from styluscam.types import Document, FloatArray, IntArray, Progress

LIMIT = 300_000
"""Points of a part at most."""

PER_PASS = 4.0
"""Sides of triangles for each mean distance between passes."""

FLAT, CARRIED = 1, 2
"""What ``Report.needs`` gives for points that need no forming."""

COVERED = 0.01
"""A point counts as covered when no more than this share of the diameter of the smallest tool used is left: as the verifier
has it."""

SHOWN_SHARE = 0.99
"""Of the covered points on the scale of what is left over: few high ones must not make all others look alike."""

LEAST_SCALLOP = 1e-3
"""mm: where that scale ends at least."""

LEAST_GOUGE = 0.01
"""mm: where the scale of gouges ends at least."""

NOTHING, UNFORMED = -1.0, -2.0
"""The values where a map shows nothing, and where a sheet needs no forming; all others are 0 or more."""


@dataclass(frozen=True, eq=False)
class HeatMap:
    """One number for each vertex."""

    key: str
    title: str
    unit: str
    values: FloatArray
    """(V,), 0 or more; :data:`NOTHING` where there is nothing to show, :data:`UNFORMED` where nothing is to be done."""
    low: float
    high: float
    limit: float | None = None
    """Above it a value has a colour of its own."""
    over: str = ""
    """What that colour means."""
    unformed: str = ""
    """What the colour of :data:`UNFORMED` means."""
    note: str = ""


@dataclass(frozen=True, eq=False)
class Shown:
    """A part with its maps, and the scallops for their histogram."""

    points: FloatArray
    borders: IntArray
    """Pairs of points between which a line is drawn, (E, 2)."""
    vertices: Vertices
    maps: tuple[HeatMap, ...]
    scallops: FloatArray
    """What is left at covered points, (N,), mm."""
    weights: FloatArray
    """The area for which each of them stands, (N,), mm^2."""
    merged: float
    """mm: size of the cells in which points of a part with too many became one."""


def shown_plain(surface: Surface) -> Shown:
    """A part without a verification: only wall angles are shown."""
    surface, merged = surface.coarsened(LIMIT)
    vertices = vertices_of(surface)
    none = np.zeros(0)
    return Shown(surface.points, surface.borders(), vertices, (_wall_angle(vertices),), none, none, merged)


def shown_judged(surface: Surface, report: Report, progress: Progress | None = None, limit: int = LIMIT) -> Shown:
    """A part and what a verified program leaves on it, refined so that the passes show; at most ``limit`` points."""
    surface, merged = surface.coarsened(limit)
    flanked = [number for one in report.flanks for face in one.faces if (number := face_of(face)) is not None]
    selected = np.isin(surface.faces, [face.face for face in report.coverage(progress=progress)]) & surface.looks_up
    selected |= np.isin(surface.faces, flanked)
    area = float(surface.areas[selected].sum())
    between = area / max(report.path.length, 1e-9)
    spacing = max(between / PER_PASS, float(np.sqrt(2.0 * area / limit)))
    borders = surface.borders()
    surface, selected = surface.refined(selected, spacing, limit)
    left = report.left(surface.points, progress=progress)
    beside = left_on(surface.points, surface.faces, surface.triangles, report.flanks)
    left = np.where(np.isnan(beside), left, beside)
    vertices = vertices_of(surface)
    asked = np.zeros(len(vertices.at), dtype=bool)
    asked[vertices.triangles[selected]] = True
    used = {operation.tool for operation in report.program.operations}
    diameters = (tool.diameter for number, tool in enumerate(report.program.tools) if number in used)
    enough = COVERED * min(diameters, default=0.0)
    needs = report.needs(surface.points[vertices.at], vertices.normals, progress=progress)
    covered = asked & (needs != FLAT) & (left[vertices.at] <= enough)
    stays = asked & ((needs == FLAT) | (needs == CARRIED) & ~covered)
    share = np.repeat(surface.areas[selected] / 3.0, 3)
    weights: FloatArray = np.asarray(
        np.bincount(vertices.triangles[selected].reshape(-1), share, len(vertices.at)), dtype=np.float64
    )
    grid = f"{len(surface.points)} points, at most {surface.longest_side(selected):.2g} mm apart where the job is"
    of_points = np.maximum(left, 0.0)[vertices.at]
    maps = [
        _left_over(np.where(stays, UNFORMED, np.where(asked, of_points, NOTHING)), covered, enough, grid),
        _gouge(np.maximum(-left, 0.0)[vertices.at], grid),
        _wall_angle(vertices),
    ]
    sheet = report.job.document["setup"].get("sheet")
    if sheet:
        maps.append(_thickness(vertices, asked, sheet))
    return Shown(surface.points, borders, vertices, tuple(maps), of_points[covered], weights[covered], merged)


def _left_over(values: FloatArray, covered: Mask, enough: float, grid: str) -> HeatMap:
    """Scallops, and what is not covered."""
    high = max(float(np.quantile(values[covered], SHOWN_SHARE)) if covered.any() else enough, LEAST_SCALLOP)
    values = np.where(np.isfinite(values), values, 2.0 * max(enough, high))
    note = f"Distance from what tool and sheet sweep on moves that are meant to touch; {grid}."
    over = f"not covered: more than {enough:.3g} mm"
    unformed = "needs no forming: stays flat by itself" if (values == UNFORMED).any() else ""
    return HeatMap("left", "left over", "mm", values, 0.0, high, enough, over, unformed, note)


def _gouge(values: FloatArray, grid: str) -> HeatMap:
    note = f"How deep moves that are meant to touch enter the part; others stand among the findings; {grid}."
    values = np.where(np.isfinite(values) & (values > 0.0), values, NOTHING)
    return HeatMap("gouge", "gouge", "mm", values, 0.0, max(LEAST_GOUGE, float(values.max(initial=0.0))), note=note)


def _angles(vertices: Vertices) -> FloatArray:
    """Wall angle at each vertex, rad; what faces down has that of its mirror image."""
    return np.asarray(np.arccos(np.clip(np.abs(vertices.normals[:, 2]), 0.0, 1.0)))


def _wall_angle(vertices: Vertices) -> HeatMap:
    note = "Between the surface and the horizontal."
    return HeatMap("wall", "wall angle", "°", np.degrees(_angles(vertices)), 0.0, 90.0, note=note)


def _thickness(vertices: Vertices, asked: Mask, sheet: Document) -> HeatMap:
    thickness = float(sheet["thickness"])
    values = thickness * np.cos(_angles(vertices))
    note = f"By the sine law: {thickness:g} mm times the cosine of the wall angle. An estimate for one pass of forming."
    low = float(values[asked].min(initial=0.99 * thickness))
    return HeatMap("thickness", "thickness", "mm", np.where(asked, values, NOTHING), low, thickness, note=note)
