"""Milling along one profile with a bounded engagement angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import number_of, refused
from styluscam.errors import GeometryError
from styluscam.judging.engagement import outlines, plane_points
from styluscam.pocketing.path import PocketPath, pocket_path
from styluscam.types import Progress

SIDES = ("left", "right")


def contour_path(
    profile: npt.ArrayLike,
    *,
    width: float,
    tool_radius: float,
    engagement_deg: float,
    side: str = "left",
    closed: bool = False,
    growth_deg: float = 0.0,
    smoothing_radius: float | None = None,
    stock: npt.ArrayLike | Sequence[npt.ArrayLike] | None = None,
    rest_of: PocketPath | Sequence[PocketPath] = (),
    direction: str = "climb",
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> PocketPath:
    """A path that clears a strip along one profile with a bounded engagement angle: milling around a part, or along an edge.

    Only the profile is a wall, and beyond its ends the straight lines on. What lies beyond the strip is taken for air: it is
    neither cut nor kept away from.

    Args:
        profile: points (N, 2), or (N, 3) with the bulge of the edge that begins there.
        width: of the strip, mm: all material is cleared that is no farther from the profile, on its side.
        tool_radius: mm.
        engagement_deg: base angle.
        side: ``"left"`` or ``"right"`` of the profile, in the direction of its points.
        closed: whether the last point is joined to the first.
        growth_deg: how much larger the angle may become.
        smoothing_radius: as of :func:`styluscam.pocket_path`.
        stock: outline of the material, or several; None: all of the strip.
        rest_of: as of :func:`styluscam.pocket_path`.
        direction: as of :func:`styluscam.pocket_path`.
        progress: called with phase and fraction; ``False`` cancels.
        cancel: cancels from another thread.

    Raises:
        GeometryError: what is no profile, no width, no radius, no angle; a profile that crosses itself.
        PlanError: nothing is to be cut.
        Cancelled: when it is cancelled.
    """
    if side not in SIDES:
        raise refused("side", side, '"left" or "right"', GeometryError)
    points, material = plane_points(profile, "profile"), None if stock is None else outlines(stock, "stock")
    lengths = number_of(width, "width"), number_of(tool_radius, "tool_radius")
    boundary, islands, strip = _engine.contour_strip(points, bool(closed), side == "left", *lengths, material)
    return pocket_path(
        boundary,
        islands,
        tool_radius=tool_radius,
        engagement_deg=engagement_deg,
        growth_deg=growth_deg,
        smoothing_radius=smoothing_radius,
        stock=strip,
        rest_of=rest_of,
        direction=direction,
        progress=progress,
        cancel=cancel,
    )
