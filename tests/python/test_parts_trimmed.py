"""Faces on elementary surfaces: meshed by the engine, closed, within the tolerance, with their area."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("OCP", reason="needs the step extra")

from OCP.BRepAlgoAPI import BRepAlgoAPI_BuilderAlgo, BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_Transform
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pnt, gp_Trsf
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopTools import TopTools_ListOfShape

from styluscam.parts import meshing
from styluscam.parts.arrays import PartArrays, signed_volume
from styluscam.parts.reading import read_part
from styluscam.parts.trimmed import Edge, edge_points

TOLERANCE = 0.002


@pytest.fixture(autouse=True)
def read_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is asked here is what reading does, not what was kept of an earlier reading."""
    monkeypatch.setattr("styluscam.parts.cache.keep", lambda *_: None)
    monkeypatch.setattr("styluscam.parts.cache.kept", lambda *_: None)


def at(x: float, y: float, z: float, direction: tuple[float, float, float] = (0, 0, 1)) -> gp_Ax2:
    return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(*direction))


def box() -> Any:
    return BRepPrimAPI_MakeBox(gp_Pnt(-20, -15, -10), gp_Pnt(20, 15, 0)).Shape()


def drilled() -> Any:
    """Holes that cross: their edges are no circles."""
    shape = BRepAlgoAPI_Cut(box(), BRepPrimAPI_MakeCylinder(at(-30, 0, -5, (1, 0, 0)), 3.0, 60.0).Shape()).Shape()
    return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(at(4, 1, -20), 5.0, 40.0).Shape()).Shape()


def bitten() -> Any:
    """A sphere, a torus and a cone taken out of a block, so that each is cut by the others."""
    shape = BRepAlgoAPI_Cut(box(), BRepPrimAPI_MakeSphere(gp_Pnt(3, 2, 2), 7.0).Shape()).Shape()
    shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeTorus(at(-4, 0, 0), 9.0, 2.5).Shape()).Shape()
    return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCone(at(10, -4, -8), 1.0, 6.0, 8.5).Shape()).Shape()


def mirrored(shape: Any) -> Any:
    """Left-handed axes, and turned out of every plane."""
    mirror, turn = gp_Trsf(), gp_Trsf()
    mirror.SetMirror(at(1, 2, 3, (0.3, -0.5, 0.8)))
    turn.SetRotation(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0.2, 0.7, 0.4)).Axis(), 0.7)
    return BRepBuilderAPI_Transform(shape, turn.Multiplied(mirror), True).Shape()


def octant() -> Any:
    """An eighth of a sphere: a face with a corner on its pole."""
    return BRepPrimAPI_MakeSphere(at(1, 2, 3), 8.0, 0.0, math.pi / 2.0, math.pi / 2.0).Shape()


def lens() -> Any:
    balls = [BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, z), 10.0).Shape() for z in (-7.0, 7.0)]
    return BRepAlgoAPI_Common(*balls).Shape()


def slit() -> Any:
    """A ball with an edge within its face that is no border."""
    ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 12.0).Shape()
    equator = BRepBuilderAPI_MakeEdge(gp_Circ(at(0, 0, 0), 12.0), 0.5, 2.0).Edge()
    fused = BRepAlgoAPI_BuilderAlgo()
    arguments = TopTools_ListOfShape()
    for shape in (ball, equator):
        arguments.Append(shape)
    fused.SetArguments(arguments)
    fused.Build()
    solid = TopExp_Explorer(fused.Shape(), TopAbs_ShapeEnum.TopAbs_SOLID)
    return solid.Current()


SHAPES: dict[str, Callable[[], Any]] = {
    "box": box,
    "cylinder": lambda: BRepPrimAPI_MakeCylinder(at(1, 2, 3, (0.3, 0.2, 0.9)), 6.0, 90.0).Shape(),
    "cone to its apex": lambda: BRepPrimAPI_MakeCone(at(1, 2, 3, (0, 1, 0)), 7.0, 0.0, 12.0).Shape(),
    "cone that opens": lambda: BRepPrimAPI_MakeCone(at(0, 0, 0), 0.0, 7.0, 12.0).Shape(),
    "sphere": lambda: BRepPrimAPI_MakeSphere(gp_Pnt(1, 2, 3), 8.0).Shape(),
    "octant": octant,
    "slit": slit,
    "lens": lens,
    "torus": lambda: BRepPrimAPI_MakeTorus(at(1, 2, 3, (1, 0, 1)), 12.0, 4.0).Shape(),
    "half a torus": lambda: BRepPrimAPI_MakeTorus(at(0, 0, 0), 12.0, 4.0, 0.3, 2.0, 1.5).Shape(),
    "drilled": drilled,
    "bitten": bitten,
    "bitten, mirrored": lambda: mirrored(bitten()),
    "boss": lambda: BRepAlgoAPI_Fuse(box(), BRepPrimAPI_MakeSphere(gp_Pnt(5, 5, -3), 6.0).Shape()).Shape(),
}


