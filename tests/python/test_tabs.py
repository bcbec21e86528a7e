"""Tabs of level loops: planned, posted, read back and verified; each defect planted in the posted text is found."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc

WIDTH, HEIGHT, RADIUS = 3.0, 1.5, 2.0
TABS = {"count": 4, "width": WIDTH, "height": HEIGHT, "slope_deg": 45.0}


def box() -> sc.Part:
    """40 x 30 x 6 mm, its top at Z0."""
    corners = np.array([[x, y, z] for z in (-6.0, 0.0) for x, y in ((0, 0), (40, 0), (40, 30), (0, 30))], dtype=float)
    quads = [(3, 2, 1, 0), (4, 5, 6, 7), *((i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4))]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return sc.Part.from_mesh(corners, triangles, face_ids=np.repeat(np.arange(1, 7), 2))


def job(**keys: Any) -> sc.Job:
    operation = {"kind": "z-level", "tool": "mill", "step": {"height": 1.0}, "fit": "arcs", "direction": "climb"}
    operation |= {"spindle": {"mode": "fixed", "rpm": 8000.0}, "tabs": TABS}
    document = {
        "schema": 1,
        "part": {"file": "box.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"mill": {"profile": {"kind": "flat", "diameter": 2.0 * RADIUS}}},
        "operations": [operation | keys],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=box())


def text_of(job: sc.Job) -> str:
    (text,) = sc.post(sc.plan(job)).files.values()
    return text


def findings(text: str, job: sc.Job) -> set[str]:
    return {finding["kind"] for finding in sc.verify(text, job).to_dict()["findings"]}


@pytest.mark.parametrize("keys", [{}, {"ramp_angle_deg": 5.0}, {"lead": "tangent"}, {"fit": "lines"}], ids=str)
def test_loops_leave_their_tabs_and_nothing_is_found(keys: dict[str, Any]) -> None:
    asked = job(**keys)
    text = text_of(asked)
    assert findings(text, asked) == set()
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    tops = ends[np.abs(ends[:, 2] - (ends[:, 2].min() + HEIGHT)) < 1e-6]
    # the loop goes round 2 mm off the box: its tabs are a quarter of it apart, the first at +X
    centre = np.array([40.0 + RADIUS, 15.0])
    first = tops[np.linalg.norm(tops[:, :2] - centre, axis=1) < WIDTH / 2 + RADIUS + 0.1]
    assert np.allclose(np.unique(np.round(first[:, 1], 1)), [15.0 - 3.5, 15.0 + 3.5], atol=0.11)
    # nothing is cut below a tab's top
    below = ends[ends[:, 2] < ends[:, 2].min() + HEIGHT - 0.01]
    assert np.linalg.norm(below[:, :2] - centre, axis=1).min() >= WIDTH / 2 + RADIUS - 1e-3


def lowered(text: str) -> str:
    """The text with one more move at its end, through a tab."""
    lines = text.splitlines()
    last = max(number for number, line in enumerate(lines) if line.startswith("M5"))
    y = 15.0
    cut = [f"G0 X42 Y{y} Z20", "G1 Z-5 F300", f"G1 Y{y + 1}", "G0 Z20"]
    return "\n".join([*lines[:last], *cut, *lines[last:], ""])


def test_a_tab_that_is_cut_is_found() -> None:
    asked = job()
    assert "tabs" in findings(lowered(text_of(asked)), asked)


def replaced_last(text: str, before: str, after: str) -> str:
    """The text with the last of the places changed."""
    start, end = text.rsplit(before, 1)
    return start + after + end


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("X23.502 Z-4.499\n", "X23.502\n"),
        ("X16.498\n", "X16.6\n"),
        ("X23.502 Z-4.499\n", "X23.4 Z-4.499\n"),
        ("X23.502 Z-4.499\n", "X23.502 Z-4.6\n"),
    ],
    ids=["removed", "too thin", "too thin before", "too low"],
)
def test_a_tab_that_is_changed_in_the_text_is_found(before: str, after: str) -> None:
    asked = job(fit="lines")
    assert "tabs" in findings(replaced_last(text_of(asked), before, after), asked)


@pytest.mark.parametrize(
    "other", [{"count": 3}, {"height": 1.0}, {"height": 2.0}, {"width": 4.0}, {"width": 2.5}], ids=str
)
def test_other_tabs_than_the_jobs_are_found(other: dict[str, Any]) -> None:
    assert "tabs" in findings(text_of(job(tabs=TABS | other)), job())


def test_loops_without_tabs_are_found_and_tabs_that_are_not_asked_for() -> None:
    document = job().to_dict()
    del document["operations"][0]["tabs"]
    plain = sc.Job.from_dict(document, part=box())
    assert "tabs" in findings(text_of(plain), job())
    assert "missing-pass" in findings(text_of(job()), plain)


def test_tabs_that_do_not_fit_are_refused() -> None:
    with pytest.raises(sc.JobError, match="20 tabs"):
        sc.plan(job(tabs=TABS | {"count": 20}))
    with pytest.raises(sc.JobError, match="count and spacing"):
        sc.plan(job(tabs=TABS | {"spacing": 20.0}))
