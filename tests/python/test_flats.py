"""What stays flat by itself when a sheet is formed is no part of what a program must cover."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import styluscam as sc
from styluscam.drawing.picture import arrays_of
from styluscam.judging import coverage
from styluscam.report import heatmaps
from styluscam.report.surface import Surface

DEPTH, FLOOR, OPENING, FLANGE = 10.0, 40.0, 60.0, 100.0
"""A square tray: depth, and the sides of its floor, of its opening, and of the sheet, mm; its walls are at 45 degrees."""


def mesh() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Vertices, triangles, and faces: 1 the flange, 2 the walls, 3 the floor."""
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    rings = [np.c_[side * corners, np.full(4, z)] for side, z in ((FLANGE, 0.0), (OPENING, 0.0), (FLOOR, -DEPTH))]
    bands = [
        (face, [outer + i, outer + j, outer + 4 + j, outer + 4 + i])
        for face, outer in ((1, 0), (2, 4))
        for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))
    ]
    quads = [*bands, (3, [8, 9, 10, 11])]
    triangles = np.array([half for _, (a, b, c, d) in quads for half in ([a, b, c], [a, c, d])])
    faces = np.repeat([face for face, _ in quads], 2)
    return np.concatenate(rings), triangles, faces


def tray() -> sc.Part:
    vertices, triangles, faces = mesh()
    return sc.Part.from_mesh(vertices, triangles, face_ids=faces)


def job_of(face: str, law: str, **operation: Any) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": "tray.stl", "units": "mm", "model_face": face},
        "setup": {"sheet": {"thickness": 1.0, "law": law}},
        "tools": {"stylus": {"profile": {"kind": "ball", "diameter": 8.0}}},
        "operations": [{"kind": "z-level", "tool": "stylus", "step": {"height": 0.5}, **operation}],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=tray())


@pytest.mark.parametrize(("face", "law"), [("back", "constant"), ("tool", "constant"), ("mid", "sine")])
def test_the_flange_and_the_floor_of_a_tray_need_no_forming(face: str, law: str) -> None:
    job = job_of(face, law)
    report = sc.verify(sc.post(sc.plan(job)), job)
    flange, walls, floor = report.coverage()
    assert flange["flat"] == 1.0 and flange["carried"] == 0.0 and flange["covered"] == 1.0
    assert flange["left"] is None and flange["at"] is None
    assert walls["flat"] < 0.01 and walls["carried"] < 0.01
    assert walls["covered"] > 0.8  # the ball bridges the sharp foot and the corners
    assert floor["flat"] == 0.0 and floor["carried"] > 0.7
    totals = coverage.Totals.of(report.coverage())
    assert totals.flat == pytest.approx(FLANGE**2 - OPENING**2, rel=0.01)
    assert totals.share is not None and totals.share > 0.8
    lines = coverage.lines(report.coverage())
    assert f"{totals.flat:.1f} mm2 need no forming: the blank lies there" in lines[0]
    assert not any(line.startswith("Face1") for line in lines)


def test_a_floor_is_as_deep_as_the_passes_around_it() -> None:
    job = job_of("back", "constant", z_bottom=-7.0)
    report = sc.verify(sc.post(sc.plan(job)), job)
    flange, _, floor = report.coverage()
    assert flange["flat"] == 1.0
    assert floor["flat"] == floor["carried"] == floor["covered"] == 0.0
    assert floor["left"] > 1.0


def test_what_is_milled_must_be_touched() -> None:
    document = job_of("back", "constant", spindle={"mode": "off"}).document
    kept = {key: document[key] for key in ("schema", "tools", "operations", "machine")}
    milling = {**kept, "part": {"file": "tray.stl", "units": "mm"}, "process": {"kind": "milling"}}
    job = sc.Job.from_dict(milling, part=tray())
    report = sc.verify(sc.post(sc.plan(job)), job)
    assert all(face["flat"] == face["carried"] == 0.0 for face in report.coverage())
    assert "forming" not in coverage.lines(report.coverage())[0]


def test_the_map_has_a_colour_for_what_stays_flat(tmp_path: Path) -> None:
    vertices, triangles = mesh()[:2]
    record = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    record["v"] = vertices[triangles]
    (tmp_path / "tray.stl").write_bytes(b"\0" * 80 + np.uint32(len(triangles)).tobytes() + record.tobytes())
    job = sc.Job.from_dict(job_of("back", "constant").document, tmp_path)
    report = sc.verify(sc.post(sc.plan(job)), job)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 20_000)
        shown = heatmaps.shown_judged(Surface.of(arrays_of(job.part()), np.array(report.scene.frame)), report)
    left = next(one for one in shown.maps if one.key == "left")
    unformed = left.values == heatmaps.UNFORMED
    positions, level = shown.points[shown.vertices.at], shown.vertices.normals[:, 2] > 0.999
    off = np.abs(positions[:, :2]).max(axis=1)
    flange, floor = level & (off > OPENING / 2 + 0.1), level & (off < FLOOR / 2 - 6.0)
    assert flange.any() and unformed[flange].all() and left.unformed
    assert floor.any() and unformed[floor].all()
    assert not unformed[~level].any()
