"""Links from pass to pass: how high rapids go, and what the verifier finds where they are too low."""

from __future__ import annotations

import itertools
import re
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import styluscam as sc
from styluscam.programs.program import ROLES

RAPID = 0
MARGIN = 1.0
CLEARANCE = 10.0
STEP = 1.0
Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]


def squares(
    pits: list[tuple[float, float]], rings: list[tuple[float, float]], cell: tuple[float, float, float]
) -> Mesh:
    """Square pits about (x, y), each of rings (half side, height), in cells (half side, half side, height) that touch."""
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    points: list[npt.NDArray[np.float64]] = []
    triangles: list[tuple[int, int, int]] = []
    for middle in pits:
        first = sum(len(ring) for ring in points)
        sides = [(np.array(cell[:2]), cell[2]), *((np.array([half, half]), height) for half, height in rings)]
        points += [np.column_stack([middle + half * corners, np.full(4, height)]) for half, height in sides]
        for base in range(first, first + 4 * len(rings), 4):
            for i in range(4):
                a, b = base + i, base + (i + 1) % 4
                triangles += [(a, b, b + 4), (a, b + 4, a + 4)]
        last = first + 4 * len(rings)
        triangles += [(last, last + 1, last + 2), (last, last + 2, last + 3)]
    return np.concatenate(points), np.array(triangles)


def two_pits() -> Mesh:
    """Two square pits of 45 degrees, 8 mm deep, side by side in a flat sheet."""
    return squares([(-20.0, 0.0), (20.0, 0.0)], [(16.0, 0.0), (8.0, -8.0)], (20.0, 20.0, 0.0))


def pits_in_a_pit() -> Mesh:
    """The same in the floor of a pit that is 4 mm deep."""
    vertices, triangles = squares([(-20.0, 0.0), (20.0, 0.0)], [(16.0, -4.0), (8.0, -12.0)], (20.0, 20.0, -4.0))
    around = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    rings = [(40.0, 20.0, -4.0), (44.0, 24.0, 0.0), (54.0, 34.0, 0.0)]
    outer = np.concatenate([np.column_stack([around * [x, y], np.full(4, z)]) for x, y, z in rings])
    base = len(vertices)
    sides = [(base + r + i, base + r + (i + 1) % 4) for r in (0, 4) for i in range(4)]
    walls = [half for a, b in sides for half in ((a, a + 4, b + 4), (a, b + 4, b))]
    return np.concatenate([vertices, outer]), np.concatenate([triangles, np.array(walls)])


PARTS = {"two": two_pits(), "nested": pits_in_a_pit()}
SPINDLE = {"mode": "fixed", "rpm": 8000.0}


def job(part: str, machine: str = "linuxcnc", process: dict[str, Any] | None = None, **keys: Any) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"clearance": CLEARANCE, "sheet": {"thickness": 1.0}},
        "process": process or {"kind": "spif", "max_bridged": 5.0},
        "tools": {"t": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
        "operations": [{"kind": "z-level", "tool": "t", "tolerance": 0.01, "step": {"height": STEP}, **keys}],
        "machine": {"name": machine},
    }
    if document["process"]["kind"] == "milling":
        del document["setup"]["sheet"]
        document["operations"][0]["spindle"] = SPINDLE
    else:
        document["part"]["model_face"] = "tool"
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*PARTS[part]))


@lru_cache(maxsize=8)
def posted(part: str, links: str, machine: str = "linuxcnc") -> tuple[sc.Job, sc.Plan, str]:
    asked = job(part, machine, links=links)
    plan = sc.plan(asked)
    (text,) = sc.post(plan).files.values()
    return asked, plan, text


def crossings(program: sc.Program) -> npt.NDArray[np.float64]:
    """Heights of the rapids that go sideways, the first one left out."""
    moves = program.moves
    ends = moves["end"]
    sideways = np.any(np.abs(np.diff(ends[:, :2], axis=0)) > 1e-9, axis=1) & (moves["kind"][1:] == RAPID)
    return np.asarray(ends[1:][sideways][:, 2])


def facts(plan: sc.Plan) -> dict[str, Any]:
    return {fact.fact: fact for fact in plan.summary()[0].operations[0].facts}


def findings(text: str, asked: sc.Job) -> list[Any]:
    return list(sc.verify(text, asked).findings)


