"""STEP, BREP and IGES files through OpenCASCADE (OCP): faces, exact surfaces and a checked mesh."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from ..errors import GeometryError
from .arrays import PartArrays
from .assembly import assemble, kind_of, outward
from .progress import AttemptSteps, Progress, report
from .surfaces import Cone, Cylinder, ExactSurface, Floats, Nurbs, Parametric, Plane, Sphere, Torus
from .tessellation import FaceMesh, Tessellation, refine_until

# An object of the CAD kernel, whose Python bindings have no types.
Kernel: TypeAlias = Any

# The kernel meshes face borders within the deflection asked, face insides with one so many times larger: they are
# refined in numpy, only where the surface bends, which gives fewer triangles in less time than the kernel's own
# refinement. Five times is quicker, but its triangles blur the radii of fillets, and hide bumps between their samples.
INSIDE_COARSER = 1.4
# Largest turn (rad) between neighbouring border segments: it decides only on arcs below 65 times the deflection.
ANGLE = 0.35


def read_brep(file: Path, tolerance: float, progress: Progress | None = None) -> PartArrays:
    """Read the part in a STEP, BREP or IGES file. See styluscam.parts.read_part."""
    ocp(file)
    with quiet_kernel(), kernel_failures(file):
        report(progress, "read", 0.0)
        shape, units = _load(file)
        faces = faces_of(shape)
        notes = _bodies(file, shape, faces)
        _check_extent(file, shape, units)
        report(progress, "mesh", 0.2)
        surfaces = [surface_of(face) for face in faces]
        tessellation = _tessellate(file, shape, faces, surfaces=surfaces, tolerance=tolerance, progress=progress)
        areas = [_area_and_centre(face) for face in faces]
    report(progress, "arrays", 0.9)
    kinds = [kind_of(surface) for surface in surfaces]
    part = assemble(
        file,
        tolerance,
        units,
        notes=notes,
        surfaces=surfaces,
        kinds=kinds,
        areas=areas,
        tessellation=tessellation,
        exact_area=lambda i: _careful_area(faces[i]),
    )
    report(progress, "arrays", 1.0)
    return part


def ocp(file: Path) -> None:
    """Import the CAD kernel, or say what to install."""
    try:
        import OCP.STEPControl  # noqa: F401
    except ImportError as error:
        raise GeometryError(
            f"{file}: reading {file.suffix} files needs the CAD kernel: pip install 'styluscam[step]'",
            code="part-extra-step",
            where=str(file),
            hint="pip install 'styluscam[step]'",
        ) from error


@contextmanager
def quiet_kernel() -> Iterator[None]:
    """Take the kernel's message printers away for a while: it writes to stdout otherwise."""
    from OCP.Message import Message

    messenger = Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)


@cache
def thrown_by_kernel() -> tuple[type[Exception], ...]:
    """Every class of exceptions of the kernel: in Python none of them derives from another."""
    from OCP import Standard, StdFail

    classes = [*vars(Standard).values(), *vars(StdFail).values()]
    return tuple(cls for cls in classes if isinstance(cls, type) and issubclass(cls, Exception))


@contextmanager
def kernel_failures(file: Path) -> Iterator[None]:
    """Turn what the kernel throws into a sentence: its own words are names of its classes."""
    try:
        yield
    except thrown_by_kernel() as error:
        cure = "open the part in a CAD system, check its geometry there and export it again"
        raise GeometryError(
            f"{file}: the CAD kernel gives up on its geometry: {cure}",
            code="part-kernel",
            where=str(file),
            hint=cure,
        ) from error


# --- loading -----------------------------------------------------------------------------------------------------


def _load(file: Path) -> tuple[Kernel, str]:
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
        raise _damaged(file, "STEP", "it is an STL file", "give it the ending .stl, and say its units")
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
    """Return the place of the first byte outside quotes and comments that is not ASCII; None where there is none."""
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
    if _count(shape, "SOLID") or _count(shape, "SHELL"):
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


def _count(shape: Kernel, kind: str) -> int:
    return int(_map_shapes(shape, kind).Size())


def _map_shapes(shape: Kernel, kind: str) -> Kernel:
    from OCP import TopAbs, TopTools
    from OCP.TopExp import TopExp

    found = TopTools.TopTools_IndexedMapOfShape()
    if not shape.IsNull():
        TopExp.MapShapes_s(shape, getattr(TopAbs.TopAbs_ShapeEnum, f"TopAbs_{kind}"), found)
    return found


