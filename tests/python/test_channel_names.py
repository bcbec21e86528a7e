"""Channels by their names: calls and engine refuse one that there is not in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from conftest import box, milling_document

import styluscam as sc
from styluscam import _engine
from styluscam.drawing.picture import plan_picture

BALL = {"kind": "ball", "diameter": 6.0}


@pytest.fixture(scope="module")
def plan() -> sc.Plan:
    document = milling_document("zig-zag", BALL, stepover=3.0, tolerance=0.01)
    part = sc.Part.from_mesh(*box([-5.0, -5.0, -5.0], [5.0, 5.0, 0.0]))
    return sc.plan(sc.Job.from_dict(document, part=part))


CALLS: dict[str, Callable[[sc.Plan, Any], object]] = {
    "scene": lambda plan, name: plan.job.scene(channel=name),
    "machine": lambda plan, name: plan.job.machine(name),
    "summary": lambda plan, name: plan.summary(channel=name),
    "picture": lambda plan, name: plan_picture(plan, "plan.png", name),
    "check": lambda plan, name: sc.check_program(plan, channel=name),
    "verify": lambda plan, name: sc.verify("M2\n", plan.job, channel=name),
    "engine's job": lambda plan, name: plan.job.engine.machine_of(name),
    "engine's plan": lambda plan, name: plan.engine.summary(name, *engines_of(plan)),
    "engine's reader": lambda plan, name: _engine.read_back(plan.job.engine, plan.machine.engine, "M2\n", name),
}


def engines_of(plan: sc.Plan) -> tuple[_engine.Scene, _engine.Machine]:
    scene, machine = plan.settings["main"]
    return scene, machine.engine


@pytest.mark.parametrize("call", CALLS)
def test_a_channel_that_there_is_not_is_refused_in_one_sentence(call: str, plan: sc.Plan) -> None:
    with pytest.raises(sc.StylusError) as caught:
        CALLS[call](plan, "side")
    error = caught.value
    assert (str(error), error.hint) == ('unknown channel "side"', "channels: main")
    assert (error.code, error.where) == ("argument", "channel")


@pytest.mark.parametrize("name", (5, None, "", ["main"]))
def test_what_is_no_name_of_a_channel_is_refused(name: Any, plan: sc.Plan) -> None:
    for call in ("scene", "machine", "summary", "picture", "check"):
        with pytest.raises(sc.StylusError, match="expected the name of a channel, got") as caught:
            CALLS[call](plan, name)
        assert caught.value.where == "channel"


def test_a_long_name_is_shortened(plan: sc.Plan) -> None:
    with pytest.raises(sc.JobError) as caught:
        plan.job.machine("s" * 1000)
    assert len(str(caught.value)) < 100
