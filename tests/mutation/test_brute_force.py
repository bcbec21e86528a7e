"""Gouge and excess of the verifier against a brute-force search, to a millionth of a millimetre."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc
from brute_force import Solid
from convex_tool import Tool
from gcode import read
from long_cases import some_long

from .cases import document, lopsided, roof, stack, terrain

DIAMETER = 4.0
BALL = {"kind": "ball", "diameter": 4.0}
CLOTHOID = {"kind": "clothoid", "diameter": 4.0}
FLAT = {"kind": "flat", "diameter": 4.0}
BULL_NOSE = {"kind": "bull-nose", "diameter": 4.0, "corner_radius": 0.7}
CONE = {"kind": "cone", "diameter": 4.0, "half_angle_deg": 30.0}
TAPERED_BALL = {"kind": "tapered-ball", "tip_radius": 0.5, "diameter": 4.0, "half_angle_deg": 20.0}
BACK = ({"thickness": 0.5}, "back")
MIDDLE_BY_SINE = ({"thickness": 0.5, "law": "sine"}, "mid")

PARTS = {
    "block": stack(4, [(10, 0), (6, 4)]),
    "pit": lopsided(stack(6, [(14, 4), (10, 4), (6, 0)])),
    "roof": roof(30.0),
    "terrain": terrain(3, side=3),
    "leaf": (np.array([[0.0, 0.0, 0.0], [9.0, 1.0, 1.0], [2.0, 8.0, 2.5]]), np.array([[0, 1, 2]])),
}
SEGMENTS: dict[str, list[tuple[list[float], list[float]]]] = {
    "block": [
        ([-9, -4, 3.9], [8, -4, 3.8]),
        ([-3, -2, 4.2], [5, 3, 3.7]),
        ([7.5, -1, 1.6], [7.2, 1, 1.8]),
        ([5, 5, 2.4], [9, 9, 1.1]),
    ],
    "pit": [([-3, -2, 0.4], [2, 1, -0.1]), ([-6, 0, 2.0], [-6, 2, 2.2]), ([0, 0, 0.3], [6.2, 3, 3.0])],
    "roof": [([2, -4, 2.2], [15, 5, 2.1]), ([2, -2, 4.4], [15, 2.5, 4.4]), ([3, 6, 1.2], [4, -7, 0.9])],
    "terrain": [([1, 1, 1.2], [7, 6, 1.0]), ([0, 7, 1.5], [8, 0.5, 1.1])],
    "leaf": [([-1, 2, 1.0], [8, 3, 0.9]), ([2, 2, 0.9], [3, 7, 2.1]), ([5, -2, 0.5], [5, 5, 1.6])],
}
"""Straight paths of the tip, in the part's own frame; with a sheet they are raised by what lies between."""

TOOLS: dict[str, tuple[dict[str, Any], Any]] = {
    "ball": (BALL, None),
    "ball with a flat": ({**BALL, "tip_flat": 0.5}, None),
    "clothoid": (CLOTHOID, None),
    "bull nose": (BULL_NOSE, None),
    "tapered ball": (TAPERED_BALL, None),
    "flat": (FLAT, None),
    "cone": (CONE, None),
    "ball over a sheet": (BALL, BACK),
    "clothoid over a sheet": (CLOTHOID, BACK),
    "ball over a sheet by the sine law": (BALL, MIDDLE_BY_SINE),
}
SHARP = ("flat", "cone")
"""Their rims and tips have no radius: how deep they are in is another question on every side of them."""
SHALLOW = 0.4
"""mm: less than the least radius of curvature of the other tools."""


def text_of(start: list[float], end: list[float]) -> str:
    ends = [" ".join(f"{axis}{value:.6f}" for axis, value in zip("XYZ", point, strict=True)) for point in (start, end)]
    return (
        "G21 G90 G94 G17 G40 G49 G80\nG54\nG64 P0.001 Q0\nT1 M6\nG43 H1\nG0 Z50\n"
        f"X{start[0]:.6f} Y{start[1]:.6f}\nG1 {ends[0]} F300\n{ends[1]} F1500\nG0 Z50\nM2\n"
    )