def _bodies(file: Path, shape: Kernel, faces: list[Kernel]) -> tuple[str, ...]:
    """Return sentences on what the file holds besides one solid; raise when there is no body."""
    solids, shells = _count(shape, "SOLID"), _map_shapes(shape, "SHELL")
    if not faces or not (solids or shells.Size()):
        raise _no_geometry(file)
    sheets = sum(not shells.FindKey(i).Closed() for i in range(1, shells.Size() + 1))
    notes = []
    if solids > 1:
        notes.append(f"the file holds {solids} solids: all of them are the part")
    if sheets or not solids:
        notes.append(f"the file holds {max(sheets, 1)} sheet body, not a closed solid: its material side is a guess")
    return tuple(notes)


def _check_extent(file: Path, shape: Kernel, units: str) -> None:
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


# --- faces and their surfaces ------------------------------------------------------------------------------------


def faces_of(shape: Kernel) -> list[Kernel]:
    """Return the faces in TopExp order: the first is Face1 in FreeCAD."""
    from OCP.TopoDS import TopoDS

    found = _map_shapes(shape, "FACE")
    return [TopoDS.Face_s(found.FindKey(i)) for i in range(1, found.Size() + 1)]


def _xyz(value: Kernel) -> tuple[float, float, float]:
    return (value.X(), value.Y(), value.Z())


def surface_of(face: Kernel) -> ExactSurface:
    """Return the exact surface under a face, oriented out of the material."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopAbs import TopAbs_Orientation

    adaptor = BRepAdaptor_Surface(face)
    outward = -1.0 if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else 1.0
    closed_form = _closed_form(adaptor)
    if closed_form is None:
        return _parametric(face, outward)
    kind, arguments = closed_form
    point, normal = _middle(adaptor)
    if kind is Cone and float((np.array(point) - arguments[0]) @ arguments[1]) * np.tan(arguments[3]) < -arguments[2]:
        arguments = (*arguments[:2], -arguments[2], -arguments[3])  # the face lies on the other nappe
    plain: ExactSurface = kind(*arguments)
    agrees = float(plain.normal(np.array([point]))[0] @ np.array(normal))
    oriented: ExactSurface = kind(*arguments, sign=outward if agrees > 0.0 else -outward)
    return oriented


def _closed_form(adaptor: Kernel) -> tuple[Kernel, tuple[Kernel, ...]] | None:
    """Return the class and arguments of a surface with a closed form; None for a freeform one."""
    from OCP.GeomAbs import GeomAbs_SurfaceType as Type

    kind = adaptor.GetType()
    if kind == Type.GeomAbs_Plane:
        plane = adaptor.Plane()
        return Plane, (_xyz(plane.Location()), _xyz(plane.Axis().Direction()))
    if kind == Type.GeomAbs_Cylinder:
        cylinder = adaptor.Cylinder()
        return Cylinder, (_xyz(cylinder.Location()), _xyz(cylinder.Axis().Direction()), cylinder.Radius())
    if kind == Type.GeomAbs_Cone:
        cone = adaptor.Cone()
        placed = (_xyz(cone.Location()), _xyz(cone.Axis().Direction()))
        return Cone, (*placed, cone.RefRadius(), cone.SemiAngle())
    if kind == Type.GeomAbs_Sphere:
        sphere = adaptor.Sphere()
        return Sphere, (_xyz(sphere.Location()), sphere.Radius())
    if kind == Type.GeomAbs_Torus:
        torus = adaptor.Torus()
        placed = (_xyz(torus.Location()), _xyz(torus.Axis().Direction()))
        return Torus, (*placed, torus.MajorRadius(), torus.MinorRadius())
    return None


def _middle(adaptor: Kernel) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return a point in the middle of the face's parameters, and the surface's own normal there (not the face's)."""
    from OCP.gp import gp_Pnt, gp_Vec

    u = (adaptor.FirstUParameter() + adaptor.LastUParameter()) / 2.0
    v = (adaptor.FirstVParameter() + adaptor.LastVParameter()) / 2.0
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    adaptor.D1(u, v, point, along_u, along_v)
    return _xyz(point), _xyz(along_u.Crossed(along_v))