def test_links_cross_a_margin_above_the_flat_sheet() -> None:
    asked, plan, text = posted("two", "low")
    heights = crossings(plan.programs["main"])
    assert len(heights) >= 6  # between the pits, level by level
    assert np.all((heights >= MARGIN) & (heights < MARGIN + 0.05)), heights
    assert findings(text, asked) == []
    by_clearance = posted("two", "clearance")[1].programs["main"]
    assert np.all(crossings(by_clearance) == CLEARANCE)
    assert by_clearance.duration - plan.programs["main"].duration > 0.1 * by_clearance.duration
    assert facts(plan)["low_links"].value == len(heights)
    assert "low_links" not in facts(posted("two", "clearance")[1])


def test_links_in_a_pit_cross_what_hangs_in_its_loops() -> None:
    asked, plan, text = posted("nested", "low")
    heights = crossings(plan.programs["main"])
    # the pit's floor is at -4; its last loop before it parts is at -3 or lower
    lower = heights[heights < 0.0]
    assert len(lower) >= 6 and np.all((lower >= -4.0 + MARGIN) & (lower <= -3.0 + MARGIN + 0.05)), heights
    assert findings(text, asked) == []


def lowered(text: str, by: float) -> str:
    """The text with its first link that much lower, mm."""
    height = re.search(r"^G0 Z(1(?:\.0\d*)?)$", text, re.MULTILINE)
    assert height
    return f"{text[: height.start()]}G0 Z{float(height[1]) - by:.3f}{text[height.end() :]}"


@pytest.mark.parametrize(("by", "kinds"), [(0.1, {"low-rapid"}), (3.0, {"low-rapid", "rapid-into-material"})])
def test_a_link_too_low_over_the_part_is_found(by: float, kinds: set[str]) -> None:
    asked, _, text = posted("two", "low")
    found = findings(lowered(text, by), asked)
    assert kinds <= {finding.kind for finding in found}
    assert "Z" in next(finding for finding in found if finding.kind == "low-rapid").message


def crossed_inside(text: str, height: float) -> str:
    """The text with a rapid across the middle of the first pit after its first loop."""
    link = re.search(r"^G0 Z1(?:\.0\d*)?\n", text, re.MULTILINE)
    assert link
    first_is_left = re.findall(r"X(-?[\d.]+)", text[: link.start()])[-1].startswith("-")
    middle = -20.0 if first_is_left else 20.0
    planted = [f"G0 X{middle} Y0", f"Z{height}", f"X{middle + 4.0}", "Z1.2", ""]
    return text[: link.end()] + "\n".join(planted) + text[link.end() :]


def test_a_link_too_low_over_sheet_that_is_not_formed_yet_is_found() -> None:
    """The part is 8 mm deep there, and the sheet hangs from the first loop, at -1."""
    asked, _, text = posted("two", "low")
    assert findings(crossed_inside(text, 0.5), asked) == []
    for height in (-0.3, -4.0):
        found = findings(crossed_inside(text, height), asked)
        assert {finding.kind for finding in found} == {"low-rapid"}, height
        assert all("the sheet" in finding.message for finding in found)
        assert found[0].limit == pytest.approx(-STEP, abs=0.02)


def test_low_rapids_are_found_where_the_job_does_not_ask_for_them() -> None:
    asked, _, _ = posted("two", "clearance")
    found = findings(posted("two", "low")[2], asked)
    assert {finding.kind for finding in found} == {"low-rapid", "deep-rapid"}
    assert any("below the clearance height" in finding.message for finding in found)


def test_rapids_that_may_not_go_straight_stay_at_clearance() -> None:
    asked, plan, text = posted("two", "low", "fanuc")
    assert np.all(crossings(plan.programs["main"]) == CLEARANCE)
    assert facts(plan)["low_links"].value == 0.0 and "fanuc" in facts(plan)["low_links"].words
    assert findings(text, asked) == []
    low = posted("two", "low")[1].programs["main"]
    (written,) = sc.post(low, "fanuc").files.values()
    assert "low-rapid" in {finding.kind for finding in findings(written, asked)}


def test_another_dialect_has_the_same_links() -> None:
    asked, plan, text = posted("two", "low", "grbl")
    assert np.all(crossings(plan.programs["main"]) < MARGIN + 0.05)
    assert findings(text, asked) == []


def test_milling_crosses_above_the_stock() -> None:
    asked = job("nested", process={"kind": "milling"}, links="low", order="by-level")
    plan = sc.plan(asked)
    heights = crossings(plan.programs["main"])
    assert len(heights) > 6 and np.all((heights >= MARGIN) & (heights < MARGIN + 0.05)), heights
    (text,) = sc.post(plan).files.values()
    assert findings(text, asked) == []
    found = findings(lowered(text, 0.5), asked)
    assert {finding.kind for finding in found} == {"low-rapid"} and "stock" in found[0].message


