"""The stock of a job in FreeCAD is the stock of the job document."""

from __future__ import annotations

from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_extended_boxes_are_counted_from_the_part(session: Any) -> None:
    assert session["stock"]["extended"] == {
        "section": {"kind": "box", "low": [-1.0, -12.0, -23.0], "high": [44.0, 35.0, 11.0]},
        "top": 11.0,
    }


def test_a_box_lies_where_it_is(session: Any) -> None:
    assert session["stock"]["box"]["section"] == {"kind": "box", "low": [-5.0, -15.0, -22.0], "high": [45.0, 45.0, 8.0]}


def test_a_cylinder_around_the_part_stays_one(session: Any) -> None:
    seen = session["stock"]["cylinder"]
    assert seen == {"section": {"kind": "cylinder", "diameter": 70.0, "top": 2.0, "bottom": 2.0}, "top": 7.0}


def test_other_stock_is_held_by_its_bounding_box(session: Any) -> None:
    """A box turned by 45 degrees is as wide as its diagonal; a cylinder beside the middle as its diameter."""
    turned, beside = (session["stock"][name]["section"] for name in ("turned box", "cylinder beside"))
    half = 100.0 / 2.0**0.5
    assert turned["low"] == pytest.approx([20.0 - half, -60.0, -22.0], abs=1e-6)
    assert turned["high"] == pytest.approx([20.0 + half, -60.0 + 2.0 * half, 8.0], abs=1e-6)
    assert beside["low"] == pytest.approx([-25.0, -40.0, -22.0], abs=1e-6)
    assert beside["high"] == pytest.approx([75.0, 60.0, 7.0], abs=1e-6)


def test_a_job_without_stock_states_none(session: Any) -> None:
    assert session["stock"]["none"] == {"section": None, "top": 5.0}
