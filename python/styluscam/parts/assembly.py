"""From faces, meshed one by one, to one welded part: whichever program meshed them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from styluscam.errors import GeometryError
from styluscam.flank.rails import Rail
from styluscam.parts.arrays import FaceInfo, PartArrays, area_vectors, describe_face, signed_volume, surface_area
from styluscam.parts.surfaces import Cone, ExactSurface, Floats, Nurbs, Parametric
from styluscam.parts.tessellation import GAP_SHARE, FaceMesh, Tessellation, is_closed, weld

# A face's mesh may miss this part of its exact area before it is looked at closer: chords are shorter than arcs.
AREA_SHARE = 0.02
# About so many triangles of a face decide which way all of them are wound.
WOUND = 1000
# Triangles that overlap by less than this part of the face cover its surface all the same: nothing of it is missing.
OVERLAP_SHARE = 0.25


def outward(mesh: FaceMesh, surface: ExactSurface) -> FaceMesh:
    """Return the mesh wound by its surface's normal; its triangles turn the same way, so that some of them decide."""
    some = mesh.triangles[:: max(1, len(mesh.triangles) // WOUND)]
    centres = mesh.nodes[some].mean(axis=1)
    if isinstance(surface, Parametric) and mesh.uv is not None:
        normals = surface.normal_from(centres, mesh.uv[some].mean(axis=1))
    else:
        normals = surface.normal(centres)
    if np.einsum("ij,ij->", area_vectors(mesh.nodes, some), normals) >= 0.0:
        return mesh
    return FaceMesh(mesh.nodes, np.ascontiguousarray(mesh.triangles[:, ::-1]), mesh.uv)


def kind_of(surface: ExactSurface) -> str:
    """Return the kind of a face in one word: plane, cylinder, cone, sphere, torus, spline, other."""
    if isinstance(surface, Parametric):
        return "spline" if isinstance(surface.evaluate, Nurbs) else "other"
    return type(surface).__name__.lower()


def check_areas(
    file: Path,
    tessellation: Tessellation,
    areas: list[tuple[float, tuple[float, float, float]]],
    exact_area: Callable[[int], float] | None = None,
) -> tuple[str, ...]:
    """Return notes on faces whose triangles overlap; refuse a mesh that leaves out a part of a face, or folds.

    `areas` (mm^2, with centres) may come from a quadrature of few points; `exact_area(face index)` from a careful
    one, asked where the first does not agree with the triangles. Along its border a mesh may leave out, or cover more,
    as wide a strip as its deviation.
    """
    notes = []
    for i, (mesh, (area, _)) in enumerate(zip(tessellation.meshes, areas, strict=True)):
        meshed = surface_area(mesh.nodes, mesh.triangles)
        if abs(meshed - area) <= AREA_SHARE * area:
            continue
        strip = border_length(mesh) * (tessellation.deviations[i].worst + tessellation.deflection) + 1e-6
        if abs(meshed - area) <= AREA_SHARE * area + strip:
            continue
        exact = area if exact_area is None else exact_area(i)
        name, figures = f"{file}:Face{i + 1}", f"{meshed:.4g} of {exact:.4g} mm^2"
        if meshed < exact * (1.0 - AREA_SHARE) - strip:
            why, cure = "a part of it would not be machined, and not be watched", "repair the face in the CAD system"
            raise _wrongly_meshed(name, f"its triangles cover only {figures}: {why}", cure)
        if meshed > exact * (1.0 + OVERLAP_SHARE) + strip:
            cure = "repair the face in the CAD system (its outline crosses itself, or its surface folds)"
            raise _wrongly_meshed(name, f"its triangles cover {figures}: they lie over each other", cure)
        if meshed > exact * (1.0 + AREA_SHARE) + strip:
            share = 100.0 * (meshed / exact - 1.0)
            notes.append(
                f"Face{i + 1} ({exact:.3g} mm^2): its triangles overlap, they cover {share:.1f} % more than it"
            )
    return tuple(notes)


def border_length(mesh: FaceMesh) -> float:
    """Return the length of a face's border, mm."""
    ends = np.sort(np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, counts = np.unique(ends, axis=0, return_counts=True)
    border = mesh.nodes[edges[counts == 1]]
    return float(np.linalg.norm(border[:, 1] - border[:, 0], axis=1).sum())


def _wrongly_meshed(name: str, what: str, cure: str) -> GeometryError:
    return GeometryError(f"{name}: {what}: {cure}", code="part-face-not-meshed", where=name, hint=cure)


def gap_note(gaps: tuple[float, ...], tolerance: float) -> tuple[str, ...]:
    """Return a note where the model's edges lie farther off its surfaces than the tolerance allows."""
    at = int(np.argmax(gaps))
    if gaps[at] <= GAP_SHARE * tolerance:
        return ()
    return (
        f"the edges of Face{at + 1} lie up to {gaps[at]:.2g} mm off its surface, as the file has them: "
        f"a part tolerance below {2.0 * gaps[at]:.2g} mm cannot be held there",
    )


def assemble(
    file: Path,
    tolerance: float,
    units: str,
    *,
    notes: tuple[str, ...],
    surfaces: list[ExactSurface],
    kinds: list[str],
    areas: list[tuple[float, tuple[float, float, float]]],
    tessellation: Tessellation,
    edges: tuple[Rail | None, ...] = (),
    exact_area: Callable[[int], float] | None = None,
) -> PartArrays:
    """Make one welded mesh out of the faces' meshes; see :func:`check_areas` for `exact_area`."""
    remarks = check_areas(file, tessellation, areas, exact_area) + gap_note(tessellation.edge_gaps, tolerance)
    meshes = tessellation.meshes
    starts = np.cumsum([0] + [len(mesh.nodes) for mesh in meshes])
    corners = np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)])
    ids = np.repeat(np.arange(1, len(meshes) + 1), [len(mesh.triangles) for mesh in meshes])
    normals = np.concatenate([_corner_normals(m, s) for m, s in zip(meshes, surfaces, strict=True)])
    vertices, triangles, kept = weld(np.concatenate([mesh.nodes for mesh in meshes]), corners)
    normals, ids = np.ascontiguousarray(normals[kept]), ids[kept]
    closed = is_closed(triangles)
    if closed and signed_volume(vertices, triangles) < 0.0:
        raise GeometryError(
            f"{file}: the solid is inside out (negative volume): repair it in the CAD system",
            code="part-inside-out",
            where=str(file),
        )
    if not closed and not notes:
        notes = ("the solid's faces do not meet everywhere: its mesh is open",)
    ends = np.searchsorted(ids, np.arange(1, len(meshes) + 2))
    faces: list[FaceInfo] = []
    for i, (kind, (area, centre)) in enumerate(zip(kinds, areas, strict=True)):
        own = slice(int(ends[i]), int(ends[i + 1]))
        faces.append(describe_face(i + 1, kind, vertices[triangles[own]], normals[own], area=area, centre=centre))
    return PartArrays(
        vertices=vertices,
        triangles=triangles,
        normals=normals,
        face_ids=ids,
        faces=tuple(faces),
        deviation_inward=max(0.0, *(d.inward for d in tessellation.deviations)),
        deviation_outward=max(0.0, *(d.outward for d in tessellation.deviations)),
        tolerance=tolerance,
        source=str(file),
        units=units,
        is_closed=closed,
        notes=notes + remarks,
        edge_gap_mm=max(0.0, *tessellation.edge_gaps),
        surfaces=tuple(surfaces),
        edges=edges,
    )


def _corner_normals(mesh: FaceMesh, surface: ExactSurface) -> Floats:
    """Return unit normals (t,3,3) of the surface at each triangle's corners."""
    if isinstance(surface, Parametric) and mesh.uv is not None:
        return surface.normal_from(mesh.nodes, mesh.uv)[mesh.triangles]
    normals = surface.normal(mesh.nodes)[mesh.triangles]
    if isinstance(surface, Cone):  # an apex has no normal of its own: take that of the triangle's middle
        apex = np.array(surface.location) - np.array(surface.axis) * surface.radius / np.tan(surface.semi_angle)
        at_apex = np.linalg.norm(mesh.nodes - apex, axis=1)[mesh.triangles] < 1e-7
        rows, _ = np.nonzero(at_apex)
        normals[at_apex] = surface.normal(mesh.nodes[mesh.triangles[rows]].mean(axis=1))
    return normals
