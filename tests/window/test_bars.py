"""Our commands in our own workbench and in CAM's, whichever is opened first."""

from __future__ import annotations

from typing import Any

import pytest

import roots
import styluscam as sc

pytestmark = [pytest.mark.world, pytest.mark.freecad]

FIRST = ["CAMWorkbench", "StylusCamWorkbench"]


@pytest.fixture(params=FIRST)
def session(request: pytest.FixtureRequest, scenarios: Any) -> Any:
    preferences = {**roots.PREFERENCES, "General": {"AutoloadModule": request.param}}
    return scenarios("bars", request.param, preferences=preferences)


def operations() -> list[str]:
    kinds = [kind["properties"]["kind"]["const"] for kind in sc.job_schema()["$defs"]["OperationSection"]["oneOf"]]
    return [f"StylusCAM_Operation_{kind.replace('-', ' ').title().replace(' ', '')}" for kind in kinds]


def test_our_workbench_has_every_command_once(session: Any) -> None:
    for name, seen in session["switched"]:
        if name != "StylusCamWorkbench":
            continue
        in_bars = [command for commands in seen["bars"].values() for command in commands]
        assert {"StylusCAM_Job", "StylusCAM_Post", *operations()} <= set(in_bars)
        assert len(in_bars) == len(set(in_bars))
        (menu,) = seen["menus"].values()
        assert set(in_bars) <= set(menu) and len(menu) == len(set(menu))


def test_cam_has_the_operations_in_its_bar_and_menu(session: Any) -> None:
    for name, seen in session["switched"]:
        if name != "CAMWorkbench":
            continue
        (bar,) = (commands for commands in seen["bars"].values() if commands)
        assert bar.count("StylusCAM_Operations") == 1
        menu = seen["menus"]["CAM"]
        assert [command for command in menu if command in operations()] == operations()
        assert len(menu) == len(set(menu))


def test_other_workbenches_have_none(session: Any) -> None:
    assert [seen for name, seen in session["switched"] if name == "PartWorkbench"] == [{"bars": {}, "menus": {}}]


def test_what_needs_a_job_is_not_active_without_one(session: Any) -> None:
    active = session["without a document"]
    assert not any(active[name] for name in [*operations(), "StylusCAM_Post"])


def test_no_traceback(session: Any) -> None:
    assert "Traceback" not in session.errors
