"""Shear spinning, the whole way: a meridian in X and Z posted with a feed per revolution, and what is wrong is found."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from test_tpif import die, document, posted

import roots
import rs274
import styluscam as sc

THICKNESS = 1.0
BALL = 5.0
"""The tool's radius, mm."""
RPM = 300.0
FEED = 2.0
"""mm per revolution."""
SHEET = {"thickness": THICKNESS, "law": "sine"}
PER_REVOLUTION = {"options": {"feed_mode": "per-revolution"}}
ROUND = {"cone_cup": ["Face1", "Face2", "Face3", "Face4"], "cap_r60": ["Face1"]}


def job(part: sc.Part, faces: Any = "all", **sections: Any) -> sc.Job:
    """A job that spins a sheet over a part; `sections` are merged into it."""
    spindle = {"mode": "fixed", "rpm": RPM}
    operation = {"feed_per_rev": FEED, "spindle": spindle, "feeds": {"plunge": 150.0}, **sections.pop("operation", {})}
    own: dict[str, Any] = {
        "process": {"kind": "spinning"},
        "setup": {"sheet": SHEET},
        "machine": {"name": "linuxcnc", **PER_REVOLUTION},
    }
    made = document(faces, kind="meridian", **{**own, **sections}, operation=operation)
    del made["operations"][0]["step"]
    return sc.Job.from_dict(made, part=part)


@lru_cache(maxsize=4)
def spun(name: str) -> tuple[sc.Job, list[str]]:
    """The job of a fixture part and its posted lines."""
    made = job(die(name), ROUND[name])
    return made, posted(made).splitlines()


@lru_cache(maxsize=1)
def ellipsoid() -> tuple[Any, Any, Any]:
    """Half an ellipsoid of revolution down to where it slopes by 60 degrees: vertices, triangles, normals at their corners."""
    a, c, rings, around = 40.0, 25.0, 160, 240
    t = np.linspace(0.0, np.arctan(np.tan(np.pi / 3) * a / c), rings + 1)
    angle = np.linspace(0.0, 2 * np.pi, around, endpoint=False)
    r, z = a * np.sin(t)[1:, None], c * np.cos(t)[1:, None]
    ring = np.stack([r * np.cos(angle), r * np.sin(angle), z + 0.0 * angle], axis=2).reshape(-1, 3)
    vertices = np.vstack([[0.0, 0.0, c], ring])
    i, j = np.meshgrid(np.arange(rings - 1), np.arange(around), indexing="ij")
    a0, a1 = 1 + i * around + j, 1 + i * around + (j + 1) % around
    quads = np.stack([a0, a0 + around, a1 + around, a0, a1 + around, a1], axis=2).reshape(-1, 3)
    k = np.arange(around)
    triangles = np.vstack([np.stack([0 * k, 1 + k, 1 + (k + 1) % around], axis=1), quads])
    normals = vertices / [a * a, a * a, c * c]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return vertices, triangles, normals[triangles]


def dome() -> sc.Part:
    return sc.Part.from_mesh(*ellipsoid())


def test_what_is_posted_is_the_offset_of_the_meridian() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cap_r60")
    moves = sc.read_gcode("\n".join(lines), "linuxcnc").moves
    tips = moves["end"][moves["feed"] > 0][1:]
    assert not tips[:, 1].any() and (np.diff(tips[:, 0]) > 0).all() and (np.diff(tips[:, 2]) <= 0).all()
    # sphere and ball touch along the line of their centres; the sheet lies on the sphere, moved up by its thickness
    middle = tips - [0.0, 0.0, -60.0 - THICKNESS] - [0.0, 0.0, THICKNESS - BALL]
    off = np.linalg.norm(middle, axis=1) - (60.0 + BALL)
    inside = tips[:, 0] < 30.0
    assert inside.sum() > 20
    assert off[inside].min() >= -0.001 and off[inside].max() <= 0.005
    assert "G95" in "\n".join(lines) and any(line.endswith(f"F{FEED:g}") for line in lines)


@pytest.mark.parametrize("name", ["cone_cup", "cap_r60", "dome"])
def test_round_parts_pass(name: str) -> None:
    if name == "dome":
        made = job(dome(), operation={"tolerance": 0.01})
        text = posted(made)
    else:
        pytest.importorskip("OCP", reason="needs the step extra")
        made, lines = spun(name)
        text = "\n".join(lines) + "\n"
    report = sc.verify(text, made)
    assert report.ok and not report.findings, report.findings


