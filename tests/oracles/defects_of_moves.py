"""Defects of coordinates, motions, lines, levels and arcs."""

from __future__ import annotations

import itertools
import math
import random
import re
import statistics

from controllers import REPEATS
from gcode import Move
from spoiling import MOTION, NUMBER, Text, chosen, kind, kind_but, respelt, shifted, without

ONE_ROW = 0.02
"""Contacts whose positions across differ by less, mm, are on one row."""


def _across(move: Move) -> int:
    """Axis, of X and Y, that is more nearly square to the path of a move."""
    return 0 if abs(move.end[0] - move.start[0]) < abs(move.end[1] - move.start[1]) else 1


# Coordinates


@kind
def coordinate_off(text: Text, random_: random.Random) -> str | None:
    """By 0.02 mm, in height where the move changes it, else square to its path."""
    moves = [m for m in text.contacts if math.dist(m.start, m.end) > 0.05]
    if not moves:
        return None
    move = random_.choice(moves)
    axis = _across(move) if move.start[2] == move.end[2] else 2
    return shifted(text, move, axis, random_.choice([-0.02, 0.02]))


@kind
def height_off(text: Text, random_: random.Random) -> str | None:
    """One Z of a contact move by 0.05 mm, up or down."""
    moves = text.contacts
    return shifted(text, random_.choice(moves), 2, random_.choice([-0.05, 0.05])) if moves else None


@kind
def level_raised(text: Text, random_: random.Random) -> str | None:
    """The Z of a plunge, and of the level that follows, by 0.05 mm."""
    return shifted(text, random_.choice(text.plunges), 2, 0.05) if text.plunges else None


@kind
def level_lowered(text: Text, random_: random.Random) -> str | None:
    """The Z of a plunge, and of the level that follows, by 0.02 mm."""
    return shifted(text, random_.choice(text.plunges), 2, -0.02) if text.plunges else None


@kind
def sign_lost(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"[XYZ]-(?=[\d.]*[1-9])0*[1-9\.]", r"([XYZ])-", r"\1")


@kind
def digit_dropped(text: Text, random_: random.Random) -> str | None:
    """The first digit of a number above 1."""
    return respelt(text, random_, r"[XYZ]-?[1-9]\d*\.\d", r"([XYZ]-?)[1-9](\d*\.)", r"\g<1>0\2")


@kind
def digits_turned(text: Text, random_: random.Random) -> str | None:
    """Two neighbouring digits after the point are swapped."""
    return respelt(text, random_, r"[XY]-?\d+\.([02468][13579]|[13579][02468])", r"([XY]-?\d+\.)(\d)(\d)", r"\1\3\2")


@kind
def point_lost(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"[XYZ]-?\d+\.\d", r"([XYZ]-?\d+)\.", r"\1")


@kind
def axes_swapped(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, rf"X{NUMBER} Y{NUMBER}", rf"X({NUMBER}) Y({NUMBER})", r"Y\1 X\2")


@kind
def letter_for_digit(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"[XYZ]-?\d+\.\d", r"([XYZ]-?\d+\.)\d", r"\1O")


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
    """Any that goes across, or down where the word holds on."""
    rapids = [m for m in text.moves if m.kind == "rapid" and m.placed and not _lifts(m)]
    if text.family in REPEATS:
        rapids = [m for m in rapids if m.start[:2] != m.end[:2]]
    stated = [_stated(text, m.line) for m in rapids]
    number = chosen(random_, [line for line in stated if line])
    return None if number is None else text.replaced(number, r"\bG0\b", "G1")


def _lifts(move: Move) -> bool:
    return move.start[:2] == move.end[:2] and move.end[2] > move.start[2]


def _stated(text: Text, number: int) -> int:
    """The line on which the G0 of a rapid stands; 0 where other words stand with it."""
    while number > 1 and not re.search(r"\bG\d+\b", text.lines[number - 1]):
        number -= 1
    return number if re.search(r"\bG0\b", text.lines[number - 1]) else 0


@kind
def plunge_in_rapid(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"\bG1 Z\S+ F", r"\bG1\b", "G0")


@kind
def rapid_too_deep(text: Text, random_: random.Random) -> str | None:
    """A rapid comes down to a tenth of a millimetre above the position where the plunge ends."""
    pairs = [
        (a, b)
        for a, b in itertools.pairwise(text.moves)
        if a.kind == "rapid" and b.kind == "feed" and a.placed and a.end[2] < a.start[2]
    ]
    if not pairs:
        return None
    rapid, plunge = random_.choice(pairs)
    return shifted(text, rapid, 2, plunge.end[2] + 0.1 - rapid.end[2])


