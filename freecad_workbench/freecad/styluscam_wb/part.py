# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a Part shape to the engine's part: triangles whose deviation from the exact surfaces is checked."""

from __future__ import annotations

import itertools
import os
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from . import engine
from .edges import curves_of, model_of
from .surfaces import surface_of, with_uv

if TYPE_CHECKING:
    from styluscam import Part as EnginePart
    from styluscam.parts.arrays import PartArrays
    from styluscam.parts.tessellation import FaceMesh

    Progress = Any

KEPT = 4
"""Parts that a session remembers."""

ANY_DEFLECTION = 1e3
"""Asked of a face that is meshed already, the kernel gives back what it has."""

KERNEL_ALGORITHM = "CSF_MeshAlgo"
"""OpenCASCADE's variable."""

_known: OrderedDict[tuple[int, float], tuple[Any, EnginePart]] = OrderedDict()


def part_of(shape: Any, tolerance: float, name: str, progress: Progress | None = None) -> EnginePart:
    """The engine's part for a Part.Shape within `tolerance` (mm); the same shape is tessellated once a session.

    Face1 is shape.Faces[0]. Coordinates are the document's.

    Raises:
        styluscam.GeometryError: no faces, or faces that cannot be meshed within the tolerance.
    """
    key = (shape.hashCode(), tolerance)
    known = _known.get(key)
    if known is not None and known[0].isEqual(shape):
        _known.move_to_end(key)
        return known[1]
    part = engine.styluscam().Part.from_arrays(arrays_of(shape, tolerance, name, progress))
    _known[key] = (shape, part)
    while len(_known) > KEPT:
        _known.popitem(last=False)
    return part


def arrays_of(shape: Any, tolerance: float, name: str, progress: Progress | None = None) -> PartArrays:
    """The shape's faces as one welded mesh, with the exact surfaces behind it."""
    from styluscam.parts import assembly
    from styluscam.parts.progress import report
    from styluscam.parts.surfaces import Parametric
    from styluscam.parts.tessellation import refine_until
    from styluscam.parts.trimmed import OWN_ATTEMPTS, shares

    source = FilePath(name)
    bare = shape.copy(True, False)  # a mesh of its own: the document's shape keeps the one it shows
    faces = bare.Faces
    if not faces:
        raise _no_faces(name)
    surfaces = [surface_of(face) for face in faces]
    model, attempts = model_of(faces, surfaces), itertools.count()

    def mesh_at(deflection: float) -> list[FaceMesh]:
        report(progress, "mesh", 0.3)
        own = None if model is None or next(attempts) >= OWN_ATTEMPTS else model.meshes(surfaces, deflection)
        meshes = _meshes(bare, faces, deflection, name) if own is None else own
        for i, (face, surface) in enumerate(zip(faces, surfaces, strict=True)):
            if isinstance(surface, Parametric):
                surfaces[i], meshes[i] = with_uv(face, surface, meshes[i])
        report(progress, "check", 0.6)
        return [assembly.outward(mesh, surface) for mesh, surface in zip(meshes, surfaces, strict=True)]

    aims = None if model is None else shares(surfaces)

    def checked(share: float) -> None:
        report(progress, "check", 0.6 + 0.3 * share)

    tessellation = refine_until(mesh_at, surfaces, tolerance, name, checked=checked, shares=aims)
    areas = [(face.Area, tuple(face.CenterOfMass)) for face in faces]
    kinds = [assembly.kind_of(surface) for surface in surfaces]
    notes = () if bare.isClosed() else ("the model is not a closed solid: its material side is a guess",)
    return assembly.assemble(
        source,
        tolerance,
        "mm",
        notes=notes,
        surfaces=surfaces,
        kinds=kinds,
        areas=areas,
        tessellation=tessellation,
        edges=curves_of(bare),
    )


def _meshes(shape: Any, faces: list[Any], deflection: float, name: str) -> list[FaceMesh]:
    """The kernel's triangles of each face; neighbours share their border nodes."""
    import MeshPart

    from styluscam.parts.trimmed import ANGLE

    for algorithm in ("delabella", "watson"):
        with _mesher(algorithm):
            MeshPart.meshFromShape(Shape=shape, LinearDeflection=deflection, AngularDeflection=ANGLE, Relative=False)
        if all(_is_meshed(face) for face in faces):
            break
    return [_face_mesh(face, f"{name}:Face{number}") for number, face in enumerate(faces, 1)]


def _face_mesh(face: Any, name: str) -> FaceMesh:
    from styluscam import GeometryError
    from styluscam.parts.tessellation import FaceMesh

    points, triangles = face.tessellate(ANY_DEFLECTION) if _is_meshed(face) else ([], [])
    if not triangles:
        message = f"{name}: the kernel cannot mesh this face: repair it in the CAD system"
        raise GeometryError(message, code="part-face-not-meshed", where=name)
    return FaceMesh(np.array([(p.x, p.y, p.z) for p in points]), np.array(triangles, dtype=np.int64))


def _no_faces(name: str) -> Exception:
    from styluscam import GeometryError

    return GeometryError(f"{name}: the model has no faces: choose a solid", code="part-no-solid", where=name)


def _is_meshed(face: Any) -> bool:
    try:
        return len(face.getUVNodes()) > 0
    except RuntimeError:
        return False


@contextmanager
def _mesher(algorithm: str) -> Iterator[None]:
    """Lets OpenCASCADE mesh with an algorithm: FreeCAD has no argument for it, the kernel reads this at each call.

    Delabella is up to ten times faster than the default, Watson, on fine meshes, but leaves some freeform faces empty.
    """
    before = os.environ.get(KERNEL_ALGORITHM)
    os.environ[KERNEL_ALGORITHM] = algorithm
    try:
        yield
    finally:
        if before is None:
            del os.environ[KERNEL_ALGORITHM]
        else:
            os.environ[KERNEL_ALGORITHM] = before
