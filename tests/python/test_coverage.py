"""What a program leaves on the faces that it is for."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Mesh, box, milling_document

import styluscam as sc

STEPOVER = 0.6
RADIUS = 3.0
TOLERANCE = 0.005


def verified(mesh: Mesh, stepover: float = STEPOVER) -> sc.Report:
    profile = {"kind": "ball", "diameter": 2 * RADIUS}
    document = milling_document("zig-zag", profile, stepover=stepover, angle_deg=0.0, tolerance=TOLERANCE)
    job = sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh))
    plan = sc.plan(job)
    return sc.verify(sc.post(plan, job.machine()), job)


PLATE = (
    np.array([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0], [30.0, 20.0, 0.0], [0.0, 20.0, 0.0]]),
    np.array([[0, 1, 2], [0, 2, 3]]),
)


def test_the_scallop_between_rows_is_that_of_a_circle() -> None:
    report = verified(PLATE)
    (face,) = report.coverage()
    height = RADIUS - np.sqrt(RADIUS**2 - 0.25 * STEPOVER**2)
    # the path stands up to the tolerance off
    assert 0.99 * height < face["scallop"] < height + TOLERANCE
    assert face["covered"] == 1.0
    assert face["area"] == pytest.approx(600.0)
    assert face["left"] == report.scallop == face["scallop"] > face["mean"] > 0.0
    assert face["points"] >= 20_000


def test_points_follow_the_distance_between_passes() -> None:
    (face,) = verified(PLATE, stepover=0.4).coverage()
    assert face["points"] == pytest.approx(25 * 600.0 / 0.4**2, rel=0.1)


def test_walls_that_rows_pass_by_are_left() -> None:
    (face,) = verified(box([0.0, 0.0, -5.0], [30.0, 20.0, 0.0])).coverage()
    assert face["area"] == pytest.approx(600.0 + 500.0)
    assert face["covered"] * face["area"] < 700.0
    assert face["left"] > 1.0
    assert face["at"][2] < -2.0


def test_it_can_be_stopped() -> None:
    report = verified(PLATE, stepover=0.05)  # long enough to be asked
    token = sc.CancelToken()
    token.cancel()
    with pytest.raises(sc.Cancelled):
        report.coverage(cancel=token)
