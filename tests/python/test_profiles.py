"""Profiles against closed forms worked out in high precision, and the published check numbers."""

from __future__ import annotations

import json
import re

import mpmath as mp
import numpy as np
import pytest

import styluscam as sc

mp.mp.dps = 40
SLOPES = (1e-6, 0.01, 0.2, 0.5, np.pi / 4, 1.0, 1.3, 1.5)
RIGHT = np.pi / 2


def clothoid(diameter):
    unit = mp.mpf(diameter) / 2 / mp.fresnelc(1)

    def at(slope):
        x = mp.sqrt(2 * slope / mp.pi)
        return unit * mp.fresnelc(x), unit * mp.fresnels(x), unit / (mp.pi * x)

    return at


def power(c, p):
    c, p = mp.mpf(c), mp.mpf(p)

    def at(slope):
        r = (mp.tan(slope) / (c * p)) ** (1 / (p - 1))
        return r, c * r**p, (1 + mp.tan(slope) ** 2) ** mp.mpf("1.5") / (c * p * (p - 1) * r ** (p - 2))

    return at


def ellipse(a, b):
    a, b = mp.mpf(a), mp.mpf(b)

    def at(slope):
        s, c = mp.sin(slope), mp.cos(slope)
        q = mp.sqrt(a**2 * s**2 + b**2 * c**2)
        return a**2 * s / q, b - b**2 * c / q, a**2 * b**2 / q**3

    return at


def circle(radius):
    radius = mp.mpf(radius)
    return lambda slope: (radius * mp.sin(slope), radius * (1 - mp.cos(slope)), radius)


def cycloid(diameter):
    a = mp.mpf(diameter) / 2 / mp.pi
    return lambda slope: (a * (2 * slope + mp.sin(2 * slope)), a * (1 - mp.cos(2 * slope)), 4 * a * mp.cos(slope))


KINDS = {
    "ball": ({"kind": "ball", "diameter": 10.0}, circle(5)),
    "part of a circle": ({"kind": "ball", "diameter": 10.0, "radius": 5.02}, circle(mp.mpf(5.02))),
    "clothoid": ({"kind": "clothoid", "diameter": 20.0}, clothoid(20)),
    "parabola": (
        {"kind": "parabola", "apex_radius": 8.0, "diameter": 240.0},
        lambda slope: (8 * mp.tan(slope), 4 * mp.tan(slope) ** 2, 8 / mp.cos(slope) ** 3),
    ),
    "ellipse": ({"kind": "ellipse", "radial": 6.0, "axial": 4.0}, ellipse(6, 4)),
    "cycloid": ({"kind": "cycloid", "diameter": 12.0}, cycloid(12)),
    "cubic": ({"kind": "power", "coefficient": 0.25, "exponent": 3.0, "diameter": 40.0}, power(0.25, 3)),
    "power 1.5": ({"kind": "power", "coefficient": 0.25, "exponent": 1.5, "diameter": 800.0}, power(0.25, 1.5)),
}


@pytest.mark.parametrize(("profile", "exact"), KINDS.values(), ids=KINDS)
def test_closed_forms_to_1e_12(profile, exact):
    tool = sc.Tool.from_dict({"profile": profile})
    slopes = np.array([s for s in SLOPES if s <= tool.max_slope])
    expected = np.array([[float(x) for x in exact(mp.mpf(s))] for s in slopes])
    found = np.stack([tool.radius_at(slopes), tool.height_at(slopes), tool.curvature_radius_at(slopes)], axis=1)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    # Z(d): where the wall is steep, a radius in float64 determines less of the height
    gentle = slopes < 1.3
    heights = tool.height_at_radius(expected[gentle, 0])
    np.testing.assert_allclose(heights, expected[gentle, 1], rtol=2e-12)


def test_clothoid_of_base_diameter_20_has_the_published_size():
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 20.0}})
    end = np.array([RIGHT])
    assert tool.height_at(end)[0] == pytest.approx(5.6195, abs=5e-5)
    assert tool.curvature_radius_at(end)[0] == pytest.approx(4.0815, abs=5e-5)
    scale = tool.curvature_radius_at(end)[0] * 12.8223
    assert scale == pytest.approx(52.333, abs=2e-3)
    by_scale = sc.Tool.from_dict({"profile": {"kind": "clothoid", "scale": 52.333, "end_slope_deg": 90.0}})
    assert by_scale.diameter == pytest.approx(20.0, abs=1e-4)