def test_two_tools_that_keep_pace_have_no_low_links() -> None:
    document = {**job("two", links="low").to_dict(), "process": {"kind": "dsif"}}
    document["tools"]["below"] = {**document["tools"]["t"], "number": 2}
    document["process"]["support_tool"] = "below"
    with pytest.raises(sc.JobError, match="cross at clearance"):
        sc.Job.from_dict(document)


LEAD = ROLES.index("lead")
MILLING = {"kind": "milling"}


@lru_cache(maxsize=8)
def with_leads(lead: str, process: str = "spif", **keys: Any) -> tuple[sc.Job, sc.Plan, str]:
    feeds = {"cut": 1200.0, "plunge": 250.0, "approach": 600.0, "exit": 900.0}
    asked = job(
        "two", process=MILLING if process == "milling" else None, lead=lead, feeds=feeds, seam_direction_deg=0.0, **keys
    )
    plan = sc.plan(asked)
    (text,) = sc.post(plan).files.values()
    return asked, plan, text


def leads_of(program: sc.Program) -> list[npt.NDArray[Any]]:
    """The moves of each lead, with the one before."""
    is_lead = program.moves["role"] == LEAD
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_lead, [False]]).astype(int)))
    return [program.moves[first - 1 : end] for first, end in edges.reshape(-1, 2)]


@pytest.mark.parametrize("links", ["clearance", "low"])
def test_vertical_leads_come_down_tangent_to_their_pass(links: str) -> None:
    asked, plan, text = with_leads("vertical", lead_radius=1.0, lead_angle_deg=60.0, links=links)
    found = leads_of(plan.programs["main"])
    assert len(found) == facts(plan)["leads"].value >= 16
    for lead in found:
        rise = lead["end"][:, 2].max() - lead["end"][:, 2].min()
        along = np.linalg.norm(lead["end"][-1, :2] - lead["end"][0, :2])
        assert rise == pytest.approx(0.5, abs=1e-6) and along == pytest.approx(np.sin(np.pi / 3), abs=1e-6)
        assert set(lead["feed"][1:]) in ({600.0}, {900.0})
    assert findings(text, asked) == []
    assert "(role lead)" in text and " F600" in text and " F900" in text


def test_tangent_leads_are_arcs_on_the_free_side() -> None:
    asked, plan, text = with_leads("tangent", "milling", lead_radius=1.5, order="by-level")
    found = leads_of(plan.programs["main"])
    assert len(found) == facts(plan)["leads"].value >= 16
    assert all(len(lead) == 2 and np.ptp(lead["end"][:, 2]) < 1e-9 for lead in found)
    chords = [np.linalg.norm(np.diff(lead["end"][:, :2], axis=0)) for lead in found]
    assert chords == pytest.approx([1.5 * np.sqrt(2.0)] * len(found), abs=1e-6)
    inside = [np.abs(lead["end"][:, :2]) for lead in found]
    assert all(np.all(ends[:, 1] < 16.0) for ends in inside)
    arcs = [line for line in text.splitlines() if re.match(r"G[23] ", line)]
    assert len(arcs) == len(found)
    assert findings(text, asked) == []


def test_no_lead_presses_sheet_down_before_its_pass() -> None:
    """At the height of the pass the sheet inside hangs a step higher, until the loop is closed."""
    asked, plan, text = with_leads("tangent", lead_radius=1.5)
    program = plan.programs["main"]
    assert {move["feed"] for lead in leads_of(program) for move in lead[1:]} == {900.0}
    assert "none fits" in facts(plan)["leads"].words
    assert findings(text, asked) == []


def test_where_no_lead_fits_the_tool_goes_straight() -> None:
    asked, plan, text = with_leads("tangent", "milling", lead_radius=40.0)
    assert leads_of(plan.programs["main"]) == [] and "none fits" in facts(plan)["leads"].words
    assert findings(text, asked) == []


@pytest.mark.parametrize(
    ("process", "lead", "out"), [("milling", "tangent", 2), ("milling", "vertical", 2), ("spif", "vertical", 9)]
)
def test_loops_begin_where_leads_fit(process: str, lead: str, out: int) -> None:
    """Nearest to each other the loops of square pits begin in their corners, where the next wall is in the way."""
    asked = job("two", process=MILLING if process == "milling" else None, lead=lead, lead_radius=2.0)
    plan = sc.plan(asked)
    (text,) = sc.post(plan).files.values()
    fact = facts(plan)["leads"]
    assert fact.words == f"{out} leads in and {out} out; 16 loops begin where they fit"
    assert len(leads_of(plan.programs["main"])) == fact.value == 2 * out
    assert findings(text, asked) == []


