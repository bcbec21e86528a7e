"""Names for the arrays and callbacks that cross the package, and the check of what comes in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from styluscam.errors import GeometryError

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
Progress: TypeAlias = Callable[[str, float], "bool | None"]
"""Called with a phase and its fraction, at most 20 times a second; ``False`` cancels."""
Document: TypeAlias = dict[str, Any]


def points(values: npt.ArrayLike, columns: int, name: str = "points") -> FloatArray:
    """Rows of ``columns`` numbers as a contiguous float64 array; a single row becomes (1, columns).

    Raises:
        GeometryError: something else; ``name`` is what it calls them.
    """
    array = numbers(values, name)
    if array.ndim == 1 and array.size in (0, columns):
        array = array.reshape(-1, columns)
    return shaped(array, (None, columns), name)


def whole_numbers(values: npt.ArrayLike, name: str) -> IntArray:
    """As a contiguous int64 array of any shape.

    Raises:
        GeometryError: something else than whole numbers.
    """
    array = values if isinstance(values, np.ndarray) and values.dtype.kind in "iu" else numbers(values, name)
    # an integer array is only looked at where it may hold too much
    is_whole = array.dtype.kind == "i" or bool(((array == np.round(array)) & (np.abs(array) < 2**62)).all())
    if not is_whole:
        raise GeometryError(f"{name}: whole numbers expected", code="not-whole", where=name, hint="give integers")
    return np.ascontiguousarray(array, dtype=np.int64)


def numbers(values: npt.ArrayLike, name: str) -> FloatArray:
    """As a contiguous float64 array of any shape.

    Raises:
        GeometryError: something else than real numbers, or rows of several lengths.
    """
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO":
            raise TypeError(f"of {array.dtype.name}")
        return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise GeometryError(
            f"{name}: an array of numbers expected ({error})",
            code="not-numbers",
            where=name,
            hint="give rows of numbers",
        ) from error


Number = TypeVar("Number", bound=np.generic)


def shaped(array: npt.NDArray[Number], shape: tuple[int | None, ...], name: str) -> npt.NDArray[Number]:
    """The array, if it has the ``shape``, of which None is any length.

    Raises:
        GeometryError: another shape.
    """
    fits = array.ndim == len(shape) and all(want in (None, have) for want, have in zip(shape, array.shape, strict=True))
    if not fits:
        wanted = ", ".join("N" if want is None else str(want) for want in shape)
        raise GeometryError(
            f"{name} has shape {array.shape}: ({wanted}{',' if len(shape) == 1 else ''}) expected",
            code="shape",
            where=name,
            hint="give one row for each",
        )
    return array
