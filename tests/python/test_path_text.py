"""A program's moves as the text of FreeCAD's commands: their geometry, without FreeCAD."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import styluscam as sc

WRITTEN = 1.01e-6
"""Six decimals; centres are relative to a start that has six as well."""

Command = tuple[str, dict[str, float]]

FRAMES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}


def program(*lines: str) -> sc.Program:
    text = "\n".join(["G21 G90 G94 G17 G54", "G0 X0 Y0 Z0", *lines, "M2", ""])
    return sc.read_gcode(text, sc.Machine.shipped("linuxcnc"))


def commands(*lines: str) -> list[Command]:
    return commands_of(program(*lines).path_text())


def commands_of(text: str) -> list[Command]:
    """Names and parameters, as FreeCAD reads them."""
    lines = [line.split(" ") for line in text.splitlines()]
    return [(name, {word[0]: float(word[1:]) for word in words}) for name, *words in lines]


def traced(found: list[Command], pieces: int = 720) -> np.ndarray:
    """Points along FreeCAD's commands, by the definition of G2 and G3: (N,3)."""
    plane, at, points = 17, None, []
    for name, parameters in found:
        if name in ("G17", "G18", "G19"):
            plane = int(name[1:])
            continue
        end = np.array([parameters[axis] for axis in "XYZ"])
        points += [end] if name in ("G0", "G1") else list(turned(plane, name, at, end, parameters, pieces))
        at = end
    return np.array(points)


def turned(plane: int, name: str, start: Any, end: np.ndarray, parameters: Any, pieces: int) -> Iterator[np.ndarray]:
    first, second, _ = FRAMES[plane]
    assert {"I", "J", "K"} & set(parameters) == {"IJK"[first], "IJK"[second]}
    centre = start.copy()
    for axis in (first, second):
        centre[axis] += parameters["IJK"[axis]]
    angles = [math.atan2(p[second] - centre[second], p[first] - centre[first]) for p in (start, end)]
    sense = -1.0 if name == "G2" else 1.0
    sweep = (sense * (angles[1] - angles[0])) % (2.0 * math.pi)
    if start[first] == end[first] and start[second] == end[second]:
        sweep = 2.0 * math.pi
    for share in np.linspace(0.0, 1.0, pieces + 1)[1:]:
        angle = angles[0] + sense * sweep * share
        radius = math.hypot(start[first] - centre[first], start[second] - centre[second])
        point = start + share * (end - start)
        point[first], point[second] = (
            centre[first] + radius * math.cos(angle),
            centre[second] + radius * math.sin(angle),
        )
        yield point


QUARTER = ("G1 X10 F600", "G3 X0 Y10 I-10 J0")


def changed(lines: tuple[str, ...], change: Callable[[list[Any]], None]) -> sc.Program:
    """The program of these lines, its document changed before it is read."""
    document = json.loads(program(*lines).engine.to_json())
    change(document["moves"])
    return sc.Program.from_json(json.dumps(document))


def length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def test_a_quarter_each_way() -> None:
    (_, _, arc) = commands("G1 X10 F600", "G3 X0 Y10 I-10 J0")
    assert arc == ("G3", {"X": 0.0, "Y": 10.0, "Z": 0.0, "I": -10.0, "J": 0.0, "F": 10.0})
    (_, _, arc) = commands("G1 X10 F600", "G2 X0 Y-10 I-10 J0")
    assert arc == ("G2", {"X": 0.0, "Y": -10.0, "Z": 0.0, "I": -10.0, "J": 0.0, "F": 10.0})


def test_other_planes_are_stated_once_and_left() -> None:
    found = commands("G1 X10 F600", "G18", "G2 X0 Z-10 I-10 K0", "G2 X-10 Z0 I0 K10", "G19", "G3 Y5 Z5 J0 K5", "G1 X1")
    names = [name for name, _ in found]
    assert names == ["G0", "G1", "G18", "G2", "G2", "G19", "G3", "G1", "G17"]
    assert found[3][1] == pytest.approx({"X": 0, "Y": 0, "Z": -10, "I": -10, "K": 0, "F": 10}, abs=1e-9)
    assert found[6][1] == pytest.approx({"X": -10, "Y": 5, "Z": 5, "J": 0, "K": 5, "F": 10}, abs=1e-9)


def test_lines_alone_state_no_plane() -> None:
    assert [name for name, _ in commands("G1 X10 F600", "G18", "G1 Z-1")] == ["G0", "G1", "G1"]


def test_a_full_circle_ends_where_it_starts() -> None:
    found = commands("G1 X10 F600", "G2 X10 Y0 I-4 J3")
    assert (found[-1][1]["X"], found[-1][1]["Y"]) == (found[-2][1]["X"], found[-2][1]["Y"])
    points = traced(found)[1:]
    assert length(points) == pytest.approx(2.0 * math.pi * 5.0, rel=1e-4)
    assert np.abs(np.linalg.norm(points[:, :2] - [6.0, 3.0], axis=1) - 5.0).max() < 1e-9


