"""Klartext in the words of the other families and back, line by line, so that defects are the same in all of them.

`L X+1 Y-2 R0 F100` is `G1 X1 Y-2 F100` here, FMAX is G0; all other blocks keep their words. Block numbers are left out, and
counted anew when the text is written: nobody can spoil a program by its numbers alone.
"""

from __future__ import annotations

import re

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
AXIS = re.compile(r"([XYZ])\+?(\S+)")
MOTION = re.compile(r"^(G\d+ )*(G[01]\b|[XYZ][\d.+-])")


def undressed(text: str) -> str:
    """Klartext in plain words; as many lines."""
    return "\n".join(map(_undressed, text.splitlines())) + "\n"


def _undressed(line: str) -> str:
    code = re.sub(r"^\d+ ", "", line)
    if not code.startswith("L "):
        return code
    words = [AXIS.sub(r"\1\2", word) for word in code.split()[1:] if word not in ("R0", "FMAX")]
    return " ".join(["G0" if "FMAX" in code else "G1", *words])


def dressed(text: str) -> str:
    """Plain words in Klartext, with block numbers; only what goes on from the line before has none."""
    lines: list[str] = []
    number = 0
    goes_on = False
    for line in text.splitlines():
        if goes_on:
            lines.append(line)
        else:
            skipped = "/" if line.startswith("/") else ""
            lines.append(f"{skipped}{number} {_dressed(line.removeprefix('/'))}")
            number += 1
        goes_on = line.endswith("~")
    return "\n".join(lines) + "\n"


def _dressed(line: str) -> str:
    code, semicolon, remark = line.partition(";")
    if not MOTION.match(code):
        return f"{code}{semicolon}{_dressed(remark.strip()) if MOTION.match(remark.strip()) else remark}"
    chunks = re.split(r" (?=G[01]\b)", code.strip())
    joined = re.fullmatch(r"(G91 )?.*", code) is not None and chunks[0] == "G91"
    blocks = [" ".join(chunks[:2]), *chunks[2:]] if joined else chunks
    return " ".join(map(_block, blocks)) + (f" {semicolon}{remark}" if semicolon else "")


def _block(words: str) -> str:
    """One motion."""
    codes = [word for word in words.split() if re.fullmatch(r"G\d+", word)]
    rest = [word for word in words.split() if word not in codes]
    axes = [_signed(word, incremental="G91" in codes) for word in rest if word[0] in "XYZ"]
    others = [word for word in rest if word[0] not in "XYZ"]
    side = [word for word in others if word in ("RL", "RR")] or ["R0"]
    feeds = ["FMAX"] if "G0" in codes else [word for word in others if word.startswith("F")]
    return " ".join(["L", *axes, *side, *feeds, *(word for word in others if word.startswith("M"))])


def _signed(word: str, *, incremental: bool) -> str:
    sign = "" if word[1:2] == "-" else "+"
    return f"{'I' if incremental else ''}{word[0]}{sign}{word[1:]}"
