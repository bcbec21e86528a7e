"""Seeded defects of posted text: one function per kind, each of which spoils one thing as people and programs do.

A function takes the text and a random generator, and gives the spoilt text, or nothing where the text has no place for
it. Which places matter is not asked here (`matters` says it), but none is chosen that cannot.
"""

from __future__ import annotations

import itertools
import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from gcode import Family, Move, read

Spoil: TypeAlias = Callable[["Text", random.Random], "str | None"]

KINDS: dict[str, Spoil] = {}
"""Every kind of defect by its name."""
NUMBER = r"-?\d*\.?\d+"
MOTION = re.compile(rf"(G[0-3] ?)?([XYZIJ]{NUMBER} ?)+(F{NUMBER})?")
"""A line of nothing but motion and feed: it can stand elsewhere."""


@dataclass(frozen=True)
class Text:
    """A sound text, its lines and its moves."""

    text: str
    family: Family

    @property
    def lines(self) -> list[str]:
        return self.text.splitlines()

    @property
    def moves(self) -> list[Move]:
        return read(self.text, self.family).moves

    @property
    def contacts(self) -> list[Move]:
        """Feed moves that go sideways."""
        return [m for m in self.moves if m.kind != "rapid" and math.dist(m.start[:2], m.end[:2]) > 1e-6]

    def with_line(self, number: int, line: str | None) -> str:
        """The text with a line in the place of another, or without it."""
        lines = self.lines
        lines[number - 1 : number] = [] if line is None else [line]
        return "\n".join(lines) + "\n"

    def numbers_of(self, pattern: str) -> list[int]:
        """Lines, from 1, in which a pattern is found."""
        return [n for n, line in enumerate(self.lines, 1) if "(" not in line and re.search(pattern, line)]

    def replaced(self, number: int, pattern: str, by: str | Callable[[re.Match[str]], str]) -> str:
        return self.with_line(number, re.sub(pattern, by, self.lines[number - 1], count=1))


def kind(function: Spoil) -> Spoil:
    """Registers a kind under its function's name."""
    KINDS[function.__name__.replace("_", " ")] = function
    return function


def _chosen(random_: random.Random, places: list[int]) -> int | None:
    return random_.choice(places) if places else None


def _across(move: Move) -> int:
    """Axis, of X and Y, that is more nearly square to the way of a move."""
    return 0 if abs(move.end[0] - move.start[0]) < abs(move.end[1] - move.start[1]) else 1


def _shifted(text: Text, move: Move, axis: int, by_mm: float) -> str:
    """The move's end shifted along an axis; the word is added where the line has none."""
    inch = move.state.units == "G20"
    value = (move.end[axis] + by_mm) / (25.4 if inch else 1.0)
    word = f"{'XYZ'[axis]}{value:.4f}" if inch else f"{'XYZ'[axis]}{value:.3f}"
    line = text.lines[move.line - 1]
    pattern = rf"{'XYZ'[axis]}{NUMBER}"
    return text.with_line(move.line, re.sub(pattern, word, line) if re.search(pattern, line) else f"{line} {word}")


# Coordinates


@kind
def coordinate_off(text: Text, random_: random.Random) -> str | None:
    """By 0.02 mm, in height where the move changes it, else square to its way."""
    moves = [m for m in text.contacts if math.dist(m.start, m.end) > 0.05]
    if not moves:
        return None
    move = random_.choice(moves)
    axis = _across(move) if move.start[2] == move.end[2] else 2
    return _shifted(text, move, axis, random_.choice([-0.02, 0.02]))


@kind
def height_off(text: Text, random_: random.Random) -> str | None:
    """One Z of a contact move by 0.05 mm, up or down."""
    moves = text.contacts
    return _shifted(text, random_.choice(moves), 2, random_.choice([-0.05, 0.05])) if moves else None


@kind
def level_raised(text: Text, random_: random.Random) -> str | None:
    """The Z of a plunge, and of the level that follows, by 0.05 mm."""
    moves = [m for m in text.moves if m.kind == "feed" and m.end[2] < m.start[2] and m.start[:2] == m.end[:2]]
    return _shifted(text, random_.choice(moves), 2, 0.05) if moves else None


