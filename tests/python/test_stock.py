"""The stock that a job states: what a pocket clears of it, and what the verifier finds where a text was made for other stock."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_pocket_operation import SIZE, TOP, block, kinds, text_of, whole_lines

import styluscam as sc

BOX: dict[str, Any] = {"kind": "box", "sides": 1.0, "top": 3.0}
CYLINDER: dict[str, Any] = {"kind": "cylinder", "sides": 0.5, "top": 3.0}
DEEP = TOP - 2.0
"""Below the block's top, in its pocket."""


SETUPS: list[dict[str, Any]] = [{"zero": "model"}, {"zero": "model", "stock": BOX}]


def job(stock: dict[str, Any] | None, machine: str = "linuxcnc", **keys: Any) -> sc.Job:
    """The stock over the block, and with another ``z_bottom`` its pocket, in layers of 2 mm."""
    operation = {"kind": "pocket", "tool": "mill", "step": {"height": 2.0}, "engagement_deg": 80.0, "fit": "arcs"}
    operation["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"} | ({"stock": stock} if stock else {}),
        "tools": {"mill": {"profile": {"kind": "flat", "diameter": 4.0}}},
        "operations": [operation | {"z_bottom": TOP} | keys],
        "machine": {"name": machine},
    }
    return sc.Job.from_dict(document, part=block())


@pytest.fixture(scope="module")
def texts() -> dict[str, list[str]]:
    """Texts by the stock that they are for, down to 2 mm into the pocket."""
    stocks = {"none": None, "box": BOX, "cylinder": CYLINDER}
    return {name: whole_lines(text_of(job(stock, z_bottom=DEEP))) for name, stock in stocks.items()}


@pytest.mark.parametrize(
    ("stock", "area"),
    [
        (BOX, (SIZE[0] + 2.0) * (SIZE[1] + 2.0)),
        (CYLINDER, np.pi * (0.5 * np.hypot(*SIZE[:2]) + 0.5) ** 2),
        ({"kind": "cylinder", "diameter": 40.0, "top": 3.0}, np.pi * 20.0**2),
    ],
)
def test_stock_above_the_part_is_cleared_as_wide_as_it_is(stock: dict[str, Any], area: float) -> None:
    (operation,) = sc.plan(job(stock)).summary()[0].operations
    facts = {fact.fact: fact.value for fact in operation.facts}
    assert facts["levels"] == 2
    assert facts["to_be_cleared"] == pytest.approx(2.0 * area, rel=1e-3)


@pytest.mark.parametrize(("name", "stock"), [("box", BOX), ("cylinder", CYLINDER)])
def test_a_pocket_from_stock_is_sound(texts: dict[str, list[str]], name: str, stock: dict[str, Any]) -> None:
    assert kinds(job(stock, z_bottom=DEEP), texts[name]) == set()


def test_clearance_counts_from_the_top_of_the_stock(texts: dict[str, list[str]]) -> None:
    ends = sc.read_gcode("\n".join([*texts["box"], ""]), "linuxcnc").moves["end"]
    assert ends[:, 2].max() == pytest.approx(TOP + 3.0 + 10.0)


def test_header_and_summary_state_the_stock(texts: dict[str, list[str]]) -> None:
    words = "a box, X-1 to 21, Y-1 to 17, Z0 to 9"
    assert f"(stock: {words})" in texts["box"] and sc.plan(job(BOX)).summary()[0].stock == words
    assert (
        not any(line.startswith("(stock") for line in texts["none"])
        and sc.plan(job(None, z_bottom=DEEP)).summary()[0].stock is None
    )


def test_a_text_for_lower_stock_misses_the_levels_above_and_goes_through_it(texts: dict[str, list[str]]) -> None:
    found = kinds(job(BOX, z_bottom=DEEP), texts["none"])
    assert {"missing-level", "rapid-into-stock", "steep-entry"} <= found


def test_a_text_for_narrower_stock_engages_too_much(texts: dict[str, list[str]]) -> None:
    assert "engagement" in kinds(job(BOX, z_bottom=DEEP), texts["cylinder"])


def test_a_level_that_is_left_out_above_the_part_is_found(texts: dict[str, list[str]]) -> None:
    lines = [line for line in texts["box"] if not (line.startswith(("G1", "G2", "G3")) and " Z7" in f"{line} ")]
    assert len(lines) < len(texts["box"]) - 100
    assert "missing-level" in kinds(job(BOX, z_bottom=DEEP), lines)