def test_loops_begin_where_the_seam_is_asked_for() -> None:
    corner = job("two", process=MILLING, lead="tangent", lead_radius=2.0, seam_direction_deg=45.0)
    words = facts(sc.plan(corner))["leads"].words
    assert words.startswith("0 leads in and 0 out; none fits 2 times") and "without seam_direction_deg" in words


def test_leads_fit_beside_upright_walls() -> None:
    """There a path as far off as its tolerance lets it be is under the top's edge, which the tool is beside."""
    angles = np.linspace(0.0, 2.0 * np.pi, 65)[:-1]
    rings = [np.column_stack([20.0 * np.cos(angles), 20.0 * np.sin(angles), np.full(64, z)]) for z in (-12.0, 0.0)]
    vertices = np.concatenate([*rings, [[0.0, 0.0, -12.0], [0.0, 0.0, 0.0]]])
    turn = [(i, (i + 1) % 64) for i in range(64)]
    triangles = [
        *((i, j, 64 + j) for i, j in turn),
        *((i, 64 + j, 64 + i) for i, j in turn),
        *((128, j, i) for i, j in turn),
        *((129, 64 + i, 64 + j) for i, j in turn),
    ]
    PARTS["disc"] = (vertices, np.array(triangles))
    for lead in ("tangent", "vertical"):
        asked = job("disc", process=MILLING, lead=lead, lead_radius=2.0)
        plan = sc.plan(asked)
        assert "none fits" not in facts(plan)["leads"].words and facts(plan)["leads"].value >= 2
        (text,) = sc.post(plan).files.values()
        assert findings(text, asked) == []


def test_a_lead_that_enters_the_part_is_found() -> None:
    asked, _, text = with_leads("tangent", "milling", lead_radius=1.5)
    lines = text.splitlines()
    number = next(i for i, line in enumerate(lines) if re.match(r"G[23] ", line))
    (end,) = re.findall(r"X(-?[\d.]+)", lines[number])
    x = float(end)
    outward = np.sign(x - np.copysign(20.0, x))
    past = [f"G1 X{x + 0.5 * outward:.3f} F600", f"X{end}"]  # on, half a millimetre into the wall, and back
    found = findings("\n".join([*lines[: number + 1], *past, *lines[number + 1 :]]), asked)
    assert "gouge" in {finding.kind for finding in found}


def test_a_lead_at_another_feed_is_found() -> None:
    asked, _, text = with_leads("vertical", lead_radius=1.0, lead_angle_deg=60.0, links="clearance")
    assert {finding.kind for finding in findings(text.replace(" F600", " F1100", 1), asked)} == {"feed-differs"}


def plate(columns: int, rows: int) -> Mesh:
    """Square pits of 60 degrees, 6 mm deep, 30 mm apart."""
    pits = [(30.0 * i, 30.0 * j) for i in range(columns) for j in range(rows)]
    return squares(pits, [(10.0, 0.0), (6.5, -6.0)], (15.0, 15.0, 0.0))


PARTS["plate"] = plate(4, 3)


def air(program: sc.Program) -> float:
    """Length of all rapids and of the feeds down after them, mm."""
    moves = program.moves
    lengths = np.linalg.norm(np.diff(moves["end"], axis=0), axis=1)
    is_rapid = moves["kind"][1:] == RAPID
    is_down = ~is_rapid & np.concatenate([[False], is_rapid[:-1]])
    return float(lengths[is_rapid | is_down].sum())


def areas_in_order(program: sc.Program) -> list[tuple[float, float]]:
    """The pits of the plate in which the tool is, as it goes from one to the next."""
    moves = program.moves
    pits = [tuple(np.round(end[:2] / 30.0)) for end in moves["end"][moves["kind"] != RAPID]]
    return [pit for number, pit in enumerate(pits) if number == 0 or pits[number - 1] != pit]


