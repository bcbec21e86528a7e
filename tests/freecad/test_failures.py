"""An operation that fails holds no motion, is Invalid, and is not posted."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]

REASONS = {
    "no step": "step is missing",
    "low clearance": "ClearanceHeight is -30 mm, and the top of what is worked on lies at",
    "no tolerance": "ModelTolerance = 0 mm: allowed is 0.0001 to 1 mm",
    "no faces": "no face is selected",
    "other model": "no Face2, Face3, Face4 any more",
    "no controller": "has no tool",
    "deleted controller": "has no tool",
    "no model face": "Model face must state",
    "other diameter": "its profile's 0.001 mm",
    "engine raises": "the engine [broke] in two lines",
    "engine is gone": "pip install --target",
}


@pytest.mark.parametrize("name", REASONS)
def test_no_motion_stays(session: Any, name: str) -> None:
    seen = session[name]
    assert seen["before"] > 100, "it must have had a path to lose"
    after = seen["after"]
    assert "Invalid" in after["state"]
    assert (after["commands"], after["motions"]) == (1, 0)
    assert REASONS[name] in after["first"]


@pytest.mark.parametrize("name", REASONS)
def test_it_is_not_posted(session: Any, name: str) -> None:
    post = session[name]["after"]["post"]
    assert "text" not in post
    assert REASONS[name] in post["refused"]


def test_a_controller_without_a_bit_is_not_posted(session: Any) -> None:
    """FreeCAD 1.1 computes nothing behind a failed controller: our post is what stands between."""
    after = session["no bit"]["after"]
    assert "text" not in after["post"]
    assert after["motions"] == 0 or "Touched" in after["state"]


def test_a_changed_operation_is_not_posted(session: Any) -> None:
    assert "recompute" in session["touched"]["post"]["refused"]


def test_text_that_enters_the_part_is_not_posted(session: Any) -> None:
    seen = session["tampered"]
    assert seen["state"] == ["Up-to-date"]
    assert "the tool enters the part by 0.04" in seen["post"]["refused"]
