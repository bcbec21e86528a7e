"""Examples open computed and are posted."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_examples(scenarios: Any) -> None:
    session = scenarios("examples")
    seen = session["opened"]
    assert set(seen) == {"StylusCAM_Example_FormedCup", "StylusCAM_Example_MilledDome"}
    for name, example in seen.items():
        assert example["state"] == ["Up-to-date"], (name, example)
        assert example["motions"] > 500
        assert "judged from this text: worst gouge 0.0000 mm" in example["post"]["text"]
    assert "Traceback" not in session.errors
