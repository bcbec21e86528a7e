"""The engagement angle of a round tool along plane paths, measured without knowing how they were planned."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import number_of, refused
from styluscam.errors import GeometryError
from styluscam.types import FloatArray, Progress, numbers, shaped

XY = 2
"""Columns of points without bulges."""


@dataclass(frozen=True, eq=False, repr=False)
class RunEngagement:
    """The engagement along one run, at steps of 0.02 tool radii. Lengths mm."""

    kind: str
    """As given: ``"cut"``, ``"entry"``, ``"link"``, ``"rapid"`` (over the stock: not measured)."""
    points: FloatArray
    """The tool's centre, (N, 2)."""
    distances: FloatArray
    """Length travelled in the run up to there, (N,)."""
    angles_deg: FloatArray
    """The engagement angle, (N,)."""
    clearances: FloatArray
    """Distance from the tool's centre to the nearest wall, (N,); infinite beyond two tool radii."""
    stepovers: FloatArray
    """Area cleared per length of the path, (N,): the radial stepover; 0 where the tool comes down."""

    @property
    def max_deg(self) -> float:
        """The largest angle, 0 where nothing was measured."""
        return float(self.angles_deg.max(initial=0.0))


def engagement(
    runs: Iterable[tuple[npt.ArrayLike, str]],
    tool_radius: float,
    stock: npt.ArrayLike | Sequence[npt.ArrayLike] | None,
    boundary: npt.ArrayLike | Sequence[npt.ArrayLike],
    *,
    cleared: Iterable[tuple[npt.ArrayLike, float]] = (),
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> list[RunEngagement]:
    """The engagement along every run of a path, in the order in which they are cut.

    A direction of the tool's rim is engaged where it lies less than a right angle from the heading and a chip thicker than
    1 um is cut there; the engagement angle is the angle of all engaged directions together. Material is what lies in the stock
    and within the boundary, and was not swept before: walls are not material. It is exact for lines and arcs at every position
    that is measured.

    Args:
        runs: pairs of points and kind, as :func:`styluscam.pocket_path` returns them: points (N, 2), or (N, 3) with the bulge of
            what begins there (the tangent of a quarter of the arc's angle, positive to the left); kinds are ``"cut"``,
            ``"entry"``, ``"link"`` and ``"rapid"``. Where a run does not begin at the last one's end, the tool comes down
            into what is there.
        tool_radius: mm.
        stock: outline of the material, or several (islands are outlines within outlines); None: all within the
            boundary.
        boundary: outline of the pocket, or several: its walls and its islands'.
        cleared: pairs of points and tool radius (mm): paths along which other tools have cleared before.
        progress: called with phase and fraction; ``False`` cancels.
        cancel: cancels from another thread.

    Raises:
        GeometryError: what is not a path, an outline or a radius.
        Cancelled: when it is cancelled.
    """
    given = [_run(number, run) for number, run in enumerate(runs)]
    walls = outlines(boundary, "boundary")
    material = walls if stock is None else outlines(stock, "stock")
    radius = number_of(tool_radius, "tool_radius")
    before = cleared_paths(cleared)
    found = _engine.engagement(given, radius, material, walls, before, progress=progress, cancel=cancel)
    return [
        RunEngagement(kind, rows[:, :2], rows[:, 2], np.degrees(rows[:, 3]), rows[:, 4], rows[:, 5])
        for (_, kind), rows in zip(given, found, strict=True)
    ]


def _run(number: int, run: Any) -> tuple[FloatArray, str]:  # noqa: ANN401  # whatever was given
    name = f"runs[{number}]"
    match run:
        case (points, str(kind)):
            return plane_points(points, name), kind
        case _:
            raise refused(name, run, 'points and a kind, like ([[0, 0], [10, 0]], "cut")', GeometryError)


def cleared_paths(paths: Iterable[Any]) -> list[tuple[FloatArray, float]]:
    """Paths of other tools, each with the tool's radius, mm.

    Raises:
        GeometryError: something else.
    """
    found = []
    for number, path in enumerate(paths):
        name = f"cleared[{number}]"
        match path:
            case (points, radius):
                found.append((plane_points(points, name), number_of(radius, f"{name}.radius")))
            case _:
                raise refused(name, path, "points and a tool's radius, like ([[0, 0], [10, 0]], 5.0)", GeometryError)
    return found


def plane_points(values: Any, name: str) -> FloatArray:  # noqa: ANN401  # whatever was given
    """Points (N, 2), or (N, 3) with bulges, as points with bulges.

    Raises:
        GeometryError: something else.
    """
    array = numbers(values, name)
    if array.ndim == XY and array.shape[1] == XY:
        return np.column_stack([array, np.zeros(len(array))])
    return shaped(array, (None, 3), name)


def outlines(values: npt.ArrayLike | Sequence[npt.ArrayLike], name: str) -> list[FloatArray]:
    """One outline or several, as points with bulges.

    Raises:
        GeometryError: something else.
    """
    if isinstance(values, list | tuple) and values and np.ndim(values[0]) == XY:
        return [plane_points(outline, f"{name}[{number}]") for number, outline in enumerate(values)]
    return [plane_points(values, f"{name}[0]")]
