"""What a report shows of pockets: engagement and removal rate over length, as the verifier measures them on the text."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import block, job, roles, straight, text_of, whole_lines
from test_report import Page, job_of

import styluscam as sc
from blocks import TOP, write_stl
from styluscam.judging.clearing import ClearedLayer, ClearingMoves, OperationEngagement, lines
from styluscam.report import Subject, clearing, heatmaps, report_page
from styluscam.report.plots import BINS

RADIUS, BOUND, CUT, DEPTH = 2.0, 80.0, 600.0, 2.0
FEEDS: dict[str, Any] = {"feeds": {"cut": CUT, "plunge": 200.0}}


def full(bound_deg: float = BOUND, radius: float = RADIUS) -> float:
    """The stepover of a straight pass at an angle."""
    return float(radius * (1.0 - np.cos(np.radians(bound_deg))))


def engagement(text: str, asked: sc.Job) -> OperationEngagement:
    (found,) = sc.verify(text, asked).engagement
    return found


def by_hand(*moves: str) -> str:
    """A text of one operation whose moves are given, and the line of the first."""
    text = text_of(job(**FEEDS)).splitlines()
    head = next(number for number, line in enumerate(text) if line.startswith("(operation"))
    tail = next(number for number, line in enumerate(text) if number > head and line.startswith("M5"))
    return "\n".join([*text[: head + 1], *moves, *text[tail:], ""])


def line_of(text: str, word: str) -> int:
    (number,) = [number for number, line in enumerate(text.splitlines(), start=1) if line == word]
    return number


SIDE = ("G0 Z16", "X-5 Y-1", "G1 Z4 F200", "X25 F500", "G1 Z8 F900", "Y30", "G0 Z16")
"""Along the block's side, one millimetre into it with a tool of 2 mm radius; up, and on over the block at a feed."""


def test_a_straight_pass_has_the_angle_and_the_rate_of_its_stepover() -> None:
    text = by_hand(*SIDE)
    found = engagement(text, job(**FEEDS))
    assert found.bound_deg == pytest.approx(BOUND) and found.operation == "pocket-1"
    (layer,) = found.layers
    assert (layer.top, layer.floor, layer.radius) == (TOP, TOP - DEPTH, RADIUS)
    assert layer.reference_rate == pytest.approx(DEPTH * CUT * full())
    moves = found.moves
    assert moves.kinds.tolist() == ["entry", "cut"] and moves.feeds.tolist() == [200.0, 500.0]
    assert moves.lines.tolist() == [line_of(text, "G1 Z4 F200"), line_of(text, "X25 F500")]
    # down 12 mm, along 30, up 4, across 31
    assert np.allclose([*moves.starts, *moves.ends, found.length], [0.0, 12.0, 12.0, 42.0, 77.0])
    inside = (found.of_move == 1) & (found.points[:, 0] > 3.0) & (found.points[:, 0] < 17.0)
    assert inside.sum() > 300 and np.allclose(found.points[inside, 1:], [-1.0, 4.0])
    assert np.allclose(found.distances[inside], 12.0 + found.points[inside, 0] + 5.0, atol=1e-9)
    assert np.allclose(found.stepovers[inside], 1.0, atol=1e-9)
    assert np.allclose(found.angles_deg[inside], np.degrees(np.arccos(1.0 - 1.0 / RADIUS)), atol=1e-6)
    # of the stepover, what rounding the ends to 1 um may turn a move of 30 mm by is taken off
    assert np.allclose(found.rates[inside], DEPTH * 500.0 * (1.0 - RADIUS * np.sqrt(2.0) * 1e-3 / 30.0), rtol=1e-9)


@pytest.mark.parametrize(("ahead", "aside", "is_found"), [(0.008, 0.001, False), (0.8, 0.1, True), (0.08, 0.01, True)])
def test_what_rounding_may_turn_a_short_move_by_is_no_engagement(ahead: float, aside: float, is_found: bool) -> None:
    """A pass just below the bound with one move that is turned by seven degrees into the stock."""
    into = RADIUS * (1.0 - np.cos(np.radians(BOUND - 0.2))) - RADIUS
    moves = [f"X{10.0 + ahead:.3f} Y{into + aside:.3f}", f"X25 Y{into + aside:.3f}"]
    text = by_hand("G0 Z16", f"X-5 Y{into:.3f}", "G1 Z4 F200", "X10 F500", *moves, "G1 Z8 F900", "Y30", "G0 Z16")
    report = sc.verify(text, job(**FEEDS))
    (found,) = report.engagement
    turned = found.of_move == found.moves.lines.tolist().index(line_of(text, moves[0]))
    assert found.angles_deg[turned].max() > BOUND + 1.0
    rounded = np.degrees(np.sqrt(2.0) * 1e-3 / np.hypot(ahead, aside))
    assert found.bounded_deg[turned].max() == pytest.approx(found.angles_deg[turned].max() - rounded, abs=0.01)
    kinds = {finding["kind"] for finding in report.to_dict()["findings"]}
    assert ("engagement" in kinds) == is_found


