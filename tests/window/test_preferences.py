"""Our page in FreeCAD's preferences."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_a_folder_that_is_none_is_refused_in_a_sentence_and_not_stored(scenarios: Any) -> None:
    session = scenarios("preferences")
    seen = session["folder that is none"]
    sentence = "the folder of machine files /no/such/folder does not exist: choose one, or leave the line empty for the default"
    assert seen["problems"] == [sentence] and seen["text"] == sentence
    assert seen["same"]
    assert seen["folder"] == "unset" and seen["verifies"]
    assert seen["user folder"] == seen["placeholder"] and seen["placeholder"].endswith("/StylusCAM/machines")
    assert "Traceback" not in session.errors


def test_what_is_chosen_is_stored_and_used(scenarios: Any) -> None:
    session = scenarios("preferences")
    seen = session["chosen"]
    assert seen["text"] == ""
    assert seen["folder"] == seen["user folder"] == seen["shown"]["folder"] == seen["wanted"]
    assert "styluscam_shop" in seen["posts"], "a machine file of the folder is a post"
    assert seen["machine"] == "grbl" and seen["post"] == "styluscam_grbl"
    assert seen["default of CAM"] == "", "CAM's own setting stays as it was"
    assert seen["shown"]["machine"] == "grbl"
    assert seen["shown"]["machines"][0] == "not stated"
    assert not seen["verifies"] and not seen["shown"]["verifies"]
    assert "Traceback" not in session.errors
