"""`styluscam new`: a commented job for any STEP, that runs as it stands."""

from __future__ import annotations

import pytest

import styluscam as sc

from .conftest import FIXTURES, changed, write_step


def shapes():
    """Solids that a CAM person would not choose first."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
    from OCP.BRepPrimAPI import (
        BRepPrimAPI_MakeBox,
        BRepPrimAPI_MakeCone,
        BRepPrimAPI_MakeCylinder,
        BRepPrimAPI_MakeSphere,
        BRepPrimAPI_MakeTorus,
    )
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_IndexedMapOfShape

    fused = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeBox(60.0, 40.0, 8.0).Shape(), BRepPrimAPI_MakeBox(8.0, 40.0, 40.0).Shape())
    fused.SimplifyResult()  # no seams between faces of one plane: they cannot be rounded
    edges = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(fused.Shape(), TopAbs_ShapeEnum.TopAbs_EDGE, edges)
    rounded = BRepFilletAPI_MakeFillet(fused.Shape())
    for number in range(1, edges.Extent() + 1):
        rounded.Add(1.5, TopoDS.Edge_s(edges.FindKey(number)))
    lying = gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0))
    return {
        "box": BRepPrimAPI_MakeBox(60.0, 40.0, 20.0).Shape(),
        "sphere": BRepPrimAPI_MakeSphere(25.0).Shape(),
        "lying cylinder": BRepPrimAPI_MakeCylinder(lying, 15.0, 60.0).Shape(),
        "standing cylinder": BRepPrimAPI_MakeCylinder(15.0, 40.0).Shape(),
        "torus": BRepPrimAPI_MakeTorus(30.0, 10.0).Shape(),
        "cone": BRepPrimAPI_MakeCone(20.0, 0.0, 30.0).Shape(),
        "tiny plate": BRepPrimAPI_MakeBox(2.0, 2.0, 0.1).Shape(),
        "big block": BRepPrimAPI_MakeBox(1500.0, 900.0, 300.0).Shape(),
        "thin wall": BRepPrimAPI_MakeBox(100.0, 3.0, 50.0).Shape(),
        'with "quotes"': BRepPrimAPI_MakeBox(20.0, 20.0, 5.0).Shape(),
        "filleted bracket": rounded.Shape(),
    }


NAMES = (
    "box", "sphere", "lying cylinder", "standing cylinder", "torus", "cone", "tiny plate", "big block", "thin wall",
    'with "quotes"',
    "filleted bracket",
)  # fmt: skip


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shapes")
    for name, shape in shapes().items():
        write_step(shape, folder / f"{name}.step")
    return folder


def coarser(job):
    """The job with fewer levels, rows and triangles: that it runs is asked here, not what it makes."""
    operation = sc.Job.read(job).to_dict()["operations"][0]
    height, feature = operation["step"]["height"], operation["smallest_feature"]
    changes = [
        (f"step = {{ height = {height!r} }}", f"step = {{ height = {5 * height!r} }}"),
        (f"stepover = {height!r} ", f"stepover = {20 * height!r} "),
        (f"smallest_feature = {feature!r} ", f"smallest_feature = {20 * feature!r} "),
        ("tolerance = 0.001 ", "tolerance = 0.002 "),
    ]
    job.write_text(changed(job.read_text(), *changes))


@pytest.mark.parametrize("name", NAMES)
def test_new_job_of_any_solid_runs(parts, cli, name):
    made = cli("new", parts / f"{name}.step", "--force")
    assert made.code == 0, made.err
    job = parts / f"{name}.toml"
    assert "styluscam run" in made.out and job.is_file()
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]
    assert ran.json["summary"]["operations"][0]["passes"] >= 1


def test_new_job_runs_as_it_stands_where_levels_end_at_jumps(parts, cli):
    """The posts of the bracket's walls are vertical: levels end where the tool would fall past their rounded feet."""
    job = parts / "bracket as it stands.toml"
    assert cli("new", parts / "filleted bracket.step", "--out", job).code == 0
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]
    operation = ran.json["summary"]["operations"][0]
    assert operation["passes"] >= 27
    assert ran.json["summary"]["excess_max"] <= 0.005


def test_levels_follow_walls(parts, cli):
    job = parts / "walls.toml"
    assert cli("new", parts / "standing cylinder.step", "--out", job, "--force").code == 0
    text = changed(job.read_text(), ('faces = "all"', 'faces = ["Face1", "Face2"]'), ('"zig-zag"', '"z-level"'))
    job.write_text(text)
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.err
    operation = ran.json["summary"]["operations"][0]
    # from the rounding of the edge down to the floor that the tool's height leaves
    assert operation["groups"] >= 10
    assert operation["passes"] == operation["groups"]


@pytest.mark.parametrize("name", ["cone_cup", "cap_r60", "vwaf", "pyramid"])
def test_new_job_of_every_fixture_runs(tmp_path, cli, name):
    job = tmp_path / f"{name}.toml"
    assert cli("new", FIXTURES / f"{name}.step", "--out", job).code == 0
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]


def test_new_job_is_commented_and_lists_faces(parts, cli, tmp_path):
    out = tmp_path / "sub" / "mine.toml"
    assert cli("new", parts / "box.step", "--out", out, "--json").json == {"written": [str(out)]}
    text = out.read_text()
    assert text.count("#") > 15 and "Face6: plane, 2400 mm2" in text
    assert sc.Job.read(out).part().triangle_count == 12


def test_new_does_not_replace_a_file_unasked(parts, cli):
    job = parts / "mine.toml"
    job.write_text("mine")
    ran = cli("new", parts / "box.step", "--out", job)
    assert ran.code == 2 and "--force" in ran.err and ran.err.count("\n") == 1
    assert job.read_text() == "mine"
    assert cli("new", parts / "box.step", "--out", job, "--force").code == 0
    assert job.read_text() != "mine"


def test_new_for_a_mesh_asks_for_units_and_takes_them(parts, cli):
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box((40.0, 30.0, 10.0)).export(parts / "block.stl")
    ran = cli("new", parts / "block.stl")
    assert ran.code == 2 and "units" in ran.err
    assert cli("new", parts / "block.stl", "--units", "mm").code == 0
    coarser(parts / "block.toml")
    assert cli("run", parts / "block.toml").code == 0
