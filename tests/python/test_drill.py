"""Holes that are drilled: found in the part, planned as cycles, and checked hole by hole in the posted text."""

from __future__ import annotations

import re
from typing import Any

import pytest

import rs274
import styluscam as sc
from meridian import FIXTURES

POINT = 1.5021515475689
"""Length of the point of a drill of 5 mm and 118 degrees, mm."""
CORED = {"kind": "mesh", "file": str(FIXTURES / "drilled.step")}
PECKS = {"kind": "peck", "peck": 3.0}


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


def job(machine: str = "linuxcnc", diameter: float = 5.0, faces: Any = "all", tip: float = 0.0, **keys: Any) -> sc.Job:
    profile = {"kind": "v", "tip_diameter": tip, "angle_deg": 118.0, "diameter": diameter}
    # taps and boring tools need the hole: the stock comes with it
    cored = {"stock": CORED} if keys.get("cycle", {}).get("kind") in ("tap", "bore") else {}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / "drilled.step"), "faces": faces},
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "clearance": 30.0, "retract": 14.0, **cored},
            "machine": {"name": machine},
            "tools": {"drill": {"number": 1, "length": 60.0, "profile": profile}},
            "operations": [
                {
                    "kind": "drill",
                    "tool": "drill",
                    "feeds": {"plunge": 200.0},
                    "spindle": {"mode": "fixed", "rpm": 3000.0},
                    **keys,
                }
            ],
        }
    )


def text_of(asked: sc.Job, machine: str = "linuxcnc") -> str:
    return sc.post(sc.plan(asked), machine).text


def kinds(text: str, asked: sc.Job) -> set[str]:
    return {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]}


def bottoms(plan: sc.Plan) -> dict[tuple[float, float], float]:
    """The lowest tip at a feed by hole."""
    lowest: dict[tuple[float, float], float] = {}
    for kind, (x, y, z) in zip(plan.programs["main"].moves["kind"], plan.programs["main"].moves["end"], strict=True):
        if kind == 1:
            at = (round(float(x), 6), round(float(y), 6))
            lowest[at] = min(lowest.get(at, float("inf")), float(z))
    return lowest


@pytest.fixture(scope="module")
def pecked() -> str:
    return text_of(job(cycle=PECKS))


def test_each_hole_is_drilled_to_its_own_depth() -> None:
    through, found = -POINT - 0.5, bottoms(sc.plan(job()))
    expected = {(8.0, 8.0): through, (52.0, 8.0): through, (8.0, 32.0): through, (52.0, 32.0): through}
    expected |= {(20.0, 20.0): 4.0, (20.0, 32.0): 3.0, (30.0, 20.0): 4.0 - POINT}
    assert found.keys() == expected.keys()
    assert all(abs(found[at] - bottom) < 1e-4 for at, bottom in expected.items())


@pytest.mark.parametrize(
    ("cycle", "code"),
    [
        ({"kind": "drill"}, "G81"),
        ({"kind": "drill", "dwell": 0.5}, "G82"),
        (PECKS, "G83"),
        ({"kind": "chip-break", "peck": 2.0}, "G73"),
        ({"kind": "tap", "pitch": 0.8}, "G84"),
        ({"kind": "bore"}, "G85"),
        ({"kind": "bore", "dwell": 0.25}, "G89"),
    ],
)
def test_every_cycle_is_posted_as_the_machine_has_it_and_found_sound(cycle: dict[str, Any], code: str) -> None:
    text = text_of(job(cycle=cycle))
    assert code in text
    assert kinds(text, job(cycle=cycle)) == set()
    if cycle["kind"] != "tap":
        moves = text_of(job("grbl", cycle=cycle), "grbl")
        assert re.search(r"G8[1-9]|G73", moves) is None
        assert kinds(moves, job("grbl", cycle=cycle)) == set()


def test_linuxcnc_drills_the_same_holes(pecked: str) -> None:
    found = rs274.interpret(pecked)
    assert found.ok, found.error
    deepest: dict[tuple[float, float], float] = {}
    for call in found.of("STRAIGHT_FEED"):
        x, y, z = (round(value, 3) for value in call.mm)
        deepest[x, y] = min(deepest.get((x, y), z), z)
    planned = bottoms(sc.plan(job(cycle=PECKS)))
    assert deepest == pytest.approx({at: round(bottom, 3) for at, bottom in planned.items()})


def test_a_counterbored_hole_begins_at_its_own_top() -> None:
    found = text_of(job(diameter=6.8, cycle=PECKS))
    assert re.findall(r"G83.* R([\d.]+)", found) == ["7"]
    assert kinds(found, job(diameter=6.8, cycle=PECKS)) == set()


