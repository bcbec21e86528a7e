"""What is reported of a sheet before it is formed: tool, frame, thickness and force; and spindles that turn freely or roll."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_fixture import tray

import styluscam as sc

WALL = np.radians(45.0)


def job(machine: Any = None, **sections: Any) -> sc.Job:
    """Levels in a tray with walls of 45 degrees, 4 mm deep, in a sheet of 1 mm; `sections` are merged."""
    document: dict[str, Any] = {
        "schema": 1,
        "part": {"file": "tray.stl", "units": "mm", "model_face": "tool"},
        "setup": {"zero": "model", "sheet": {"thickness": 1.0} | sections.get("sheet", {})},
        "tools": {"stylus": {"profile": sections.get("profile", {"kind": "ball", "diameter": 6.0})}},
        "operations": [{"kind": "z-level", "tool": "stylus", "step": {"height": 0.5}} | sections.get("operation", {})],
        "machine": machine or {"name": "linuxcnc"},
    }
    document["setup"] |= sections.get("setup", {})
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*tray()))


def findings(made: sc.Job) -> dict[str, str]:
    """The sentences of what is found, by kind; all of them warnings."""
    report = sc.verify(sc.post(sc.plan(made)), made)
    assert report.ok
    return {finding["kind"]: finding["message"] for finding in report.findings}


def facts(made: sc.Job) -> dict[str, float]:
    summary, _ = sc.plan(made).summary()
    return {fact["fact"]: fact["value"] for fact in summary.to_dict()["operations"][0]["facts"]}


@pytest.mark.parametrize(
    ("profile", "sentence"),
    [
        ({"kind": "ball", "diameter": 4.0}, None),
        ({"kind": "ball", "diameter": 3.0}, "radius of curvature of tool stylus is 1.50 mm"),
        ({"kind": "bull-nose", "diameter": 8.0, "corner_radius": 2.0}, None),
        ({"kind": "bull-nose", "diameter": 8.0, "corner_radius": 1.25}, "is 1.25 mm"),
        ({"kind": "flat", "diameter": 6.0}, "has an edge without a radius"),
    ],
)
def test_a_tool_that_is_too_sharp_for_the_sheet(profile: dict[str, Any], sentence: str | None) -> None:
    found = findings(job(profile=profile))
    assert ("tool-radius" in found) == (sentence is not None)
    assert sentence is None or (sentence in found["tool-radius"] and "needs 2 mm" in found["tool-radius"])


@pytest.mark.parametrize(("opening", "beyond"), [([60.0, 60.0], None), ([41.0, 60.0], 0.5), (56.0, 1.284)])
def test_a_part_that_is_larger_than_the_frame(opening: Any, beyond: float | None) -> None:
    setup = {"fixture": {"clamp": {"opening": opening, "height": 3.0}, "margin": 1.0}}
    made = job(setup=setup)
    report = sc.verify(sc.post(sc.plan(made)), made)
    sentence = [finding["message"] for finding in report.findings if finding["kind"] == "clamp-opening"]
    assert bool(sentence) == (beyond is not None)
    # the walls' upper edge is a square of 40 mm; its corners are 28.284 mm from the middle
    assert not sentence or f"reach {beyond:.3f} mm into the margin of 1 mm" in sentence[0]


def test_how_thin_the_sheet_becomes_and_where() -> None:
    summary, notes = sc.plan(job()).summary()
    fact = next(fact for fact in summary.to_dict()["operations"][0]["facts"] if fact["fact"] == "thinnest")
    assert fact["value"] == pytest.approx(np.cos(WALL), abs=1e-9)
    position = [float(number) for number in re.findall(r"[XYZ](-?[\d.]+)", fact["words"])]
    assert max(abs(position[0]), abs(position[1])) - 20.0 == pytest.approx(position[2], abs=1e-3)
    assert not any("thin" in note for note in notes)


def expected_force(strength: float, step: float) -> float:
    """By the formula, at the slope of 45 degrees: below 49.3 degrees the steepest wall takes most."""
    diameter, across = 6.0, step / np.sin(WALL)
    scallop = 0.5 * (diameter - np.sqrt(diameter**2 - across**2))
    return float(0.0716 * strength * diameter**0.41 * scallop**0.09 * 45.0 * np.cos(WALL))


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_the_axial_force_by_the_formula(step: float, tmp_path: Path) -> None:
    assert "axial_force" not in facts(job())
    keys = {"sheet": {"tensile_strength": 200.0}, "operation": {"step": {"height": step}}}
    force = facts(job(**keys))["axial_force"]
    assert force == pytest.approx(expected_force(200.0, step), rel=1e-9)
    assert "axial-force" not in findings(job(**keys))
    machine = tmp_path / "shop.toml"
    for most, warned in ((force + 1.0, False), (force - 1.0, True)):
        machine.write_text(f'schema = 1\nextends = "linuxcnc"\nname = "shop"\n[limits]\nmax_axial_force = {most}\n')
        found = findings(job({"file": str(machine)}, **keys))
        assert ("axial-force" in found) == warned
        assert not warned or f"about {force:.0f} N" in found["axial-force"]


def test_a_spindle_that_turns_freely_is_posted_as_stopped_with_a_remark() -> None:
    made = job(operation={"spindle": {"mode": "free"}})
    text = sc.post(sc.plan(made)).text
    assert "M3" not in text
    assert "(the spindle must turn freely: release its brake)" in text
    assert sc.verify(text, made).ok
    turning = text.replace("M5\n", "S500 M3\n", 1)
    assert "spindle-differs" in {finding["kind"] for finding in sc.verify(turning, made).findings}


@pytest.mark.parametrize("kind", ["z-level", "spiral"])
def test_a_rolling_spindle_turns_as_fast_as_the_feed_along_the_wall(kind: str) -> None:
    rolling = {
        "kind": kind,
        "spindle": {"mode": "rolling"},
        "direction": "same",
        "feeds": {"cut": 1500.0, "plunge": 300.0},
    }
    made = job(operation=rolling)
    text = sc.post(sc.plan(made)).text
    # a ball of 3 mm touches a wall of 45 degrees 2.121 mm from its axis
    expected = 1500.0 / (2.0 * np.pi * 3.0 * np.sin(WALL))
    speed = re.search(r"S([\d.]+) M3|M3 S([\d.]+)", text)
    assert speed is not None
    assert float(speed[1] or speed[2]) == pytest.approx(expected, abs=0.5)
    assert not sc.verify(text, made).findings
    slower = text.replace(speed[0], speed[0].replace("S1", "S2", 1), 1)
    assert slower != text
    assert "spindle-differs" in {finding["kind"] for finding in sc.verify(slower, made).findings}


def test_the_path_has_the_wall_on_its_right() -> None:
    rolling = {"spindle": {"mode": "rolling"}, "direction": "same"}
    moves = sc.plan(job(operation=rolling)).programs["main"].moves
    loop = moves["end"][np.abs(moves["end"][:, 2] - moves["end"][:, 2].min()) < 1e-6][:, :2]
    x, y = loop[:-1].T
    area = 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    # counterclockwise inside walls: these are on the right, where a tool that turns clockwise moves backwards
    assert area > 0.0


@pytest.mark.parametrize(
    ("operation", "where"),
    [
        ({}, "operations[0].direction"),
        ({"direction": "conventional"}, "operations[0].direction"),
        ({"kind": "zig-zag", "stepover": 1.0, "step": None}, "operations[0].spindle.mode"),
        ({"direction": "same", "faces": "flat"}, "operations[0].spindle.mode"),
    ],
)
def test_where_a_spindle_cannot_roll(operation: dict[str, Any], where: str) -> None:
    document = operation | {"spindle": {"mode": "rolling"}}
    flat = document.get("faces") == "flat"
    vertices, triangles = tray()
    if flat:
        document.pop("faces")
        vertices = vertices * [1.0, 1.0, 0.0]
    with pytest.raises(sc.StylusError) as caught:
        base: dict[str, Any] = {"kind": "z-level", "tool": "stylus", "step": {"height": 0.5}} | document
        operation = {key: value for key, value in base.items() if value is not None}
        made = sc.Job.from_dict(
            {
                "schema": 1,
                "part": {"file": "tray.stl", "units": "mm", "model_face": "tool"},
                "setup": {"zero": "model", "sheet": {"thickness": 1.0}},
                "tools": {"stylus": {"profile": {"kind": "ball", "diameter": 6.0}}},
                "operations": [operation],
                "machine": {"name": "linuxcnc"},
            },
            part=sc.Part.from_mesh(vertices, triangles),
        )
        sc.plan(made)
    assert caught.value.where == where
