"""Links of a pocket: at depth with a feed of their own, or over the stock; and the rapids down to what is cleared."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from test_pocket_entry import LEVEL, findings, kinds
from test_pocket_operation import TOP, job, roles, text_of, whole_lines

import styluscam as sc

RAPID = 0
GAP = 0.25
"""What rapids keep over a floor that is cleared, mm."""


def words_of(lines: list[str], role: str) -> list[tuple[int, float]]:
    """The feed words of moves of a role: index of the line, mm/min."""
    found = []
    for begins in roles(lines, role):
        inside = itertools.takewhile(lambda line: not line[1].startswith("(role"), enumerate(lines[begins + 1 :]))
        words = ((begins + 1 + number, re.search(r"F([\d.]+)", line)) for number, line in inside)
        found += [(number, float(word[1])) for number, word in words if word]
    return found


@pytest.mark.parametrize("machine", ["linuxcnc", "grbl"])
def test_links_have_the_feed_of_the_passes_where_none_is_stated(machine: str) -> None:
    asked = job(machine, **LEVEL, feeds={"cut": 600.0, "plunge": 200.0})
    text = text_of(asked)
    assert findings(text, asked) == []
    assert max(float(word) for word in re.findall(r"F([\d.]+)", text)) == 600.0


def test_links_have_the_feed_that_is_stated_and_no_higher_one() -> None:
    asked = job(**LEVEL, link_feed=2345.0)
    text = text_of(asked)
    assert findings(text, asked) == [] and {feed for _, feed in words_of(whole_lines(text), "link")} == {2345.0}
    assert "feed-differs" in kinds(text.replace("F2345", "F2600"), asked)


def test_a_cut_with_the_feed_of_a_link_is_found() -> None:
    asked = job(**LEVEL, link_feed=3000.0)
    lines = whole_lines(text_of(asked))
    number, feed = words_of(lines, "cut")[-1]
    lines[number] = lines[number].replace(f"F{feed:g}", "F3000")
    assert "feed-differs" in kinds("\n".join([*lines, ""]), asked)


def test_an_entry_with_the_feed_of_a_link_is_found() -> None:
    asked = job(**LEVEL, entry="ramp", link_feed=3000.0)
    lines = whole_lines(text_of(asked))
    ramp = roles(lines, "ramp")[0] + 1
    lines[ramp] = re.sub(r" F[\d.]+", "", lines[ramp]) + " F3000"
    assert "feed-differs" in kinds("\n".join([*lines, ""]), asked)


def two_levels() -> tuple[sc.Job, list[str]]:
    """A pocket on two levels that begins on the lower one over cleared stock."""
    asked = job(step={"height": 1.0}, z_bottom=4.0)
    return asked, whole_lines(text_of(asked))


def rapids_down(lines: list[str]) -> list[tuple[int, float]]:
    """Lines of rapids down below the stock's top, with their heights."""
    moves = sc.read_gcode("\n".join([*lines, ""]), "linuxcnc").moves
    low = (moves["kind"] == RAPID) & (moves["end"][:, 2] < TOP + GAP + 1e-6)
    falls = np.diff(moves["end"][:, 2], prepend=np.inf) < 0
    return [(int(move["line"]), float(move["end"][2])) for move in moves[low & falls]]


def test_rapids_come_down_to_what_is_cleared() -> None:
    asked, lines = two_levels()
    found = rapids_down(lines)
    assert findings("\n".join([*lines, ""]), asked) == []
    # to the stock, and to the layer under the first
    assert [height for _, height in found] == pytest.approx([TOP + GAP, TOP - 1.0 + GAP], abs=0.03)


@pytest.mark.parametrize(("deeper", "kind"), [(0.5, "rapid-into-stock"), (0.22, "rapid-into-stock")])
def test_a_rapid_deeper_than_what_is_cleared_is_found(deeper: float, kind: str) -> None:
    asked, lines = two_levels()
    line, height = rapids_down(lines)[-1]
    lines[line - 1] = re.sub(r"Z[-\d.]+", f"Z{height - deeper:.3f}", lines[line - 1])
    assert kind in kinds("\n".join([*lines, ""]), asked)
