"""What formed parts deviate by, from files: tables of points, or the target and the part as measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from styluscam.errors import GeometryError
from styluscam.parts.arrays import Ints
from styluscam.parts.formats import MESH_ENDINGS, UNITS
from styluscam.parts.mesh import triangles_as_written
from styluscam.parts.reading import check_readable
from styluscam.parts.surfaces import Floats
from styluscam.tables import Layout, read_table
from styluscam.types import Document

LAYOUT = Layout(
    columns={"x": 0, "y": 1, "z": 2, "dx": 3, "dy": 4, "dz": 5, "ux": 3, "uy": 4, "uz": 5},
    content="x, y, z, dx, dy, dz",
    example="write a point and its deviation, as in 12.5, 3.0, -8.0, 0.02, 0.01, 0.31",
    cure="six columns: a point of the target, and measured minus target there",
    largest=200_000_000,  # a million points take half of it
    too_large="not the deviation of a part; a point each millimetre is enough",
    failure=GeometryError,
)


def files(section: Document) -> list[str]:
    """The files that a ``[part.springback]`` names."""
    return [name for one in section["deviations"] for name in ([one] if isinstance(one, str) else one.values())]


def read_deviations(section: Document, folder: Path) -> list[tuple[Floats, Floats]]:
    """Points (N, 3) of the target and their deviations (N, 3), mm, for each entry of ``[part.springback]``.

    Raises:
        GeometryError: a file cannot be read, states no units and the section neither, or two meshes do not correspond.
    """
    units = section.get("units")
    return [
        _table(folder / one, units) if isinstance(one, str) else _meshes(folder, one, units)
        for one in section["deviations"]
    ]


def _table(file: Path, units: str | None) -> tuple[Floats, Floats]:
    if file.suffix.lower() in MESH_ENDINGS:
        cure = f'give both meshes: {{ target = "...", measured = "{file.name}" }}'
        raise _error(file, "one mesh states no deviation", cure, "springback-one-mesh")
    if units is None:
        cure = f"add units to [part.springback], one of {', '.join(UNITS)}"
        raise _error(file, "a table carries no units", cure, "springback-units-missing")
    check_readable(file)
    rows = np.array(read_table(file, LAYOUT)) * UNITS[units]
    return np.ascontiguousarray(rows[:, :3]), np.ascontiguousarray(rows[:, 3:])


def _meshes(folder: Path, pair: Document, units: str | None) -> tuple[Floats, Floats]:
    (target, of_target), (measured, of_measured) = (
        _triangles(folder / pair[key], units) for key in ("target", "measured")
    )
    if not np.array_equal(of_target, of_measured) or len(target) != len(measured):
        sizes = f"{len(of_target)} triangles on {len(target)} points, and {len(of_measured)} on {len(measured)}"
        what = f"its triangles are not those of {pair['target']} ({sizes})"
        cure = "give the same mesh before and after, or a table of points and deviations"
        raise _error(folder / pair["measured"], what, cure, "springback-meshes-differ")
    return target, measured - target


def _triangles(file: Path, units: str | None) -> tuple[Floats, Ints]:
    check_readable(file)
    if file.suffix.lower() not in MESH_ENDINGS:
        known = " ".join(MESH_ENDINGS)
        raise _error(file, "not a mesh", f"use one of {known}", "springback-not-a-mesh")
    return triangles_as_written(file, None if file.suffix.lower() == ".3mf" else units)


def _error(file: Path, what: str, cure: str, code: str) -> GeometryError:
    return GeometryError(f"{file}: {what}: {cure}", code=code, where=str(file), hint=cure)
