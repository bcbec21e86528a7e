"""STL, OBJ, PLY and 3MF files: the mesh is the part, its faces lie between its creases."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from styluscam import _engine
from styluscam.errors import GeometryError
from styluscam.extras import require
from styluscam.parts.arrays import FaceInfo, Ints, PartArrays, area_vectors, describe_face
from styluscam.parts.facets import Facets
from styluscam.parts.formats import UNITLESS, UNITS
from styluscam.parts.mending import Filled, Mending
from styluscam.parts.progress import Progress, report
from styluscam.parts.stl import read_stl
from styluscam.parts.surfaces import Floats, unit
from styluscam.words import position

FLAT = 1e-6
"""A closed mesh is no body where it is, across a plane through it, this share of its length thick: numbers in files have
seven digits."""


def read_mesh(file: Path, tolerance: float, units: str | None, progress: Progress | None = None) -> PartArrays:
    """Read the part in a mesh file. See styluscam.parts.reading.read_part."""
    report(progress, "read", 0.0)
    scale, units = _scale(file, units)
    points, corners, own_units, notes = _load(file)
    if own_units is not None:
        scale, units = own_units
    if not len(corners):
        raise _error(file, "holds no triangles", "export the part again", "part-no-triangles")
    if not np.isfinite(points).all():
        raise _error(file, "has coordinates that are not numbers (NaN or infinite)", "export it again", "part-nan")
    report(progress, "faces", 0.5)
    vertices, triangles, face_ids, mending, kinds = _mended(file, points * scale, corners)
    if mending.closed and _is_flat(vertices):
        what = "its triangles close, but enclose nothing: it has no height"
        raise _error(file, what, "give it its height, or one side only", "part-no-volume")
    report(progress, "arrays", 0.9)
    normals = np.repeat(unit(area_vectors(vertices, triangles))[:, None, :], 3, axis=1)
    part = PartArrays(
        vertices=vertices,
        triangles=triangles,
        normals=normals,
        face_ids=face_ids,
        faces=_described(vertices[triangles], normals, face_ids, kinds),
        deviation_inward=mending.moved,
        deviation_outward=mending.moved,
        tolerance=tolerance,
        source=str(file),
        units=units,
        is_closed=mending.closed,
        notes=notes + mending.notes(len(triangles)),
        surfaces=(Facets(vertices, triangles),) * len(kinds),
        is_mesh=True,
    )
    report(progress, "arrays", 1.0)
    return part


def triangles_as_written(file: Path, units: str | None) -> tuple[Floats, Ints]:
    """Return points (N,3) in mm and triangles (T,3) in the order in which a mesh file has them; nothing is mended.

    Raises GeometryError for every file that cannot be read.
    """
    scale, _ = _scale(file, units)
    points, corners, own_units, _ = _load(file)
    return points * (scale if own_units is None else own_units[0]), corners


def _is_flat(vertices: Floats) -> bool:
    """Return whether all corners lie in one plane, however it is tilted."""
    *_, height = spread = np.linalg.svd(vertices - vertices.mean(axis=0), compute_uv=False)
    return bool(height <= FLAT * spread[0])


def _mended(file: Path, points: Floats, corners: Ints) -> tuple[Floats, Ints, Ints, Mending, list[str]]:
    """Return vertices, triangles wound outward, the face of each, what was done to them, and each face's kind."""
    try:
        vertices, triangles, face_ids, text = _engine.mended(points, np.ascontiguousarray(corners))
    except GeometryError as error:
        if error.code == "empty-mesh":
            what = "has no area: all its triangles are degenerate"
            raise _error(file, what, "export it again", "part-zero-area") from error
        raise _error(file, f"damaged: {error}", "export the part again", "part-damaged") from error
    done = json.loads(text)
    filled = done["mending"].pop("filled")
    mending = Mending(**done["mending"], filled=None if filled is None else Filled(**filled))
    if mending.unclear is not None:
        point = position(mending.unclear)
        what = f"its triangles are wound inconsistently, some are inside out, and which side is out is not clear at {point}"
        cure = "make its normals consistent, all outward, in the program that made it"
        raise _error(file, what, cure, "part-inconsistent")
    return vertices, triangles, face_ids, mending, done["shapes"]


def _described(corners: Floats, normals: Floats, face_ids: Ints, kinds: list[str]) -> tuple[FaceInfo, ...]:
    """Describe all faces, from the triangles' corners and corner normals, each (T,3,3)."""
    order = np.argsort(face_ids, kind="stable")
    ends = np.searchsorted(face_ids[order], np.arange(1, len(kinds) + 2))
    own = [order[start:end] for start, end in pairwise(ends)]
    faces = zip(kinds, own, strict=True)
    return tuple(describe_face(i, kind, corners[at], normals[at]) for i, (kind, at) in enumerate(faces, 1))


def _error(file: Path, what: str, cure: str, code: str) -> GeometryError:
    return GeometryError(f"{file}: {what}: {cure}", code=code, where=str(file), hint=cure)


def _scale(file: Path, units: str | None) -> tuple[float, str]:
    """Return the factor to mm, and the unit's name. 3MF carries its own."""
    if file.suffix.lower() not in UNITLESS:
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
    """Return the file's meshes, each at its position, as trimesh reads them."""
    kind = file.suffix.lower()[1:].upper()
    # networkx and lxml are what trimesh reads 3MF with
    trimesh = require(
        "mesh",
        f"{file}: reading {kind} files",
        modules=() if kind == "3MF" else ("trimesh",),
        failure=GeometryError,
        code="part-extra-mesh",
        where=str(file),
    )
    try:
        loaded: Any = trimesh.load_scene(str(file), process=False)
        return [g for g in loaded.dump() if isinstance(g, trimesh.Trimesh)]
    except Exception as error:  # trimesh lets through whatever its parsers raise
        # the parsers' own words are about Python, not about the file: they stay in the cause
        what = f"cannot be read as {kind}: it is damaged, or another format"
        raise _error(file, what, "export the part again", "part-damaged") from error