@pytest.mark.parametrize(
    ("plane", "ends", "centre"),
    [
        (17, "X0 Y5 Z-9", "I-5 J0"),
        (18, "Z0 X5 Y-9", "I0 K-5"),
        (19, "Y0 Z5 X-9", "J-5 K0"),
    ],
)
@pytest.mark.parametrize("code", ["G2", "G3"])
def test_turns_of_a_helix_become_circles(plane: int, ends: str, centre: str, code: str) -> None:
    """P3: two full turns and the first arrival."""
    starts = {17: "X5 Y0 Z0", 18: "X0 Y0 Z5", 19: "X0 Y5 Z0"}
    found = commands(f"G1 {starts[plane]} F600", f"G{plane}", f"{code} {ends} {centre} P3")
    arcs = [words for name, words in found if name == code]
    assert len(arcs) == 3
    share = 0.25 if (code == "G3") else 0.75
    radius, rise = 5.0, 9.0
    expected = math.hypot(2.0 * math.pi * radius * (2.0 + share), rise)
    assert length(traced(found)[1:]) == pytest.approx(expected, rel=1e-4)
    third = "XYZ"[FRAMES[plane][2]]
    heights = [-rise * turns / (2.0 + share) for turns in (1.0, 2.0, 2.0 + share)]
    assert [words[third] for words in arcs] == pytest.approx(heights, abs=WRITTEN)


def test_a_short_arc_is_no_full_circle() -> None:
    """Written with six decimals its ends would be one point."""

    def shorten(moves: list[Any]) -> None:
        moves[-1]["end"] = [10.0, 0.000001, 0.0]

    found = commands_of(changed(QUARTER, shorten).path_text())
    assert found[-1] == ("G1", {"X": 10.0, "Y": 0.000001, "Z": 0.0, "F": 10.0})


def test_an_arc_from_nowhere_is_refused() -> None:
    def behead(moves: list[Any]) -> None:
        del moves[:-1]

    with pytest.raises(sc.JobError, match="move 1 is an arc with an unknown start") as caught:
        changed(QUARTER, behead).path_text()
    assert (caught.value.code, caught.value.hint) == ("path-arc-start", "begin with a rapid move or a line")


def test_a_line_of_a_tool_that_leans_states_its_axis_and_an_arc_is_refused() -> None:
    def tilt(moves: list[Any]) -> None:
        moves[1]["axis"] = [0.6, 0.0, 0.8]

    def tilt_arc(moves: list[Any]) -> None:
        moves[2]["axis"] = [0.6, 0.0, 0.8]

    found = changed(QUARTER, tilt).path_text().splitlines()
    assert [line for line in found if " K" in line] == ["G1 X10 Y0 Z0 I0.6 J0 K0.8 F10"]
    with pytest.raises(sc.JobError, match="move 3 is an arc of a tool that leans"):
        changed(QUARTER, tilt_arc).path_text()


def test_numbers_have_six_decimals_and_zero_no_sign() -> None:
    def move(moves: list[Any]) -> None:
        moves[0]["end"] = [1.00000049, -0.00000049, -12.3456785]

    assert changed(QUARTER, move).path_text().splitlines()[0] == "G0 X1 Y0 Z-12.345679"


@pytest.mark.parametrize("seed", range(60))
def test_commands_follow_the_program(seed: int) -> None:
    random = np.random.default_rng(seed)
    plane, code, turns = [17, 18, 19][seed % 3], ["G2", "G3"][seed % 2], seed % 4 + 1
    radius, rise = random.uniform(0.5, 50.0), random.uniform(-5.0, 5.0)
    from_angle, to_angle = random.uniform(0.0, 2.0 * math.pi, 2)
    first, second, third = FRAMES[plane]
    start, end = np.zeros(3), np.zeros(3)
    for point, angle in ((start, from_angle), (end, to_angle)):
        point[first], point[second] = radius * math.cos(angle), radius * math.sin(angle)
    end[third] = rise

    def text(point: np.ndarray) -> str:
        return " ".join(f"{axis}{value:.9f}" for axis, value in zip("XYZ", point, strict=True))

    offsets = " ".join(f"{'IJK'[axis]}{-start[axis]:.9f}" for axis in (first, second))
    planned = program(f"G1 {text(start)} F600", f"G{plane}", f"{code} {text(end)} {offsets} P{turns}")
    ours = traced(commands_of(planned.path_text()))
    theirs = planned.positions
    assert length(ours) == pytest.approx(length(theirs), rel=1e-3, abs=1e-3)
    away = np.linalg.norm(theirs[::3, None] - ours[None, ::2], axis=2).min(axis=1)
    assert away.max() < 2.0 * math.pi * 50.0 / 360 + 0.01
