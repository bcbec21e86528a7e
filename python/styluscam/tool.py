"""Tools: convex profiles, asked by slope."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine, fctb, library, toolfile
from styluscam.errors import ToolError
from styluscam.files import write_whole
from styluscam.types import Document, FloatArray


class Tool:
    """A checked tool; build it with :meth:`from_dict`, :meth:`read` or :meth:`library`.

    Attributes:
        name: by which a library or a person calls it; may be empty.
        title: what it is, in a line; may be empty.
        remarks: what a reader of its file had to guess, in sentences.
    """

    def __init__(self, engine: _engine.Tool, name: str = "", title: str = "", remarks: Sequence[str] = ()) -> None:
        self._engine = engine
        self.name = name
        self.title = title
        self.remarks = tuple(remarks)

    @classmethod
    def from_dict(cls, document: Document) -> Tool:
        """From ``{"profile": {"kind": "clothoid", "diameter": 20.0}, "shank_diameter": .., "length": ..}``.

        ``schema``, ``name`` and ``title``, as tool files have them, may stand beside the profile.

        Raises:
            ToolError: a key is unknown, missing or out of range.
        """
        return cls._named(document, "tool")

    @classmethod
    def read(cls, path: str | Path) -> Tool:
        """From a tool file: JSON with the document that :meth:`from_dict` takes, or FreeCAD's ``.fctb``.

        Raises:
            ToolError: the file cannot be read, or holds no tool that can be built.
        """
        if Path(path).suffix.lower() == ".fctb":
            document, remarks = fctb.read(path)
            return cls._named(document, str(path), remarks)
        return cls._named(toolfile.read_json(path, "a tool file"), str(path))

    @classmethod
    def library(cls, name: str, size: str | None = None) -> Tool:
        """A tool of the shipped libraries; ``clothoid`` in size ``medium`` is ``clothoid:medium`` too.

        Raises:
            ToolError: no such tool or size.
        """
        return cls._named(library.find(name, size), name)

    @classmethod
    def _named(cls, document: Document, where: str, remarks: Sequence[str] = ()) -> Tool:
        toolfile.check_schema(document, where)
        try:
            engine = _engine.Tool(json.dumps(toolfile.bare(document)))
        except ToolError as error:
            toolfile.check_tool(document, where)
            if where == "tool" or where in str(error):
                raise
            raise ToolError(f"{where}: {error}", code=error.code, where=where, hint=error.hint) from error
        toolfile.check_text(document, ("name", "title"), where)
        return cls(engine, document.get("name", ""), document.get("title", ""), remarks)

    def write(self, path: str | Path) -> None:
        """Writes a tool file, whole or not at all: ``.fctb`` for FreeCAD, else JSON. Numbers are kept exactly.

        Raises:
            StylusError: the file cannot be written.
        """
        path = Path(path)
        text = fctb.text_of(self) if path.suffix.lower() == ".fctb" else toolfile.text_of(self.to_file())
        write_whole(path, text)

    def to_dict(self) -> Document:
        """The document that builds this tool."""
        document: Document = json.loads(self._engine.to_json())
        return document

    def to_file(self) -> Document:
        """As :meth:`to_dict`, with schema, name and title: what a tool file holds."""
        names = {"name": self.name, "title": self.title}
        return {"schema": toolfile.SCHEMA} | {k: v for k, v in names.items() if v} | self.to_dict()

    def report(self) -> Document:
        """What building it has to say: ``notes`` (sentences) and ``fit_deviation_mm`` (of points, else None)."""
        report: Document = json.loads(self._engine.report())
        return {**report, "notes": [*self.remarks, *report["notes"]]}

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
