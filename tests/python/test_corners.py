"""Feeds at sharp turns: lower where the machine's acceleration asks for it, and found where they are not."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from test_linking import MILLING, PARTS, SPINDLE, facts, findings

import styluscam as sc

FEED = 3000.0
BALL = {"kind": "ball", "diameter": 6.0}
ZIG_ZAG = {"kind": "zig-zag", "stepover": 2.0}
KINDS: dict[str, dict[str, Any]] = {
    "z-level": {"kind": "z-level", "step": {"height": 2.0}},
    "spiral": {"kind": "spiral", "step": {"height": 2.0}, "direction": "same"},
    "zig-zag": ZIG_ZAG,
    "arcs": {"kind": "zig-zag", "stepover": 2.0, "turns": "rounded", "fit": "arcs"},
}


def job(kind: str, machine: str = "linuxcnc", **keys: Any) -> sc.Job:
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"clearance": 10.0},
        "process": MILLING,
        "tools": {"t": {"number": 1, "profile": BALL}},
        "operations": [
            {
                "tool": "t",
                "tolerance": 0.01,
                "slow_corners": True,
                "feeds": {"cut": FEED},
                "spindle": SPINDLE,
                **KINDS[kind],
                **keys,
            }
        ],
        "machine": {"name": machine},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*PARTS["two"]))


@lru_cache(maxsize=8)
def posted(kind: str, machine: str = "linuxcnc") -> tuple[sc.Job, sc.Plan, str]:
    asked = job(kind, machine)
    plan = sc.plan(asked)
    (text,) = sc.post(plan).files.values()
    return asked, plan, text


def slowest_at_corners(program: sc.Program, acceleration: float, deviation: float) -> float:
    """The largest share of the speed allowed at a turn of two lines of 0.1 mm or more, each of them fed."""
    moves = program.moves
    ends = moves["end"]
    along = np.diff(ends, axis=0)
    lengths = np.linalg.norm(along, axis=1)
    worst = 0.0
    for i in range(1, len(along)):
        before, after = moves[i], moves[i + 1]
        fed = before["kind"] != 0 and after["kind"] != 0 and moves[i - 1]["kind"] != 0
        straight = np.isnan(before["centre"]).any() and np.isnan(after["centre"]).any()
        if not (fed and straight) or min(lengths[i - 1], lengths[i]) < 0.1:
            continue
        half = np.sqrt(0.5 * (1.0 + along[i - 1] @ along[i] / lengths[i - 1] / lengths[i]))  # of the turn, its cosine
        if half < 0.99:
            allowed = np.sqrt(acceleration * max(deviation * half / (1.0 - half), deviation))
            worst = max(worst, before["feed"] / 60.0 / allowed, after["feed"] / 60.0 / allowed)
    return float(worst)


@pytest.mark.parametrize("kind", KINDS)
def test_feeds_drop_at_turns(kind: str) -> None:
    asked, plan, text = posted(kind)
    assert findings(text, asked) == []
    program = plan.programs["main"]
    worst = slowest_at_corners(program, 500.0, 0.01)
    assert 0.5 < worst <= 1.0 if kind != "arcs" else worst <= 1.0
    assert facts(plan)["slow_corners"].value > 0
    feeds = program.moves["feed"][program.moves["kind"] != 0]
    assert feeds.max() == FEED and (feeds == FEED).sum() > 10


def test_the_planned_machine_decides() -> None:
    """GRBL's file states 200 mm/s^2, LinuxCNC's 500: the square root of that is how much slower corners are."""
    least = {}
    for machine in ("linuxcnc", "grbl"):
        asked, plan, text = posted("z-level", machine)
        assert findings(text, asked) == []
        moves = plan.programs["main"].moves
        least[machine] = moves["feed"][(moves["kind"] != 0) & (moves["feed"] != 300.0)].min()
    assert least["grbl"] / least["linuxcnc"] == pytest.approx(np.sqrt(200.0 / 500.0), rel=0.02)


def test_nothing_changes_where_it_is_not_asked_for() -> None:
    asked = job("z-level", slow_corners=False)
    plan = sc.plan(asked)
    moves = plan.programs["main"].moves
    assert set(moves["feed"][moves["kind"] != 0]) == {FEED, 300.0}
    (text,) = sc.post(plan).files.values()
    found = findings(text, job("z-level"))
    assert {finding.kind for finding in found} == {"corner-feed"}


def test_a_feed_that_does_not_drop_is_found_with_its_line() -> None:
    asked, _, text = posted("zig-zag")
    lines = text.splitlines()
    feeds = [(number, float(word[1])) for number, line in enumerate(lines) if (word := re.search(r" F([\d.]+)", line))]
    number, least = next((n, f) for n, f in feeds if f == min(f for _, f in feeds if f != 300.0))
    lines[number] = re.sub(r" F[\d.]+", f" F{1.2 * least:.0f}", lines[number])
    found = findings("\n".join(lines) + "\n", asked)
    assert {finding.kind for finding in found} == {"corner-feed"}
    assert number + 1 in {finding.line for finding in found}


def test_higher_feeds_than_the_operations_are_still_found() -> None:
    asked, _, text = posted("z-level")
    found = findings(text.replace(f" F{FEED:.0f}", f" F{FEED + 500:.0f}", 1), asked)
    assert "feed-differs" in {finding.kind for finding in found}
