"""Passes that a text does not have, against programs of which some were taken out."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import styluscam as sc

STEPOVER = 3.0
SIDES = 96
SPINDLE = {"mode": "fixed", "rpm": 8000.0}
Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]


def turned(profile: list[tuple[float, float]], sides: int = SIDES) -> Mesh:
    """The surface that a line of (radius, height), mm, from the tip or the bottom, sweeps about Z, its outside up."""
    angles = 2 * np.pi * np.arange(sides) / sides
    rings = [np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(sides, z)]) for r, z in profile]
    here = np.arange(sides)
    there = np.roll(here, -1)
    triangles = []
    for ring in range(len(profile) - 1):
        a, b, c, d = (sides * (ring + up) + along for up in (0, 1) for along in (here, there))
        triangles += [np.column_stack([a, c, b]), np.column_stack([b, c, d])]
    return np.concatenate(rings), np.concatenate(triangles)


def arc(radius: float, depth: float) -> list[tuple[float, float]]:
    """A bowl's profile, mm, in steps of 3 degrees."""
    last = np.arccos(1 - depth / radius)
    angles = np.linspace(0.02, last, int(np.degrees(last) / 3))
    return [(radius * np.sin(angle), radius * (1 - np.cos(angle))) for angle in angles]


PARTS: dict[str, Mesh] = {
    "pyramid": turned([(0.001, 6.0), (14.0, 0.0)], sides=4),
    "funnel": turned([(3.0, 0.0), (8.0, 6.0)]),
    "bowl": turned(arc(12.0, 6.0)),
    "pin": turned([(5.0, 6.0), (7.0, 0.0)]),
}
OPERATIONS = {
    "missing-row": {"kind": "zig-zag", "stepover": STEPOVER},
    "missing-level": {"kind": "z-level", "step": {"height": 1.0}},
}


def job_of(part: str, kind: str, smallest_feature: float, keys: dict[str, Any] | None = None) -> sc.Job:
    """A part milled with a ball that is as wide as the rows are apart."""
    vertices, triangles = PARTS[part]
    operation = {"tool": "ball", "smallest_feature": smallest_feature, "spindle": SPINDLE, **(keys or OPERATIONS[kind])}
    document = {
        "schema": 1,
        "part": {"file": f"{part}.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": STEPOVER}}},
        "operations": [operation],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles))


def without(text: str, kind: str, low: float, high: float) -> tuple[str, int]:
    """A text without the moves at feed whose tip lies between two positions, and how many there were.

    What else those lines say, G1 and F, holds for the lines after them and stays.
    """
    axis = "Y" if kind == "missing-row" else "Z"
    position, kept, left = np.inf, [], 0
    for line in text.splitlines():
        words = [] if line.startswith("(") else line.split()
        position = next((float(word[1:]) for word in words if word.startswith(axis)), position)
        inside = low < position < high and any(word[0] in "XYZ" for word in words)
        left += inside
        kept.append(" ".join(word for word in words if word[0] not in "XYZ") if inside else line)
    return "\n".join(kept) + "\n", left


@pytest.mark.parametrize("smallest_feature", [0.2, 1.0, 3.0])
@pytest.mark.parametrize(("high", "severity"), [(1.9, "warning"), (5.4, "error")])
@pytest.mark.parametrize("kind", OPERATIONS)
@pytest.mark.parametrize("part", PARTS)
def test_passes_that_were_taken_out_are_found(
    part: str, kind: str, high: float, severity: str, smallest_feature: float
) -> None:
    """A few are a matter of what is left over; without many it is another program."""
    job = job_of(part, kind, smallest_feature)
    whole = sc.post(sc.plan(job)).text
    assert not sc.verify(whole, job).findings
    text, left = without(whole, kind, *((0.5, high) if kind == "missing-level" else (-high, high)))
    assert left
    found = {finding["kind"]: finding for finding in sc.verify(text, job).findings}
    assert found[kind]["severity"] == severity
    assert found[kind]["value_mm"] > found[kind]["limit"]


ENDING = {
    "spiral": {"kind": "spiral", "step": {"height": 1.0}},
    "levels": {"kind": "z-level", "step": {"height": 1.0}},
    "scallop": {"kind": "z-level", "step": {"scallop": 0.06}, "step_min": 0.2},
}


def ended_early(text: str, share: float) -> str:
    """A text without the last moves on its last level, this share of them by their number, or without all of it."""
    lines = text.splitlines()
    feeds = [number for number, line in enumerate(lines) if line[:1] in "XYG" and ("X" in line or "Y" in line)]
    level = []
    for number in reversed(feeds):
        level.append(number)
        if "Z" in lines[number]:
            break
    left_off = set(level[: max(1, round(share * len(level)))])
    return "\n".join(line for number, line in enumerate(lines) if number not in left_off) + "\n"


@pytest.mark.parametrize("operation", ENDING)
@pytest.mark.parametrize("part", ["pyramid", "funnel"])
def test_a_program_that_ends_too_soon_is_found(part: str, operation: str) -> None:
    """In the midst of its last level, or a level before it: nothing lies below that shows it."""
    job = job_of(part, "missing-level", 1.0, ENDING[operation])
    whole = sc.post(sc.plan(job)).text
    assert not sc.verify(whole, job).findings
    for share in (0.65, 1.0):  # of 0.4 the turn above leaves less than the tolerance
        found = {finding["kind"] for finding in sc.verify(ended_early(whole, share), job).findings}
        assert found & {"missing-pass", "missing-level"}, share


