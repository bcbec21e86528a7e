"""What verification measures of surfaces that are milled with the side of the tool, as arrays."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import styluscam as sc

PART = Path(__file__).parents[2] / "fixtures" / "pyramid.step"

LOW, HIGH = ([80.0, 0.0, -40.0], [80.0, 50.0, -40.0]), ([80.0, 0.0, 0.0], [80.0, 50.0, 0.0])
"""The rails of a wall beside the part."""


@pytest.fixture(scope="module")
def report() -> sc.Report:
    job = sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(PART), "tolerance": 0.01},
            "setup": {"zero": "model"},
            "process": {"kind": "milling"},
            "tools": {"mill": {"number": 1, "length": 60.0, "profile": {"kind": "flat", "diameter": 10.0}}},
            "operations": [
                {
                    "id": "wall",
                    "kind": "flank",
                    "tool": "mill",
                    "side": "right",
                    "rails": {"curves": [{"poles": list(rail)} for rail in (LOW, HIGH)]},
                }
            ],
            "machine": {"name": "linuxcnc"},
        }
    )
    return sc.verify(sc.post(sc.plan(job)).text, job)


def test_the_points_lie_evenly_between_the_rails(report: sc.Report) -> None:
    (wall,) = report.flanks
    (surface,) = wall.faces
    assert (wall.operation, surface.name) == ("wall", "the stated rails")
    u, v = (np.linspace(0.0, 1.0, count) for count in surface.left.shape)
    low, high = (np.array(rail[0]) + u[:, None] * np.subtract(rail[1], rail[0]) for rail in (LOW, HIGH))
    expected = low[:, None] + (high - low)[:, None] * v[:, None]
    assert surface.points.shape == (*surface.left.shape, 3)
    np.testing.assert_allclose(surface.points, expected, atol=1e-9)


def test_the_figures_are_those_of_the_document(report: sc.Report) -> None:
    (wall,), (stated,) = report.flanks, report.to_dict()["flanks"]
    (surface,), (face,) = wall.faces, stated["faces"]
    assert [surface.over, surface.under, surface.missed] == [face["over"], face["under"], face["missed"]]
    assert surface.missed == np.mean(np.isinf(surface.left))
    turning = stated["turning"]
    assert [wall.speed_max, wall.acceleration_max, wall.unevenness] == list(turning.values())


def test_copies_measure_again(report: sc.Report) -> None:
    for other in (copy.copy(report), pickle.loads(pickle.dumps(report))):
        np.testing.assert_array_equal(other.flanks[0].faces[0].left, report.flanks[0].faces[0].left)
