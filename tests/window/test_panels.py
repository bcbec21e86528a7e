"""Every panel of ours, widget by widget, in FreeCAD's light and dark themes."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]

THEMES = ("light", "dark")

TOGETHER = ("1.1",)
"""Versions whose panels can be looked at in one session: those with PySide6."""


@pytest.fixture(params=THEMES)
def session(request: pytest.FixtureRequest, window: Any, scenarios: Any) -> Any:
    """The session with a scenario."""

    def of(name: str) -> Any:
        alone = () if window.version in TOGETHER else (name,)
        variant = "-".join([request.param, *alone]).replace(" ", "-")
        return scenarios("panels", variant, only=alone, theme=request.param, timeout=500.0)

    return of


def test_what_is_wrong_with_a_panel_is_found(session: Any) -> None:
    found = session("faults")["faults"]
    for part in (
        "QLabel short 'A label that is too long for its width': its text needs",
        "QLabel over 'One label over' and QLabel under 'another one' overlap by 200 x 10 pixels",
        "QLabel faint 'Hardly to be read': contrast 1.",
        "QLabel outside 'Cut off': reaches out of",
    ):
        assert len([line for line in found if line.startswith(part)]) == 1, (part, found)
    assert len(found) == 4


def test_every_command_in_the_bars_has_an_icon(session: Any) -> None:
    seen = session("workbench")["workbench"]
    assert seen["bars"] >= 3
    assert seen["without icon"] == []


@pytest.mark.parametrize(("name", "texts"), [("operation 0", 10), ("operation 1", 10), ("tool", 7), ("preferences", 5)])
def test_texts_of_panels_fit_and_stand_out(session: Any, name: str, texts: int) -> None:
    seen = session(name)[name]
    assert [line for panel in seen.values() for line in panel["findings"]] == []
    assert min(panel["texts"] for panel in seen.values()) >= texts
    assert "Traceback" not in session(name).errors
