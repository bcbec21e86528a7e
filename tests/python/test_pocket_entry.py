"""Entries into a pocket, and links at depth: as they are asked for, and what the verifier finds where they are not so."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import TOP, block, job, roles, text_of, whole_lines

import styluscam as sc

LEVEL: dict[str, Any] = {"z_bottom": 4.0}
"""One level of 2 mm."""
RADIUS = 2.0


def findings(text: str, asked: sc.Job) -> list[dict[str, Any]]:
    found = sc.verify(text, asked).to_dict()["findings"]
    # the floor is deeper than the one level
    return [finding for finding in found if finding["kind"] != "missing-level"]


def kinds(text: str, asked: sc.Job) -> set[str]:
    return {finding["kind"] for finding in findings(text, asked)}


def ramps(text: str) -> Any:  # moves as numpy has them
    moves = sc.read_gcode(text, "linuxcnc").moves
    before = np.concatenate([moves["end"][:1], moves["end"][:-1]])
    falls = (before[:, 2] <= TOP + 1e-6) & (before[:, 2] > moves["end"][:, 2] + 1e-6)
    return before[falls], moves["end"][falls], moves["feed"][falls]


@pytest.mark.parametrize("keys", [{}, {"entry_angle_deg": 8.0, "entry_size": 6.0, "entry_feed": 200.0}])
def test_a_ramp_goes_to_and_fro_no_steeper_longer_or_faster_than_asked(keys: dict[str, Any]) -> None:
    asked = job(**LEVEL, entry="ramp", **keys)
    text = text_of(asked)
    assert kinds(text, asked) == set()
    starts, ends, feeds = ramps(text)
    along = np.hypot(*(ends - starts)[:, :2].T)
    slopes = np.degrees(np.arctan2((starts - ends)[:, 2], along))
    # arcs at its ends are longer than their chords
    longest = along > 1.0
    assert slopes[longest].max() <= keys.get("entry_angle_deg", 3.0) + 0.05 and longest.sum() >= 3
    assert along.max() <= keys.get("entry_size", 2 * RADIUS) + 0.01
    assert set(feeds) == {keys.get("entry_feed", 300.0)}
    # both ways lie on a line, 0.15 tool radii off it
    points = np.concatenate([starts, ends])[:, :2]
    thin, wide = np.linalg.eigh(np.cov(points.T))[0]
    assert thin < (0.2 * RADIUS) ** 2 < 0.5 < wide


def test_helices_are_no_larger_than_asked() -> None:
    asked = job(**LEVEL, entry="helix", entry_size=1.6)
    text = text_of(asked)
    _, ends, _ = ramps(text)
    assert kinds(text, asked) == set()
    assert np.ptp(ends[:, 0]) == pytest.approx(1.6, abs=0.02)


@pytest.mark.parametrize("entry", ["helix", "ramp"])
def test_entries_remove_no_more_stock_in_a_minute_than_passes(entry: str) -> None:
    feeds = {"cut": 1500.0, "plunge": 300.0}
    asked = job(**LEVEL, entry=entry, entry_angle_deg=20.0, entry_feed=5000.0, feeds=feeds)
    text = text_of(asked)
    starts, ends, found = ramps(text)
    assert kinds(text, asked) == set()
    # one feed: the tool is 2 r wide in what it falls by in a turn, against 2 mm by r (1 - cos 80)
    around = 2 * np.pi * 0.7 * RADIUS if entry == "helix" else 2 * 2 * RADIUS + 2 * np.pi * 0.15 * RADIUS
    fall = 2.0 / np.ceil(2.0 / (around * np.tan(np.radians(20.0))))
    rate = feeds["cut"] * 2.0 * RADIUS * (1 - np.cos(np.radians(80.0)))
    assert np.allclose(found, rate / (2 * RADIUS * fall), rtol=0.03) and (starts - ends)[:, 2].sum() == pytest.approx(2)


def test_a_ramp_that_is_steeper_than_asked_is_found() -> None:
    text = text_of(job(**LEVEL, entry="ramp", entry_angle_deg=8.0))
    assert kinds(text, job(**LEVEL, entry="ramp", entry_angle_deg=4.0)) == {"steep-entry"}


@pytest.mark.parametrize("entry", ["helix", "ramp"])
def test_a_plunge_in_the_middle_of_a_way_down_is_found(entry: str) -> None:
    asked = job(**LEVEL, entry=entry)
    lines = whole_lines(text_of(asked))
    falling = [number for number, line in enumerate(lines) if re.search(r" Z5\.[1-6]", line)]
    low = next(number for number, line in enumerate(lines) if "Z4" in line.split())
    # after some turns straight down, over ground that has been passed higher up only
    here = falling[-1]
    words = {word[0]: word for word in lines[here].split()}
    around = [re.sub(r"Z[45](\.\d+)?", "Z4", line) for line in lines[here + 1 : low]]
    spoilt = [*lines[: here + 1], f"G1 {words['X']} {words['Y']} Z4 F300", *around, *lines[low:]]
    found = [finding for finding in findings("\n".join([*spoilt, ""]), asked) if finding["kind"] == "steep-entry"]
    assert found and found[0]["line"] == here + 2


def test_where_no_way_down_fits_the_place_and_the_remedy_are_named() -> None:
    asked = job(**LEVEL, entry="ramp")
    document = asked.to_dict()
    # 14 by 10 mm of pocket leave its centre 4.2 by 0.2 mm: too narrow for a ramp's two ways
    document["tools"]["mill"]["profile"]["diameter"] = 9.8
    document["operations"][0]["smoothing_radius"] = 0.09
    document["operations"][0]["entry_size"] = 3.0
    with pytest.raises(sc.JobError) as refused:
        sc.plan(sc.Job.from_dict(document, part=block()))
    assert (refused.value.code, refused.value.where) == ("no-entry", "operations[0].entry")
    assert "Z4" in str(refused.value) and "X" in str(refused.value) and "entry" in str(refused.value.hint)
    assert 'entry = "auto"' in refused.value.hint and "lower entry_size" in refused.value.hint
    del document["operations"][0]["entry_size"]
    with pytest.raises(sc.JobError) as refused:
        sc.plan(sc.Job.from_dict(document, part=block()))
    assert "entry_size" not in refused.value.hint  # none was stated


@pytest.mark.parametrize("form", ["ramp", "helix", "auto"])
def test_an_entry_that_is_a_plunge_is_refused(form: str) -> None:
    with pytest.raises(sc.JobError) as refused:
        sc.plan(job(**LEVEL, entry=form, entry_size=0.05 * RADIUS))
    assert (refused.value.code, refused.value.where) == ("out-of-range", "operations[0].entry_size")
    assert "tool radii or more" in str(refused.value)


def heights(asked: sc.Job) -> dict[float, int]:
    ends = sc.read_gcode(text_of(asked), "linuxcnc").moves["end"]
    found, counts = np.unique(np.round(ends[:, 2], 3), return_counts=True)
    return dict(zip(found.tolist(), counts.tolist(), strict=True))


def test_links_are_lifted_and_cut_nothing() -> None:
    asked = job(**LEVEL, link_lift=0.25)
    assert kinds(text_of(asked), asked) == set()
    assert heights(asked)[4.25] > 10 and 4.25 not in heights(job(**LEVEL))


@pytest.mark.parametrize("lift", [0.0, 0.25])
def test_a_link_through_stock_is_found(lift: float) -> None:
    asked = job(**LEVEL, link_lift=lift)
    lines = whole_lines(text_of(asked))
    link = roles(lines, "link")[2]
    (x, y) = (next(word for word in lines[link - 1].split() if word[0] == axis) for axis in "XY")
    # to a corner of the pocket and back
    corner, high = "X5.5 Y5.5", f"Z{4 + lift:.3f}"
    there = [f"G1 {x} {y} {high}", f"G1 {corner} {high}", f"G1 {x} {y} {high}", f"G1 {x} {y} Z4"]
    found = findings("\n".join([*lines[: link + 1], *there, *lines[link + 1 :], ""]), asked)
    through = [finding for finding in found if "link is to cut nothing" in finding["message"]]
    assert through and link + 2 < through[0]["line"] <= link + 5


def test_a_lower_level_under_stock_that_is_left_above_is_found() -> None:
    asked = job()
    lines = whole_lines(text_of(asked))
    low = next(number for number, line in enumerate(lines) if re.search(r" Z2\.\d+", line))
    last = max(number for number in roles(lines, "cut") if number < low)
    retract = next(number for number in range(last, low) if lines[number].startswith("G0"))
    links = [number for number in roles(lines, "link") if number < retract]
    # the upper level ends half way
    spoilt = [*lines[: links[len(links) // 2]], *lines[retract:]]
    found = findings("\n".join([*spoilt, ""]), asked)
    under = [finding for finding in found if "below stock that is not cleared" in finding["message"]]
    assert under and under[0]["position"][2] < 3.0
