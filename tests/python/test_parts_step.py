"""STEP, BREP and IGES: faces, orientation, the deviation bound, and every bad input."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("OCP", reason="needs the step extra")

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeVertex, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeRevol,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.BRepTools import BRepTools
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IGESControl import IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shell

from styluscam.errors import Cancelled, GeometryError
from styluscam.parts.arrays import PartArrays
from styluscam.parts.kernel import faces_of, quiet_kernel
from styluscam.parts.reading import read_part

FIXTURES = Path(__file__).parents[2] / "fixtures"
AS_IS = STEPControl_StepModelType.STEPControl_AsIs


@pytest.fixture(autouse=True)
def read_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is asked here is what reading does, not what was kept of an earlier reading."""
    monkeypatch.setattr("styluscam.parts.cache.keep", lambda *_: None)
    monkeypatch.setattr("styluscam.parts.cache.kept", lambda *_: None)


def write_step(shape: Any, file: Path, unit: str = "MM") -> Path:
    with quiet_kernel():
        writer = STEPControl_Writer()
        Interface_Static.SetCVal_s("write.step.unit", unit)
        writer.Transfer(shape, AS_IS)
        writer.Write(str(file))
        Interface_Static.SetCVal_s("write.step.unit", "MM")
    return file


def box(x: float = 10.0, y: float = 20.0, z: float = 30.0) -> Any:
    return BRepPrimAPI_MakeBox(x, y, z).Shape()


def spline_block() -> Any:
    """A block 20 x 20 under a wavy B-spline top (swept down to Z = -20, cut to size)."""
    from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
    from OCP.TColgp import TColgp_Array2OfPnt

    points = TColgp_Array2OfPnt(1, 9, 1, 7)
    for i in range(9):
        for j in range(7):
            height = 2.0 * np.sin(0.7 * i) * np.cos(0.6 * j)
            points.SetValue(i + 1, j + 1, gp_Pnt(2.5 * i, 3.4 * j, height))
    top = BRepBuilderAPI_MakeFace(GeomAPI_PointsToBSplineSurface(points).Surface(), 1e-6).Face()
    return BRepPrimAPI_MakePrism(top, gp_Vec(0, 0, -20)).Shape()


def at(x: float, y: float, z: float, direction: tuple[float, float, float] = (0, 0, 1)) -> gp_Ax2:
    return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(*direction))


def all_kinds() -> Any:
    """One solid with planes, a cylinder, a cone, a sphere, a torus and splines, convex and concave."""
    shape = BRepPrimAPI_MakeBox(gp_Pnt(-40, -40, -20), gp_Pnt(40, 40, 0)).Shape()
    for body in (
        BRepPrimAPI_MakeCone(at(-20, -20, -12), 3.0, 12.0, 12.0).Shape(),
        BRepPrimAPI_MakeSphere(gp_Pnt(20, -20, 3), 10.0).Shape(),
        BRepPrimAPI_MakeTorus(at(20, 20, 0), 10.0, 4.0).Shape(),
        BRepPrimAPI_MakeCylinder(at(-20, 20, -30), 6.0, 60.0).Shape(),
    ):
        shape = BRepAlgoAPI_Cut(shape, body).Shape()
    shape = BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, -2), 8.0).Shape()).Shape()
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(30, -10, -8))
    return BRepAlgoAPI_Fuse(shape, BRepBuilderAPI_Transform(spline_block(), move, True).Shape()).Shape()


@pytest.fixture(scope="module")
def kinds_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_step(all_kinds(), tmp_path_factory.mktemp("parts") / "kinds.step")


@pytest.fixture(scope="module")
def kinds(kinds_file: Path) -> PartArrays:
    return read_part(kinds_file, tolerance=0.005)


def read_shape(file: Path) -> Any:
    from styluscam.parts.loading import load

    with quiet_kernel():
        return load(file)[0]


