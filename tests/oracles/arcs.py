"""Turns the level loops of a sound program about an axis into arcs, rounded as the machine rounds.

Within a pit the arc runs on the least radius of the loop's corners, around a bump on the largest: on the free side, where
the chords were. Sources as in `gcode`.
"""

from __future__ import annotations

import itertools
import math
import re

from controllers import Family
from gcode import Move, read


def with_arcs(text: str, family: Family, axis: tuple[float, float], *, inside: bool, pieces: int) -> str:
    """The text with every closed level loop about an axis (X, Y in mm) as so many arcs, one of which is a full circle."""
    lines = text.splitlines()
    moves = read(text, family).moves
    for loop in reversed(_loops(moves)):
        _put(lines, loop, _arrival(moves, loop), _arcs(loop, axis, inside, pieces))
    return "\n".join(lines) + "\n"


def _loops(moves: list[Move]) -> list[list[Move]]:
    """Runs of level feed moves that end where they start."""
    loops: list[list[Move]] = []
    run: list[Move] = []
    for move in moves:
        level = move.kind == "feed" and move.start[2] == move.end[2]
        if not level:
            run = []
            continue
        run.append(move)
        if len(run) > 2 and math.dist(run[0].start, move.end) < 1e-9:
            loops.append(run)
            run = []
    return loops


def _arrival(moves: list[Move], loop: list[Move]) -> Move:
    """The last move before a loop that goes sideways: it ends over the loop's start or on it."""
    before = moves[: moves.index(loop[0])]
    return next(move for move in reversed(before) if move.start[:2] != move.end[:2])


def _arcs(loop: list[Move], axis: tuple[float, float], inside: bool, pieces: int) -> list[str]:
    """The words of the start of the loop, then of each arc."""
    inch = loop[0].state.units == "G20"
    scale, decimals = (25.4, 4) if inch else (1.0, 3)
    corners = [(m.end[0] - axis[0], m.end[1] - axis[1]) for m in loop]
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    sense = 1 if area > 0 else -1
    radii = [math.hypot(*corner) for corner in corners]
    radius = min(radii) if inside else max(radii)
    first = math.atan2(loop[0].start[1] - axis[1], loop[0].start[0] - axis[0])

    def rounded(value: float) -> float:
        return round(value / scale, decimals) + 0.0

    points = []
    for piece in range(pieces + 1):
        turn = first + sense * 2 * math.pi * (piece % pieces) / pieces
        points.append((rounded(axis[0] + radius * math.cos(turn)), rounded(axis[1] + radius * math.sin(turn))))
    code = "G3" if sense > 0 else "G2"
    words = [f"X{points[0][0]:g} Y{points[0][1]:g}"]
    for (x, y), (end_x, end_y) in itertools.pairwise(points):
        i, j = rounded(axis[0] - x * scale), rounded(axis[1] - y * scale)
        words.append(f"{code} X{end_x:g} Y{end_y:g} I{i:g} J{j:g}")
    return words


def _put(lines: list[str], loop: list[Move], arrival: Move, words: list[str]) -> None:
    """The arcs instead of the loop's lines; the arrival ends where they start, and what follows states G1 again."""
    feed = re.search(r"F\S+", lines[loop[0].line - 1])
    first, last = loop[0].line - 1, loop[-1].line
    arcs = [words[1] + (f" {feed[0]}" if feed else ""), *words[2:]]
    if last < len(lines) and re.match(r"[XYZ]", lines[last]):
        lines[last] = f"G1 {lines[last]}"
    lines[first:last] = arcs
    lines[arrival.line - 1] = _placed(lines[arrival.line - 1], words[0])


def _placed(line: str, point: str) -> str:
    """The line with another X and Y."""
    rest = re.sub(r"[XY]\S+ ?", "", line).strip()
    code = re.match(r"G[01]\b", rest)
    return f"{code[0]} {point} {rest[code.end() :].strip()}".strip() if code else f"{point} {rest}".strip()