@pytest.mark.world
def test_linuxcnc_reads_the_feed_per_revolution() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cone_cup")
    try:
        interpreted = rs274.interpret("\n".join(lines) + "\n")
    except roots.Unavailable as reason:
        pytest.skip(f"NOT TESTED with LinuxCNC: {reason}")
    assert interpreted.ok, interpreted.error
    assert ("0", "1") in {call.words for call in interpreted.of("SET_FEED_MODE")}
    ends = np.array([call.mm for call in interpreted.of("STRAIGHT_FEED")])
    moves = sc.read_gcode("\n".join(lines), "linuxcnc").moves
    assert np.allclose(ends, moves["end"][moves["feed"] > 0], atol=1e-4)
    assert not ends[:, 1].any() and {call.feed for call in interpreted.of("STRAIGHT_FEED")} == {0.5, FEED}


def found(lines: list[str]) -> dict[str, str]:
    """The first message by kind, errors before warnings."""
    made, _ = spun("cone_cup")
    messages: dict[str, str] = {}
    for finding in sc.verify("\n".join(lines) + "\n", made).findings:
        messages.setdefault(finding["kind"], finding["message"])
    return messages


def path_of(lines: list[str]) -> tuple[int, int]:
    """The lines before and behind the path, from the plunge to the wait of a turn at its end."""
    first = next(number for number, line in enumerate(lines) if line.startswith("G1 Z"))
    return first, next(number for number in range(first + 1, len(lines)) if lines[number].startswith("G"))


def points_of(lines: list[str]) -> list[tuple[float, float]]:
    """X and Z of the path's points, from where the tool comes down."""
    first, end = path_of(lines)
    at, points = {"X": 0.0, "Z": 0.0}, []
    for line in lines[first:end]:
        at |= {word[0]: float(word[1:]) for word in line.split() if word[0] in "XZ"}
        points.append((at["X"], at["Z"]))
    return points


def test_wrong_words_are_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cone_cup")
    first, end = path_of(lines)
    assert f"F{FEED:g}" in lines[first + 1]
    points = points_of(lines)
    into, off = end - first - 12, end - first - 6
    changed = list(lines)
    for number, by in ((into, -0.05), (off, 0.05)):
        x, z = points[number]
        changed[first + number] = f"X{x} Z{z + by:.3f}"
    changed = [line.replace(f"S{RPM:g}", "S320") for line in changed]
    messages = found(changed)
    assert {"gouge", "excess", "spindle-differs"} <= set(messages)
    # 0.05 down on a slope, where the text states it
    assert f"line {first + into + 1}" in messages["gouge"] and f"line {first + off + 1}" in messages["excess"]


