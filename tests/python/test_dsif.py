"""Double-sided forming, the whole way: a job, two programs, two texts for two controllers, read back and verified together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import FACES

import styluscam as sc

BALLS = ({"kind": "ball", "diameter": 10.0}, {"kind": "ball", "diameter": 5.0})
CLOTHOIDS = ({"kind": "clothoid", "diameter": 10.0}, {"kind": "clothoid", "diameter": 6.0})
STEP = {"step": {"height": 4.0}}
CASES = [
    ("cone_cup", BALLS, {"law": "constant", "model_face": "tool", "squeeze": 0.95}, {"kind": "z-level", **STEP}),
    (
        "cone_cup",
        CLOTHOIDS,
        {"law": "sine", "model_face": "back", "squeeze": 0.9},
        {"kind": "z-level", "z_bottom": -24.0, **STEP},
    ),
    ("cone_cup", BALLS[:1] * 2, {"law": "constant", "model_face": "back", "squeeze": 1.0}, {"kind": "spiral", **STEP}),
    ("vwaf", BALLS, {"law": "sine", "model_face": "mid", "squeeze": 0.85}, {"kind": "z-level", **STEP}),
    ("pyramid", BALLS, {"law": "constant", "model_face": "tool", "squeeze": 0.9}, {"kind": "z-level", **STEP}),
]


def described(
    part: str, profiles: tuple[dict[str, Any], ...], sheet: dict[str, Any], operation: dict[str, Any]
) -> dict[str, Any]:
    return {
        "schema": 1,
        "part": {"file": f"{part}.step", "faces": FACES.get(part, "all"), "model_face": sheet["model_face"]},
        "setup": {"sheet": {"thickness": 1.0, "law": sheet["law"]}},
        "process": {"kind": "dsif", "support_tool": "below", "squeeze": sheet["squeeze"]},
        "tools": {"tool": {"profile": profiles[0]}, "below": {"profile": profiles[1]}},
        # deeper steps than sheet takes: few passes are enough here
        "accept": ["punch", "wall-angle"],
        "operations": [{"tool": "tool", "tolerance": 0.01, **operation}],
        "machine": {"name": "linuxcnc"},
        "machines": {"support": {"name": "grbl"}},
    }


@pytest.fixture
def job_of(part_of: Callable[[str], sc.Part], tmp_path: Path) -> Callable[..., sc.Job]:
    def made(part: str, *more: Any) -> sc.Job:
        return sc.Job.from_dict(described(part, *more), folder=tmp_path, part=part_of(part))

    return made


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}-{case[1][0]['kind']}-{case[3]['kind']}")
def test_two_programs_are_written_and_verified_together(
    job_of: Callable[..., sc.Job], case: Any, tmp_path: Path
) -> None:
    result = sc.run(job_of(*case))
    errors = [f.message for each in result.channels.values() for f in each.report.findings if f.severity == "error"]
    assert result.ok, errors
    names = sorted(path.name for path in result.written)
    assert names == ["job.ngc", "job.program.json", "job.support.ngc", "job.support.program.json"]
    main, support = (result.plan.programs[channel] for channel in ("main", "support"))
    assert len(main.moves) == len(support.moves)
    assert abs(main.duration - support.duration) < 0.005 * main.duration
    assert (main.moves["kind"] == support.moves["kind"]).all()
    for each in result.channels.values():
        assert each.report.gouge_max <= 0.001
        assert not any("not given" in finding.message for finding in each.report.findings)
    header = (tmp_path / "job.support.ngc").read_text().split("G21")[0]
    assert "turned half about X" in " ".join(header.replace("(", "").replace(")", "").split())


def test_files_are_verified_together_or_reported_as_half_checked(job_of: Callable[..., sc.Job], tmp_path: Path) -> None:
    job = job_of(*CASES[4])
    sc.run(job)
    texts = tmp_path / "job.support.ngc", tmp_path / "job.ngc"
    report = sc.verify_file(texts[0], job, channel="support", beside=texts[1])
    assert report.ok
    assert report.beside == texts[1].read_text()
    alone = sc.verify_file(texts[0], job, channel="support")
    assert any(finding.kind == "not-checked" and finding.severity == "warning" for finding in alone.findings)


def test_a_corner_that_the_main_tool_bridges_is_refused_with_its_place() -> None:
    square = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]]
    vertices = [[x, y, 0.0] for x, y in square] + [[0.4 * x, 0.4 * y, -9.0] for x, y in square]
    walls = [[i, (i + 1) % 4, (i + 1) % 4 + 4] for i in range(4)] + [[i, (i + 1) % 4 + 4, i + 4] for i in range(4)]
    part = sc.Part.from_mesh(vertices, [*walls, [4, 5, 6], [4, 6, 7]])
    sheet = {"law": "constant", "model_face": "tool", "squeeze": 0.9}
    document = described("pit", BALLS, sheet, {"kind": "z-level", **STEP})
    with pytest.raises(sc.PlanError, match=r"touches two places at once"):
        sc.plan(sc.Job.from_dict(document, part=part))


def test_arcs_are_refused_for_the_tool_below_follows_straight_moves() -> None:
    sheet = {"law": "constant", "model_face": "tool", "squeeze": 0.9}
    document = described("cone_cup", BALLS, sheet, {"kind": "z-level", "fit": "arcs", **STEP})
    with pytest.raises(sc.JobError, match="straight moves") as refused:
        sc.Job.from_dict(document)
    assert refused.value.where == "operations[0].fit"
