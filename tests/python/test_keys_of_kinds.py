"""Keys of every operation that mean nothing to a kind: the schema states them, and stating one is refused or changes nothing."""

from __future__ import annotations

from typing import Any

import pytest
from test_pocket_operation import job, text_of

import styluscam as sc

VALUES: dict[str, Any] = {
    "check_faces": "rest",
    "check_clearance": 1.0,
    "boundary": {"slope_deg": [0.0, 30.0]},
    "edges": "stop",
    "max_corner_deg": 10.0,
    "links": "retract",
    "link_margin": 3.0,
    "lead": "arc",
    "lead_radius": 2.5,
    "lead_angle_deg": 40.0,
}
"""One that is not the default of each key that the schema states not to be of pockets."""

SILENT = {"link_margin", "lead_radius", "lead_angle_deg"}
"""Numbers for what is refused: of no use without it."""


def stated_not_of(kind: str) -> set[str]:
    kinds = sc.job_schema()["$defs"]["OperationSection"]["oneOf"]
    (keys,) = (one["properties"] for one in kinds if one["properties"]["kind"]["const"] == kind)
    return {name for name, entry in keys.items() if kind in entry.get("x-not-of", ())}


def test_the_schema_states_what_a_pocket_does_not_follow() -> None:
    assert stated_not_of("pocket") == set(VALUES)


@pytest.mark.parametrize("key", sorted(set(VALUES) - SILENT))
def test_what_it_does_not_follow_is_refused(key: str) -> None:
    with pytest.raises(sc.StylusError) as error:
        sc.plan(job(**{key: VALUES[key]}))
    assert str(error.value.where).endswith(f".{key}") and error.value.hint


def test_a_step_by_scallop_is_refused() -> None:
    with pytest.raises(sc.JobError) as error:
        sc.plan(job(step={"scallop": 0.01}))
    assert error.value.where == "operations[0].step.scallop" and "height" in error.value.hint


def test_numbers_for_that_change_nothing() -> None:
    silent = {key: VALUES[key] for key in SILENT}
    assert text_of(job(**silent)) == text_of(job())


def test_every_other_key_is_of_pockets() -> None:
    accepted = {
        "direction": "climb",
        "tolerance": 0.01,
        "fit": "lines",
        "smallest_feature": 1.0,
        "z_top": 6.0,
        "z_bottom": 2.5,
    }
    assert not stated_not_of("pocket") & set(accepted)
    assert text_of(job(**accepted)) != text_of(job())
