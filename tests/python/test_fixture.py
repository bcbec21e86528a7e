"""Clamp frame, backing plate and what the sheet withstands, against distances known by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import Mesh

import styluscam as sc

RADIUS = 2.0
THICKNESS = 1.0
DEPTH = 4.0


def tray() -> Mesh:
    """A square opening of 40 mm in a flange of 80, walls of 45 degrees, a floor 4 mm below: as the tool meets it."""
    rings = [(40.0, 0.0), (20.0, 0.0), (20.0 - DEPTH, -DEPTH)]
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    vertices = [(x * r, y * r, z) for r, z in rings for x, y in corners]
    walls = [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    others = [(4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    return np.array(vertices, dtype=float), np.array([*walls, *others, (8, 9, 10), (8, 10, 11)])


def verified(
    setup: dict[str, Any] | None = None, sheet: dict[str, Any] | None = None, accept: tuple[str, ...] = (), **tool: Any
) -> sc.Report:
    """The tray's levels, planned and verified."""
    document = {
        "schema": 1,
        "accept": list(accept),
        "part": {"file": "tray.stl", "units": "mm", "model_face": "tool"},
        "setup": {"zero": "model", "sheet": {"thickness": THICKNESS} | (sheet or {})} | (setup or {}),
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": 2 * RADIUS}} | tool},
        "operations": [{"kind": "z-level", "tool": "ball", "step": {"height": 1.0}}],
        "machine": {"name": "linuxcnc"},
    }
    job = sc.Job.from_dict(document, part=sc.Part.from_mesh(*tray()))
    return sc.verify(sc.post(sc.plan(job)).text, job)


def found(report: sc.Report) -> dict[str, Any]:
    """Findings by kind, the worst of each."""
    return {f["kind"]: f for f in sorted(report.findings, key=lambda f: f["value_mm"] or 0.0, reverse=True)}


def farthest(report: sc.Report) -> float:
    """How far out the tool's axis goes while it is below the clamp's top, mm."""
    ends = report.program.moves["end"]
    return float(np.abs(ends[ends[:, 2] < 3.0][:, :2]).max())


def test_a_wide_fixture_is_no_obstacle() -> None:
    fixture = {"clamp": {"opening": [60.0, 60.0], "height": 6.0}, "backing": {"opening": [50.0, 50.0]}}
    report = verified({"fixture": fixture})
    assert report.ok
    assert not report.findings


@pytest.mark.parametrize("margin", [0.0, 2.5])
def test_the_clamp_is_as_far_as_plane_geometry_predicts(margin: float) -> None:
    report = verified({"fixture": {"margin": margin, "clamp": {"opening": [39.0, 60.0], "height": 3.0}}})
    room = 19.5 - farthest(report) - RADIUS
    assert room < 2.5
    if room >= margin:
        assert report.ok
    else:
        finding = found(report)["clamp-collision"]
        assert not report.ok
        assert finding["value_mm"] == pytest.approx(room, abs=1e-6)
        assert finding["limit"] == margin


def test_a_round_clamp_is_met_in_the_corners() -> None:
    report = verified({"fixture": {"margin": 6.0, "clamp": {"opening": 58.0, "height": 3.0}}})
    ends = report.program.moves["end"]
    out = np.hypot(*ends[ends[:, 2] < 3.0][:, :2].T).max()
    assert found(report)["clamp-collision"]["value_mm"] == pytest.approx(29.0 - out - RADIUS, abs=2e-3)


def test_the_holder_meets_the_clamp_that_the_tool_passes() -> None:
    fixture = {"clamp": {"opening": [50.0, 50.0], "height": 6.0}}
    assert verified({"fixture": fixture}, length=12.0).ok
    report = verified({"fixture": fixture}, length=6.0, holder={"diameter": 30.0, "length": 20.0})
    assert "clamp-collision" in found(report)


def test_the_sheet_must_not_touch_the_backing_plate() -> None:
    # tool and sheet reach the wall's back, 45 degrees down from the flange's corner at 20 mm
    back = 20.0 + THICKNESS * np.tan(np.radians(22.5))
    wide = {"margin": 0.0, "backing": {"opening": [2 * back + 3.0, 2 * back + 3.0]}}
    assert verified({"fixture": wide}).ok
    narrow = {"margin": 0.0, "backing": {"opening": [36.0, 80.0]}}
    finding = found(verified({"fixture": narrow}))["backing-collision"]
    assert finding["value_mm"] < -0.5


@pytest.mark.parametrize(("limit", "ok"), [(44.0, False), (45.5, True)])
def test_walls_are_held_against_what_the_sheet_withstands(limit: float, ok: bool) -> None:
    report = verified(sheet={"max_wall_angle_deg": limit})
    assert report.ok == ok
    if not ok:
        assert "at 45.0 degrees" in found(report)["wall-angle"]["message"]


def test_a_risk_that_the_job_takes_by_name_is_a_warning() -> None:
    report = verified(sheet={"max_wall_angle_deg": 44.0}, accept=("wall-angle",))
    finding = found(report)["wall-angle"]
    assert report.ok
    assert finding["severity"] == "warning"
    assert "accepted by the job" in finding["message"]
    with pytest.raises(sc.JobError, match="wall-angel"):
        verified(accept=("wall-angel",))


@pytest.mark.parametrize(("least", "ok"), [(0.72, False), (0.70, True)])
def test_the_sine_law_predicts_how_thin_the_sheet_becomes(least: float, ok: bool) -> None:
    report = verified(sheet={"min_thickness": least})
    assert report.ok == ok
    if not ok:
        assert found(report)["thinning"]["value_mm"] == pytest.approx(np.sqrt(0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("setup", "where"),
    [
        ({"fixture": {"clamp": {"opening": [60.0, 60.0], "height": 9.5}}}, "setup.clearance"),
        ({"fixture": {"clamp": {"opening": 0.0, "height": 3.0}}}, "setup.fixture.clamp.opening"),
        ({"fixture": {"clamp": {"opening": "wide", "height": 3.0}}}, "setup.fixture.clamp.opening"),
        ({"fixture": {"margin": -1.0}}, "setup.fixture.margin"),
        ({"fixture": {"clamp": 3}}, "setup.fixture.clamp"),
        ({"sheet": None, "fixture": {}}, "setup"),
    ],
)
def test_fixtures_that_make_no_sense_are_refused(setup: dict[str, Any], where: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        verified(setup)
    assert refused.value.where is not None
    assert where in refused.value.where


def test_a_sheet_cannot_keep_more_than_it_has() -> None:
    with pytest.raises(sc.JobError) as caught:
        verified(sheet={"min_thickness": 1.5 * THICKNESS})
    assert caught.value.where == "setup.sheet.min_thickness"
