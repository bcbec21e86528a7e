"""Parts from STEP, BREP and IGES files through OpenCASCADE (OCP): faces, exact surfaces and a checked mesh."""

from __future__ import annotations

from pathlib import Path

from styluscam.parts.arrays import PartArrays
from styluscam.parts.assembly import assemble, kind_of
from styluscam.parts.edges import edge_curves
from styluscam.parts.exact import area_and_centre, careful_area, surface_of
from styluscam.parts.kernel import faces_of, kernel_failures, ocp, quiet_kernel
from styluscam.parts.loading import bodies, check_extent, load
from styluscam.parts.meshing import tessellate
from styluscam.parts.progress import Progress, report


def read_brep(file: Path, tolerance: float, progress: Progress | None = None) -> PartArrays:
    """Read the part in a STEP, BREP or IGES file. See styluscam.parts.read_part."""
    ocp(file)
    with quiet_kernel(), kernel_failures(file):
        report(progress, "read", 0.0)
        shape, units = load(file)
        faces = faces_of(shape)
        notes = bodies(file, shape, faces)
        check_extent(file, shape, units)
        report(progress, "mesh", 0.2)
        surfaces = [surface_of(face) for face in faces]
        tessellation = tessellate(file, shape, faces, surfaces=surfaces, tolerance=tolerance, progress=progress)
        areas = [area_and_centre(face) for face in faces]
        edges = edge_curves(shape)
    report(progress, "arrays", 0.9)
    kinds = [kind_of(surface) for surface in surfaces]
    part = assemble(
        file,
        tolerance,
        units,
        notes=notes,
        surfaces=surfaces,
        kinds=kinds,
        areas=areas,
        tessellation=tessellation,
        edges=edges,
        exact_area=lambda i: careful_area(faces[i]),
    )
    report(progress, "arrays", 1.0)
    return part
