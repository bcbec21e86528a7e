"""Sheets: both laws, the model on each of its faces, over parts whose offset has a closed form, from both sides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
import pytest

import styluscam as sc
from meridian import Floats, Profile
from styluscam.offset.positions import sheet_raise

THICKNESS = 1.2
SHEETS = tuple(product(("constant", "sine"), (("tool", 0.0), ("mid", 0.5), ("back", 1.0))))
PROFILES = ({"kind": "ball", "diameter": 6.0}, {"kind": "clothoid", "diameter": 10.0})
RADIUS = 60.0
"""Of generating arcs, mm: more than any radius of tool and sheet at the slopes asked."""


@dataclass(frozen=True)
class Shape:
    """A wall around a core square (a point for 0) by its slope: distance from the core, height; where its normal leans.

    `leans` is +1 outwards (a bump), -1 inwards (a pit). `bends` is the side on which side of the surface chords lie: -1 inside
    the material, +1 outside, 0 both.
    """

    point: Callable[[Floats], tuple[Floats, Floats]]
    leans: float
    bends: int
    core: float = 0.0
    slopes_deg: tuple[float, float] = (10.0, 65.0)


def cone(slope_deg: float) -> Callable[[Floats], tuple[Floats, Floats]]:
    """One slope only: what is asked for as a slope runs along the wall instead."""
    return lambda phi: (12.0 + 25.0 * phi, 25.0 * phi * np.tan(np.radians(slope_deg)))


def arc(phi: Floats) -> tuple[Floats, Floats]:
    return RADIUS * np.sin(phi), RADIUS * (1 - np.cos(phi))


def ellipse(phi: Floats) -> tuple[Floats, Floats]:
    a, b, t = 50.0, 40.0, np.tan(phi)
    root = np.sqrt(b * b + a * a * t * t)
    return a * a * t / root, b - b * b / root


def parabola(phi: Floats) -> tuple[Floats, Floats]:
    return 30.0 * np.tan(phi), 15.0 * np.tan(phi) ** 2


def raised(curve: Callable[[Floats], tuple[Floats, Floats]], start: float, rise: float) -> object:
    """The generatrix from `start` outwards, climbing (a pit's) or falling (a bump's)."""
    return lambda phi: (start + curve(phi)[0], rise * curve(phi)[1])


def turned(curve: Callable[[Floats], tuple[Floats, Floats]], rise: float) -> object:
    """The generatrix seen from its other end: it is steepest at the inside."""
    return lambda phi: (90.0 - curve(phi)[0], rise * curve(phi)[1])


SHAPES = {
    **{f"cone-{a}-pit": Shape(raised(cone(a), 0.0, 1.0), -1, +1) for a in (45, 67)},  # type: ignore[arg-type]
    **{f"cone-{a}-bump": Shape(raised(cone(a), 0.0, -1.0), +1, -1) for a in (45, 67)},  # type: ignore[arg-type]
    "bowl": Shape(arc, -1, +1),
    "cap": Shape(raised(arc, 0.0, -1.0), +1, -1),  # type: ignore[arg-type]
    **{
        f"{curve.__name__}-{side}": Shape(point, leans, bends)  # type: ignore[arg-type]
        for curve in (arc, ellipse, parabola)
        for side, point, leans, bends in (
            ("frustum-hollow-pit", raised(curve, 15.0, 1.0), -1, +1),
            ("frustum-hollow-bump", turned(curve, 1.0), +1, 0),
            ("frustum-round-pit", turned(curve, -1.0), -1, 0),
            ("frustum-round-bump", raised(curve, 15.0, -1.0), +1, -1),
        )
    },
    "pyramid-pit": Shape(raised(cone(45), 0.0, 1.0), -1, +1, core=9.0),  # type: ignore[arg-type]
    "pyramid-bump": Shape(raised(cone(45), 0.0, -1.0), +1, -1, core=9.0),  # type: ignore[arg-type]
}

FINE = 0.0012
"""How far the parts' triangles leave the surfaces at most, mm."""


def slope_of(name: str, phi: Floats) -> Floats:
    """The wall's slope: a cone has one."""
    fixed = {"cone-45": 45.0, "cone-67": 67.0, "pyramid": 45.0}
    found = [a for start, a in fixed.items() if name.startswith(start)]
    return np.full_like(phi, np.radians(found[0])) if found else phi


def around(shape: Shape, phi: Floats, turn: Floats) -> tuple[Floats, Floats]:
    """Points (N, 3), and the horizontal directions (N, 2) in which the distance from the core grows."""
    distance, height = shape.point(phi)
    away = np.column_stack([np.cos(turn), np.sin(turn)])
    corner = shape.core * np.where(np.abs(away) < 1e-12, 0.0, np.sign(away))
    return np.column_stack([corner + distance[:, None] * away, height]), away


@lru_cache(maxsize=4)
def part_of(name: str) -> sc.Part:
    shape = SHAPES[name]
    phi = np.radians(np.linspace(*shape.slopes_deg, 150))
    quarter = np.linspace(1e-9, 0.5 * np.pi - 1e-9, 181)
    turn = np.concatenate([quarter + 0.5 * np.pi * k for k in range(4)])
    points, _ = around(shape, np.tile(phi, len(turn)), np.repeat(turn, len(phi)))
    i = np.arange(len(turn) * len(phi)).reshape(len(turn), len(phi))
    j = np.roll(i, -1, axis=0)
    a, b, c, d = i[:, :-1].ravel(), i[:, 1:].ravel(), j[:, :-1].ravel(), j[:, 1:].ravel()
    triangles = np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])
    corners = points[triangles]
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0
    triangles[~up] = triangles[~up][:, ::-1]
    return sc.Part.from_mesh(points, triangles)


