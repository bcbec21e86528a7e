"""Feeds of a pocket: as much stock in a minute as a full pass takes, never more; what is over that is found, by its line."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import TOP, job, text_of

import styluscam as sc
from styluscam.programs.program import COUNTERCLOCKWISE, FEED, RAPID

LEVEL: dict[str, Any] = {"z_bottom": 4.0}
RADIUS, BOUND, CUT, HIGHEST = 2.0, np.radians(80.0), 600.0, 1800.0
FEEDS = {"feeds": {"cut": CUT, "plunge": 200.0}, "max_feed": HIGHEST}


def findings(text: str, asked: sc.Job) -> list[dict[str, Any]]:
    found = sc.verify(text, asked).to_dict()["findings"]
    # the floor is deeper than the one level
    return [finding for finding in found if finding["kind"] != "missing-level"]


def test_the_stepover_of_straight_passes_slots_and_corners_is_exact() -> None:
    square = np.array([[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]])
    slot = np.array([[-10.0, 0.0], [10.0, 0.0]])
    beside = slot - np.array([0.0, 1.0])
    runs = [(slot, "cut"), (slot[::-1], "link"), (beside, "cut")]
    first, back, second = sc.engagement(runs, RADIUS, None, square)
    assert np.allclose(first.stepovers[1:], 2 * RADIUS, atol=1e-9) and np.allclose(back.stepovers, 0.0, atol=1e-9)
    middle = np.abs(second.points[:, 0]) < 5.0
    # 1 um of it, in front of what was swept before, does not count
    assert np.allclose(second.stepovers[middle], 1.0, atol=1.5e-3)
    assert np.allclose(second.angles_deg[middle], np.degrees(np.arccos(1 - 1.0 / RADIUS)), atol=0.1)


def rates(text: str) -> tuple[Any, Any, Any]:
    """Of each move of the text on its level: largest stepover, feed, length."""
    moves = sc.read_gcode(text, "linuxcnc").moves
    inside = np.flatnonzero((moves["end"][:, 2] < 4.0 + 1e-6) & (moves["kind"] != RAPID))
    runs, feeds, lengths = [], [], []
    for index in inside:
        start, end = moves["end"][index - 1], moves["end"][index]
        if start[2] > 4.0 + 1e-6 or np.allclose(start[:2], end[:2]):
            continue
        bulge = bulge_of(start, end, moves[index])
        runs.append((np.array([[*start[:2], bulge], [*end[:2], 0.0]]), "cut"))
        feeds.append(moves["feed"][index])
        lengths.append(np.hypot(*(end - start)[:2]))
    x, y = 20.0, 16.0
    stock = np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]])
    found = sc.engagement(runs, RADIUS, stock, stock)
    return np.array([run.stepovers.max(initial=0.0) for run in found]), np.array(feeds), np.array(lengths)


def bulge_of(start: Any, end: Any, move: Any) -> float:  # rows as numpy has them
    if move["kind"] == FEED:
        return 0.0
    arms = [(point - move["centre"])[:2] for point in (start, end)]
    turn = np.arctan2(arms[0][0] * arms[1][1] - arms[0][1] * arms[1][0], arms[0] @ arms[1])
    sense = 1.0 if move["kind"] == COUNTERCLOCKWISE else -1.0
    return float(sense * np.tan(sense * turn % (2 * np.pi) / 4))


def test_the_rate_is_held_near_the_reference_and_not_above_it() -> None:
    widths, feeds, lengths = rates(text_of(job(**LEVEL, **FEEDS)))
    reference = CUT * RADIUS * (1 - np.cos(BOUND))
    # ends are rounded to 1 um: on a move of 9 um the heading may be off by 0.16 rad, and the stepover by as much of the radius
    widths = np.maximum(widths - RADIUS * np.sqrt(2.0) * 1e-3 / lengths, 0.0)
    # half a degree more is what the bound itself allows
    assert (widths * feeds).max() < 1.012 * reference
    cuts = widths > 0.02
    near = (widths * feeds > 0.85 * reference) | (feeds >= HIGHEST)
    assert lengths[cuts & near].sum() > 0.6 * lengths[cuts].sum()


@pytest.mark.parametrize("machine", ["linuxcnc", "grbl"])
@pytest.mark.parametrize(
    "keys", [{}, {"chip_thinning": True}, {"fit": "lines"}, {"link_lift": 0.2, "direction": "conventional"}]
)
def test_no_move_removes_more_than_a_full_pass(machine: str, keys: dict[str, Any]) -> None:
    asked = job(machine, **LEVEL, **FEEDS, **keys)
    assert findings(text_of(asked), asked) == []


def test_feeds_rise_to_the_reference_and_stay_in_steps() -> None:
    asked = job(**LEVEL, **FEEDS)
    text = text_of(asked)
    words = [float(word) for word in re.findall(r"F([\d.]+)", text)]
    assert max(words) == HIGHEST and CUT in words
    steps = np.log([word / CUT for word in words if word not in (HIGHEST, 200.0)]) / np.log(1.05)
    assert np.allclose(steps, np.round(steps), atol=1e-2)
    moves = sc.read_gcode(text, "linuxcnc").moves
    inside = moves[(moves["end"][:, 2] < TOP - 1e-6) & (moves["kind"] != RAPID)]
    # the same path at one feed takes longer
    plain = sc.plan(job(**LEVEL, feeds=FEEDS["feeds"], link_feed=CUT)).programs["main"].duration
    assert sc.plan(asked).programs["main"].duration < 0.9 * plain and len(words) < 0.5 * len(inside)


def test_chip_thinning_lets_feeds_rise_less() -> None:
    mean = {}
    for thinning in (False, True):
        moves = sc.read_gcode(text_of(job(**LEVEL, **FEEDS, chip_thinning=thinning)), "linuxcnc").moves
        cuts = moves["feed"][(moves["end"][:, 2] < 4.0 + 1e-6) & (moves["kind"] != RAPID)]
        mean[thinning] = cuts.mean()
    assert CUT < mean[True] < mean[False] < HIGHEST


def test_a_feed_that_is_too_high_for_its_stepover_is_found_on_its_line() -> None:
    asked = job(**LEVEL, **FEEDS)
    lines = text_of(asked).splitlines()
    raised = [n for n, line in enumerate(lines) if line.endswith(f" F{CUT:g}") or line == f"F{CUT:g}"]
    number = raised[len(raised) // 2]
    lines[number] = lines[number].replace(f"F{CUT:g}", f"F{1.2 * CUT:g}")
    ends = next(n for n in range(number + 1, len(lines)) if "F" in lines[n])
    found = findings("\n".join([*lines, ""]), asked)
    assert {finding["kind"] for finding in found} == {"removal-rate"}
    assert all(number + 1 <= finding["first_line"] <= finding["last_line"] <= ends for finding in found)
    # as fast as its stepover allows, by a step of 5 %
    assert CUT <= found[0]["limit"] < 1.05 * CUT and found[0]["value"] == pytest.approx(1.2 * CUT)


def test_feeds_beyond_the_highest_are_found() -> None:
    asked = job(**LEVEL, **FEEDS)
    text = text_of(asked).replace(f"F{HIGHEST:g}", "F2500")
    assert "feed-differs" in {finding["kind"] for finding in findings(text, asked)}


@pytest.mark.parametrize(
    ("keys", "where"),
    [
        ({"max_feed": 500.0, "feeds": {"cut": 600.0}}, "operations[0].max_feed"),
        ({"chip_thinning": True}, "operations[0].chip_thinning"),
    ],
)
def test_feeds_that_contradict_each_other_are_refused(keys: dict[str, Any], where: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        job(**keys)
    assert refused.value.where == where and refused.value.hint


def test_sharp_turns_are_slower_where_it_is_asked_for() -> None:
    asked = job("grbl", **LEVEL, slow_corners=True)
    text = text_of(asked)
    words = [float(word) for word in re.findall(r"F([\d.]+)", text)]
    assert findings(text, asked) == [] and min(words) < 300.0
