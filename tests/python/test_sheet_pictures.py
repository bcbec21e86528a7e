"""What a picture of a forming job shows: blank, formed sheet, what holds it, die, and the tools on both sides."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.drawing.picture import plan_picture
from styluscam.drawing.section import section
from styluscam.drawing.shapes import Shape, around_plan, shapes_of
from styluscam.drawing.sheet_pane import moment
from styluscam.report import Subject, report_page

pytest.importorskip("OCP", reason="needs the step extra")

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
WALL_DEG = 45.0


def job(process: dict[str, Any], sheet: dict[str, Any] | None = None, **more: Any) -> sc.Job:
    """The cone cup, with few levels."""
    document: dict[str, Any] = {
        "schema": 1,
        "title": "Cup",
        "part": {"file": "cone_cup.step", "model_face": "tool"},
        "setup": {"sheet": sheet or {"thickness": 1.0}},
        "process": process,
        "tools": {
            "stylus": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}},
            "below": {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}},
        },
        "machine": {"name": "linuxcnc"},
        "operations": [{"kind": "z-level", "tool": "stylus", "step": {"height": 6.0}, "tolerance": 0.01}],
        **more,
    }
    return sc.Job.from_dict(document, FIXTURES)


DSIF = {"kind": "dsif", "support_tool": "below", "squeeze": 0.9}


@pytest.fixture(scope="module")
def both_sides() -> sc.Job:
    # few levels, too far apart for a real sheet
    return job(DSIF, machines={"support": {"name": "linuxcnc"}}, accept=["punch"])


@pytest.fixture(scope="module")
def plan(both_sides: sc.Job) -> Any:
    return sc.plan(both_sides)


def named(shapes: tuple[Shape, ...]) -> dict[str, Shape]:
    return {shape.key: shape for shape in shapes}


def volume(shape: Shape) -> float:
    """Of a closed body, mm^3."""
    a, b, c = (shape.vertices[shape.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def area_of(outlines: list[np.ndarray]) -> float:
    """Between outlines that turn around it, mm^2."""
    cross = [x * np.roll(z, -1) - z * np.roll(x, -1) for x, z in (outline[:-1].T for outline in outlines)]
    return abs(sum(float(part.sum()) for part in cross)) / 2.0


def test_the_sheet_has_its_thickness_and_the_blank_its_position() -> None:
    for law in ("constant", "sine"):
        cup = job({"kind": "spif"}, {"thickness": 1.0, "law": law})
        scene = cup.scene()
        shapes = named(shapes_of(cup, scene))
        assert list(shapes) == ["blank", "formed-sheet"]
        low, high = scene.bounds
        blank = shapes["blank"].vertices
        np.testing.assert_allclose(blank.min(axis=0), [low[0], low[1], -1.0], atol=1e-6)
        np.testing.assert_allclose(blank.max(axis=0), [high[0], high[1], 0.0], atol=1e-6)
        formed = shapes["formed-sheet"]
        a, b, c = (formed.vertices[formed.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a) / 2.0
        upper = normals[:, 2] > 1e-9
        per_area = normals[upper, 2].sum() if law == "sine" else np.linalg.norm(normals[upper], axis=1).sum()
        assert volume(formed) == pytest.approx(per_area, rel=0.03 if law == "constant" else 1e-6)
        # the wall's thickness, measured across it in the section: t, and t cos(wall angle) by the sine law
        (outline,) = section(formed, 0.0)
        assert area_of([outline]) == pytest.approx(_length(outline, law), rel=0.03)


def _length(outline: np.ndarray, law: str) -> float:
    """What the section's area must be for 1 mm of sheet: half of its outline, or its width."""
    if law == "sine":
        return float(np.ptp(outline[:, 0]))
    return (float(np.linalg.norm(np.diff(outline, axis=0), axis=1).sum()) - 2.0) / 2.0


