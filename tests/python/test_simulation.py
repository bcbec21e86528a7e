"""The material after a program: heights, meshes, distances to the part."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from conftest import box, milling_document

import styluscam as sc

STEPOVER = 0.6
RADIUS = 3.0
TOLERANCE = 0.005
HEADER = "G21 G90 G17 G54\nG64 P0.001\nT1 M6\nG43 H1\nG0 Z20\n"
EXAMPLE = Path(__file__).parents[2] / "examples" / "first-light" / "job.toml"


@lru_cache(maxsize=1)
def report() -> sc.Report:
    """Rows over a block of 30 x 20 x 5 mm."""
    profile = {"kind": "ball", "diameter": 2 * RADIUS}
    document = milling_document("zig-zag", profile, stepover=STEPOVER, angle_deg=0.0, tolerance=TOLERANCE)
    job = sc.Job.from_dict(document, part=sc.Part.from_mesh(*box([0.0, 0.0, -5.0], [30.0, 20.0, 0.0])))
    return sc.verify(sc.post(sc.plan(job), job.machine()), job)


@lru_cache(maxsize=1)
def milled() -> sc.Report:
    """The same block, rows 1 mm deep in it."""
    words = HEADER
    for row in range(20):
        words += f"G0 X5 Y{4.0 + STEPOVER * row:.4f}\nG0 Z1\nG1 Z-1 F500\nG1 X25\nG0 Z20\n"
    return sc.verify(words + "M2\n", report().job)


@lru_cache(maxsize=1)
def formed() -> sc.Report:
    """A stylus that goes round on a sheet of 1 mm, tip 2 mm under the blank's top; the part is the sheet's back face."""
    profile = {"kind": "ball", "diameter": 2 * RADIUS}
    document = milling_document("zig-zag", profile, stepover=STEPOVER, angle_deg=0.0, tolerance=TOLERANCE)
    document["part"]["model_face"] = "back"
    document["setup"] = {"sheet": {"thickness": 1.0}, "zero": "sheet-top"}
    document["process"] = {"kind": "spif"}
    job = sc.Job.from_dict(document, part=sc.Part.from_mesh(*box([0.0, 0.0, -5.0], [30.0, 20.0, 0.0])))
    words = f"{HEADER}G0 X10 Y10\nG1 Z-2 F500\nG1 X20\nG1 X20 Y12\nG0 Z20\nM2\n"
    return sc.verify(words, job)


def test_heights_stand_on_a_grid_over_the_part() -> None:
    found = sc.simulate(report(), 0.5)
    assert found.heights.shape == (len(found.y), len(found.x)) == found.points.shape[:2]
    assert (found.x[0], found.x[-1], found.y[0], found.y[-1]) == pytest.approx((0.0, 30.0, 0.0, 20.0))
    assert np.diff(found.x).max() <= 0.5 and np.diff(found.y).max() <= 0.5
    assert not found.touched.any()  # the block's top is what it was


def test_rows_leave_their_grooves() -> None:
    found = sc.simulate(milled(), 0.05)
    aside = np.abs((found.y - 4.0 + 0.5 * STEPOVER) % STEPOVER - 0.5 * STEPOVER)
    rows = (found.y > 4.0) & (found.y < 15.0)
    middle = found.heights[rows][:, (found.x > 6.0) & (found.x < 24.0)]
    expected = RADIUS - 1.0 - np.sqrt(RADIUS**2 - aside[rows, None] ** 2)
    assert np.abs(middle - expected).max() < 1e-9
    compared = found.compare()
    assert compared.gouge_max == pytest.approx(1.0, abs=1e-4)
    assert compared.gouge_at is not None and 4.0 <= compared.gouge_at[1] <= 15.5
    assert compared.left_max == 0.0 and compared.left_at is None
    assert compared.share_within(1.1) == 1.0 > compared.share_within(0.1)


def test_a_sound_program_takes_nothing_out_of_the_part() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    job = sc.Job.read(EXAMPLE)
    verified = sc.verify(sc.post(sc.plan(job), job.machine()), job)
    assert verified.ok
    compared = sc.simulate(verified, 0.2).compare()
    assert compared.touched.mean() > 0.2
    # gouge limit and what the triangles are off the part
    assert compared.gouge_max <= 0.001 + 0.001 + 1e-6
    assert compared.to_dict()["gouge_max"] == compared.gouge_max


def test_a_sheet_follows_the_tool() -> None:
    tool = sc.simulate(formed(), 0.1, face="tool")
    back = sc.simulate(formed(), 0.1)
    row, column = int(abs(tool.y - 10.0).argmin()), int(abs(tool.x - 15.0).argmin())
    assert tool.heights[row, column] == pytest.approx(-2.0, abs=1e-3)
    assert back.heights[row, column] == pytest.approx(-3.0, abs=1e-3)
    assert tool.heights.max() == 0.0 and back.heights.max() == -1.0
    # along the normal both faces are as far apart as the sheet is thick: a groove of radius 3 within one of 4
    aside = tool.y[row + 20] - 10.0
    assert back.heights[row - 20, column] == pytest.approx(1.0 - np.sqrt(16.0 - aside**2), abs=1e-3)
    assert tool.heights[row - 20, column] == pytest.approx(1.0 - np.sqrt(9.0 - aside**2), abs=1e-3)
    vertices, triangles = tool.mesh(0.01)
    assert vertices[:, 2].min() == tool.heights.min() and len(triangles) > 100
    with pytest.raises(sc.GeometryError, match="tool face was followed") as raised:
        tool.compare()
    assert raised.value.code == "another-face"


@pytest.mark.parametrize("ending", ["stl", "ply"])
def test_it_is_written_as_a_closed_body(tmp_path: Path, ending: str) -> None:
    trimesh = pytest.importorskip("trimesh", reason="needs the mesh extra")
    file = tmp_path / f"after.{ending}"
    sc.simulate(report(), 0.5).save(file)
    body = trimesh.load_mesh(file)
    assert body.is_watertight and body.volume == pytest.approx(30.0 * 20.0 * 5.0)
    again = tmp_path / f"again.{ending}"
    sc.simulate(report(), 0.5).save(again)
    assert again.read_bytes() == file.read_bytes()


def test_wrong_questions_are_named(tmp_path: Path) -> None:
    for spacing in (0.0, -1.0, float("nan"), 1e-5):
        with pytest.raises(sc.GeometryError, match="spacing"):
            sc.simulate(report(), spacing)
    with pytest.raises(sc.GeometryError, match="tool"):
        sc.simulate(formed(), 0.5, face="inside")
    found = sc.simulate(report(), 1.0)
    with pytest.raises(sc.GeometryError, match="tolerance"):
        found.mesh(-1.0)
    with pytest.raises(sc.GeometryError, match=r"\.stl or \.ply"):
        found.save(tmp_path / "after.obj")


def test_it_can_be_stopped() -> None:
    token = sc.CancelToken()
    token.cancel()
    with pytest.raises(sc.Cancelled):
        sc.simulate(milled(), 0.01, cancel=token)  # long enough to be asked
