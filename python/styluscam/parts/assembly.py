"""From faces, meshed one by one, to one welded part: whichever program meshed them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import GeometryError
from .arrays import FaceInfo, PartArrays, area_vectors, describe_face, signed_volume
from .surfaces import Cone, ExactSurface, Floats, Nurbs, Parametric
from .tessellation import FaceMesh, Tessellation, is_closed, weld

# A face's mesh may miss this part of its exact area before the face counts as meshed wrongly.
AREA_SHARE = 0.02


def outward(mesh: FaceMesh, surface: ExactSurface) -> FaceMesh:
    """Return the mesh wound as its surface's normal says."""
    centres = mesh.nodes[mesh.triangles].mean(axis=1)
    if isinstance(surface, Parametric) and mesh.uv is not None:
        normals = surface.normal_from(centres, mesh.uv[mesh.triangles].mean(axis=1))
    else:
        normals = surface.normal(centres)
    if np.einsum("ij,ij->", area_vectors(mesh.nodes, mesh.triangles), normals) >= 0.0:
        return mesh
    return FaceMesh(mesh.nodes, np.ascontiguousarray(mesh.triangles[:, ::-1]), mesh.uv)


def kind_of(surface: ExactSurface) -> str:
    """Return the kind of a face in one word: plane, cylinder, cone, sphere, torus, spline, other."""
    if isinstance(surface, Parametric):
        return "spline" if isinstance(surface.evaluate, Nurbs) else "other"
    return type(surface).__name__.lower()


def check_areas(file: Path, tessellation: Tessellation, areas: list[tuple[float, tuple[float, float, float]]]) -> None:
    """Refuse a mesh that leaves out, folds or covers more than the face."""
    for number, (mesh, (exact, _)) in enumerate(zip(tessellation.meshes, areas, strict=True), 1):
        meshed = float(np.linalg.norm(area_vectors(mesh.nodes, mesh.triangles), axis=1).sum() / 2.0)
        if exact > 1e-6 and abs(meshed - exact) > AREA_SHARE * exact + 1e-6:
            place = f"{file}:Face{number}"
            raise GeometryError(
                f"{place}: its mesh covers {meshed:.6g} of {exact:.6g} mm^2: repair the face in the CAD system",
                code="part-face-not-meshed",
                where=place,
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
) -> PartArrays:
    """Make one welded mesh out of the faces' meshes."""
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
        notes=notes,
        surfaces=tuple(surfaces),
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
