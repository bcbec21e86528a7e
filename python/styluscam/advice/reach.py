"""How much a tool leaves in concave corners: an estimate from its profile alone, before anything is planned.

Look along a corner, at the section across it. The surface turns there from one plane to another, in an edge or over a
fillet. A tool whose support function in that section (the distance of its tangent from a fixed point, by direction)
less the fillet's radius is D stands free where t . n >= D for all normals n between the planes, t its position seen from the
fillet's centre. The point n stays away from every free tool by the least t . n - D: by what the concave hull of D over
the tangent of the angle rises above it. For a ball of radius R in an edge that is R / cos(half the turn) - R. In an edge
the gap is taken along the planes' normals, as planning measures it, which is a little more.
"""

from __future__ import annotations

import numpy as np

from styluscam.advice.walls import Corners
from styluscam.tools.tool import Tool
from styluscam.types import FloatArray

STATIONS = 49
"""Normals between the two planes that are looked at."""

STEEPEST = 0.05
"""Cosine from which a tangent of the tool is as good as parallel to a plane's normal."""


def gaps(tool: Tool, corners: Corners, ball: float) -> tuple[FloatArray, FloatArray]:
    """What stays between each corner and the tool, and the width of the strip that it does not touch, (K,) mm each.

    ``ball`` is the radius (mm) of the ball by which a sheet rounds the tool.
    """
    a, b = corners.sides[:, 0], corners.sides[:, 1]
    angle = np.arccos(np.clip(np.einsum("nk,nk->n", a, b), -1.0, 1.0))
    aside = b - np.cos(angle)[:, None] * a
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-12)
    turns = angle[:, None] * np.linspace(0.0, 1.0, STATIONS)
    normals = np.cos(turns)[..., None] * a[:, None] + np.sin(turns)[..., None] * aside[:, None]
    slopes = np.arccos(np.clip(normals[..., 2], 0.0, 1.0))
    support = _support(tool, slopes) + ball - corners.radii[:, None]
    found = [_section(*each) for each in zip(turns, support, corners.radii, strict=True)]
    return np.array([gap for gap, _ in found]), np.array([width for _, width in found])


def _support(tool: Tool, slopes: FloatArray) -> FloatArray:
    """Distance (mm) of the tangent from the tip, by slope (rad); beyond the profile's end the rim is touched."""
    asked = np.minimum(slopes, tool.max_slope)
    return np.asarray(tool.radius_at(asked) * np.sin(slopes) - tool.height_at(asked) * np.cos(slopes))


def _section(turns: FloatArray, support: FloatArray, radius: float) -> tuple[float, float]:
    """Largest gap of one corner, and the width of the strip around it that is not touched."""
    from_middle = turns - 0.5 * turns[-1]
    along, height = np.tan(from_middle), support / np.cos(from_middle)
    hull = _hull(along, height)
    left = (np.interp(along, along[hull], height[hull]) - height) * np.cos(from_middle)
    worst = int(np.argmax(left))
    if left[worst] <= 1e-9:
        return 0.0, 0.0
    end = int(np.searchsorted(hull, worst))
    i, j = hull[end - 1], hull[end]
    turn = turns[j] - turns[i]
    across = (support[j] - np.cos(turn) * support[i]) / np.sin(turn)
    back = np.cos(turn) * across - np.sin(turn) * support[i]
    slope = np.gradient(support, turns, edge_order=2)
    beside = max(0.0, float(across - slope[i])) + max(0.0, float(slope[j] - back))
    gap = float(left[worst]) if radius > 0.0 else float((left / _steepness(turns)).max())
    return gap, radius * float(turn) + beside


def _steepness(turns: FloatArray) -> FloatArray:
    """Cosine of the angle to the farther plane's normal."""
    return np.asarray(np.maximum(np.cos(np.maximum(turns, turns[-1] - turns)), STEEPEST))


def _hull(x: FloatArray, y: FloatArray) -> list[int]:
    """Indices of the upper hull of points in the order of x (Andrew's monotone chain)."""
    kept: list[int] = []
    for k in range(len(x)):
        while len(kept) > 1:
            i, j = kept[-2], kept[-1]
            if (y[j] - y[i]) * (x[k] - x[i]) > (y[k] - y[i]) * (x[j] - x[i]):
                break
            kept.pop()
        kept.append(k)
    return kept
