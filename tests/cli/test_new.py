"""`styluscam new`: a commented job for any STEP, that runs as it stands."""

from __future__ import annotations

import re

import numpy as np
import pytest

import styluscam as sc

from .conftest import FIXTURES, write_step


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


def of(job, name):
    """The operation of a name."""
    (found,) = [operation for operation in sc.Job.read(job).document["operations"] if operation["id"] == name]
    return found


def coarser(job):
    """The job with fewer levels, rows and triangles, as far as steps may go: that it runs is asked here, not what it makes."""
    text = job.read_text()
    for key, times in (("height", 5.0), ("stepover", 4.0), ("smallest_feature", 10.0)):

        def larger(found, key=key, times=times):
            return f"{key} = {min(times * float(found[1]), 100.0):.6g}"

        text = re.sub(rf"{key} = ([\d.e-]+)", larger, text)
    job.write_text(text)


@pytest.mark.parametrize("name", NAMES)
def test_new_job_of_any_solid_runs(parts, cli, name):
    made = cli("new", parts / f"{name}.step", "--force")
    assert made.code == 0, made.err
    job = parts / f"{name}.toml"
    assert "styluscam run" in made.out and job.is_file()
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]
    assert ran.json["summary"]["operations"][0]["facts"][1]["value"] >= 1


def test_feeds_and_spindle_are_for_the_material_with_the_source_beside_them(parts, cli):
    job, part = parts / "of steel.toml", parts / "box.step"
    made = cli("new", part, "--material", "mild-steel", "--out", job)
    assert made.code == 0, made.err
    document = sc.Job(job).document
    assert document["process"]["material"] == "steel"
    tool = document["tools"]["cutter"]
    assert (tool["profile"], tool["flutes"], tool["cutter_material"]) == (
        {"kind": "flat", "diameter": 10.0, "tip_flat": 0.0}, 2, "carbide"
    )  # fmt: skip
    # no wider than the tool of the roughing; 230 m/min and 0.08 mm per tooth: 7321 rev/min, at 7300 of them 1168 mm/min
    operation = of(job, "walls")
    assert (operation["spindle"]["rpm"], operation["feeds"]["cut"], operation["feeds"]["plunge"]) == (
        7300.0,
        1160.0,
        580.0,
    )
    text = job.read_text().replace("\n#  ", "")
    assert re.search(r'# - source: .*atagroup.*"Unalloyed steel < 500 N/mm2"\nfeeds = ', text)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]


def test_a_table_of_one_s_own_is_named_in_the_job(parts, cli):
    table = parts / "shop.toml"
    table.write_text(
        '[[materials]]\nname = "our brass"\n[[materials.data]]\ncutter = "carbide"\nwork = ["finish-milling"]\n'
        "rpm = 60\nchip_mm = [[10, 0.05]]\n"
    )
    job = parts / "of brass.toml"
    made = cli("new", parts / "box.step", "--material", "our brass", "--cutting-data", table, "--out", job)
    assert made.code == 0, made.err
    document = sc.Job(job).document
    assert document["process"] == {
        "kind": "milling", "material": "our brass", "cutting_data": "shop.toml", "max_unreached": 0.1
    }  # fmt: skip
    operation = of(job, "walls")
    assert (operation["spindle"]["rpm"], operation["feeds"]["cut"]) == (
        60.0,
        6.0,
    )  # two teeth of 0.05 mm
    assert "# - source: the shop's table" in job.read_text()
    # the table states nothing for roughing: it is left out, and why
    assert [operation["kind"] for operation in document["operations"]] == ["z-level", "zig-zag"]
    assert 'no operation "roughing"' in job.read_text()


