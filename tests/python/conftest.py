"""Fixture parts read once, their exact meridians, jobs built from dicts, and a made part of pits and bumps."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
import pytest
from numpy.typing import NDArray

import styluscam as sc
from meridian import FIXTURES, Meridian

Floats: TypeAlias = NDArray[np.float64]
Mesh: TypeAlias = tuple[Floats, NDArray[np.int64]]
"""Vertices (N, 3) and triangles (M, 3)."""

FACES = {
    "cone_cup": ["Face1", "Face2", "Face3", "Face4"],
    "cap_r60": ["Face1"],
    "vwaf": ["Face1", "Face2", "Face3", "Face4"],
}
"""The formed faces: all but flange, plate and block."""


@lru_cache(maxsize=4)
def _part(name: str) -> sc.Part:
    return sc.Part.read(FIXTURES / f"{name}.step", tolerance=0.001)


@pytest.fixture(scope="session")
def part_of() -> Callable[[str], sc.Part]:
    """Reads a fixture part once per session."""
    pytest.importorskip("OCP", reason="needs the step extra")
    return _part


@pytest.fixture(scope="session")
def meridian_of() -> Callable[[str], Meridian]:
    """The exact meridian of a fixture part."""
    return lru_cache(maxsize=4)(Meridian.of)


def job_document(
    part: str, kind: str, profile: dict[str, Any], *, machine: str = "linuxcnc", **operation: Any
) -> dict[str, Any]:
    """A coarse job on a 1 mm sheet of constant thickness; `operation` overrides."""
    pitch = {"step": {"height": 2.5}} if kind == "z-level" else {"stepover": 2.5, "angle_deg": 30.0}
    return {
        "schema": 1,
        "part": {"file": f"{part}.step", "faces": FACES.get(part, "all"), "model_face": "back"},
        "setup": {"zero": "sheet-top", "sheet": {"thickness": 1.0}},
        "tools": {"tool": {"profile": profile}},
        "operations": [{"kind": kind, "tool": "tool", **pitch, **operation}],
        "machine": {"name": machine},
    }


def milling_document(
    kind: str, profile: dict[str, Any], *, machine: str = "linuxcnc", **operation: Any
) -> dict[str, Any]:
    """The same without a sheet, for parts that are handed over as they are."""
    operation.setdefault("spindle", {"mode": "fixed", "rpm": 8000.0})
    document = job_document("made", kind, profile, machine=machine, **operation)
    document["part"] = {"file": "made.stl", "units": "mm"}
    document["setup"] = {}
    document["process"] = {"kind": "milling"}
    return document


def box(low: list[float], high: list[float]) -> Mesh:
    corners = np.array([[x, y, z] for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])])
    sides = [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]]
    return corners, np.array([half for a, b, c, d in sides for half in ([a, b, c], [a, c, d])])


def together(*meshes: Mesh) -> Mesh:
    firsts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    triangles = [triangles + first for (_, triangles), first in zip(meshes, firsts, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(triangles)


CELL = 6.0
"""Side of a cell of the made part, mm."""


def made_part(rows: int, widths: Floats, shifts: Floats, depth: float, wall_deg: float) -> Mesh:
    """Vertices and triangles of a plate of square cells, each with a square pit (`depth` < 0 in odd cells) or bump.

    `widths` (N,) are the squares' half sides at half their depth, `shifts` (N, 2) their positions off the cells' middles.
    """
    run = 0.5 * depth / np.tan(np.radians(wall_deg))
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)
    vertices: list[Floats] = []
    triangles: list[tuple[int, int, int]] = []
    for n, (half, shift) in enumerate(zip(widths, shifts, strict=True)):
        middle = CELL * (np.array([n % rows, n // rows]) + 0.5)
        height = depth if n % 2 == 0 else -depth
        outer, inner = half + run, half - run
        rings = [
            np.column_stack([middle + 0.5 * CELL * square, np.zeros(4)]),
            np.column_stack([middle + shift + outer * square, np.zeros(4)]),
            np.column_stack([middle + shift + inner * square, np.full(4, height)]),
        ]
        base = 12 * n
        vertices += rings
        for low in (base, base + 4):
            for i in range(4):
                a, b, c, d = low + i, low + (i + 1) % 4, low + 4 + i, low + 4 + (i + 1) % 4
                triangles += [(a, b, d), (a, d, c)]
        triangles += [(base + 8, base + 9, base + 10), (base + 8, base + 10, base + 11)]
    points, index = np.unique(np.round(np.concatenate(vertices), 9), axis=0, return_inverse=True)
    return points, np.asarray(index.reshape(-1)[np.array(triangles)], dtype=np.int64)


@pytest.fixture(scope="session")
def small_part() -> Mesh:
    """A plate of 4 x 2 cells: lopsided, so that every turn of it shows."""
    widths = np.array([1.0, 1.4, 1.8, 1.2, 1.6, 1.1, 1.3, 1.5])
    shifts = np.column_stack([np.linspace(-0.3, 0.3, 8), np.linspace(0.2, -0.4, 8)])
    return made_part(4, widths, shifts, 2.0, 60.0)