@kind
def level_lowered(text: Text, random_: random.Random) -> str | None:
    """The Z of a plunge, and of the level that follows, by 0.02 mm."""
    moves = [m for m in text.moves if m.kind == "feed" and m.end[2] < m.start[2] and m.start[:2] == m.end[:2]]
    return _shifted(text, random_.choice(moves), 2, -0.02) if moves else None


@kind
def sign_lost(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"[XYZ]-(?=[\d.]*[1-9])0*[1-9\.]"))
    return None if number is None else text.replaced(number, r"([XYZ])-", r"\1")


@kind
def digit_dropped(text: Text, random_: random.Random) -> str | None:
    """The first digit of a number above 1."""
    number = _chosen(random_, text.numbers_of(r"[XYZ]-?[1-9]\d*\.\d"))
    return None if number is None else text.replaced(number, r"([XYZ]-?)[1-9](\d*\.)", r"\g<1>0\2")


@kind
def digits_turned(text: Text, random_: random.Random) -> str | None:
    """Two neighbouring digits after the point change places."""
    number = _chosen(random_, text.numbers_of(r"[XY]-?\d+\.([02468][13579]|[13579][02468])"))
    return None if number is None else text.replaced(number, r"([XY]-?\d+\.)(\d)(\d)", r"\1\3\2")


@kind
def point_lost(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"[XYZ]-?\d+\.\d"))
    return None if number is None else text.replaced(number, r"([XYZ]-?\d+)\.", r"\1")


@kind
def axes_swapped(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(rf"X{NUMBER} Y{NUMBER}"))
    return None if number is None else text.replaced(number, rf"X({NUMBER}) Y({NUMBER})", r"Y\1 X\2")


@kind
def letter_for_digit(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"[XYZ]-?\d+\.\d"))
    return None if number is None else text.replaced(number, r"([XYZ]-?\d+\.)\d", r"\1O")


# Motions


@kind
def rapid_for_feed(text: Text, random_: random.Random) -> str | None:
    """G0 where G1 stands, or before a contact move without a G word."""
    move = random_.choice(text.contacts) if text.contacts else None
    if move is None:
        return None
    line = text.lines[move.line - 1]
    return text.with_line(move.line, line.replace("G1", "G0") if "G1" in line else f"G0 {line}")


@kind
def feed_for_rapid(text: Text, random_: random.Random) -> str | None:
    """Any but the last: that one only lifts the tool."""
    number = _chosen(random_, text.numbers_of(r"\bG0\b")[:-1])
    return None if number is None else text.replaced(number, r"\bG0\b", "G1")


