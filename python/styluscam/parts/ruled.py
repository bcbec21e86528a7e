"""Ruled faces: the two curves between whose points of equal parameter a face's straight lines run."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from styluscam.errors import GeometryError
from styluscam.flank.rails import Rail
from styluscam.parts.arrays import PartArrays
from styluscam.parts.surfaces import Cone, Cylinder, ExactSurface, Floats, Nurbs, Parametric, unit

STRAIGHT = 1e-6
"""How far a line of a freeform surface may be from straight, mm."""
LOOKED_AT = 17
"""Lines of a surface, and points of each, that are looked at."""
SAME_AREA = 0.01
"""By what share a face's area may differ from that of its strip: a face that is cut out of the strip is none."""

CLOSED = np.radians(20.0)
"""A face around an axis whose widest gap is less goes all around: it begins and ends where one of its points is."""

Rails = tuple[Rail, Rail]


def ruled_faces(part: PartArrays) -> dict[int, Rails]:
    """The rails of the faces that are ruled from end to end between them, by the faces' numbers.

    Planes are left out: their lines run in every direction.
    """
    if part.is_mesh or not part.surfaces:
        return {}
    found = {}
    ends = np.searchsorted(part.face_ids, np.arange(1, len(part.faces) + 2))
    for index, (face, surface) in enumerate(zip(part.faces, part.surfaces, strict=True)):
        own = part.triangles[int(ends[index]) : int(ends[index + 1])]
        rails = rails_of(surface, part.vertices[np.unique(own)])
        if rails is not None and abs(_area(rails) - face.area_mm2) <= SAME_AREA * face.area_mm2:
            found[face.id] = rails
    return found


def rails_of(surface: ExactSurface, points: Floats) -> Rails | None:
    """The rails of a surface between the outermost of points (N, 3) of its face; None where no straight lines are known."""
    try:
        if isinstance(surface, Parametric) and isinstance(surface.evaluate, Nurbs):
            return _of_nurbs(surface.evaluate, surface, points)
        if isinstance(surface, (Cylinder, Cone)):
            return _of_revolution(surface, points)
    except (GeometryError, ValueError):
        return None
    return None


def _of_nurbs(nurbs: Nurbs, surface: Parametric, points: Floats) -> Rails | None:
    uv = surface.seed_uv if len(surface.seed_uv) else surface.project(points, surface.nearest_seed(points))
    low, high = uv.min(axis=0), uv.max(axis=0)
    for across in (1, 0):
        if not _is_straight(nurbs, low, high, across):
            continue
        ends = (nurbs.iso_curve(across, float(value[across])) for value in (low, high))
        first, second = (Rail(*curve).between(float(low[1 - across]), float(high[1 - across])) for curve in ends)
        return first, second
    return None


def _is_straight(nurbs: Nurbs, low: Floats, high: Floats, across: int) -> bool:
    """Whether the lines of one parameter are straight, in the face's range."""
    shares = np.linspace(0.0, 1.0, LOOKED_AT)
    uv = np.empty((LOOKED_AT, LOOKED_AT, 2))
    uv[..., across] = low[across] + shares * (high[across] - low[across])
    uv[..., 1 - across] = (low[1 - across] + shares * (high[1 - across] - low[1 - across]))[:, None]
    lines = nurbs(uv.reshape(-1, 2))[0].reshape(LOOKED_AT, LOOKED_AT, 3)
    from_start = lines - lines[:, :1]
    along = unit(from_start[:, -1])
    aside = from_start - np.einsum("ijk,ik->ij", from_start, along)[..., None] * along[:, None]
    return bool(np.linalg.norm(aside, axis=2).max() <= STRAIGHT)


def _of_revolution(surface: Cylinder | Cone, points: Floats) -> Rails | None:
    """Arcs across a cylinder's or cone's axis, at the ends of what the points cover of it."""
    axis, location = np.array(surface.axis), np.array(surface.location)
    from_axis = points - location
    heights = from_axis @ axis
    across = unit(from_axis - heights[:, None] * axis)
    if np.linalg.norm(from_axis - heights[:, None] * axis, axis=1).min() < STRAIGHT:
        return None  # a cone's apex
    first = across[0]
    second = np.cross(axis, first)
    angles = np.sort(np.arctan2(across @ second, across @ first))
    gaps = np.diff(np.concatenate([angles, angles[:1] + 2.0 * np.pi]))
    widest = int(np.argmax(gaps))
    if np.ptp(heights) < STRAIGHT:
        return None
    is_closed = gaps[widest] < CLOSED
    start = 0.0 if is_closed else angles[(widest + 1) % len(angles)]
    sweep = 2.0 * np.pi if is_closed else 2.0 * np.pi - gaps[widest]
    growth = np.tan(surface.semi_angle) if isinstance(surface, Cone) else 0.0

    unit_arc = _unit_arc(float(sweep))
    turned = np.array([np.cos(start) * first + np.sin(start) * second, np.cos(start) * second - np.sin(start) * first])

    def arc(height: float) -> Rail:
        poles = location + height * axis + abs(surface.radius + growth * height) * (unit_arc.poles[:, :2] @ turned)
        return replace(unit_arc, poles=poles)

    return arc(float(heights.min())), arc(float(heights.max()))


@lru_cache(maxsize=64)
def _unit_arc(sweep: float) -> Rail:
    """About +Z from +X on, rad."""
    return Rail.of(
        lambda shares: np.stack([np.cos(sweep * shares), np.sin(sweep * shares), 0.0 * shares], axis=1), "arc"
    )


def _area(rails: Rails) -> float:
    """Of the strip between two rails, mm^2."""
    u = np.linspace(0.0, 1.0, 129)
    first, second = (rail.at(u) for rail in rails)
    v = np.linspace(0.0, 1.0, 17)[:, None, None]
    grid = first + (second - first) * v
    a, b = np.diff(grid[:, :-1], axis=0), np.diff(grid[:-1], axis=1)
    c, d = np.diff(grid[:, 1:], axis=0), np.diff(grid[1:], axis=1)
    sizes = np.linalg.norm(np.cross(a, b), axis=2) + np.linalg.norm(np.cross(c, d), axis=2)
    return float(sizes.sum() / 2.0)
