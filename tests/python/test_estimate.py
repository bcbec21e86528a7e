"""The seconds that are estimated for a plan, against those that it takes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import job_document, milling_document

import styluscam as sc
from styluscam.advice.estimate import LONG, estimate, too_long

BALL = {"kind": "ball", "diameter": 6.0}


@pytest.mark.parametrize("kind", ("zig-zag", "z-level"))
@pytest.mark.parametrize("part", ("cap_r60", "cone_cup"))
def test_length_and_moves_are_right_within_a_factor(part: str, kind: str, part_of: Callable[[str], sc.Part]) -> None:
    job = sc.Job.from_dict(job_document(part, kind, BALL), part=part_of(part))
    (found,) = estimate(job)
    program = sc.plan(job).programs["main"]
    assert found.kind == kind
    assert 0.4 < found.length / program.length < 2.5
    assert 0.2 < found.points / len(program.moves) < 5.0
    assert found.seconds < LONG
    assert too_long(job) == []


def test_what_takes_long_is_stated_with_what_shortens_it(tmp_path: Path) -> None:
    # a wavy square metre in steps of a hundredth
    count = 60
    x, y = np.meshgrid(np.arange(count), np.arange(count))
    corners = np.column_stack([20.0 * x.ravel(), 20.0 * y.ravel(), (x * y % 7).ravel()])
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    facets = np.zeros(2 * len(a), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    facets["corners"] = corners[np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])]
    file = tmp_path / "wavy.stl"
    file.write_bytes(bytes(80) + np.uint32(len(facets)).tobytes() + facets.tobytes())
    part = sc.Part.read(file, units="mm")
    job = sc.Job.from_dict(milling_document("zig-zag", BALL, stepover=0.01), part=part)
    (sentence,) = too_long(job)
    assert "zig-zag-1: about" in sentence
    assert "A stepover of 0.02 mm (now 0.01 mm) halves that" in sentence
