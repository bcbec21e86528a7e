"""The addendum: a wall of constant angle from a part's outer edge to the blank, planned, posted and verified with the part."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Floats, Mesh, job_document, together

import styluscam as sc

BALL = {"kind": "ball", "diameter": 10.0}


def bowl(radius: float, depth: float, uneven: float = 0.0, at: tuple[float, float] = (0.0, 0.0)) -> Mesh:
    """A bowl of revolution, its edge at height 0, or up and down by `uneven` as a saddle: rings of 120 points."""
    turn = 2 * np.pi * np.arange(120) / 120
    rings = [np.array([[*at, -depth]])]
    for share in np.linspace(0.0, 1.0, 25)[1:]:
        height = depth * (share**2 - 1.0) + uneven * share**2 * np.cos(2 * turn)
        rings.append(
            np.column_stack([at[0] + radius * share * np.cos(turn), at[1] + radius * share * np.sin(turn), height])
        )
    triangles = [(0, 1 + i, 1 + (i + 1) % 120) for i in range(120)]
    for ring in range(23):
        for i in range(120):
            a, b = 1 + 120 * ring + i, 1 + 120 * ring + (i + 1) % 120
            triangles += [(a, a + 120, b + 120), (a, b + 120, b)]
    return np.concatenate(rings), np.array(triangles)


def document(addendum: dict[str, Any], **part: Any) -> dict[str, Any]:
    found = job_document("bowl", "z-level", BALL, step={"height": 2.0})
    found["part"] |= {"faces": "all", "tolerance": 0.005, "addendum": addendum, **part}
    return found


def job_of(mesh: Mesh, addendum: dict[str, Any], folder: Path = Path(), **part: Any) -> sc.Job:
    return sc.Job.from_dict(document(addendum, **part), folder, sc.Part.from_mesh(*mesh))


def cones(edges: list[Floats], points: Floats, slope: float) -> Floats:
    """The lowest of cones on the edges over points in plan, by brute force: 40 tips on each side."""
    share = np.linspace(0.0, 1.0, 40)[:, None, None]
    tips = [edge * (1 - share) + np.roll(edge, -1, axis=0) * share for edge in edges]
    tips_of_all = np.concatenate([each.reshape(-1, 3) for each in tips])
    away = np.linalg.norm(points[:, None, :2] - tips_of_all[None, :, :2], axis=2)
    return (tips_of_all[:, 2] + slope * away).min(axis=1)


def section(wall: Floats, angle: float, plane: float, radius: float) -> Floats:
    """The wall's height with an arc of `radius` between it and the plane."""
    x, tangent = (wall - plane) / np.tan(angle), radius * np.tan(0.5 * angle)
    arc = plane - radius + np.sqrt(np.clip(radius**2 - (tangent - x) ** 2, 0.0, None))
    return np.where(x <= -tangent * np.cos(angle), wall, np.where(x >= tangent, plane, arc))


@pytest.mark.parametrize("uneven", [0.0, 2.5])
def test_the_wall_is_the_lowest_of_all_cones_on_the_edge(uneven: float) -> None:
    job = job_of(bowl(30.0, 12.0, uneven), {"wall_angle_deg": 50.0, "corner_radius": 4.0, "height": 6.0})
    vertices, triangles, faces, _ = job.part().engine.arrays()
    assert set(faces.tolist()) == {1, 2, 3}
    trim = job.part().engine.trim
    assert len(trim) == 1 and len(trim[0]) == 120
    assert np.abs(np.linalg.norm(trim[0][:, :2], axis=1) - 30.0).max() < 1e-9
    middles = vertices[triangles[faces == 2]].mean(axis=1)[::7]
    points = np.concatenate([vertices[np.unique(triangles[faces == 2])][::7], middles])
    angle = np.radians(50.0)
    exact = section(cones(trim, points, np.tan(angle)), angle, uneven + 6.0, 4.0)
    assert np.abs(points[:, 2] - exact).max() < 0.01
    assert np.abs(vertices[triangles[faces == 3]][..., 2] - uneven - 6.0).max() < 1e-9


def test_two_cups_share_one_addendum_that_creases_between_them() -> None:
    two = together(bowl(15.0, 9.0, at=(-22.0, 0.0)), bowl(15.0, 9.0, at=(22.0, 0.0)))
    job = job_of(two, {"wall_angle_deg": 45.0, "corner_radius": 0.0, "height": 10.0})
    vertices, triangles, faces, _ = job.part().engine.arrays()
    middles = vertices[triangles[faces == 2]].mean(axis=1)
    exact = np.minimum(cones(job.part().engine.trim, middles, 1.0), 10.0)
    assert np.abs(middles[:, 2] - exact).max() < 0.02
    corners = vertices[np.unique(triangles[faces == 2])]
    between = corners[np.abs(corners[:, :2]).max(axis=1) < 2.0]
    assert between[:, 2].max() == pytest.approx(7.0, abs=0.1)


