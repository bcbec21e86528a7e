"""Two programs that form a sheet from both sides: seeded defects of the pair, and whether one matters.

Positions and times are those that `gcode` reads. The tools are balls: their gap is the distance of their centres less both
radii, and no slope is asked for.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from gcode import Move, read
from plain import NUMBER

Spoil: TypeAlias = Callable[["Pair", random.Random], "Pair | None"]

KINDS: dict[str, Spoil] = {}
"""Every kind of defect by its name."""
TOO_NEAR = 0.003
TOO_FAR = 0.011
"""A gap that is less, or more, than the sheet by this, mm, matters where the sound pair keeps to it: both tools may be 0.001 mm
inside and 0.005 mm outside their faces."""
MOVED = 0.02
"""A main program that goes elsewhere by more, mm, matters: it is on the part no longer."""
OUT_OF_STEP = 0.02
"""Two programs matter that are apart by more along the main path, mm."""


class Pair(NamedTuple):
    """The texts for main and support."""

    main: str
    support: str


@dataclass(frozen=True)
class Between:
    """What stands between the two tips: radii of the balls, and the sheet along the normal and along the vertical, mm."""

    radius: float
    radius_below: float
    normal: float
    vertical: float

    def gap(self, main: Move, below: Move) -> float:
        """What is left beyond the sheet at the ends of two moves."""
        x, y, z = main.end
        u, v, w = below.end
        rise = z + self.radius - (-w - self.radius_below) - self.vertical
        return math.hypot(x - u, y + v, rise) - self.radius - self.radius_below - self.normal


def matters(sound: Pair, spoilt: Pair, between: Between) -> bool:
    """Whether the spoilt pair no longer has its moves together, or its tools, as the sound one has."""
    (main, below), (main_2, below_2) = (_moves(sound), _moves(spoilt))
    if len(main_2) != len(below_2):
        return True
    if len(main_2) == len(main):
        if any(math.dist(one.end, other.end) > MOVED for one, other in zip(main[1:], main_2[1:], strict=True)):
            return True
        kept = [i for i, both in enumerate(zip(main, below, strict=True)) if _keeps(between.gap(*both))]
        if any(not _keeps(between.gap(main_2[i], below_2[i])) for i in kept):
            return True
    return _apart(main_2, below_2) > OUT_OF_STEP


def _keeps(gap: float) -> bool:
    return -TOO_NEAR <= gap <= TOO_FAR


def _moves(pair: Pair) -> tuple[list[Move], list[Move]]:
    return read(pair.main, "linuxcnc").moves, read(pair.support, "linuxcnc").moves


def _apart(main: list[Move], below: list[Move]) -> float:
    """The most by which one program is ahead of the other, mm along the main path."""
    late = most = 0.0
    for one, other in zip(main, below, strict=True):
        if one.kind != other.kind:
            return math.inf
        if one.kind == "rapid":
            late = 0.0
            continue
        seconds = one.seconds("linuxcnc")
        late += other.seconds("linuxcnc") - seconds
        most = max(most, abs(late) * one.length / seconds if seconds > 0.0 else 0.0)
    return most


def kind(function: Spoil) -> Spoil:
    """Registers a kind under its function's name."""
    KINDS[function.__name__.replace("_", " ")] = function
    return function


def _contacts(text: str) -> list[int]:
    """Numbers of lines, from 0, that hold a place on X and Y among others that do: moves along passes."""
    lines = text.splitlines()
    plain = [re.fullmatch(rf"X{NUMBER} ?Y{NUMBER}( ?Z{NUMBER})?( ?F{NUMBER})?", line) is not None for line in lines]
    return [n for n in range(1, len(lines) - 1) if plain[n - 1] and plain[n] and plain[n + 1]]


def _with(text: str, number: int, *lines: str) -> str:
    all_lines = text.splitlines()
    all_lines[number : number + 1] = lines
    return "\n".join(all_lines) + "\n"


def _line(text: str, number: int) -> str:
    return text.splitlines()[number]


def _shifted(text: str, letter: str, by: float, numbers: range | None = None) -> str:
    def moved(match: re.Match[str]) -> str:
        return f"{letter}{float(match[1]) + by:.4f}"

    lines = text.splitlines()
    for number in numbers or range(len(lines)):
        if "(" not in lines[number]:
            lines[number] = re.sub(rf"{letter}({NUMBER})", moved, lines[number])
    return "\n".join(lines) + "\n"


@kind
def support_block_missing(pair: Pair, random_: random.Random) -> Pair:
    number = random_.choice(_contacts(pair.support))
    return pair._replace(support=_with(pair.support, number))


