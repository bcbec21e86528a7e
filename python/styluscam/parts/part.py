"""Parts: what readers and callers hand to the engine."""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import starmap
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import FileName, file_of, number_of, refused
from styluscam.errors import GeometryError
from styluscam.parts.arrays import PartArrays
from styluscam.parts.changed import changed
from styluscam.parts.reading import read_part
from styluscam.parts.ruled import ruled_faces
from styluscam.types import Document, FloatArray, Progress, numbers, points, shaped, whole_numbers
from styluscam.words import counted, shortened, size

PartLike: TypeAlias = "Part | str | os.PathLike[str]"
"""A part, or the file that it is in."""

WANTED = "a Part or the name of a part file"


class Part:
    """A part as triangles, with the exact surfaces behind them where a reader knew those: ``Part("cup.step")``."""

    engine: _engine.Part
    arrays: PartArrays | None

    def __init__(self, source: PartLike | _engine.Part, tolerance: float = 0.001, units: str | None = None) -> None:
        """A part, or as :meth:`read`."""
        known = (
            Part._built(source) if isinstance(source, _engine.Part) else source if isinstance(source, Part) else None
        )
        vars(self).update(vars(known or Part.read(file_of(source, "part", WANTED, GeometryError), tolerance, units)))

    @classmethod
    def _built(cls, engine: _engine.Part, arrays: PartArrays | None = None) -> Part:
        part = cls.__new__(cls)
        part.engine, part.arrays = engine, arrays
        return part

    def __repr__(self) -> str:
        """Where it comes from, faces, triangles and size."""
        name, faces = "", ""
        if self.arrays is not None:
            name = f" {shortened(Path(self.arrays.source).name)}"
            faces = f"{counted(len(self.arrays.faces), 'face')}, "
        return f"<Part{name}: {faces}{counted(self.triangle_count, 'triangle')}, {size(*self.engine.bounds)}>"

    def __eq__(self, other: object) -> bool:
        """Whether the triangles, their faces and normals and what is known of their deviation are the same."""
        if not isinstance(other, Part):
            return NotImplemented
        if self.engine is other.engine:
            return True
        mine, theirs = self.engine, other.engine
        if (mine.deviation, mine.bounds, mine.triangle_count) != (
            theirs.deviation,
            theirs.bounds,
            theirs.triangle_count,
        ):
            return False
        return all(starmap(np.array_equal, zip(mine.arrays(), theirs.arrays(), strict=True)))

    def __hash__(self) -> int:
        """As equality compares, by size and count of the triangles."""
        low, high = self.engine.bounds
        return hash((self.triangle_count, *low, *high))

    def __getstate__(self) -> Document:
        """For pickle and copy: the triangles, and what a reader knew of them."""
        return {"arrays": self.arrays, "mesh": self.engine.arrays(), "deviation": self.engine.deviation}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        vertices, triangles, faces, normals = state["mesh"]
        inward, outward = state["deviation"]
        self.arrays = state["arrays"]
        curves = ((), {}) if self.arrays is None else _curves(self.arrays)
        self.engine = _engine.Part(vertices, triangles, faces, inward, outward, normals, *curves)

    @classmethod
    def of(cls, source: PartLike, argument: str = "part") -> Part:
        """From what a call takes for a part: one, or a part file whose format states its units.

        Raises:
            GeometryError: it is neither, or cannot be read.
        """
        if isinstance(source, Part):
            return source
        return cls.read(file_of(source, argument, WANTED, GeometryError))

    @classmethod
    def from_mesh(
        cls,
        vertices: npt.ArrayLike,
        triangles: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        face_ids: npt.ArrayLike | None = None,
    ) -> Part:
        """From arrays: (V, 3) mm, (T, 3) indices wound outward, corner normals (T, 3, 3), face id per triangle (T,).

        The triangles are taken for the part itself; those that meet share vertices. Normals are the model's, of any
        length, by which :func:`styluscam.offset_surface` places the tool; without them it takes the facets'.

        Raises:
            GeometryError: numbers that are not finite or absurd, indices out of range, lengths that do not match,
                nothing left.
        """
        corners = whole_numbers(triangles, "triangles")
        corners = shaped(corners.reshape(-1, 3) if corners.size == 0 else corners, (None, 3), "triangles")
        known = None if normals is None else shaped(numbers(normals, "normals"), (len(corners), 3, 3), "normals")
        ids = None if face_ids is None else shaped(whole_numbers(face_ids, "face_ids"), (None,), "face_ids")
        return cls._built(_engine.Part(points(vertices, 3, "vertices"), corners, ids, normals=known))

    @classmethod
    def from_arrays(cls, arrays: PartArrays) -> Part:
        """From what a reader made: triangles with their checked deviation and, where it knew surfaces, their normals."""
        if not isinstance(arrays, PartArrays):
            raise refused("arrays", arrays, "what a reader made (PartArrays)", GeometryError)
        engine = _engine.Part(
            arrays.vertices,
            arrays.triangles,
            arrays.face_ids,
            arrays.deviation_inward,
            arrays.deviation_outward,
            None if arrays.is_mesh else arrays.normals,
            *_curves(arrays),
        )
        return cls._built(engine, arrays)

    @classmethod
    def read(
        cls, path: FileName, tolerance: float = 0.001, units: str | None = None, progress: Progress | None = None
    ) -> Part:
        """From a file: STEP, BREP, IGES, STL, OBJ, PLY, 3MF by its ending.

        ``tolerance`` (mm) bounds the triangles' deviation from the surfaces, checked by sampling; ``units``
        ("mm", "cm", "m", "in", "ft", "um") is required where the format has none.

        Raises:
            GeometryError: the file cannot be read or holds no usable part.
        """
        file = file_of(path, "path", "the name of a part file", GeometryError)
        if units is not None and not isinstance(units, str):
            raise refused("units", units, 'a unit like "mm"', GeometryError)
        return cls.from_arrays(read_part(file, number_of(tolerance, "tolerance"), units, progress))

    def shaped(self, job: _engine.Job, deviations: Sequence[tuple[FloatArray, FloatArray]]) -> Part:
        """The part as a job forms it; ``deviations`` are the points (N, 3) and displacements (N, 3), mm, that it names.

        Raises:
            JobError: they do not fit the part, or the shape cannot be formed.
        """
        engine = _engine.shaped(job, self.engine, deviations)
        return Part._built(engine, None if self.arrays is None else changed(self.arrays, engine))

    @property
    def bounds(self) -> FloatArray:
        """Lower and upper corner of the box, (2, 3), mm."""
        return np.array(self.engine.bounds)

    @property
    def triangle_count(self) -> int:
        """Triangles of positive area."""
        return self.engine.triangle_count


RailColumns: TypeAlias = "tuple[int, list[float], FloatArray, FloatArray]"


def _curves(arrays: PartArrays) -> tuple[list[RailColumns | None], dict[int, tuple[RailColumns, RailColumns]]]:
    """The edges' curves and the rails of the ruled faces, as the engine takes them."""
    edges = [None if edge is None else edge.columns for edge in arrays.edges]
    return edges, {face: (first.columns, second.columns) for face, (first, second) in ruled_faces(arrays).items()}
