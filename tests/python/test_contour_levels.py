"""Contours level by level: in which order edges are milled, how the tool comes into the stock, and what is found of it."""

from __future__ import annotations

import numpy as np
import pytest
from test_contour import BOSS_TOP, FRONT, OFF, OUTLINE, POCKET, RIM, STOCK, TABS, job, kinds, text_of

import styluscam as sc


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


@pytest.mark.parametrize("direction", ["climb", "conventional", "alternate"])
def test_every_edge_is_milled_from_the_top_down_and_finished_last(direction: str) -> None:
    keys = {"radial_stock_to_leave": 0.3, "finish": True, "direction": direction, "setup": STOCK}
    asked = job([FRONT, RIM[0]], "right", **keys)
    text = text_of(asked)
    assert kinds(text, asked) <= {"unreached"}
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    passes = ends[1:][(np.abs(np.diff(ends[:, 2])) < 1e-6) & (ends[1:, 2] < BOSS_TOP)]
    for side, axis in ((passes[passes[:, 1] < 0.0], -3.0), (passes[passes[:, 1] > 0.0], POCKET[0][1] + 3.0)):
        assert len(side) > 4 and (np.diff(side[:, 2]) <= 1e-6).all()
        assert np.abs(side[[0, -1], 1] - axis) == pytest.approx([0.3, 0.0], abs=OFF)


def entering(text: str, *moves: str) -> str:
    """The text with feeds before its first descent into the stock."""
    return text.replace(
        "\nG1 Z18.2 F200\n", "\n" + "\n".join([*moves, "G0 Z32", "X40 Y-3.002", "G1 Z18.2 F200", ""]), 1
    )


@pytest.mark.parametrize(
    "moves",
    [
        # from the air, the last 3.75 mm of 30 through 2 mm of stock
        ["G1 X10 Y-3.002 Z16 F200"],
        # through the stock from beside it to beside it
        ["G0 X-30 Y-3.002", "G1 Z18.2 F200", "X110 Z0 F600"],
        # called a lead
        ["(role lead)", "G1 X10 Y-3.002 Z16 F200", "(role none)"],
    ],
)
def test_a_steep_way_through_the_stock_is_found(moves: list[str]) -> None:
    asked = job(OUTLINE, "outside", setup=STOCK)
    text = text_of(asked)
    spoilt = entering(text, *moves)
    assert spoilt != text and "steep-entry" in kinds(spoilt, asked)


def before_the_rest(text: str, moves: str) -> str:
    """The text with moves at the beginning of its operation."""
    return text.replace("(operation contour-1: contour)\n", f"(operation contour-1: contour)\n{moves}", 1)


def moves_of(text: str) -> str:
    """The moves of its operation."""
    return text.split("(operation contour-1: contour)\n", 1)[1].split("M5\n", 1)[0]


@pytest.mark.parametrize("fit", ["lines", "arcs"])
@pytest.mark.parametrize(("edges", "side"), [(OUTLINE, "outside"), (RIM, "inside"), ([FRONT], "right")])
def test_what_cuts_deeper_than_a_level_at_once_is_found(edges: list[str], side: str, fit: str) -> None:
    asked = job(edges, side, fit=fit, setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) <= {"unreached"}
    # what comes last, first: each with a ramp from the air above the stock
    last = moves_of(text_of(job(edges, side, fit=fit, setup=STOCK, step={"height": 30.0})))
    assert "stock-above" in kinds(before_the_rest(text, last), asked)


@pytest.mark.parametrize(
    "cut", [["X-30 Y-7", "G1 Z0 F200", "X110 F600"], ["X0 Y-6", "G1 Z18 F200", "X80 Z14 F600", "X0 Z10"]]
)
def test_what_cuts_the_stock_elsewhere_deeper_than_a_level_is_found(cut: list[str]) -> None:
    asked = job(OUTLINE, "outside", setup=STOCK)
    spoilt = before_the_rest(text_of(asked), "\n".join(["G0 Z48", *cut, "G0 Z48", ""]))
    assert "stock-above" in kinds(spoilt, asked)


def test_a_finish_pass_before_its_levels_is_found() -> None:
    keys = {"radial_stock_to_leave": 0.3, "setup": STOCK}
    asked = job(OUTLINE, "outside", finish=True, **keys)
    text = text_of(asked)
    levels = moves_of(text_of(job(OUTLINE, "outside", **keys)))
    finish = moves_of(text_of(job(OUTLINE, "outside", setup=STOCK, step={"height": 30.0})))
    head, tail = text.split(moves_of(text), 1)
    assert "stock-above" not in kinds(head + levels + finish + tail, asked)
    assert "stock-above" in kinds(head + finish + levels + tail, asked)


def test_ramps_beside_tabs_alone_are_as_steep_as_those_of_tabs() -> None:
    asked = job(OUTLINE, "outside", tabs=TABS, setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) == set()
    assert "steep-entry" in kinds(entering(text, "G1 Z18.2 F200", "X30 Y-3.002 Z16 F600"), asked)


def test_what_is_nearer_to_an_edge_below_all_levels_is_found() -> None:
    # over the part, into which it does not go
    asked = job([FRONT], "right", z_top=14.0, z_bottom=13.0)
    text = text_of(asked)
    spoilt = text.replace("\nM5\n", "\nG0 X40 Y-1\nZ14\nG1 Z12.5 F200\nG0 Z48\nM5\n", 1)
    assert kinds(text, asked) == set() and "gouge" in kinds(spoilt, asked)


def test_ramps_leave_the_stock_that_is_to_stay() -> None:
    asked = job(OUTLINE, "outside", setup=STOCK, radial_stock_to_leave=0.3)
    text = text_of(asked)
    spoilt = text.replace("\nX0 Z", "\nX0 Y-3.2 Z", 1)
    assert spoilt != text and kinds(text, asked) == set() and "stock-to-leave" in kinds(spoilt, asked)