def test_a_box_is_exact(tmp_path: Path) -> None:
    part = read_part(write_step(box(), tmp_path / "box.step"))
    assert part.is_closed and not part.notes
    assert part.box == (pytest.approx((0, 0, 0), abs=1e-9), pytest.approx((10, 20, 30)))
    assert (len(part.vertices), len(part.triangles)) == (8, 12)
    assert part.deviation_inward == pytest.approx(0.0, abs=1e-12)
    assert part.deviation_outward == pytest.approx(0.0, abs=1e-12)
    assert [face.id for face in part.faces] == [1, 2, 3, 4, 5, 6]
    assert sorted(face.area_mm2 for face in part.faces) == pytest.approx([200, 200, 300, 300, 600, 600])
    top = next(f for f in part.faces if f.normal[2] > 0.9)
    assert top.centre == pytest.approx((5, 10, 30))
    assert (top.slope_min_deg, top.slope_max_deg) == pytest.approx((0, 0), abs=1e-6)
    assert top.kind == "plane" and top.name == f"Face{top.id}" and top.triangles == 2
    assert not part.vertices.flags.writeable


def outward_everywhere(part: PartArrays) -> None:
    """Windings and corner normals leave the material, and agree with each other."""
    corners = part.vertices[part.triangles]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.einsum("ij,ij->", corners.mean(axis=1), facets) > 0.0  # six volumes
    areas = np.linalg.norm(facets, axis=1)
    agree = np.einsum("ij,ij->i", facets, part.normals.mean(axis=1)) > 0.9 * areas
    assert areas[~agree].sum() < 1e-4 * areas.sum()
    assert np.linalg.norm(part.normals, axis=2) == pytest.approx(1.0, abs=1e-9)


def test_all_kinds_are_known_and_watertight(kinds: PartArrays) -> None:
    assert {f.kind for f in kinds.faces} == {"plane", "cylinder", "cone", "sphere", "torus", "spline"}
    assert kinds.is_closed and not kinds.notes
    outward_everywhere(kinds)
    assert np.array_equal(np.unique(kinds.face_ids), np.arange(1, len(kinds.faces) + 1))
    assert [f.triangles for f in kinds.faces] == np.bincount(kinds.face_ids)[1:].tolist()


def test_face_order_and_areas_are_the_kernels(kinds: PartArrays, kinds_file: Path) -> None:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    corners = kinds.vertices[kinds.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    for info, face in zip(kinds.faces, faces_of(read_shape(kinds_file)), strict=True):
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, properties)
        assert info.area_mm2 == pytest.approx(properties.Mass(), rel=1e-9)
        assert areas[kinds.face_ids == info.id].sum() == pytest.approx(properties.Mass(), rel=5e-3)
        centre = properties.CentreOfMass()
        assert info.centre == pytest.approx((centre.X(), centre.Y(), centre.Z()), abs=1e-9)


def test_deviation_bound_holds_by_kernel_projection(kinds: PartArrays, kinds_file: Path) -> None:
    """Denser, random samples, measured by the kernel's projection, stay within the bound that we report."""
    assert max(kinds.deviation_inward, kinds.deviation_outward) <= 0.005
    random = np.random.default_rng(5)
    worst = 0.0
    for info, face in zip(kinds.faces, faces_of(read_shape(kinds_file)), strict=True):
        own = kinds.triangles[kinds.face_ids == info.id]
        count = 300 if info.kind != "spline" else 120
        chosen = own[random.integers(len(own), size=count)]
        weights = random.dirichlet((2.0, 2.0, 2.0), size=count)
        points = np.einsum("nk,nkd->nd", weights, kinds.vertices[chosen])
        signed = kinds.surface_distance(points, np.full(count, info.id))
        surface = BRep_Tool.Surface_s(face)
        for point, distance in zip(points, signed, strict=True):
            expected = GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), surface).LowerDistance()
            assert abs(distance) == pytest.approx(expected, abs=1e-7)
        assert -signed.min() <= kinds.deviation_inward + 1e-12
        assert signed.max() <= kinds.deviation_outward + 1e-12
        worst = max(worst, float(np.abs(signed).max()))
    assert worst > 0.001  # the bound is not met by meshing far too finely