@pytest.mark.parametrize("machine", ["linuxcnc", "grbl"])
def test_areas_are_milled_one_after_the_other(machine: str) -> None:
    asked = job("plate", machine, MILLING)
    plan = sc.plan(asked)
    order = areas_in_order(plan.programs["main"])
    assert len(order) == len(set(order)) == 12
    # from pit to pit, to a neighbour each time
    assert all(abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1.0 for a, b in itertools.pairwise(order))
    by_level = sc.plan(job("plate", machine, MILLING, order="by-level")).programs["main"]
    assert len(areas_in_order(by_level)) > 50
    assert air(plan.programs["main"]) < 0.2 * air(by_level)
    (text,) = sc.post(plan).files.values()
    assert findings(text, asked) == []


def test_a_sheet_is_formed_evenly_unless_areas_are_asked_for() -> None:
    by_level = posted("two", "clearance")[1].programs["main"]
    z = by_level.moves["end"][:, 2][by_level.moves["kind"] != RAPID]
    assert np.all(np.diff(z) < 1e-9)
    asked = job("nested", order="by-area", links="low")
    plan = sc.plan(asked)
    assert air(plan.programs["main"]) < 0.6 * air(posted("nested", "low")[1].programs["main"])
    assert facts(plan)["between_passes"].value > 0.0
    (text,) = sc.post(plan).files.values()
    assert findings(text, asked) == []


def test_an_area_formed_before_the_one_around_it_is_found() -> None:
    asked = job("nested", order="by-area")
    (text,) = sc.post(sc.plan(asked)).files.values()
    lines = text.splitlines()
    rises = [number for number, line in enumerate(lines) if re.fullmatch(rf"G0 Z{CLEARANCE:.0f}(\.0*)?", line)]
    start, begin, end = (number + 1 for number in rises[:3])  # the pit, the first pit in it, the second
    planted = [*lines[:start], *lines[begin:end], *lines[start:begin], *lines[end:]]
    found = {finding.kind for finding in findings("\n".join(planted) + "\n", asked)}
    assert "punch" in found, found


def test_a_frame_that_goes_down_does_not_come_up_again() -> None:
    document = {**job("two", order="by-area").to_dict(), "process": {"kind": "tpif", "die": "male"}}
    with pytest.raises(sc.JobError, match="by-area"):
        sc.Job.from_dict(document)


def test_rows_around_holes_are_done_area_by_area() -> None:
    rows = {"kind": "zig-zag", "stepover": 2.0, "boundary": {"slope_deg": [0.0, 10.0]}}
    document = job("plate", process=MILLING).to_dict()
    document["operations"] = [{"tool": "t", "tolerance": 0.01, "spindle": SPINDLE, **rows}]
    asked = sc.Job.from_dict(document, part=sc.Part.from_mesh(*PARTS["plate"]))
    plan = sc.plan(asked)
    by_nearest = re.search(r"([\d.]+) mm with the nearest", facts(plan)["between_passes"].words)
    assert by_nearest and facts(plan)["between_passes"].value < 0.3 * float(by_nearest[1])
    (text,) = sc.post(plan).files.values()
    assert findings(text, asked) == []


def test_rows_are_linked_across_a_hole_at_a_feed_where_the_part_stands_no_higher(tmp_path: Path) -> None:
    import trimesh

    plate = trimesh.creation.annulus(4.0, 20.0, 5.0)  # its top at Z2.5
    pillar = trimesh.creation.cylinder(1.5, 20.0)  # up to Z10
    for body, crossed in ((plate, True), (trimesh.util.concatenate([plate, pillar]), False)):
        body.export(tmp_path / "part.stl")
        asked = sc.Job.from_dict(
            {
                "schema": 1,
                "part": {"file": str(tmp_path / "part.stl"), "units": "mm", "faces": "all", "tolerance": 0.001},
                "process": {"kind": "milling", "max_unreached": 1.0},
                "setup": {"zero": "model", "clearance": 5.0, "stock": {"kind": "box", "sides": 1.0}},
                "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 6.0}}},
                "operations": [
                    {
                        "kind": "zig-zag",
                        "tool": "ball",
                        "stepover": 1.0,
                        "links": "low",
                        "z_bottom": 2.4,
                        "spindle": SPINDLE,
                    }
                ],
                "machine": {"name": "linuxcnc"},
            }
        )
        text = sc.post(sc.plan(asked), "linuxcnc").text
        moves = sc.read_gcode(text, "linuxcnc").moves
        links = moves[moves["role"] == ROLES.index("link")]
        assert (len(links) >= 6) == crossed, len(links)
        # no higher than the proof that nothing stands there asks for
        assert all(2.4 <= z < 2.6 for z in links["end"][:, 2]), links["end"][:, 2]
        assert not [one for one in sc.verify(text, asked).to_dict()["findings"] if one["severity"] == "error"]
