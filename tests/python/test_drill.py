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
PECKS = {"kind": "peck", "peck": 3.0}


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


def job(machine: str = "linuxcnc", diameter: float = 5.0, faces: Any = "all", tip: float = 0.0, **keys: Any) -> sc.Job:
    profile = {"kind": "v", "tip_diameter": tip, "angle_deg": 118.0, "diameter": diameter}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / "drilled.step"), "faces": faces},
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "clearance": 30.0, "retract": 14.0},
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
        ("R13 Q3", "R11.9 Q3", "rapid-plunge"),
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