def _parametric(face: Kernel, outward: float) -> Parametric:
    """Return a freeform face's surface; its seeds come with the mesh (see _with_seeds)."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepTools import BRepTools
    from OCP.Geom import Geom_BSplineSurface, Geom_RectangularTrimmedSurface
    from OCP.GeomConvert import GeomConvert

    surface = BRep_Tool.Surface_s(face)
    while isinstance(surface, Geom_RectangularTrimmedSurface):
        surface = surface.BasisSurface()
    none = np.zeros((0, 3)), np.zeros((0, 2))
    if not isinstance(surface, Geom_BSplineSurface):
        if _is_offset(surface):
            return Parametric(*_by_kernel(face), *none, outward)
        u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
        try:
            trimmed = Geom_RectangularTrimmedSurface(surface, u0, u1, v0, v1)
            surface = GeomConvert.SurfaceToBSplineSurface_s(trimmed)
        except thrown_by_kernel():
            return Parametric(*_by_kernel(face), *none, outward)
    nurbs = nurbs_of(surface)
    return Parametric(nurbs, nurbs.bounds, *none, outward)


def _is_offset(surface: Kernel) -> bool:
    """Tell whether an offset is involved: the kernel converts those approximately only."""
    from OCP.Geom import Geom_OffsetSurface, Geom_SweptSurface, Geom_TrimmedCurve

    if isinstance(surface, Geom_SweptSurface):
        curve = surface.BasisCurve()
        while isinstance(curve, Geom_TrimmedCurve):
            curve = curve.BasisCurve()
        return "Offset" in type(curve).__name__
    return isinstance(surface, Geom_OffsetSurface)


def nurbs_of(surface: Kernel) -> Nurbs:
    """Return a kernel's B-spline surface as arrays."""
    surface = surface.Copy()
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    rows, columns = range(1, surface.NbUPoles() + 1), range(1, surface.NbVPoles() + 1)
    knots_u = [surface.UKnot(i) for i in range(1, surface.NbUKnots() + 1) for _ in range(surface.UMultiplicity(i))]
    knots_v = [surface.VKnot(i) for i in range(1, surface.NbVKnots() + 1) for _ in range(surface.VMultiplicity(i))]
    return Nurbs(
        surface.UDegree(),
        surface.VDegree(),
        np.array(knots_u),
        np.array(knots_v),
        np.array([[_xyz(surface.Pole(i, j)) for j in columns] for i in rows]),
        np.array([[surface.Weight(i, j) for j in columns] for i in rows]),
    )


class _KernelSurface:
    """An evaluator that asks the kernel point by point (some 3 us each)."""

    def __init__(self, face: Kernel) -> None:
        from OCP.BRep import BRep_Tool

        self._face = face
        self._surface = BRep_Tool.Surface_s(face)

    def __call__(self, uv: Floats) -> tuple[Floats, Floats, Floats]:
        from OCP.gp import gp_Pnt, gp_Vec

        out = np.empty((len(uv), 3, 3))
        point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
        for i, (u, v) in enumerate(uv.tolist()):
            self._surface.D1(u, v, point, along_u, along_v)
            out[i] = _xyz(point), _xyz(along_u), _xyz(along_v)
        return out[:, 0], out[:, 1], out[:, 2]

    def __reduce__(self) -> tuple[Kernel, tuple[bytes]]:
        """For workers: the kernel's own binary form, exact."""
        from OCP.BinTools import BinTools

        stream = io.BytesIO()
        BinTools.Write_s(self._face, stream)
        return _kernel_surface, (stream.getvalue(),)


def _kernel_surface(face: bytes) -> _KernelSurface:
    """Return the evaluator that was written."""
    from OCP.BinTools import BinTools
    from OCP.TopoDS import TopoDS, TopoDS_Shape

    shape = TopoDS_Shape()
    BinTools.Read_s(shape, io.BytesIO(face))
    return _KernelSurface(TopoDS.Face_s(shape))


def _by_kernel(face: Kernel) -> tuple[_KernelSurface, tuple[float, float, float, float]]:
    """Return an evaluator that asks the kernel, and the face's parameter range."""
    from OCP.BRepTools import BRepTools

    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    return _KernelSurface(face), (u0, u1, v0, v1)


def _area_and_centre(face: Kernel) -> tuple[float, tuple[float, float, float]]:
    """Return the exact area (mm^2) and its centre."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return abs(properties.Mass()), _xyz(properties.CentreOfMass())


def _careful_area(face: Kernel) -> float:
    """Return the exact area (mm^2) by a quadrature that halves its steps until 0.01 % is sure."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties, 1e-4)
    return abs(float(properties.Mass()))


# --- meshing -----------------------------------------------------------------------------------------------------


def _tessellate(
    file: Path,
    shape: Kernel,
    faces: list[Kernel],
    *,
    surfaces: list[ExactSurface],
    tolerance: float,
    progress: Progress | None,
) -> Tessellation:
    """Mesh each face, checked; give the freeform surfaces their seeds on the way."""
    steps = AttemptSteps(progress)

    def mesh_at(deflection: float) -> list[FaceMesh]:
        steps.begin()
        _mesh(shape, faces, deflection)
        meshes = [outward(m, s) for m, s in zip(_face_meshes(file, faces), surfaces, strict=True)]
        for i, (mesh, surface) in enumerate(zip(meshes, surfaces, strict=True)):
            if isinstance(surface, Parametric) and mesh.uv is not None:
                surfaces[i] = _with_seeds(surface, mesh)
        return meshes

    return refine_until(mesh_at, surfaces, tolerance, str(file), steps.checked)


