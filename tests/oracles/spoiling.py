"""A sound text as the defects see it: lines, moves, and the words that the families say differently."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import plain
from controllers import FAMILIES, REPEATS, Family
from gcode import Move, read

Spoil: TypeAlias = Callable[["Text", random.Random], "str | None"]

KINDS: dict[str, Spoil] = {}
"""Every kind of defect by its name."""
FAMILIES_OF: dict[str, tuple[Family, ...]] = {}
"""The families whose programs can have the defect."""
NUMBER = plain.NUMBER
MOTION = re.compile(rf"(G[0-3] ?)?([XYZIJ]{NUMBER} ?)+(F{NUMBER})?")
"""A line of nothing but motion and feed: it can stand elsewhere."""


@dataclass(frozen=True)
class Dialect:
    """Patterns and words of a family; an empty pattern states that it has no such thing."""

    units: str = r"\bG2[01]\b ?"
    metric: str = "G21"
    imperial: str = "G20"
    wcs: str = r"^G5[4-6]\b"
    others: tuple[str, ...] = ("G57", "G58", "G59")
    """Words of work offsets that no job here selects."""
    tool: str = r"^T(\d+) M6"
    """The tool that a change brings."""
    change: str = r"^T\d+ M6"
    """The line that changes."""
    length: str = r"\bG43\b.*\bH(\d)"
    length_words: str = r"\bG43\b ?|\bH\d+ ?"
    length_off: str = "G49"
    tolerance: str = ""
    loose: str = ""
    """The tolerance's words with a larger number."""
    bare: str = ""
    """The tolerance's words without a number."""
    dwell: str = "G4 P{:g}"
    dwell_unit: float = 1.0
    semicolon: bool = False
    """Remarks begin with ; and go on to the line's end."""
    pointed: bool = False
    """Numbers always have a point."""
    ends: str = r"^M0?(2|30)$"
    early: str = "M2"
    """The end among the cuts; empty where that is taken for something else."""
    top: str = ""
    """The word that sends an axis to a machine position."""


FANUC = Dialect(dwell_unit=1000.0, pointed=True, early="M30", top="G53 ")
DIALECTS: dict[Family, Dialect] = {
    "linuxcnc": Dialect(tolerance=r"^G64 P\S+.*$", loose="G64 P0.5", bare="G64", top="G53 "),
    "grbl": Dialect(early="", top="G53 "),
    "fanuc": FANUC,
    "okuma": Dialect(
        wcs=r"^G15 H[1-3]\b",
        others=("G15 H4", "G15 H5", "G15 H6"),
        length=r"\bG56\b.*\bH(\d)",
        length_words=r"\bG56\b ?|\bH\d+ ?",
        length_off="G53",
        dwell="G4 F{:g}.",
        pointed=True,
        early="M02",
    ),
    "marlin": Dialect(
        wcs="",
        tool="",
        change="",
        length="",
        length_off="",
        dwell="G4 S{:g}",
        semicolon=True,
        early="",
        ends="",
    ),
    "siemens": Dialect(
        units=r"\bG7[01]0\b ?",
        metric="G710",
        imperial="G700",
        others=("G57", "G505", "G506"),
        tool=r"^T(\d+)$",
        change=r"^M6$",
        length=r"^D(\d)$",
        length_words=r"^D\d$",
        length_off="D0",
        tolerance=r"^CYCLE832\(.*$",
        loose="CYCLE832(0.5,1,1)",
        bare="CYCLE832()",
        dwell="G4 F{:g}",
        semicolon=True,
        early="M30",
        top="SUPA ",
    ),
    "heidenhain": Dialect(
        units=r" (MM|INCH)$",
        metric=" MM",
        imperial=" INCH",
        wcs=r"Q339=\+[1-3]\b",
        others=("Q339=+4", "Q339=+5", "Q339=+6"),
        tool=r"^TOOL CALL (\d+)",
        change=r"^TOOL CALL \d+ Z",
        length="",
        length_off="",
        tolerance=r"^CYCL DEF 32\.1 .*$",
        loose="CYCL DEF 32.1 T0.5",
        bare="CYCL DEF 32.1",
        dwell="CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL {:g}",
        semicolon=True,
        early="M30",
        top="M91",
    ),
}


