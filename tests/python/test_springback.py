"""Springback: the part is formed bent the other way by what it was measured to deviate, and verified as such."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Floats, job_document

import styluscam as sc
from meridian import FIXTURES

BALL = {"kind": "ball", "diameter": 10.0}
PITCH, HALF = 1.5, 24.0


def dish() -> tuple[Floats, Any]:
    """A smooth dish, 6 mm deep and 40 mm wide, in a flat square of 48 mm: points 1.5 mm apart, and triangles."""
    side = np.arange(-HALF, HALF + 0.5 * PITCH, PITCH)
    x, y = (a.ravel() for a in np.meshgrid(side, side))
    z = -6.0 * np.clip(1.0 - (x * x + y * y) / 400.0, 0.0, None) ** 2
    n = len(side)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    corners = [(first, first + 1, first + n + 1), (first, first + n + 1, first + n)]
    return np.column_stack([x, y, z]), np.concatenate([np.column_stack(c) for c in corners])


def document(deviations: list[Any], **springback: Any) -> dict[str, Any]:
    found = job_document("dish", "z-level", BALL)
    found["part"] |= {"faces": "all", "springback": {"deviations": deviations, "units": "mm", **springback}}
    return found


def write(path: Path, points: Floats, deviations: Floats) -> str:
    np.savetxt(path, np.hstack([points, deviations]), delimiter=",", header="x,y,z,dx,dy,dz", comments="", fmt="%.9g")
    return path.name


def formed_at(job: sc.Job, points: Floats) -> Floats:
    """Where points of the target, corners of its triangles, are formed; those in the sheet's plane stay."""
    engine = job.part().engine
    formed = engine.arrays()[0]
    target = engine.target_points(formed)
    known = np.isfinite(target).all(axis=1)
    formed_from = {tuple(np.round(p[:2], 6) + 0.0): q for p, q in zip(target[known], formed[known], strict=True)}
    return np.array([formed_from.get(tuple(np.round(p[:2], 6) + 0.0), p) for p in points])


def sprung(formed: Floats) -> Floats:
    """An elastic sheet: it comes back by 6 % of its depth, more where it is deeper, and is drawn inwards by it."""
    measured = formed.copy()
    back = 0.06 * (1.0 - formed[:, 2] / 20.0)
    measured[:, 2] *= 1.0 - back
    measured[:, :2] *= 1.0 + 0.002 * formed[:, 2:3] / 6.0
    return measured


def test_repeated_trials_of_an_elastic_sheet_converge_to_the_part(tmp_path: Path) -> None:
    points, triangles = dish()
    target = sc.Part.from_mesh(points, triangles)
    trials, worst = list[str](), [np.linalg.norm(sprung(points) - points, axis=1).max()]
    formed = points
    for number in range(1, 6):
        trials.append(write(tmp_path / f"trial-{number}.csv", points, sprung(formed) - points))
        formed = formed_at(sc.Job.from_dict(document(trials), tmp_path, target), points)
        worst.append(np.linalg.norm(sprung(formed) - points, axis=1).max())
        if worst[-1] < 0.001:
            break
    assert worst[0] > 0.4 and worst[-1] < 0.001, worst
    assert all(after < 0.25 * before for before, after in pairwise(worst)), worst


def cup_points() -> Floats:
    """Points of the cone cup's formed faces and its flange, some 2 mm apart."""
    segments = json.loads((FIXTURES / "cone_cup.json").read_text())["meridian"]["segments"]
    line = []
    for segment in segments:
        (r0, z0), (r1, z1) = segment["from"], segment["to"]
        share = np.linspace(0.0, 1.0, 1 + int(segment["length"] / 0.5))
        if segment["kind"] == "line":
            line.append(np.column_stack([r0 + share * (r1 - r0), z0 + share * (z1 - z0)]))
            continue
        (cr, cz), radius = segment["centre"], segment["radius"]
        from_, to = np.arctan2(z0 - cz, r0 - cr), np.arctan2(z1 - cz, r1 - cr)
        angle = from_ + share * (to - from_)
        line.append(np.column_stack([cr + radius * np.cos(angle), cz + radius * np.sin(angle)]))
    meridian = np.concatenate(line)[::4]
    rings = []
    for r, z in meridian[meridian[:, 0] < 72.0]:
        turn = 2 * np.pi * np.arange(max(1, int(np.pi * r))) / max(1, int(np.pi * r)) + 0.3 * r
        rings.append(np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full_like(turn, z)]))
    points = np.concatenate(rings)
    return points[np.abs(points[:, :2]).max(axis=1) <= 50.0]