def _mesh(shape: Kernel, faces: list[Kernel], deflection: float) -> None:
    """Give each face a triangulation; faces share their border nodes.

    The Delabella algorithm is up to ten times faster than the default, Watson, and freer of wrong triangles, but
    gives up on some freeform faces: those that it leaves empty go to Watson, on the borders that are there already.
    """
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.IMeshTools import IMeshTools_MeshAlgoType as Algorithm
    from OCP.IMeshTools import IMeshTools_Parameters

    parameters = IMeshTools_Parameters()
    parameters.Deflection = deflection
    parameters.DeflectionInterior = INSIDE_COARSER * deflection
    parameters.Angle = ANGLE
    parameters.Relative = False
    parameters.InParallel = True
    parameters.ControlSurfaceDeflection = False
    BRepTools.Clean_s(shape)
    for algorithm in (
        Algorithm.IMeshTools_MeshAlgoType_Delabella,
        Algorithm.IMeshTools_MeshAlgoType_Watson,
    ):
        parameters.MeshAlgo = algorithm
        BRepMesh_IncrementalMesh(shape, parameters)
        if all(_triangulation(face)[0] is not None for face in faces):
            return


def _triangulation(face: Kernel) -> tuple[Kernel, Kernel]:
    """Return a face's triangulation (None if there is none) and its placement."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    location = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, location)
    return (found if found is not None and found.NbTriangles() else None), location


def _face_meshes(file: Path, faces: list[Kernel]) -> list[FaceMesh]:
    """Return the kernel's triangles of each face, fetched in bulk: asking node by node takes 1 us each."""
    from OCP.BRep import BRep_Builder
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Compound, TopoDS_Face
    from OCP.TopTools import TopTools_IndexedMapOfShape

    builder, bare = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(bare)
    distinct = TopTools_IndexedMapOfShape()  # faces that are copies at another place share one triangulation
    numbers, placements = [], []
    for number, face in enumerate(faces, 1):
        triangulation, location = _triangulation(face)
        if triangulation is None:
            place = f"{file}:Face{number}"
            raise GeometryError(
                f"{place}: the kernel cannot mesh this face: repair it in the CAD system",
                code="part-face-not-meshed",
                where=place,
            )
        known = distinct.Size()
        index = distinct.Add(face.Located(TopLoc_Location()))
        if index > known:
            carrier = TopoDS_Face()
            builder.MakeFace(carrier, triangulation)
            builder.Add(bare, carrier)
        numbers.append(index - 1)
        placements.append(_placement(location))
    stored = _stored_triangulations(bare)
    if len(stored) != distinct.Size():
        raise RuntimeError(f"{distinct.Size()} triangulations written, {len(stored)} read back")
    return [_placed(stored[number], placement) for number, placement in zip(numbers, placements, strict=True)]


def _stored_triangulations(shape: Kernel) -> list[FaceMesh]:
    """Return all triangulations of a shape, in order, by way of the kernel's binary format (BinTools, version 1).

    A section "Triangulations N" holds for each: node and triangle counts (int32), whether it has parameters (a byte),
    deflection, nodes, parameters (float64) and triangles (int32, from 1).
    """
    from OCP.BinTools import BinTools, BinTools_FormatVersion

    stream = io.BytesIO()
    BinTools.Write_s(shape, stream, True, False, BinTools_FormatVersion.BinTools_FormatVersion_VERSION_1)
    data = stream.getvalue()
    header = re.search(rb"\nTriangulations (\d+)\n", data)
    if header is None:
        raise RuntimeError("the kernel wrote no triangulations")
    at = header.end()
    meshes = []
    for _ in range(int(header[1])):
        nodes, triangles = (int(n) for n in np.frombuffer(data, "<i4", 2, at))
        has_uv = data[at + 8] != 0
        at += 17
        points = np.frombuffer(data, "<f8", 3 * nodes, at).reshape(-1, 3)
        at += 24 * nodes
        uv = np.frombuffer(data, "<f8", 2 * nodes, at).reshape(-1, 2) if has_uv else None
        at += 16 * nodes if has_uv else 0
        corners = np.frombuffer(data, "<i4", 3 * triangles, at).reshape(-1, 3).astype(np.int64) - 1
        at += 12 * triangles
        meshes.append(FaceMesh(points, corners, uv))
    return meshes


def _placement(location: Kernel) -> Floats | None:
    """Return a face's placement as a 3 x 4 matrix; None where it stands at its own place."""
    if location.IsIdentity():
        return None
    matrix = location.Transformation()
    return np.array([[matrix.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])


def _placed(mesh: FaceMesh, placement: Floats | None) -> FaceMesh:
    if placement is None:
        return mesh
    return FaceMesh(mesh.nodes @ placement[:, :3].T + placement[:, 3], mesh.triangles, mesh.uv)


def _with_seeds(surface: Parametric, mesh: FaceMesh) -> Parametric:
    assert mesh.uv is not None
    return Parametric(surface.evaluate, surface.bounds, mesh.nodes, mesh.uv, surface.sign)