def test_a_rapid_through_the_stock_above_the_part_is_found(texts: dict[str, list[str]]) -> None:
    lines = texts["box"]
    first = next(number for number, line in enumerate(lines) if line.startswith("G1") and "Z7" in line)
    back = lines[first].split()[1:4]
    below = [*lines[: first + 1], "G0 X10 Y8", " ".join(["G0", *back]), *lines[first + 1 :]]
    assert {"low-rapid", "rapid-into-stock"} <= kinds(job(BOX, z_bottom=DEEP), below)


def test_low_links_keep_above_the_stock() -> None:
    keys = {"kind": "zig-zag", "stepover": 2.0, "faces": ["Face4"], "links": "low", "fit": "lines"}
    document = job(BOX).to_dict()
    operation = {"tool": "mill", "spindle": {"mode": "fixed", "rpm": 8000.0}} | keys
    asked = [sc.Job.from_dict(document | {"operations": [operation], "setup": setup}, part=block()) for setup in SETUPS]
    texts = [text_of(one) for one in asked]
    assert kinds(asked[1], texts[1].splitlines()) == kinds(asked[0], texts[0].splitlines()) == set()
    found = sc.verify(texts[0], asked[1]).to_dict()["findings"]
    assert any("stock may stand up to Z9.000" in finding["message"] for finding in found)


def test_the_simulation_begins_with_the_stock(texts: dict[str, list[str]]) -> None:
    asked = job(CYLINDER, z_bottom=DEEP)
    found = sc.simulate(sc.verify("\n".join([*texts["cylinder"], ""]), asked), spacing=0.1)
    x, y = np.meshgrid(found.x, found.y)
    away = np.hypot(x - 0.5 * SIZE[0], y - 0.5 * SIZE[1])
    radius = 0.5 * np.hypot(*SIZE) + 0.5
    assert np.ptp(found.x) == pytest.approx(2.0 * radius)
    assert (found.heights[away > radius + 1e-6] == 0.0).all()
    # what was above the block is gone, and around it nothing was cut below its top
    ring = found.heights[(away < radius - 1e-6) & ((x < 0) | (x > SIZE[0]) | (y < 0) | (y > SIZE[1]))]
    assert ring.min() >= TOP - 0.005 and ring.max() <= TOP + 0.005


@pytest.mark.parametrize(
    ("stock", "where", "code"),
    [
        ({"kind": "box", "low": [1, 0, 0], "high": [20, 16, 8]}, "setup.stock", "conflict"),
        ({"kind": "box", "low": [0, 0, 0], "high": [20, 16, 5.9]}, "setup.stock", "conflict"),
        ({"kind": "cylinder", "diameter": 25.0}, "setup.stock", "conflict"),
        ({"kind": "box", "low": [0, 0, 0]}, "setup.stock.high", "missing"),
        ({"kind": "box", "low": [0, 0, 0], "high": [20, 16, 0]}, "setup.stock.low", "conflict"),
        ({"kind": "box", "low": [0, 0, 0], "high": [20, 16, 8], "top": 2.0}, "setup.stock.top", "conflict"),
        ({"kind": "box", "sides": -1.0}, "setup.stock.sides", "out-of-range"),
        ({"kind": "cylinder", "diameter": 0.0}, "setup.stock.diameter", "out-of-range"),
        ({"kind": "cylinder", "diameter": 40.0, "sides": 2.0}, "setup.stock.sides", "conflict"),
        ({"kind": "sphere"}, "setup.stock.kind", "unknown"),
    ],
)
def test_impossible_stock_is_refused(stock: dict[str, Any], where: str, code: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(stock))
    assert (refused.value.where, refused.value.code) == (where, code) and refused.value.hint


def test_stock_beside_a_sheet_is_refused() -> None:
    document = job(BOX).to_dict()
    document["setup"]["sheet"] = {"thickness": 1.0}
    document["part"]["model_face"] = "tool"
    document["process"] = {"kind": "spif"}
    with pytest.raises(sc.JobError) as refused:
        sc.Job.from_dict(document, part=block())
    assert refused.value.where == "setup.stock" and "sheet" in str(refused.value)
