"""The corpus's own gouge check against brute force, and against programs that are wrong on purpose."""

from __future__ import annotations

import numpy as np
import pytest
from gouge import NEAR, Scene, checked

from brute_force import Solid
from convex_tool import Tool

PROFILES = {
    "ball": {"kind": "ball", "diameter": 6.0},
    "clothoid": {"kind": "clothoid", "diameter": 6.0},
    "flat": {"kind": "flat", "diameter": 6.0},
    "bull-nose": {"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.2},
}
TRIANGLES = np.array(
    [
        [(-20, -20, 0), (20, -20, 0), (20, 20, 0)],
        [(-20, -20, 0), (20, 20, 0), (-20, 20, 0)],
        [(5, -20, 0), (5, 20, 0), (5, 20, 8)],
        [(5, -20, 0), (5, 20, 8), (5, -20, 8)],
        [(-9, -3, 0.5), (-7, 2, 3), (-6, -4, 1)],
    ],
    dtype=float,
)
PROGRAM = "G21 G90 G17 G54\nT1 M6\nG43 H1\nG0 Z20\nG0 X-15 Y0\nG1 Z{z} F500\nG1 X{x}\nG0 Z20\nM2\n"


def job(profile):
    return {"part": {}, "setup": {}, "tools": {"cutter": {"number": 1, "profile": profile}}}


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_the_distance_is_brute_forces(profile):
    rng = np.random.default_rng(5)
    tips = rng.uniform((-18, -18, -1), (12, 18, 4), (150, 3))
    tool = Tool.of(profile)
    expected = Solid(TRIANGLES).clearances(tool, tips)
    here = Scene(tool, TRIANGLES)
    found = np.array([here.distances(tip[None], 0.001)[0] for tip in tips])
    entered = expected < -0.002
    assert entered.sum() > 30
    # at a rim the depth has no one value; that something is entered has
    assert np.all(found[entered] < -0.001)
    assert np.all(found[expected > 0.001] > -0.001)
    near = (expected > -0.5) & (expected < NEAR) & (expected > -0.001)
    assert np.abs(found[near] - expected[near]).max(initial=0.0) < 0.01


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_a_path_on_a_face_is_none_and_one_below_it_is(profile):
    flat = TRIANGLES[:2]
    assert checked(PROGRAM.format(z=0.0, x=15), job(profile), flat, 0.002, "linuxcnc", 1).deepest == 0.0
    found = checked(PROGRAM.format(z=-0.01, x=15), job(profile), flat, 0.002, "linuxcnc", 1)
    assert found.deepest == pytest.approx(0.01, abs=1e-4)
    assert found.touching > 0.5


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
def test_a_wall_is_met_from_the_side(profile):
    walls = TRIANGLES[:4]
    program = PROGRAM.format(z=0.0, x=2)
    assert checked(program, job(profile), walls, 0.002, "linuxcnc", 1).deepest == 0.0
    assert checked(PROGRAM.format(z=0.0, x=2.1), job(profile), walls, 0.002, "linuxcnc", 1).deepest > 0.05


def test_inch_instead_of_mm_goes_into_the_part_or_touches_nothing():
    text = PROGRAM.format(z=0.5, x=15).replace("G21", "G20")
    found = checked(text, job(PROFILES["ball"]), TRIANGLES[:2], 0.002, "linuxcnc", 1)
    assert found.touching == 0.0


def test_a_text_that_a_controller_refuses_is_not_checked():
    assert "no end" in checked("G21 G90\nG0 X0\n", job(PROFILES["ball"]), TRIANGLES, 0.002, "linuxcnc", 1).refused


def test_lifts_for_nothing_are_counted():
    cut = "G0 X{x} Y0\nG1 Z0\nG1 X{x1} Y0.05\nG1 X{end}\nG0 Z20\n"
    spans = [(-15, -14.9), (-14.7, -12), (0, 4), (6, 6.1), (6.2, 9)]
    body = "".join(cut.format(x=x, x1=x + 0.05, end=end) for x, end in spans)
    text = f"G21 G90 G17 G54\nT1 M6\nG43 H1\nG0 Z20\nF500\n{body}M2\n"
    document = job(PROFILES["ball"]) | {"operations": [{"smallest_feature": 0.6}, {"smallest_feature": 0.5}]}
    found = checked(text, document, TRIANGLES[:2], 0.002, "linuxcnc", 1)
    assert (found.cuts, found.lifts) == (5, 2)
    circles = text.replace("M2", 2 * "G0 X9 Y0.05\nG1 Z0\nG2 X9 Y0.05 I-3 J0\nG0 Z20\n" + "M2")
    found = checked(circles, document | {"operations": [{}]}, TRIANGLES[:2], 0.002, "linuxcnc", 1)
    assert (found.cuts, found.lifts) == (7, 4), (
        "full circles are cuts; an operation that names no feature has its default"
    )
    changed = text.replace("X6.2 Y0", "X6.2 Y0\nT2 M6\nG43 H2")
    document["tools"] = document["tools"] | {"other": document["tools"]["cutter"] | {"number": 2}}
    assert checked(changed, document, TRIANGLES[:2], 0.002, "linuxcnc", 1).lifts == 1, "the tool is another one"