def plate_with_a_pocket(length):
    """Thickness 40 mm, with an upright pocket whose corners have a radius of 10 mm."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_IndexedMapOfShape

    inner = BRepPrimAPI_MakeBox(gp_Pnt(60.0, 60.0, 20.0), 300.0, 200.0, 40.0).Shape()
    edges = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(inner, TopAbs_ShapeEnum.TopAbs_EDGE, edges)
    rounded = BRepFilletAPI_MakeFillet(inner)
    for number in (1, 3, 5, 7):  # the upright ones
        rounded.Add(10.0, TopoDS.Edge_s(edges.FindKey(number)))
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(length, 500.0, 40.0).Shape(), rounded.Shape()).Shape()


@pytest.mark.parametrize(("length", "rougher"), [(900.0, 20.0), (1100.0, 100.0)])
def test_large_parts_are_roughed_with_inserts(tmp_path, cli, length, rougher):
    part = tmp_path / "plate.step"
    write_step(plate_with_a_pocket(length), part)
    made = cli("new", part)
    assert made.code == 0, made.err
    tools = sc.Job.read(tmp_path / "plate.toml").document["tools"]
    assert tools["rougher"]["profile"]["diameter"] == rougher
    text = re.sub(r"\n# *", " ", (tmp_path / "plate.toml").read_text())
    assert ("one with inserts" in text) == (rougher > 20.0)


def test_cutters_are_no_wider_than_the_material_s_data_allow(tmp_path, cli):
    """Routers in wood turn at 18,000 rev/min whatever their diameter."""
    part = tmp_path / "panel.step"
    write_step(plate_with_a_pocket(1100.0), part)
    made = cli("new", part, "--material", "wood")
    assert made.code == 0, made.err
    tools = sc.Job.read(tmp_path / "panel.toml").document["tools"]
    assert max(tool["profile"]["diameter"] for tool in tools.values()) <= 25.4


def test_an_unknown_material_lists_the_known_ones(parts, cli):
    ran = cli("new", parts / "box.step", "--material", "unobtainium", "--out", parts / "none.toml")
    assert ran.code == 2 and '"stainless" (stainless steel, austenitic)' in ran.err
    assert not (parts / "none.toml").exists()


def test_new_job_runs_as_it_stands_where_levels_end_at_jumps(parts, cli):
    """The posts of the bracket's walls are vertical: levels end where the tool would fall past their rounded feet."""
    job = parts / "bracket as it stands.toml"
    assert cli("new", parts / "filleted bracket.step", "--out", job).code == 0
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]
    (operation,) = [operation for operation in ran.json["summary"]["operations"] if operation["kind"] == "z-level"]
    # of a flat tool: a fifth of its diameter apart
    assert operation["id"] == "flat-walls" and operation["facts"][1]["value"] >= 20
    assert ran.json["summary"]["excess_max"] <= of(job, operation["id"])["tolerance"]


@pytest.mark.parametrize("name", ["cone_cup", "cap_r60", "vwaf", "pyramid"])
def test_new_job_of_every_fixture_runs(tmp_path, cli, name):
    job = tmp_path / f"{name}.toml"
    assert cli("new", FIXTURES / f"{name}.step", "--out", job).code == 0
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]


def test_new_job_is_commented_and_lists_faces(parts, cli, tmp_path):
    out = tmp_path / "sub" / "mine.toml"
    made = cli("new", parts / "box.step", "--out", out, "--json").json
    assert made["written"] == [str(out)] and "it is milled" in made["reasons"][0]
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


def test_new_for_a_mesh_states_how_large_it_would_be(parts, cli):
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box((4.0, 3.0, 1.0)).export(parts / "small.stl")
    ran = cli("new", parts / "small.stl")
    assert ran.code == 2 and ran.err.count("\n") == 1
    assert "4 x 3 x 1 mm" in ran.err and "101.6 x 76.2 x 25.4 mm" in ran.err and "--units in" in ran.err


