"""Tools asked by slope: Fresnel integrals summed in 50 digits, the ball's closed form, and the published check numbers."""

from __future__ import annotations

import json
import math
from decimal import Decimal, localcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
SLOPES_DEG = (1e-9, 1e-4, 0.01, 0.5, 1.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 67.0, 75.0, 85.0, 89.0, 89.999, 90.0)


def clothoid_integrals(phi: Decimal) -> tuple[Decimal, Decimal]:
    """Integrals of cos and sin of l^2/2 from 0 to sqrt(2 phi): r and z of the clothoid with A = 1."""
    length = (2 * phi).sqrt()
    cosine, sine, term = Decimal(0), Decimal(0), Decimal(1)
    for n in range(40):
        share = term / (2 * n + 1) * (-1) ** (n // 2)
        if n % 2 == 0:
            cosine += share
        else:
            sine += share
        term *= phi / (n + 1)
    return length * cosine, length * sine


def relative(found: np.ndarray, exact: list[float]) -> float:
    return float(np.max(np.abs(found - np.array(exact)) / np.abs(np.array(exact))))


@pytest.mark.parametrize("diameter", (10.0, 20.0))
def test_clothoid_is_fresnel_s_to_1e_12(diameter: float) -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": diameter}})
    slopes = np.radians(SLOPES_DEG)
    with localcontext() as context:
        context.prec = 50
        scale = Decimal(diameter) / 2 / clothoid_integrals(PI / 2)[0]
        # the engine gets the doubles: their exact values are what the integrals are asked for
        points = [clothoid_integrals(min(Decimal(float(phi)), PI / 2)) for phi in slopes]
        radii = [float(scale * r) for r, _ in points]
        heights = [float(scale * z) for _, z in points]
        curvatures = [float(scale / (2 * Decimal(float(phi))).sqrt()) for phi in slopes]
    assert relative(tool.radius_at(slopes), radii) < 1e-12
    assert relative(tool.height_at(slopes), heights) < 1e-12
    assert relative(tool.curvature_radius_at(slopes), curvatures) < 1e-12
    # the reverse, where a radius still determines the slope
    lower = slopes < np.radians(80.0)
    assert relative(tool.height_at_radius(np.array(radii)[lower]), np.array(heights)[lower].tolist()) < 1e-12


def test_the_published_numbers_of_the_clothoid_d20() -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 20.0}})
    quarter = np.array([np.pi / 2])
    arc = 10.0 / 0.7798934
    assert arc == pytest.approx(12.8223, abs=5e-5)
    assert arc**2 / np.pi == pytest.approx(52.334, abs=1e-3)
    assert tool.radius_at(quarter)[0] == pytest.approx(10.0, rel=1e-14)
    assert tool.height_at(quarter)[0] == pytest.approx(5.6195, abs=5e-5)
    assert tool.height_at(quarter)[0] == pytest.approx(0.4382591 * arc, rel=2e-7)
    assert tool.curvature_radius_at(quarter)[0] == pytest.approx(4.0815, abs=5e-5)
    by_scale = sc.Tool.from_dict({"profile": {"kind": "clothoid", "scale": arc**2 / np.pi, "end_slope_deg": 90.0}})
    assert by_scale.diameter == pytest.approx(20.0, rel=1e-7)


def test_ball_is_a_circle_to_1e_12() -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 6.0}})
    slopes = np.radians(SLOPES_DEG)
    assert relative(tool.radius_at(slopes), [3.0 * math.sin(s) for s in slopes]) < 1e-12
    assert relative(tool.height_at(slopes), [6.0 * math.sin(s / 2) ** 2 for s in slopes]) < 1e-12
    assert (tool.curvature_radius_at(slopes) == 3.0).all()
    radii = np.linspace(0.0, 3.0, 50)[1:]
    exact = [r * r / (3.0 + math.sqrt(9.0 - r * r)) for r in radii]
    assert relative(tool.height_at_radius(radii), exact) < 1e-12


