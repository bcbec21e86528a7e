"""Pockets that begin in a drilled hole: down without a helix, and only where the hole is."""

from __future__ import annotations

from typing import Any

import pytest
from test_pocket_operation import block, job, text_of

import styluscam as sc

HOLE = {"x": 10.0, "y": 8.0, "diameter": 5.0, "in_stock": True}
LEVEL: dict[str, Any] = {"z_bottom": 4.0}


def kinds(text: str, asked: sc.Job) -> set[str]:
    found = sc.verify(text, asked).to_dict()["findings"]
    # the floor is deeper than the one level
    return {finding["kind"] for finding in found} - {"missing-level"}


@pytest.fixture(scope="module")
def text() -> str:
    return text_of(job(**LEVEL, entry_hole=HOLE))


def test_the_tool_goes_down_in_the_hole_without_a_helix(text: str) -> None:
    assert "(role ramp)" not in text and "(role ramp)" in text_of(job(**LEVEL))
    assert kinds(text, job(**LEVEL, entry_hole=HOLE)) == set()


@pytest.mark.parametrize("hole", [None, HOLE | {"x": 8.0}, HOLE | {"diameter": 4.2}])
def test_a_hole_that_is_missing_elsewhere_or_smaller_is_found(text: str, hole: dict[str, float] | None) -> None:
    keys = LEVEL if hole is None else LEVEL | {"entry_hole": hole}
    assert kinds(text, job(**keys)) & {"steep-entry", "engagement"}


def test_a_hole_that_nothing_has_made_is_found(text: str) -> None:
    asked = job(**LEVEL, entry_hole=HOLE | {"in_stock": False})
    found = [finding for finding in sc.verify(text, asked).to_dict()["findings"] if finding["kind"] == "missing-hole"]
    assert [finding["severity"] for finding in found] == ["error"]
    assert "X10.000 Y8.000" in found[0]["message"] and "in_stock" in found[0]["message"]


@pytest.mark.parametrize(("bottom", "finding"), [(4.0, set()), (3.0, {"missing-hole"})])
def test_what_is_cut_before_counts_as_deep_as_it_goes(bottom: float, finding: set[str]) -> None:
    document = job(**LEVEL, id="first").to_dict()
    hole = HOLE | {"in_stock": False}
    document["operations"] += job(z_bottom=bottom, entry_hole=hole, id="second").to_dict()["operations"]
    asked = sc.Job.from_dict(document, part=block())
    assert kinds(text_of(asked), asked) == finding


@pytest.mark.parametrize(
    ("hole", "where"),
    [
        (HOLE | {"diameter": 4.0}, "operations[0].entry_hole.diameter"),
        (HOLE | {"x": 1.0}, "operations[0].entry_hole"),
        (HOLE | {"x": 3.0}, "operations[0].entry_hole"),
    ],
)
def test_a_hole_of_no_use_is_refused_with_what_to_do(hole: dict[str, float], where: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(**LEVEL, entry_hole=hole))
    assert refused.value.where == where and "entry_hole" in str(refused.value.hint)
