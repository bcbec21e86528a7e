"""Corners of the path: `max_corner_deg` bounds them where the part is smooth, and the finding `corner` names the others."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
ROUNDING = 0.12
"""What three decimals turn chords of 0.5 mm and more by, degrees."""


ROWS = {"kind": "zig-zag", "stepover": 8.0}
SPINDLE = {"mode": "fixed", "rpm": 8000.0}


def job(part: str, machine: str = "linuxcnc", **keys: Any) -> sc.Job:
    """Rows 8 mm apart, each from rim to rim, milled."""
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / f"{part}.step")},
            "process": {"kind": "milling"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}}},
            "machine": {"name": machine},
            "operations": [
                {
                    "tool": "ball",
                    "tolerance": 0.01,
                    "spindle": SPINDLE,
                    **(keys if "kind" in keys else {**ROWS, **keys}),
                }
            ],
        }
    )


def corners(asked: sc.Job, text: str) -> list[Any]:
    return corners_of(sc.verify(text, asked))


def corners_of(report: sc.Report) -> list[Any]:
    return [finding for finding in report.findings if finding.kind == "corner"]


def largest_in_rows(program: sc.Program) -> float:
    """The largest angle between chords along rows, which run along X, degrees."""
    moves = program.moves
    steps = np.diff(moves["end"], axis=0)
    along = (moves["kind"][1:] != 0) & (np.abs(steps[:, 1]) < 1e-6) & (np.abs(steps[:, 0]) > 0.02)
    both = along[:-1] & along[1:]
    a, b = steps[:-1][both], steps[1:][both]
    angle: np.ndarray = np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))
    return float(angle.max())


def test_smooth_rows_turn_by_no_more_than_asked() -> None:
    keys = {"faces": ["Face1"], "turns": "rounded", "tolerance": 0.03}
    free = sc.plan(job("cap_r60", **keys)).programs["main"]
    assert largest_in_rows(free) > 2.5
    for machine in ("linuxcnc", "grbl"):
        asked = sc.plan(job("cap_r60", machine, max_corner_deg=1.0, **keys)).programs["main"]
        assert largest_in_rows(asked) <= 1.0 + ROUNDING
        assert len(asked.moves) > len(free.moves)


def moves_with_corners(report: sc.Report) -> int:
    """How many moves lie between the first and the last corner of each place."""
    return sum(finding.moves for finding in corners_of(report))


@pytest.mark.parametrize(("kind", "fit"), [("z-level", "lines"), ("spiral", "lines"), ("spiral", "arcs")])
def test_levels_and_spirals_keep_it_but_where_the_tool_plunges(kind: str, fit: str) -> None:
    """On the cone cup's wall, which is smooth round about."""
    keys = {"kind": kind, "fit": fit, "step": {"height": 6.0}, "tolerance": 0.03, "faces": ["Face4"]}
    asked = job("cone_cup", max_corner_deg=2.0, **keys)
    report = sc.verify(sc.post(sc.plan(asked)).text, asked)
    assert report.ok
    assert 0 < moves_with_corners(report) < 10
    if fit == "lines":
        free = sc.post(sc.plan(job("cone_cup", **keys))).text
        assert moves_with_corners(sc.verify(free, asked)) > 100


def test_a_corner_put_into_a_text_is_found_where_it_is() -> None:
    asked = job("cap_r60", max_corner_deg=5.0, faces=["Face1"])
    lines = sc.post(sc.plan(asked)).text.splitlines()
    known = {finding.line for finding in corners(asked, "\n".join(lines))}
    long = [
        number for number in range(40, len(lines) - 40) if lines[number].startswith("X") and "Y" not in lines[number]
    ]
    number = long[len(long) // 2]
    height = float(lines[number].partition("Z")[2])
    lines[number] = lines[number].partition("Z")[0] + f"Z{height + 0.8:.3f}"
    new = [finding for finding in corners(asked, "\n".join(lines)) if finding.line not in known]
    assert new and {number + 1, number + 2} & {finding.line for finding in new}
    assert all(finding.value > finding.limit == 5.0 and finding.unit == "deg" for finding in new)


def test_links_and_edges_of_the_part_are_named() -> None:
    """The rows of a cup with sharp edges, linked straight."""
    asked = job("cap_r60", max_corner_deg=10.0)
    text = sc.post(sc.plan(asked)).text
    found = corners(asked, text)
    assert found and max(finding.value for finding in found) > 45.0
    assert all(finding.severity == "warning" and finding.line for finding in found)
    assert "max_corner_deg is 10.00" in found[0].message
    assert not corners(job("cap_r60"), text)
