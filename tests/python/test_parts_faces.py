"""Meshes as people have them: mended with a note, their faces distinguished, and planned as before."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.errors import GeometryError
from styluscam.parts import mesh
from styluscam.parts.arrays import PartArrays
from styluscam.parts.reading import read_part

BOX = np.array([(x, y, z) for x in (0, 10) for y in (0, 10) for z in (0, 10)], dtype=float)
SIDES = np.array(
    [
        *[(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)],
        *[(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)],
    ]
)


def boxes(*corners: tuple[float, float, float]) -> np.ndarray:
    return np.concatenate([(BOX + corner)[SIDES] for corner in corners])


def written(triangles: np.ndarray, folder: Path) -> Path:
    """Triangles (T,3,3) as a binary STL."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.zeros(len(triangles), record)
    records["corners"] = triangles
    file = folder / "part.stl"
    file.write_bytes(b" " * 80 + len(records).to_bytes(4, "little") + records.tobytes())
    return file


def read(triangles: np.ndarray, folder: Path) -> PartArrays:
    return read_part(written(triangles, folder), units="mm")


def volume(part: PartArrays) -> float:
    a, b, c = part.vertices[part.triangles].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def some_turned() -> np.ndarray:
    triangles = boxes((0, 0, 0), (20, 0, 0))
    triangles[[2, 5, 17]] = triangles[[2, 5, 17], ::-1]
    return triangles


def shaken() -> np.ndarray:
    return boxes((0, 0, 0)) + np.random.default_rng(3).uniform(-2e-5, 2e-5, (12, 3, 3))


def flat_added() -> np.ndarray:
    return np.concatenate([boxes((0, 0, 0)), [[(0, 0, 0), (0, 0, 0), (10, 0, 0)]] * 3])


MENDED = {
    "twice": (
        np.concatenate([boxes((0, 0, 0))] * 2),
        "12 triangles left out that the file has more than once",
        1000,
    ),
    "inside out": (boxes((0, 0, 0))[:, ::-1], r"wound inward \(inside out\)", 1000),
    "one body inside out": (
        np.concatenate([boxes((0, 0, 0)), boxes((20, 0, 0))[:, ::-1]]),
        r"12 triangles turned over, of bodies that were wound inward \(inside out\)",
        2000,
    ),
    "some turned": (some_turned(), "3 triangles turned over that wound against their neighbours", 2000),
    "shaken": (shaken(), "28 corners that did not quite meet others joined them", 1000),
    "flat": (flat_added(), "3 triangles without area left out", 1000),
}


@pytest.mark.parametrize("name", MENDED)
def test_what_is_mended_is_stated(name: str, tmp_path: Path) -> None:
    triangles, note, size = MENDED[name]
    part = read(triangles, tmp_path)
    assert part.is_closed and volume(part) == pytest.approx(size, rel=1e-5)
    assert len(part.notes) == 1 and re.search(note, part.notes[0])
    assert {face.kind for face in part.faces} == {"plane"} and len(part.faces) == 6 * size // 1000


def test_joined_corners_count_as_deviation(tmp_path: Path) -> None:
    part = read(shaken(), tmp_path)
    assert 1e-5 < part.deviation_inward == part.deviation_outward < 1e-4
    assert read(boxes((0, 0, 0)), tmp_path).deviation_inward == 0.0


def test_a_surface_wound_both_ways_is_refused_in_a_sentence(tmp_path: Path) -> None:
    grid = np.array([(x, y, 0.1 * x) for x in range(5) for y in range(5)], dtype=float)
    corners = [(i, i + 5, i + 6) for i in range(19) if i % 5 < 4] + [(i, i + 6, i + 1) for i in range(19) if i % 5 < 4]
    triangles = grid[np.array(corners)]
    triangles[:12] = triangles[:12, ::-1]
    with pytest.raises(GeometryError, match="some are inside out, and which side is out is not clear at X") as caught:
        read(triangles, tmp_path)
    assert caught.value.code == "part-inconsistent" and caught.value.hint in str(caught.value)


def plate_with_pin(sides: int = 24) -> np.ndarray:
    """A plate 40 x 40 x 5, on it a pin of radius 6 (its foot stands in the plate's top)."""
    angles = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.stack([20 + 6 * np.cos(angles), 20 + 6 * np.sin(angles), np.full(sides, 4.0)], axis=1)
    upper, following = ring + np.array([0, 0, 11]), np.roll(np.arange(sides), -1)
    low, high = np.array([20.0, 20.0, 4.0]), np.array([20.0, 20.0, 15.0])
    pin = []
    for i, j in enumerate(following):
        pin += [(ring[i], ring[j], upper[j]), (ring[i], upper[j], upper[i])]
        pin += [(low, ring[j], ring[i]), (high, upper[i], upper[j])]
    return np.concatenate([(BOX * (4.0, 4.0, 0.5))[SIDES], np.array(pin)])


def test_faces_have_kind_area_and_slopes(tmp_path: Path) -> None:
    part = read(plate_with_pin(), tmp_path)
    assert [face.kind for face in part.faces].count("cylinder") == 1 and len(part.faces) == 9
    top, side = part.faces[0], next(face for face in part.faces if face.kind == "cylinder")
    assert (top.kind, top.slope_max_deg, top.centre) == ("plane", pytest.approx(0.0), pytest.approx((20, 20, 15)))
    assert side.slope_min_deg == side.slope_max_deg == pytest.approx(90.0)
    assert side.area_mm2 == pytest.approx(24 * 2 * 6 * np.sin(np.pi / 24) * 11)
    shuffled = np.random.default_rng(5).permutation(plate_with_pin())
    assert [face.kind for face in read(shuffled, tmp_path).faces] == [face.kind for face in part.faces]


LEVELS = {"kind": "z-level", "step": {"height": 2.0}, "z_bottom": 0.0}
ROWS = {"kind": "zig-zag", "stepover": 1.0}


def path(file: Path, faces: Any, operation: dict[str, Any]) -> np.ndarray:
    """The planned positions (N,3)."""
    job = {
        "schema": 1,
        "part": {"file": str(file), "units": "mm", "faces": faces},
        "setup": {"zero": "model"},
        "process": {"kind": "milling"},
        "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
        "operations": [{"id": "one", "tool": "ball", "spindle": {"mode": "fixed", "rpm": 8000.0}, **operation}],
        "machine": {"name": "linuxcnc"},
    }
    return sc.plan(sc.Job.from_dict(job)).programs["main"].positions


@pytest.mark.parametrize("operation", [LEVELS, ROWS], ids=["levels", "rows"])
def test_all_faces_plan_as_one_face_did(
    operation: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = written(plate_with_pin(), tmp_path)
    now = path(file, "all", operation)
    true = mesh._engine.mended

    def whole(points: Any, corners: Any) -> Any:
        vertices, triangles, faces, done = true(points, corners)
        return vertices, triangles, np.ones_like(faces), re.sub(r'"shapes":\[.*?\]', '"shapes":["freeform"]', done)

    monkeypatch.setattr(mesh._engine, "mended", whole)
    assert len(now) > 100 and np.array_equal(path(file, "all", operation), now)


def test_a_face_of_a_mesh_can_be_chosen(tmp_path: Path) -> None:
    file = written(plate_with_pin(), tmp_path)
    top, whole = (np.abs(path(file, faces, ROWS)[:, :2] - 20.0).max() for faces in (["Face1"], "all"))
    assert top < 12.0 and whole > 18.0
