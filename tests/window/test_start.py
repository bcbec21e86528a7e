"""What a person sees after FreeCAD's start with the addon."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_start(scenarios: Any) -> None:
    session = scenarios("started")
    assert session["start"]["bars"]
    assert "Traceback" not in session.errors
