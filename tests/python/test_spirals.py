"""Spirals: one descent, evenly, exact on the walls; they part where the loops part, and a missing turn is found."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.types import FloatArray

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
PITCH = 0.5
RAPID = 0


def document(part: dict[str, Any], profile: dict[str, Any], forming: bool, pitch: float = PITCH) -> dict[str, Any]:
    sheet = {"setup": {"zero": "model", "sheet": {"thickness": 1.0}}, "process": {"kind": "spif"}}
    milling = {"setup": {"zero": "model"}, "process": {"kind": "milling"}}
    return {
        "schema": 1,
        "part": {**part, **({"model_face": "back"} if forming else {})},
        **(sheet if forming else milling),
        "tools": {"tool": {"number": 1, "profile": profile}},
        "operations": [
            {"kind": "spiral", "tool": "tool", "step": {"height": pitch}, "spindle": {"mode": "fixed", "rpm": 8000.0}}
        ],
        "machine": {"name": "linuxcnc"},
    }


BALL = {"kind": "ball", "diameter": 6.0}
CLOTHOID = {"kind": "clothoid", "diameter": 10.0}
CUP = {"file": str(FIXTURES / "cone_cup.step"), "faces": ["Face1", "Face2", "Face3", "Face4"]}


def runs(program: sc.Program) -> list[FloatArray]:
    """Tips (N,3) of each run at feed between rapids, from its first contact on."""
    found, run = [], []
    for kind, end in zip(program.moves["kind"], program.moves["end"], strict=True):
        if kind == RAPID:
            found.append(run)
            run = []
        else:
            run.append(end)
    return [np.array(run) for run in [*found, run] if run]


def distances(run: FloatArray) -> FloatArray:
    """Differences in height of neighbouring turns about the Z axis, at fifty angles."""
    angle = np.unwrap(np.arctan2(run[:, 1], run[:, 0]))
    turns = np.abs(angle - angle[0]) / (2.0 * np.pi)
    starts = np.arange(0.0, 1.0, 0.02)
    heights = [np.interp(np.arange(start, turns[-1], 1.0), turns, run[:, 2]) for start in starts]
    return np.concatenate([-np.diff(found)[2:-3] for found in heights])


@pytest.mark.parametrize("forming", [False, True])
def test_a_cup_is_one_even_descent(forming: bool) -> None:
    job = sc.Job.from_dict(document(CUP, CLOTHOID, forming))
    plan = sc.plan(job)
    (run,) = runs(plan.programs["main"])
    falls = -np.diff(run[:, 2])
    assert falls.min() >= 0.0 and falls.max() < 0.05 * PITCH
    level = np.flatnonzero(falls > 1e-9)
    assert (falls[level[0] : level[-1]] > 0.0).all()  # strictly between the loops at both ends
    assert np.abs(distances(run) - PITCH).max() < 0.01 * PITCH
    report = sc.verify(sc.post(plan), job)
    assert report.ok and not [one for one in report.findings if one["severity"] != "note"]
    assert report.gouge_max <= 0.001


@pytest.mark.parametrize("name", ["cap_r60", "pyramid", "vwaf"])
def test_walls_of_any_shape_are_followed(name: str) -> None:
    job = sc.Job.from_dict(document({"file": str(FIXTURES / f"{name}.step")}, BALL, forming=False, pitch=1.0))
    plan = sc.plan(job)
    assert len(runs(plan.programs["main"])) <= 2  # the walls, and what stands below a flat
    report = sc.verify(sc.post(plan), job)
    assert report.ok and not report.findings
    assert report.gouge_max <= 0.001 and report.excess_max <= 0.006


def two_pockets() -> sc.Part:
    """A shallow basin with two deep pockets in its floor, as a heightfield of 100 x 60 mm."""
    x, y = np.meshgrid(np.arange(-50.0, 50.5, 0.5), np.arange(-30.0, 30.5, 0.5))
    basin = np.clip(np.maximum(np.abs(x) - 42.0, np.abs(y) - 22.0), -4.0, 0.0)
    pockets = [np.clip(np.hypot(x - middle, y) - 14.0, -8.0, 0.0) for middle in (-20.0, 20.0)]
    z = basin + pockets[0] + pockets[1]
    vertices = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    across = x.shape[1]
    corner = (np.arange(x.shape[0] - 1)[:, None] * across + np.arange(across - 1)).ravel()
    first = np.column_stack([corner, corner + 1, corner + across + 1])
    second = np.column_stack([corner, corner + across + 1, corner + across])
    return sc.Part.from_mesh(vertices, np.concatenate([first, second]))


@pytest.mark.parametrize("forming", [False, True])
def test_two_pockets_in_a_basin_part_cleanly(forming: bool) -> None:
    part = {"file": "basin.stl", "units": "mm"}
    job = sc.Job.from_dict(document(part, BALL, forming), part=two_pockets())
    plan = sc.plan(job)
    found = runs(plan.programs["main"])
    deep = [run for run in found if run[:, 2].min() < -9.0]
    assert sorted(np.sign(run[:, 0].mean()) for run in deep) == [-1.0, 1.0]
    assert all((np.diff(run[:, 2]) <= 0.0).all() for run in deep)
    shallow = min(found, key=lambda run: -run[:, 2].max())
    assert shallow[:, 2].max() > -1.0  # the basin comes before what lies in it
    report = sc.verify(sc.post(plan), job)
    assert report.ok, [one["message"] for one in report.findings]
    assert "punch" not in {one["kind"] for one in report.findings}


def without_a_turn(text: str) -> str:
    """The text of a descent without the moves of two turns in its middle."""
    lines = text.splitlines()
    heights = [
        (number, float(found[1])) for number, line in enumerate(lines) if (found := re.search(r"Z(-[\d.]+)", line))
    ]
    cut = [number for number, z in heights if -12.0 < z < -11.0]
    return "\n".join([*lines[: cut[0]], *lines[cut[-1] :]])


def test_missing_turns_are_found() -> None:
    job = sc.Job.from_dict(document(CUP, CLOTHOID, forming=False))
    text = sc.post(sc.plan(job)).text
    assert not sc.verify(text, job).findings
    found = {one["kind"]: one["severity"] for one in sc.verify(without_a_turn(text), job).findings}
    assert found.get("missing-level") or found.get("missing-pass"), found


def test_missing_turns_of_a_sheet_are_found() -> None:
    job = sc.Job.from_dict(document(CUP, CLOTHOID, forming=True))
    report = sc.verify(without_a_turn(sc.post(sc.plan(job)).text), job)
    assert {"missing-level", "missing-pass", "punch"} & {one["kind"] for one in report.findings}


def test_planning_can_be_cancelled() -> None:
    job = sc.Job.from_dict(document(CUP, CLOTHOID, forming=False))
    job.part()
    with pytest.raises(sc.Cancelled):
        sc.plan(job, progress=lambda phase, fraction: phase != "spirals")


def test_a_step_is_positive() -> None:
    for pitch in (0.0, -1.0, float("nan")):
        with pytest.raises(sc.JobError, match="height"):
            sc.Job.from_dict(document(CUP, CLOTHOID, forming=False, pitch=pitch))