def read(shape: Any, file: Path, tolerance: float = TOLERANCE) -> PartArrays:
    BRepTools.Write_s(shape, str(file))
    return read_part(file, tolerance=tolerance)


def volume_of(shape: Any) -> float:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return float(properties.Mass())


@pytest.mark.parametrize("name", SHAPES)
def test_the_engine_meshes_it(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: Any) -> None:
        raise AssertionError("the kernel's mesher was asked")

    shape = SHAPES[name]()
    theirs = volume_of(shape)
    monkeypatch.setattr(meshing, "_mesh", refused)
    part = read(shape, tmp_path / "part.brep")
    assert part.is_closed and part.notes == ()
    assert max(part.deviation_inward, part.deviation_outward) <= TOLERANCE
    area = sum(face.area_mm2 for face in part.faces)
    ours = signed_volume(part.vertices, part.triangles)
    assert abs(ours - theirs) <= TOLERANCE * area
    facets = np.cross(*(part.vertices[part.triangles[:, k]] - part.vertices[part.triangles[:, 0]] for k in (1, 2)))
    assert (np.einsum("ij,ij->i", facets, part.normals.mean(axis=1)) > 0.0).all()


def test_it_takes_fewer_triangles_than_the_kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shape = bitten()
    ours = len(read(shape, tmp_path / "part.brep").triangles)
    monkeypatch.setattr(meshing, "model_of", lambda *_: None)
    theirs = len(read(shape, tmp_path / "part.brep").triangles)
    assert ours < 0.8 * theirs


def test_what_does_not_close_is_left_to_the_kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An edge is left out: no triangles of ours, the kernel's instead."""
    real = meshing.model_of

    def spoilt(*arguments: Any) -> Any:
        model = real(*arguments)
        return type(model)(
            model.edges, [type(face)(face.value, face.middle, face.uses[1:], face.area) for face in model.faces]
        )

    monkeypatch.setattr(meshing, "model_of", spoilt)
    part = read(box(), tmp_path / "part.brep")
    assert part.is_closed and len(part.triangles) == 12


@pytest.mark.parametrize("radius", [0.001, 1.0, 500.0])
def test_chords_of_a_circle_hold_the_deflection(radius: float) -> None:
    circle = Edge(
        lambda t: (radius * math.cos(t), radius * math.sin(t), 0.0),
        (0.0, 2.0 * math.pi),
        ((radius, 0.0, 0.0), (radius, 0.0, 0.0)),
        radius,
    )
    points, fractions = edge_points(circle, 0.001)
    assert len(points) == len(fractions) >= 19
    sagitta = radius - np.linalg.norm((points[1:] + points[:-1]) / 2.0, axis=1)
    assert sagitta.max() <= 0.001 * (1.0 + 1e-9)


def test_any_curve_is_halved_where_it_bends() -> None:
    ellipse = Edge(
        lambda t: (20.0 * math.cos(t), 2.0 * math.sin(t), 0.0),
        (0.0, math.pi),
        ((20.0, 0.0, 0.0), (-20.0, 0.0, 0.0)),
        None,
    )
    points, fractions = edge_points(ellipse, 0.001)
    assert fractions == sorted(fractions) and len(set(fractions)) == len(fractions)
    for start, end in itertools.pairwise(fractions):
        a, b, middle = (np.array(ellipse.value(math.pi * t)) for t in (start, end, (start + end) / 2.0))
        share = float((middle - a) @ (b - a) / ((b - a) @ (b - a)))
        assert np.linalg.norm(middle - a - share * (b - a)) <= 0.0011
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.min() < 0.3 * steps.max()  # short at the sharp ends