def test_a_compensated_cup_is_planned_deeper_and_verified_against_its_own_shape(
    tmp_path: Path, part_of: Callable[[str], sc.Part]
) -> None:
    points = cup_points()
    deviations = np.column_stack([np.zeros((len(points), 2)), -0.02 * points[:, 2]])
    name = write(tmp_path / "trial.csv", points, deviations)
    plain = job_document("cone_cup", "z-level", BALL)
    bent = {**plain, "part": {**plain["part"], "springback": {"deviations": [name], "units": "mm"}}}
    jobs = [sc.Job.from_dict(one, tmp_path, part_of("cone_cup")) for one in (plain, bent)]
    plans = [sc.plan(job) for job in jobs]
    texts = [sc.post(plan, job.machine()).text for plan, job in zip(plans, jobs, strict=True)]
    report = sc.verify(texts[1], jobs[1])
    assert report.ok and report.to_dict()["brep_checked"] > 500 and report.gouge_max <= 0.001, report.findings
    low, high = (plan.summary()[0] for plan in plans)
    assert high.deepest_z == pytest.approx(low.deepest_z - 0.5, abs=0.005)
    assert high.part_max == low.part_max and high.zero == low.zero
    assert [change.fact for change in high.changes] == ["springback", "springback_gap"] and low.changes == []
    assert high.changes[0].value == pytest.approx(0.5, abs=0.001)
    assert any("springback compensated" in line for line in texts[1].splitlines()[:40])
    # far from what was measured the block stays as it is
    corners = np.abs(jobs[1].part().engine.arrays()[0]) == [50.0, 50.0, 30.0]
    assert corners.all(axis=1).sum() == 4
    # what was made for the one shape does not pass as the other
    assert not sc.verify(texts[1], jobs[0]).ok and not sc.verify(texts[0], jobs[1]).ok


