"""Flank milling as an operation of a job: planned, posted for two rotary axes, read back and verified."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.flank.rails import Rail
from styluscam.parts.ruled import ruled_faces

BLADE = Path(__file__).resolve().parents[2] / "fixtures" / "blade.step"
MAX_ERROR = 0.02
HOLLOW = [{"poles": [[-6.0, 0.0, z], [0.0, 12.0, z], [6.0, 0.0, z]]} for z in (0.0, 20.0)]
"""Rails with a radius of 3 mm in their middle, smaller than the tool's."""


def job(faces: Any = ("Face1", "Face2"), tool: dict[str, Any] | None = None, **keys: Any) -> sc.Job:
    machine = keys.pop("machine", "linuxcnc-trunnion")
    part: dict[str, Any] = {"file": str(keys.pop("part", BLADE)), "faces": list(faces) if faces != "all" else "all"}
    if "units" in keys:
        part["units"] = keys.pop("units")
    spindle = {"mode": "fixed", "rpm": 8000.0}
    operation = {"kind": "flank", "tool": "mill", "feeds": {"cut": 800.0, "plunge": 300.0}, "spindle": spindle, **keys}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": part,
            "process": {"kind": "milling"},
            "tools": {"mill": {"profile": {"kind": "flat", "diameter": 8.0}, "length": 60.0, **(tool or {})}},
            "operations": [operation],
            "machine": {"name": machine},
        }
    )


def text_of(asked: sc.Job) -> str:
    (text,) = sc.post(sc.plan(asked)).files.values()
    return text


def kinds(report: sc.Report) -> set[str]:
    return {finding["kind"] for finding in report.to_dict()["findings"] if finding["severity"] == "error"}


def surfaces(report: sc.Report) -> dict[str, tuple[float, float, float]]:
    (flank,) = report.to_dict()["flanks"]
    return {face["name"]: (face["over"], face["under"], face["missed"]) for face in flank["faces"]}


@pytest.fixture(scope="module")
def sound() -> tuple[sc.Job, str]:
    asked = job()
    return asked, text_of(asked)


def test_both_sides_of_a_blade_are_milled_within_the_error(sound: tuple[sc.Job, str]) -> None:
    asked, text = sound
    report = sc.verify(text, asked)
    assert report.ok and not report.to_dict()["findings"], report.to_dict()["findings"]
    found = surfaces(report)
    assert sorted(found) == ["Face1", "Face2"]
    for over, under, missed in found.values():
        assert max(over, under) < MAX_ERROR and missed == 0.0
    program = sc.read_gcode(text, "linuxcnc-trunnion")
    # the tool leans, goes over both sides, and rapids stay high
    assert np.degrees(np.arccos(program.moves["axis"][:, 2])).max() > 5.0
    end = program.moves["end"]
    assert end[:, 1].min() < -3.0 and end[:, 1].max() > 3.0
    assert end[program.moves["kind"] == 0, 2].max() > 30.0


def test_the_same_by_edges_and_by_curves() -> None:
    part = job().part()
    assert part.arrays is not None
    shares = np.linspace(0.0, 1.0, 9)
    rails_of_face = ruled_faces(part.arrays)[1]

    def is_along(edge: Rail | None, rail: Rail) -> bool:
        return edge is not None and any(np.allclose(edge.at(shares)[::step], rail.at(shares)) for step in (1, -1))

    # the upper one first, and as the file has them: in their order and direction they need not be
    numbers = [
        f"Edge{next(number for number, edge in enumerate(part.arrays.edges, 1) if is_along(edge, rail))}"
        for rail in sorted(rails_of_face, key=lambda rail: -rail.poles[0, 2])
    ]
    curves = [{"poles": part.arrays.edges[int(number[4:]) - 1].poles.tolist()} for number in numbers]  # type: ignore[union-attr]
    found = {
        side: kinds(sc.verify(text_of(job(("Face1",), rails={"edges": numbers}, side=side)), job(("Face1",))))
        for side in ("left", "right")
    }
    # on one side it is the face that is milled, on the other one the inside of the blade
    (outside,) = (side for side, kinds_of in found.items() if not kinds_of)
    assert "gouge" in found["left" if outside == "right" else "right"]
    by_edges, by_curves = (
        text_of(job(("Face1",), rails=rails, side=outside)) for rails in ({"edges": numbers}, {"curves": curves})
    )
    moves = [[line for line in text.splitlines() if not line.startswith("(")] for text in (by_edges, by_curves)]
    assert moves[0] == moves[1] and len(moves[0]) > 100
    asked = job(("Face1",), rails={"curves": curves}, side=outside)
    report = sc.verify(by_curves, asked)
    assert report.ok, report.to_dict()["findings"]


