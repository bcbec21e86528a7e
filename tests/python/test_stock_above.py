"""Stock that stands where a tool comes: found, unless what ran before has taken it."""

from __future__ import annotations

from typing import Any

import pytest

import styluscam as sc
from blocks import box

TOP, OVER, SIDES = 10.0, 4.0, 3.0
BEGINS = 8.0
"""Of operations that begin below the stock's top, and below the part's."""


def job(*operations: dict[str, Any], stated: bool = True, stock: dict[str, Any] | None = None) -> sc.Job:
    common = {"tool": "mill", "feeds": {"cut": 600.0, "plunge": 200.0}, "spindle": {"mode": "fixed", "rpm": 8000.0}}
    stock = stock or {"kind": "box", "top": OVER, "sides": SIDES}
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "setup": {"zero": "model"} | ({"stock": stock} if stated else {}),
        "process": {"kind": "milling"},
        "tools": {
            "mill": {"number": 1, "profile": {"kind": "flat", "diameter": 6.0}},
            "ball": {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}},
            "held": {
                "number": 3,
                "profile": {"kind": "flat", "diameter": 6.0},
                "length": 12.0,
                "holder": {"diameter": 30.0, "length": 40.0},
            },
        },
        "machine": {"name": "linuxcnc"},
        "operations": [common | {"id": f"of{number}"} | operation for number, operation in enumerate(operations)],
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*box((-20.0, -15.0, 0.0), (20.0, 15.0, TOP))))


def contour(**keys: Any) -> dict[str, Any]:
    return {"kind": "contour", "edge_side": "outside", "step": {"height": 3.0}, "faces": "all", **keys}


def pocket(**keys: Any) -> dict[str, Any]:
    return {
        "kind": "pocket",
        "clears": "stock",
        "step": {"height": 3.0},
        "engagement_deg": 90.0,
        "faces": "all",
        **keys,
    }


def kinds(asked: sc.Job) -> set[str]:
    text = sc.post(sc.plan(asked), "linuxcnc").text
    return {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]}


@pytest.mark.parametrize("operation", [contour, pocket])
def test_an_operation_that_begins_below_the_stock_is_found(operation: Any) -> None:
    assert "stock-above" in kinds(job(operation(z_top=BEGINS)))
    assert "stock-above" not in kinds(job(operation()))
    # the air that ramps begin with
    assert "stock-above" not in kinds(job(operation(z_top=TOP + OVER - 0.19)))
    assert "stock-above" in kinds(job(operation(z_top=TOP + OVER - 0.21)))


@pytest.mark.parametrize("around", [{"diameter": 60.0}, {"sides": 5.0}])
def test_in_a_cylinder_it_is_found_where_there_is_stock(around: dict[str, float]) -> None:
    stock = {"kind": "cylinder", "top": OVER} | around
    assert "stock-above" in kinds(job(contour(z_top=BEGINS), stock=stock))
    assert "stock-above" not in kinds(job(contour(), stock=stock))


@pytest.mark.parametrize("operation", [contour, pocket])
def test_it_is_sound_after_what_takes_the_stock_above(operation: Any) -> None:
    down = pocket(z_bottom=BEGINS)
    rest = {"rest_machining": True} if operation is pocket else {}
    assert kinds(job(down, operation(z_top=BEGINS, **rest))) == set()
    # one that ends higher does not help, and one that comes after
    high = pocket(z_bottom=BEGINS + 1.0)
    assert "stock-above" in kinds(job(high, contour(z_top=BEGINS)))
    assert "stock-above" in kinds(job(contour(z_top=BEGINS), down))
    # nor one that went elsewhere
    narrow = {"kind": "box", "top": OVER, "sides": SIDES + 12.0}
    assert "stock-above" in kinds(job(contour(z_bottom=BEGINS), pocket(z_top=BEGINS), stock=narrow))


def test_what_a_ball_leaves_between_its_rows_is_stock() -> None:
    rows = {"kind": "zig-zag", "tool": "ball", "faces": "all", "stepover": 5.9}
    assert "stock-above" in kinds(job(rows, contour(z_top=TOP)))


def test_without_a_stated_stock_nothing_is_known_of_it() -> None:
    assert "stock-above" not in kinds(job(contour(z_top=BEGINS), stated=False))


@pytest.mark.parametrize(("left", "found"), [(0.4, set()), (0.7, {"stock-above"})])
def test_a_skin_on_the_wall_above_is_no_stock(left: float, found: set[str]) -> None:
    down = pocket(radial_stock_to_leave=left)
    assert kinds(job(down, contour(z_top=BEGINS, step={"height": 20.0}))) == found


ROWS = {"kind": "zig-zag", "faces": "all", "stepover": 2.0}


@pytest.mark.parametrize(("over", "found"), [(5.9, set()), (6.1, {"stock-above"})])
def test_rows_that_cut_deeper_than_the_tool_is_wide_are_warned_of(over: float, found: set[str]) -> None:
    stock = {"kind": "box", "top": over, "sides": SIDES}
    assert kinds(job(ROWS, stock=stock)) == found
    assert kinds(job(pocket(), ROWS, stock=stock)) == set()
    assert kinds(job(ROWS, stated=False)) == set()


def test_a_wall_that_was_roughed_may_be_finished_at_its_full_height() -> None:
    stock = {"kind": "box", "top": 0.0, "sides": 8.0}
    levels = {"kind": "z-level", "faces": "all", "step": {"height": 10.0}}
    left = pocket(radial_stock_to_leave=0.5)
    assert kinds(job(left, levels, stock=stock)) == set()
    assert "stock-above" in kinds(job(levels, stock=stock))


def test_a_holder_in_stock_beside_the_part_is_found() -> None:
    """The tool sticks out by 12 mm, and goes 14 mm under the stock's top."""
    around = contour(tool="held")
    assert "holder-collision" in kinds(job(around, stock={"kind": "box", "top": OVER, "sides": 20.0}))
    # what a longer one has taken before, or an earlier pass of its own
    assert "holder-collision" not in kinds(job(pocket(), around, stock={"kind": "box", "top": OVER, "sides": 20.0}))
    assert "holder-collision" not in kinds(job(around, stock={"kind": "box", "top": 1.9, "sides": 20.0}))
