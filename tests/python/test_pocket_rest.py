"""What a larger tool leaves of a pocket, cleared by a smaller one."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import block, text_of

import styluscam as sc

BOX = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)]
NECK = [(0, 0), (20, 0), (20, 8), (25, 8), (25, 0), (40, 0), (40, 20), (25, 20), (25, 14), (20, 14), (20, 20), (0, 20)]
LARGE, SMALL = 4.0, 1.5


def cut_length(path: sc.PocketPath) -> float:
    return sum(float(run.distances[-1]) for run in path.engagement if run.kind == "cut")


@pytest.mark.parametrize("direction", ["climb", "conventional"])
def test_the_corners_that_a_larger_tool_leaves_are_cleared_and_nothing_else(direction: str) -> None:
    large = sc.pocket_path(BOX, tool_radius=LARGE, engagement_deg=60.0, direction=direction)
    rest = sc.pocket_path(BOX, tool_radius=SMALL, engagement_deg=60.0, direction=direction, rest_of=large)
    # between the corners' arcs of both tools, each larger by a twentieth for the smallest radius of its path
    corners = (4.0 - math.pi) * 1.05**2 * (LARGE**2 - SMALL**2)
    assert rest.reachable_area == pytest.approx(corners, rel=0.005)
    assert rest.uncleared_area < 1e-3 and rest.engagement_max_deg < 60.5
    assert not rest.exempt  # no helix: the larger tool has been there
    assert cut_length(rest) < 3.0 * corners / (SMALL * (1.0 - math.cos(math.radians(60.0))))
    cut = np.concatenate([points[:, :2] for points, kind in rest.runs if kind == "cut"])
    away = np.minimum(cut, np.array([30.0, 20.0]) - cut)
    assert (away.max(axis=1) < 2 * LARGE).all()


def test_a_neck_that_only_the_smaller_tool_fits_through_is_cleared_from_its_ends() -> None:
    large = sc.pocket_path(NECK, tool_radius=LARGE, engagement_deg=60.0)
    rest = sc.pocket_path(NECK, tool_radius=SMALL, engagement_deg=60.0, rest_of=[large])
    assert rest.reachable_area > 5 * 6 and rest.uncleared_area < 1e-3
    assert rest.engagement_max_deg < 60.5 and not rest.exempt


def test_the_measured_angle_knows_what_was_cleared_before() -> None:
    # a slot of 8 mm, then a tool of 3 mm straight along its middle, and 1 mm beside its side
    wide = [([[2.0, 10.0], [28.0, 10.0]], LARGE)]
    runs = [([[5.0, 10.0], [25.0, 10.0]], "cut"), ([[5.0, 13.5], [25.0, 13.5]], "cut")]
    middle, side = sc.engagement(runs, SMALL, None, BOX, cleared=wide)
    assert middle.max_deg == 0.0
    along = side.angles_deg[(side.points[:, 0] > 8.0) & (side.points[:, 0] < 22.0)]
    exact = math.degrees(math.acos((4.0 - 3.5 + 1e-3) / SMALL))
    assert along == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize(
    ("cleared", "where"),
    [
        ([5.0], "cleared[0]"),
        ([([[0.0, 0.0]], float("nan"))], "cleared[0].radius"),
        ([([[0.0, math.inf]], 1.0)], "cleared[0]"),
    ],
)
def test_what_is_no_path_of_a_tool_is_refused(cleared: list[Any], where: str) -> None:
    with pytest.raises(sc.GeometryError) as refused:
        sc.engagement([([[0.0, 0.0], [1.0, 0.0]], "cut")], 1.0, None, BOX, cleared=cleared)
    assert str(refused.value.where).startswith(where)
    with pytest.raises(sc.GeometryError, match="rest_of"):
        sc.pocket_path(BOX, tool_radius=SMALL, engagement_deg=60.0, rest_of=cleared)  # type: ignore[arg-type]


def test_nothing_left_is_no_empty_path() -> None:
    path = sc.pocket_path(BOX, tool_radius=SMALL, engagement_deg=60.0)
    with pytest.raises(sc.PlanError, match="nothing"):
        sc.pocket_path(BOX, tool_radius=SMALL, engagement_deg=60.0, rest_of=path)


def job(machine: str = "linuxcnc", tools: tuple[str, ...] = ("large", "small"), **rest: Any) -> sc.Job:
    common = {"kind": "pocket", "step": {"height": 2.0}, "engagement_deg": 80.0, "fit": "arcs"}
    common["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    operations = [{"id": tool, "tool": tool} | common for tool in tools]
    operations[-1] |= rest
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {
            "large": {"number": 1, "profile": {"kind": "flat", "diameter": 6.0}},
            "small": {"number": 2, "profile": {"kind": "flat", "diameter": 2.0}},
        },
        "operations": operations,
        "machine": {"name": machine},
    }
    return sc.Job.from_dict(document, part=block())


def errors(text: str, asked: sc.Job) -> set[str]:
    return {
        finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"] if finding["severity"] == "error"
    }


@pytest.fixture(scope="module")
def text() -> str:
    return text_of(job(rest_machining=True))


def test_the_operation_clears_what_the_ones_before_it_leave(text: str) -> None:
    asked = job(rest_machining=True)
    assert errors(text, asked) == set()
    _, small = sc.plan(asked).summary()[0].operations
    (whole,) = sc.plan(job(tools=("small",))).summary()[0].operations
    small, whole = ({fact.fact: fact.value for fact in one.facts} for one in (small, whole))
    # the corners on two levels
    assert small["to_be_cleared"] == pytest.approx(2 * (4.0 - math.pi) * 1.05**2 * (3.0**2 - 1.0), rel=0.01)
    assert small["cut"] < 0.25 * whole["cut"]


@pytest.mark.parametrize("machine", ["haas", "fanuc"])
def test_other_controllers_and_chords_are_as_sound(machine: str) -> None:
    asked = job(machine, rest_machining=True, fit="lines")
    assert errors(text_of(asked), asked) == set()


def test_the_verifier_takes_nothing_for_cleared_that_was_not(text: str) -> None:
    # for a whole box the corners alone are not enough, and each is cut from the solid
    assert errors(text, job(rest_machining=False)) >= {"engagement", "uncleared"}
    # the larger tool a tenth of a millimetre higher on its last level: it does not come down to the floor's level
    lines = text.splitlines()
    change = next(number for number, line in enumerate(lines) if line.startswith("T2"))
    raised = [re.sub(r"Z2(\.\d+)?\b", "Z2.1", line) for line in lines[:change]] + lines[change:]
    assert raised != lines
    assert "engagement" in errors("\n".join([*raised, ""]), job(rest_machining=True))


def test_without_an_operation_before_or_anything_left_it_is_refused() -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(tools=("small",), rest_machining=True))
    assert refused.value.where == "operations[0].rest_machining" and "before" in str(refused.value)
    with pytest.raises(sc.PlanError, match="operations before leave stock"):
        sc.plan(job(tools=("small", "large"), rest_machining=True))
