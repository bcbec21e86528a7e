"""Triangles out: STL and PLY files through trimesh."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import numpy.typing as npt

from styluscam.errors import GeometryError
from styluscam.extras import require
from styluscam.files import drawn_whole
from styluscam.types import FloatArray, IntArray


def write_triangles(
    file: Path, vertices: FloatArray, triangles: IntArray, colours: npt.NDArray[np.uint8] | None = None
) -> None:
    """Writes vertices (V, 3), triangles (T, 3) and, where the format has them, the vertices' colours (V, 3), by the ending.

    Raises:
        StylusError: trimesh is missing, or a path that cannot be written to.
    """
    trimesh = writer(file)
    mesh = trimesh.Trimesh(vertices, triangles, vertex_colors=colours, process=False)
    with drawn_whole(file) as temporary:
        mesh.export(temporary, file_type=file.suffix.lower().lstrip("."))


def writer(file: Path) -> ModuleType:
    """trimesh; ``file`` is what it is needed for.

    Raises:
        GeometryError: it is missing.
    """
    what = f"{file}: writing {file.suffix.lower()} files"
    return require("mesh", what, modules=("trimesh",), failure=GeometryError, where=str(file))
