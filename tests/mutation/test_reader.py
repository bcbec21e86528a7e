"""The oracle's reader takes a text as LinuxCNC's own interpreter does, sound or spoilt."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

import rs274
from defects import FAMILIES_OF, KINDS, Text
from gcode import read

from .cases import Case, arc_case, made_case
from .defective import ARCS

UNITS = ("units change",)
"""Kinds after which the interpreter's feed is that of the unit before."""
APART = ("block deleted", "block of a cut deleted", "offset by g92")
"""Kinds of which the interpreter thinks as the machine's switch stands, or that the oracle refuses as never posted."""
TAKEN = [kind for kind in KINDS if "linuxcnc" in FAMILIES_OF[kind] and kind not in APART]
SPOILT = [kind for number, kind in enumerate(TAKEN) if number % 4 == 0 or kind in ARCS]
CALLED = {"STRAIGHT_TRAVERSE": "rapid", "STRAIGHT_FEED": "feed", "ARC_FEED": "arc"}
ROUNDED = 0.0026
"""mm: half of the last digit that the interpreter prints, in inches, and what its sums lose."""


def linuxcnc_case(draw: random.Random, folder: Path, *, arcs: bool) -> Case:
    make = arc_case if arcs else made_case
    return make(draw.randrange(200), folder, "linuxcnc")


def require_the_same(text: str, *, feeds: bool = True) -> None:
    program, calls = read(text, "linuxcnc"), rs274.interpret(text)
    assert (program.refused is None) == calls.ok, (program.refused, calls.error)
    if program.refused is not None:
        return
    assert program.moves
    for move, call in zip(program.moves, calls.moves, strict=True):
        assert move.kind == CALLED[call.kind]
        assert all(math.isnan(a) or abs(a - b) < ROUNDED for a, b in zip(move.end, call.mm, strict=True)), (move, call)
        assert move.sense * call.turns >= 0
        if move.kind != "rapid" and feeds:
            assert call.feed * (25.4 if call.unit == "inch" else 1.0) == pytest.approx(move.state.feed, rel=1e-3)


@pytest.mark.world
@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_sound_programs(seed: int, arcs: bool, folder: Path) -> None:
    require_the_same(linuxcnc_case(random.Random(seed), folder, arcs=arcs).text)


@pytest.mark.world
@pytest.mark.parametrize("kind", SPOILT)
def test_spoilt_programs(kind: str, folder: Path) -> None:
    draw = random.Random(kind)
    cases = (linuxcnc_case(draw, folder, arcs=kind in ARCS) for _ in range(100))
    texts = (KINDS[kind](Text(case.text, "linuxcnc"), draw) for case in cases)
    require_the_same(next(text for text in texts if text is not None), feeds=kind not in UNITS)