@kind
def plunge_in_rapid(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bG1 Z\S+ F"))
    return None if number is None else text.replaced(number, r"\bG1\b", "G0")


@kind
def rapid_too_deep(text: Text, random_: random.Random) -> str | None:
    """A rapid comes down to a tenth of a millimetre above the place where the plunge ends."""
    pairs = [
        (a, b)
        for a, b in itertools.pairwise(text.moves)
        if a.kind == "rapid" and b.kind == "feed" and a.end[2] < a.start[2]
    ]
    if not pairs:
        return None
    rapid, plunge = random_.choice(pairs)
    return _shifted(text, rapid, 2, plunge.end[2] + 0.1 - rapid.end[2])


@kind
def retract_missing(text: Text, random_: random.Random) -> str | None:
    lifts = [b.line for a, b in itertools.pairwise(text.moves) if b.kind == "rapid" and a.kind == "feed"]
    number = _chosen(random_, lifts)
    return None if number is None else text.with_line(number, None)


@kind
def plunge_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bG1 Z\S+ F"))
    return None if number is None else text.with_line(number, None)


@kind
def approach_missing(text: Text, random_: random.Random) -> str | None:
    """A rapid across is left out."""
    numbers = [m.line for m in text.moves if m.kind == "rapid" and m.start[:2] != m.end[:2]]
    number = _chosen(random_, numbers)
    return None if number is None else text.with_line(number, None)


@kind
def dog_leg(text: Text, random_: random.Random) -> str | None:
    """A rapid across and the rapid down after it in one line."""
    moves = text.moves
    pairs = [
        (a, b)
        for a, b in itertools.pairwise(moves)
        if a.kind == b.kind == "rapid" and b.line == a.line + 1 and b.end[2] < a.end[2] and a.start[:2] != a.end[:2]
    ]
    if not pairs:
        return None
    across, down = random_.choice(pairs)
    joined = f"{text.lines[across.line - 1]} {text.lines[down.line - 1].replace('G0 ', '')}"
    return Text(text.with_line(down.line, None), text.family).with_line(across.line, joined)


@kind
def clearance_lowered(text: Text, random_: random.Random) -> str | None:
    """A rapid lifts to half a millimetre above the last contact instead of the clearance height."""
    moves = text.moves
    lifts = [(a, b) for a, b in itertools.pairwise(moves[:-1]) if b.kind == "rapid" and a.kind == "feed"]
    if not lifts:
        return None
    contact, lift = random_.choice(lifts)
    return _shifted(text, lift, 2, contact.end[2] + 0.5 - lift.end[2])


# Lines and levels


@kind
def corner_missing(text: Text, random_: random.Random) -> str | None:
    """The end of a contact move that turns is left out."""
    contacts = text.contacts
    turns = [a for a, b in itertools.pairwise(contacts) if b.line == a.line + 1 and _turn(a, b) > 0.3]
    number = _chosen(
        random_, [m.line for m in turns if "G" not in text.lines[m.line - 1] and "F" not in text.lines[m.line - 1]]
    )
    return None if number is None else text.with_line(number, None)


def _turn(first: Move, second: Move) -> float:
    """Angle between two moves, rad, where both are longer than a twentieth of a millimetre."""
    a = [e - s for s, e in zip(first.start, first.end, strict=True)]
    b = [e - s for s, e in zip(second.start, second.end, strict=True)]
    if min(math.hypot(*a), math.hypot(*b)) < 0.05:
        return 0.0
    cosine = sum(x * y for x, y in zip(a, b, strict=True)) / (math.hypot(*a) * math.hypot(*b))
    return math.acos(max(-1.0, min(1.0, cosine)))


@kind
def lines_swapped(text: Text, random_: random.Random) -> str | None:
    """Two neighbouring contact moves."""
    contacts = [m for m in text.contacts if "G" not in text.lines[m.line - 1] and "F" not in text.lines[m.line - 1]]
    pairs = [a for a, b in itertools.pairwise(contacts) if b.line == a.line + 1 and _turn(a, b) > 0.3]
    if not pairs:
        return None
    first = random_.choice(pairs).line
    lines = text.lines
    lines[first - 1], lines[first] = lines[first], lines[first - 1]
    return "\n".join(lines) + "\n"


@kind
def line_strayed(text: Text, random_: random.Random) -> str | None:
    """A contact move stands a second time, a third of the program away."""
    contacts = [m.line for m in text.contacts if "X" in text.lines[m.line - 1] and "Y" in text.lines[m.line - 1]]
    if len(contacts) < 6:
        return None
    place = random_.randrange(len(contacts))
    lines = text.lines
    lines.insert(contacts[(place + len(contacts) // 3) % len(contacts)], lines[contacts[place] - 1])
    return "\n".join(lines) + "\n"


def _blocks(text: Text) -> list[tuple[int, int]]:
    """Levels, as first and last line: from the end of the level before to the end of its own; the first is left out.

    Where there are none, as in rows over a surface: stretches between two lifts.
    """
    ends = _ends_of_levels(text.moves)
    if len(ends) < 3:
        ends = [a.line for a, b in itertools.pairwise(text.moves) if a.kind != "rapid" and b.kind == "rapid"]
    blocks = [(first + 1, last) for first, last in itertools.pairwise(ends)]
    return [(a, b) for a, b in blocks if all(MOTION.fullmatch(line) for line in text.lines[a - 1 : b])]


def _ends_of_levels(moves: list[Move]) -> list[int]:
    """Lines on which level stretches of three moves and more end."""
    ends, count = [], 0
    for move, following in zip(moves, [*moves[1:], None], strict=True):
        level = move.kind != "rapid" and move.start[2] == move.end[2]
        count = count + 1 if level else 0
        goes_on = following is not None and following.kind != "rapid" and following.end[2] == move.end[2]
        if count >= 3 and not goes_on:
            ends.append(move.line)
    return ends


@kind
def level_skipped(text: Text, random_: random.Random) -> str | None:
    blocks = _blocks(text)
    if not blocks:
        return None
    first, last = random_.choice(blocks)
    lines = text.lines
    return "\n".join(lines[: first - 1] + lines[last:]) + "\n"


@kind
def level_repeated(text: Text, random_: random.Random) -> str | None:
    """A level stands a second time at the end, below all others."""
    blocks = _blocks(text)
    if len(blocks) < 2:
        return None
    first, last = random_.choice(blocks[:-1])
    lines, end = text.lines, blocks[-1][1]
    return "\n".join(lines[:end] + lines[first - 1 : last] + lines[end:]) + "\n"


@kind
def levels_swapped(text: Text, random_: random.Random) -> str | None:
    blocks = _blocks(text)
    pairs = [(a, b) for a, b in itertools.pairwise(blocks) if b[0] == a[1] + 1]
    if not pairs:
        return None
    (first, middle), (_, last) = random_.choice(pairs)
    lines = text.lines
    return "\n".join(lines[: first - 1] + lines[middle:last] + lines[first - 1 : middle] + lines[last:]) + "\n"


@kind
def cut_short(text: Text, random_: random.Random) -> str | None:
    """The program ends in the middle, properly."""
    blocks = _blocks(text)
    if len(blocks) < 2:
        return None
    first = random_.choice(blocks)[0]
    lift = max(move.end[2] for move in text.moves) / (25.4 if text.moves[0].state.units == "G20" else 1.0)
    return "\n".join(text.lines[: first - 1]) + f"\nG0 Z{lift:.3f}\nM5\nM9\nM2\n"


# Feeds, spindle, states


def _feeds(text: Text) -> list[int]:
    return text.numbers_of(rf"F{NUMBER}$")


def _feed_times(text: Text, random_: random.Random, factor: float) -> str | None:
    number = _chosen(random_, _feeds(text))
    if number is None:
        return None
    feed = float(re.search(rf"F({NUMBER})$", text.lines[number - 1])[1])  # type: ignore[index]
    return text.replaced(number, rf"F{NUMBER}$", f"F{feed * factor:g}")


@kind
def feed_times_ten(text: Text, random_: random.Random) -> str | None:
    return _feed_times(text, random_, 10.0)


@kind
def feed_by_ten(text: Text, random_: random.Random) -> str | None:
    return _feed_times(text, random_, 0.1)


@kind
def feed_zero(text: Text, random_: random.Random) -> str | None:
    return _feed_times(text, random_, 0.0)


@kind
def feed_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, _feeds(text))
    return None if number is None else text.replaced(number, rf" F{NUMBER}$", "")


def _header(text: Text, pattern: str, by: str) -> str | None:
    numbers = text.numbers_of(pattern)
    if not numbers:
        return None
    line = re.sub(pattern, by, text.lines[numbers[0] - 1], count=1).strip()
    return text.with_line(numbers[0], line or None)


@kind
def units_removed(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"G2[01]\b ?", "")


@kind
def units_swapped(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"G21\b", "G20") or _header(text, r"G20\b", "G21")


@kind
def units_change(text: Text, random_: random.Random) -> str | None:
    """The other unit from the middle on."""
    other = "G20" if text.numbers_of(r"\bG21\b") else "G21"
    numbers = [m.line for m in text.contacts if "F" not in text.lines[m.line - 1]]
    number = _chosen(random_, numbers)
    return None if number is None else text.with_line(number, f"{other} {text.lines[number - 1]}")


@kind
def incremental(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"G90\b", "G91")


@kind
def incremental_from_here(text: Text, random_: random.Random) -> str | None:
    numbers = [m.line for m in text.contacts]
    number = _chosen(random_, numbers)
    return None if number is None else text.with_line(number, f"G91 {text.lines[number - 1]}")


@kind
def work_plane(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"G17\b", random_.choice(["G18", "G19"]))


@kind
def work_offset(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"^G5[4-6]\b", random_.choice(["G57", "G58", "G59"]))


@kind
def tool_number(text: Text, random_: random.Random) -> str | None:
    """Another tool of the job, or one that it does not have."""
    numbers = text.numbers_of(r"^T\d+")
    if not numbers:
        return None
    number = random_.choice(numbers)
    tool = int(re.search(r"T(\d+)", text.lines[number - 1])[1])  # type: ignore[index]
    return text.replaced(number, r"T\d+", f"T{3 - tool if tool in (1, 2) else tool + 1}")


@kind
def tool_change_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"^T\d+ M6"))
    return None if number is None else text.with_line(number, None)


@kind
def length_offset(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"^G43 H\d+"))
    return None if number is None else text.replaced(number, r"H(\d)", r"H\g<1>0")


