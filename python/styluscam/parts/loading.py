"""STEP, IGES and BREP files into shapes of the CAD kernel; what is no whole file is refused before the kernel sees it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from styluscam.errors import GeometryError
from styluscam.parts.kernel import Kernel, count, map_shapes


def load(file: Path) -> tuple[Kernel, str]:
    """Return the shape in mm, and the name of the file's unit of length."""
    ending = file.suffix.lower()
    if ending in (".step", ".stp"):
        return _load_step(file)
    if ending in (".iges", ".igs"):
        return _load_iges(file)
    return _load_native(file)


def _load_step(file: Path) -> tuple[Kernel, str]:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TColStd import TColStd_SequenceOfAsciiString

    _check_step_text(file)
    reader = STEPControl_Reader()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    if reader.ReadFile(str(file)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise _damaged(file, "STEP")
    lengths, angles, solid_angles = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.FileUnits(lengths, angles, solid_angles)
    names = sorted({lengths.Value(i).ToCString().lower() for i in range(1, lengths.Length() + 1)})
    roots = reader.NbRootsForTransfer()
    if roots == 0 or reader.TransferRoots() == 0:
        raise _no_geometry(file)
    return reader.OneShape(), ", ".join(names) or "unknown"


def _check_step_text(file: Path) -> None:
    """Refuse what is not a whole STEP file, before the kernel reads half of it without a word."""
    text = file.read_bytes()
    if re.match(rb"\s*solid\b", text, re.IGNORECASE) and b"facet" in text[:4096]:
        raise _damaged(file, "STEP", "it is an STL file", "give it the ending .stl, and state its units")
    if b"ISO-10303-21" not in text[:4096]:
        raise _damaged(file, "STEP", "it does not begin with ISO-10303-21")
    if re.search(rb"END-ISO-10303-21\s*;", text[-4096:]) is None:
        raise _damaged(file, "STEP", "it is cut short: END-ISO-10303-21 is missing")
    if (foreign := _foreign_byte(text)) is not None:  # the kernel may end the whole process on it
        line = text.count(b"\n", 0, foreign) + 1
        raise _damaged(file, "STEP", f"line {line} holds a byte that no STEP file has outside a name")
    strange = re.search(rb"[(,]\s*[-+]?(?:nan|inf)\b", text, re.IGNORECASE)
    if strange is not None:  # the kernel would mesh it forever
        line = text.count(b"\n", 0, strange.end()) + 1
        raise _damaged(file, "STEP", f"line {line} holds a coordinate that is not a number")


def _foreign_byte(text: bytes) -> int | None:
    """Return the index of the first byte outside quotes and comments that is not ASCII; None where there is none."""
    if text.isascii():
        return None
    names = re.compile(rb"'[^']*'|/\*.*?\*/", re.DOTALL)
    found = re.search(rb"[^\x00-\x7f]", names.sub(lambda name: b" " * len(name[0]), text))
    return None if found is None else found.start()


def _load_iges(file: Path) -> tuple[Kernel, str]:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.IGESControl import IGESControl_Reader
    from OCP.Interface import Interface_Static

    reader = IGESControl_Reader()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    if reader.ReadFile(str(file)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise _damaged(file, "IGES")
    unit = reader.IGESModel().GlobalSection().UnitName()
    name = unit.ToCString().lower() if unit is not None else "unknown"
    if reader.NbRootsForTransfer() == 0 or reader.TransferRoots() == 0:
        raise _no_geometry(file)
    shape = reader.OneShape()
    if count(shape, "SOLID") or count(shape, "SHELL"):
        return shape, name
    sewing = BRepBuilderAPI_Sewing(1e-4)  # loose faces, as most IGES files have: they share no edges yet
    sewing.Add(shape)
    sewing.Perform()
    return sewing.SewedShape(), name


def _load_native(file: Path) -> tuple[Kernel, str]:
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Shape

    _check_native_text(file)
    shape = TopoDS_Shape()
    if not BRepTools.Read_s(shape, str(file), BRep_Builder()) or shape.IsNull():
        raise _damaged(file, "BREP")
    return shape, "mm"


# The sections of a BREP file, each with its count.
NATIVE = (
    "Locations",
    "Curve2ds",
    "Curves",
    "Polygon3D",
    "PolygonOnTriangulations",
    "Surfaces",
    "Triangulations",
    "TShapes",
)


def _check_native_text(file: Path) -> None:
    """Refuse what is not a whole BREP file: the kernel reads on behind its end for ever."""
    text = file.read_bytes()
    if b"CASCADE Topology" not in text[:4096]:
        raise _damaged(file, "BREP", "it does not begin with 'CASCADE Topology'")
    at, count = 0, 0
    for section in NATIVE:
        header = re.compile(rb"^%s (\d+)\s*$" % section.encode(), re.MULTILINE).search(text, at)
        if header is None:
            raise _damaged(file, "BREP", f"its section {section} is missing: it is cut short")
        at, count = header.end(), int(header[1])
    shapes = len(re.findall(rb"\*\s*$", text[at:], re.MULTILINE))
    if shapes != count or re.search(rb"[-+]\d+ \d+\s*$", text[-64:]) is None:
        raise _damaged(file, "BREP", f"it holds {shapes} of {count} shapes: it is cut short")


def _damaged(
    file: Path, kind: str, why: str = "the kernel cannot parse it", cure: str = "export the part again"
) -> GeometryError:
    return GeometryError(
        f"{file}: not a whole {kind} file ({why}): {cure}", code="part-damaged", where=str(file), hint=cure
    )


def _no_geometry(file: Path) -> GeometryError:
    return GeometryError(
        f"{file}: holds no solid and no sheet body: export the body itself", code="part-no-solid", where=str(file)
    )


def bodies(file: Path, shape: Kernel, faces: list[Kernel]) -> tuple[str, ...]:
    """Return sentences on what the file holds besides one solid; raise when there is no body."""
    solids, shells = count(shape, "SOLID"), map_shapes(shape, "SHELL")
    if not faces or not (solids or shells.Size()):
        raise _no_geometry(file)
    sheets = sum(not shells.FindKey(i).Closed() for i in range(1, shells.Size() + 1))
    notes = []
    if solids > 1:
        notes.append(f"the file holds {solids} solids: all of them are the part")
    if sheets or not solids:
        notes.append(f"the file holds {max(sheets, 1)} sheet body, not a closed solid: its material side is a guess")
    return tuple(notes)


def check_extent(file: Path, shape: Kernel, units: str) -> None:
    """Refuse an absurd size before meshing it would take forever."""
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    corners = np.array(box.Get()) if not box.IsVoid() else np.zeros(6)
    reach, size = float(np.abs(corners).max()), float((corners[3:] - corners[:3]).max())
    if not np.isfinite(corners).all() or reach > 1e6 or size < 1e-3:
        what = f"reaches {reach:.3g} mm from the origin" if not reach <= 1e6 else f"is only {size:.3g} mm across"
        raise GeometryError(
            f"{file}: the part {what}: check its units (read as {units})",
            code="part-too-large" if not reach <= 1e6 else "part-too-small",
            where=str(file),
            hint="check the units",
        )
