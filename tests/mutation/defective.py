"""Draws defective programs and faulty inputs by their numbers, and asks the verifier and the oracle about them."""

from __future__ import annotations

import copy
import random
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

import matters
import styluscam as sc
from controllers import FAMILIES, Family
from defects import FAMILIES_OF, KINDS, Text
from faulty_inputs import FAULTS
from matters import Verdict

from .cases import Case, arc_case, made_case

POOL = 200
"""Sound programs from which those to be spoilt are drawn."""
TRIES = 60
SHARE_WITH_ARCS = 0.15
NEAR = 1
"""Lines by which a finding may miss: a wrong point makes the moves to it and from it wrong."""

ARCS = ("arc turned", "arc centre", "arc centre sign", "arc straightened")
"""Kinds that need a program with arcs."""


def _any(case: Case) -> bool:
    return True


SUITS: dict[str, Callable[[Case], bool]] = {
    "levels swapped": lambda case: case.wanted.forming,
    "level repeated": lambda case: case.wanted.forming,
    "spindle on": lambda case: case.wanted.forming,
    "corner missing": lambda case: case.document["operations"][0]["kind"] == "z-level" and not case.arcs,
    "lines swapped": lambda case: case.document["operations"][0]["kind"] == "z-level" and not case.arcs,
}
"""Cases in which a kind can matter, where that is not all."""


WARNED_OF = ("missing-pass", "missing-level", "missing-row", "forming-order")
"""What is left undone, or done in another order, breaks nothing: the verifier warns of it."""


@dataclass(frozen=True)
class Trial:
    """A defect: what was spoilt, whether that matters, and what the verifier reported."""

    kind: str
    seed: int
    case: Case
    text: str
    verdict: Verdict
    found: bool
    reported: str

    def __str__(self) -> str:
        first = min(self.verdict.lines, default=0)
        why = "; ".join(self.verdict.reasons[:2])
        return f"{self.kind} #{self.seed} ({self.case.name}) at line {first}: {why} | verifier: {self.reported}"


Make: TypeAlias = Callable[[int, Path, Family | None], Case]
"""Draws a case by its number."""


def text_defect(
    kind: str, seed: int, folder: Path, family: Family | None = None, make: Make | None = None
) -> Trial | None:
    """A sound program with one defect, of a family and a maker if these are given; none where the kind fits no program."""
    draw = random.Random(f"{kind} {seed} {family or ''}")
    if family is None and FAMILIES_OF[kind] != FAMILIES:
        family = draw.choice(FAMILIES_OF[kind])
    suits = SUITS.get(kind, _any)
    for _ in range(TRIES):
        if make is None:
            drawn = arc_case if kind in ARCS or draw.random() < SHARE_WITH_ARCS else made_case
        case = (make or drawn)(draw.randrange(POOL), folder, family)
        if not suits(case):
            continue
        changed = KINDS[kind](Text(case.text, case.family), draw)
        if changed is not None:
            verdict = matters.weigh(case.text, changed, case.wanted)
            return Trial(kind, seed, case, changed, verdict, *_verified(changed, case, verdict))
    return None


def input_fault(name: str, seed: int, folder: Path) -> Trial | None:
    """A program made from a spoilt input, verified against the right one."""
    draw = random.Random(f"{name} {seed}")
    for _ in range(TRIES):
        case = made_case(draw.randrange(POOL), folder)
        spoilt = FAULTS[name](copy.deepcopy(case.mesh), copy.deepcopy(case.document))
        if spoilt is None:
            continue
        try:
            text = Case(case.name, *spoilt, case.family).text
        except sc.StylusError:
            continue  # a fault that planning refuses never becomes a program
        verdict = matters.weigh(case.text, text, case.wanted)
        verdict.whole = True
        return Trial(name, seed, case, text, verdict, *_verified(text, case, verdict))
    return None


def _verified(text: str, case: Case, verdict: Verdict) -> tuple[bool, str]:
    """Whether the verifier objects at the right line or position, and what it reports."""
    try:
        report = sc.verify(text, case.job)
    except sc.VerifyError as error:
        return _names_line(str(error.where), verdict), f"{error}"
    telling = [f for f in report.findings if f["severity"] == "error" or f["kind"] in WARNED_OF]
    reported = "; ".join(f"{f['severity']} {f['kind']} {f['first_line']}-{f['last_line']}" for f in report.findings[:3])
    return any(_is_there(finding, verdict) for finding in telling), reported or "nothing"


def _is_there(finding: dict[str, Any], verdict: Verdict) -> bool:
    first, last = finding["first_line"] - NEAR, finding["last_line"] + NEAR
    if finding["line"] and any(first <= line <= last for line in verdict.lines):
        return True
    position = finding.get("position")
    if position is not None and verdict.positions:
        return bool(min(np.linalg.norm(np.array(position) - known) for known in verdict.positions) < 3.0)
    return finding["line"] == 0 and verdict.whole


def _names_line(where: str, verdict: Verdict) -> bool:
    """A text that cannot be read: its error names line and column."""
    number = re.search(r"line (\d+)", where)
    return number is None or any(abs(int(number[1]) - line) <= NEAR for line in verdict.lines)


def trials(count: int, folder: Path) -> Iterator[Trial]:
    """`count` of each kind of text defect, spread over the families, and one third as many of each fault of the input."""
    for kind in KINDS:
        families = FAMILIES_OF[kind]
        for number, family in enumerate(families):
            seeds = range(number, count, len(families))
            yield from filter(None, (text_defect(kind, seed, folder, family) for seed in seeds))
    for name in FAULTS:
        yield from filter(None, (input_fault(name, seed, folder) for seed in range(-(-count // 3))))
