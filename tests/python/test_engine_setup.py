"""The set-up: a model turned, turned over or moved in its file gives the same path once the job states so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import Floats, Mesh, box, milling_document, together

import styluscam as sc
from styluscam import _engine

BALL = {"kind": "ball", "diameter": 1.5}
UP = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "+z": (0, 0, 1), "-z": (0, 0, -1)}


def job(mesh: Mesh, kind: str = "z-level", **setup: object) -> sc.Job:
    keys: dict[str, Any] = {"step": {"height": 0.5}} if kind == "z-level" else {"stepover": 0.7}
    document = milling_document(kind, BALL, **keys)
    document["setup"] = setup
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh))


def frame(job: sc.Job) -> Floats:
    """Rows (3, 4) from the file's frame to work coordinates."""
    return np.array(_engine.Scene(job.engine, job.part().engine).frame)


def path(job: sc.Job) -> Floats:
    return sc.plan(job).programs["main"].positions


@pytest.mark.parametrize("up", UP)
def test_the_named_axis_points_up(up: str, small_part: Mesh) -> None:
    rows = frame(job(small_part, up=up))
    turn = rows[:, :3]
    assert np.allclose(turn @ UP[up], [0.0, 0.0, 1.0], atol=1e-15)
    assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert (rows[:, 3] == 0.0).all()


@pytest.mark.parametrize("kind", ("z-level", "zig-zag"))
@pytest.mark.parametrize("up", UP)
def test_a_model_that_lies_otherwise_gives_the_same_path(up: str, kind: str, small_part: Mesh) -> None:
    vertices, triangles = small_part
    turn = np.round(frame(job(small_part, up=up))[:, :3])
    expected, found = path(job(small_part, kind)), path(job((vertices @ turn, triangles), kind, up=up))
    assert expected.shape == found.shape
    assert np.abs(expected - found).max() < 1e-6


@pytest.mark.parametrize("angle", (90.0, -30.0, 17.5))
def test_rotation_turns_the_model_counterclockwise(angle: float, small_part: Mesh) -> None:
    vertices, triangles = small_part
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    assert np.allclose(frame(job(small_part, rotation=angle))[:, :3], turn, atol=1e-15)
    expected = path(job(small_part))
    found = path(job((vertices @ turn, triangles), rotation=angle))
    assert expected.shape == found.shape
    # the sine's rounding decides between halves of an interval: the ends of a run are found to 0.001 mm
    assert np.abs(expected - found).max() < 0.002


@pytest.mark.parametrize("kind", ("z-level", "zig-zag"))
def test_the_zero_point_moves_the_path(kind: str, small_part: Mesh) -> None:
    expected = path(job(small_part, kind))
    zero = np.array([3.0, -2.0, 1.5])
    found = path(job(small_part, kind, zero=zero.tolist()))
    assert expected.shape == found.shape
    assert np.abs(found + zero - expected).max() < 1e-6
    assert np.array_equal(path(job(small_part, kind, zero="model")), expected)


def test_zero_is_taken_of_the_turned_model(small_part: Mesh) -> None:
    vertices, triangles = small_part
    over = (vertices * [1.0, -1.0, -1.0], triangles)
    expected = path(job(small_part, zero=[3.0, -2.0, 1.5]))
    found = path(job(over, up="-z", zero=[3.0, -2.0, 1.5]))
    turn = frame(job(over, up="-z"))[:, :3]
    if np.allclose(turn, np.diag([1.0, -1.0, -1.0])):
        assert np.abs(found - expected).max() < 1e-6
    else:
        assert np.allclose(turn, np.diag([-1.0, 1.0, -1.0]))


def test_with_a_sheet_zero_is_its_top(small_part: Mesh) -> None:
    vertices, triangles = small_part
    document = milling_document("z-level", BALL, step={"height": 0.5})
    document["process"] = {"kind": "spif"}
    document["part"]["model_face"] = "back"
    tops = {}
    for name, lift in (("low", 0.0), ("high", 40.0)):
        document["setup"] = {"sheet": {"thickness": 0.7}}
        part = sc.Part.from_mesh(vertices + np.array([0.0, 0.0, lift]), triangles)
        plan = sc.plan(sc.Job.from_dict(document, part=part))
        tops[name] = plan.programs["main"]
        # the bumps' top and the sheet on it
        assert plan.scene.frame[2][3] == pytest.approx(-(2.0 + 0.7 + lift))
    assert np.abs(tops["low"].positions - tops["high"].positions).max() < 1e-6
    assert tops["low"].setup["clearance"] == pytest.approx(10.0)


@pytest.mark.parametrize("machine", ["linuxcnc", "grbl"])
@pytest.mark.parametrize("top", [0.00049, 1.23456, 5.4950312])
def test_a_clearance_height_that_is_rounded_down_in_the_text_is_no_finding(machine: str, top: float) -> None:
    mesh = together(box([0.0, 0.0, -5.0], [5.0, 5.0, top]), box([30.0, 0.0, -5.0], [35.0, 5.0, top]))
    document = milling_document("z-level", BALL, machine=machine, step={"height": 2.0}, smallest_feature=2.0)
    work = sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh))
    report = sc.verify(sc.post(sc.plan(work), work.machine()), work)
    assert not [finding for finding in report.findings if "rapid" in finding["kind"]]