def test_a_cup_without_its_flange_is_formed_with_an_addendum_and_verified(
    part_of: Callable[[str], sc.Part], tmp_path: Path
) -> None:
    vertices, triangles, faces, normals = part_of("cone_cup").engine.arrays()
    own = np.isin(faces, [1, 2, 3])  # cut off in its wall of 45 degrees
    assert normals is not None
    cup = sc.Part.from_mesh(vertices, triangles[own], normals[own], faces[own])
    found = document({"wall_angle_deg": 40.0, "height": 8.0})
    found["operations"][0]["step"] = {"height": 4.0}
    found["output"] = {"file": "cup.ngc", "trim": "trim.csv"}
    job = sc.Job.from_dict(found, tmp_path, cup)
    result = sc.run(job)
    assert result.ok, result.report.findings
    assert result.report.gouge_max <= 0.001
    facts = {change.fact: change.value for change in result.summary.changes}
    assert facts["addendum"] == pytest.approx(8.0, abs=1e-6) and 1.0 < facts["area_stretch"] < 1.6
    edge = np.linalg.norm(job.part().engine.trim[0][:, :2], axis=1).max()
    reach = edge + 8.0 / np.tan(np.radians(40.0)) + 5.0 * np.tan(np.radians(20.0))
    assert facts["blank_x"] == pytest.approx(2 * (reach + 20.0), abs=0.02)
    assert facts["trim_length"] == pytest.approx(2 * np.pi * edge, abs=0.01)
    table = np.loadtxt(tmp_path / "trim.csv", delimiter=",", skiprows=1)
    assert np.array_equal(table[0], table[-1]) and np.ptp(table[:, 3]) < 1e-3
    assert table[0, 3] == pytest.approx(result.summary.part_max[2] - 8.0, abs=1e-3)
    # the wall at another angle is found, whichever of the two is asked for
    steeper = document({"wall_angle_deg": 42.0, "height": 8.0})
    steeper["operations"] = found["operations"]
    other = sc.Job.from_dict(steeper, tmp_path, cup)
    kinds = [
        {finding.kind for finding in sc.verify(text, against).findings if finding.severity == "error"}
        for text, against in ((result.posted.text, other), (sc.post(sc.plan(other)).text, job))
    ]
    assert all(kinds) and any("gouge" in found for found in kinds), kinds


def test_operations_name_the_addendum(tmp_path: Path) -> None:
    found = document({"wall_angle_deg": 45.0, "height": 6.0})
    found["operations"][0]["faces"] = ["Addendum"]
    job = sc.Job.from_dict(found, tmp_path, sc.Part.from_mesh(*bowl(30.0, 12.0)))
    plan = sc.plan(job)
    assert plan.summary()[0].operations[0].faces == [2]
    assert plan.programs["main"].positions[:, 2].min() > -9.0
    assert len(plan.trim) == 1 and plan.trim[0][:, 2].max() == pytest.approx(-6.0 - 1.0, abs=1e-9)


def test_over_a_male_die_the_wall_goes_down(part_of: Callable[[str], sc.Part], tmp_path: Path) -> None:
    found = job_document("cap_r60", "z-level", BALL, step={"height": 3.0})
    found["part"] |= {"faces": "all", "addendum": {"wall_angle_deg": 50.0, "height": 15.0}}
    found["process"] = {"kind": "tpif", "die": "male"}
    found["accept"] = ["solid"]
    job = sc.Job.from_dict(found, tmp_path, part_of("cap_r60"))
    plan = sc.plan(job)
    # none is left out while the tool rolls from the flange over its edge to the wall
    heights = np.unique(plan.programs["main"].moves["end"][:, 2].round(2))
    heights = heights[heights < 0.0]
    assert np.diff(heights).max() < 3.01, heights
    report = sc.verify(sc.post(plan).text, job)
    assert report.ok, report.findings
    edge = job.part().engine.trim[0][:, 2]
    assert np.ptp(edge) < 1e-9
    arrays = job.part().arrays
    assert arrays is not None
    blank = arrays.faces[-1]
    assert blank.centre[2] == pytest.approx(edge[0] - 15.0, abs=1e-9) and blank.slope_max_deg == pytest.approx(0.0)


