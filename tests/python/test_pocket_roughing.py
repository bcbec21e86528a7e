"""Pockets that clear all stock, around the part too, and what the verifier finds where some of it is left."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_pocket_operation import block, kinds, whole_lines

import styluscam as sc
from blocks import FLOOR, SIZE, TOP, mesh

STEP = 2.5
SIDES = 3.0
"""By how much the stock is larger than the part, mm."""


def job(rest: dict[str, Any] | None = None, **keys: Any) -> sc.Job:
    """Roughing, and with `rest` a second operation by a smaller tool for what that leaves."""
    operation = {
        "id": "rough",
        "kind": "pocket",
        "tool": "mill",
        "clears": "stock",
        "step": {"height": STEP},
        "engagement_deg": 80.0,
        "radial_stock_to_leave": 0.3,
        "axial_stock_to_leave": 0.2,
        "fit": "arcs",
        "spindle": {"mode": "fixed", "rpm": 8000.0},
    }
    operations = [operation | keys]
    if rest is not None:
        operations.append(operation | {"id": "rest", "tool": "small", "rest_machining": True} | rest)
    diameters = {"mill": 4.0} | ({"small": 2.0} if rest is not None else {})
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model", "stock": {"kind": "box", "sides": SIDES, "top": 1.0}},
        "tools": {
            name: {"number": number, "profile": {"kind": "flat", "diameter": diameter}}
            for number, (name, diameter) in enumerate(diameters.items(), start=1)
        },
        "operations": operations,
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=block())


def lines_of(asked: sc.Job) -> list[str]:
    (text,) = sc.post(sc.plan(asked)).files.values()
    return whole_lines(text)


@pytest.fixture(scope="module")
def roughed() -> tuple[sc.Job, list[str]]:
    asked = job()
    return asked, lines_of(asked)


def around(lines: list[str]) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Which ends of moves lie beside the part, below its top."""
    ends = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc").moves["end"]
    inside = ((ends[:, :2] > 0.0) & (ends[:, :2] < SIZE[:2])).all(axis=1)
    return ~inside & (ends[:, 2] < TOP)


def test_all_stock_is_cleared_around_the_part_and_in_it(roughed: tuple[sc.Job, list[str]]) -> None:
    asked, lines = roughed
    assert kinds(asked, lines) == set()
    assert around(lines).any() and not around(lines_of(job(clears="faces"))).any()


def test_the_tool_comes_from_outside_of_the_stock(roughed: tuple[sc.Job, list[str]]) -> None:
    _, lines = roughed
    moves = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc").moves["end"]
    falls = np.flatnonzero(np.diff(moves[:, 2]) < -1e-6) + 1
    beside = [end for end in moves[falls] if not ((end[:2] > 0.0) & (end[:2] < SIZE[:2])).all() and end[2] < TOP]
    radius = 2.0
    free = [
        (end[:2] < -SIDES - radius + 1e-3) | (end[:2] > np.array(SIZE[:2]) + SIDES + radius - 1e-3) for end in beside
    ]
    assert beside and all(axes.any() for axes in free)


def test_stock_that_is_left_around_the_part_is_found() -> None:
    asked = job()
    assert "uncleared" in kinds(asked, lines_of(job(clears="faces")))


@pytest.mark.parametrize("keys", [{}, {"z_bottom": 0.0}])
def test_levels_go_down_to_the_foot_beside_the_part(keys: dict[str, float]) -> None:
    """Nothing is left there for finishing."""
    asked = job(**keys)
    lines = lines_of(asked)
    assert kinds(asked, lines) == set()
    ends = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc").moves["end"]
    assert abs(ends[:, 2].min()) < 0.01


def test_levels_go_down_to_the_height_that_is_stated() -> None:
    higher = job(z_bottom=1.0)
    lines = lines_of(higher)
    assert kinds(higher, lines) == set()
    assert kinds(job(z_bottom=0.0), lines) == {"missing-level"}


def test_a_level_over_a_floor_follows_the_tolerance(roughed: tuple[sc.Job, list[str]]) -> None:
    coarse = job(tolerance=0.05)
    lines = lines_of(coarse)
    assert kinds(coarse, lines) == set()
    ends = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc").moves["end"]
    over = ends[:, 2] - FLOOR - 0.2
    assert 0.02 < over[over > -1e-3].min() < 0.05
    # what the coarse text leaves is too much for a fine tolerance
    assert "missing-level" in kinds(roughed[0], lines)


def test_rest_roughing_owes_no_level_on_which_nothing_is_left() -> None:
    asked = job(rest={})
    lines = lines_of(asked)
    assert kinds(asked, lines) == set()
    # in the pocket's corners there is some on the levels over its floor, and none around the part below
    _, rest = sc.verify("\n".join([*lines, ""]), asked).engagement
    assert rest.layers[-1].floor > FLOOR
    above = job(rest={"z_bottom": 4.0})
    assert kinds(above, lines_of(above)) == set()
    assert "missing-level" in kinds(asked, lines_of(above))


def test_a_face_that_slopes_by_ten_micrometres_is_no_level_floor() -> None:
    asked = job()
    vertices, triangles, faces = mesh()
    is_top = np.isclose(vertices[:, 2], TOP)
    vertices[is_top, 2] += 5e-4 * vertices[is_top, 0]
    sloped = sc.Job.from_dict(asked.to_dict(), part=sc.Part.from_mesh(vertices, triangles, face_ids=faces))
    assert "missing-level" not in kinds(sloped, lines_of(sloped))
