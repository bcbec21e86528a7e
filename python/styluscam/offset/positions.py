"""Where the tool stands: slope-matched offset, drop-cutter, waterlines."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import document_of, json_of, number_of
from styluscam.errors import GeometryError
from styluscam.parts.part import Part, PartLike
from styluscam.tools.tool import Tool, ToolLike
from styluscam.types import Document, FloatArray, Progress, numbers, points, shaped

SHEET = ("thickness", "law", "model_face")
NEEDED = ("thickness", "model_face")
"""Keys of a sheet, and those that it has to have."""

REGULAR, RIM, UNDERCUT = 0, 1, 2
"""Flags of :class:`Offsets`."""


class Offsets(np.ndarray[tuple[int, ...], np.dtype[np.float64]]):
    """CL points (N, 3), mm. ``.flags`` (N,) is for each: regular, rim (steeper than the profile), undercut.

    What is computed from it is a plain array again, with numpy's own ``flags``.
    """

    _by_point: npt.NDArray[np.uint8] | None = None

    @property
    def flags(self) -> Any:  # noqa: ANN401 - numpy's own flags have no public type
        """Flag by point (N,)."""
        return super().flags if self._by_point is None else self._by_point

    def __reduce__(self) -> tuple[Any, ...]:
        """For pickle and copy: the flags travel along."""
        return _again, (np.asarray(self).copy(), self._by_point)

    def __deepcopy__(self, memo: object) -> Offsets:
        """The tips and their flags."""
        return _again(np.asarray(self).copy(), self._by_point)

    def __copy__(self) -> Offsets:
        """The tips and their flags."""
        return _again(np.asarray(self).copy(), self._by_point)


def _again(tips: FloatArray, flags: npt.NDArray[np.uint8] | None) -> Offsets:
    """Offsets as they were."""
    result = tips.view(Offsets)
    result._by_point = flags
    return result


def _sheet(sheet: Document | None) -> str | None:
    if sheet is None:
        return None
    document = document_of(sheet, "sheet", 'a dict like {"thickness": 1.0, "model_face": "back"}', GeometryError)
    for key in [key for key in document if key not in SHEET] + [key for key in NEEDED if key not in document]:
        what = f"{key} is missing" if key in NEEDED else f"unknown key {key!r}"
        raise GeometryError(f"sheet: {what}", code="argument", where="sheet", hint=f"its keys are {', '.join(SHEET)}")
    return json_of(document, "sheet", GeometryError)


def sheet_raise(sheet: Document) -> float:
    """How far a sheet lifts the tool over a horizontal face of the model, mm; ``sheet`` as in :func:`slope_matched_offset`.

    Raises:
        GeometryError: keys or a thickness that no sheet has.
    """
    return _engine.sheet_raise(_sheet(sheet) or "{}")


def slope_matched_offset(
    tool: ToolLike, points_: npt.ArrayLike, normals: npt.ArrayLike, sheet: Document | None = None
) -> Offsets:
    """Tips (N, 3) of the tool touching ``points_`` (N, 3) with outward ``normals`` (N, 3), exact to rounding.

    ``sheet = {"thickness": 1.0, "law": "constant", "model_face": "back"}``. The tool may interfere elsewhere: see
    :func:`drop_cutter`. Source: US 2023/0035585.
    """
    tips, flags = _engine.slope_matched_offset(
        Tool.of(tool)._engine, points(points_, 3), points(normals, 3, "normals"), _sheet(sheet)
    )
    return _again(tips, flags)


def drop_cutter(
    part: PartLike,
    tool: ToolLike,
    xy: npt.ArrayLike,
    sheet: Document | None = None,
    floor: float | None = None,
    *,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> FloatArray:
    """Lowest tip heights (N,) at ``xy`` (N, 2) at which the tool does not enter the part, mm.

    Exact for the triangles; the part's checked inward deviation is added, so that a part that was read from a
    file is never entered. Where the tool meets nothing: ``floor``, else NaN.
    """
    level = None if floor is None else number_of(floor, "floor")
    return _engine.drop_cutter(
        Part.of(part).engine,
        Tool.of(tool)._engine,
        points(xy, 2, "xy"),
        _sheet(sheet),
        level,
        progress=progress,
        cancel=cancel,
    )


def push_cutter(
    part: PartLike,
    tool: ToolLike,
    xy: npt.ArrayLike,
    directions: npt.ArrayLike,
    z: float,
    *,
    sheet: Document | None = None,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> FloatArray:
    """Distances (N,), mm, travelled from ``xy`` (N, 2) in ``directions`` (N, 2), the tip at ``z``, until the tool touches.

    Exact for the triangles, on vertical walls too, where :func:`drop_cutter` jumps; the part's checked inward
    deviation is added. Infinite where the tool meets nothing, NaN where it does not stand free at the beginning.
    """
    return _engine.push_cutter(
        Part.of(part).engine,
        Tool.of(tool)._engine,
        points(xy, 2, "xy"),
        points(directions, 2, "directions"),
        number_of(z, "z"),
        _sheet(sheet),
        progress=progress,
        cancel=cancel,
    )


def waterline(
    part: PartLike,
    tool: ToolLike,
    z: float,
    sheet: Document | None = None,
    tolerance: float = 0.005,
    *,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> list[FloatArray]:
    """Loops (M, 3) of the tip at height ``z``, mm, each with its first point repeated at the end.

    They keep 0 to ``tolerance`` mm clear of the part, and have the higher ground on their right. A level that meets a
    floor stands as clear of it as of walls: its points lie up to the tolerance above ``z``.
    """
    (loops,) = waterlines(part, tool, [number_of(z, "z")], sheet, tolerance, progress=progress, cancel=cancel)
    return loops


def waterlines(
    part: PartLike,
    tool: ToolLike,
    heights: npt.ArrayLike,
    sheet: Document | None = None,
    tolerance: float = 0.005,
    *,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> list[list[FloatArray]]:
    """The loops of :func:`waterline` for each of the ``heights`` (N,), mm: much quicker than one call for each."""
    levels: list[float] = shaped(np.atleast_1d(numbers(heights, "heights")), (None,), "heights").tolist()
    within = number_of(tolerance, "tolerance")
    return _engine.waterlines(
        Part.of(part).engine, Tool.of(tool)._engine, levels, _sheet(sheet), within, progress=progress, cancel=cancel
    )