def mesh_of(upper, lower=None, size=60.0, nodes=61):
    """A square between two height fields with its rim; an open surface without a lower one."""
    trimesh = pytest.importorskip("trimesh")
    at = np.linspace(-0.5 * size, 0.5 * size, nodes)
    x, y = (each.ravel() for each in np.meshgrid(at, at))
    points = [np.column_stack([x, y, upper(x, y)])]
    number = np.arange(nodes * nodes).reshape(nodes, nodes)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    top = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    triangles = [top]
    if lower is not None:
        points.append(np.column_stack([x, y, lower(x, y)]))
        ring = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
        low, on, over = ring + nodes * nodes, np.roll(ring, -1), np.roll(ring, -1) + nodes * nodes
        triangles += [top[:, ::-1] + nodes * nodes, np.stack([low, over, on], -1), np.stack([low, on, ring], -1)]
    return trimesh.Trimesh(np.concatenate(points), np.concatenate(triangles), process=False)


def cup(x, y):
    """A wall of 31 degrees, 6 mm deep, with a flange."""
    return np.clip(0.6 * (np.hypot(x, y) - 24.0), -6.0, 0.0)


def made(parts, cli, name, mesh):
    """The document and the reasons that `new` writes for a mesh."""
    mesh.export(parts / f"{name}.stl")
    ran = cli("new", parts / f"{name}.stl", "--units", "mm", "--force", "--json")
    assert ran.code == 0, ran.out
    return sc.Job.read(parts / f"{name}.toml").document, " ".join(ran.json["reasons"])


def test_a_sheet_is_formed_with_its_own_thickness(parts, cli):
    document, reasons = made(parts, cli, "sheet", mesh_of(cup, lambda x, y: cup(x, y) - 0.8))
    assert document["process"]["kind"] == "spif" and document["part"]["model_face"] == "tool"
    assert document["setup"]["sheet"]["thickness"] == pytest.approx(0.8, abs=0.09)
    assert [operation["kind"] for operation in document["operations"]] == ["z-level"]
    assert "a sheet 0." in reasons and "it is formed" in reasons
    coarser(parts / "sheet.toml")
    assert cli("run", parts / "sheet.toml").code == 0


def test_a_sheet_too_thick_to_form_is_milled(parts, cli):
    dish = lambda x, y: np.clip(0.2 * (np.hypot(x, y) - 100.0), -15.0, 0.0)  # noqa: E731
    document, reasons = made(parts, cli, "thick", mesh_of(dish, lambda x, y: dish(x, y) - 8.0, size=300.0))
    assert document["process"]["kind"] == "milling" and "6 mm that a stylus forms" in reasons


def test_what_no_tool_gets_to_is_let_pass_by_name(parts, cli):
    """Pits, a node wide and deep as ten, that are narrower than any tool for a part of this size."""
    pits = -10.0 * (np.random.default_rng(3).random(31 * 31) < 0.15)
    document, reasons = made(parts, cli, "pits", mesh_of(lambda x, _: pits, lambda x, _: 0.0 * x - 20.0, nodes=31))
    limit = document["process"]["max_unreached"]
    assert 0.1 < limit <= 0.3 and f"max_unreached = {limit}" in reasons
    coarser(parts / "pits.toml")
    ran = cli("run", parts / "pits.toml", "--json")
    assert ran.code == 0, ran.out[-2000:]


def test_run_takes_what_new_read_ahead(parts, cli, monkeypatch, tmp_path):
    monkeypatch.setenv("STYLUSCAM_CACHE", str(tmp_path))
    assert cli("new", parts / "box.step", "--out", parts / "ahead.toml", "--force").code == 0

    def read_brep(*_):
        raise AssertionError("read again")

    monkeypatch.setattr("styluscam.parts.reading.read_brep", read_brep)
    ran = cli("run", parts / "ahead.toml", "--json")
    assert ran.code == 0, ran.out[-2000:]


def test_a_sheet_that_opens_downward_is_turned_over(parts, cli):
    document, reasons = made(parts, cli, "over", mesh_of(lambda x, y: -cup(x, y), lambda x, y: -cup(x, y) - 0.8))
    assert document["process"]["kind"] == "spif" and document["setup"]["up"] == "-z"
    assert "turns it over" in reasons
    coarser(parts / "over.toml")
    assert cli("run", parts / "over.toml").code == 0