@kind
def retract_missing(text: Text, random_: random.Random) -> str | None:
    return without(text, random_, [lift.line for _, lift in text.lifts])


@kind
def plunge_missing(text: Text, random_: random.Random) -> str | None:
    return without(text, random_, text.numbers_of(r"\bG1 Z\S+ F"))


@kind
def approach_missing(text: Text, random_: random.Random) -> str | None:
    """A rapid across is left out."""
    rapids = [m for m in text.moves if m.kind == "rapid" and m.start[:2] != m.end[:2] and math.isfinite(m.end[0])]
    return without(text, random_, [m.line for m in rapids])


@kind
def dog_leg(text: Text, random_: random.Random) -> str | None:
    """A rapid across and the rapid down after it in one line."""
    moves = text.moves
    pairs = [
        (a, b)
        for a, b in itertools.pairwise(moves)
        if a.kind == b.kind == "rapid"
        and b.placed
        and b.line == a.line + 1
        and b.end[2] < a.end[2]
        and a.start[:2] != a.end[:2]
    ]
    if not pairs:
        return None
    across, down = random_.choice(pairs)
    joined = f"{text.lines[across.line - 1]} {text.lines[down.line - 1].replace('G0 ', '')}"
    lines = list(text.lines)
    lines[across.line - 1 : down.line] = [joined]
    return "\n".join(lines) + "\n"


@kind
def clearance_lowered(text: Text, random_: random.Random) -> str | None:
    """A rapid lifts to half a millimetre above the last contact instead of the clearance height."""
    lifts = [pair for pair in text.lifts if pair[1] is not text.moves[-1]]
    if not lifts:
        return None
    contact, lift = random_.choice(lifts)
    return shifted(text, lift, 2, contact.end[2] + 0.5 - lift.end[2])


# Lines and levels


@kind
def corner_missing(text: Text, random_: random.Random) -> str | None:
    """The end of a contact move that turns is left out."""
    contacts = text.contacts
    turns = [a for a, b in itertools.pairwise(contacts) if b.line == a.line + 1 and _turn(a, b) > 0.3]
    return without(text, random_, [m.line for m in turns if text.is_bare(m.line)])


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
    contacts = [m for m in text.contacts if text.is_bare(m.line)]
    pairs = [a for a, b in itertools.pairwise(contacts) if b.line == a.line + 1 and _turn(a, b) > 0.3]
    if not pairs:
        return None
    first = random_.choice(pairs).line
    lines = list(text.lines)
    lines[first - 1], lines[first] = lines[first], lines[first - 1]
    return "\n".join(lines) + "\n"


