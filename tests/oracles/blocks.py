"""Blocks: one with a rectangular pocket, as a mesh and as a file, and one without."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

SIZE, WALL, TOP, FLOOR = (20.0, 16.0), 3.0, 6.0, 2.0
"""Its sides and the walls around the pocket, the heights of its top and of the floor, mm."""


def mesh() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Vertices (N, 3), triangles (M, 3) and their faces (M,).

    Faces: 1 the rim on top, 2 the sides, 3 the pocket's walls, 4 its floor, 5 the block's foot.
    """
    x, y = SIZE
    rings = [
        np.array([[a, b, z], [x - a, b, z], [x - a, y - b, z], [a, y - b, z]])
        for a, b, z in ((0.0, 0.0, 0.0), (0.0, 0.0, TOP), (WALL, WALL, TOP), (WALL, WALL, FLOOR))
    ]
    quads = [
        (face, [4 * ring + i, 4 * ring + j, 4 * ring + 4 + j, 4 * ring + 4 + i])
        for face, ring in ((2, 0), (1, 1), (3, 2))
        for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))
    ]
    quads += [(4, [12, 13, 14, 15]), (5, [3, 2, 1, 0])]
    triangles = np.array([half for _, (a, b, c, d) in quads for half in ([a, b, c], [a, c, d])])
    return np.concatenate(rings), triangles, np.repeat([face for face, _ in quads], 2)


def box(
    low: tuple[float, float, float], high: tuple[float, float, float]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """A closed block, its normals outwards: two triangles a side, bottom first, then top, front, right, back, left."""
    corners = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def write_stl(path: Path) -> None:
    """The block as STL."""
    vertices, triangles, _ = mesh()
    facets = (
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in vertices[corners])
        + "endloop\nendfacet\n"
        for corners in triangles
    )
    path.write_text(f"solid block\n{''.join(facets)}endsolid block\n", encoding="ascii")