def test_an_open_surface_is_formed_where_a_sheet_can_follow_and_milled_where_not(parts, cli):
    document, reasons = made(parts, cli, "surface", mesh_of(cup))
    assert document["process"]["kind"] == "spif" and "an open surface" in reasons
    document, reasons = made(parts, cli, "hill", mesh_of(lambda x, y: -cup(x, y)))
    assert document["process"]["kind"] == "milling" and "only pushes down" in reasons and "6.0 mm below" in reasons
    assert "if it should be a solid" in reasons


def test_a_flat_plate_and_one_with_upright_walls_are_no_sheets_to_form(parts, cli):
    document, reasons = made(parts, cli, "plate", mesh_of(lambda x, _: 0.0 * x, lambda x, _: 0.0 * x - 1.0))
    assert document["process"]["kind"] == "milling" and "it is flat" in reasons
    pit = lambda x, y: np.where(np.maximum(np.abs(x), np.abs(y)) < 20.5, -20.0, 0.0)  # noqa: E731
    document, reasons = made(parts, cli, "tray", mesh_of(pit))
    assert document["process"]["kind"] == "milling" and "tear a sheet" in reasons


def test_a_part_that_is_cut_from_below_is_turned_over(parts, cli):
    pocket = mesh_of(lambda x, _: 0.0 * x, lambda x, y: -20.0 - 2.0 * cup(x, y))
    document, reasons = made(parts, cli, "below", pocket)
    assert document["setup"]["up"] == "-z" and "hidden from +z" in reasons
    text = (parts / "below.toml").read_text(encoding="utf-8")
    listed = dict(re.findall(r"#   (Face\d+): .* slope (\d+) to", text))
    named = [face for operation in document["operations"] for face in operation.get("faces") or ()]
    assert named and all(float(listed[face]) <= 90.0 for face in named), "slopes as the part lies"


def test_the_tool_fits_the_fillets(parts, cli):
    """R4 along the feet of two ribs in a plate: a D20 ball, as the plate's size has it, would bridge them."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_IndexedMapOfShape

    plate = BRepPrimAPI_MakeBox(200.0, 150.0, 10.0).Shape()
    rib = BRepPrimAPI_MakeBox(gp_Pnt(0.0, 65.0, 0.0), 200.0, 20.0, 40.0).Shape()
    fused = BRepAlgoAPI_Fuse(plate, rib)
    fused.SimplifyResult()
    rounded = BRepFilletAPI_MakeFillet(fused.Shape())
    edges = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(fused.Shape(), TopAbs_ShapeEnum.TopAbs_EDGE, edges)
    for number in range(1, edges.Extent() + 1):
        edge = TopoDS.Edge_s(edges.FindKey(number))
        if is_foot(edge):
            rounded.Add(4.0, edge)
    write_step(rounded.Shape(), parts / "ribs.step")
    ran = cli("new", parts / "ribs.step", "--force", "--json")
    assert ran.code == 0, ran.out
    document = sc.Job.read(parts / "ribs.toml").document
    tool = document["tools"]["cutter"]
    assert tool["profile"] == {**tool["profile"], "kind": "ball", "diameter": 8.0}
    assert "a radius of 4.0" in " ".join(ran.json["reasons"])
    # the upright sides in levels, the rest in rows, no face in both
    assert [operation["kind"] for operation in document["operations"]] == ["pocket", "z-level", "zig-zag"]
    _, walls, floors = (operation.get("faces") for operation in document["operations"])
    assert not set(walls) & set(floors)


def splined(height):
    """A plate whose outline is one closed spline."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.GeomAPI import GeomAPI_Interpolate
    from OCP.gp import gp_Pnt, gp_Vec
    from OCP.TColgp import TColgp_HArray1OfPnt

    angles = np.arange(12) * np.pi / 6.0
    points = TColgp_HArray1OfPnt(1, len(angles))
    for number, (angle, radius) in enumerate(zip(angles, 25.0 + 6.0 * np.cos(2.0 * angles), strict=True), start=1):
        points.SetValue(number, gp_Pnt(float(radius * np.cos(angle)), float(radius * np.sin(angle)), 0.0))
    curve = GeomAPI_Interpolate(points, True, 1e-9)
    curve.Perform()
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve.Curve()).Edge()).Wire()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire).Face(), gp_Vec(0.0, 0.0, height)).Shape()


