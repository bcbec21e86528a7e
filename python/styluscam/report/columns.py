"""Columns of numbers as text for a page: whole numbers by differences, byte planes, gzip, base64.

``decoded`` in ``page/data.js`` reverses it.
"""

from __future__ import annotations

import base64
import gzip

import numpy as np
import numpy.typing as npt

from styluscam.types import Document

DECIMALS = 7
"""Digits behind the point that are looked for: controllers know no more than six."""


def packed(values: npt.ArrayLike, step: float | None = None) -> Document:
    """An array (N,) or (N, C) as data, exactly; with a ``step``, rounded to its multiples.

    Decimal numbers and whole numbers become small; anything else is kept bit by bit.
    """
    array = np.asarray(values, dtype=np.float64)
    columns = (array[:, None] if array.ndim == 1 else array).T
    scale = _scale(columns) if step is None else 1.0 / step
    whole = None if scale is None else np.rint(columns * scale)
    shape: Document = {"count": len(array), "columns": len(columns)}
    if whole is None or not _differences_fit(whole):
        return {**shape, "scale": 0, "data": _text(np.ascontiguousarray(columns).view(np.uint8).reshape(-1, 8))}
    difference = np.diff(whole, axis=1, prepend=0.0).astype(np.int64)
    zigzag = np.ascontiguousarray(np.where(difference < 0, -2 * difference - 1, 2 * difference), dtype="<u4")
    return {**shape, "scale": scale, "data": _text(zigzag.view(np.uint8).reshape(-1, 4))}


def _scale(columns: npt.NDArray[np.float64]) -> float | None:
    """The power of ten that makes all numbers whole, and gives the very same ones back."""
    if not np.isfinite(columns).all():
        return None
    for decimals in range(DECIMALS + 1):
        scale = 10.0**decimals
        if np.array_equal(np.rint(columns * scale) / scale, columns):
            return scale
    return None


def _differences_fit(whole: npt.NDArray[np.float64]) -> bool:
    """Whether neighbours differ by less than 32 bits hold with a sign, and all are exact."""
    if not np.isfinite(whole).all() or np.abs(whole).max(initial=0.0) >= 2.0**53:
        return False
    return bool(np.abs(np.diff(whole, axis=1, prepend=0.0)).max(initial=0.0) < 2.0**31 - 1.0)


def _text(bytes_of: npt.NDArray[np.uint8]) -> str:
    """Byte planes (N, K) one after the other, compressed, as base64."""
    planes = np.ascontiguousarray(bytes_of.T).tobytes()
    return base64.b64encode(gzip.compress(planes, compresslevel=6, mtime=0)).decode("ascii")