@pytest.mark.parametrize(
    ("before", "after", "finding"),
    [
        ("X8 Y8\n", "", "missing-hole"),
        ("X8 Y8\n", "X8.02 Y8\n", "extra-hole"),
        ("X20 Y20 Z4 ", "X20 Y20 Z3.9 ", "extra-hole"),
        ("X20 Y20 Z4 ", "X20 Y20 Z4.1 ", "missing-hole"),
        ("X20 Y20 Z4 R13 Q3", "X20 Y20 Z4 R13 Q4", "peck"),
        ("X20 Y20 Z4 ", "X22 Y20 Z4 ", "gouge"),
        ("R13 Q3", "R11.9 Q3", "rapid-plunge"),
        ("R13 Q3", "R12.04 Q3", "rapid-plunge"),
        ("G98", "G99", "low-rapid"),
        ("G83", "G73", "peck"),
    ],
)
def test_a_hole_that_is_missing_elsewhere_or_of_another_depth_is_found(
    pecked: str, before: str, after: str, finding: str
) -> None:
    assert before in pecked
    assert finding in kinds(pecked.replace(before, after, 1), job(cycle=PECKS))


def test_a_rapid_below_what_is_drilled_is_found() -> None:
    asked = job("grbl", cycle=PECKS)
    text = text_of(asked, "grbl")
    assert "rapid-plunge" in kinds(text.replace("Z7.254\n", "Z6.9\n", 1), asked)
    assert "peck" in kinds(text.replace("G0 Z13\nZ10.254\nG1 Z7\n", "Z7\n", 1), asked)


@pytest.mark.parametrize(
    ("after", "added", "finding"),
    [
        ("G1 Z4\n", "X20.5\n", "extra-hole"),
        ("G1 Z4\n", "G0 X20.5\n", "low-rapid"),
        ("G1 Z4\n", "G2 X20 Y20 I0.2 J0\n", "extra-hole"),
        ("G1 Z4\n", "G4 P0.5\n", "dwell"),
        ("G1 Z4\n", "Z3.9\n", "extra-hole"),
    ],
)
def test_what_is_added_at_the_bottom_of_a_hole_is_found(after: str, added: str, finding: str) -> None:
    asked = job("grbl")
    text = text_of(asked, "grbl")
    assert after in text
    assert finding in kinds(text.replace(after, after + added, 1), asked)


@pytest.fixture(scope="module")
def two_drills() -> sc.Job:
    """A drill of 6.8 mm for one hole, T1, and then one of 5 mm for the others, T2."""
    document = job(diameter=6.8).to_dict()
    document["tools"]["narrow"] = job().to_dict()["tools"]["drill"] | {"number": 2}
    document["operations"].append(document["operations"][0] | {"tool": "narrow"})
    return sc.Job.from_dict(document)


@pytest.mark.parametrize(
    ("before", "after", "findings"),
    [
        ("T1 M6\nG43 H1", "T2 M6\nG43 H2", {"tool-differs"}),
        ("T2 M6\nG43 H2", "T1 M6\nG43 H1", {"tool-differs", "gouge"}),
        ("G81 X40 Y20", "G81 X8 Y8", {"extra-hole", "gouge", "missing-hole"}),
        ("G81 X40 Y20", "G81 X45 Y30", {"extra-hole", "gouge", "missing-hole"}),
    ],
)
def test_a_drill_in_a_hole_of_another_diameter_is_found(
    two_drills: sc.Job, before: str, after: str, findings: set[str]
) -> None:
    text = text_of(two_drills)
    assert kinds(text, two_drills) == set() and before in text
    assert kinds(text.replace(before, after, 1), two_drills) >= findings


@pytest.mark.parametrize(
    ("turn", "rise", "finding"),
    [
        ("M4", "G1 Z13 F2400", ""),
        ("", "G1 Z13 F2400", "spindle-differs"),
        ("M4", "G1 Z13 F1200", "feed-differs"),
        ("M4", "G0 Z13", "rapid-into-material"),
    ],
)
def test_a_tap_that_does_not_come_out_as_it_went_in_is_found(turn: str, rise: str, finding: str) -> None:
    asked = job(cycle={"kind": "tap", "pitch": 0.8})
    depth = ""

    def moves(hole: re.Match[str]) -> str:
        nonlocal depth
        depth = hole[2] or depth
        return f"G0 {hole[1]}\nZ13\nG1 Z{depth} F2400\n{turn}\n{rise}\nM3\nG0 Z42\n"

    start, holes = text_of(asked).split("G17\n", 1)
    holes = re.sub(r"(?:G98 G84 )?(X\S+ Y\S+)(?: Z(\S+) R13 F2400)?\n", moves, holes.replace("G80\n", ""))
    assert kinds(start + holes, asked) == ({finding} if finding else set())


def test_a_boring_tool_that_comes_up_at_rapid_is_found() -> None:
    asked = job(cycle={"kind": "bore"})
    assert kinds(text_of(asked).replace("G85", "G81"), asked) == {"rapid-into-material"}


TAP = {"kind": "tap", "pitch": 0.8}


