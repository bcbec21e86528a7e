"""The meridian as lines, arcs and conics: within its tolerance of the profile, and exact where the profile is one."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.tools import starters
from styluscam.tools.spans import TOLERANCE, Span, spans

EXACT = {"ball": 1, "parabola": 1, "ellipse": 1, "bull-nose": 2, "rounded-rectangle": 2, "barrel": 2, "cone": 2,
         "tapered-ball": 2, "v": 2, "flat": 1}  # fmt: skip
"""Kinds that are lines and conics, and how many."""

MORE: dict[str, dict[str, Any]] = {
    "clothoid with a flat": {"kind": "clothoid", "diameter": 10.0, "tip_flat": 1.0},
    "clothoid by its scale": {"kind": "clothoid", "scale": 5.0, "end_slope_deg": 50.0},
    "blunt power": {"kind": "power", "coefficient": 0.02, "exponent": 1.5, "diameter": 20.0},
    "measured": {
        "kind": "points",
        "points": [[r / 10, (r / 10) ** 3 * 0.02] for r in range(60)],
        "fit_tolerance": 1e-3,
    },
}

PROFILES = {**starters.profiles(), **MORE}


def points_on(span: Span, count: int = 2001) -> Any:
    """Points (count, 2) of a span."""
    share = np.linspace(0.0, 1.0, count)[:, None]
    a, b = np.array(span.start), np.array(span.end)
    if span.control is None:
        return a + share * (b - a)
    by_a, by_control, by_b = (1 - share) ** 2, 2 * span.weight * share * (1 - share), share**2
    return (by_a * a + by_control * np.array(span.control) + by_b * b) / (by_a + by_control + by_b)


def distance(points: Any, line: Any) -> float:
    """The largest distance (mm) of points to a line through points."""
    start, side = line[:-1], np.diff(line, axis=0)
    square = np.sum(side**2, axis=1)
    start, side, square = start[square > 0], side[square > 0], square[square > 0]
    largest = 0.0
    for point in points:
        share = np.clip(np.sum((point - start) * side, axis=1) / square, 0.0, 1.0)
        gap = np.hypot(*(start + share[:, None] * side - point).T)
        largest = max(largest, float(gap.min()))
    return largest


@pytest.mark.parametrize("name", sorted(PROFILES))
def test_spans_lie_on_the_profile(name: str) -> None:
    tool = sc.Tool.from_dict({"profile": PROFILES[name]})
    found = spans(tool)
    assert found[0].start == (0.0, 0.0)
    assert found[-1].end[0] == pytest.approx(tool.diameter / 2.0, abs=1e-9)
    assert all(one.end == next_.start for one, next_ in itertools.pairwise(found))
    drawn = np.concatenate([points_on(span) for span in found])
    slopes = np.linspace(0.0, tool.max_slope, 301)
    asked = np.stack([tool.radius_at(slopes), tool.height_at(slopes)], axis=1)
    assert distance(asked, drawn) <= 1.2 * TOLERANCE  # the drawn line's own chords deviate by 1e-6
    assert len(found) <= 14


@pytest.mark.parametrize("kind", sorted(EXACT))
def test_lines_and_conics_are_exact(kind: str) -> None:
    tool = sc.Tool.from_dict({"profile": PROFILES[kind]})
    found = spans(tool)
    assert len(found) == EXACT[kind]
    for span in found:
        inside = points_on(span, 31)[1:-1]
        if span.control is None or span.end[1] == span.start[1]:
            continue
        assert np.allclose(tool.height_at_radius(inside[:, 0]), inside[:, 1], rtol=0.0, atol=1e-9), kind


@pytest.mark.parametrize("kind", ["ball", "barrel", "bull-nose"])
def test_circles_are_arcs(kind: str) -> None:
    found = [span for span in spans(sc.Tool.from_dict({"profile": PROFILES[kind]})) if span.control is not None]
    assert found and all(span.middle is not None for span in found)


def test_an_ellipse_is_no_arc() -> None:
    (span,) = spans(sc.Tool.from_dict({"profile": {"kind": "ellipse", "radial": 6.0, "axial": 4.0}}))
    assert span.middle is None
    assert span.control == pytest.approx((6.0, 0.0))
    assert span.weight == pytest.approx(math.sqrt(0.5))


def test_a_coarser_tolerance_takes_fewer_spans() -> None:
    tool = sc.Tool.from_dict({"profile": PROFILES["clothoid"]})
    assert len(spans(tool, 1e-2)) < len(spans(tool)) < len(spans(tool, 1e-8))
