"""Stock that operations leave whose tool follows the surface: exact positions on spheres, and what the verifier finds."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import block, kinds, text_of

import styluscam as sc

RADIUS, BALL, TOLERANCE = 15.0, 3.0, 0.02
"""Radii of the part and of the tool, mm."""
ACROSS, UNDER = 0.3, 0.2
LEFT = {"radial_stock_to_leave": ACROSS, "axial_stock_to_leave": UNDER}
KINDS: dict[str, dict[str, Any]] = {
    "z-level": {"step": {"height": 1.0}},
    "zig-zag": {"stepover": 1.0},
    "spiral": {"step": {"height": 1.0}},
    "constant-scallop": {"scallop": 0.05},
}


def cap(is_dish: bool, around: int = 90, rings: int = 30) -> sc.Part:
    """A dish or a dome, part of a sphere up to 60 degrees, its lowest or highest point in the origin."""
    slopes, turns = np.radians(np.linspace(0.0, 60.0, rings + 1)[1:]), 2.0 * np.pi * np.arange(around) / around
    radii, heights = RADIUS * np.sin(slopes), RADIUS * (1.0 - np.cos(slopes)) * (1.0 if is_dish else -1.0)
    points = [[r * np.cos(turn), r * np.sin(turn), z] for r, z in zip(radii, heights, strict=True) for turn in turns]
    triangles = [[0, 1 + k, 1 + (k + 1) % around] for k in range(around)]
    for first in range(1, 1 + (rings - 1) * around, around):
        for k in range(around):
            a, b = first + k, first + (k + 1) % around
            triangles += [[a, a + around, b + around], [a, b + around, b]]
    return sc.Part.from_mesh(np.array([[0.0, 0.0, 0.0], *points]), np.array(triangles))


def job(kind: str, is_dish: bool = True, **keys: Any) -> sc.Job:
    operation = {"kind": kind, "tool": "mill", "tolerance": TOLERANCE, "spindle": {"mode": "fixed", "rpm": 8000.0}}
    document = {
        "schema": 1,
        "part": {"file": "cap.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"mill": {"profile": {"kind": "ball", "diameter": 2.0 * BALL}}},
        "operations": [operation | KINDS[kind] | keys],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=cap(is_dish))


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    """Texts for the dish that leave stock, by kind."""
    return {kind: text_of(job(kind, **LEFT)) for kind in KINDS}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("is_dish", [True, False])
def test_passes_lie_as_far_from_a_sphere_as_is_asked(kind: str, is_dish: bool) -> None:
    asked = job(kind, is_dish, **LEFT)
    program = sc.plan(asked).programs["main"]
    cut = program.moves[(program.moves["kind"] != 0) & (program.moves["end"][:, 2] < 9.0)]
    x, y, z = cut["end"].T
    # the sphere's middle from the ball's, that one shifted by the disc to the wall and let down
    away = np.hypot(x, y) + (ACROSS if is_dish else -ACROSS)
    up = z + BALL - UNDER - (RADIUS if is_dish else -RADIUS)
    apart = np.hypot(away, up) - (RADIUS - BALL if is_dish else RADIUS + BALL)
    # on level faces and at the sphere's rim other points of the disc, or of the tool, touch
    slope = np.degrees(np.arctan2(away, np.abs(up)))
    inner = (slope > 5.0) & (slope < 55.0)
    assert inner.sum() > 100
    chord = RADIUS * (1.0 - np.cos(np.pi / 90.0))
    off = -apart[inner] if is_dish else apart[inner]
    assert off.min() > -chord - 0.002 and off.max() < TOLERANCE + chord


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_asked_is_sound(texts: dict[str, str], kind: str) -> None:
    assert kinds(job(kind, **LEFT), texts[kind].splitlines()) == set()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("left", "found"),
    [
        ({"radial_stock_to_leave": 0.35, "axial_stock_to_leave": UNDER}, "stock-to-leave"),
        ({"radial_stock_to_leave": ACROSS, "axial_stock_to_leave": 0.23}, "stock-to-leave"),
        ({"radial_stock_to_leave": 0.2, "axial_stock_to_leave": UNDER}, "excess"),
        ({"radial_stock_to_leave": ACROSS, "axial_stock_to_leave": 0.15}, "excess"),
        ({}, "excess"),
    ],
)
def test_too_much_or_too_little_is_found(texts: dict[str, str], kind: str, left: dict[str, float], found: str) -> None:
    assert found in kinds(job(kind, **left), texts[kind].splitlines())


def test_stock_to_leave_is_no_gouge_and_a_gouge_is_one() -> None:
    bare = text_of(job("zig-zag"))
    found = kinds(job("zig-zag", **LEFT), bare.splitlines())
    assert "stock-to-leave" in found and "gouge" not in found
    # the tool's length is off by half a millimetre: it cuts the part as well
    lines = bare.splitlines()
    low = [re.sub(r"Z(-?[\d.]+)", lambda word: f"Z{float(word.group(1)) - 0.5:.3f}", line) for line in lines]
    assert {"stock-to-leave", "gouge"} <= kinds(job("zig-zag", **LEFT), low)


def test_sheets_have_none() -> None:
    document = job("zig-zag", **LEFT).to_dict()
    sheet = document | {"process": {"kind": "spif"}, "setup": {"sheet": {"thickness": 1.0}}}
    sheet["part"] = document["part"] | {"model_face": "tool"}
    with pytest.raises(sc.JobError) as refused:
        sc.Job.from_dict(sheet, part=block())
    assert refused.value.where == "operations[0].radial_stock_to_leave"