FORMULAS = {
    "explicit": {"z": "b - b*sqrt(1 - (r/a)^2)", "diameter": 12.0, "parameters": {"a": 6.0, "b": 4.0}},
    "parametric": {"r": "6*sin(t)", "z": "4*cos(t)", "t": [0.0, RIGHT]},
    "implicit": {"implicit": "(r/6)^2 + (z/4)^2 - 1", "start": [0.0, -4.0]},
}


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=FORMULAS)
def test_an_ellipse_by_formula_is_the_ellipse(formula):
    tool = sc.Tool.from_dict({"profile": {"kind": "formula", **formula}})
    kind = sc.Tool.from_dict({"profile": {"kind": "ellipse", "radial": 6.0, "axial": 4.0}})
    slopes = np.linspace(1e-4, RIGHT - 1e-6, 500)
    for ask in ("radius_at", "height_at", "curvature_radius_at"):
        np.testing.assert_allclose(
            getattr(tool, ask)(slopes), getattr(kind, ask)(slopes), rtol=1e-9, atol=1e-11, err_msg=ask
        )


def test_the_published_formula_is_moved_and_mirrored():
    tool = sc.Tool.from_dict({"profile": {"kind": "formula", "r": "sin(t)", "z": "2*cos(t)", "t": [0.0, RIGHT]}})
    notes = " ".join(tool.report()["notes"])
    assert "moved" in notes and "mirrored" in notes
    assert tool.diameter == pytest.approx(2.0, abs=1e-12)
    assert tool.height_at(np.array([RIGHT]))[0] == pytest.approx(2.0, abs=1e-12)


def test_a_sheet_is_a_ball_added_to_the_profile():
    """r + t sin, z + t (1 - cos): the tool's tip over a plane stands where both together touch it."""
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 20.0}})
    sheet = {"thickness": 1.5, "law": "constant", "model_face": "back"}
    for slope in (0.0, 0.3, 0.9, 1.4):
        normal = np.array([[np.sin(slope), 0.0, np.cos(slope)]])
        tip = sc.slope_matched_offset(tool, np.zeros((1, 3)), normal, sheet)[0]
        r, z = (float(x) for x in clothoid(20)(mp.mpf(slope))[:2]) if slope else (0.0, 0.0)
        expected = [r + 1.5 * np.sin(slope), 0.0, -z + 1.5 * np.cos(slope)]
        np.testing.assert_allclose(tip, expected, atol=1e-12)


REFUSED = {
    "hollow points": (
        {"kind": "points", "points": [[0, 0], [2, 0.4], [3, 1.2], [4, 1.4], [5, 4]], "fit_tolerance": 1e-6},
        "points[2]",
    ),
    "tip off the axis": ({"kind": "points", "points": [[0.5, 0], [2, 0.4], [3, 1.2]]}, "axis"),
    "concave formula": ({"kind": "formula", "z": "sqrt(r)", "diameter": 8.0}, "r = "),
    "not a number on the range": ({"kind": "formula", "z": "5 - sqrt(25 - r^2)", "diameter": 12.0}, "r = "),
    "past a right angle": ({"kind": "formula", "r": "sin(t)", "z": "1 - cos(t)", "t": [0.0, 2.0]}, "t = 1.57"),
    "unknown function": ({"kind": "formula", "z": "abs(r)", "diameter": 8.0}, "abs"),
    "corner wider than the tool": ({"kind": "bull-nose", "diameter": 8.0, "corner_radius": 5.0}, "corner_radius"),
    "ball wider than its cone": (
        {"kind": "tapered-ball", "tip_radius": 5.0, "half_angle_deg": 10.0, "diameter": 8.0},
        "tip_radius",
    ),
    "exponent 1": ({"kind": "power", "coefficient": 1.0, "exponent": 1.0, "diameter": 8.0}, "exponent"),
}


@pytest.mark.parametrize(("profile", "word"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_profile_is_refused_with_its_position(profile, word):
    with pytest.raises(sc.ToolError, match=re.escape(word)):
        sc.Tool.from_dict({"profile": profile})


def test_documents_survive_json_bit_by_bit():
    odd = 0.1 + 0.2
    document = {"profile": {"kind": "points", "points": [[0.0, 0.0], [odd, 1e-3 / 3], [2.0 / 3, 0.1]], "tip_flat": odd}}
    again = json.loads(json.dumps(sc.Tool.from_dict(document).to_dict()))
    assert again["profile"]["points"] == document["profile"]["points"]
    assert again["profile"]["tip_flat"] == odd
    assert sc.Tool.from_dict(again).to_dict() == again