@kind
def length_offset_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"^G43 H\d+"))
    return None if number is None else text.with_line(number, None)


@kind
def path_tolerance(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"^G64 P\S+", "G64 P0.5")


@kind
def path_tolerance_missing(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"^G64 .*$", "")


@kind
def spindle_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bM[34]\b"))
    return None if number is None else text.with_line(number, None)


@kind
def spindle_turned(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bM[34]\b"))
    return (
        None if number is None else text.replaced(number, r"\bM([34])\b", lambda word: "M4" if word[1] == "3" else "M3")
    )


@kind
def spindle_speed(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bS\d+"))
    return None if number is None else text.replaced(number, r"S(\d+)", r"S\g<1>0")


@kind
def spindle_on(text: Text, random_: random.Random) -> str | None:
    """A stylus that should stand turns."""
    number = _chosen(random_, text.numbers_of(r"^M5$"))
    return None if number is None else text.with_line(number, "S5000 M3")


@kind
def coolant_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"\bM8\b"))
    return None if number is None else text.with_line(number, None)


@kind
def dwell(text: Text, random_: random.Random) -> str | None:
    """The tool stands on the part for a minute."""
    numbers = [m.line for m in text.contacts]
    number = _chosen(random_, numbers)
    return None if number is None else text.with_line(number, f"G4 P60\n{text.lines[number - 1]}")


