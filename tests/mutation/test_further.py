"""Spirals, steps by list and by scallop, fitted arcs: sound programs pass, and what is seeded into them is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from controllers import Family

from .cases import FURTHER, Case, further_case
from .defective import Trial, text_defect
from .test_defects import LEAST_SCORE, mattering, require_found
from .test_sound import require_sound

MOVED = (
    "coordinate off",
    "height off",
    "level lowered",
    "level raised",
    "sign lost",
    "digits turned",
    "axes swapped",
    "rapid for feed",
    "rapid too deep",
    "plunge in rapid",
    "cut short",
    "block deleted",
)
"""Kinds of defects of where the tool goes."""
SEEDS = 12
"""Seeds of a kind among which one must matter."""


def of(operation: int, number: int, folder: Path, family: Family | None) -> Case:
    """A case of one of the operations."""
    return further_case(operation + len(FURTHER) * (number % 7), folder, family)


def drawn(kind: str, seed: int, operation: int, folder: Path) -> Trial | None:
    return text_defect(kind, seed, folder, make=lambda number, at, family: of(operation, number, at, family))


@pytest.mark.parametrize("number", range(2 * len(FURTHER)))
def test_a_sound_program_passes(number: int, folder: Path) -> None:
    require_sound(further_case(number, folder))


@pytest.mark.parametrize(("kind", "operation"), [(kind, 5 * i % len(FURTHER)) for i, kind in enumerate(MOVED)])
def test_a_defect_of_each_kind_is_found(kind: str, operation: int, folder: Path) -> None:
    require_found(drawn(kind, seed, operation, folder) for seed in range(SEEDS))


@pytest.mark.long
def test_every_kind_is_found_in_every_operation(folder: Path) -> None:
    found = [
        mattering(drawn(kind, seed, operation, folder) for seed in range(first, first + SEEDS))
        for operation in range(len(FURTHER))
        for kind in MOVED
        for first in (0, SEEDS)
    ]
    made = [trial for trial in found if trial is not None]
    survivors = [trial for trial in made if not trial.found]
    print("", f"{len(made)} matter, {len(survivors)} survive", *survivors, sep="\n")
    assert len(made) >= len(found) // 2 and len(made) - len(survivors) >= LEAST_SCORE * len(made)