@kind
def line_strayed(text: Text, random_: random.Random) -> str | None:
    """A contact move stands a second time, a third of the program away."""
    contacts = [m.line for m in text.contacts if "X" in text.lines[m.line - 1] and "Y" in text.lines[m.line - 1]]
    if len(contacts) < 6:
        return None
    offset = random_.randrange(len(contacts))
    lines = list(text.lines)
    lines.insert(contacts[(offset + len(contacts) // 3) % len(contacts)], lines[contacts[offset] - 1])
    return "\n".join(lines) + "\n"


def _blocks(text: Text) -> list[tuple[int, int]]:
    """Levels, as first and last line: from the end of the level before to the end of its own; the first is left out.

    Where there are none, as in rows over a surface: stretches between two lifts, but for rows that were added between those
    that lie the ordered distance apart. Without them the program is still what was ordered.
    """
    ends = _ends_of_levels(text.moves)
    are_levels = len(ends) >= 3
    if not are_levels:
        ends = [a.line for a, b in itertools.pairwise(text.moves) if a.kind != "rapid" and b.kind == "rapid"]
    blocks = [(first + 1, last) for first, last in itertools.pairwise(ends)]
    if not are_levels:
        blocks = _in_step(text, blocks)
    return [(a, b) for a, b in blocks if all(MOTION.fullmatch(line) for line in text.lines[a - 1 : b])]


def _in_step(text: Text, blocks: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Without the rows that are no whole number of steps from most of the others."""
    if not text.contacts:
        return blocks
    longest = max(text.contacts, key=lambda move: move.length)
    along = math.atan2(longest.end[1] - longest.start[1], longest.end[0] - longest.start[0])
    offsets = []
    for first, last in blocks:
        tips = [tip for m in text.contacts if first <= m.line <= last for tip in (m.start, m.end)]
        across = [tip[1] * math.cos(along) - tip[0] * math.sin(along) for tip in tips]
        offsets.append(min(across) if across and max(across) - min(across) < ONE_ROW else math.nan)
    rows = sorted(offset for offset in offsets if not math.isnan(offset))
    steps = [b - a for a, b in itertools.pairwise(rows) if b - a > ONE_ROW]
    if not steps:
        return blocks
    step = statistics.median(steps)

    def in_step(a: float, b: float) -> bool:
        return abs(a - b - step * round((a - b) / step)) <= ONE_ROW

    most = max(rows, key=lambda row: sum(in_step(row, other) for other in rows))
    return [block for block, offset in zip(blocks, offsets, strict=True) if math.isnan(offset) or in_step(offset, most)]


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
    lines = list(text.lines)
    return "\n".join(lines[: first - 1] + lines[last:]) + "\n"


@kind
def level_repeated(text: Text, random_: random.Random) -> str | None:
    """A level stands a second time at the end, below all others."""
    blocks = _blocks(text)
    if len(blocks) < 2:
        return None
    first, last = random_.choice(blocks[:-1])
    lines, end = list(text.lines), blocks[-1][1]
    return "\n".join(lines[:end] + lines[first - 1 : last] + lines[end:]) + "\n"


@kind
def levels_swapped(text: Text, random_: random.Random) -> str | None:
    blocks = _blocks(text)
    pairs = [(a, b) for a, b in itertools.pairwise(blocks) if b[0] == a[1] + 1]
    if not pairs:
        return None
    (first, middle), (_, last) = random_.choice(pairs)
    lines = list(text.lines)
    return "\n".join(lines[: first - 1] + lines[middle:last] + lines[first - 1 : middle] + lines[last:]) + "\n"


@kind
def cut_short(text: Text, random_: random.Random) -> str | None:
    """The program ends in the middle, as it ends else."""
    blocks = _blocks(text)
    if len(blocks) < 2:
        return None
    first = random_.choice(blocks)[0]
    last = [m.line for a, m in itertools.pairwise(text.moves) if m.kind == "rapid" and a.kind != "rapid"][-1]
    return "\n".join([*text.lines[: first - 1], *text.lines[last - 1 :]]) + "\n"


# Arcs


@kind_but("heidenhain")
def arc_turned(text: Text, random_: random.Random) -> str | None:
    """G2 for G3, or the reverse, where that is not the same circle."""
    arcs = [m for m in text.moves if m.kind == "arc" and m.start != m.end]
    if not arcs:
        return None
    arc = random_.choice(arcs)
    other = "G3" if arc.sense < 0 else "G2"
    line = re.sub(r"\bG[23]\b ?", "", text.lines[arc.line - 1])
    return text.with_line(arc.line, f"{other} {line}")


@kind_but("heidenhain")
def arc_centre(text: Text, random_: random.Random) -> str | None:
    """I or J by 0.02 mm: a whole circle is another one then, and LinuxCNC still takes some other arcs."""
    number = chosen(random_, text.numbers_of(r"\b[IJ]-?[\d.]*[1-9]"))
    if number is None:
        return None
    by = random_.choice([-0.02, 0.02]) / (25.4 if text.moves[-1].state.units == "G20" else 1.0)
    word, value = random_.choice(re.findall(rf"([IJ])({NUMBER})", text.lines[number - 1]))
    return text.replaced(number, rf"{word}{NUMBER}", f"{word}{float(value) + by:.4f}")


@kind_but("heidenhain")
def arc_centre_sign(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"\b[IJ]-?[\d.]*[1-9]", rf"([IJ])(-?)({NUMBER})", _minus)


def _minus(match: re.Match[str]) -> str:
    return f"{match[1]}{'' if match[2] else '-'}{match[3]}"


@kind_but("heidenhain")
def arc_straightened(text: Text, random_: random.Random) -> str | None:
    """G1 for an arc: its chord."""
    arcs = [m for m in text.moves if m.kind == "arc" and m.start != m.end]
    if not arcs:
        return None
    number = random_.choice(arcs).line
    line = re.sub(r"\bG[23]\b ?|[IJ]\S+ ?", "", text.lines[number - 1]).strip()
    return text.with_line(number, f"G1 {line}")
