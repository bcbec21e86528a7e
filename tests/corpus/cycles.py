"""Canned drilling cycles as plain moves, line for line, for a reader that knows none.

G81, G82, G83 and G73 with G98, by LinuxCNC's manual ("G Code Reference", canned cycles): over the hole at rapid, down to R at
rapid, down to Z at feed, and back up to where the tool was before the first of them. How pecks go up and down in between moves
the tool where it was already: they are left out.
"""

from __future__ import annotations

import re

CYCLE = re.compile(r"^(?:G98 )?G(?:81|82|83|73)(?= )(?P<words>.*)$")
WORD = re.compile(r"([A-Z])(-?[\d.]+)")
HOLE = re.compile(r"^(?:[XYZR]-?[\d.]+ ?)+$")
TO_Z = re.compile(r"^(?:G0 |G1 )?(?:[XY]-?[\d.]+ )*Z(-?[\d.]+)")


def expanded(text: str) -> tuple[str, list[int]]:
    """The text without cycles, and the line of the given one from which each of its lines comes."""
    lines: list[str] = []
    numbers: list[int] = []
    held: dict[str, str] = {}
    top = "0"
    for number, line in enumerate(text.splitlines(), start=1):
        found = CYCLE.match(line)
        if found or (held and HOLE.match(line)):
            held |= dict(WORD.findall(found["words"] if found else line))
            moves = [f"G0 X{held['X']} Y{held['Y']}", f"Z{held['R']}", f"G1 Z{held['Z']} F{held['F']}", f"G0 Z{top}"]
        else:
            if line.startswith("G80"):
                held = {}
            if placed := TO_Z.match(line):
                top = placed[1]
            moves = [line]
        lines += moves
        numbers += [number] * len(moves)
    return "\n".join(lines) + "\n", numbers