@kind
def end_missing(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"^M(2|30)$"))
    return None if number is None else text.with_line(number, None)


@kind
def program_stop(text: Text, random_: random.Random) -> str | None:
    """The tool waits on the part until somebody comes."""
    number = _chosen(random_, [m.line for m in text.contacts])
    return None if number is None else text.with_line(number, f"M0\n{text.lines[number - 1]}")


@kind
def spindle_stops(text: Text, random_: random.Random) -> str | None:
    """M5 among the cuts."""
    number = _chosen(random_, [m.line for m in text.contacts if m.state.spindle != "M5"])
    return None if number is None else text.with_line(number, f"M5\n{text.lines[number - 1]}")


@kind
def end_early(text: Text, random_: random.Random) -> str | None:
    """M2 among the cuts; LinuxCNC does not look at what follows."""
    if text.family != "linuxcnc":
        return None
    number = _chosen(random_, [m.line for m in text.contacts])
    return None if number is None else text.with_line(number, f"M2\n{text.lines[number - 1]}")


@kind
def percent_inside(text: Text, random_: random.Random) -> str | None:
    """Two programs in one file: the first one's last % ends the text."""
    if text.family != "linuxcnc":
        return None
    number = _chosen(random_, [m.line for m in text.contacts])
    return None if number is None else "%\n" + text.with_line(number, f"%\n{text.lines[number - 1]}")