def test_entries_are_exempt_and_have_no_rate() -> None:
    found = engagement(text_of(job(**FEEDS)), job(**FEEDS))
    entries = found.exempt
    assert len(entries) == len(found.layers) == 2
    for entry, layer in zip(entries, found.layers, strict=True):
        on_it = (found.distances >= entry.start) & (found.distances <= entry.start + entry.length) & found.is_exempt
        assert np.isnan(found.rates[on_it]).all() and found.angles_deg[on_it].max() == entry.max_deg > BOUND
        # helices of 3 degrees through the layer, and what of the plunge lies in it
        assert entry.length == pytest.approx((layer.top - layer.floor) / np.sin(np.radians(3.0)), rel=0.3)
    assert found.is_exempt.sum() < 0.3 * len(found.distances)
    assert np.isfinite(found.rates[~found.is_exempt]).all()


def test_figures_are_those_of_the_arrays_and_within_bound_and_reference() -> None:
    found = engagement(text_of(job(**FEEDS, max_feed=1800.0)), job(**FEEDS, max_feed=1800.0))
    figures = found.figures
    bounded = np.where(found.is_exempt, 0.0, found.bounded_deg)
    assert figures.angle is not None and figures.rate is not None
    assert figures.angle.value == bounded.max() and 0.9 * BOUND < figures.angle.value < BOUND + 0.5
    assert figures.angle.line == found.moves.lines[found.of_move[bounded.argmax()]]
    assert figures.angle.share == pytest.approx(figures.angle.value / BOUND)
    assert 0.95 < figures.rate.share < 1.012 and figures.rate.value == pytest.approx(np.nanmax(found.rates), rel=0.01)


def test_layers_of_other_depth_have_another_reference() -> None:
    asked = job(step={"list": [1.0, 3.0]}, **FEEDS)
    found = engagement(text_of(asked), asked)
    assert [round(layer.top - layer.floor, 2) for layer in found.layers] == [1.0, 3.0]
    references = [layer.reference_rate for layer in found.layers]
    assert references == pytest.approx([CUT * full(), 3.0 * CUT * full()], rel=2e-3)
    assert np.array_equal(np.unique(found.reference_rates), np.unique(references))
    # every move lies in the layer of its height
    ends = found.points[np.append(np.flatnonzero(np.diff(found.of_move)), len(found.of_move) - 1), 2]
    floors = np.array([layer.floor for layer in found.layers])[found.moves.layers]
    assert (ends >= floors - 1e-3).all()


def test_a_pass_that_is_left_out_shows_in_the_plot_where_the_verifier_finds_it() -> None:
    asked = job(**FEEDS)
    posted = whole_lines(text_of(asked))
    links = roles(posted, "link")
    ends = {
        number: min(link for link in links if link > number) for number in roles(posted, "cut") if number < links[-1]
    }
    longest = max(ends, key=lambda number: ends[number] - number)
    spoilt = "\n".join([*posted[:longest], *posted[ends[longest] :], ""])
    report = sc.verify(spoilt, asked)
    (found,) = report.engagement
    largest = found.figures.angle
    findings = [finding for finding in report.findings if finding.kind == "engagement"]
    assert largest is not None and largest.value > BOUND + 5.0
    # the move is a link as well, for which more is looked at
    worst = max(findings, key=lambda finding: finding.value or 0.0)
    assert worst.line == largest.line and worst.value == pytest.approx(largest.value, rel=0.02)
    assert worst.position is not None and np.allclose(worst.position[:2], largest.position[:2])
    distances, values = clearing.highest_of(found, found.bounded_deg)
    at = int(np.nanargmax(values))
    assert values[at] == largest.value and distances[at] == pytest.approx(largest.distance)
    notes = clearing.over_length(found)[0].notes
    assert f"{largest.value:.2f}° in line {largest.line}," in notes[0]


