"""Passes that a text does not have, against programs of which some were taken out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc

SIDE, STEPOVER = 20.0, 3.0


def job_of(operation: dict[str, Any]) -> sc.Job:
    """A pyramid with a square base, milled with a ball that is as wide as the rows are apart."""
    half = SIDE / 2
    vertices = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0], [0, 0, 6.0]])
    triangles = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    document = {
        "schema": 1,
        "part": {"file": "pyramid.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {"ball": {"profile": {"kind": "ball", "diameter": STEPOVER}}},
        "operations": [{"tool": "ball", **operation}],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles))


OPERATIONS = {
    "missing-row": {"kind": "zig-zag", "stepover": STEPOVER},
    "missing-level": {"kind": "z-level", "step": {"height": 1.0}, "z_bottom": -1.0},
}


def without(text: str, kind: str, low: float, high: float) -> tuple[str, int]:
    """A text without the moves at feed whose tip lies between two places, and how many there were.

    What else those lines say, G1 and F, holds for the lines after them and stays.
    """
    axis = "Y" if kind == "missing-row" else "Z"
    place, kept, left = np.inf, [], 0
    for line in text.splitlines():
        words = [] if line.startswith("(") else line.split()
        place = next((float(word[1:]) for word in words if word.startswith(axis)), place)
        inside = low < place < high and any(word[0] in "XYZ" for word in words)
        left += inside
        kept.append(" ".join(word for word in words if word[0] not in "XYZ") if inside else line)
    return "\n".join(kept) + "\n", left


@pytest.mark.parametrize(("high", "severity"), [(1.9, "warning"), (5.9, "error")])
@pytest.mark.parametrize("kind", OPERATIONS)
def test_passes_that_were_taken_out_are_found(kind: str, high: float, severity: str) -> None:
    """A few are a matter of what is left over; without many it is another program."""
    job = job_of(OPERATIONS[kind])
    whole = sc.post(sc.plan(job)).text
    assert not sc.verify(whole, job).findings
    text, left = without(whole, kind, *((0.5, high) if kind == "missing-level" else (-high, high)))
    assert left
    found = {finding["kind"]: finding for finding in sc.verify(text, job).findings}
    assert found[kind]["severity"] == severity
    assert found[kind]["value_mm"] > found[kind]["limit"]
