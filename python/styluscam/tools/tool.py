"""Tools: convex profiles, asked by slope."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam._engine import Tool as EngineTool
from styluscam.arguments import A_FILE, FileName, document_of, file_of, word_of
from styluscam.errors import ToolError
from styluscam.files import is_file, write_whole
from styluscam.records import Record
from styluscam.tools import fctb, library, pointsfile, toolfile
from styluscam.types import Document, FloatArray, numbers

ToolLike: TypeAlias = "Tool | Document | str | os.PathLike[str]"
"""A tool, its document, the name of a shipped one, or a tool file."""

WANTED = "a Tool, a dict with its profile, the name of a shipped tool or of a tool file"

LONG = re.compile(r"\d+\.\d{2,}")
"""A number with many digits."""


@dataclass(frozen=True)
class OutlinePart:
    """A part of a tool's profile: straight, or a curve without kinks."""

    straight: bool
    slopes: tuple[float, float]
    """First and last slope, rad: the same one where it is straight."""
    inner: tuple[float, float]
    """Radius and height of its end nearer to the tip, mm."""
    outer: tuple[float, float]
    """Radius and height of its other end, mm."""


@dataclass(frozen=True, slots=True, eq=False)
class ToolReport(Record):
    """What building a tool reports.

    Attributes:
        notes: what a reader guessed and what was done to the curve, in sentences.
        fit_deviation_mm: largest distance of a given point from the profile; None but for points.
    """

    notes: list[str]
    fit_deviation_mm: float | None


