"""The top of a stock is faced by a pocket over the part's top: level by level, down to its exact height."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from blocks import box

TOP, STOCK, TOLERANCE = 10.0, 3.0, 0.005
RAPID = 0


def job(over: float = STOCK, **keys: Any) -> sc.Job:
    operation = {"kind": "pocket", "tool": "mill", "step": {"height": 1.0}, "tolerance": TOLERANCE}
    operation["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"stock": {"kind": "box", "top": over, "sides": 2.0}},
        "process": {"kind": "milling"},
        "tools": {"mill": {"number": 1, "profile": {"kind": "flat", "diameter": 6.0}}},
        "machine": {"name": "linuxcnc"},
        "operations": [operation | keys],
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*box((-20.0, -15.0, 0.0), (20.0, 15.0, TOP))))


def test_the_top_of_a_stock_is_faced_level_by_level() -> None:
    asked = job()
    text = sc.post(sc.plan(asked), asked.machine()).text
    assert sc.verify(text, asked).ok
    moves = sc.read_gcode(text, asked.machine()).moves
    heights = sorted({round(float(z), 4) for z in moves["end"][moves["kind"] != RAPID, 2]})
    assert heights[1:3] == [TOP + 1.0, TOP + 2.0] and TOP <= heights[0] <= TOP + TOLERANCE
    # without the last level a millimetre stands
    raised = re.sub(rf"\bZ{heights[0]:g}\b", f"Z{heights[1]:g}", text)
    assert not sc.verify(raised, asked).ok


@pytest.mark.parametrize("over", [0.235, 0.245, 0.255, 0.262, 0.28])
def test_what_stands_little_over_what_stays_is_faced_or_no_layer(over: float) -> None:
    asked = job(over, axial_stock_to_leave=0.24, clears="stock")
    text = sc.post(sc.plan(asked), asked.machine()).text
    assert sc.verify(text, asked).ok
    moves = sc.read_gcode(text, asked.machine()).moves
    heights = moves["end"][moves["kind"] != RAPID, 2]
    is_faced = (np.abs(heights - TOP - 0.24) < 0.01).any()
    assert is_faced or over < 0.26
