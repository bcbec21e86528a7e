"""The tutorial's steps lead to a verified program, in both versions."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_tutorial(scenarios: Any) -> None:
    session = scenarios("tutorial")
    seen = session["tutorial"]
    assert seen["state"] == ["Up-to-date"] and seen["motions"] > 1000
    assert "judged from this text: worst gouge 0.0000 mm" in seen["text"]
    assert seen["process"] == "spif" and "clothoid" in seen["text"]
    assert "T2 M6" in seen["text"].splitlines()
    assert "Traceback" not in session.errors
