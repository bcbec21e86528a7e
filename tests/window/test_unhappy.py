"""What goes wrong in a window ends with a sentence, and with a whole document."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


@pytest.fixture
def session(scenarios: Any) -> Any:
    return scenarios("unhappy")


def test_a_document_is_not_closed_while_it_is_computed(session: Any) -> None:
    seen = session["closed during computation"]
    assert "cancel that first" in seen["refused"] and seen["open"]


def test_of_two_tools_the_chosen_one_is_used(session: Any) -> None:
    seen = session["two controllers"]
    assert seen["asked"] and seen["state"] == ["Up-to-date"]
    assert "text" in seen["post"], seen["post"]
    text = seen["post"]["text"]
    assert "T2 M6" in text and "T1 M6" not in text
    assert "TC: Second states no HorizFeed and no VertFeed" in seen["notes"][-1]


@pytest.mark.parametrize(
    ("name", "sentence"), [("without profile", "profile"), ("deleted model", "the job has 0 models")]
)
def test_it_fails_without_motion_and_is_not_posted(session: Any, name: str, sentence: str) -> None:
    seen = session[name]
    assert "Invalid" in seen["state"] and seen["motions"] == 0
    assert sentence in seen["first"]
    assert "has failed" in seen["post"]["refused"]


def test_a_refused_post_is_a_sentence_in_a_dialog(session: Any) -> None:
    seen = session["post refused"]
    assert "has failed" in seen["failed"] and not seen["written"]
    assert "no file can be written there" in seen["folder"]


def test_a_panel_outlives_its_job(session: Any) -> None:
    assert session["job deleted under panel"]["closed"]


def test_no_traceback(session: Any) -> None:
    assert "Traceback" not in session.errors
