"""Tools: convex profiles, asked by slope."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.errors import ToolError
from styluscam.types import Document, FloatArray


class Tool:
    """A checked tool; build it with :meth:`from_dict` or :meth:`read`."""

    def __init__(self, engine: _engine.Tool) -> None:
        self._engine = engine

    @classmethod
    def from_dict(cls, document: Document) -> Tool:
        """From ``{"profile": {"kind": "clothoid", "diameter": 20.0}, "shank_diameter": .., "length": ..}``.

        Raises:
            ToolError: a key is unknown, missing or out of range.
        """
        return cls(_engine.Tool(json.dumps(document)))

    @classmethod
    def read(cls, path: str | Path) -> Tool:
        """From a JSON file with the document that :meth:`from_dict` takes."""
        try:
            document = json.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise ToolError(f"{path}: not a tool file: {error}", code="unreadable", where=str(path)) from error
        return cls.from_dict(document)

    def to_dict(self) -> Document:
        """The document that builds this tool."""
        document: Document = json.loads(self._engine.to_json())
        return document

    @property
    def description(self) -> str:
        """What it is, in words: ``clothoid D10``."""
        return self._engine.description

    @property
    def diameter(self) -> float:
        """Diameter of the base, mm."""
        return self._engine.diameter

    @property
    def max_slope(self) -> float:
        """Slope at which the profile ends, rad."""
        return self._engine.max_slope

    def radius_at(self, slope: npt.ArrayLike) -> FloatArray:
        """Radius (mm) by slope (rad): array in, array out; the outer end where the profile is straight."""
        return _by_entry(self._engine.radius_at, slope)

    def radius_range_at(self, slope: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Inner and outer radius (mm) by slope (rad): they differ where the profile is straight."""
        array = np.asarray(slope, dtype=np.float64)
        inner, outer = self._engine.radius_range_at(np.ascontiguousarray(array.ravel()))
        return inner.reshape(array.shape), outer.reshape(array.shape)

    def height_at(self, slope: npt.ArrayLike) -> FloatArray:
        """Height over the tip (mm) by slope (rad)."""
        return _by_entry(self._engine.height_at, slope)

    def curvature_radius_at(self, slope: npt.ArrayLike) -> FloatArray:
        """Radius of curvature of the meridian (mm) by slope (rad)."""
        return _by_entry(self._engine.curvature_radius_at, slope)

    def height_at_radius(self, radius: npt.ArrayLike) -> FloatArray:
        """Height over the tip (mm) by radius (mm); infinite beyond the base."""
        return _by_entry(self._engine.height_at_radius, radius)


def _by_entry(function: Callable[[FloatArray], FloatArray], values: npt.ArrayLike) -> FloatArray:
    array = np.asarray(values, dtype=np.float64)
    return function(np.ascontiguousarray(array.ravel())).reshape(array.shape)