def test_a_tap_in_what_is_solid_is_found_at_every_hole() -> None:
    document = job(cycle=TAP).to_dict()
    del document["setup"]["stock"]
    asked = sc.Job.from_dict(document)
    assert kinds(text_of(asked), asked) == {"missing-hole"}
    found = sc.verify(text_of(asked), asked).to_dict()["findings"]
    assert {finding["severity"] for finding in found} == {"error"}
    assert sum(finding["moves"] for finding in found) == 7


def test_a_hole_that_is_drilled_before_is_tapped_and_not_the_other_way_round() -> None:
    document = job(cycle=TAP).to_dict()
    del document["setup"]["stock"]
    tap = document["operations"][0] | {"id": "tap"}
    drill = job().to_dict()["operations"][0] | {"id": "drill"}
    document["operations"] = [drill, tap]
    asked = sc.Job.from_dict(document)
    assert kinds(text_of(asked), asked) == set()
    document["operations"] = [tap, drill]
    asked = sc.Job.from_dict(document)
    assert kinds(text_of(asked), asked) == {"missing-hole"}


def test_a_wait_that_is_longer_than_asked_is_found() -> None:
    asked = job(cycle={"kind": "drill", "dwell": 0.5})
    assert "dwell" in kinds(text_of(asked).replace("P0.5", "P5"), asked)


def test_over_holes_stands_the_stock_that_the_job_states() -> None:
    document = job(cycle=PECKS).to_dict()
    document["setup"]["stock"] = {"kind": "box", "top": 3.0}
    asked = sc.Job.from_dict(document)
    text = text_of(asked)
    assert set(re.findall(r" R(\S+)", text)) == {"16"}
    assert kinds(text, asked) == set()
    assert "rapid-plunge" in kinds(text.replace("R16", "R13"), asked)


@pytest.mark.parametrize(
    ("cycle", "work", "pitch"), [({"kind": "drill"}, "drilling", None), ({"kind": "tap", "pitch": 0.8}, "tapping", 0.8)]
)
def test_feeds_of_drills_follow_from_the_material(cycle: dict[str, Any], work: str, pitch: float | None) -> None:
    document = job(cycle=cycle).to_dict()
    del document["operations"][0]["feeds"], document["operations"][0]["spindle"]
    document["process"]["material"] = "aluminium"
    document["tools"]["drill"] |= {"cutter_material": "hss", "flutes": 2}
    made = sc.Job.from_dict(document)
    operation = made.document["operations"][0]
    rpm = operation["spindle"]["rpm"]
    tool = {key: document["tools"]["drill"][key] for key in ("profile", "flutes", "cutter_material")}
    table = sc.cutting_data(tool, "aluminium", work, pitch=pitch)
    assert rpm == int(table.rpm)
    assert operation["feeds"]["plunge"] == pytest.approx(table.plunge, abs=1.0)
    posted = {float(feed) for feed in re.findall(r" F(\S+)", text_of(made))}
    assert len(posted) == 1
    assert posted.pop() == pytest.approx(
        table.plunge if pitch is None else pitch * rpm, abs=1.0 if pitch is None else 1e-3
    )
    assert kinds(text_of(made), made) == set()


@pytest.mark.parametrize(
    ("keys", "code", "where"),
    [
        ({"diameter": 6.0}, "wide-hole", "operations[0].diameter_tolerance"),
        ({"diameter": 12.0}, "narrow-hole", "operations[0].tool"),
        ({"faces": ["Face1"]}, "no-hole", "operations[0].faces"),
        ({"depth": "full-diameter"}, "flat-floor", "operations[0].depth"),
        ({"machine": "grbl", "cycle": {"kind": "tap", "pitch": 0.8}}, "no-tapping", "operations[0].cycle"),
        ({"cycle": {"kind": "tap", "pitch": 0.8}, "spindle": {"mode": "off"}}, "conflict", "operations[0].spindle"),
        ({"z_bottom": 1.0}, "conflict", "operations[0].z_bottom"),
    ],
)
def test_what_cannot_be_drilled_is_refused_with_what_to_do(keys: dict[str, Any], code: str, where: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(**keys))
    assert (refused.value.code, refused.value.where) == (code, where)
    assert refused.value.hint


def test_a_hole_across_is_refused_by_its_angle() -> None:
    across = [face for face in range(1, 20) if _refusal(face) == "leaning-hole"]
    assert len(across) == 1


def _refusal(face: int) -> str:
    document = job(faces=[f"Face{face}"]).to_dict()
    document["part"]["allow_undercuts"] = True
    try:
        sc.plan(sc.Job.from_dict(document))
    except sc.JobError as error:
        return error.code
    return ""


def test_stock_above_a_stated_beginning_is_found() -> None:
    document = job().to_dict()
    document["setup"] |= {"stock": {"kind": "box", "top": 3.0, "sides": 1.0}, "clearance": 30.0, "retract": 17.0}
    asked = sc.Job.from_dict(document)
    assert kinds(text_of(asked), asked) == set()
    document["operations"][0]["z_top"] = 12.0
    asked = sc.Job.from_dict(document)
    assert "stock-above" in kinds(text_of(asked), asked)