def subject_of(name: str, part: str) -> tuple[sc.Job, Tool, Solid]:
    """A tool on a part, for the verifier and for the brute force."""
    profile, sheet = TOOLS[name]
    made = document("zig-zag", profile, {"name": "linuxcnc"}, sheet=sheet)
    made["setup"]["zero"] = "model"
    vertices, triangles = PARTS[part]
    job = sc.Job.from_dict(made, part=sc.Part.from_mesh(vertices, triangles))
    return job, Tool.of(profile, *(sheet or ())), Solid(vertices[triangles])


LONG = {"clothoid over a sheet"}
"""The brute force takes longest with it; clothoids and sheets are each among the others."""


@pytest.mark.parametrize("part", SEGMENTS)
@pytest.mark.parametrize("name", some_long(TOOLS, LONG))
def test_gouge_and_excess_are_those_of_the_brute_force(name: str, part: str) -> None:
    job, tool, solid = subject_of(name, part)
    for low, high in SEGMENTS[part]:
        start, end = ([x, y, z + tool.raised] for x, y, z in (low, high))
        report = sc.verify(text_of(start, end), job)
        across = solid.deepest(tool, start, end)
        down = solid.deepest(tool, [*start[:2], start[2] + 3.0], start)
        depth = max(0.0, -across.value, -down.value)
        if depth < (1e-6 if name in SHARP else SHALLOW):
            assert report.gouge_max == pytest.approx(depth, abs=1e-6)
        else:
            assert report.gouge_max > 0.2 * depth
        pieces = int(np.ceil(np.linalg.norm(np.subtract(end, start)) / (0.25 * TOOLS[name][0]["diameter"]) - 1e-9))
        looked_at = solid.clearances(tool, np.linspace(start, end, 2 * max(pieces, 1) + 1))
        # where a sharp tool is deep in, the search jumps between the sides of what it is in
        if depth < SHALLOW or name not in SHARP:
            assert report.excess_max == pytest.approx(max(0.0, looked_at.max()), abs=1e-6)


ARC_MOVES: dict[str, list[tuple[list[float], list[float], list[float], str]]] = {
    "block": [([7.6, 0, 1.5], [-7.6, 0, 1.7], [-7.6, 0], "G3"), ([-4, -4, 3.9], [4, 4, 4.05], [4, 4], "G2")],
    "pit": [([5.0, 0, 1.1], [5.0, 0, 0.9], [-5.0, 0], "G2"), ([-2, 1, 0.05], [2, 3, -0.1], [2, 1], "G3")],
    "roof": [([4, -4, 2.2], [4, 4, 2.2], [3, 4], "G3"), ([14, 1, 4.3], [8, 1, 4.35], [-3, 2], "G2")],
    "leaf": [([0, 2, 1.2], [6, 2, 0.9], [3, 1], "G3")],
}
"""Start, end and centre from the start, which rises or falls along the path; each is a turn about Z."""


@pytest.mark.parametrize("part", ARC_MOVES)
@pytest.mark.parametrize("name", ["ball", "bull nose", "tapered ball", "ball over a sheet"])
def test_arcs_are_those_of_the_brute_force(name: str, part: str) -> None:
    job, tool, solid = subject_of(name, part)
    for low, high, centre, code in ARC_MOVES[part]:
        start, end = ([x, y, z + tool.raised] for x, y, z in (low, high))
        arc = f"{code} I{centre[0]:.6f} J{centre[1]:.6f}"
        text = text_of(start, end).replace("F300\n", f"F300\n{arc} ")
        report = sc.verify(text, job)
        (move,) = [m for m in read(text, "linuxcnc").moves if m.kind == "arc"]
        deepest = solid.deepest_along(tool, lambda shares, move=move: np.array([move.at(share) for share in shares]))
        depth = max(0.0, -deepest.value, -solid.deepest(tool, [*start[:2], start[2] + 3.0], start).value)
        if depth < SHALLOW:
            assert report.gouge_max == pytest.approx(depth, abs=1e-6)
        else:
            assert report.gouge_max > 0.2 * depth
        length = np.hypot(move.angle * np.hypot(*centre), end[2] - start[2])
        pieces = int(np.ceil(max(move.angle / np.radians(15.0), length / (0.25 * DIAMETER)) - 1e-9))
        looked_at = solid.clearances(tool, np.array([move.at(i / (2 * pieces)) for i in range(2 * pieces + 1)]))
        assert report.excess_max == pytest.approx(max(0.0, looked_at.max()), abs=1e-6)


