"""Names for the arrays and callbacks that cross the package."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
Progress: TypeAlias = Callable[[str, float], "bool | None"]
"""Called with a phase and its fraction, at most 20 times a second; ``False`` cancels."""
Document: TypeAlias = dict[str, Any]


def points(values: npt.ArrayLike, columns: int) -> FloatArray:
    """Rows of ``columns`` numbers as a contiguous float64 array; a single row becomes (1, columns)."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    return array.reshape(1, -1) if array.ndim == 1 and array.size == columns else array
