"""Triangles of the CAD kernel's faces: meshed, fetched in bulk, checked against the exact surfaces."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np

from styluscam.errors import GeometryError
from styluscam.parts.assembly import outward
from styluscam.parts.edges import model_of
from styluscam.parts.kernel import Kernel
from styluscam.parts.progress import AttemptSteps, Progress
from styluscam.parts.surfaces import ExactSurface, Floats, Parametric
from styluscam.parts.tessellation import FaceMesh, Tessellation, refine_until
from styluscam.parts.trimmed import ANGLE, OWN_ATTEMPTS, shares

# The kernel meshes face borders within the deflection asked, face insides with one so many times larger: they are
# refined in numpy, only where the surface bends, which gives fewer triangles in less time than the kernel's own
# refinement. Five times is quicker, but its triangles blur the radii of fillets, and hide bumps between their samples.
INSIDE_COARSER = 1.4


def tessellate(
    file: Path,
    shape: Kernel,
    faces: list[Kernel],
    *,
    surfaces: list[ExactSurface],
    tolerance: float,
    progress: Progress | None,
) -> Tessellation:
    """Mesh each face, checked; give the freeform surfaces their seeds as well."""
    steps = AttemptSteps(progress)
    model = model_of(shape, faces, surfaces)

    def mesh_at(deflection: float) -> list[FaceMesh]:
        steps.begin()
        own = None if model is None or steps.attempt >= OWN_ATTEMPTS else model.meshes(surfaces, deflection)
        if own is None:
            _mesh(shape, faces, deflection)
            own = _face_meshes(file, faces)
        meshes = [outward(m, s) for m, s in zip(own, surfaces, strict=True)]
        for i, (mesh, surface) in enumerate(zip(meshes, surfaces, strict=True)):
            if isinstance(surface, Parametric) and mesh.uv is not None:
                surfaces[i] = _with_seeds(surface, mesh)
        return meshes

    aims = None if model is None else shares(surfaces)
    return refine_until(mesh_at, surfaces, tolerance, str(file), checked=steps.checked, shares=aims)


def _mesh(shape: Kernel, faces: list[Kernel], deflection: float) -> None:
    """Give each face a triangulation; faces share their border nodes.

    The Delabella algorithm is up to ten times faster than the default, Watson, and freer of wrong triangles, but
    gives up on some freeform faces: those that it leaves empty go to Watson, on the borders that are there already.
    """
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.IMeshTools import IMeshTools_MeshAlgoType as Algorithm
    from OCP.IMeshTools import IMeshTools_Parameters

    parameters = IMeshTools_Parameters()
    parameters.Deflection = deflection
    parameters.DeflectionInterior = INSIDE_COARSER * deflection
    parameters.Angle = ANGLE
    parameters.Relative = False
    parameters.InParallel = True
    parameters.ControlSurfaceDeflection = False
    BRepTools.Clean_s(shape)
    for algorithm in (
        Algorithm.IMeshTools_MeshAlgoType_Delabella,
        Algorithm.IMeshTools_MeshAlgoType_Watson,
    ):
        parameters.MeshAlgo = algorithm
        BRepMesh_IncrementalMesh(shape, parameters)
        if all(_triangulation(face)[0] is not None for face in faces):
            return


def _triangulation(face: Kernel) -> tuple[Kernel, Kernel]:
    """Return a face's triangulation (None if there is none) and its placement."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    location = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, location)
    return (found if found is not None and found.NbTriangles() else None), location


def _face_meshes(file: Path, faces: list[Kernel]) -> list[FaceMesh]:
    """Return the kernel's triangles of each face, fetched in bulk.

    For the 91,524 nodes and 181,121 triangles of a meshed ``fixtures/cap_r60.step`` this takes 0.05 s; iterating
    ``Poly_Triangulation.MapNodeArray``, ``MapUVNodeArray`` and ``MapTriangleArray`` takes 1.6 s, 33 times as long (17 times
    at 720,907 triangles), for the same numbers; the kernel meshes for 5.9 s (OCP 7.9, one core).
    """
    from OCP.BRep import BRep_Builder
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Compound, TopoDS_Face
    from OCP.TopTools import TopTools_IndexedMapOfShape

    builder, bare = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(bare)
    distinct = TopTools_IndexedMapOfShape()  # faces that are copies at another position share one triangulation
    numbers, placements = [], []
    for number, face in enumerate(faces, 1):
        triangulation, location = _triangulation(face)
        if triangulation is None:
            name = f"{file}:Face{number}"
            raise GeometryError(
                f"{name}: the kernel cannot mesh this face: repair it in the CAD system",
                code="part-face-not-meshed",
                where=name,
            )
        known = distinct.Size()
        index = distinct.Add(face.Located(TopLoc_Location()))
        if index > known:
            carrier = TopoDS_Face()
            builder.MakeFace(carrier, triangulation)
            builder.Add(bare, carrier)
        numbers.append(index - 1)
        placements.append(_placement(location))
    stored = _stored_triangulations(bare)
    if len(stored) != distinct.Size():
        raise RuntimeError(f"{distinct.Size()} triangulations written, {len(stored)} read back")
    return [_placed(stored[number], placement) for number, placement in zip(numbers, placements, strict=True)]


def _stored_triangulations(shape: Kernel) -> list[FaceMesh]:
    """Return all triangulations of a shape, in order, through the kernel's binary format (BinTools, version 1).

    A section "Triangulations N" holds for each: node and triangle counts (int32), whether it has parameters (a byte),
    deflection, nodes, parameters (float64) and triangles (int32, from 1).
    """
    from OCP.BinTools import BinTools, BinTools_FormatVersion

    stream = io.BytesIO()
    BinTools.Write_s(shape, stream, True, False, BinTools_FormatVersion.BinTools_FormatVersion_VERSION_1)
    data = stream.getvalue()
    header = re.search(rb"\nTriangulations (\d+)\n", data)
    if header is None:
        raise RuntimeError("the kernel wrote no triangulations")
    at = header.end()
    meshes = []
    for _ in range(int(header[1])):
        nodes, triangles = (int(n) for n in np.frombuffer(data, "<i4", 2, at))
        has_uv = data[at + 8] != 0
        at += 17
        points = np.frombuffer(data, "<f8", 3 * nodes, at).reshape(-1, 3)
        at += 24 * nodes
        uv = np.frombuffer(data, "<f8", 2 * nodes, at).reshape(-1, 2) if has_uv else None
        at += 16 * nodes if has_uv else 0
        corners = np.frombuffer(data, "<i4", 3 * triangles, at).reshape(-1, 3).astype(np.int64) - 1
        at += 12 * triangles
        meshes.append(FaceMesh(points, corners, uv))
    return meshes


def _placement(location: Kernel) -> Floats | None:
    """Return a face's placement as a 3 x 4 matrix; None where it is not moved."""
    if location.IsIdentity():
        return None
    matrix = location.Transformation()
    return np.array([[matrix.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])


def _placed(mesh: FaceMesh, placement: Floats | None) -> FaceMesh:
    if placement is None:
        return mesh
    return FaceMesh(mesh.nodes @ placement[:, :3].T + placement[:, 3], mesh.triangles, mesh.uv)


def _with_seeds(surface: Parametric, mesh: FaceMesh) -> Parametric:
    assert mesh.uv is not None
    return Parametric(surface.evaluate, surface.bounds, mesh.nodes, mesh.uv, surface.sign)