class Tool:
    """A checked tool: ``Tool("clothoid:small")``, ``Tool("mine.json")``, ``Tool({"profile": ...})``.

    Attributes:
        name: by which a library or a person calls it; may be empty.
        title: what it is, in a line; may be empty.
        remarks: what a reader of its file had to guess, in sentences.
        files: that it was read from.
    """

    _engine: EngineTool
    name: str
    title: str
    remarks: tuple[str, ...]
    files: tuple[Path, ...]

    def __init__(self, source: ToolLike) -> None:
        """As :meth:`of`."""
        vars(self).update(vars(Tool.of(source)))

    @classmethod
    def _built(cls, engine: EngineTool, name: str, title: str, remarks: Sequence[str], files: Sequence[Path]) -> Tool:
        tool = cls.__new__(cls)
        tool._engine, tool.name, tool.title = engine, name, title
        tool.remarks, tool.files = tuple(remarks), tuple(files)
        return tool

    def __repr__(self) -> str:
        """Its name and what it is."""
        name = f" {self.name!r}" if self.name else ""
        return f"<Tool{name}: {self.description}>"

    def __eq__(self, other: object) -> bool:
        """Whether it is the same body; names and titles do not count."""
        return self._engine.to_json() == other._engine.to_json() if isinstance(other, Tool) else NotImplemented

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self._engine.to_json())

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        return {**vars(self), "_engine": self._engine.to_json()}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        vars(self).update(state, _engine=EngineTool(state["_engine"]))

    @classmethod
    def of(cls, source: ToolLike, argument: str = "tool") -> Tool:
        """From what a call takes for a tool: one, its document, the name of a shipped tool, or a tool file.

        ``library.json:name`` is a tool of a library in a file. Errors call it ``argument``.

        Raises:
            ToolError: it is none of these, there is no such tool or file, or one that cannot be built.
        """
        if isinstance(source, Tool):
            return source
        if isinstance(source, Mapping):
            return cls.from_dict(document_of(source, argument, WANTED, ToolError))
        path = file_of(source, argument, WANTED, ToolError)
        return cls.find(source) if isinstance(source, str) else cls.read(path)

    @classmethod
    def from_dict(cls, document: Document, folder: str | Path = ".") -> Tool:
        """From ``{"profile": {"kind": "clothoid", "diameter": 20.0}, "shank_diameter": .., "length": ..}``.

        ``schema``, ``name`` and ``title``, as tool files have them, may stand beside the profile. The file that a points
        profile may name instead of its list is looked for in ``folder``.

        Raises:
            ToolError: a key is unknown, missing or out of range.
        """
        document = document_of(document, "document", "a dict with a tool's profile", ToolError)
        name = document.get("name")
        return cls._named(document, name if isinstance(name, str) and name else "tool", folder=folder)

    @classmethod
    def read(cls, path: FileName) -> Tool:
        """From a tool file: JSON with the document that :meth:`from_dict` takes, or FreeCAD's ``.fctb``.

        A library that holds one tool is a tool file too.

        Raises:
            ToolError: the file cannot be read, or holds no tool that can be built.
        """
        path, remarks = file_of(path, "path", A_FILE, ToolError), list[str]()
        if path.suffix.lower() == ".fctb":
            document, remarks = fctb.read(path)
        else:
            document = toolfile.read_json(path, "a tool file")
        if "tools" in document and "profile" not in document:
            return cls.of_library(library.read_library(path))
        found = cls._named(document, str(path), remarks, path.parent)
        found.files = (path, *found.files)
        return found

    @classmethod
    def find(cls, name: str, folder: str | Path = ".") -> Tool:
        """By the value of a job's key ``library``: the name of a shipped tool, a tool file, or ``library.json:name``.

        Raises:
            ToolError: no such file or tool, or one that cannot be built.
        """
        name = word_of(name, "name", "the name of a shipped tool or of a tool file", ToolError)
        file, tool = toolfile.file_and_name(name)
        if not file and name not in library.names() and is_file(Path(folder) / name):
            file = name
        if not file:
            return cls.library(name)
        path = Path(folder) / file
        if not tool:
            return cls.read(path)
        return cls.of_library(library.read_library(path), tool)

    @classmethod
    def of_library(cls, shelf: library.Library, name: str = "") -> Tool:
        """A tool of a library that was read from a file; its name may be left out where it is the only one.

        Raises:
            ToolError: no such tool, or one that cannot be built.
        """
        if not name and len(shelf.tools) > 1:
            choice = [f"{shelf.file}:{each}" for each in list(shelf.tools)[:3]]
            hint = f"name one of them: {' or '.join(choice)}{' or ...' if len(shelf.tools) > 3 else ''}"
            message = f"{shelf.file}: a library of {len(shelf.tools)} tools, not one tool"
            raise ToolError(message, code="library", where=shelf.file, hint=hint)
        document = shelf.find(name or next(iter(shelf.tools)))
        found = cls._named(document, f"{shelf.file}: {document['name']}")
        found.files = (Path(shelf.file), *found.files)
        return found

    @classmethod
    def library(cls, name: str, size: str | None = None) -> Tool:
        """A tool of the shipped libraries; ``clothoid`` in size ``medium`` is ``clothoid:medium`` too.

        Raises:
            ToolError: no such tool or size.
        """
        name = word_of(name, "name", "the name of a shipped tool", ToolError)
        if size is not None:
            size = word_of(size, "size", "one of its sizes", ToolError)
        return cls._named(library.find(name, size), name)

    @classmethod
    def _named(cls, document: Document, where: str, remarks: Sequence[str] = (), folder: str | Path = ".") -> Tool:
        toolfile.check_schema(document, where)
        document, files = pointsfile.resolved(document, folder)
        text = toolfile.engine_text(document, where)
        try:
            engine = EngineTool(text)
        except ToolError as error:
            toolfile.check_tool(document, where)
            if where == "tool" or where in str(error):
                raise
            raise ToolError(f"{where}: {error}", code=error.code, where=where, hint=error.hint) from error
        toolfile.check_text(document, ("name", "title"), where)
        return cls._built(engine, document.get("name", ""), document.get("title", ""), remarks, files)

    def write(self, path: FileName) -> None:
        """Writes a tool file, whole or not at all: ``.fctb`` for FreeCAD, else JSON. Numbers are kept exactly.

        Raises:
            StylusError: the file cannot be written.
        """
        path = file_of(path, "path", A_FILE, ToolError)
        document = self.to_file()
        if path.suffix.lower() == ".fctb":
            height = float(self.height_at(self.max_slope))
            text = fctb.text_of(document, self.title or self.name or self.description, self.diameter, height)
        else:
            text = toolfile.text_of(document)
        write_whole(path, text)

    def to_dict(self) -> Document:
        """The document that builds this tool."""
        document: Document = json.loads(self._engine.to_json())
        return document

    def to_file(self) -> Document:
        """As :meth:`to_dict`, with schema, name and title: what a tool file holds."""
        names = {"name": self.name, "title": self.title}
        return {"schema": toolfile.SCHEMA} | {k: v for k, v in names.items() if v} | self.to_dict()

    def report(self) -> ToolReport:
        """What building it reports."""
        report: Document = json.loads(self._engine.report())
        return ToolReport(**{**report, "notes": [*self.remarks, *report["notes"]]})

    @property
    def description(self) -> str:
        """What it is, in words: ``clothoid D10``; numbers with five digits at most."""
        return LONG.sub(lambda found: f"{float(found[0]):.5g}", self._engine.description)

    @property
    def diameter(self) -> float:
        """Diameter of the base, mm."""
        return self._engine.diameter

    @property
    def max_slope(self) -> float:
        """Slope at which the profile ends, rad."""
        return self._engine.max_slope

    def outline(self) -> tuple[OutlinePart, ...]:
        """The parts of the profile from the tip to the base, each from where the one before it ends."""
        parts = self._engine.outline()
        return tuple(OutlinePart(straight, (first, last), *ends) for straight, (first, last), ends in parts)

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
    array = numbers(values, "values")
    found = function(np.ascontiguousarray(array.ravel())).reshape(np.shape(values))
    return np.asarray(np.where(np.isnan(array.reshape(found.shape)), np.nan, found))
