"""A path that clears a plane pocket, and what the simulated engagement along it is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import number_of, refused
from styluscam.errors import GeometryError
from styluscam.judging.engagement import RunEngagement, engagement, outlines, plane_points
from styluscam.types import FloatArray, Progress

MSR = 0.05
"""The smallest radius of the centre's path unless another is given, in tool radii."""

EDGES = "numbers of edges, from 0"

DIRECTIONS = ("climb", "conventional", "either")


@dataclass(frozen=True)
class ExemptPlace:
    """Cutting that the bound is not for. Lengths mm."""

    reason: str
    """``"entry"``: the helix into the material."""
    at: tuple[float, float]
    """Where it begins."""
    peak_deg: float
    """The largest engagement angle there."""
    length: float
    """Length of the path, once around a helix."""


@dataclass(frozen=True, eq=False, repr=False)
class PocketPath:
    """A path that clears a pocket. Lengths mm."""

    runs: list[tuple[FloatArray, str]]
    """Points (N, 3), each with the bulge of what begins there, and kind: ``"cut"``, ``"entry"`` (a helix, seen from above),
    ``"link"`` (at depth, through what is cleared), ``"rapid"`` (over the stock)."""
    engagement: list[RunEngagement]
    """The simulated engagement along each run: see :func:`styluscam.engagement`."""
    reachable_area: float
    """What of the stock the tool can reach, corners rounded by its radius and the smoothing radius, mm^2."""
    uncleared_area: float
    """What of that the planner did not clear, mm^2."""
    tool_radius: float
    """mm."""

    @property
    def cleared(self) -> list[tuple[FloatArray, float]]:
        """The points of all runs on which the tool is at depth, each with its radius: what a smaller tool finds cleared."""
        return [(points, self.tool_radius) for points, kind in self.runs if kind != "rapid"]

    @property
    def engagement_max_deg(self) -> float:
        """The largest simulated angle on cuts and links: on all that is not exempt."""
        return max((run.max_deg for run in self.engagement if run.kind != "entry"), default=0.0)

    @property
    def exempt(self) -> list[ExemptPlace]:
        """The places for which the bound does not hold."""
        return [
            ExemptPlace(
                "entry", (float(run.points[0, 0]), float(run.points[0, 1])), run.max_deg, float(run.distances[-1])
            )
            for run in self.engagement
            if run.kind == "entry"
        ]


def pocket_path(
    boundary: npt.ArrayLike,
    islands: Sequence[npt.ArrayLike] = (),
    *,
    tool_radius: float,
    engagement_deg: float,
    growth_deg: float = 0.0,
    smoothing_radius: float | None = None,
    open_edges: Sequence[int] = (),
    stock: npt.ArrayLike | Sequence[npt.ArrayLike] | None = None,
    rest_of: PocketPath | Sequence[PocketPath] = (),
    direction: str = "climb",
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> PocketPath:
    """A path that clears a plane pocket with a bounded engagement angle.

    The bound is ``engagement_deg + growth_deg``, 10 to 90 deg. The path is measured by :func:`styluscam.engagement`, which knows
    nothing of how it was planned: ``engagement_max_deg`` is what that finds, all of the path but the entries.

    Args:
        boundary: outline of the pocket: points (N, 2), or (N, 3) with the bulge of the edge that begins there.
        islands: outlines that stay.
        tool_radius: mm.
        engagement_deg: base angle.
        growth_deg: how much larger the angle may become.
        smoothing_radius: smallest radius of the centre's path (MSR), mm; 0.05 tool radii unless given. Corners stay
            rounded by the tool's radius and as much more; necks narrower than twice that sum are not cleared.
        open_edges: numbers of the boundary's edges beyond which is air.
        stock: outline of the material, or several; None: all of the pocket.
        rest_of: paths of larger tools that ran before: only what they leave is cleared.
        direction: ``"climb"`` or ``"conventional"``, for a spindle that turns clockwise; ``"either"``: both, whichever has
            the shorter way.
        progress: called with phase and fraction; ``False`` cancels.
        cancel: cancels from another thread.

    Raises:
        GeometryError: what is no outline, no edge, no radius, no angle.
        PlanError: the tool fits nowhere, or nothing is to be cut.
        Cancelled: when it is cancelled.
    """
    if direction not in DIRECTIONS:
        raise refused("direction", direction, '"climb", "conventional" or "either"', GeometryError)
    radius = number_of(tool_radius, "tool_radius")
    bound = bound_of(engagement_deg, growth_deg)
    smoothing = MSR * radius if smoothing_radius is None else number_of(smoothing_radius, "smoothing_radius")
    walls, material = _walls(boundary, islands), None if stock is None else outlines(stock, "stock")
    before = [path for one in _paths(rest_of) for path in one.cleared]
    ground = (
        walls[0],
        walls[1:],
        _edges(open_edges),
        material,
        before,
    )
    runs, (reachable, uncleared) = _engine.pocket_path(
        *ground, radius, math.radians(bound), smoothing, direction, progress=progress, cancel=cancel
    )
    measured = engagement(runs, radius, material, walls, cleared=before, progress=progress, cancel=cancel)
    return PocketPath(runs, measured, reachable, uncleared, radius)


def bound_of(engagement_deg: object, growth_deg: object) -> float:
    """The largest engagement angle, degrees."""
    growth = number_of(growth_deg, "growth_deg")
    if growth < 0.0:
        raise refused("growth_deg", growth, "0 or more", GeometryError)
    return number_of(engagement_deg, "engagement_deg") + growth


def _several(value: Iterable[object], key: str, expected: str) -> list[Any]:
    if not isinstance(value, Iterable):
        raise refused(key, value, expected, GeometryError)
    return list(value)


def _paths(value: object) -> list[PocketPath]:
    found: list[PocketPath] = []
    for path in value if isinstance(value, list | tuple) else [value]:
        if not isinstance(path, PocketPath):
            raise refused("rest_of", path, "paths that pocket_path returned", GeometryError)
        found.append(path)
    return found


def _walls(boundary: npt.ArrayLike, islands: Iterable[object]) -> list[FloatArray]:
    within = enumerate(_several(islands, "islands", "outlines"))
    return [plane_points(boundary, "boundary"), *(plane_points(one, f"islands[{i}]") for i, one in within)]


def _edges(value: Iterable[object]) -> list[int]:
    edges = _several(value, "open_edges", EDGES)
    for edge in edges:
        if isinstance(edge, bool) or not isinstance(edge, int) or edge < 0:
            raise refused("open_edges", edge, EDGES, GeometryError)
    return edges
