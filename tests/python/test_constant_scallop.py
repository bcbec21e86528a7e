"""Contours of equal scallop: what the posted text leaves, measured at points of its own; what is found where a pass is gone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import styluscam as sc

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
TESSELLATION = 0.0005
TOLERANCE = 0.002
POINTS = 40_000
FloatArray = npt.NDArray[np.float64]

BALL = {"kind": "ball", "diameter": 10.0}
CLOTHOID = {"kind": "clothoid", "diameter": 10.0}


def job(part: str, profile: dict[str, Any], scallop: float) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": str(FIXTURES / f"{part}.step"), "tolerance": TESSELLATION},
        "process": {"kind": "milling"},
        "tools": {"mill": {"number": 1, "profile": profile}},
        "machine": {"name": "linuxcnc", "options": {"decimals": 4}},
        "operations": [
            {
                "kind": "constant-scallop",
                "tool": "mill",
                "scallop": scallop,
                "tolerance": TOLERANCE,
                "feeds": {"cut": 1000.0, "plunge": 200.0},
                "spindle": {"mode": "fixed", "rpm": 8000.0},
            }
        ],
    }
    return sc.Job.from_dict(document)


def verified(asked: sc.Job) -> sc.Report:
    return sc.verify(sc.post(sc.plan(asked), asked.machine()), asked)


def points_touched(part: str, profile: dict[str, Any]) -> FloatArray:
    """Points spread at random over what faces up, where the tool that touches them is not in the part elsewhere."""
    shape, tool = (
        sc.Part.read(FIXTURES / f"{part}.step", tolerance=TESSELLATION),
        sc.Tool.from_dict({"profile": profile}),
    )
    corners = np.asarray(shape.arrays.vertices)[np.asarray(shape.arrays.triangles)]
    normals = np.asarray(shape.arrays.normals)
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    areas[normals[:, :, 2].mean(axis=1) < 0.05] = 0.0
    random = np.random.default_rng(26)
    chosen = random.choice(len(areas), size=POINTS, p=areas / areas.sum())
    root, share = np.sqrt(random.random(POINTS)), random.random(POINTS)
    weights = np.stack([1.0 - root, root * (1.0 - share), root * share], axis=1)[:, :, None]
    points, directions = (weights * corners[chosen]).sum(axis=1), (weights * normals[chosen]).sum(axis=1)
    tips = np.asarray(sc.slope_matched_offset(tool, points, directions / np.linalg.norm(directions, axis=1)[:, None]))
    is_touched: npt.NDArray[np.bool_] = tips[:, 2] >= sc.drop_cutter(shape, tool, tips[:, :2]) - 0.003
    return points[is_touched]


@pytest.mark.parametrize(
    ("part", "profile", "scallop"),
    [
        ("matrix/freeform", BALL, 0.05),
        ("matrix/freeform", CLOTHOID, 0.05),
        ("matrix/frustum_male", BALL, 0.03),
        ("matrix/pyramid", BALL, 0.03),
        ("cap_r60", BALL, 0.1),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else None,
)
def test_no_more_is_left_than_asked_for(part: str, profile: dict[str, Any], scallop: float) -> None:
    report = verified(job(part, profile, scallop))
    assert report.ok and not report.findings, [finding.message for finding in report.findings]
    points = points_touched(part, profile)
    assert len(points) > 0.85 * POINTS
    left = report.left(points)
    # the path may stand up to its tolerance off
    assert np.percentile(left, 99.0) <= 1.05 * scallop + TOLERANCE
    assert left.max() <= 1.3 * scallop + TOLERANCE
    # and no less: the passes lie as far apart as they may
    assert np.percentile(left, 90.0) >= 0.6 * scallop


def test_contours_too_far_apart_are_found() -> None:
    asked = job("matrix/pyramid", BALL, 0.05)
    wide = job("matrix/pyramid", BALL, 0.1)
    text = next(iter(sc.post(sc.plan(wide), wide.machine()).files.values()))
    assert not sc.verify(text, wide).findings
    errors = [finding for finding in sc.verify(text, asked).findings if finding.severity == "error"]
    assert {finding.kind for finding in errors} == {"scallop"}
    assert all(finding.limit == 0.05 and 0.08 < (finding.value or 0.0) < 0.115 for finding in errors)


def test_a_scallop_is_stated() -> None:
    document = job("matrix/pyramid", BALL, 0.05).to_dict()
    del document["operations"][0]["scallop"]
    with pytest.raises(sc.JobError, match="scallop"):
        sc.Job.from_dict(document)
    document["operations"][0]["scallop"] = 0.0
    with pytest.raises(sc.JobError, match="scallop"):
        sc.Job.from_dict(document)


def test_a_contour_that_is_gone_from_the_text_is_found() -> None:
    asked = job("matrix/pyramid", BALL, 0.05)
    text = next(iter(sc.post(sc.plan(asked), asked.machine()).files.values()))
    lines = text.splitlines()
    assert not sc.verify(text, asked).findings
    for first in range(300, 3000, 900):  # contours follow each other in one run
        without = "\n".join(lines[:first] + lines[first + 100 :]) + "\n"
        errors = [finding for finding in sc.verify(without, asked).findings if finding.severity == "error"]
        assert "scallop" in {finding.kind for finding in errors}, first


def split(shallow: float, steep: float, *, scallop: float = 0.05) -> sc.Job:
    """Contours on slopes up to ``shallow``, levels on those from ``steep`` on, degrees."""
    document = job("matrix/frustum_male", BALL, scallop).to_dict()
    contours = document["operations"][0]
    levels = {key: value for key, value in contours.items() if key not in ("id", "scallop")}
    contours["boundary"] = {"slope_deg": [0.0, shallow]}
    levels |= {"kind": "z-level", "step": {"scallop": scallop}, "boundary": {"slope_deg": [steep, 90.0]}}
    document["operations"] = [levels, contours]
    return sc.Job.from_dict(document)


def test_slopes_that_overlap_leave_nothing_between_levels_and_contours() -> None:
    points = points_touched("matrix/frustum_male", BALL)
    report = verified(split(32.0, 28.0))
    assert report.ok and not report.findings, [finding.message for finding in report.findings]
    assert report.left(points).max() <= 1.3 * 0.05 + TOLERANCE
    # with slopes that neither takes a strip is left
    assert verified(split(26.0, 34.0)).left(points).max() > 2.0 * 0.05
