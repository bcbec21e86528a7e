"""Where passes may run: check faces, boundaries and edges, planned, posted, and checked by the verifier."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import FIXTURES, Mesh
from numpy.typing import NDArray

import styluscam as sc

RADIUS = 3.0
BALL = {"kind": "ball", "diameter": 2 * RADIUS}
CUP = ["Face1", "Face2", "Face3", "Face4"]
"""The cone cup from its floor to its rim."""
HALF = [[[-60.0, -60.0], [60.0, -60.0], [60.0, 3.0], [-60.0, 3.0]]]
"""A wire around the half of a part in front of Y3."""


def job(file: str, faces: list[str], kind: str = "z-level", part: Any = None, **more: Any) -> sc.Job:
    """A job that mills with a ball; `setup`, `machine` and `tool` beside the operation's own keys."""
    pitch = {"stepover": 2.0} if kind == "zig-zag" else {"step": {"height": 2.0}}
    document = {
        "schema": 1,
        "part": {"file": file, "faces": faces},
        "setup": more.pop("setup", {}),
        "process": {"kind": "milling"},
        "tools": {"tool": {"profile": BALL, **more.pop("tool", {})}},
        "machine": {"name": more.pop("machine", "linuxcnc")},
        "operations": [{"kind": kind, "tool": "tool", "spindle": {"mode": "fixed", "rpm": 8000.0}, **pitch, **more}],
    }
    return sc.Job.from_dict(document, folder=FIXTURES, part=part)


def verified(planned: sc.Job, text: str | None = None) -> tuple[NDArray[np.float64], sc.Report]:
    """Positions along passes, and the report of the job's text, or of another one."""
    report = sc.verify(text or sc.post(sc.plan(planned)).text, planned)
    moves = report.program.moves
    ends = np.array(moves["end"])
    return ends[ends[:, 2] < -1e-3], report


def kinds(report: sc.Report) -> set[str]:
    return {finding["kind"] for finding in report.findings}


def ring(middle: float, radius: float, z: float, count: int = 48) -> list[tuple[float, float, float]]:
    angles = 2 * np.pi * np.arange(count) / count
    return [(middle + radius * np.cos(a), radius * np.sin(a), z) for a in angles]


def cup(middle: float, count: int = 48) -> Mesh:
    """A cone of 45 degrees, 12 mm deep, with a level floor, in a ring of land up to 16 mm from its axis."""
    rings = [ring(middle, 18.0, 0.0), ring(middle, 16.0, 0.0), ring(middle, 4.0, -12.0)]
    last = 3 * count
    triangles = []
    for k in range(2):
        for i in range(count):
            a, b = count * k + i, count * k + (i + 1) % count
            triangles += [(a, b, a + count), (b, b + count, a + count)]
    triangles += [(2 * count + i, 2 * count + (i + 1) % count, last) for i in range(count)]
    return np.array([*rings[0], *rings[1], *rings[2], (middle, 0.0, -12.0)]), np.array(triangles)


@pytest.fixture(scope="module")
def two_cups() -> sc.Part:
    """Two cups whose rims are 6 mm apart; faces 1 to 3 are the one at X-19, 4 to 6 the one at X19."""
    left, right = cup(-19.0), cup(19.0)
    vertices = np.vstack([left[0], right[0]])
    triangles = np.vstack([left[1], right[1] + len(left[0])])
    rows = len(left[1])
    of_one = np.repeat([1, 2, 3], [96, 96, 48])
    assert rows == len(of_one)
    return sc.Part.from_mesh(vertices, triangles, face_ids=np.concatenate([of_one, of_one + 3]))


# --- check faces -------------------------------------------------------------------------------------------------


def depth_beside(land: float, clearance: float) -> float:
    """How deep the ball's tip goes at most on a wall of 45 degrees that ends in a level floor `land` lower, when it stays that
    far off the floor."""
    return land - clearance


@pytest.mark.parametrize("kind", ["z-level", "spiral", "zig-zag"])
@pytest.mark.parametrize("clearance", [0.0, 1.5])
def test_a_wall_is_cut_where_the_floor_is_as_near_as_the_clearance(
    two_cups: sc.Part, kind: str, clearance: float
) -> None:
    planned = job("made.stl", ["Face2"], kind, two_cups, check_faces=["Face3"], check_clearance=clearance)
    ends, report = verified(planned)
    assert not report.findings
    assert ends[:, 0].max() < 0.0, "the other cup is not selected"
    assert ends[:, 2].min() > -12.0 + clearance
    if kind == "zig-zag":  # cut where the clearance is used up, and not before
        assert ends[:, 2].min() == pytest.approx(-12.0 + clearance, abs=0.04)