@pytest.mark.parametrize("kind", ("ball", "clothoid"))
def test_profiles_are_convex_and_begin_at_the_tip(kind: str) -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": kind, "diameter": 8.0}})
    slopes = np.linspace(0.0, tool.max_slope, 2001)
    r, z = tool.radius_at(slopes), tool.height_at(slopes)
    assert r[0] == z[0] == 0.0
    assert (np.diff(r) >= 0.0).all()
    assert (np.diff(z) >= 0.0).all()
    # chords lie between the tangents at their ends
    chords = np.arctan2(np.diff(z), np.diff(r))
    assert (chords > slopes[:-1] - 1e-9).all()
    assert (chords < slopes[1:] + 1e-9).all()
    assert tool.height_at_radius([-0.0, 4.0 + 1e-9, 1e9]).tolist() == [0.0, math.inf, math.inf]


def test_arrays_keep_their_shape() -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 8.0}})
    assert tool.radius_at(np.zeros((2, 3, 4))).shape == (2, 3, 4)
    assert tool.height_at(0.25).shape == ()
    assert tool.radius_at(np.radians(np.arange(90))[::7]).shape == (13,)


def test_a_tip_flat_moves_the_curve_outwards() -> None:
    bare = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 8.0}})
    flat = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0, "tip_flat": 1.0}})
    slopes = np.radians(SLOPES_DEG)
    assert np.allclose(flat.radius_at(slopes), 1.0 + bare.radius_at(slopes), rtol=0, atol=1e-14)
    assert np.array_equal(flat.height_at(slopes), bare.height_at(slopes))
    inner, outer = flat.radius_range_at(np.array([0.0, 0.5]))
    assert inner[0] == 0.0
    assert outer[0] == 1.0
    assert inner[1] == outer[1]


def test_a_tool_s_document_builds_it_again(tmp_path: Path) -> None:
    document = {"profile": {"kind": "clothoid", "diameter": 12.0}, "shank_diameter": 12.0, "length": 60.0}
    tool = sc.Tool.from_dict(document)
    path = tmp_path / "tool.json"
    path.write_text(json.dumps(tool.to_dict()))
    assert sc.Tool.read(path).to_dict() == tool.to_dict()
    assert sc.Tool.read(path).description == "clothoid D12"


@pytest.mark.parametrize(
    "profile",
    (
        {"kind": "ball"},
        {"kind": "ball", "diameter": 0.0},
        {"kind": "ball", "diameter": -1.0},
        {"kind": "ball", "diameter": 1e9},
        {"kind": "clothoid", "diameter": 10.0, "scale": 3.0},
        {"kind": "clothoid", "diameter": 10.0, "tip_flat": -1.0},
        {"kind": "clothoid", "diameter": 10.0, "tip_flat": 6.0},
        {"kind": "pyramid", "diameter": 10.0},
    ),
    ids=json.dumps,
)
def test_tools_that_cannot_be_are_refused(profile: dict[str, object]) -> None:
    with pytest.raises(sc.ToolError) as caught:
        sc.Tool.from_dict({"profile": profile})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("document", "where", "words"),
    [
        ({"profile": {"kind": "ball", "diameter": "10"}}, "profile.diameter", "a number is expected"),
        ({"profile": {"kind": "ball", "diameter": None}}, "profile.diameter", "a number is expected"),
        ({"profile": {"kind": "points", "points": [[0, 0], [1]]}}, "profile.points", "length"),
        ({"profile": {"kind": "formula", "r": "t", "z": "t", "t": ["a", 1]}}, "profile.t", "a number is expected"),
        ({"profile": {"kind": "cone", "diameter": 3.0}}, "profile.half_angle_deg", "half_angle_deg is missing"),
        ({"profile": {"kind": "ball", "diameter": 3.0}, "holder": "x"}, "holder", "a table is expected"),
        ({"profile": {"kind": "ball", "diameter": 3.0}, "base": {"kind": "chamfered"}}, "base.kind", "chamfered"),
    ],
)
def test_a_key_of_the_wrong_type_is_named(document: dict[str, Any], where: str, words: str) -> None:
    with pytest.raises(sc.ToolError) as caught:
        sc.Tool.from_dict(document)
    assert caught.value.where == where
    assert words in str(caught.value)
    assert "column" not in str(caught.value)