@dataclass(frozen=True)
class Text:
    """A sound text, its lines in plain words, and its moves."""

    text: str
    family: Family
    dialect: Dialect = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "dialect", DIALECTS[self.family])

    @cached_property
    def lines(self) -> list[str]:
        """Plain words; Klartext without block numbers."""
        return (plain.undressed(self.text) if self.family == "heidenhain" else self.text).splitlines()

    @cached_property
    def moves(self) -> list[Move]:
        return read(self.text, self.family).moves

    @property
    def plunges(self) -> list[Move]:
        """Feed moves straight down."""
        return [m for m in self.moves if m.kind == "feed" and m.end[2] < m.start[2] and m.start[:2] == m.end[:2]]

    @property
    def contacts(self) -> list[Move]:
        """Feed moves that go sideways."""
        return [m for m in self.moves if m.kind != "rapid" and m.placed and math.dist(m.start[:2], m.end[:2]) > 1e-6]

    @property
    def lifts(self) -> list[tuple[Move, Move]]:
        """Feed moves and the rapids up after them, but for those from which the tool goes on to the machine's top."""
        following = [*self.moves[2:], None]
        return [
            (contact, lift)
            for contact, lift, then in zip(self.moves, self.moves[1:], following, strict=False)
            if contact.kind != "rapid" and lift.kind == "rapid" and not (then and math.isinf(then.end[2]))
        ]

    def with_line(self, number: int, line: str | None) -> str:
        """The text with a line instead of another, or without it; a line may be several."""
        lines = list(self.lines)
        lines[number - 1 : number] = [] if line is None else [line]
        return "\n".join(lines) + "\n"

    def with_before(self, number: int, line: str) -> str:
        """The text with a line before another."""
        return self.with_line(number, f"{line}\n{self.lines[number - 1]}")

    def with_code(self, number: int, code: str) -> str:
        """The text with a code on a line, or before it where a line is one command."""
        if self.family == "marlin":
            return self.with_before(number, code)
        return self.with_line(number, f"{code} {self.lines[number - 1]}")

    def is_remark(self, line: str) -> bool:
        """Whether something on a line is one."""
        return (";" in line) if self.dialect.semicolon else ("(" in line)

    def numbers_of(self, pattern: str) -> list[int]:
        """Lines, from 1, in which a pattern is found; an empty one is found nowhere."""
        found = (n for n, line in enumerate(self.lines, 1) if pattern and re.search(pattern, line))
        return [n for n in found if not self.is_remark(self.lines[n - 1]) or "Q339" in self.lines[n - 1]]

    def replaced(self, number: int, pattern: str, by: str | Callable[[re.Match[str]], str]) -> str:
        return self.with_line(number, re.sub(pattern, by, self.lines[number - 1], count=1))

    def is_bare(self, number: int) -> bool:
        """Whether a line is a move that states no mode: without it the next one means the same."""
        repeated = "(G1 )?" if self.family in REPEATS else ""
        return re.fullmatch(rf"{repeated}([XYZ]{NUMBER} ?)+", self.lines[number - 1]) is not None

    def number(self, value: float, decimals: int) -> str:
        """A number as the family needs it."""
        text = f"{value:.{decimals}f}"
        return f"{text}." if self.dialect.pointed and "." not in text else text

    def feed(self, value: float) -> str:
        text = f"{value:g}"
        return f"{text}." if self.dialect.pointed and "." not in text else text

    def dwell(self, seconds: float) -> str:
        """The line, or lines, of a wait."""
        return self.dialect.dwell.format(seconds * self.dialect.dwell_unit)

    def remark(self, code: str) -> str:
        return f"; {code}" if self.dialect.semicolon else f"({code})"


def kind(function: Spoil) -> Spoil:
    """Registers a kind under its function's name for all families."""
    return _registered(function, FAMILIES)


def kind_of(*families: Family) -> Callable[[Spoil], Spoil]:
    """Registers a kind of some families."""
    return lambda function: _registered(function, families)


def kind_but(*families: Family) -> Callable[[Spoil], Spoil]:
    """Registers a kind of all other families."""
    return kind_of(*(family for family in FAMILIES if family not in families))


def _registered(function: Spoil, families: tuple[Family, ...]) -> Spoil:
    """What it spoils is written as the family writes."""

    def spoilt(text: Text, random_: random.Random) -> str | None:
        changed = function(text, random_)
        return plain.dressed(changed) if changed is not None and text.family == "heidenhain" else changed

    name = function.__name__.replace("_", " ")
    KINDS[name] = spoilt
    FAMILIES_OF[name] = families
    return function


def respelt(
    text: Text, random_: random.Random, found: str, pattern: str, by: str | Callable[[re.Match[str]], str]
) -> str | None:
    """The text with a pattern spelt otherwise, once, on one of the lines in which something is found."""
    number = chosen(random_, text.numbers_of(found))
    return None if number is None else text.replaced(number, pattern, by)


def chosen(random_: random.Random, numbers: list[int]) -> int | None:
    """One of the lines, if there are any."""
    return random_.choice(numbers) if numbers else None


def shifted(text: Text, move: Move, axis: int, by_mm: float) -> str:
    """The move's end shifted along an axis; the word is added where the line has none."""
    inch = move.state.units == "G20"
    value = (move.end[axis] + by_mm) / (25.4 if inch else 1.0)
    word = f"{'XYZ'[axis]}{text.number(value, 4 if inch else 3)}"
    line = text.lines[move.line - 1]
    pattern = rf"{'XYZ'[axis]}{NUMBER}"
    return text.with_line(move.line, re.sub(pattern, word, line) if re.search(pattern, line) else f"{line} {word}")


def without(text: Text, random_: random.Random, numbers: list[int]) -> str | None:
    """The text without one of the lines."""
    number = chosen(random_, numbers)
    return None if number is None else text.with_line(number, None)


def before(text: Text, random_: random.Random, numbers: list[int], line: str) -> str | None:
    """The text with a line before one of the lines."""
    number = chosen(random_, numbers)
    return None if number is None else text.with_before(number, line)


def header(text: Text, pattern: str, by: str) -> str | None:
    """The first match of a pattern replaced; a line that becomes empty is left out."""
    numbers = text.numbers_of(pattern)
    if not numbers:
        return None
    line = re.sub(pattern, by, text.lines[numbers[0] - 1], count=1).rstrip()
    return text.with_line(numbers[0], line or None)