def samples(name: str) -> tuple[Floats, Floats, Floats]:
    """Points, normals and slopes away from the wall's ends; for a pyramid on its sides too."""
    shape, rng = SHAPES[name], np.random.default_rng(5)
    low, high = shape.slopes_deg
    phi = np.radians(rng.uniform(low + 0.35 * (high - low), high - 0.2 * (high - low), 200))
    turn = rng.uniform(0.01, 0.49 * np.pi, 200) + 0.5 * np.pi * rng.integers(0, 4, 200)
    points, away = around(shape, phi, turn)
    if shape.core:
        straight, away[:100] = np.arange(100) % 2, 0.0
        away[np.arange(100), straight] = 1.0
        points[:100, :2] = (shape.core + shape.point(phi[:100])[0])[:, None] * away[:100]
        points[np.arange(100), 1 - straight] = rng.uniform(-0.9, 0.9, 100) * shape.core
    slope = slope_of(name, phi)
    normals = np.column_stack([shape.leans * np.sin(slope)[:, None] * away, np.cos(slope)])
    return points, normals, slope


def closed_form(name: str, profile: dict[str, object], law: str, share: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Tips (N, 3) with the points, normals and slopes that they belong to."""
    points, normals, slope = samples(name)
    r, height = Profile.of(profile).at(np.sqrt(slope * 2 / np.pi))
    along = share * THICKNESS * (normals if law == "constant" else np.array([0.0, 0.0, 1.0]))
    across = normals[:, :2] / np.sin(slope)[:, None]
    tips = points + along + np.column_stack([r[:, None] * across, -height])
    return tips, points, normals, slope


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: p["kind"])
def test_offset_and_envelope_are_the_closed_form(name: str, profile: dict[str, object]) -> None:
    tool = sc.Tool.from_dict({"profile": profile})
    for law, (face, share) in SHEETS:
        sheet = {"thickness": THICKNESS, "law": law, "model_face": face}
        tips, points, normals, slope = closed_form(name, profile, law, share)
        assert np.abs(sc.slope_matched_offset(tool, points, normals, sheet) - tips).max() < 1e-9, (law, face)
        over = (sc.drop_cutter(part_of(name), tool, tips[:, :2], sheet) - tips[:, 2]) * np.cos(slope)
        # chords inside the material let the tool sink, those outside it hold it up
        assert over.min() > (-FINE if SHAPES[name].bends <= 0 else -1e-9), (law, face, over.min())
        assert over.max() < (FINE if SHAPES[name].bends >= 0 else 1e-9), (law, face, over.max())


@pytest.mark.parametrize("face, share", (("tool", 0.0), ("mid", 0.5), ("back", 1.0)))
def test_a_sheet_of_constant_thickness_and_the_tool_act_as_one_tool(
    face: str, share: float, small_part: tuple[Floats, np.ndarray]
) -> None:
    part = sc.Part.from_mesh(*small_part)
    xy = np.random.default_rng(6).uniform((0.0, 0.0), (24.0, 12.0), (4000, 2))
    sheet = {"thickness": THICKNESS, "law": "constant", "model_face": face}
    added = share * THICKNESS
    for tip_flat in (0.0, 0.7):
        profile = {"kind": "ball", "diameter": 2.0 + 2 * tip_flat, "tip_flat": tip_flat}
        grown = {"kind": "ball", "diameter": profile["diameter"] + 2 * added, "tip_flat": tip_flat}
        under = sc.drop_cutter(part, sc.Tool.from_dict({"profile": profile}), xy, sheet)
        bare = sc.drop_cutter(part, sc.Tool.from_dict({"profile": grown}), xy)
        assert np.abs(under - (bare + added)).max() < 1e-12


@pytest.mark.parametrize("face, share", (("tool", 0.0), ("mid", 0.5), ("back", 1.0)))
@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: p["kind"])
def test_the_sine_law_is_a_vertical_shift(
    face: str, share: float, profile: dict[str, object], small_part: tuple[Floats, np.ndarray]
) -> None:
    part, tool = sc.Part.from_mesh(*small_part), sc.Tool.from_dict({"profile": profile})
    xy = np.random.default_rng(7).uniform((-2.0, -2.0), (26.0, 14.0), (4000, 2))
    sheet = {"thickness": THICKNESS, "law": "sine", "model_face": face}
    shift = sc.drop_cutter(part, tool, xy, sheet) - sc.drop_cutter(part, tool, xy)
    assert np.abs(shift - share * THICKNESS).max() < 1e-12


@pytest.mark.parametrize(("law", "face"), SHEETS)
def test_the_raise_is_what_the_tip_stands_over_a_flat_face(law: str, face: tuple[str, float]) -> None:
    sheet = {"thickness": THICKNESS, "law": law, "model_face": face[0]}
    tip = sc.slope_matched_offset(sc.Tool.from_dict({"profile": PROFILES[0]}), [[0, 0, 0]], [[0, 0, 1]], sheet)
    assert sheet_raise(sheet) == tip[0][2] == face[1] * THICKNESS


def test_a_sheet_without_a_thickness_has_no_raise() -> None:
    with pytest.raises(sc.GeometryError, match="thickness is missing"):
        sheet_raise({"model_face": "back"})