def rib(height: float, wall_deg: float) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Vertices, triangles and faces of a rib 16 mm wide at its top, along Y on a plate: 2 and 4 are its walls."""
    foot = 8.0 + height * np.tan(np.radians(90.0 - wall_deg))
    line = [(-30.0, 0.0), (-foot, 0.0), (-8.0, height), (8.0, height), (foot, 0.0), (30.0, 0.0)]
    count = len(line)
    vertices = np.array([(x, y, z) for y in (0.0, 40.0) for x, z in line])
    triangles = [t for i in range(count - 1) for t in ((i, i + 1, count + i + 1), (i, count + i + 1, count + i))]
    return vertices, np.array(triangles), np.repeat(np.arange(1, count), 2)


@pytest.mark.parametrize("step", [0.7, 0.9, 1.1])
def test_no_pass_is_wanted_at_the_sharp_upper_edge_of_a_wall(step: float) -> None:
    """The first level lies one step below the edge, and the tool's height at the edge is known to the tolerance only."""
    vertices, triangles, faces = rib(10.0, 80.0)
    document = {
        "schema": 1,
        "part": {"file": "rib.stl", "units": "mm", "faces": ["Face2", "Face4"]},
        "process": {"kind": "milling", "max_unreached": 0.9},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": 12.0}}},
        "operations": [{"tool": "ball", "kind": "z-level", "step": {"height": step}, "spindle": SPINDLE}],
        "machine": {"name": "linuxcnc"},
    }
    job = sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles, face_ids=faces))
    assert not sc.verify(sc.post(sc.plan(job)).text, job).findings


def levels_job(
    mesh: tuple[npt.NDArray[np.float64], ...], faces: list[str], step: float, feature: float, kind: str
) -> sc.Job:
    """Levels with a tool of 6 mm over some faces of vertices, triangles and faces."""
    vertices, triangles, numbers = mesh
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm", "faces": faces},
        "process": {"kind": "milling", "max_unreached": 0.99},
        "tools": {"cutter": {"profile": {"kind": kind, "diameter": 6.0}}},
        "operations": [
            {
                "tool": "cutter",
                "kind": "z-level",
                "step": {"height": step},
                "smallest_feature": feature,
                "spindle": SPINDLE,
            },
        ],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles, face_ids=numbers))


def test_levels_of_a_wall_lower_than_the_smallest_feature_are_asked_for() -> None:
    """How wide the smallest loop has nothing to do with how high a wall is."""
    vertices, triangles = turned([(0.01, 0.9), (10.0, 0.9), (10.0, 0.0), (30.0, 0.0)], sides=4)
    job = levels_job((vertices, triangles, np.repeat([1, 2, 3], 8)), ["Face2"], 0.1, 1.0, "flat")
    text = sc.post(sc.plan(job)).text
    assert not sc.verify(text, job).findings
    cut, left = without(text, "missing-level", -1.0, 0.75)
    found = {(finding["kind"], finding["severity"]) for finding in sc.verify(cut, job).findings}
    assert left and ("missing-level", "error") in found


@pytest.mark.parametrize("width", [6.2, 6.3])
def test_passes_along_the_opposite_wall_of_a_slot_serve_their_own_wall(width: float) -> None:
    """A slot little wider than the ball, cut along one of its walls: what stays on the other one is found."""
    rings = [(20.0, 40.0, 0.0), (0.5 * width, 20.0, 0.0), (0.5 * width, 20.0, -10.0)]
    vertices = np.array([(sx * x, sy * y, z) for x, y, z in rings for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    around = [(i, (i + 1) % 4) for i in range(4)]
    sides = [(up + i, up + j, up + 4 + j, up + 4 + i) for up in (0, 4) for i, j in around]
    quads = [*sides, (8, 9, 10, 11)]
    triangles = np.array([half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])
    faces = np.repeat([1, 1, 1, 1, 2, 3, 4, 5, 6], 2)
    job = levels_job((vertices, triangles, faces), ["Face3", "Face5"], 1.0, 0.3, "ball")
    text = sc.post(sc.plan(job)).text
    assert not sc.verify(text, job).findings
    one_wall = sc.verify(text.replace("X-0.", "X0."), job).findings
    assert len([finding for finding in one_wall if finding["kind"] == "missing-pass"]) >= 4


STEPPED = [(0.01, 30.0), (10.0, 30.0), (10.0, 15.0), (25.0, 15.0), (25.0, 0.0), (40.0, 0.0)]


@pytest.mark.parametrize("step", [1.66, 2.08, 2.44, 2.98])
def test_no_level_is_wanted_while_a_ball_rolls_over_the_edge_of_a_shoulder(step: float) -> None:
    """Between the floor of the upper wall and the top of the lower one the tip goes down by its radius beside neither."""
    vertices, triangles = turned(STEPPED, sides=48)
    job = levels_job((vertices, triangles, np.repeat([1, 2, 3, 4, 5], 96)), ["Face2", "Face4"], step, 1.0, "ball")
    text = sc.post(sc.plan(job)).text
    assert not sc.verify(text, job).findings
    for low, high in ((9.0, 12.0), (18.0, 18.0 + 1.9 * step)):
        cut, left = without(text, "missing-level", low, high)
        assert left and "missing-level" in {finding["kind"] for finding in sc.verify(cut, job).findings}