@pytest.mark.parametrize("code", ["G7", "G96 D500"])
def test_diameters_and_surface_speeds_are_not_taken_for_radii_and_revolutions(code: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made, lines = spun("cone_cup")
    first, _ = path_of(lines)
    with pytest.raises(sc.VerifyError) as caught:
        sc.verify("\n".join([*lines[:first], code, *lines[first:]]) + "\n", made)
    assert code.split(maxsplit=1)[0] in str(caught.value)


def test_another_feed_per_revolution_is_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cone_cup")
    messages = found([re.sub(rf"F{FEED:g}$", f"F{2.5 * FEED:g}", line) for line in lines])
    assert f"the feed is {2.5 * FEED * RPM:g} mm/min, and {FEED * RPM:g} in the job" in messages["feed-differs"]
    # and what it leaves: turns are two and a half times as far apart
    assert "missing-pass" in messages


def test_a_missing_stretch_is_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cone_cup")
    _, end = path_of(lines)
    x, z = points_of(lines)[-2]
    # the wall falls as far as it goes out: 9 mm of it are left out
    [a, b] = [f"X{x + out:.3f} Z{z - out:.3f}" for out in (4.0, 13.0)]
    jump = [a, "G0 Z10", b.split()[0], "Z2", f"G1 {b.split()[1]} F0.5", f"{lines[end - 1]} F{FEED:g}"]
    messages = found([*lines[: end - 1], *jump, *lines[end:]])
    assert "without a level" in messages["missing-level"] and "missing-pass" in messages


def test_the_wrong_order_is_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = spun("cone_cup")
    _, end = path_of(lines)
    rim, *inwards = [f"X{x:g} Z{z:g}" for x, z in reversed(points_of(lines))]
    start = lines.index("X0 Y0")
    down = [f"{rim.split()[0]} Y0", "Z2", f"G1 {rim.split()[1]} F0.5", f"{inwards[0]} F{FEED:g}", *inwards[1:]]
    messages = found([*lines[:start], *down, *lines[end:]])
    assert "punches through" in messages["punch"]


def test_a_plan_takes_the_time_of_its_turns() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made, _ = spun("cone_cup")
    plan = sc.plan(made)
    summary, _ = plan.summary()
    facts = {fact.fact: fact.value for fact in summary.operations[0].facts}
    moves = plan.programs["main"].moves
    tips = moves["end"][moves["feed"] > 0]
    length = np.linalg.norm(np.diff(tips, axis=0), axis=1).sum()
    assert facts["turns"] == pytest.approx(length / FEED, abs=1.0)
    # besides the path a plunge of 2 mm, rapids and the wait of a turn
    assert 0.5 < plan.programs["main"].duration - 60.0 * length / (FEED * RPM) < 3.0
    # a ball leaves f^2 / 8 R on a plane; the sheet's sine law does not change its section
    assert facts["scallop"] == pytest.approx(FEED**2 / (8 * BALL), rel=0.02)
    assert facts["thinnest"] == pytest.approx(THICKNESS * np.sin(np.pi / 4), abs=1e-3)


def two_cups() -> sc.Part:
    """Two domes, side by side."""
    vertices, triangles, normals = ellipsoid()
    aside = np.array([45.0, 0.0, 0.0])
    both = np.vstack([vertices - aside, vertices + aside])
    return sc.Part.from_mesh(both, np.vstack([triangles, triangles + len(vertices)]), np.vstack([normals, normals]))


@pytest.mark.parametrize(
    ("part", "zero", "deviation"),
    [
        (lambda: die("pyramid"), 0.0, [5.0, 40.0]),
        (two_cups, 0.0, [10.0, 90.0]),
        (dome, 3.0, [2.0, 6.0]),
        (dome, 0.02, [0.02, 0.05]),
    ],
    ids=["pyramid", "two cups", "3 mm off", "0.02 mm off"],
)
def test_what_is_not_round_is_refused(part: Any, zero: float, deviation: list[float]) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(part(), setup={"sheet": SHEET, "zero": [zero, 0.0, 0.0]}))
    error = caught.value
    assert (error.code, error.where) == ("not-round", "operations[0].faces")
    measured = re.search(r"X-?[\d.]+ Y-?[\d.]+ Z-?[\d.]+ comes to lie ([\d.]+) mm off", str(error))
    assert measured and deviation[0] <= float(measured[1]) <= deviation[1], str(error)
    assert "setup.zero" in (error.hint or "")


@pytest.mark.parametrize(
    ("sections", "where", "hint"),
    [
        ({"machine": {"name": "grbl"}}, "machine.options.feed_mode", "linuxcnc"),
        ({"machine": {"name": "linuxcnc"}}, "machine.options.feed_mode", "per-revolution"),
        ({"setup": {"sheet": {"thickness": 1.0}}}, "setup.sheet.law", "sine"),
        ({"process": {"kind": "tpif", "die": "male"}}, "operations[0].kind", "spinning"),
        ({"operation": {"spindle": {"mode": "off"}}}, "operations[0].spindle.mode", "fixed"),
        ({"operation": {"links": "low"}}, "operations[0].links", 'write links = "clearance"'),
        ({"operation": {"lead": "tangent"}}, "operations[0].lead", 'write lead = "none"'),
        ({"operation": {"lead": "vertical"}}, "operations[0].lead", 'write lead = "none"'),
        ({"operation": {"direction": "climb"}}, "operations[0].direction", "direction"),
        ({"operation": {"kind": "z-level", "step": {"height": 1.0}}}, "operations[0].feed_per_rev", ""),
    ],
)
def test_what_cannot_be_spun_is_refused(sections: dict[str, Any], where: str, hint: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(die("cap_r60"), ROUND["cap_r60"], **sections))
    assert caught.value.where == where
    assert hint in f"{caught.value} {caught.value.hint}"


@pytest.mark.parametrize("machine", ["fanuc", "haas", "siemens"])
def test_other_machines_with_feeds_per_revolution(machine: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made = job(die("cone_cup"), ROUND["cone_cup"], machine={"name": machine, **PER_REVOLUTION})
    text = posted(made)
    report = sc.verify(text, made)
    assert report.ok, report.findings
    assert "G95" in text and re.search(r"F2\.?0*$", text, re.MULTILINE)