@pytest.mark.parametrize("machine", ["linuxcnc-trunnion", "fanuc-five-axis"])
def test_upright_walls_are_milled_as_well(machine: str, tmp_path: Path) -> None:
    corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]
    vertices = np.array([(x, y, z) for z in (0.0, 20.0) for x, y in corners])
    walls = [[(i, j, j + 4), (i, j + 4, i + 4)] for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))]
    triangles = np.array([(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), *(t for wall in walls for t in wall)])
    part = tmp_path / "block.stl"
    with part.open("w", encoding="ascii") as file:
        file.write("solid block\n")
        for triangle in triangles:
            points = "".join(f"vertex {x} {y} {z}\n" for x, y, z in vertices[triangle])
            file.write(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n")
        file.write("endsolid block\n")
    rails = {"curves": [{"poles": [[0.0, 0.0, z], [40.0, 0.0, z]]} for z in (0.0, 20.0)]}
    asked = job("all", part=part, rails=rails, side="right", machine=machine, units="mm")
    report = sc.verify(text_of(asked), asked)
    assert report.ok, report.to_dict()["findings"]
    ((over, under, missed),) = surfaces(report).values()
    assert max(over, under) < 0.001 and missed == 0.0
    program = sc.read_gcode(text_of(asked), machine)
    assert np.allclose(program.moves["axis"], [0.0, 0.0, 1.0], atol=1e-6)


def test_a_selection_by_rule_takes_the_ruled_faces() -> None:
    (operation,) = sc.plan(job("all")).summary()[0].operations
    assert {fact.fact: fact.value for fact in operation.facts}["surfaces"] == 2


def test_a_machine_with_three_axes_is_refused_before_anything_is_planned() -> None:
    with pytest.raises(sc.JobError, match="linuxcnc has three axes") as caught:
        sc.plan(job(machine="linuxcnc"))
    assert caught.value.code == "no-rotary-axes" and "rotary" in caught.value.hint


def test_a_short_cutter_mills_in_several_depths() -> None:
    short = job(tool={"length": 17.0})
    (operation,) = sc.plan(short).summary()[0].operations
    assert {fact.fact: fact.value for fact in operation.facts}["passes"] == 4
    report = sc.verify(text_of(short), short)
    assert report.ok, report.to_dict()["findings"]
    assert all(missed == 0.0 for _, _, missed in surfaces(report).values())
    three = sc.plan(job(pass_depth=11.0)).summary()[0].operations[0]
    assert {fact.fact: fact.value for fact in three.facts}["passes"] == 6
    cone = {"profile": {"kind": "tapered-ball", "tip_radius": 3.0, "half_angle_deg": 3.0, "diameter": 8.0}}
    with pytest.raises(sc.JobError) as caught:
        sc.plan(job(tool={**cone, "length": 80.0}))
    assert caught.value.code == "short-flank"


def test_stock_is_left_and_found_left() -> None:
    left = job(stock_to_leave=0.3)
    text = text_of(left)
    assert sc.verify(text, left).ok
    assert kinds(sc.verify(text, job())) == {"excess"}


def test_a_ball_end_and_a_cone_mill_as_well() -> None:
    for profile in (
        {"kind": "ball", "diameter": 8.0},
        {"kind": "tapered-ball", "tip_radius": 3.0, "half_angle_deg": 2.0, "diameter": 10.0},
    ):
        asked = job(("Face1",), tool={"profile": profile, "length": 90.0}, max_error=0.03)
        report = sc.verify(text_of(asked), asked)
        assert report.ok, report.to_dict()["findings"]


def test_climb_goes_the_other_way_than_conventional() -> None:
    climb, conventional = (
        sc.plan(job(("Face1",), direction=direction)).programs["main"].moves for direction in ("climb", "conventional")
    )
    cut = [
        moves["end"][moves["role"] == 1] if (moves["role"] == 1).any() else moves["end"]
        for moves in (climb, conventional)
    ]
    along = [points[-1] - points[0] for points in cut]
    assert along[0] @ along[1] < 0.0
    # the part is on the right of a tool that climbs, seen from above: this side of the blade looks to +Y
    assert along[0][0] > 0.0


def test_what_is_wrong_in_the_text_is_found(sound: tuple[sc.Job, str]) -> None:
    asked, text = sound
    lines = text.splitlines()
    cuts = [i for i, line in enumerate(lines) if line.startswith(("G1", "X", "Y", "Z", "A", "C")) and " F" in line]
    middle = cuts[len(cuts) // 4]

    def found(letter: str, by: float) -> set[str]:
        at = next(i for i in range(middle, len(lines)) if re.search(rf"\b{letter}-?[\d.]+", lines[i]))
        value = re.search(rf"\b{letter}(-?[\d.]+)", lines[at])
        assert value is not None
        changed = [*lines]
        changed[at] = re.sub(rf"\b{letter}-?[\d.]+", f"{letter}{float(value[1]) + by:.5f}", lines[at])
        return kinds(sc.verify("\n".join([*changed, ""]), asked))

    # across the surface one of two directions enters it
    assert any("gouge" in found(letter, by) for letter in "XY" for by in (0.2, -0.2))
    assert any("gouge" in found("A", by) for by in (1.0, -1.0))
    # without half of a pass a part of a surface is not milled
    half = [*lines[:middle], *lines[middle + len(cuts) // 4 :]]
    assert kinds(sc.verify("\n".join([*half, ""]), asked)) & {"excess", "missing-pass", "gouge"}


@pytest.mark.parametrize(
    ("keys", "code"),
    [
        ({"faces": ("Face3",)}, "not-ruled"),
        ({"rails": {"edges": ["Edge1", "Edge99"]}, "side": "left"}, "unknown"),
        ({"rails": {"edges": ["Edge1", "Kante"]}, "side": "left"}, "unknown"),
        ({"rails": {"edges": ["Edge1", "Edge2"]}}, "missing"),
        ({"side": "left"}, "conflict"),
        ({"z_top": 20.0}, "conflict"),
        ({"boundary": {"slope_deg": [10.0, 20.0]}}, "conflict"),
        (
            {
                "rails": {"curves": [{"poles": [[0, 0, 0], [10, 0, 0]]}, {"poles": [[0, 0, 0], [10, 0, 9]]}]},
                "side": "left",
            },
            "rails-meet",
        ),
        (
            {
                "rails": {
                    "curves": [{"poles": [[0, 0, 0], [10, 0, 0]], "weights": [1.0]}, {"poles": [[0, 0, 9], [10, 0, 9]]}]
                },
                "side": "left",
            },
            "conflict",
        ),
        (
            {
                "rails": {
                    "curves": [{"poles": [[0, 0, 0], [10, 0, 0]], "degree": 3}, {"poles": [[0, 0, 9], [10, 0, 9]]}]
                },
                "side": "left",
            },
            "length",
        ),
        ({"tool": {"profile": {"kind": "parabola", "apex_radius": 2.0, "diameter": 8.0}}}, "out-of-range"),
        ({"rails": {"curves": HOLLOW}, "side": "right"}, "tool-too-large"),
    ],
)
def test_what_cannot_be_milled_is_refused_by_name(keys: dict[str, Any], code: str) -> None:
    faces = keys.pop("faces", ("Face1",))
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(faces, **keys))
    assert caught.value.code == code, (caught.value.code, str(caught.value))


def test_a_lying_tool_is_refused() -> None:
    curves = [{"poles": [[0, 0, 0], [40, 0, 0]]}, {"poles": [[0, 30, 1.0], [40, 30, 1.0]]}]
    with pytest.raises(sc.JobError, match="lean") as caught:
        sc.plan(job(("Face1",), rails={"curves": curves}, side="left"))
    assert caught.value.code == "lean"
