"""STL, OBJ, PLY and 3MF files: the mesh is the part."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import GeometryError
from .arrays import Ints, PartArrays, area_vectors, describe_face, signed_volume
from .progress import Progress, report
from .stl import read_stl
from .surfaces import Floats, unit
from .tessellation import is_closed, weld

# Corners of single-precision files that mean one point agree to the last bit: this only takes up rounding in scaling.
WELD = 1e-9


def read_mesh(file: Path, tolerance: float, units: str | None, progress: Progress | None = None) -> PartArrays:
    """Read the part in a mesh file, all of it face 1. See styluscam.parts.read_part."""
    report(progress, "read", 0.0)
    scale, units = _scale(file, units)
    points, corners, own_units, notes = _load(file)
    if own_units is not None:
        scale, units = own_units
    if not len(corners):
        raise _error(file, "holds no triangles", "export the part again", "part-no-triangles")
    if not np.isfinite(points).all():
        raise _error(file, "has coordinates that are not numbers (NaN or infinite)", "export it again", "part-nan")
    report(progress, "arrays", 0.6)
    vertices, triangles, _ = weld(points * scale, corners, WELD)
    doubled = area_vectors(vertices, triangles)
    sizes = np.sqrt(np.einsum("ij,ij->i", doubled, doubled))
    if not sizes.sum() > 0.0:
        raise _error(file, "has no area: all its triangles are degenerate", "export it again", "part-zero-area")
    closed = is_closed(triangles)
    if not closed:
        notes += ("the mesh is open: not each edge is shared by two triangles",)
    if closed and signed_volume(vertices, triangles) < 0.0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
        doubled = -doubled
        notes += ("the mesh was wound inward: its triangles were turned over",)
    normals = np.repeat(unit(doubled)[:, None, :], 3, axis=1)
    report(progress, "arrays", 1.0)
    return PartArrays(
        vertices=vertices,
        triangles=triangles,
        normals=normals,
        face_ids=np.ones(len(triangles), dtype=np.int64),
        faces=(describe_face(1, "mesh", vertices[triangles], normals),),
        deviation_inward=0.0,
        deviation_outward=0.0,
        tolerance=tolerance,
        source=str(file),
        units=units,
        is_closed=closed,
        notes=notes,
        surfaces=(Facets(vertices, triangles),),
    )


def _error(file: Path, what: str, cure: str, code: str) -> GeometryError:
    return GeometryError(f"{file}: {what}: {cure}", code=code, where=str(file), hint=cure)


def _scale(file: Path, units: str | None) -> tuple[float, str]:
    """Return the factor to mm, and the unit's name. 3MF carries its own."""
    from . import UNITS

    if file.suffix.lower() == ".3mf":
        if units is not None:
            raise _error(file, "a .3mf file carries its units", f"remove units = {units!r}", "part-units-not-wanted")
        return 1.0, "mm"
    if units is None:
        what = f"a {file.suffix.lower()} file carries no units"
        raise _error(file, what, f"give units, one of {', '.join(UNITS)}", "part-units-missing")
    return UNITS[units], units


# The units that the 3MF core specification (3.4) allows.
UNITS_OF_3MF = {
    "micron": (0.001, "um"),
    "millimeter": (1.0, "mm"),
    "centimeter": (10.0, "cm"),
    "inch": (25.4, "in"),
    "foot": (304.8, "ft"),
    "meter": (1000.0, "m"),
}


def _load(file: Path) -> tuple[Floats, Ints, tuple[float, str] | None, tuple[str, ...]]:
    """Return points (N,3) in the file's units, triangles (T,3), for 3MF its units, and notes on the file."""
    if file.suffix.lower() == ".stl":
        points, corners, notes = read_stl(file)
        return points, corners, None, notes
    meshes = _meshes(file)
    if not meshes:
        raise _error(file, "holds no triangles", "export the part again", "part-no-triangles")
    starts = np.cumsum([0] + [len(m.vertices) for m in meshes])
    points = np.concatenate([np.asarray(m.vertices, dtype=np.float64) for m in meshes])
    corners = np.concatenate([np.asarray(m.faces, dtype=np.int64) + s for m, s in zip(meshes, starts, strict=False)])
    own_units = None
    if file.suffix.lower() == ".3mf":
        own_units = UNITS_OF_3MF.get(str(meshes[0].units or "millimeter"), (1.0, "mm"))
    return points, corners, own_units, ()


