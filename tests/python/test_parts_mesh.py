"""Mesh files: units, welding, orientation, distances, and every bad input."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

import numpy as np
import pytest

from styluscam.errors import GeometryError
from styluscam.parts.facets import Facets
from styluscam.parts.reading import read_part

trimesh = pytest.importorskip("trimesh", reason="needs the mesh extra")


def cube(side: float = 10.0) -> trimesh.Trimesh:
    return trimesh.creation.box(extents=(side, side, side))


def export(mesh: trimesh.Trimesh, file: Path, kind: str | None = None) -> Path:
    mesh.export(str(file), file_type=kind)
    return file


@pytest.mark.parametrize(("ending", "kind"), [("stl", "stl"), ("stl", "stl_ascii"), ("obj", "obj"), ("ply", "ply")])
def test_cube(ending: str, kind: str, tmp_path: Path) -> None:
    part = read_part(export(cube(), tmp_path / f"cube.{ending}", kind), units="mm")
    assert part.is_closed and not part.notes
    assert (len(part.vertices), len(part.triangles)) == (8, 12)
    assert part.box == (pytest.approx((-5, -5, -5)), pytest.approx((5, 5, 5)))
    assert [face.area_mm2 for face in part.faces] == [pytest.approx(100.0)] * 6 and part.is_mesh
    assert {face.kind for face in part.faces} == {"plane"} and set(part.face_ids) == {1, 2, 3, 4, 5, 6}
    assert (part.faces[0].slope_max_deg, part.faces[5].slope_min_deg) == (pytest.approx(0.0), pytest.approx(180.0))
    assert (part.deviation_inward, part.deviation_outward) == (0.0, 0.0)
    corners = part.vertices[part.triangles]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.einsum("ij,ij->i", corners.mean(axis=1), facets).min() > 0.0
    assert part.normals[:, 0] == pytest.approx(facets / np.linalg.norm(facets, axis=1)[:, None])


@pytest.mark.parametrize(("units", "factor"), [("mm", 1.0), ("in", 25.4), ("inch", 25.4), ("m", 1000.0), ("cm", 10.0)])
def test_units_scale(units: str, factor: float, tmp_path: Path) -> None:
    part = read_part(export(cube(2.0), tmp_path / "c.stl"), units=units)
    assert part.box[1] == pytest.approx((factor, factor, factor))
    assert part.units == units


def test_3mf_carries_its_units(tmp_path: Path) -> None:
    pytest.importorskip("networkx")
    pytest.importorskip("lxml")
    file = export(cube(), tmp_path / "c.3mf")
    assert read_part(file).box[1] == pytest.approx((5, 5, 5))
    with pytest.raises(GeometryError, match="carries its units"):
        read_part(file, units="mm")


def test_wound_inward_is_turned(tmp_path: Path) -> None:
    mesh = cube()
    mesh.faces = mesh.faces[:, ::-1]
    part = read_part(export(mesh, tmp_path / "c.stl"), units="mm")
    assert "turned over" in part.notes[0]
    assert np.einsum("ij,ij->i", part.vertices[part.triangles].mean(axis=1), part.normals[:, 0]).min() > 0.0


def test_open_mesh_is_flagged(tmp_path: Path) -> None:
    mesh = cube()
    mesh.update_faces(mesh.face_normals[:, 2] < 0.5)
    part = read_part(export(mesh, tmp_path / "c.stl"), units="mm")
    assert not part.is_closed and "open" in part.notes[0] and len(part.triangles) == 10


def test_a_missing_triangle_is_made_again(tmp_path: Path) -> None:
    mesh = cube()
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    part = read_part(export(mesh, tmp_path / "c.stl"), units="mm")
    assert part.is_closed and len(part.triangles) == 12 and "1 hole, 14.1 mm wide at most" in part.notes[0]


def test_distance_to_facets(tmp_path: Path) -> None:
    part = read_part(export(cube(), tmp_path / "c.stl"), units="mm")
    points = np.array([(0, 0, 7), (0, 0, 4), (6, 6, 6), (6, 6, 0), (-8, 1, 2), (0, 0, 0)], dtype=float)
    found = part.surface_distance(points, np.ones(6, dtype=int))
    assert found == pytest.approx([2.0, -1.0, np.sqrt(3.0), np.sqrt(2.0), 3.0, -5.0])
    assert part.surfaces[0].normal(points[:1])[0] == pytest.approx((0, 0, 1))


def test_beyond_a_sharp_edge_is_outside() -> None:
    """Both sides of a thin wedge share the nearest point; seen from one alone the point would be inside."""
    vertices = np.array([(0, 0, 0), (0, 9, 0), (-10, 0, 1), (-10, 9, 1), (-10, 0, -1), (-10, 9, -1)], dtype=float)
    upper, lower = [(0, 1, 3), (0, 3, 2)], [(0, 5, 1), (0, 4, 5)]
    points = np.array([(0.2, 4.0, 1.2), (0.2, 4.0, -1.2), (-5.0, 4.0, 0.0)])
    for order in (upper + lower, lower + upper):
        found = Facets(vertices, np.array(order)).distance(points)
        assert found[:2] == pytest.approx(np.hypot(0.2, 1.2))
        assert found[2] == pytest.approx(-5.0 / np.sqrt(101.0))


def test_distance_to_many_facets_is_that_of_a_ball() -> None:
    ball = trimesh.creation.icosphere(subdivisions=3, radius=10.0)
    facets = Facets(np.asarray(ball.vertices), np.asarray(ball.faces, dtype=np.int64))
    points = np.random.default_rng(1).normal(size=(500, 3))
    points *= np.random.default_rng(2).uniform(5.0, 15.0, 500)[:, None] / np.linalg.norm(points, axis=1)[:, None]
    exact = np.linalg.norm(points, axis=1) - 10.0
    assert np.abs(facets.distance(points) - exact).max() < 0.08


def stl(triangles: np.ndarray) -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in triangles)
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + body


ONE = np.array([[(0, 0, 0), (1, 0, 0), (0, 1, 0)]], dtype=float)
A, B, C, D = (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)
FLAT_BODY = np.array([(A, B, C), (A, C, D), (A, D, B), (B, D, C)], dtype=float)

TILT = np.array([[1.0, 0.3, 0.7], [-0.4, 1.0, 0.2], [0.0, 0.0, 1.0]])

BAD = {
    "no units": (stl(ONE), None, "part-units-missing"),
    "unknown units": (stl(ONE), "furlong", "part-units-unknown"),
    "empty": (b"", "mm", "part-empty"),
    "text": (b"hello\n" * 40, "mm", None),
    "no triangles": (stl(ONE[:0]), "mm", None),
    "NaN": (stl(np.where(ONE == 1.0, np.nan, ONE)), "mm", "part-nan"),
    "infinite": (stl(np.where(ONE == 1.0, np.inf, ONE)), "mm", "part-nan"),
    "zero area": (stl(0.0 * ONE + 3.0), "mm", None),
    "collinear": (stl(np.array([[(0, 0, 0), (1, 0, 0), (2, 0, 0)]], dtype=float)), "mm", "part-zero-area"),
    "flat body": (stl(FLAT_BODY), "mm", "part-no-volume"),
    "flat body, tilted": (stl(40.0 * FLAT_BODY @ TILT), "mm", "part-no-volume"),
    "huge": (stl(2e6 * ONE), "mm", "part-too-large"),
    "far away": (stl(ONE + 2e6), "mm", "part-too-large"),
    "tiny": (stl(1e-4 * ONE), "mm", "part-too-small"),
    "cut": (stl(np.repeat(ONE, 20, axis=0))[:300], "mm", "part-damaged"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_typed_line(name: str, tmp_path: Path) -> None:
    content, units, code = BAD[name]
    file = tmp_path / "part.stl"
    file.write_bytes(content)
    with pytest.raises(GeometryError) as caught:
        read_part(file, units=units)
    assert code is None or caught.value.code == code
    assert "\n" not in str(caught.value) and caught.value.where in (str(file), "part.units")


@pytest.mark.parametrize("ending", ["obj", "ply", "3mf"])
def test_junk_in_other_formats(ending: str, tmp_path: Path) -> None:
    file = tmp_path / f"part.{ending}"
    file.write_bytes(b"\x00\x01junk" * 30)
    with pytest.raises(GeometryError):
        read_part(file, units=None if ending == "3mf" else "mm")


@pytest.mark.parametrize("ending", ["stl", "obj", "ply", "3mf"])
def test_no_word_of_a_library_reaches_users(ending: str, tmp_path: Path) -> None:
    file = tmp_path / f"part.{ending}"
    for junk in (
        b"\x00\x01junk" * 30,
        b"solid x\nfacet normal 0 0\nvertex",
        b"ply\nformat ascii 1.0\nelement",
        b"f 1 2 x\n",
    ):
        file.write_bytes(junk)
        with pytest.raises(GeometryError) as caught:
            read_part(file, units=None if ending == "3mf" else "mm")
        assert "Error" not in str(caught.value) and "Exception" not in str(caught.value)
        assert caught.value.hint in str(caught.value)


def test_missing_trimesh_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = export(cube(), tmp_path / "c.ply")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(GeometryError, match=r"styluscam\[mesh\]") as caught:
        read_part(file, units="mm")
    assert caught.value.code == "part-extra-mesh"