def test_normals_are_the_faces_own(kinds: PartArrays, kinds_file: Path) -> None:
    """Corner normals against the kernel's, with the face's orientation."""
    from OCP.BRepLProp import BRepLProp_SLProps
    from OCP.TopAbs import TopAbs_Orientation

    for info, face in zip(kinds.faces, faces_of(read_shape(kinds_file)), strict=True):
        own = np.flatnonzero(kinds.face_ids == info.id)[::41][:15]
        adaptor = BRepAdaptor_Surface(face)
        turned = -1.0 if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else 1.0
        for triangle in own:
            point = kinds.vertices[kinds.triangles[triangle, 0]]
            u, v = GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), BRep_Tool.Surface_s(face)).LowerDistanceParameters()
            normal = BRepLProp_SLProps(adaptor, u, v, 1, 1e-9).Normal()
            expected = turned * np.array([normal.X(), normal.Y(), normal.Z()])
            assert kinds.normals[triangle, 0] == pytest.approx(expected, abs=1e-6)


def test_slopes(tmp_path: Path) -> None:
    part = read_part(write_step(BRepPrimAPI_MakeCone(at(0, 0, 0), 10.0, 4.0, 6.0).Shape(), tmp_path / "c.step"), 0.01)
    cone = next(f for f in part.faces if f.kind == "cone")
    assert (cone.slope_min_deg, cone.slope_max_deg) == pytest.approx((45.0, 45.0))
    ball = read_part(write_step(BRepPrimAPI_MakeSphere(10.0).Shape(), tmp_path / "s.step"), 0.01)
    assert (ball.faces[0].slope_min_deg, ball.faces[0].slope_max_deg) == pytest.approx((0.0, 180.0), abs=1e-3)
    outward_everywhere(ball)
    assert ball.is_closed


def test_cone_apex_has_a_normal(tmp_path: Path) -> None:
    part = read_part(write_step(BRepPrimAPI_MakeCone(at(0, 0, 0), 5.0, 0.0, 5.0).Shape(), tmp_path / "a.step"), 0.01)
    assert part.is_closed
    cone = next(f for f in part.faces if f.kind == "cone")
    assert (cone.slope_min_deg, cone.slope_max_deg) == pytest.approx((45.0, 45.0))
    outward_everywhere(part)


