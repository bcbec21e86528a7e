"""The bench's part and its points: a wavy surface of 100 x 100 mm, asked in raster order and at random."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SIDE = 100.0
PITCH = 0.1


def wavy(triangles: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles, about as many as asked."""
    cells = round((triangles / 2) ** 0.5)
    axis = np.linspace(0.0, SIDE, cells + 1)
    x, y = np.meshgrid(axis, axis)
    z = 4.0 * np.sin(x / 7.0) * np.cos(y / 9.0) + 1.5 * np.sin(x / 2.9 + y / 4.3)
    corner = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].reshape(-1)
    right, up = corner + 1, corner + cells + 1
    faces = np.concatenate([np.stack([corner, right, up + 1], axis=1), np.stack([corner, up + 1, up], axis=1)])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces


def positions(order: str, count: int) -> NDArray[np.float64]:
    """Positions (N, 2): "raster" in rows of `PITCH`, every other one backwards, in the surface's middle; or "random"."""
    if order == "random":
        return np.random.default_rng(1).uniform(1.0, SIDE - 1.0, (count, 2))
    columns = round((SIDE - 2.0) / PITCH)
    rows = max(count // columns, 1)
    x = np.tile(1.0 + PITCH * np.arange(columns), (rows, 1))
    x[1::2] = x[1::2, ::-1]
    y = SIDE / 2 + PITCH * (np.arange(rows) - rows // 2)
    return np.stack([x.reshape(-1), np.repeat(y, columns)], axis=1)
