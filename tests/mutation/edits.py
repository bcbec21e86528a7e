"""Edits of a posted text: one word changed, or one line left out; and those of them that matter and are not found."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import styluscam as sc
from gcode import Move, read

MOST = 300
"""So many edits of a text are tried at most."""
Harm = Callable[[list[Move]], str]
"""What is wrong with moves, in words; empty where nothing is."""


def edits(text: str) -> list[str]:
    """Texts with one word changed, or one line left out."""
    lines = text.splitlines()
    made = []
    for number, line in enumerate(lines):
        others = [""]
        for word in re.finditer(r"\b([XYZIJ])(-?[\d.]+)", line):
            value = float(word[2])
            changed = [value + 0.1, value - 0.1, value + 1.5, value - 1.5, -value, 10 * value, value / 10]
            others += [f"{line[: word.start()]}{word[1]}{new:.3f}{line[word.end() :]}" for new in changed]
        if re.search(r"\bG[01]\b", line):
            others.append(re.sub(r"\bG([01])\b", lambda code: f"G{1 - int(code[1])}", line))
        made += ["\n".join([*lines[:number], other, *lines[number + 1 :], ""]) for other in others]
    return made


def assert_found(asked: sc.Job, harm: Harm, least: int) -> None:
    """The program of a job does no harm and is sound; of its edits at least so many do harm, and an error is found in each."""
    text = sc.post(sc.plan(asked)).text
    assert sc.verify(text, asked).ok
    assert harm(read(text, "grbl").moves) == ""
    made = edits(text)
    made = random.Random(0).sample(made, min(len(made), MOST))
    matter = {edit: harm(read(edit, "grbl").moves) for edit in made}
    matter = {edit: reason for edit, reason in matter.items() if reason}
    assert len(matter) >= least
    missed = []
    for edit, reason in matter.items():
        try:
            found = any(finding["severity"] == "error" for finding in sc.verify(edit, asked).findings)
        except sc.StylusError:
            continue
        if not found:
            pairs = zip(text.splitlines(), edit.splitlines(), strict=False)
            missed.append((reason, [pair for pair in pairs if len(set(pair)) > 1]))
    assert missed == []
