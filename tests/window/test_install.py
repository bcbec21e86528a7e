"""The addon in a user's folder of addons, and FreeCAD's window without its engine."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_without_the_engine_the_window_starts_and_one_sentence_states_the_command(scenarios: Any) -> None:
    session = scenarios("without_engine", engine=False)
    seen = session["explained"]
    sentence, command = seen["text"].split("; install it with: ")
    assert sentence == "the StylusCAM engine cannot be loaded (No module named 'styluscam')"
    assert command.endswith(f'-m pip install --target "{seen["packages"]}" styluscam')
    assert sentence in session.errors
    assert "Traceback" not in session.errors


def test_without_the_engine_the_rest_of_freecad_works(scenarios: Any) -> None:
    session = scenarios("without_engine", engine=False)
    assert session["unharmed"]["volume"] == pytest.approx(1000.0)
    assert session["unharmed"]["bars"] > 3
