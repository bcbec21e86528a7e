"""Drilled holes: edits of a word, and lines left out, by which the drill breaks or the hole is not made, are found."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

import styluscam as sc
from gcode import Move, read

from .cases import stack

DEPTH, PECK, RADIUS = 6.0, 2.0, 2.5
NEAR = 0.02
"""Edits that change less do not matter, mm."""
LEAST = 50
"""Edits that matter, at least."""


def job(cycle: dict[str, Any]) -> sc.Job:
    """A round block with a blind hole in its middle, its floor flat, on a machine without cycles."""
    sides = 48
    vertices, triangles = stack(sides, [(9, -8), (9, 0), (RADIUS, 0), (RADIUS, -DEPTH)])
    faces = [1 + min(number // (2 * sides), 3) for number in range(len(triangles))]
    document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {"zero": "model", "clearance": 10.0, "retract": 5.0},
        "process": {"kind": "milling"},
        "tools": {"drill": {"number": 1, "profile": {"kind": "v", "diameter": 2 * RADIUS, "angle_deg": 118.0}}},
        "operations": [
            {
                "kind": "drill",
                "tool": "drill",
                "cycle": cycle,
                "feeds": {"plunge": 200.0},
                "spindle": {"mode": "fixed", "rpm": 3000.0},
            }
        ],
        "machine": {"name": "grbl"},
    }
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(vertices, triangles, face_ids=faces))


def harm(moves: list[Move], peck: float) -> str:
    """What is wrong with the hole, or with the way to it."""
    drilled = 0.0
    begun: float | None = None
    for move in moves:
        if not move.placed:
            continue
        (x, y, high), (to_x, to_y, low) = move.start, move.end
        is_down = low < high and math.hypot(to_x - x, to_y - y) < 1e-6
        if min(high, low) < -NEAR and max(math.hypot(x, y), math.hypot(to_x, to_y)) > NEAR:
            return "beside the hole"
        if low < -DEPTH - NEAR:
            return "too deep"
        if move.kind == "rapid" and low < high and low < drilled - NEAR:
            return "a rapid into material"
        if move.kind == "rapid" or not is_down:
            begun = None
            continue
        begun = min(high, drilled) if begun is None else begun
        if begun - low > peck + NEAR:
            return "a peck too deep"
        drilled = min(drilled, low)
    return "not drilled to its depth" if drilled > -DEPTH + NEAR else ""


def edits(text: str) -> list[str]:
    """Texts with one word changed, or one line left out."""
    lines = text.splitlines()
    made = []
    for number, line in enumerate(lines):
        others = [""]
        for word in re.finditer(r"\b([XYZ])(-?[\d.]+)", line):
            value = float(word[2])
            changed = [value + 0.1, value - 0.1, value + 1.5, value - 1.5, -value, 10 * value, value / 10]
            others += [f"{line[: word.start()]}{word[1]}{new:.3f}{line[word.end() :]}" for new in changed]
        if re.search(r"\bG[01]\b", line):
            others.append(re.sub(r"\bG([01])\b", lambda code: f"G{1 - int(code[1])}", line))
        made += ["\n".join([*lines[:number], other, *lines[number + 1 :], ""]) for other in others]
    return made


@pytest.mark.parametrize("kind", ["drill", "peck", "chip-break"])
def test_every_edit_that_matters_is_found(kind: str) -> None:
    cycle = {"kind": kind} if kind == "drill" else {"kind": kind, "peck": PECK}
    asked, peck = job(cycle), math.inf if kind == "drill" else PECK
    text = sc.post(sc.plan(asked)).text
    assert sc.verify(text, asked).ok and harm(read(text, "grbl").moves, peck) == ""
    matter = {edit: harm(read(edit, "grbl").moves, peck) for edit in edits(text)}
    matter = {edit: reason for edit, reason in matter.items() if reason}
    assert len(matter) >= (LEAST if kind != "drill" else LEAST // 3)
    missed = []
    for edit, reason in matter.items():
        try:
            found = any(finding["severity"] == "error" for finding in sc.verify(edit, asked).findings)
        except sc.StylusError:
            continue
        if not found:
            missed.append(
                (
                    reason,
                    [pair for pair in zip(text.splitlines(), edit.splitlines(), strict=False) if len(set(pair)) > 1],
                )
            )
    assert missed == []