def test_revolved_spline_and_extrusion(tmp_path: Path) -> None:
    """Swept surfaces become B-splines; their meshes hold like any other."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire
    from OCP.GeomAPI import GeomAPI_PointsToBSpline
    from OCP.TColgp import TColgp_Array1OfPnt

    points = TColgp_Array1OfPnt(1, 6)
    for i in range(6):
        points.SetValue(i + 1, gp_Pnt(8.0 + 1.5 * np.sin(1.1 * i), 0.0, 4.0 * i))
    curve = GeomAPI_PointsToBSpline(points).Curve()
    ends = [curve.Value(curve.FirstParameter()), curve.Value(curve.LastParameter())]
    foot, head = gp_Pnt(2, 0, ends[0].Z()), gp_Pnt(2, 0, ends[1].Z())
    wire = BRepBuilderAPI_MakeWire(
        BRepBuilderAPI_MakeEdge(curve).Edge(),
        BRepBuilderAPI_MakeEdge(ends[1], head).Edge(),
        BRepBuilderAPI_MakeEdge(head, foot).Edge(),
        BRepBuilderAPI_MakeEdge(foot, ends[0]).Edge(),
    ).Wire()
    face = BRepBuilderAPI_MakeFace(wire).Face()
    revolved = BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape()
    for name, shape in (("r", revolved), ("e", BRepPrimAPI_MakePrism(face, gp_Vec(0, 15, 0)).Shape())):
        file = tmp_path / f"{name}.brep"
        BRepTools.Write_s(shape, str(file))
        part = read_part(file, 0.005)
        assert part.is_closed and "spline" in {f.kind for f in part.faces}
        outward_everywhere(part)
        assert max(part.deviation_inward, part.deviation_outward) <= 0.005
        spline = next(f for f in part.faces if f.kind == "spline")
        kernel_surface = BRep_Tool.Surface_s(faces_of(shape)[spline.id - 1])
        centres = part.vertices[part.triangles[part.face_ids == spline.id]].mean(axis=1)[::97]
        ours = part.surface_distance(centres, np.full(len(centres), spline.id))
        for point, distance in zip(centres, ours, strict=True):
            expected = GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), kernel_surface).LowerDistance()
            assert abs(distance) == pytest.approx(expected, abs=1e-7)


def test_offset_surface_is_asked_of_the_kernel(tmp_path: Path) -> None:
    from OCP.Geom import Geom_OffsetSurface

    top = faces_of(spline_block())[-1]
    spline = next(f for f in faces_of(spline_block()) if "BSpline" in type(BRep_Tool.Surface_s(f)).__name__)
    assert top is not None
    offset = Geom_OffsetSurface(BRep_Tool.Surface_s(spline), 0.5)
    builder, shell = BRep_Builder(), TopoDS_Shell()
    builder.MakeShell(shell)
    builder.Add(shell, BRepBuilderAPI_MakeFace(offset, 1e-6).Face())
    file = tmp_path / "offset.brep"
    BRepTools.Write_s(shell, str(file))
    part = read_part(file, 0.02)
    assert part.faces[0].kind == "other"
    assert not part.is_closed and "sheet" in part.notes[0]
    assert max(part.deviation_inward, part.deviation_outward) <= 0.02


def test_units_become_mm(tmp_path: Path) -> None:
    part = read_part(write_step(box(), tmp_path / "inch.step", unit="INCH"))
    assert part.box[1] == pytest.approx((10, 20, 30))
    assert "inch" in part.units
    assert "mill" in read_part(write_step(box(), tmp_path / "mm.step")).units


def test_two_placed_copies_and_a_turned_body(tmp_path: Path) -> None:
    """Copies of one body share a triangulation: each must stand at its own position."""
    builder, both = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(both)
    body = BRepAlgoAPI_Cut(box(), BRepPrimAPI_MakeCylinder(at(5, 10, -1), 3.0, 50.0).Shape()).Shape()
    builder.Add(both, body)
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), np.pi / 2)
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(100, 0, 0))
    builder.Add(both, body.Moved(TopLoc_Location(move.Multiplied(turn))))
    file = tmp_path / "two.brep"
    BRepTools.Write_s(both, str(file))
    part = read_part(file, 0.01)
    assert part.is_closed and len(part.faces) == 14
    assert "2 solids" in part.notes[0]
    assert part.box == (pytest.approx((0, -30, 0), abs=1e-9), pytest.approx((110, 20, 30)))
    outward = np.einsum("tkd,tkd->tk", part.normals, np.repeat(part.normals[:, :1], 3, axis=1))
    assert outward.min() > 0.9
    hole = [f.id for f in part.faces if f.kind == "cylinder"]
    assert len(hole) == 2
    assert part.surface_distance(np.array([[105.0, -15.0, 10.0]]), np.array(hole[1:]))[0] == pytest.approx(3.0)


def test_igs_is_sewn(tmp_path: Path) -> None:
    file = tmp_path / "box.igs"
    with quiet_kernel():
        writer = IGESControl_Writer("MM", 0)
        writer.AddShape(box())
        writer.ComputeModel()
        writer.Write(str(file))
    part = read_part(file)
    assert len(part.faces) == 6 and part.box[1] == pytest.approx((10, 20, 30), abs=1e-6)
    assert part.is_closed


def test_distance_of_a_face_that_does_not_exist(kinds: PartArrays) -> None:
    with pytest.raises(IndexError, match="face 0 does not exist"):
        kinds.surface_distance(np.zeros((1, 3)), np.array([0]))


def test_progress_and_cancel(tmp_path: Path) -> None:
    file = write_step(box(), tmp_path / "box.step")
    seen: list[tuple[str, float]] = []
    read_part(file, progress=lambda phase, fraction: seen.append((phase, fraction)))
    assert [f for _, f in seen] == sorted(f for _, f in seen) and seen[-1][1] == 1.0
    with pytest.raises(Cancelled):
        read_part(file, progress=lambda phase, _: phase != "mesh")
    with pytest.raises(ZeroDivisionError):
        read_part(file, progress=lambda *_: 1 / 0 > 0)


def sheet(x: float) -> Any:
    return BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, x, 0.0, x).Face()


def huge(tmp: Path) -> Path:
    return write_step(box(3e6, 1, 1), tmp / "huge.step")


def tiny(tmp: Path) -> Path:
    return write_step(box(5e-4, 5e-4, 5e-4), tmp / "tiny.step")


def truncated(tmp: Path) -> Path:
    whole = write_step(all_kinds(), tmp / "whole.step").read_bytes()
    (tmp / "cut.step").write_bytes(whole[: len(whole) // 2])
    return tmp / "cut.step"


def garbled(tmp: Path) -> Path:
    whole = write_step(box(), tmp / "whole.step").read_bytes()
    (tmp / "garbled.step").write_bytes(whole.replace(b"ADVANCED_FACE", b"ADVANCED_F(CE"))
    return tmp / "garbled.step"


def only_a_point(tmp: Path) -> Path:
    return write_step(BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Shape(), tmp / "point.step")


def no_entities(tmp: Path) -> Path:
    text = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    text += "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"
    (tmp / "none.step").write_text(text)
    return tmp / "none.step"


def written(name: str, content: bytes) -> Any:
    def make(tmp: Path) -> Path:
        (tmp / name).write_bytes(content)
        return tmp / name

    return make


BAD = {
    "missing": (lambda tmp: tmp / "none.step", "part-not-found"),
    "directory": (lambda tmp: tmp, "part-not-a-file"),
    "empty": (written("e.step", b""), "part-empty"),
    "text": (written("t.step", b"hello, this is no STEP file\n" * 50), "part-damaged"),
    "binary": (written("b.stp", bytes(range(256)) * 100), "part-damaged"),
    "truncated": (truncated, "part-damaged"),
    "garbled": (garbled, "part-no-solid"),
    "no entities": (no_entities, "part-no-solid"),
    "only a point": (only_a_point, "part-no-solid"),
    "huge": (huge, "part-too-large"),
    "tiny": (tiny, "part-too-small"),
    "text as brep": (written("t.brep", b"hello"), "part-damaged"),
    "cut brep": (written("t.brep", b"DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra\nLoc"), "part-damaged"),
    "text as iges": (written("t.igs", b"hello\n" * 30), None),
    "unknown ending": (written("t.dwg", b"x"), "part-ending-unknown"),
    "no ending": (written("t", b"x"), "part-ending-unknown"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_typed_line(name: str, tmp_path: Path) -> None:
    make, code = BAD[name]
    file = make(tmp_path)
    with pytest.raises(GeometryError) as caught:
        read_part(file)
    assert code is None or caught.value.code == code
    assert "\n" not in str(caught.value) and str(file) in str(caught.value)
    assert caught.value.where == str(file)


@pytest.mark.skipif(sys.platform == "win32", reason="permissions are POSIX ones")
def test_unreadable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = write_step(box(), tmp_path / "box.step")

    def refuse(*_: Any, **__: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(GeometryError, match="Permission denied") as caught:
        read_part(file)
    assert caught.value.code == "part-unreadable"


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan"), float("inf"), 1e-9])
def test_absurd_tolerance(tolerance: float, tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match="tolerance"):
        read_part(write_step(box(), tmp_path / "box.step"), tolerance)


def test_units_are_refused_where_the_file_has_them(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match="carries its units"):
        read_part(write_step(box(), tmp_path / "box.step"), units="mm")


@pytest.mark.parametrize("make", [truncated, garbled, only_a_point, huge, no_entities])
def test_stdout_stays_clean(make: Any, tmp_path: Path) -> None:
    """Whatever the kernel has to say, at C level too: a process that only reads prints nothing."""
    files = [str(make(tmp_path)), str(write_step(box(), tmp_path / "good.step"))]
    script = (
        "import sys, styluscam.parts.reading as p\n"
        "for f in sys.argv[1:]:\n"
        "    try: p.read_part(f)\n"
        "    except Exception as e: sys.stderr.write(type(e).__name__)\n"
    )
    done = subprocess.run([sys.executable, "-c", script, *files], capture_output=True, check=False)
    assert done.returncode == 0
    assert done.stdout == b""
    assert done.stderr == b"GeometryError"


def test_missing_kernel_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = write_step(box(), tmp_path / "box.step")
    monkeypatch.setitem(sys.modules, "OCP.STEPControl", None)
    with pytest.raises(GeometryError, match=r"styluscam\[step\]") as caught:
        read_part(file)
    assert caught.value.code == "part-extra-step"


def test_importing_the_readers_loads_numpy_only() -> None:
    script = "import sys, styluscam.parts.reading; print([m for m in ('OCP', 'trimesh', 'scipy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("name", ["cone_cup", "pyramid", "cap_r60"])
def test_fixtures_hold_a_micrometre(name: str) -> None:
    file = FIXTURES / f"{name}.step"
    if not file.exists():
        pytest.skip("the fixtures are not built")
    part = read_part(file)
    assert part.is_closed and not part.notes
    assert max(part.deviation_inward, part.deviation_outward) <= 0.001
    assert len(part.triangles) < 200_000
    outward_everywhere(part)


def test_what_the_kernel_throws_becomes_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from OCP.Standard import Standard_Failure

    def fails(*_: object) -> None:
        raise Standard_Failure("Standard_OutOfRange")

    monkeypatch.setattr("styluscam.parts.step.surface_of", fails)
    with pytest.raises(GeometryError, match="cannot process its geometry") as caught:
        read_part(write_step(box(), tmp_path / "box.step"))
    assert "Standard" not in str(caught.value) and caught.value.hint


def test_edges_off_their_surface_are_read_with_a_note(tmp_path: Path) -> None:
    file = write_step(BRepPrimAPI_MakeCylinder(5.0, 10.0).Shape(), tmp_path / "pin.step")
    text = file.read_text()
    loose = re.sub(r"(CYLINDRICAL_SURFACE\('',#\d+,)5\.", r"\g<1>5.0026", text)
    assert loose != text
    file.write_text(loose)
    part = read_part(file)
    assert part.edge_gap_mm == pytest.approx(0.0026, abs=1e-5)
    assert 0.0026 < part.deviation_inward < 0.005
    assert any("lie up to 0.0026 mm off its surface" in note for note in part.notes)
    file.write_text(text)
    assert read_part(file).edge_gap_mm < 1e-6


def test_damage_is_named(tmp_path: Path) -> None:
    """The text is checked before the kernel reads it: it would read a part of the file without a word."""
    with pytest.raises(GeometryError, match="cut short"):
        read_part(truncated(tmp_path))
    with pytest.raises(GeometryError, match="does not begin with ISO"):
        read_part(written("t.step", b"hello\n" * 50)(tmp_path))
    with pytest.raises(GeometryError, match="it is an STL file") as caught:
        read_part(written("t.step", b"solid x\nfacet normal 0 0 1\n" * 50)(tmp_path))
    assert "ending .stl" in caught.value.hint


def test_a_cut_brep_file_is_refused(tmp_path: Path) -> None:
    """The kernel reads on behind its end for ever, wherever it is cut."""
    from OCP.BRepTools import BRepTools

    BRepTools.Write_s(BRepPrimAPI_MakeCylinder(5.0, 10.0).Shape(), str(tmp_path / "pin.brep"))
    whole = (tmp_path / "pin.brep").read_bytes()
    for share in (0.2, 0.5, 0.8, 0.95):
        with pytest.raises(GeometryError, match="cut short") as caught:
            read_part(written("cut.brep", whole[: int(share * len(whole))])(tmp_path))
        assert caught.value.code == "part-damaged"
    assert read_part(tmp_path / "pin.brep").is_closed


def test_a_foreign_byte_is_named_by_its_line(tmp_path: Path) -> None:
    """The kernel may end the whole process on it; in names it is what many systems write."""
    text = write_step(box(), tmp_path / "box.step").read_bytes()
    at = text.index(b"CARTESIAN_POINT")
    with pytest.raises(GeometryError, match=f"line {text.count(bytes([10]), 0, at) + 1} holds a byte"):
        read_part(written("bad.step", text[:at] + b"\xa6" + text[at + 1 :])(tmp_path))
    named = text.replace(b"'Open CASCADE", "'Gehäuse".encode("latin-1"), 1)
    assert named != text and read_part(written("named.step", named)(tmp_path)).is_closed


@pytest.mark.parametrize("make", [huge, tiny])
def test_absurd_sizes_are_refused_before_meshing(make: Any, tmp_path: Path) -> None:
    """Meshing a part read in the wrong units would take forever: the reader itself stops it."""
    phases: list[str] = []
    with pytest.raises(GeometryError, match="check its units"):
        read_part(make(tmp_path), progress=lambda phase, _: phases.append(phase))
    assert phases == ["read"]
