"""The model against the job: a sheet of another thickness, with another face, a solid, a border that lies low."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc

NODES = 25


def between(upper: Any, lower: Any = None) -> sc.Part:
    """A square of 40 mm between two height fields (functions of x and y), with its rim; an open surface without a lower one."""
    at = np.linspace(-20.0, 20.0, NODES)
    x, y = (each.ravel() for each in np.meshgrid(at, at))
    layers = [np.column_stack([x, y, upper(x, y)])]
    number = np.arange(NODES * NODES).reshape(NODES, NODES)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    top = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    triangles = [top]
    if lower is not None:
        layers.append(np.column_stack([x, y, lower(x, y)]))
        triangles.append(top[:, ::-1] + NODES * NODES)
        ring = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
        low, on, high = ring + NODES * NODES, np.roll(ring, -1), np.roll(ring, -1) + NODES * NODES
        triangles += [np.stack([low, high, on], -1), np.stack([low, on, ring], -1)]
    return sc.Part.from_mesh(np.concatenate(layers), np.concatenate(triangles))


def cup(x: Any, y: Any) -> Any:
    """A wall of 27 degrees, 5 mm deep, with a flange."""
    return np.clip(0.5 * (np.hypot(x, y) - 16.0), -5.0, 0.0)


def bracket(x: Any, _: Any) -> Any:
    """A foot and a wall."""
    return np.where(x < -12.0, 20.0, 5.0)


def found(part: sc.Part, *, thickness: float = 1.0, face: str = "tool", faces: Any = "all", accept: Any = ()) -> Any:
    """Severity and sentence of what the verifier has against the model, by kind."""
    job = sc.Job.from_dict(
        {
            "schema": 1,
            "accept": list(accept),
            "part": {"file": "made.stl", "units": "mm", "model_face": face, "faces": faces},
            "setup": {"sheet": {"thickness": thickness}},
            "tools": {"stylus": {"profile": {"kind": "ball", "diameter": 6.0}}},
            "operations": [{"kind": "zig-zag", "tool": "stylus", "stepover": 4.0}],
            "machine": {"name": "linuxcnc"},
        },
        part=part,
    )
    report = sc.verify(sc.post(sc.plan(job)), job)
    kinds = ("sheet-thickness", "sheet-face", "solid-formed", "flange-height")
    return {f["kind"]: (f["severity"], f["message"]) for f in report.findings if f["kind"] in kinds}


def sheet(upper: Any, thickness: float) -> sc.Part:
    return between(upper, lambda x, y: upper(x, y) - thickness)


def test_a_sheet_that_agrees_is_not_spoken_of() -> None:
    assert found(sheet(cup, 1.0)) == {}
    assert found(between(cup)) == {} == found(between(cup), face="back", thickness=2.0)


def test_a_sheet_of_another_thickness() -> None:
    reported = found(sheet(cup, 1.0), thickness=3.0)
    assert list(reported) == ["sheet-thickness"]
    severity, words = reported["sheet-thickness"]
    assert severity == "error" and "3 mm" in words and "thickness = 1.0" in words and 'accept = ["thickness"]' in words
    assert found(sheet(cup, 1.0), thickness=3.0, accept=["thickness"])["sheet-thickness"][0] == "warning"


@pytest.mark.parametrize("face", ["back", "mid"])
def test_a_sheet_with_both_faces_shows_the_tool_its_upper_one(face: str) -> None:
    reported = found(sheet(cup, 1.0), face=face)
    assert list(reported) == ["sheet-face"]
    severity, words = reported["sheet-face"]
    assert severity == "error" and 'model_face = "tool"' in words
    assert found(sheet(cup, 1.0), face=face, accept=["model-face"])["sheet-face"][0] == "warning"


def test_a_solid_is_no_sheet() -> None:
    solid = between(bracket, lambda x, _: 0.0 * x)
    reported = found(solid)
    assert list(reported) == ["solid-formed"]
    severity, words = reported["solid-formed"]
    assert severity == "error" and "5.0" in words and 'process.kind = "milling"' in words
    assert found(solid, accept=["solid"])["solid-formed"][0] == "warning"
    # a block that the cup's surface is cut into shows a face of the sheet
    assert found(between(cup, lambda x, _: 0.0 * x - 20.0)) == {}


@pytest.mark.parametrize("part", [sheet(lambda x, y: -cup(x, y), 1.0), between(lambda x, y: -cup(x, y))])
def test_a_border_below_what_is_formed_cannot_be_clamped(part: sc.Part) -> None:
    reported = found(part)
    assert list(reported) == ["flange-height"]
    severity, words = reported["flange-height"]
    assert severity == "error" and "5.0" in words and "setup.up" in words
    assert found(part, accept=["flange"])["flange-height"][0] == "warning"


def test_what_rises_and_falls_from_its_border_is_not_to_be_turned_over() -> None:
    both = between(lambda x, y: -np.sign(x) * cup(2.0 * (np.abs(x) - 10.0), 2.0 * y))
    words = found(both)["flange-height"][1]
    assert "male" in words and "setup.up" not in words