def test_the_largest_angle_is_the_one_that_the_verifier_reports() -> None:
    text = by_hand("G0 Z16", "X-5 Y0.5", "G1 Z4 F200", "X25 F300", "G0 Z16")
    report = sc.verify(text, job(**FEEDS))
    (found,) = report.engagement
    largest = found.figures.angle
    (finding,) = [finding for finding in report.findings if finding.kind == "engagement"]
    assert largest is not None and largest.value == pytest.approx(finding.value)
    # of a pass of 30 mm, what rounding its ends may turn it by is taken off
    assert finding.value == pytest.approx(np.degrees(np.arccos(-0.25) - np.sqrt(2.0) * 1e-3 / 30.0))
    assert largest.line == finding.line == line_of(text, "X25 F300")


def test_a_feed_that_is_too_high_shows_in_the_rate() -> None:
    asked = job(**FEEDS)
    posted = text_of(asked).splitlines()
    (found,) = sc.verify("\n".join([*posted, ""]), asked).engagement
    rate = found.figures.rate
    assert rate is not None
    # the word that holds where the rate is largest
    cut = max(number for number, line in enumerate(posted[: rate.line]) if line.endswith(f"F{CUT:g}"))
    posted[cut] = posted[cut].replace(f"F{CUT:g}", f"F{1.3 * CUT:g}")
    report = sc.verify("\n".join([*posted, ""]), asked)
    (found,) = report.engagement
    rate = found.figures.rate
    assert rate is not None and rate.share == pytest.approx(1.3, abs=0.02)
    findings = [finding for finding in report.findings if finding.kind == "removal-rate"]
    assert [finding for finding in findings if finding.first_line <= rate.line <= finding.last_line]


def made(count: int, peak: int) -> OperationEngagement:
    """One move of many positions at 40 degrees, with one at 75; the first tenth is an entry at 180."""
    distances = np.linspace(0.0, 1000.0, count)
    angles = np.where(distances < 100.0, 180.0, 40.0)
    angles[peak] = 75.0
    moves = ClearingMoves(
        lines=np.array([5, 6]),
        layers=np.array([0, 0]),
        kinds=np.array(["entry", "cut"]),
        starts=np.array([0.0, 100.0]),
        ends=np.array([100.0, 1000.0]),
        feeds=np.full(2, CUT),
        roundings=np.zeros(2),
    )
    return OperationEngagement(
        operation="made",
        bound_deg=60.0,
        length=1000.0,
        layers=[ClearedLayer(6.0, 4.0, RADIUS, DEPTH * CUT * full(60.0))],
        moves=moves,
        of_move=(distances >= 100.0).astype(np.int64),
        distances=distances,
        points=np.column_stack([distances, 0 * distances, 0 * distances + 4.0]),
        angles_deg=angles,
        stepovers=RADIUS * (1.0 - np.cos(np.radians(angles))),
    )


@pytest.mark.parametrize("peak", [30_000, 123_456, 199_999])
def test_a_single_peak_is_drawn_where_it_is(peak: int) -> None:
    found = made(200_000, peak)
    distances, values = clearing.highest_of(found, np.where(found.is_exempt, np.nan, found.angles_deg))
    assert len(values) == BINS and (np.diff(distances) > 0.0).all()
    at = int(np.nanargmax(values))
    assert (values[at], distances[at]) == (75.0, found.distances[peak])
    assert np.isnan(values[distances < 99.0]).all() and (np.delete(values, at)[distances[:-1] > 101.0] == 40.0).all()


def test_what_is_not_measured_is_a_gap() -> None:
    found = engagement(by_hand(*SIDE[:4], "G1 Z8 F900", "X-5", "Z4", "X25 F500", "G0 Z16"), job(**FEEDS))
    distances, values = clearing.highest_of(found, found.angles_deg)
    # 4 mm up and 30 back over the block
    (gap,) = np.flatnonzero(np.isnan(values))
    assert distances[gap] == pytest.approx(42.0) and distances[gap + 1] > 76.0 - 1e-6


def test_a_program_through_the_air_engages_nothing() -> None:
    found = engagement(by_hand("G0 Z16", "X-5 Y-9", "G1 Z4 F200", "X25 F500", "G0 Z16"), job(**FEEDS))
    figures = found.figures
    assert figures.angle is not None and figures.rate is not None and figures.exempt == []
    assert (figures.angle.value, figures.rate.value) == (0.0, 0.0)
    notes = clearing.over_length(found)[0].notes
    assert notes[0].startswith("Largest angle 0.00° in line") and "No entry goes through stock" in notes[1]


def test_rapids_alone_are_not_measured() -> None:
    found = engagement(by_hand("G0 Z16", "X-5 Y1"), job(**FEEDS))
    assert (len(found.distances), found.length, found.layers) == (0, 0.0, [])
    assert found.figures.angle is None and found.figures.rate is None
    assert lines([found]) == ["pocket-1: no cutting move to measure"]


