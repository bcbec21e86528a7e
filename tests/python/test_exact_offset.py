"""Slope-matched offset and drop-cutter against the fixtures' exact answers and against closed forms."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest

import styluscam as sc
from meridian import Meridian, Profile, fresnel
from styluscam.offset.positions import REGULAR, RIM, UNDERCUT

PARTS = ("cone_cup", "cap_r60", "vwaf", "pyramid")
PROFILES = ({"kind": "ball", "diameter": 6.0}, {"kind": "clothoid", "diameter": 10.0})

SHALLOW = {"kind": "clothoid", "scale": 30.0, "end_slope_deg": 60.0}


def tool_of(profile: dict[str, object]) -> sc.Tool:
    return sc.Tool.from_dict({"profile": profile})


@pytest.mark.parametrize("part", PARTS)
def test_the_oracle_of_envelopes_agrees_with_the_fixtures(part: str, meridian_of: Callable[[str], Meridian]) -> None:
    meridian = meridian_of(part)
    for entry in meridian.document["envelope"]:
        xy = np.array([s["xy"] for s in entry["samples"]])
        exact = meridian.envelope(xy, entry["tool"], entry["sheet"])
        assert np.abs(exact.height - [s["z"] for s in entry["samples"]]).max() < 1e-12
        assert np.abs(exact.clearance(exact.height)).max() == 0.0


@pytest.mark.parametrize("part", PARTS)
def test_slope_matched_offset_is_the_closed_form(part: str, meridian_of: Callable[[str], Meridian]) -> None:
    answers = meridian_of(part).document
    points = np.array([s["point"] for s in answers["slope_matched"]])
    normals = np.array([s["normal"] for s in answers["slope_matched"]])
    for tool, sheet in product(answers["tools"], answers["sheets"]):
        found = sc.slope_matched_offset(tool_of(answers["tools"][tool]), points, normals, answers["sheets"][sheet])
        exact = np.array([s["cl"][tool][sheet] for s in answers["slope_matched"]])
        assert np.abs(found - exact).max() < 1e-9, (tool, sheet)
        assert (found.flags == REGULAR).all()


def test_the_sheet_s_side_decides_how_much_of_it_lies_between() -> None:
    tool, normal = tool_of(PROFILES[0]), np.array([[0.6, 0.0, 0.8]])
    for face, share in (("tool", 0.0), ("mid", 0.5), ("back", 1.0)):
        sheet = {"thickness": 2.0, "law": "constant", "model_face": face}
        bare = sc.slope_matched_offset(tool, np.zeros((1, 3)), normal)
        found = sc.slope_matched_offset(tool, np.zeros((1, 3)), normal, sheet)
        assert np.allclose(found - bare, 2.0 * share * normal, atol=1e-14)


def test_flags_say_rim_and_undercut() -> None:
    tool = tool_of(SHALLOW)
    slopes = np.radians([0.0, 59.9, 60.1, 90.0, 90.1, 135.0])
    normals = np.column_stack([np.sin(slopes), np.zeros_like(slopes), np.cos(slopes)])
    found = sc.slope_matched_offset(tool, np.zeros((6, 3)), normals)
    assert found.flags.tolist() == [REGULAR, REGULAR, RIM, RIM, UNDERCUT, UNDERCUT]
    # steeper than the profile: the rim touches
    r, height = rim_of_shallow()
    assert np.allclose(found[2:4], [r, 0.0, -height], atol=1e-12)


def test_a_wall_steeper_than_the_profile_is_met_by_the_rim() -> None:
    slope = np.radians(75.0)
    corners = np.array([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 60.0, 0.0]])
    corners[:, 2] = -np.tan(slope) * corners[:, 0]
    xy = np.random.default_rng(4).uniform(-5.0, 5.0, (50, 2))
    r, height = rim_of_shallow()
    found = sc.drop_cutter(sc.Part.from_mesh(corners, [[0, 1, 2]]), tool_of(SHALLOW), xy)
    assert np.abs(found - (-np.tan(slope) * (xy[:, 0] - r) - height)).max() < 1e-9


def rim_of_shallow() -> tuple[float, float]:
    u = np.sqrt(2 * 60.0 / 180.0)
    return tuple(np.sqrt(np.pi * 30.0) * float(f) for f in fresnel(np.array(u)))  # type: ignore[return-value]


def test_over_a_floor_the_axis_stands_over_the_point() -> None:
    for profile in PROFILES:
        flat = tool_of({**profile, "tip_flat": 1.0})
        found = sc.slope_matched_offset(flat, np.array([[1.0, 2.0, 3.0]]), np.array([[0.0, 0.0, 1.0]]))
        assert found.tolist() == [[1.0, 2.0, 3.0]]


@pytest.mark.parametrize("part", PARTS)
def test_drop_cutter_lies_0_to_3_um_over_the_exact_envelope(
    part: str, part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]
) -> None:
    meridian = meridian_of(part)
    for entry in meridian.document["envelope"]:
        xy = np.array([s["xy"] for s in entry["samples"]])
        exact = meridian.envelope(xy, entry["tool"], entry["sheet"])
        tool, sheet = tool_of(meridian.document["tools"][entry["tool"]]), meridian.document["sheets"][entry["sheet"]]
        along_normal = (sc.drop_cutter(part_of(part), tool, xy, sheet) - exact.height) * exact.cosine
        assert along_normal.min() > -1e-9, entry["tool"]
        assert along_normal.max() < 0.003, entry["tool"]


@pytest.mark.parametrize("part", ("cone_cup", "pyramid"))
def test_drop_cutter_between_the_samples(
    part: str, part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]
) -> None:
    xy = np.random.default_rng(1).uniform(-43.0, 43.0, (4000, 2))
    meridian = meridian_of(part)
    for tool, sheet in (("ball-6", "none"), ("clothoid-10", "constant"), ("clothoid-10", "sine")):
        found = sc.drop_cutter(
            part_of(part), tool_of(meridian.document["tools"][tool]), xy, meridian.document["sheets"][sheet]
        )
        clearance = meridian.envelope(xy, tool, sheet).clearance(found)
        assert clearance.min() > -1e-9
        assert clearance.max() < 0.003


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: p["kind"])
@pytest.mark.parametrize("thickness", (0.0, 1.5))
@pytest.mark.parametrize("slope_deg", (0.0, 1.0, 30.0, 75.0))
def test_one_triangle_is_a_plane(profile: dict[str, object], thickness: float, slope_deg: float) -> None:
    slope = np.radians(slope_deg)
    corners = np.array([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 60.0, 0.0]])
    corners[:, 2] = -np.tan(slope) * corners[:, 0]  # the normal leans towards +X
    part = sc.Part.from_mesh(corners, [[0, 1, 2]])
    xy = np.random.default_rng(2).uniform(-5.0, 5.0, (50, 2))
    sheet = {"thickness": thickness, "law": "constant", "model_face": "back"} if thickness else None
    found = sc.drop_cutter(part, tool_of(profile), xy, sheet)
    r, height = Profile.of(profile).at(np.sqrt(np.array(slope) * 2 / np.pi))
    # the tip's distance over the plane: the contact lies r towards -X and `height` up; the sheet lies on the normal
    exact = -np.tan(slope) * (xy[:, 0] - r) - height + thickness / np.cos(slope)
    assert np.abs(found - exact).max() < 1e-9


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: p["kind"])
@pytest.mark.parametrize("rise", (0.0, 0.5, -2.0))
def test_a_ridge_touches_along_its_edge(profile: dict[str, object], rise: float) -> None:
    # two walls of 85 deg across a ridge along X that climbs by `rise`: the contact never lies on a facet near it
    drop = np.tan(np.radians(89.5)) * 3.0
    ends = np.array([[-30.0, 0.0, -30.0 * rise], [30.0, 0.0, 30.0 * rise]])
    left, right = ends + np.array([0.0, 3.0, -drop]), ends + np.array([0.0, -3.0, -drop])
    part = sc.Part.from_mesh(np.concatenate([ends, left, right]), [[0, 1, 3], [0, 3, 2], [1, 0, 4], [1, 4, 5]])
    rng = np.random.default_rng(3)
    shape = Profile.of(profile)
    reach = float(profile["diameter"]) / 2  # type: ignore[arg-type]
    q = rng.uniform(-0.9, 0.9, 40) * reach * np.cos(np.arctan(abs(rise)))
    x = rng.uniform(-10.0, 10.0, 40)
    found = sc.drop_cutter(part, tool_of(profile), np.column_stack([x, q]))
    exact = [
        rise * x0 + highest(lambda s, q0=q0: rise * s - shape.height_at_radius(np.hypot(q0, s))[0], reach)
        for x0, q0 in zip(x, q, strict=True)
    ]
    assert np.abs(found - exact).max() < 1e-9


def highest(f: Callable[[np.ndarray], np.ndarray], reach: float) -> float:
    """The largest value of a concave function over [-reach, reach]: a grid that closes in."""
    low, high = -reach, reach
    for _ in range(14):
        grid = np.linspace(low, high, 401)
        values = f(grid)
        at = int(np.argmax(values))
        low, high = grid[max(at - 2, 0)], grid[min(at + 2, 400)]
    return float(values.max())


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: p["kind"])
def test_a_needle_touches_at_its_point(profile: dict[str, object]) -> None:
    corners = np.array([[0.0, 0.0, 7.0], [0.01, 0.0, -900.0], [-0.01, 0.01, -900.0], [-0.01, -0.01, -900.0]])
    part = sc.Part.from_mesh(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    reach = float(profile["diameter"]) / 2  # type: ignore[arg-type]
    distance = np.linspace(0.0, 0.98 * reach, 60)
    angle = np.linspace(0.0, 20.0, 60)
    found = sc.drop_cutter(
        part, tool_of(profile), np.column_stack([distance * np.cos(angle), distance * np.sin(angle)])
    )
    exact = 7.0 - Profile.of(profile).height_at_radius(distance)[0]
    assert np.abs(found - exact).max() < 1e-9


def test_where_nothing_is_met_there_is_the_floor_or_nan() -> None:
    part = sc.Part.from_mesh([[0, 0, 0], [10, 0, 0], [0, 10, 0]], [[0, 1, 2]])
    tool = tool_of(PROFILES[0])
    xy = np.array([[2.0, 2.0], [-2.99, 2.0], [-3.01, 2.0], [500.0, 0.0]])
    bare = sc.drop_cutter(part, tool, xy)
    assert bare[0] == 0.0
    assert bare[1] == pytest.approx(-(3.0 - np.sqrt(9.0 - 2.99**2)), abs=1e-9)
    assert np.isnan(bare[2:]).all()
    assert sc.drop_cutter(part, tool, xy, floor=-1.0).tolist() == [0.0, -1.0, -1.0, -1.0]
    assert sc.drop_cutter(part, tool, xy, floor=-9.0).tolist() == [*bare[:2].tolist(), -9.0, -9.0]


def test_positions_and_normals_that_do_not_fit_are_refused() -> None:
    part = sc.Part.from_mesh([[0, 0, 0], [10, 0, 0], [0, 10, 0]], [[0, 1, 2]])
    tool = tool_of(PROFILES[0])
    for xy in ([[np.nan, 0.0]], [[np.inf, 0.0]], [[1.0, 2.0, 3.0]]):
        with pytest.raises(sc.GeometryError):
            sc.drop_cutter(part, tool, np.array(xy))
    with pytest.raises(sc.GeometryError):
        sc.slope_matched_offset(tool, np.zeros((2, 3)), np.ones((3, 3)))