@kind
def main_block_missing(pair: Pair, random_: random.Random) -> Pair:
    number = random_.choice(_contacts(pair.main))
    return pair._replace(main=_with(pair.main, number))


@kind
def support_block_doubled(pair: Pair, random_: random.Random) -> Pair:
    number = random_.choice(_contacts(pair.support))
    line = _line(pair.support, number)
    return pair._replace(support=_with(pair.support, number, line, line))


@kind
def support_block_late(pair: Pair, random_: random.Random) -> Pair:
    """A block is lost, and a later one doubled: the numbers are equal again."""
    first, last = sorted(random_.sample(_contacts(pair.support), 2))
    line = _line(pair.support, last)
    return pair._replace(support=_with(_with(pair.support, last, line, line), first))


@kind
def support_feed(pair: Pair, random_: random.Random) -> Pair | None:
    """One feed by a third or more, up or down."""
    lines = [n for n in _contacts(pair.support) if "F" in _line(pair.support, n) and "F" in _line(pair.support, n + 1)]
    if not lines:
        return None
    number, factor = random_.choice(lines), random_.choice([0.5, 0.7, 1.5, 3.0])
    line = re.sub(rf"F({NUMBER})", lambda m: f"F{float(m[1]) * factor:.1f}", _line(pair.support, number))
    return pair._replace(support=_with(pair.support, number, line))


@kind
def support_feeds(pair: Pair, random_: random.Random) -> Pair:
    """All feeds by a few percent, as an override does."""
    factor = random_.choice([0.9, 0.95, 1.05, 1.2])
    text = re.sub(rf"F({NUMBER})", lambda m: f"F{float(m[1]) * factor:.1f}", pair.support)
    return pair._replace(support=text)


@kind
def main_feed(pair: Pair, random_: random.Random) -> Pair:
    """The main tool slows down on a block."""
    number = random_.choice(_contacts(pair.main))
    line = re.sub(rf" ?F{NUMBER}", "", _line(pair.main, number))
    after = _line(pair.main, number + 1)
    after = after if "F" in after else f"{after} F1500"
    text = _with(_with(pair.main, number + 1, after), number, f"{line} F400")
    return pair._replace(main=text)


@kind
def support_shifted(pair: Pair, random_: random.Random) -> Pair:
    """The zero point of the support is off by 0.05 mm."""
    letter, by = random_.choice("XYZ"), random_.choice([-0.05, 0.05])
    return pair._replace(support=_shifted(pair.support, letter, by))


@kind
def support_lower(pair: Pair, random_: random.Random) -> Pair:
    """One position of the support is 0.03 mm away from the sheet, or in it."""
    lines = [n for n in _contacts(pair.support) if "Z" in _line(pair.support, n)]
    number = random_.choice(lines or _contacts(pair.support))
    letter = "Z" if lines else random_.choice("XY")
    by = random_.choice([-0.03, 0.03]) if lines else random_.choice([-0.06, 0.06])
    return pair._replace(support=_shifted(pair.support, letter, by, range(number, number + 1)))


@kind
def support_mirrored(pair: Pair, random_: random.Random) -> Pair:
    """The support's machine was taken to have its Y, or its X, the other way."""
    letter = random_.choice("XY")
    lines = [
        line if "(" in line else re.sub(rf"{letter}({NUMBER})", lambda m: f"{letter}{-float(m[1]):.4f}", line)
        for line in pair.support.splitlines()
    ]
    return pair._replace(support="\n".join(lines) + "\n")


@kind
def support_is_main(pair: Pair, _random: random.Random) -> Pair:
    """The main program was loaded on both machines."""
    return pair._replace(support=pair.main)


@kind
def changed_over(pair: Pair, _random: random.Random) -> Pair:
    """Each machine has the other's program."""
    return Pair(pair.support, pair.main)


@kind
def support_pass_turned(pair: Pair, random_: random.Random) -> Pair | None:
    """A stretch of the support runs the other way round."""
    contacts = _contacts(pair.support)
    starts = [n for n in contacts if all(n + k in contacts for k in range(12))]
    if not starts:
        return None
    first = random_.choice(starts)
    lines = pair.support.splitlines()
    lines[first : first + 12] = lines[first : first + 12][::-1]
    return pair._replace(support="\n".join(lines) + "\n")


@kind
def rapid_for_feed(pair: Pair, random_: random.Random) -> Pair:
    """A block of the support is a rapid."""
    number = random_.choice(_contacts(pair.support))
    lines = _line(pair.support, number), _line(pair.support, number + 1)
    text = _with(_with(pair.support, number + 1, f"G1 {lines[1]}"), number, f"G0 {lines[0]}")
    return pair._replace(support=text)