def test_a_curved_upright_wall_is_a_wall(parts, cli):
    """Its triangles lean by their deviation, to either side: it does not face down."""
    write_step(splined(12.0), parts / "splined.step")
    ran = cli("new", parts / "splined.step", "--force", "--json")
    assert ran.code == 0, ran.out
    assert "cannot be reached" not in " ".join(ran.json["reasons"])
    document = sc.Job.read(parts / "splined.toml").document
    tool = document["tools"]["cutter"]
    assert document["setup"]["up"] == "+z" and tool["profile"]["kind"] == "flat"
    assert [len(operation["faces"]) for operation in document["operations"][1:]] == [1, 1]
    done = cli("run", parts / "splined.toml", "--json")
    assert done.code == 0, done.out[-2000:]
    _, walls, _ = done.json["summary"]["operations"]
    assert walls["wall_angle_max_deg"] == pytest.approx(90.0, abs=1e-6)
    assert walls["reached"][0]["contact"] > 0.99 * sum(v for k, v in walls["reached"][0].items() if k != "face")


def test_a_hole_across_is_named(parts, cli):
    """No tool from above gets into it: it would be left without a word."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    across = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(30.0, 0.0, 15.0), gp_Dir(0.0, 1.0, 0.0)), 5.0, 40.0).Shape()
    write_step(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(60.0, 40.0, 30.0).Shape(), across).Shape(), parts / "across.step")
    ran = cli("new", parts / "across.step", "--force", "--json")
    (stated,) = [reason for reason in ran.json["reasons"] if "lies under other faces" in reason]
    (named,) = re.findall(r"Face\d+", stated)
    assert f"#   {named}: cylinder" in (parts / "across.toml").read_text(encoding="utf-8")


def test_a_plate_is_roughed_drilled_and_finished(cli, tmp_path):
    """Holes of three diameters, each with its own drill; the program removes the stock, by the verifier's account."""
    job = tmp_path / "drilled.toml"
    made = cli("new", FIXTURES / "drilled.step", "--out", job, "--json")
    assert made.code == 0, made.out
    document = sc.Job.read(job).document
    kinds = [operation["kind"] for operation in document["operations"]]
    assert kinds[0] == "pocket" and kinds.count("drill") == 3 and kinds[-1] in ("z-level", "zig-zag")
    assert kinds == sorted(kinds, key=["pocket", "drill", "z-level", "zig-zag"].index)
    assert document["setup"]["stock"]["kind"] == "box" and document["setup"]["stock"]["top"] > 0.0
    rough = document["operations"][0]
    assert rough["radial_stock_to_leave"] > 0.0 < rough["axial_stock_to_leave"]
    drills = {o["id"]: document["tools"][o["tool"]]["profile"]["diameter"] for o in document["operations"][1:4]}
    assert drills == {"holes-5": 5.0, "holes-6.8": 6.8, "holes-11": 11.0}
    # what is drilled is not roughed, nor is the hole across
    drilled = {face for operation in document["operations"][1:4] for face in operation["faces"]}
    assert len(drilled) == 9 and not drilled & set(rough["faces"])
    # a drill's point leaves a cone on the shoulder of the counterbore, which finishing takes, and its wall
    (wall,) = next(o for o in document["operations"] if o["id"] == "holes-11")["faces"]
    assert wall in next(o for o in document["operations"] if o["kind"] == "z-level")["faces"]
    assert wall not in rough["faces"]
    assert any("finishing takes it" in reason for o in made.json["operations"] for reason in o["reasons"])
    # every operation states why it is there, in the job and for scripts
    text = job.read_text()
    assert [operation["id"] for operation in made.json["operations"]] == [o["id"] for o in document["operations"]]
    for operation in made.json["operations"]:
        assert operation["reasons"]
        start = text.index(f'id = "{operation["id"]}"')
        assert "# - " + operation["reasons"][0][:30] in text[start : start + 200]
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]
    assert ran.json["report"]["ok"]


