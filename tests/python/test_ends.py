"""Where operations end: one rule for planner, verifier and summary."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import Mesh

import styluscam as sc
from blocks import box

BALL = {"kind": "ball", "diameter": 6.0}
TOOLS: dict[str, dict[str, Any]] = {
    "ball": BALL,
    "flat": {"kind": "flat", "diameter": 6.0},
    "bull-nose": {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0},
    "clothoid": {"kind": "clothoid", "diameter": 6.0},
}


def tilted(mesh: Mesh, angle: float) -> Mesh:
    """The mesh turned by a small angle about a slanted axis."""
    points, triangles = mesh
    x, y, z = points.T
    return np.stack([x + angle * z, y - angle * z, z - angle * x + angle * y], axis=1), triangles


def job(mesh: Mesh, profile: dict[str, Any], faces: list[int] | None = None, **operation: Any) -> sc.Job:
    """One operation of milling."""
    document = {
        "schema": 1,
        "part": {"file": "part.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"tool": {"profile": profile}},
        "operations": [{"tool": "tool", "spindle": {"mode": "fixed", "rpm": 8000.0}, **operation}],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh, face_ids=faces))


def verified(of: sc.Job) -> tuple[sc.Report, dict[str, Any]]:
    """The verification of a job's text, and what the summary reports of its operation."""
    plan = sc.plan(of)
    return sc.verify(sc.post(plan).text, of), plan.summary()[0]["operations"][0]


def lowest(report: sc.Report) -> float:
    """Of the tips at feed."""
    return float(report.program.moves["end"][:, 2].min())


@pytest.mark.parametrize("angle", [0.0, 1e-6])
@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize(
    "operation", [{"kind": "z-level", "step": {"height": 1.0}}, {"kind": "zig-zag", "stepover": 1.0}]
)
def test_a_cube_is_milled_to_its_foot(operation: dict[str, Any], tool: str, angle: float) -> None:
    report, _ = verified(job(tilted(box((-5, -5, 0), (5, 5, 10)), angle), TOOLS[tool], **operation))
    assert report.ok
    assert not report.findings
    assert lowest(report) > -1e-3
    assert lowest(report) < 0.01 or operation["kind"] == "zig-zag"


def test_what_the_foot_leaves_is_stated_and_z_bottom_goes_deeper() -> None:
    cube = box((-5, -5, 0), (5, 5, 10))
    levels: dict[str, Any] = {"kind": "z-level", "step": {"height": 1.0}}
    _, summary = verified(job(cube, BALL, **levels))
    assert summary["ends"]["at_foot"]
    assert summary["ends"]["untouched"] == pytest.approx(3.0)
    report, deeper = verified(job(cube, BALL, z_bottom=-3.0, **levels))
    assert report.ok
    assert lowest(report) == pytest.approx(-3.0, abs=0.01)
    assert deeper["ends"] is None


def test_a_program_that_ends_above_the_foot_is_found() -> None:
    cube = box((-5, -5, 0), (5, 5, 10))
    levels: dict[str, Any] = {"kind": "z-level", "step": {"height": 1.0}}
    short = sc.post(sc.plan(job(cube, BALL, z_bottom=4.0, **levels))).text
    report = sc.verify(short, job(cube, BALL, **levels))
    assert not report.ok
    assert "missing-level" in {finding["kind"] for finding in report.findings}


def test_walls_alone_are_levels_too() -> None:
    cube = box((-5, -5, 0), (5, 5, 10))
    faces = np.repeat([1, 2, 3, 4, 5, 6], 2)
    of = job(cube, BALL, faces=faces, kind="z-level", step={"height": 1.0})
    document = of.to_dict() | {"part": of.to_dict()["part"] | {"faces": ["Face4"]}}
    report, summary = verified(sc.Job.from_dict(document, part=sc.Part.from_mesh(*cube, face_ids=faces)))
    assert report.ok
    assert not report.findings
    assert summary["faces"] == [4]
    facts = {fact["fact"]: fact["value"] for fact in summary["facts"]}
    assert facts["loops"] == facts["levels"]


def test_a_floor_far_below_the_walls_wants_no_level() -> None:
    """A low plate beside a high block, of which the block's top, its walls and the plate's top are meant."""
    (points, triangles), (more, others) = box((0, 0, 40), (20, 20, 50)), box((-30, -30, 0), (60, 60, 5))
    mesh = np.vstack([points, more]), np.vstack([triangles, others + len(points)])
    faces = np.array([1] * 2 + [2] * 10 + [3] * 12)
    of = job(mesh, BALL, faces=faces, kind="z-level", step={"height": 2.0})
    document = of.to_dict() | {"part": of.to_dict()["part"] | {"faces": ["Face2", "Face3"], "allow_undercuts": True}}
    report, _ = verified(sc.Job.from_dict(document, part=sc.Part.from_mesh(*mesh, face_ids=faces)))
    assert report.ok
    assert not [f for f in report.findings if f["severity"] == "error"]