@pytest.mark.parametrize("sheet", [None, BACK])
@pytest.mark.parametrize("length", [3.9, 4.4, 4.999, 5.1, 7.0])
def test_a_holder_collides_where_the_brute_force_finds_it(length: float, sheet: Any) -> None:
    made = document("zig-zag", BALL, {"name": "linuxcnc"}, sheet=sheet)
    made["setup"]["zero"] = "model"
    made["tools"]["tool"] |= {"length": length, "holder": {"diameter": 16.0, "length": 20.0}}
    vertices, triangles = PARTS["pit"]
    job = sc.Job.from_dict(made, part=sc.Part.from_mesh(vertices, triangles))
    tool, solid = Tool.of(BALL, *(sheet or ())), Solid(vertices[triangles])
    start, end = [-2.0, -1.0, tool.raised], [3.0, 1.0, tool.raised]
    report = sc.verify(text_of(start, end), job)
    depth = -min(
        solid.deepest(tool.holder(16.0, length), a, b).value for a, b in ((start, end), ([*start[:2], 9.0], start))
    )
    collisions = [finding for finding in report.findings if finding["kind"] == "holder-collision"]
    assert bool(collisions) == (depth > 0.001), (depth, report.findings)
    assert all(finding["line"] in (8, 9) for finding in collisions)


GROOVED = [(0.0, 0.0), (3.5, 0.0), (5.0, -2.0), (6.5, 0.0), (13.5, 0.0), (15.0, -2.0), (16.5, 0.0), (20.0, 0.0)]
"""X and Z of a plate with two grooves."""


def grooved_plate() -> tuple[Any, Any]:
    vertices = np.array([[x, y, z] for x, z in GROOVED for y in (0.0, 20.0)])
    strips = [(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3) for i in range(len(GROOVED) - 1)]
    return vertices, np.array([half for a, b, c, d in strips for half in ((a, c, d), (a, d, b))])


def report_of(mesh: tuple[Any, Any], profile: dict[str, Any], start: list[float], end: list[float]) -> sc.Report:
    made = document("zig-zag", profile, {"name": "linuxcnc"})
    return sc.verify(text_of(start, end), sc.Job.from_dict(made, part=sc.Part.from_mesh(*mesh)))


def test_excess_between_the_samples_is_found() -> None:
    mesh, profile = grooved_plate(), {"kind": "ball", "diameter": 1.0}
    start, end = [0.5, 10.0, 0.0005], [19.5, 10.0, 0.0005]
    everywhere = Solid(mesh[0][mesh[1]]).clearances(Tool.of(profile), np.linspace(start, end, 401))
    assert report_of(mesh, profile, start, end).excess_max > 0.9 * everywhere.max()


@pytest.mark.parametrize("half_angle_deg", [10.0, 30.0])
def test_a_sharp_tip_in_the_part_is_found(half_angle_deg: float) -> None:
    """Below the tip the part is cut 0.0018 mm too deep."""
    profile = {"kind": "cone", "diameter": 2.0, "half_angle_deg": half_angle_deg}
    report = report_of(stack(4, [(20, 0), (10, 0)]), profile, [-4.0, -4.0, -0.0018], [4.0, 4.0, -0.0018])
    assert report.gouge_max == pytest.approx(0.0018, abs=1e-6)
    assert not report.ok


@pytest.mark.parametrize("half_angle_deg", [0.5, 1.0, 2.0, 2.5, 3.0, 8.0])
def test_the_tip_of_a_needle_is_as_deep_as_it_is_pressed(half_angle_deg: float) -> None:
    depth = 0.02
    made = document(
        "zig-zag", {"kind": "cone", "diameter": 1.0, "half_angle_deg": half_angle_deg}, {"name": "linuxcnc"}
    )
    made["setup"]["zero"] = "model"
    corners = np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 20.0, 0.0], [0.0, 20.0, 0.0]])
    job = sc.Job.from_dict(made, part=sc.Part.from_mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    report = sc.verify(text_of([5.0, 10.0, -depth], [9.0, 11.0, -depth]), job)
    assert report.gouge_max == pytest.approx(depth, abs=1e-9)
    assert not report.ok