def test_pockets_of_a_part_for_a_ball_are_finished_with_a_flat_tool(parts, cli):
    """A countersink asks for a ball; level floors and upright walls within sharp edges are a flat tool's."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    solid = BRepPrimAPI_MakeBox(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(70.0, 50.0, 14.0)).Shape()
    for low, high in (((20.0, 10.0, 9.0), (50.0, 40.0, 15.0)), ((26.0, 16.0, 4.0), (44.0, 34.0, 10.0))):
        solid = BRepAlgoAPI_Cut(solid, BRepPrimAPI_MakeBox(gp_Pnt(*low), gp_Pnt(*high)).Shape()).Shape()
    for x in (9.0, 61.0):
        sink = BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(x, 25.0, 8.0), gp_Dir(0.0, 0.0, 1.0)), 0.5, 6.5, 6.0).Shape()
        solid = BRepAlgoAPI_Cut(solid, sink).Shape()
    writer = STEPControl_Writer()
    writer.Transfer(solid, STEPControl_AsIs)
    writer.Write(str(parts / "pockets.step"))
    made = cli("new", parts / "pockets.step", "--out", parts / "pockets.toml", "--force", "--json")
    assert made.code == 0, made.out
    document = sc.Job.read(parts / "pockets.toml").document
    works = {operation["id"]: operation for operation in document["operations"]}
    profiles = {name: document["tools"][works[name]["tool"]]["profile"] for name in works}
    # of both pockets and of the part
    assert len(works["flat-walls"]["faces"]) == 12 and 1 <= len(works["flat-floors"]["faces"]) <= 2
    assert profiles["flat-walls"] == profiles["flat-floors"] and profiles["floors"]["kind"] == "ball"
    assert profiles["flat-walls"]["kind"] == "flat"
    assert profiles["flat-walls"]["diameter"] <= profiles["roughing"]["diameter"]
    finished = [face for name in works if name != "roughing" for face in works[name]["faces"]]
    assert len(finished) == len(set(finished))
    ran = cli("run", parts / "pockets.toml", "--json")
    assert ran.code == 0 and ran.json["report"]["ok"], ran.out[-2000:]


def test_holes_deeper_than_three_diameters_are_pecked(parts, cli):
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    def hole(x, radius, depth):
        axis = gp_Ax2(gp_Pnt(x, 20.0, 30.0 - depth), gp_Dir(0.0, 0.0, 1.0))
        return BRepPrimAPI_MakeCylinder(axis, radius, depth).Shape()

    block = BRepPrimAPI_MakeBox(60.0, 40.0, 30.0).Shape()
    for x, radius, depth in ((10.0, 2.0, 11.9), (30.0, 2.5, 30.0), (50.0, 1.615, 8.0)):
        block = BRepAlgoAPI_Cut(block, hole(x, radius, depth)).Shape()
    write_step(block, parts / "deep.step")
    job = parts / "deep.toml"
    assert cli("new", parts / "deep.step", "--out", job, "--force").code == 0
    cycles = {
        o["id"]: (o["cycle"]["kind"], o["cycle"].get("peck"))
        for o in sc.Job.read(job).document["operations"]
        if o["kind"] == "drill"
    }
    assert cycles == {"holes-3.2": ("drill", None), "holes-4": ("drill", None), "holes-5": ("peck", 5.0)}
    # 3.23 mm: no drill has that size
    assert of(job, "holes-3.2")["diameter_tolerance"] == pytest.approx(0.03, abs=2e-3)
    assert "ream or bore" in job.read_text() and "a cone on flat floors" in job.read_text().replace("\n#  ", "")
    coarser(job)
    ran = cli("run", job, "--json")
    assert ran.code == 0, ran.out[-2000:]


def is_foot(edge):
    """Whether an edge lies along X on the plate, at the rib."""
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(edge, box, False, False)
    low_x, low_y, low_z, high_x, high_y, high_z = box.Get()
    return high_x - low_x > 100.0 and abs(low_z - 10.0) < 1e-3 > abs(high_z - 10.0) and 60.0 < low_y < 90.0 > high_y


def test_slopes_that_roughing_leaves_in_high_steps_are_cut_by_wider_balls_before_the_finishing(cli, tmp_path):
    part = FIXTURES / "corpus" / "slice" / "terrain-00.stl"
    job = tmp_path / "terrain.toml"
    assert cli("new", part, "--units", "mm", "--out", job).code == 0
    document = sc.Job.read(job).document
    works = {operation["id"]: operation for operation in document["operations"]}
    assert list(works) == ["roughing", "semi-finishing", "semi-finishing-2", "walls", "floors"]
    profiles = [document["tools"][operation["tool"]]["profile"] for operation in works.values()]
    assert [profile["kind"] for profile in profiles] == ["flat", "ball", "ball", "ball", "ball"]
    widths = [profile["diameter"] for profile in profiles]
    assert widths == sorted(widths, reverse=True) and widths[1] > widths[2] > widths[3]
    for name in ("semi-finishing", "semi-finishing-2"):
        assert works[name]["radial_stock_to_leave"] == works[name]["axial_stock_to_leave"] > 0.0
        assert set(works[name]["faces"]) == {*works["walls"]["faces"], *works["floors"]["faces"]}
    text = job.read_text().replace("\n#   ", " ")
    assert re.search(r"# - the finishing tool of 2 mm would cut up to 1\d\.\d mm deep at once", text)


def test_the_roughing_tool_gets_to_where_the_finishing_tool_would_cut_too_deep(cli, tmp_path):
    """A gap of 6.2 mm around a pillar, 16 mm deep: a tool of 8 mm would leave all of it to one of 3 mm."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    block = BRepPrimAPI_MakeBox(120.0, 60.0, 20.0).Shape()
    pocket = BRepPrimAPI_MakeBox(gp_Pnt(10.0, 10.0, 4.0), 100.0, 22.4, 20.0).Shape()
    pillar = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(60.0, 21.2, 0.0), gp_Dir(0.0, 0.0, 1.0)), 5.0, 20.0).Shape()
    shape = BRepAlgoAPI_Fuse(BRepAlgoAPI_Cut(block, pocket).Shape(), pillar).Shape()
    write_step(shape, tmp_path / "gap.step")
    job = tmp_path / "gap.toml"
    assert cli("new", tmp_path / "gap.step", "--out", job).code == 0
    document = sc.Job.read(job).document
    assert document["tools"]["rougher"]["profile"]["diameter"] <= 6.0
    assert "semi-finisher" not in document["tools"]


def test_no_rows_are_proposed_over_upright_walls_alone(parts, cli):
    """A top too rough for any tool is left out: rows of balls over the walls around it would cut nothing."""
    noise = np.random.default_rng(2).uniform(0.0, 1.5, 81 * 81)
    hills = lambda x, y: 12.0 + 5.0 * np.sin(x / 3.0) * np.cos(y / 4.0) + noise  # noqa: E731
    document, reasons = made(parts, cli, "rough", mesh_of(hills, lambda x, y: 0.0 * x, size=30.0, nodes=81))
    assert "has too little room in these: Face1" in reasons
    assert [operation["id"] for operation in document["operations"]] == ["roughing", "walls"]
