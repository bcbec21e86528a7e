"""Seeded defects of the text and faults of the input: what matters is found, at the right line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from controllers import Family
from defects import FAMILIES_OF, KINDS
from faulty_inputs import FAULTS

from .defective import Trial, input_fault, text_defect, trials

LEAST_SCORE = 0.99
MOST_LEFT_OUT = 0.10
DRAWN = 6
"""Seeds of a kind among which one must matter."""


OWN: dict[Family, tuple[str, ...]] = {
    "fanuc": (
        "point lost",
        "rapid too deep",
        "retract missing",
        "machine place added",
        "home by way of zero",
        "absolute missing",
        "retract and lift missing",
        "first change missing",
        "length offset missing",
        "length offset of another tool",
        "percent inside",
        "block of a cut deleted",
        "arc turned",
    ),
    "okuma": (
        "point lost",
        "height off",
        "clearance lowered",
        "foreign offset",
        "length offset missing",
        "length cancelled",
        "tool change missing",
        "mist for flood",
        "word commented out",
        "end early",
        "units swapped",
        "arc centre sign",
    ),
    "marlin": (
        "motion word missing",
        "two commands on a line",
        "homing",
        "newline lost",
        "commented out",
        "letter for digit",
        "plunge in rapid",
        "feed missing",
        "incremental from here",
        "block deleted",
        "spindle stops",
        "arc straightened",
    ),
    "siemens": (
        "machine place lost",
        "machine place added",
        "tolerance switched off",
        "path tolerance",
        "foreign offset",
        "parenthesis for remark",
        "length offset missing",
        "tool number",
        "work plane",
        "units change",
        "dog leg",
        "arc centre",
    ),
    "heidenhain": (
        "machine place lost",
        "machine place added",
        "path tolerance without number",
        "parenthesis for remark",
        "radius compensation",
        "rapid for feed",
        "feed for rapid",
        "incremental from here",
        "tool number",
        "work offset",
        "units swapped",
        "dwell",
    ),
}
"""Kinds that are tried on a family in the fast run."""
SPREAD = [(family, kind) for family, kinds in OWN.items() for kind in kinds]
EVERYWHERE = [(family, kind) for kind, families in FAMILIES_OF.items() for family in families]


def mattering(drawn: Iterator[Trial | None]) -> Trial | None:
    """The first one that matters."""
    return next((trial for trial in drawn if trial is not None and trial.verdict.matters), None)


def require_found(drawn: Iterator[Trial | None]) -> None:
    """The first one that matters."""
    trial = mattering(drawn)
    assert trial is not None, "none of them matters"
    assert trial.found, str(trial)


@pytest.mark.parametrize("kind", KINDS)
def test_a_defect_of_each_kind_is_found(kind: str, folder: Path) -> None:
    require_found(text_defect(kind, seed, folder) for seed in range(DRAWN))


@pytest.mark.parametrize(("family", "kind"), SPREAD, ids=lambda name: name)
def test_a_defect_of_each_kind_is_found_on(family: Family, kind: str, folder: Path) -> None:
    require_found(text_defect(kind, seed, folder, family) for seed in range(DRAWN))


@pytest.mark.long
def test_every_kind_is_found_on_every_family(folder: Path) -> None:
    drawn = {
        (family, kind): mattering(text_defect(kind, seed, folder, family) for seed in range(DRAWN))
        for family, kind in EVERYWHERE
    }
    assert [pair for pair, trial in drawn.items() if trial is None] == []
    survivors = [trial for trial in drawn.values() if trial is not None and not trial.found]
    print("", f"{len(drawn)} pairs, {len(survivors)} survive", *survivors, sep="\n")
    assert len(drawn) - len(survivors) >= LEAST_SCORE * len(drawn)


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_of_the_input_is_found(name: str, folder: Path) -> None:
    require_found(input_fault(name, seed, folder) for seed in range(DRAWN))


@pytest.mark.long
def test_three_hundred_defects(folder: Path) -> None:
    made = list(trials(7, folder))
    mattering = [trial for trial in made if trial.verdict.matters]
    survivors = [trial for trial in mattering if not trial.found]
    print(summary(made, mattering, survivors))
    if len(made) < 300 or len(made) - len(mattering) > MOST_LEFT_OUT * len(made):
        raise RuntimeError("too few defects that matter")
    assert len(mattering) - len(survivors) >= LEAST_SCORE * len(mattering), f"{len(survivors)} survive"


def summary(made: list[Trial], mattering: list[Trial], survivors: list[Trial]) -> str:
    """Numbers by kind, the share left out, and every survivor with its case and line."""
    counts = [Counter(trial.kind for trial in some) for some in (made, mattering, survivors)]
    rows = [
        f"{kind:26} {n:3} made, {counts[1][kind]:3} matter, {counts[2][kind]:3} survive"
        for kind, n in counts[0].items()
    ]
    share = 1 - len(mattering) / len(made)
    found = 1 - len(survivors) / len(mattering)
    total = f"{len(made)} made, {share:.1%} left out, {found:.1%} of {len(mattering)} found"
    return "\n".join(["", *rows, total, *map(str, survivors)])