def test_what_cannot_be_is_refused_with_what_to_do() -> None:
    def refused(mesh: Mesh, addendum: dict[str, Any], **part: Any) -> sc.StylusError:
        with pytest.raises(sc.StylusError) as caught:
            job_of(mesh, addendum, **part).part()
        assert caught.value.where.startswith("part.addendum") and caught.value.hint
        return caught.value

    wall = {"wall_angle_deg": 45.0}
    level = bowl(30.0, 12.0)
    assert refused(bowl(30.0, 12.0, 8.0), {"wall_angle_deg": 15.0}).code == "steep-edge"
    assert refused(level, {**wall, "height": 0.5, "corner_radius": 9.0}).code == "no-height"
    flat = (level[0] * [1.0, 1.0, 0.0], level[1])
    assert refused(flat, wall).code == "not-needed"
    assert (
        refused((level[0] * [1.0, 1.0, -1.0], level[1]), {**wall, "height": 1.0, "corner_radius": 0.0}).code
        == "beyond-blank"
    )
    assert refused(level, {"wall_angle_deg": 90.0}).code == "out-of-range"
    for key in ("wall_angle_deg", "height", "corner_radius", "flange_width"):
        for value in (float("nan"), float("inf"), -1.0):
            with pytest.raises(sc.JobError) as caught:
                job_of(level, {**wall, key: value})
            assert caught.value.where == f"part.addendum.{key}"
    blended = {**wall, "kind": "blended"}
    assert refused(level, {**blended, "corner_radius": 0.0}).code == "conflict"
    assert refused((level[0] * [1.0, 1.0, -1.0], level[1]), {**blended, "height": 40.0}).code == "falling-edge"
    assert refused(level, {**wall, "end": "opening"}).code == "missing"
    assert refused(level, {**wall, "end": "opening", "height": 3.0}).code == "conflict"
    assert refused(level, wall, springback={"deviations": ["a.csv"]}).code == "conflict"
    milling = {**document(wall), "process": {"kind": "milling"}, "setup": {}}
    milling["part"].pop("model_face")
    with pytest.raises(sc.JobError, match="needs no addendum"):
        sc.Job.from_dict(milling)
    with pytest.raises(sc.JobError, match="trim"):
        sc.Job.from_dict({**job_document("bowl", "z-level", BALL), "output": {"trim": "trim.csv"}})


@pytest.mark.parametrize("plate", ["backing", "clamp"])
def test_a_wall_that_leaves_the_plates_opening_is_refused(plate: str) -> None:
    found = document({"wall_angle_deg": 45.0, "height": 8.0, "corner_radius": 2.0})
    reach = 30.0 + 8.0 + 2.0 * np.tan(np.radians(22.5))
    for opening, fits in ((2 * reach + 2.5, True), (2 * reach + 1.5, False)):
        found["setup"]["fixture"] = {plate: {"opening": opening, **({"height": 8.0} if plate == "clamp" else {})}}
        job = sc.Job.from_dict(found, ".", sc.Part.from_mesh(*bowl(30.0, 12.0)))
        if fits:
            sc.plan(job)
            continue
        with pytest.raises(sc.JobError, match=r"addendum reaches 0\.2") as caught:
            sc.plan(job)
        assert caught.value.code == "beyond-opening"


@pytest.mark.parametrize("uneven", [0.0, 2.0])
def test_a_blended_wall_goes_on_by_the_parts_own_slope(uneven: float) -> None:
    mesh = bowl(30.0, 12.0, uneven)
    keys = {"wall_angle_deg": 55.0, "corner_radius": 8.0, "height": 14.0, "flange_width": 5.0}
    kinks = []
    for kind in ("wall", "blended"):
        vertices, triangles, faces, _ = job_of(mesh, {"kind": kind, **keys}).part().engine.arrays()
        corners = vertices[triangles]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = cross / np.linalg.norm(cross, axis=1)[:, None]
        ends = np.round(np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]], axis=2), 9)
        sides: dict[bytes, list[int]] = {}
        for triangle in np.flatnonzero(faces != 3):
            for side in ends[triangle]:
                sides.setdefault(np.ascontiguousarray(side + 0.0).tobytes(), []).append(int(triangle))
        pairs = [pair for pair in sides.values() if len(pair) == 2 and {*faces[pair]} == {1, 2}]
        assert len(pairs) == 120  # the wall has all sides of the edge, and no others
        cosines = [normals[a] @ normals[b] for a, b in pairs]
        kinks.append(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).max())
        slopes = np.degrees(np.arccos(normals[(faces == 2) & (np.linalg.norm(cross, axis=1) > 1e-3), 2]))
        assert slopes.max() < 55.6
    # the bowl reaches its edge by 39 degrees; what is left are chords of the bowl and of the arc
    assert kinks[0] > 14.0 and kinks[1] < 3.5, kinks


def test_a_blended_wall_is_formed_up_to_the_opening_of_the_backing_plate(tmp_path: Path) -> None:
    found = document({"kind": "blended", "wall_angle_deg": 50.0, "corner_radius": 8.0, "end": "opening"})
    found["setup"]["fixture"] = {"backing": {"opening": 84.0}}
    found["machine"] = {"name": "grbl"}
    job = sc.Job.from_dict(found, tmp_path, sc.Part.from_mesh(*bowl(30.0, 12.0)))
    vertices, triangles, faces, _ = job.part().engine.arrays()
    reach = np.linalg.norm(vertices[np.unique(triangles[faces == 2])][:, :2], axis=1).max()
    assert 42.0 - 1.0 - 0.05 < reach <= 42.0 - 1.0
    plan = sc.plan(job)
    report = sc.verify(sc.post(plan).text, job)
    assert report.ok, report.findings
    found["setup"]["fixture"]["backing"]["opening"] = 58.0
    with pytest.raises(sc.JobError) as caught:
        sc.Job.from_dict(found, tmp_path, sc.Part.from_mesh(*bowl(30.0, 12.0))).part()
    assert caught.value.code == "beyond-opening"