def test_the_tool_with_its_holder_keeps_off_the_other_cup(two_cups: sc.Part) -> None:
    """The holder is 20 mm wide 8 mm over the tip: deep in the one cup it would reach over the other one's land."""
    holder = {"length": 8.0, "holder": {"diameter": 30.0, "length": 20.0}}
    keys = {"check_faces": ["Face4", "Face5"], "check_clearance": 1.0}
    with_holder, report = verified(job("made.stl", ["Face2"], "z-level", two_cups, tool=holder, **keys))
    assert "check-clearance" not in kinds(report)
    without, free = verified(job("made.stl", ["Face2"], "z-level", two_cups, **keys))
    assert not free.findings
    # below -8 the holder is lower than the land, whose nearest point is 1 mm from X0: 15 mm and the clearance off the axis
    deep = with_holder[with_holder[:, 2] < -7.0]
    land = np.hypot(deep[:, 0] - 19.0, deep[:, 1]) - 18.0
    assert land.min() > 16.0 - 1e-6
    deep = without[without[:, 2] < -7.0]
    assert (np.hypot(deep[:, 0] - 19.0, deep[:, 1]) - 18.0).min() < 15.0


def test_the_verifier_finds_a_tool_that_comes_too_near(two_cups: sc.Part) -> None:
    keys = {"check_faces": ["Face3"], "check_clearance": 1.5}
    text = sc.post(sc.plan(job("made.stl", ["Face2"], "z-level", two_cups))).text
    _, report = verified(job("made.stl", ["Face2"], "z-level", two_cups, **keys), text)
    found = [finding for finding in report.findings if finding["kind"] == "check-clearance"]
    assert found
    assert found[0]["severity"] == "error"
    assert found[0]["position"][2] < -10.4
    assert min(finding["value"] for finding in found) < 0.5
    assert not verified(job("made.stl", ["Face2"], "z-level", two_cups), text)[1].findings


def test_rest_is_everything_else_and_other_operations_are_free(two_cups: sc.Part) -> None:
    one = job("made.stl", ["Face2"], "z-level", two_cups, check_faces="rest", check_clearance=1.0)
    document = one.to_dict()
    other = {**document["operations"][0], "faces": ["Face5"], "check_faces": ["Face6"], "check_clearance": 0.0}
    document["operations"].append(other)
    both = sc.Job.from_dict(document, part=two_cups)
    ends, report = verified(both)
    assert not report.findings
    left, right = ends[ends[:, 0] < 0.0], ends[ends[:, 0] > 0.0]
    # 1 mm off the land: by a ball of 3 mm on a wall of 45 degrees, its tip is 1.7 mm below where it touches the edge
    assert left[:, 2].max() < right[:, 2].max() - 0.5


@pytest.mark.parametrize(
    ("keys", "where", "words"),
    [
        ({"check_faces": ["Face2"]}, "operations[0].check_faces", "Face2 is selected"),
        ({"check_faces": ["Face9"]}, "operations[0].check_faces[0]", 'no face "Face9"'),
        ({"check_faces": "all"}, "operations[0].check_faces", "rest"),
        ({"check_faces": []}, "operations[0].check_faces", "no face is named"),
        ({"check_clearance": 1.0}, "operations[0].check_clearance", "none are named"),
        ({"check_faces": "rest", "check_clearance": 11.0}, "operations[0].check_clearance", "rapids"),
        ({"boundary": {}}, "operations[0].boundary", "states nothing"),
        ({"boundary": {"wire": [[[0.0, 0.0], [1.0, 0.0]]]}}, "operations[0].boundary.wire[0]", "2 corners"),
        ({"boundary": {"slope_deg": [60.0, 30.0]}}, "operations[0].boundary.slope_deg", "holds no slope"),
        ({"boundary": {"wire": HALF, "face_edges": True}}, "operations[0].boundary.face_edges", "one of them"),
    ],
)
def test_what_makes_no_region_is_refused(two_cups: sc.Part, keys: Any, where: str, words: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job("made.stl", ["Face2"], "z-level", two_cups, **keys))
    assert refused.value.where == where
    assert words in str(refused.value)


def test_a_region_that_leaves_nothing_is_an_error_that_names_it(two_cups: sc.Part) -> None:
    far = [[[50.0, 50.0], [60.0, 50.0], [60.0, 60.0]]]
    with pytest.raises(sc.PlanError, match="and the boundary"):
        sc.plan(job("made.stl", ["Face2"], "z-level", two_cups, boundary={"wire": far}))


