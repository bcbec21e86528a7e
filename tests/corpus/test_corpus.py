"""The committed parts of the corpus, each through `new` and `run` in processes of their own."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import pytest
from outcomes import run_part, turn_up

from long_cases import some_long

HERE = Path(__file__).resolve().parent
SLICE = HERE.parents[1] / "fixtures" / "corpus" / "slice"
PARTS = {part["name"]: part for part in json.loads((SLICE / "parts.json").read_text(encoding="utf-8"))}
OPTIONS = argparse.Namespace(limit=60.0, patience=3.0, keep=None, variant=[], base=True, all=False)


LONG = {
    "blend-02",
    "channel-01",
    "cup-02",
    "fins-00",
    "gearbox-00.as-made.ply-binary-mm",
    "hinge-02",
    "pins-03",
    "spline-05",
    "step-02",
    "terrain-00",
}
"""Parts whose roughing takes the better part of a minute to plan and to verify."""


@pytest.mark.parametrize("name", some_long(PARTS, LONG))
def test_a_part_becomes_a_program_or_one_true_sentence(name, tmp_path):
    (row,) = run_part(PARTS[name], SLICE, tmp_path, OPTIONS)
    assert row.wrong == "", f"{row.outcome}: {row.detail} {row.kinds}"
    assert row.peak_mb < 1000


@pytest.mark.parametrize("up", ["+x", "-x", "+y", "-y", "+z", "-z"])
def test_a_setup_turns_its_axis_up(up):
    axis = np.zeros(3)
    axis["xyz".index(up[1])] = 1.0 if up[0] == "+" else -1.0
    turn = turn_up(up, 30.0)
    assert np.allclose(turn @ axis, [0.0, 0.0, 1.0]) and np.isclose(np.linalg.det(turn), 1.0)


@pytest.mark.parametrize(
    ("up", "x_becomes"),
    [
        ("+z", [0.0, 1.0, 0.0]),
        ("-z", [0.0, 1.0, 0.0]),
        ("+y", [0.0, 1.0, 0.0]),
        ("-x", [0.0, 0.0, -1.0]),
    ],
)
def test_a_setup_turns_the_part_about_z_then(up, x_becomes):
    assert np.allclose(turn_up(up, 90.0) @ [1.0, 0.0, 0.0], x_becomes)
