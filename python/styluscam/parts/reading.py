"""A part file into arrays: by its ending to the reader of its format."""

from __future__ import annotations

import math
import os
import shlex
from pathlib import Path

from styluscam.errors import GeometryError
from styluscam.parts import cache
from styluscam.parts.arrays import PartArrays
from styluscam.parts.formats import BREP_ENDINGS, MESH_ENDINGS, UNITS
from styluscam.parts.mesh import read_mesh
from styluscam.parts.progress import Progress, report
from styluscam.parts.step import read_brep

LARGEST, SMALLEST = 1e6, 1e-3  # mm: a part beyond is a mistake of units


def read_part(
    path: str | os.PathLike[str],
    tolerance: float = 0.001,
    units: str | None = None,
    progress: Progress | None = None,
) -> PartArrays:
    """Read the part in a file into arrays, in mm.

    `tolerance` (mm) bounds the mesh's checked deviation from the exact surfaces, inward and outward each.
    `units` (one of UNITS) is required for STL, OBJ and PLY, which carry none; other formats refuse it.
    Raises GeometryError for every file that cannot be used, Cancelled when `progress` answers False.
    """
    file = Path(path)
    _check_arguments(file, tolerance, units)
    require_part(file)
    check_readable(file)
    ending = file.suffix.lower()
    if ending in BREP_ENDINGS:
        part = _read_brep(file, tolerance, units, progress)
    elif ending in MESH_ENDINGS:
        part = read_mesh(file, tolerance, units, progress)
    else:
        known = " ".join(BREP_ENDINGS + MESH_ENDINGS)
        raise GeometryError(
            f"{file}: ending {ending!r} is not a part format known here: use one of {known}",
            code="part-ending-unknown",
            where=str(file),
            hint=known,
        )
    _check_size(part)
    return part


def _check_arguments(file: Path, tolerance: float, units: str | None) -> None:
    """Refuse a tolerance out of range, unknown units, and a name that no program can hand on."""
    if not (math.isfinite(tolerance) and 1e-6 <= tolerance <= 10.0):
        raise GeometryError(
            f"tolerance {tolerance:g} mm is out of range: give 0.000001 to 10 mm",
            code="part-tolerance-range",
            where="part.tolerance",
            hint="0.001",
        )
    if units is not None and units not in UNITS:
        known = ", ".join(UNITS)
        raise GeometryError(
            f"units {units!r} are not known: use one of {known}",
            code="part-units-unknown",
            where="part.units",
            hint=known,
        )
    try:
        str(file).encode()
    except UnicodeEncodeError as error:
        shown = str(file).encode(errors="replace").decode()
        cure = "give it a name in UTF-8"
        raise GeometryError(
            f"{shown}: the file's name is not UTF-8: {cure}", code="part-name", where=shown, hint=cure
        ) from error


def _read_brep(file: Path, tolerance: float, units: str | None, progress: Progress | None) -> PartArrays:
    """Read a part with exact surfaces, or take it as it was read before."""
    if units is not None:
        raise GeometryError(
            f"{file}: a {file.suffix.lower()} file carries its units: remove units = {units!r}",
            code="part-units-not-wanted",
            where=str(file),
            hint="remove units",
        )
    name = cache.key(file, tolerance)
    part = cache.kept(name, str(file))
    if part is None:
        part = read_brep(file, tolerance, progress)
        cache.keep(name, part)
    else:
        report(progress, "arrays", 1.0)
    return part


def require_part(file: Path) -> None:
    """Refuse a job file given as a part: it belongs to another command.

    Raises GeometryError.
    """
    if file.suffix.lower() == ".toml":
        cure = f"styluscam run {shlex.quote(str(file))}"
        raise GeometryError(
            f"{file}: this is a job, not a part: {cure}", code="part-is-job", where=str(file), hint=cure
        )


def check_readable(file: Path) -> None:
    """Refuse what is not a readable, non-empty file."""
    where = str(file)
    if not file.exists():
        raise GeometryError(f"{where}: no such file: check the path", code="part-not-found", where=where)
    if not file.is_file():
        raise GeometryError(f"{where}: not a file: name the part file", code="part-not-a-file", where=where)
    try:
        with file.open("rb") as stream:
            first = stream.read(1)
    except OSError as error:
        raise GeometryError(
            f"{where}: cannot be read ({error.strerror}): check its permissions", code="part-unreadable", where=where
        ) from error
    if not first:
        raise GeometryError(f"{where}: the file is empty: export the part again", code="part-empty", where=where)


def _check_size(part: PartArrays) -> None:
    """Refuse a part whose size can only be a mistake."""
    low, high = part.box
    size = max(b - a for a, b in zip(low, high, strict=True))
    reach = max(abs(c) for c in (*low, *high))
    if reach > LARGEST or size < SMALLEST:
        what = f"reaches {reach:.3g} mm from the origin" if reach > LARGEST else f"is only {size:.3g} mm across"
        raise GeometryError(
            f"{part.source}: the part {what}: check its units (read as {part.units})",
            code="part-too-large" if reach > LARGEST else "part-too-small",
            where=part.source,
            hint="check the units",
        )
