"""What verification measures of surfaces that are milled with the side of the tool, as arrays."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import styluscam as sc

PART = Path(__file__).parents[2] / "fixtures" / "blade.step"

RAILS = ("Edge1", "Edge3")
"""The lower and the upper edge of its Face1."""


@pytest.fixture(scope="module")
def report() -> sc.Report:
    job = sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(PART), "tolerance": 0.01},
            "setup": {"zero": "model"},
            "process": {"kind": "milling"},
            "tools": {"mill": {"number": 1, "length": 60.0, "profile": {"kind": "flat", "diameter": 8.0}}},
            "operations": [
                {
                    "id": "blade",
                    "kind": "flank",
                    "tool": "mill",
                    "faces": ["Face1"],
                    "spindle": {"mode": "fixed", "rpm": 8000.0},
                }
            ],
            "machine": {"name": "linuxcnc-trunnion"},
        }
    )
    return sc.verify(sc.post(sc.plan(job)).text, job)


def test_the_points_lie_evenly_between_the_rails(report: sc.Report) -> None:
    (blade,) = report.flanks
    (surface,) = blade.faces
    assert (blade.operation, surface.name) == ("blade", "Face1")
    u, v = (np.linspace(0.0, 1.0, count) for count in surface.left.shape)
    edges = report.job.part().arrays.edges
    rails = [edges[int(name.removeprefix("Edge")) - 1] for name in RAILS]
    low, high = (rail.at(u) for rail in rails if rail is not None)
    expected = low[:, None] + (high - low)[:, None] * v[:, None]
    assert surface.points.shape == (*surface.left.shape, 3)
    np.testing.assert_allclose(surface.points, expected, atol=1e-9)


def test_the_figures_are_those_of_the_document(report: sc.Report) -> None:
    (blade,), (stated,) = report.flanks, report.to_dict()["flanks"]
    (surface,), (face,) = blade.faces, stated["faces"]
    assert [surface.over, surface.under, surface.missed] == [face["over"], face["under"], face["missed"]]
    assert surface.missed == np.mean(np.isinf(surface.left))
    known = surface.left[np.isfinite(surface.left)]
    assert 1e-4 < surface.over == pytest.approx(-known.min(), abs=1e-9) and blade.speed_max > 1.0
    assert 1e-4 < surface.under == pytest.approx(known.max(), abs=1e-9)
    turning = stated["turning"]
    assert [blade.speed_max, blade.acceleration_max, blade.unevenness] == list(turning.values())


def test_copies_measure_again(report: sc.Report) -> None:
    for other in (copy.copy(report), pickle.loads(pickle.dumps(report))):
        np.testing.assert_array_equal(other.flanks[0].faces[0].left, report.flanks[0].faces[0].left)
