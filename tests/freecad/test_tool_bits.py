"""Stylus tool bits, and FreeCAD's own where there is a profile for them."""

from __future__ import annotations

import math
from typing import Any

import pytest

pytestmark = [pytest.mark.world, pytest.mark.freecad]


def test_a_stylus_has_an_exact_profile_and_lengths(session: Any) -> None:
    seen = session["tool bit"]
    assert seen["kind"] == "stylus"
    assert seen["profile"] == '{"kind": "clothoid", "diameter": 10.0}'
    diameter, height, length, shank = seen["lengths"]
    assert (diameter, shank) == pytest.approx((10.0, 10.0))
    assert length == pytest.approx(height + 40.0)
    assert seen["odd"] == 3.175


def test_its_solid_stands_on_its_tip(session: Any) -> None:
    seen = session["tool bit"]
    _, height, length, _ = seen["lengths"]
    assert seen["valid"]
    assert seen["box"] == pytest.approx([10.0, 10.0, 0.0, length], abs=1e-6)
    cylinder = math.pi * 25.0 * (length - height)
    assert cylinder < seen["volume"] < cylinder + math.pi * 25.0 * height


def test_a_stylus_does_not_turn(session: Any) -> None:
    assert session["tool bit"]["commands"] == ["(TC: Stylus)", "M6"]
    lines = session["two tools"]["post"]["text"].splitlines()
    assert "M5" in lines
    assert not any(line.endswith(("M3", "M4")) for line in lines)


def test_lengths_follow_an_edited_profile(session: Any) -> None:
    diameter, height, volume = session["tool bit"]["edited"]
    assert (diameter, height) == pytest.approx((6.0, 3.0))
    assert volume != pytest.approx(session["tool bit"]["volume"], rel=1e-3)
    seen = session["milling ball"]
    assert (seen["diameter"], seen["height"]) == pytest.approx((10.0, 5.0))
    assert "ball D10" in seen["post"]["text"]


def test_a_native_ball_end_mill_turns_under_flood(session: Any) -> None:
    seen = session["native bits"]["ballend"]
    lines = seen["post"]["text"].splitlines()
    assert "S5000 M3" in lines
    assert lines.index("S5000 M3") < lines.index("M8") < lines.index("M9")
    assert lines.index("M9") < lines.index("M5", lines.index("M9"))


def test_a_probe_has_no_profile(session: Any) -> None:
    assert "no profile is known for a bit of shape 'probe'" in session["native bits"]["probe"]["first"]