# --- boundaries --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["z-level", "spiral", "zig-zag"])
@pytest.mark.parametrize(("inside", "end"), [("centre", 3.0), ("tool", 3.0 - RADIUS)])
def test_passes_end_on_a_wire_to_a_thousandth(two_cups: sc.Part, kind: str, inside: str, end: float) -> None:
    """The machine posts a thousandth: half of that is what the text can be off; planning cuts to a millionth."""
    keys: Any = {"boundary": {"wire": HALF, "inside": inside}, "machine": "grbl" if kind == "z-level" else "linuxcnc"}
    if kind == "zig-zag":
        keys["angle_deg"] = 90.0
    ends, report = verified(job("made.stl", ["Face2"], kind, two_cups, **keys))
    assert not report.findings
    at_end = ends[ends[:, 1] > end - 1e-3]
    assert ends[:, 1].max() <= end + 5.1e-4
    assert len(at_end) >= 4, "most levels and rows come to the wire"


def test_planned_ends_lie_on_the_wire_to_a_millionth(two_cups: sc.Part) -> None:
    plan = sc.plan(job("made.stl", ["Face2"], "z-level", two_cups, boundary={"wire": HALF}))
    ends = np.array(plan.programs["main"].moves["end"])
    ends = ends[ends[:, 2] < 0.0]
    assert np.all(ends[:, 1] <= 3.0)
    assert np.count_nonzero(ends[:, 1] > 3.0 - 1e-6) >= 12, "both ends of six levels"


def test_a_contact_ends_on_the_wire_where_it_touches(two_cups: sc.Part) -> None:
    """Beyond the wire by what lies between axis and contact on the wall of 45 degrees."""
    wire = [[[-60.0, -60.0], [-25.0, -60.0], [-25.0, 60.0], [-60.0, 60.0]]]
    keys = {"boundary": {"wire": wire, "inside": "contact"}}
    ends, report = verified(job("made.stl", ["Face2"], "zig-zag", two_cups, stepover=1.0, **keys))
    assert not report.findings
    row = ends[np.abs(ends[:, 1]) < 0.6]
    assert row[:, 0].max() == pytest.approx(-25.0 + RADIUS * np.sqrt(0.5), abs=0.01)


def test_a_loop_inside_another_is_an_island(two_cups: sc.Part) -> None:
    outer = [[-60.0, -60.0], [0.0, -60.0], [0.0, 60.0], [-60.0, 60.0]]
    island = [[-21.0, -60.0 + 1.0], [-17.0, -59.0], [-17.0, 59.0], [-21.0, 59.0]]
    ends, report = verified(job("made.stl", ["Face2"], "zig-zag", two_cups, boundary={"wire": [outer, island]}))
    assert not report.findings
    assert not np.any((ends[:, 0] > -21.0 + 1e-3) & (ends[:, 0] < -17.0 - 1e-3))
    assert np.any(ends[:, 0] < -22.0)
    assert np.any((ends[:, 0] > -16.0) & (ends[:, 0] < 0.0))


def test_slopes_take_the_wall_of_the_cone_cup_alone() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    planned = job("cone_cup.step", CUP, "z-level", boundary={"slope_deg": [30.0, 60.0]})
    ends, report = verified(planned)
    assert not report.findings
    # of the floor's fillet, 8 mm, from 30 degrees on: the ball's tip is (8 - 3) (1 - cos 30) over the floor
    assert ends[:, 2].min() > -25.0 + 5.0 * (1.0 - np.cos(np.radians(30.0))) - 0.02
    # of the rim, 4 mm, up to 30 degrees: 7 (1 - cos 30) below the land
    assert ends[:, 2].max() < -7.0 * (1.0 - np.cos(np.radians(30.0))) + 0.02
    whole = sc.post(sc.plan(job("cone_cup.step", CUP))).text
    found = [one for one in verified(planned, whole)[1].findings if one["kind"] == "outside-boundary"]
    assert found and found[0]["unit"] == "deg"