def _meshes(file: Path) -> list[Any]:
    """Return the file's meshes, each at its place, as trimesh reads them."""
    kind = file.suffix.lower()[1:].upper()
    try:
        import trimesh
    except ImportError as error:
        cure = "pip install 'styluscam[mesh]'"
        raise _error(file, f"reading {kind} files needs trimesh", cure, "part-extra-mesh") from error
    try:
        loaded: Any = trimesh.load_scene(str(file), process=False)
        return [g for g in loaded.dump() if isinstance(g, trimesh.Trimesh)]
    except Exception as error:  # trimesh lets through whatever its parsers raise
        if isinstance(error, ImportError) and file.suffix.lower() == ".3mf":
            cure = "pip install 'styluscam[mesh]'"
            raise _error(file, f"reading it needs {error.name}", cure, "part-extra-mesh") from error
        # the parsers' own words are about Python, not about the file: they stay in the cause
        what = f"cannot be read as {kind}: it is damaged, or another format"
        raise _error(file, what, "export the part again", "part-damaged") from error


@dataclass(frozen=True, eq=False)
class Facets:
    """A triangle mesh as an exact surface: distance to its nearest triangle, signed by that triangle's side."""

    vertices: Floats
    triangles: Ints

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return self._nearest(points)[0]

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface: that of the nearest triangle."""
        return unit(area_vectors(self.vertices, self.triangles[self._nearest(points)[1]]))

    def _nearest(self, points: Floats) -> tuple[Floats, Ints]:
        """Return signed distance and nearest triangle: bounding spheres leave few candidates for each point."""
        corners = self.vertices[self.triangles]
        centres = (corners.min(axis=1) + corners.max(axis=1)) / 2.0
        radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
        distances, nearest = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
        rows = max(1, 2_000_000 // len(corners))
        for start in range(0, len(points), rows):
            part = points[start : start + rows]
            apart = np.sqrt(((part[:, None] - centres) ** 2).sum(axis=2))
            which, candidate = np.nonzero(apart - radii <= (apart + radii).min(axis=1)[:, None])
            away = part[which] - _closest(part[which], corners[candidate])
            doubled = area_vectors(self.vertices, self.triangles[candidate])
            height = np.einsum("ij,ij->i", away, unit(doubled))
            # Among triangles that share the nearest point, the one seen most from above gives the right side.
            order = np.lexsort((-np.abs(height), np.round(np.linalg.norm(away, axis=1), 9), which))
            first = order[np.searchsorted(which[order], np.arange(len(part)))]
            size = np.linalg.norm(away[first], axis=1)
            distances[start : start + rows] = np.copysign(size, height[first])
            nearest[start : start + rows] = candidate[first]
        return distances, nearest


def _closest(points: Floats, corners: Floats) -> Floats:
    """Return the point of each triangle (N,3,3) nearest to the point beside it (N,3)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    squared = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    away = points - a
    v = np.einsum("ij,ij->i", np.cross(away, ac), normal) / squared
    w = np.einsum("ij,ij->i", np.cross(ab, away), normal) / squared
    best = a + v[:, None] * ab + w[:, None] * ac
    outside = (v < 0.0) | (w < 0.0) | (v + w > 1.0)
    gap = np.where(outside, np.inf, 0.0)
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        length = np.maximum(np.einsum("ij,ij->i", side, side), 1e-300)
        share = np.clip(np.einsum("ij,ij->i", points - start, side) / length, 0.0, 1.0)
        on_side = start + share[:, None] * side
        reach = np.linalg.norm(points - on_side, axis=1)
        better = outside & (reach < gap)
        best, gap = np.where(better[:, None], on_side, best), np.where(better, reach, gap)
    return np.asarray(best)
