"""Stages: a cup with walls beyond the sheet's limit, formed by way of shapes with gentler ones, each verified for itself."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from conftest import Mesh, job_document

import styluscam as sc

BALL = {"kind": "ball", "diameter": 6.0}
DEPTH, RIM, FILLET, WALL = 7.0, 12.0, 4.0, 85.0


def cup(count: int = 90) -> Mesh:
    """A cup in a flange: walls of 85 degrees, a fillet of 4 mm around its floor."""
    slopes = np.radians(np.linspace(0.0, WALL, 15))
    arc = np.column_stack([FILLET * np.sin(slopes), FILLET * (1.0 - np.cos(slopes)) - DEPTH])
    reach = arc[-1, 0] - arc[-1, 1] / np.tan(np.radians(WALL))
    floor = arc + np.array([RIM - reach, 0.0])
    line = np.vstack([[0.5 * floor[0, 0], -DEPTH], floor, [RIM, 0.0], [18.0, 0.0]])
    turn = 2 * np.pi * np.arange(count) / count
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(count, z)]) for r, z in line]
    triangles = [(0, 1 + i, 1 + (i + 1) % count) for i in range(count)]
    for ring in range(len(rings) - 1):
        for i in range(count):
            a, b = 1 + count * ring + i, 1 + count * ring + (i + 1) % count
            triangles += [(a, a + count, b + count), (a, b + count, b)]
    return np.concatenate([[[0.0, 0.0, -DEPTH]], *rings]), np.array(triangles)


def document(stages: list[float] | float, machine: str = "linuxcnc", **sheet: Any) -> dict[str, Any]:
    found = job_document("cup", "z-level", BALL, machine=machine, step={"height": 2.0})
    found["part"] |= {"faces": "all", "model_face": "tool", **({"stages": stages} if stages else {})}
    found["setup"]["sheet"] |= {"max_wall_angle_deg": 70.0, **sheet}
    return found


def job_of(stages: list[float] | float, **keys: Any) -> sc.Job:
    return sc.Job.from_dict(document(stages, **keys), part=sc.Part.from_mesh(*cup()))


def kinds(report: sc.Report) -> set[str]:
    return {finding.kind for finding in report.findings if finding.severity == "error"}


@pytest.fixture(scope="module")
def staged() -> tuple[sc.Job, str]:
    job = job_of([50.0, 66.0])
    return job, sc.post(sc.plan(job)).text


def test_walls_beyond_the_limit_are_formed_in_stages(staged: tuple[sc.Job, str]) -> None:
    job, text = staged
    report = sc.verify(text, job)
    assert report.ok, report.findings
    alone = job_of([])
    assert "wall-angle" in kinds(sc.verify(sc.post(sc.plan(alone)).text, alone))
    first_too_steep = job_of([74.0])
    report = sc.verify(sc.post(sc.plan(first_too_steep)).text, first_too_steep)
    assert kinds(report) == {"wall-angle"} and "stage of 74 degrees" in report.findings[0].message


def test_a_stage_is_the_lowest_shape_above_the_part_with_gentler_walls(staged: tuple[sc.Job, str]) -> None:
    job, _ = staged
    plan = sc.plan(job)
    summary = plan.summary()[0]
    assert [operation.id for operation in summary.operations] == ["z-level-1-stage-1", "z-level-1-stage-2", "z-level-1"]
    facts = [{fact.fact: fact.value for fact in operation.facts} for operation in summary.operations]
    # the sine law holds for the first stage; then the area is all that is known
    assert facts[0]["thinnest"] == pytest.approx(np.cos(np.radians(50.0)), abs=0.02)
    assert "thinnest" not in facts[2] and facts[2]["mean_thickness"] == pytest.approx(_mean_thickness(*cup()), abs=1e-3)
    program = plan.programs["main"]
    for operation, angle in ((0, 50.0), (1, 66.0)):
        tips = program.moves[program.moves["operation"] == operation]["end"]
        tips = tips[tips[:, 2] < -3.0]  # below the rim, on which the ball rolls first
        # a ball that rolls on a cone of this angle, which ends at the rim: its centre keeps off it by its radius
        slope = np.radians(angle)
        wall = np.hypot(tips[:, 0], tips[:, 1]) * np.tan(slope) - (tips[:, 2] + 3.0) - RIM * np.tan(slope)
        off = -wall * np.cos(slope)
        assert off.min() > 2.99 and np.quantile(off, 0.5) < 3.1, (angle, off.min(), np.quantile(off, 0.5))


def test_a_missing_stage_and_swapped_ones_are_found(staged: tuple[sc.Job, str]) -> None:
    job, text = staged
    marks = [m.start() for m in re.finditer(r"(?m)^\(operation [^\n]*z-level-1[^\n]*\)$", text)]
    assert len(marks) == 3
    head, first, second, last = (text[a:b] for a, b in zip([0, *marks], [*marks, len(text)], strict=True))
    assert head + first + second + last == text
    assert "missing-operation" in kinds(sc.verify(head + second + last, job))
    assert "operation-order" in kinds(sc.verify(head + second + first + last, job))


def test_a_stage_of_another_angle_is_found(staged: tuple[sc.Job, str]) -> None:
    job, text = staged
    gentler = job_of([46.0, 66.0])
    report = sc.verify(text, gentler)
    assert "gouge" in kinds(report) and any("stage of 46 degrees" in one.message for one in report.findings)
    report = sc.verify(sc.post(sc.plan(gentler)).text, job)
    assert not report.ok and any("stage of 50 degrees" in one.message for one in report.findings)


def test_other_controllers_take_stages_too() -> None:
    job = job_of([55.0], machine="grbl")
    report = sc.verify(sc.post(sc.plan(job)).text, job)
    assert report.ok, report.findings


def test_stages_that_cannot_be_are_refused() -> None:
    for change, code in (
        ({"stages": [60.0, 50.0]}, "order"),
        ({"stages": [50.0, 95.0]}, "out-of-range"),
        ({"stages": [4.0, 50.0]}, "out-of-range"),
        ({"stages": [50.0, float("nan")]}, "argument"),
        ({"stages": []}, "empty"),
        ({"stages": 0}, "out-of-range"),
        ({"stages": 2.5}, "out-of-range"),
        ({"stages": 21}, "out-of-range"),
        ({"stages": list(np.linspace(20.0, 60.0, 25))}, "out-of-range"),
    ):
        contradictory = document([])
        contradictory["part"] |= change
        with pytest.raises(sc.JobError) as caught:
            sc.Job.from_dict(contradictory)
        assert caught.value.code == code and caught.value.where.startswith("part.stages"), change
    for process in ({"kind": "tpif", "die": "male"}, {"kind": "dsif", "support_tool": "tool"}):
        with pytest.raises(sc.JobError, match="no intermediate stages"):
            sc.Job.from_dict({**document([50.0]), "process": process, "machines": {"support": {"name": "linuxcnc"}}})


def test_a_number_of_stages_is_spread_from_what_the_sheet_withstands_to_the_steepest_wall() -> None:
    assert _angles(job_of(2)) == pytest.approx([69.0, 77.0], abs=0.02)
    # by the sine law a wall of 60 degrees leaves half of the sheet
    assert _angles(job_of(3, min_thickness=0.5)) == pytest.approx([59.0, 67.67, 76.33], abs=0.02)
    with pytest.raises(sc.JobError) as caught:
        sc.plan(job_of(2, max_wall_angle_deg=86.0))
    assert caught.value.code == "not-needed" and caught.value.where == "part.stages"


def _angles(job: sc.Job) -> list[float]:
    changes = [fact.words for operation in sc.plan(job).summary()[0].operations for fact in operation.facts]
    return [float(words.split()[2]) for words in changes if words.startswith("stage of ")]


def test_no_stage_makes_more_sheet_than_there_is() -> None:
    job = job_of([50.0, 66.0], min_thickness=0.62)
    report = sc.verify(sc.post(sc.plan(job)).text, job)
    # the first stage passes by the sine law, cos 50 degrees; the part has more area than the sheet fills with 0.62 mm
    area = _mean_thickness(cup()[0], cup()[1])
    assert area == pytest.approx(0.553, abs=0.001)
    assert kinds(report) == {"thinning"}
    messages = [one.message for one in report.findings]
    assert any(words.startswith(f"z-level-1 makes the sheet {area:.3f} mm thin on average") for words in messages), (
        messages
    )
    assert any(words.startswith("stage of 66 degrees") and "on average" in words for words in messages), messages


def _mean_thickness(vertices: Any, triangles: Any) -> float:
    """Of a sheet of 1 mm over all triangles of which a corner is below the rim."""
    corners = vertices[triangles]
    cross = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    formed = corners[..., 2].min(axis=1) < -1e-3
    return float(cross[formed, 2].clip(0.0).sum() / np.linalg.norm(cross[formed], axis=1).sum())


def square(half: float = 14.0, depth: float = 8.0) -> Mesh:
    """A square cup in a flange, with walls of 85 degrees and sharp corners."""
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    foot = half - depth / np.tan(np.radians(WALL))
    rings = [
        np.column_stack([reach * corners, np.full(4, z)]) for reach, z in ((20.0, 0.0), (half, 0.0), (foot, -depth))
    ]
    triangles = [(8, 9, 10), (8, 10, 11)]
    for ring in (0, 4):
        for i in range(4):
            a, b = ring + i, ring + (i + 1) % 4
            triangles += [(a, b, b + 4), (a, b + 4, a + 4)]
    return np.concatenate(rings), np.array(triangles)


def test_a_stage_is_as_steep_as_its_angle_in_corners_too() -> None:
    """There its facets are narrow, and lean by more."""
    wanted = document([45.0], max_wall_angle_deg=46.0)
    job = sc.Job.from_dict(wanted | {"accept": ["solid"]}, part=sc.Part.from_mesh(*square()))
    plan = sc.plan(job)
    text = sc.post(plan).text
    assert re.search(r"stage-1: .*largest wall angle 45\.0 deg", text)
    found = [finding for finding in sc.verify(text, job).findings if finding.kind == "wall-angle"]
    assert all("85.0 degrees" in finding.message for finding in found), found
