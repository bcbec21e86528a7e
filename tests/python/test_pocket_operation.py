"""Pockets as an operation: planned, posted, read back and verified; each defect planted in the posted text is found."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from blocks import FLOOR, SIZE, TOP, WALL, mesh


def block() -> sc.Part:
    """A part of :func:`mesh`."""
    vertices, triangles, faces = mesh()
    return sc.Part.from_mesh(vertices, triangles, face_ids=faces)


def job(machine: str = "linuxcnc", **keys: Any) -> sc.Job:
    operation = {"kind": "pocket", "tool": "mill", "step": {"height": 2.0}, "engagement_deg": 80.0, "fit": "arcs"}
    operation["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"mill": {"profile": {"kind": "flat", "diameter": 4.0}}},
        "operations": [operation | keys],
        "machine": {"name": machine},
    }
    return sc.Job.from_dict(document, part=block())


def text_of(job: sc.Job) -> str:
    (text,) = sc.post(sc.plan(job)).files.values()
    return text


def whole_lines(text: str) -> list[str]:
    """The lines of a text with all words of every move on its own, so that lines can be taken out."""
    lines, at, code = [], dict[str, str](), ""
    for line in text.splitlines():
        found = re.match(r"^(G[0-3])? ?((?:[XYZIJF]-?[\d.]+ ?)+)$", line)
        if found is None:
            lines.append(line)
            continue
        code = found.group(1) or code
        words = {word[0]: word for word in found.group(2).split()}
        at |= {axis: words[axis] for axis in "XYZ" if axis in words}
        lines.append(" ".join([code, *at.values(), *(words[axis] for axis in "IJF" if axis in words)]))
    return lines


@pytest.fixture(scope="module")
def sound() -> tuple[sc.Job, list[str]]:
    """A job, and its text, whose lines can be taken out."""
    asked = job()
    return asked, whole_lines(text_of(asked))


def kinds(job: sc.Job, lines: list[str]) -> set[str]:
    report = sc.verify("\n".join([*lines, ""]), job)
    return {finding["kind"] for finding in report.to_dict()["findings"] if finding["severity"] == "error"}


def roles(lines: list[str], role: str) -> list[int]:
    return [number for number, line in enumerate(lines) if line == f"(role {role})"]


def straight(line: str) -> str:
    return "G1 " + " ".join(word for word in line.split()[1:] if word[0] in "XYZ")


def test_a_pocket_is_planned_and_nothing_is_found(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    assert kinds(asked, lines) == set()
    program = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc")
    heights = np.unique(np.round(program.moves["end"][program.moves["end"][:, 2] < TOP - 1e-6, 2], 3))
    # the floor's level stands on the floor, within the tolerance
    assert heights[-1] < 6.0 and 4.0 in heights and FLOOR < heights[0] < FLOOR + 0.005
    cut = program.moves["end"][program.moves["end"][:, 2] < TOP - 1e-6]
    for axis in (0, 1):
        assert cut[:, axis].min() > WALL + 2.0 and cut[:, axis].max() < SIZE[axis] - WALL - 2.0
        assert cut[:, axis].min() < WALL + 2.02 and cut[:, axis].max() > SIZE[axis] - WALL - 2.02


def test_the_summary_states_levels_areas_and_lengths() -> None:
    (operation,) = sc.plan(job(z_bottom=4.0)).summary()[0].operations
    facts = {fact.fact: fact.value for fact in operation.facts}
    assert operation.words == "1 area on 1 level" and (facts["levels"], facts["areas"]) == (1, 1)
    # the tool's radius and 0.1 mm more round the corners of 14 by 10 mm; 3 um are left on the walls
    assert abs(facts["to_be_cleared"] - (14 * 10 - (4 - np.pi) * 2.1**2)) < 0.4
    # at 80 degrees all along, it would be the area over r (1 - cos 80) of passes
    straight_on = facts["to_be_cleared"] / (2.0 * (1.0 - np.cos(np.radians(80.0))))
    assert straight_on < facts["cut"] < 1.65 * straight_on and facts["not_cutting"] > 0 and "narrow_areas" not in facts


@pytest.mark.parametrize("keys", [{"fit": "lines"}, {"direction": "conventional", "growth_deg": 5.0}])
def test_chords_on_another_controller_and_the_other_direction_are_as_sound(keys: dict[str, Any]) -> None:
    asked = job("grbl", z_bottom=4.0, **keys)
    report = sc.verify(text_of(asked), asked)
    # the floor is deeper, as the job has it
    assert {finding["kind"] for finding in report.to_dict()["findings"]} <= {"missing-level"}


def test_a_pass_that_is_left_out_makes_the_next_one_engage_more(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    links = roles(lines, "link")
    ends = {
        number: min(link for link in links if link > number) for number in roles(lines, "cut") if number < links[-1]
    }
    longest = max(ends, key=lambda number: ends[number] - number)
    assert "engagement" in kinds(asked, lines[:longest] + lines[ends[longest] :])


def test_passes_that_are_missing_at_the_end_leave_stock(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    ends = [number for number, line in enumerate(lines) if line.startswith("G0 Z16")]
    low = next(number for number, line in enumerate(lines) if re.search(r" Z2\.\d+", line))
    cuts = [number for number in roles(lines, "cut") if number > low]
    assert "uncleared" in kinds(asked, lines[: cuts[len(cuts) // 2]] + lines[ends[-1] :])


def test_a_way_down_without_its_helix_is_found(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    ramp = roles(lines, "ramp")[0]
    around = next(number for number, line in enumerate(lines) if number > ramp and "Z4" in line.split())
    spoilt = [*lines[: ramp + 1], straight(lines[around]) + " F300", *lines[around + 1 :]]
    assert "steep-entry" in kinds(asked, spoilt)


@pytest.mark.parametrize(("moves", "kind"), [("G0 Z2", "rapid-into-stock"), ("G1 Z2 F300", "steep-entry")])
def test_a_move_below_the_last_level_is_found(moves: str, kind: str) -> None:
    asked = job(z_bottom=4.0)
    lines = whole_lines(text_of(asked))
    last = max(number for number, line in enumerate(lines) if line.startswith("G0 Z16"))
    spoilt = [*lines[:last], moves, "G0 Z4", *lines[last:]]
    assert kind in kinds(asked, spoilt) - kinds(asked, lines)


def test_a_rapid_down_into_stock_is_found(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    down = next(number for number, line in enumerate(lines) if line.startswith("G1"))
    spoilt = [*lines[:down], "G0 Z4", "G0 Z8", *lines[down:]]
    assert {"rapid-into-stock"} <= kinds(asked, spoilt)


def test_a_level_that_is_missing_is_found(sound: tuple[sc.Job, list[str]]) -> None:
    asked, lines = sound
    low = [number for number, line in enumerate(lines) if re.search(r" Z2\.\d+", line)]
    high = [number for number, line in enumerate(lines) if line.startswith("G0") and number < low[0]]
    end = [number for number, line in enumerate(lines) if line.startswith("G0") and number > low[-1]]
    assert "missing-level" in kinds(asked, lines[: high[-1]] + lines[end[0] :])


@pytest.mark.parametrize(
    ("keys", "where"),
    [
        ({"growth_deg": 20.0}, "operations[0].growth_deg"),
        ({"boundary": {"slope_deg": [0.0, 30.0]}}, "operations[0].boundary"),
        ({"engagement_deg": 5.0}, "operations[0].engagement_deg"),
    ],
)
def test_what_a_pocket_does_not_keep_to_is_refused(keys: dict[str, Any], where: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        job(**keys)
    assert refused.value.where == where and refused.value.hint


def test_a_tool_that_fits_nowhere_is_refused_in_words() -> None:
    asked = job(z_top=4.0)
    document = asked.to_dict()
    document["tools"]["mill"]["profile"]["diameter"] = 12.0
    with pytest.raises(sc.PlanError):
        sc.plan(sc.Job.from_dict(document, part=block()))
