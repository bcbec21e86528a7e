"""`styluscam part show`, and the pictures of parts and paths."""

from __future__ import annotations

import json

import numpy as np
import pytest

import styluscam as sc
from styluscam.drawing.raster import View, rasterise

from .conftest import FIXTURES


@pytest.mark.parametrize("name", ["cone_cup", "cap_r60", "vwaf", "pyramid"])
def test_faces_are_those_of_the_fixture(cli, name):
    truth = json.loads((FIXTURES / f"{name}.json").read_text())
    document = cli("part", "show", FIXTURES / f"{name}.step", "--json").json
    assert len(document["faces"]) == len(truth["faces"])
    assert document["closed"] and document["units"].startswith("milli")
    for shown, true in zip(document["faces"], sorted(truth["faces"], key=lambda face: face["index"]), strict=True):
        assert shown["name"] == f"Face{true['index']}" and shown["kind"] == true["kind"]
        assert shown["area_mm2"] == pytest.approx(float(true["area"]), rel=1e-6)
        assert shown["centre"] == pytest.approx([float(x) for x in true["centre"]], abs=1e-6)
        slopes = [shown["slope_min_deg"], shown["slope_max_deg"]]
        assert slopes == pytest.approx([float(s) for s in true["slope_deg"]], abs=0.6)
    assert document["box_min"] == pytest.approx(truth["box"][0], abs=1e-6)
    assert document["box_max"] == pytest.approx(truth["box"][1], abs=1e-6)


def test_table_has_a_row_for_each_face(cli):
    ran = cli("part", "show", FIXTURES / "cone_cup.step")
    assert ran.code == 0 and ran.err == ""
    rows = {line.split()[0]: line.split() for line in ran.out.splitlines() if line.startswith("Face")}
    assert list(rows) == [f"Face{number}" for number in range(1, 11)]
    assert rows["Face3"] == ["Face3", "cone", "5361.9", "0.000", "0.000", "-10.545", "45.0"]
    assert rows["Face2"][-3:] == ["0.0", "to", "45.0"]
    assert "X -50.000 to 50.000, Y -50.000 to 50.000, Z -30.000 to 0.000 mm" in ran.out
    assert "closed" in ran.out and "-0.000" not in ran.out


def test_quiet_shows_nothing(cli):
    assert cli("part", "show", FIXTURES / "cone_cup.step", "-q").out == ""


def test_open_mesh_is_stated_to_be_open(cli, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    block = trimesh.creation.box((40.0, 30.0, 10.0))
    block.update_faces(np.arange(len(block.faces)) > 1)
    block.export(tmp_path / "open.stl")
    ran = cli("part", "show", tmp_path / "open.stl", "--units", "mm")
    assert ran.code == 0 and "open" in ran.out and "note" in ran.out


def test_picture_shows_the_part(cli, tmp_path):
    from matplotlib.image import imread

    path = tmp_path / "new" / "cup.png"
    ran = cli("part", "show", FIXTURES / "cone_cup.step", "--picture", path)
    assert ran.code == 0 and "cup.png" in ran.out
    image = imread(path)
    assert image.shape[:2] == (800, 1200)
    inked = (image[..., :3] < 0.95).any(axis=2)
    assert 0.15 < inked[:, :600].mean() < 0.8 and 0.15 < inked[:, 600:].mean() < 0.8
    assert [file.name for file in path.parent.iterdir()] == ["cup.png"]


@pytest.mark.parametrize("name", ["cone_cup", "cap_r60", "vwaf", "pyramid"])
def test_every_face_gets_a_name_and_no_two_overlap(name, tmp_path, monkeypatch):
    from styluscam.drawing import picture
    from styluscam.parts.reading import read_part

    kept = []
    monkeypatch.setattr(picture, "save", lambda figure, path: kept.append(figure))
    arrays = read_part(FIXTURES / f"{name}.step", 0.05)
    picture.part_picture(arrays, tmp_path / "part.png")
    (figure,) = kept
    figure.canvas.draw()
    names = [text for axes in figure.axes for text in axes.texts if text.get_text().startswith("Face")]
    assert sorted(text.get_text() for text in names) == sorted(face.name for face in arrays.faces)
    boxes = [text.get_window_extent() for text in names]
    for i, box in enumerate(boxes):
        assert box.x0 >= 0 and box.x1 <= 1200 and box.y0 >= 0 and box.y1 <= 800
        for other in boxes[:i]:
            assert not box.overlaps(other)


def test_path_behind_a_wall_is_hidden(tmp_path, monkeypatch):
    from styluscam.drawing import picture

    kept = []
    monkeypatch.setattr(picture, "save", lambda figure, path: kept.append(figure))
    part = sc.Part.read(FIXTURES / "cone_cup.step", 0.05)
    machine = sc.Machine.shipped("linuxcnc")
    text = "G21 G90 G54\nT1 M6\nG0 X-10 Y-10 Z5\nG1 Z{z} F100\nX10\nY10\nX-10\nY-10\nM2\n"
    shown = []
    for z in (-5.0, -40.0):  # above the floor of the cup, and below the block
        program = sc.read_gcode(text.format(z=z), machine)
        picture.program_picture(part, program, tmp_path / "p.png")
        lines = [c for axes in kept[-1].axes for c in axes.collections if c.get_array() is not None]
        shown.append(sum(len(line.get_segments()) for line in lines[:1]))
    assert shown[0] > 40 and shown[1] < shown[0] / 2


def test_rasteriser_sees_the_nearer_of_two_squares():
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    vertices = np.concatenate([2.0 * square, square + np.array([0.0, 0.0, 3.0])])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    raster = rasterise(View(-90.0, 90.0, 100, 80, scale=10.0), vertices, triangles)
    assert (raster.triangle >= 0).sum() == 40 * 40
    assert (raster.triangle >= 2).sum() == 20 * 20
    assert raster.depth[40, 50] == pytest.approx(3.0) and raster.depth[25, 35] == pytest.approx(0.0)
    assert raster.weights[raster.triangle >= 0].sum(axis=1) == pytest.approx(1.0)
    behind = np.array([[50.0, 40.0, 1.0], [50.0, 40.0, 3.5], [35.0, 25.0, 0.0], [500.0, 40.0, -9.0]])
    assert raster.hides(behind, 0.1).tolist() == [True, False, False, False]


def test_rasteriser_gives_the_same_in_many_parts(monkeypatch):
    from styluscam.drawing import raster

    generator = np.random.default_rng(7)
    vertices = generator.uniform(-1.0, 1.0, (90, 3))
    triangles = np.arange(90).reshape(-1, 3)
    view = View(30.0, 40.0, 120, 90, scale=30.0)
    whole = rasterise(view, vertices, triangles)
    monkeypatch.setattr(raster, "FRAGMENTS", 500)
    parts = rasterise(view, vertices, triangles)
    assert np.array_equal(whole.triangle, parts.triangle) and np.array_equal(whole.depth, parts.depth)


def test_a_part_without_arrays_cannot_be_drawn(tmp_path):
    from styluscam.drawing.picture import part_picture

    part = sc.Part.from_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(sc.GeometryError, match=r"Part\.read|from a file"):
        part_picture(part, tmp_path / "p.png")


def test_without_matplotlib_the_extra_is_named(cli, tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib", None)
    ran = cli("part", "show", FIXTURES / "cone_cup.step", "--picture", tmp_path / "p.png")
    assert ran.code == 2 and ran.err.count("\n") == 1 and "styluscam[plot]" in ran.err
    assert not list(tmp_path.iterdir())