def test_the_rest_that_a_larger_tool_leaves_is_shown_without_what_that_tool_took() -> None:
    mill = {"number": 1, "profile": {"kind": "flat", "diameter": 6.0}}
    small = {"number": 2, "profile": {"kind": "flat", "diameter": 2.0}}
    keys = {"kind": "pocket", "step": {"height": 2.0}, "engagement_deg": 60.0, "z_bottom": 4.0, "fit": "arcs"}
    spindle = {"spindle": {"mode": "fixed", "rpm": 8000.0}}
    document = {
        **job(**FEEDS).document,
        "tools": {"mill": mill, "small": small},
        "operations": [
            {**keys, **spindle, "id": "rough", "tool": "mill"},
            {**keys, **spindle, "id": "rest", "tool": "small", "rest_machining": True},
        ],
    }
    asked = sc.Job.from_dict(document, part=block())
    rough, rest = sc.verify(text_of(asked), asked).engagement
    assert (rough.operation, rest.operation) == ("rough", "rest")
    assert rough.exempt and not rest.exempt
    assert rest.figures.angle is not None and 30.0 < rest.figures.angle.value < 60.5
    assert rest.layers[0].radius == 1.0


def test_an_engagement_travels_and_is_json() -> None:
    asked = job(**FEEDS, z_bottom=4.0)
    report = sc.verify(text_of(asked), asked)
    (found,) = report.engagement
    (copy,) = pickle.loads(pickle.dumps(report)).engagement
    assert np.array_equal(copy.angles_deg, found.angles_deg) and copy.figures == found.figures
    document = found.figures.to_dict()
    assert set(document) == {"operation", "bound_deg", "length", "layers", "angle", "rate", "exempt"}
    assert document["layers"][0]["floor"] == 4.0 and document["exempt"][0]["first_line"] > 1


# --- on the page ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def subject(tmp_path_factory: pytest.TempPathFactory) -> Subject:
    """A pocket whose part can be drawn."""
    folder = tmp_path_factory.mktemp("pocket")
    write_stl(folder / "block.stl")
    asked = sc.Job.from_dict({**job(**FEEDS).document, "title": "Block"}, folder)
    return Subject.judged(sc.verify(text_of(asked), asked), asked.machine(), "block.ngc")


@pytest.fixture(autouse=True)
def few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of heat maps, which are not looked at here."""
    monkeypatch.setattr(heatmaps, "LIMIT", 20_000)


def test_the_page_shows_both_over_length_with_the_line_of_the_largest(subject: Subject) -> None:
    assert subject.report is not None
    (found,) = subject.report.engagement
    page = Page(report_page(subject))
    figures = found.figures
    assert figures.angle is not None and figures.rate is not None
    labels = [attributes["aria-label"] for tag, attributes in page.tags if attributes.get("role") == "img"]
    assert labels[-3:-1] == ["Engagement angle over length", "Removal rate over length"]  # before the tool
    for words in (
        "pocket-1: what it engages and removes",
        f"Largest angle {figures.angle.value:.2f}° in line {figures.angle.line}",
        f"largest: line {figures.angle.line}",
        f"largest: line {figures.rate.line}",
        f"{100.0 * figures.rate.share:.1f} % of the reference",
        "bound 80°",
        f"does not hold on 2 entries, {sum(entry.length for entry in found.exempt):.1f} mm",
        "engagement angle, °",
        "removal rate, cm³/min",
    ):
        assert words in page.text, words


def test_a_page_of_a_job_without_pockets_shows_none(tmp_path: Path) -> None:
    asked = job_of(tmp_path)
    report = sc.verify(sc.post(sc.plan(asked)).text, asked)
    assert report.engagement == []
    page = report_page(Subject.judged(report, asked.machine(), "rows.ngc"))
    assert "over length" not in page and "Height over time" in page


def test_a_helix_that_is_straightened_is_still_an_entry(subject: Subject) -> None:
    assert subject.job is not None
    posted = whole_lines(text_of(subject.job))
    ramp = roles(posted, "ramp")[0]
    around = next(number for number, line in enumerate(posted) if number > ramp and "Z4" in line.split())
    spoilt = [*posted[: ramp + 1], straight(posted[around]) + " F300", *posted[around + 1 :]]
    report = sc.verify("\n".join([*spoilt, ""]), subject.job)
    (found,) = report.engagement
    assert "steep-entry" in {finding.kind for finding in report.findings}
    assert found.exempt[0].length < 6.0 and found.exempt[0].max_deg > 100.0