def test_a_wire_around_one_side_of_the_pyramid_in_forming() -> None:
    """Cut loops are open passes a step apart: no punch, and nothing is expected of the other sides."""
    pytest.importorskip("OCP", reason="needs the step extra")
    side = [[[9.0, -9.0], [60.0, -9.0], [60.0, 9.0], [9.0, 9.0]]]
    document = {
        "schema": 1,
        "part": {"file": "pyramid.step", "model_face": "tool"},
        "setup": {"sheet": {"thickness": 1.0}},
        "tools": {"tool": {"profile": BALL}},
        "machine": {"name": "linuxcnc"},
        "operations": [{"kind": "z-level", "tool": "tool", "step": {"height": 0.5}, "boundary": {"wire": side}}],
    }
    ends, report = verified(sc.Job.from_dict(document, folder=FIXTURES))
    assert not report.findings
    assert np.abs(ends[:, 1]).max() <= 9.0 + 6e-4
    assert ends[:, 2].min() < -15.0
    walls = [face for face in report.coverage() if face["area"] > 200.0]
    assert [face["face"] for face in walls] == [22], "of the four sides one, and of that all"
    assert walls[0]["covered"] > 0.95


def dxf(*entities: list[tuple[int, Any]], unit: int = 4) -> str:
    pairs = [
        (0, "SECTION"),
        (2, "HEADER"),
        (9, "$INSUNITS"),
        (70, unit),
        (0, "ENDSEC"),
        (0, "SECTION"),
        (2, "ENTITIES"),
    ]
    pairs += [pair for entity in entities for pair in entity] + [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs)


def line(a: tuple[float, float], b: tuple[float, float]) -> list[tuple[int, Any]]:
    return [(0, "LINE"), (10, a[0]), (20, a[1]), (11, b[0]), (21, b[1])]


def test_a_dxf_bounds_passes_as_its_polylines_do(two_cups: sc.Part, tmp_path: Path) -> None:
    """A half disc of a line and a bulge of 1, in inches, and a circle; lines in any order and direction."""
    half = [(0, "LWPOLYLINE"), (90, 2), (70, 1), (10, -2.0), (20, 0.0), (42, 1.0), (10, 2.0), (20, 0.0), (42, 0.0)]
    circle = [(0, "CIRCLE"), (10, -0.75), (20, -0.25), (40, 0.125)]
    triangle = [line((5.0, 5.0), (6.0, 5.0)), line((6.0, 6.0), (6.0, 5.0)), line((6.0, 6.0), (5.0, 5.0))]
    (tmp_path / "outline.dxf").write_text(dxf(half, circle, *triangle, unit=1))
    planned = job("made.stl", ["Face2"], "z-level", two_cups, boundary={"wire": HALF}).to_dict()
    planned["operations"][0]["boundary"] = {"file": "outline.dxf"}
    read = sc.Job.from_dict(planned, folder=tmp_path, part=two_cups)
    wires = [np.array(one) for one in read.to_dict()["operations"][0]["boundary"]["wire"]]
    by_size = sorted(wires, key=lambda wire: float(np.ptp(wire[:, 0])))
    assert np.allclose(np.hypot(by_size[0][:, 0] + 19.05, by_size[0][:, 1] + 6.35), 3.175)
    assert sorted(map(tuple, np.round(by_size[1] / 25.4, 6).tolist())) == [(5.0, 5.0), (6.0, 5.0), (6.0, 6.0)]
    assert np.allclose(np.hypot(*by_size[2].T), 50.8)
    middles = 0.5 * (by_size[2][1:] + by_size[2][:-1])
    assert 0.0 < 50.8 - np.hypot(*middles.T)[1:-1].min() <= 0.001
    assert tmp_path / "outline.dxf" in read.inputs()
    ends, report = verified(read)
    assert not report.findings
    assert ends[:, 1].max() <= 5e-4


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (dxf(line((0.0, 0.0), (1.0, 0.0))), "do not close"),
        (dxf([(0, "SPLINE"), (70, 8)]), "holds a SPLINE"),
        (dxf(), "no line, arc"),
        (dxf(unit=20), "INSUNITS = 20"),
        ("AutoCAD Binary DXF\n\n", "ASCII"),
        ("what is in it\n", "no section ENTITIES"),
        (dxf([(0, "LINE"), (10, 0.0), (20, 0.0)]), "a LINE has no group code 11"),
        (dxf([(0, "CIRCLE"), (10, "x"), (20, 0.0), (40, 1.0)]), "line 18: x is no number"),
        (dxf([(0, "CIRCLE"), (10, "nan"), (20, 0.0), (40, 1.0)]), "nan is no number"),
        (dxf([(0, "CIRCLE"), (10, 0.0), (20, 0.0), (40, -5.0)]), "the radius -5"),
    ],
)
def test_a_dxf_that_bounds_nothing_is_refused(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "outline.dxf").write_text(text)
    document = job("made.stl", ["Face2"], boundary={"slope_deg": [10.0, 60.0]}).to_dict()
    document["operations"][0]["boundary"]["file"] = "outline.dxf"
    with pytest.raises(sc.GeometryError) as refused:
        sc.Job.from_dict(document, folder=tmp_path)
    assert words in str(refused.value) + refused.value.hint


