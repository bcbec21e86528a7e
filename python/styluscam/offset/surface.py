"""The slope-matched offset of a part's surface as a mesh: where the tool stands, and what keeps it from there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import number_of, refused
from styluscam.errors import GeometryError
from styluscam.files import drawn_whole
from styluscam.offset.positions import _sheet
from styluscam.parts.meshfile import write_triangles
from styluscam.parts.part import Part, PartLike
from styluscam.tools.tool import Tool, ToolLike
from styluscam.types import Document, FloatArray, IntArray, Progress

FLAGS = ("contact", "bridged", "interferes", "rim", "undercut")
"""Names of the flags of an :class:`OffsetSurface`, by number."""

COLOURS = ((120, 180, 110), (242, 178, 51), (214, 69, 65), (90, 130, 200), (150, 150, 150))
"""Red, green and blue (0 to 255) of each flag, in pictures and PLY files."""


@dataclass(frozen=True)
class OffsetRegion:
    """All of a face that has one flag."""

    face: int
    flag: str
    """One of :data:`FLAGS`."""
    area: float
    """mm^2; each triangle's is shared equally among its corners' flags."""
    depth: float
    """How deep the tool would enter what stops it, mm, at the worst."""
    contact: tuple[float, float, float]
    """The point of the part for which it would."""
    place: tuple[float, float, float]
    """The point of the part that it would enter."""


@dataclass(frozen=True, eq=False, repr=False)
class OffsetSurface:
    """Slope-matched positions of the tool over a part's triangles, each checked against the whole part. Lengths mm.

    A flag (a number of :data:`FLAGS`) states what becomes of a position. *contact*: the tool enters nothing there deeper
    than the tolerance. *bridged*: something of the same smooth patch of the part stops it first, because the part is
    more curved than the tool; a patch is what hangs together within faces and over edges without a crease (2 deg between
    the model's normals, 20 deg between facets where those are not known). *interferes*: something beyond a crease stops
    it: a wall, a step, an island. *rim*: steeper than the profile, touched by the base's edge. *undercut*: faces down.
    """

    points: FloatArray
    """The tool's tips (CL), (V, 3)."""
    triangles: IntArray
    """Triangles of the points, (T, 3), wound as the part's."""
    contacts: FloatArray
    """The points of the part (CC), (V, 3)."""
    normals: FloatArray
    """Unit normals of the part there, (V, 3)."""
    slopes: FloatArray
    """Angles between the normals and +Z, (V,), rad."""
    flags: npt.NDArray[np.uint8]
    """What becomes of each position, (V,)."""
    depths: FloatArray
    """How deep the tool, with the sheet, standing there would enter what stops it, (V,); 0 where nothing does."""
    places: FloatArray
    """The points of the part that stop it, (V, 3); where nothing does, the contacts."""
    place_faces: IntArray
    """Their faces, (V,)."""
    faces: IntArray
    """Face of each triangle, (T,)."""
    fine: float
    """No side of a triangle where something stops the tool is longer, mm: a quarter of the tool's radius, or as fine as two
    million points allow."""
    _regions: tuple[OffsetRegion, ...] = field(repr=False)

    def __repr__(self) -> str:
        """How many points and triangles, and the area of each flag."""
        areas = {flag: sum(one.area for one in self._regions if one.flag == flag) for flag in FLAGS}
        shown = ", ".join(f"{flag} {area:.1f} mm2" for flag, area in areas.items() if area > 0.0)
        return f"<OffsetSurface: {len(self.points)} points, {len(self.triangles)} triangles; {shown}>"

    def __eq__(self, other: object) -> bool:
        """Whether all positions, and what becomes of them, are the same."""
        if not isinstance(other, OffsetSurface):
            return NotImplemented
        return all(np.array_equal(mine, vars(other)[name]) for name, mine in vars(self).items())

    __hash__ = None  # type: ignore[assignment]  # arrays can be written to

    def regions(self) -> list[OffsetRegion]:
        """What there is of each flag on each face, in the order of faces and flags."""
        return list(self._regions)

    def save(self, path: str | Path) -> None:
        """Writes all arrays (``.npz``), or the mesh of the tips coloured by flag (``.ply``; extra ``mesh``).

        Raises:
            StylusError: another ending, or a path that cannot be written to.
        """
        file = Path(path)
        if file.suffix.lower() not in (".npz", ".ply"):
            message = f"{file}: an offset surface is written as .npz or .ply"
            raise GeometryError(message, code="ending-unknown", where=str(file), hint=".npz or .ply")
        if file.suffix.lower() == ".ply":
            write_triangles(file, self.points, self.triangles, np.array(COLOURS, dtype=np.uint8)[self.flags])
            return
        columns = {name: value for name, value in vars(self).items() if name != "_regions"}
        with drawn_whole(file) as temporary, temporary.open("wb") as stream:  # numpy would append an ending to a name
            np.savez_compressed(stream, **columns)


def offset_surface(
    part: PartLike,
    tool: ToolLike,
    sheet: Document | None = None,
    *,
    tolerance: float = 0.005,
    faces: Sequence[int | str] | None = None,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> OffsetSurface:
    """The slope-matched offset of a part's ``faces`` (numbers or names as "Face3"; all if None).

    Positions are exact for the part's normals: those of the surfaces of a STEP, IGES or BREP file, those given to
    :meth:`Part.from_mesh`, else the facets'. They are checked against the triangles: a position is free if the tool,
    lifted off along the normal by ``tolerance`` (mm), enters nothing. So it has to exceed the triangles' checked
    deviation, and it covers what facets are off. With a flat at the tip, or where the profile is straight, many positions
    touch a point; the surface holds the one with the axis over it, or with the contact at the straight part's outer end.

    Raises:
        GeometryError: a face that does not exist, a tolerance below the part's deviation.

    Source: US 2023/0035585.
    """
    numbers = None if faces is None else _numbers(faces)
    within, cutter = number_of(tolerance, "tolerance"), Tool.of(tool)
    if not within <= cutter.diameter:
        message = f"tolerance = {within:g}: at most the tool's diameter, {cutter.diameter:g} mm"
        raise GeometryError(message, code="out-of-range", where="tolerance", hint="0.005 mm is usual")
    columns, (triangles, of_triangles, fine), regions = _engine.offset_surface(
        Part.of(part).engine, cutter._engine, _sheet(sheet), within, numbers, progress=progress, cancel=cancel
    )
    points, contacts, normals, slopes, flags, depths, places, place_faces = columns
    return OffsetSurface(
        points=points,
        triangles=triangles,
        contacts=contacts,
        normals=normals,
        slopes=slopes,
        flags=flags,
        depths=depths,
        places=places,
        place_faces=place_faces,
        faces=of_triangles,
        fine=fine,
        _regions=tuple(
            OffsetRegion(face, flag, area, depth, (x, y, z), (px, py, pz))
            for face, flag, area, depth, (x, y, z), (px, py, pz) in regions
        ),
    )


def _numbers(faces: Sequence[int | str]) -> list[int]:
    """The numbers of faces; one name alone is a face too."""
    if isinstance(faces, bytes) or not isinstance(faces, Iterable):
        raise refused("faces", faces, "a list of face names or numbers", GeometryError)
    return [_number(face) for face in ([faces] if isinstance(faces, str) else faces)]


def _number(face: int | str) -> int:
    """The number of a face given by number or name."""
    digits = str(face).removeprefix("Face")
    if not digits.isdecimal() or int(digits) >= 2**32:
        raise GeometryError(f"the part has no face {face!r}", code="no-such-face", where="faces")
    return int(digits)