@kind
def block_deleted(text: Text, random_: random.Random) -> str | None:
    """A slash before the lift, which LinuxCNC skips."""
    lifts = [b.line for a, b in itertools.pairwise(text.moves) if b.kind == "rapid" and a.kind != "rapid"]
    number = _chosen(random_, lifts) if text.family == "linuxcnc" else None
    return None if number is None else text.with_line(number, f"/{text.lines[number - 1]}")


@kind
def newline_lost(text: Text, random_: random.Random) -> str | None:
    """Two moves in one line."""
    pairs = [a.line for a, b in itertools.pairwise(text.contacts) if b.line == a.line + 1]
    number = _chosen(random_, pairs)
    if number is None:
        return None
    joined = f"{text.lines[number - 1]} {text.lines[number]}"
    return Text(text.with_line(number + 1, None), text.family).with_line(number, joined)


@kind
def commented_out(text: Text, random_: random.Random) -> str | None:
    """A lift or a rapid across in brackets."""
    rapids = [m for m in text.moves if m.kind == "rapid" and (m.end[2] > m.start[2] or m.end[:2] != m.start[:2])]
    number = _chosen(random_, [m.line for m in rapids])
    return None if number is None else text.with_line(number, f"({text.lines[number - 1]})")


@kind
def decimal_comma(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"[XYZ]-?\d+\.\d"))
    return None if number is None else text.replaced(number, r"([XYZ]-?\d+)\.", r"\1,")


@kind
def offset_by_g92(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, [m.line for m in text.moves])
    return None if number is None else text.with_line(number, f"G92 X0.1\n{text.lines[number - 1]}")


@kind
def inverse_time(text: Text, random_: random.Random) -> str | None:
    return _header(text, r"G94\b", "G93")


@kind
def comment_open(text: Text, random_: random.Random) -> str | None:
    numbers = [n for n, line in enumerate(text.lines, 1) if line.endswith(")")]
    number = _chosen(random_, numbers)
    return None if number is None else text.with_line(number, text.lines[number - 1][:-1])


# Arcs


@kind
def arc_turned(text: Text, random_: random.Random) -> str | None:
    """G2 for G3, or the other way round, where that is not the same circle."""
    arcs = [m for m in text.moves if m.kind == "arc" and m.start != m.end]
    if not arcs:
        return None
    arc = random_.choice(arcs)
    other = "G3" if arc.sense < 0 else "G2"
    line = re.sub(r"\bG[23]\b ?", "", text.lines[arc.line - 1])
    return text.with_line(arc.line, f"{other} {line}")


@kind
def arc_centre(text: Text, random_: random.Random) -> str | None:
    """I or J by 0.02 mm: a whole circle is another one then, and LinuxCNC still takes some other arcs."""
    number = _chosen(random_, text.numbers_of(r"[IJ]-?[\d.]*[1-9]"))
    if number is None:
        return None
    by = random_.choice([-0.02, 0.02]) / (25.4 if text.numbers_of(r"\bG20\b") else 1.0)
    word, value = random_.choice(re.findall(rf"([IJ])({NUMBER})", text.lines[number - 1]))
    return text.replaced(number, rf"{word}{NUMBER}", f"{word}{float(value) + by:.4f}")


@kind
def arc_centre_sign(text: Text, random_: random.Random) -> str | None:
    number = _chosen(random_, text.numbers_of(r"[IJ]-?[\d.]*[1-9]"))
    return None if number is None else text.replaced(number, rf"([IJ])(-?)({NUMBER})", _minus)


def _minus(match: re.Match[str]) -> str:
    return f"{match[1]}{'' if match[2] else '-'}{match[3]}"


@kind
def arc_straightened(text: Text, random_: random.Random) -> str | None:
    """G1 for an arc: its chord."""
    arcs = [m for m in text.moves if m.kind == "arc" and m.start != m.end]
    if not arcs:
        return None
    number = random_.choice(arcs).line
    line = re.sub(r"\bG[23]\b ?|[IJ]\S+ ?", "", text.lines[number - 1]).strip()
    return text.with_line(number, f"G1 {line}")