def test_the_verifier_finds_contacts_outside_the_wire(two_cups: sc.Part) -> None:
    text = sc.post(sc.plan(job("made.stl", ["Face2"], "z-level", two_cups))).text
    bounded = job("made.stl", ["Face2"], "z-level", two_cups, boundary={"wire": HALF})
    found = [one for one in verified(bounded, text)[1].findings if one["kind"] == "outside-boundary"]
    assert found
    # the highest level's axis is 16 mm from the cup's, but for what the ball stands off the wall
    assert max(one["value"] for one in found) == pytest.approx(16.0 - 2.0 - 3.0, abs=3.0)


def test_the_verifier_misses_a_pass_inside_the_boundary_only(two_cups: sc.Part) -> None:
    """A level taken out of the bounded text is missed; outside the wire nothing is expected."""
    bounded = job("made.stl", ["Face2"], "z-level", two_cups, boundary={"wire": HALF}, step={"height": 1.0})
    text = sc.post(sc.plan(bounded)).text
    assert not verified(bounded, text)[1].findings
    lifted = text.replace("Z-5.854", "Z-4.854")
    assert lifted != text
    assert {"missing-level", "missing-pass", "excess"} & kinds(verified(bounded, lifted)[1])


# --- from pass to pass -------------------------------------------------------------------------------------------


def test_low_rapids_keep_clear_of_check_faces(two_cups: sc.Part) -> None:
    """From cup to cup over their lands, 3 mm above them though half a millimetre above the stock is asked for."""
    keys: Any = {"links": "low", "link_margin": 0.5, "check_faces": ["Face1", "Face4"], "check_clearance": 3.0}
    keys["order"] = "by-level"  # by areas it crosses once
    planned = job("made.stl", ["Face2", "Face5"], "z-level", two_cups, **keys)
    _, report = verified(planned)
    assert not report.findings
    moves = report.program.moves
    ends, is_rapid = np.array(moves["end"]), np.array(moves["kind"]) == 0
    crossings = ends[1:, 2][is_rapid[1:] & (np.abs(np.diff(ends[:, 0])) > 20.0)]
    assert len(crossings) > 1
    assert 3.0 < crossings.min() < 5.0
    keys["check_faces"] = ["Face3", "Face6"]
    low = sc.post(sc.plan(job("made.stl", ["Face2", "Face5"], "z-level", two_cups, **keys))).text
    assert "check-clearance" in kinds(verified(planned, low)[1])


@pytest.mark.parametrize(
    ("keys", "fact", "words"),
    [
        ({"lead": "vertical", "lead_radius": 3.0}, "leads", "none fits"),
        ({"turns": "looped", "turn_radius": 3.0}, "straight_turns", "where no turn fits"),
    ],
)
def test_leads_and_turns_keep_clear_of_check_faces(two_cups: sc.Part, keys: Any, fact: str, words: str) -> None:
    """Rows end as near to the land as its clearance: whatever goes on from there along the wall comes nearer."""
    region = {"check_faces": ["Face1"], "check_clearance": 1.5}
    planned = job("made.stl", ["Face2"], "zig-zag", two_cups, **keys, **region)
    plan = sc.plan(planned)
    found = {one.fact: one.words for one in plan.summary()[0].operations[0].facts}
    assert words in found[fact]
    assert not sc.verify(sc.post(plan), planned).findings


# --- edges -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("edges", "highest"), [("stop", -RADIUS * (1 - np.sqrt(0.5))), ("roll", 0.0)])
def test_the_tool_rolls_over_the_edge_or_stops_at_it(two_cups: sc.Part, edges: str, highest: float) -> None:
    """On the wall's upper edge the ball's tip rises from where it touches at 45 degrees to where it stands on it."""
    ends, report = verified(job("made.stl", ["Face2"], "zig-zag", two_cups, edges=edges))
    assert not report.findings
    assert ends[:, 2].max() == pytest.approx(highest, abs=0.06)


def test_the_verifier_finds_contacts_on_faces_that_are_not_selected(two_cups: sc.Part) -> None:
    text = sc.post(sc.plan(job("made.stl", ["Face2", "Face3"], "zig-zag", two_cups))).text
    report = verified(job("made.stl", ["Face2"], "zig-zag", two_cups), text)[1]
    found = [one for one in report.findings if one["kind"] == "unselected-contact"]
    assert found
    assert found[0]["position"][2] == pytest.approx(-12.0, abs=0.01)