def stl(path: Path, points: Floats, triangles: Any) -> str:
    records = np.zeros(len(triangles), np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")]))
    records["c"] = points[triangles]
    path.write_bytes(bytes(80) + len(triangles).to_bytes(4, "little") + records.tobytes())
    return path.name


def test_two_meshes_state_the_same_as_a_table_and_half_a_factor_half_of_it(tmp_path: Path) -> None:
    points, triangles = dish()
    target, moved = sc.Part.from_mesh(points, triangles), sprung(points)
    table = write(tmp_path / "t.csv", points, moved - points)
    meshes = {
        "target": stl(tmp_path / "a.stl", points, triangles),
        "measured": stl(tmp_path / "b.stl", moved, triangles),
    }
    one, other, half = (
        formed_at(sc.Job.from_dict(document(deviations, factor=factor), tmp_path, target), points)
        for deviations, factor in (([table], 1.0), ([meshes], 1.0), ([table], 0.5))
    )
    assert np.abs(one - other).max() < 1e-5
    assert np.abs((one - points) - 2 * (half - points)).max() < 1e-6 and np.abs(one - points).max() > 0.4


def test_a_job_keeps_its_target_and_names_its_measurements(tmp_path: Path) -> None:
    points, triangles = dish()
    name = write(tmp_path / "trial.csv", points, sprung(points) - points)
    job = sc.Job.from_dict(document([name]), tmp_path, sc.Part.from_mesh(points, triangles))
    assert np.array_equal(job.target().bounds, sc.Part.from_mesh(points, triangles).bounds)
    assert job.part().bounds[0][2] < -6.3 and tmp_path / name in job.inputs()
    again = pickle.loads(pickle.dumps(job))
    assert again == job and again.part() == job.part()


def steep_cup() -> tuple[Floats, Any]:
    """A cup with walls of 80 degrees, 8 mm deep: rings of 60 points."""
    turn = 2 * np.pi * np.arange(60) / 60
    rings = [(25.0, 0.0), *((15.0 - d * np.tan(np.radians(10.0)), -d) for d in np.linspace(0.0, 8.0, 9)), (6.0, -8.0)]
    points = np.concatenate([np.column_stack([r * np.cos(turn), r * np.sin(turn), 0 * turn + z]) for r, z in rings])
    found = []
    for ring in range(len(rings) - 1):
        for i in range(60):
            j = (i + 1) % 60
            a, b, c, d = 60 * ring + i, 60 * ring + j, 60 * ring + 60 + i, 60 * ring + 60 + j
            found += [(a, b, d), (a, d, c)]
    last = 60 * (len(rings) - 1)
    found += [(last, last + i, last + i + 1) for i in range(1, 59)]
    return points, np.array(found)


def test_what_does_not_fit_is_refused_with_what_to_do(tmp_path: Path) -> None:
    points, triangles = dish()
    target = sc.Part.from_mesh(points, triangles)

    def refused(failure: type[sc.StylusError], deviations: Floats, at: Floats = points, **keys: Any) -> sc.StylusError:
        name = write(tmp_path / "d.csv", at, deviations)
        with pytest.raises(failure) as caught:
            sc.Job.from_dict(document([name], **keys), tmp_path, target).part()
        assert caught.value.where.startswith("part.springback") or str(tmp_path) in caught.value.where
        return caught.value

    near = points[:, 0] < 10.0
    gap = refused(sc.JobError, 0.0 * points[near], points[near])
    assert gap.code == "gap" and "max_gap = 5" in str(gap) and gap.hint
    assert refused(sc.JobError, points).code == "too-large"
    fold = np.column_stack([3.0 * np.sin(points[:, 0]), 0 * points[:, :2]])
    assert refused(sc.JobError, fold).code == "folded"
    broken = sprung(points) - points
    broken[7, 2] = np.nan
    assert "line 9" in str(refused(sc.GeometryError, broken))
    assert refused(sc.GeometryError, broken[:7], points[:7]).code == "few-samples"
    assert refused(sc.GeometryError, 0 * points, units=None).code == "springback-units-missing"
    wall, corners = steep_cup()
    target = sc.Part.from_mesh(wall, corners)
    out = wall * [1.0, 1.0, 0.0] * (wall[:, 2:3] / 8.0) * 0.2
    undercut = refused(sc.JobError, out, wall)
    assert undercut.code == "undercut" and "Face1" in str(undercut)


def test_documents_that_contradict_themselves_are_refused(tmp_path: Path) -> None:
    for change, code in (
        ({"deviations": []}, "empty"),
        ({"factor": 0.0}, "out-of-range"),
        ({"deviations": [3]}, "type"),
    ):
        contradictory = document(["a.csv"])
        contradictory["part"]["springback"] |= change
        with pytest.raises(sc.JobError) as caught:
            sc.Job.from_dict(contradictory)
        assert caught.value.code == code, change
    milling = {**document(["a.csv"]), "process": {"kind": "milling"}, "setup": {}}
    milling["part"].pop("model_face")
    with pytest.raises(sc.JobError, match="does not spring back"):
        sc.Job.from_dict(milling)
    points, triangles = dish()
    meshes = {
        "target": stl(tmp_path / "a.stl", points, triangles),
        "measured": stl(tmp_path / "b.stl", points, triangles[1:]),
    }
    job = sc.Job.from_dict(document([meshes]), tmp_path, sc.Part.from_mesh(points, triangles))
    with pytest.raises(sc.GeometryError, match=r"its triangles are not those of a\.stl"):
        job.part()