def test_a_die_fills_what_is_under_the_sheet_and_does_not_enter_it() -> None:
    cup = job({"kind": "tpif", "die": "female"})
    shapes = named(shapes_of(cup, cup.scene()))
    die, formed = shapes["die"], shapes["formed-sheet"]
    assert die.words == "female die"
    # at the same positions in plan the die's upper side is the sheet's lower one: as sections by the same plane show
    (sheet_outline,), (die_outline,) = section(formed, 3.0), section(die, 3.0)
    for x in np.linspace(-40.0, 40.0, 33):
        under = min(_crossings(sheet_outline, x))
        assert max(_crossings(die_outline, x)) == pytest.approx(under, abs=1e-6)
    assert formed.vertices[:, 2].min() - die.vertices[:, 2].min() > 5.0


def _crossings(outline: np.ndarray, x: float) -> list[float]:
    a, b = outline[:-1], outline[1:]
    crossed = (a[:, 0] < x) != (b[:, 0] < x)
    a, b = a[crossed], b[crossed]
    return list(a[:, 1] + (b[:, 1] - a[:, 1]) * (x - a[:, 0]) / (b[:, 0] - a[:, 0]))


def test_the_tools_of_both_sides_leave_the_squeezed_sheet_between_them(both_sides: sc.Job, plan: Any) -> None:
    posted = sc.post(plan)
    report = sc.verify(posted, both_sides)
    assert report.ok, [finding.message for finding in report.findings]
    subject = Subject.judged(report, both_sides.machine(), "main.ngc")
    tips = subject.opposite_tips
    assert tips.shape == subject.positions.shape
    apart = np.linalg.norm(subject.positions - tips + np.array([0.0, 0.0, 8.0]), axis=1)
    on_wall = (subject.positions[:, 2] < -3.0) & (subject.kinds == 2)
    assert on_wall.sum() > 100
    # the balls' middles are both radii and what is left of the sheet apart
    close = np.abs(apart[on_wall] - (5.0 + 3.0 + 0.9)) < 0.03
    assert close.mean() > 0.9
    tip, other = moment(plan.programs["main"], 0.0, around_plan(plan, "main").opposite)
    assert abs(tip[1]) < 0.5 and np.linalg.norm(tip - other + [0.0, 0.0, 8.0]) == pytest.approx(8.9, abs=0.05)


def test_a_picture_from_the_other_side_has_the_same_sheet(plan: Any) -> None:
    main, support = (named(tuple(around_plan(plan, channel).shapes)) for channel in ("main", "support"))
    for key, shape in main.items():
        # other points of it are left out for the drawing: those of the two may differ by its tolerance
        turned = shape.vertices * [1.0, -1.0, -1.0]
        np.testing.assert_allclose(turned.min(axis=0), support[key].vertices.min(axis=0), atol=0.02)
        assert volume(shape) == pytest.approx(volume(support[key]), rel=2e-3)


def test_the_pages_shapes_are_the_engines_and_have_layers(both_sides: sc.Job, plan: Any, tmp_path: Path) -> None:
    posted = sc.post(plan)
    subject = Subject.judged(sc.verify(posted, both_sides), both_sides.machine(), "main.ngc")
    page = report_page(subject)
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])
    assert [shape["key"] for shape in data["shapes"]] == ["blank", "formed-sheet"]
    assert data["opposite"]["tips"]["count"] == len(subject.positions)
    assert re.findall(r'data-layer="([^"]+)"', page.split("<script")[0]) == [
        "blank",
        "formed-sheet",
        "tool",
        "opposite",
    ]
    shapes = len(json.dumps(data["shapes"]))
    assert shapes + len(json.dumps(data["standing"])) < 600_000
    for channel in ("main", "support"):
        plan_picture(plan, tmp_path / f"{channel}.png", channel)
        assert (tmp_path / f"{channel}.png").stat().st_size > 30_000


def test_milling_has_no_sheet() -> None:
    cup = sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": "cone_cup.step"},
            "process": {"kind": "milling"},
            "tools": {"a": {"profile": {"kind": "ball", "diameter": 6.0}}},
            "machine": {"name": "linuxcnc"},
            "operations": [
                {"kind": "z-level", "tool": "a", "step": {"height": 6.0}, "spindle": {"mode": "fixed", "rpm": 8000.0}}
            ],
        },
        FIXTURES,
    )
    assert shapes_of(cup, cup.scene()) == ()
