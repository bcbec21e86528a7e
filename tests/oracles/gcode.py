"""Reads posted text as LinuxCNC and GRBL would, from their manuals alone: states, moves and what would be refused.

Only what 3-axis programs use: G0 to G4, G17 to G19, G20, G21, G40, G43, G49, G54 to G59.3, G61, G64, G80, G90, G91, G93, G94,
M0 to M9, M30, F, S, T, H, comments. Lengths are mm, feeds mm/min, times s; positions are the point that the text moves.

Sources: LinuxCNC documentation, "G Codes", "M Codes", "G Code Overview"; Grbl v1.1 Commands, gcode.c of grbl 1.1h.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

Point: TypeAlias = tuple[float, float, float]
Family: TypeAlias = Literal["linuxcnc", "grbl"]

RAPID_RATE = {"linuxcnc": 3000.0, "grbl": 1000.0}
"""mm/min, as the shipped machine files assume."""

REFUSED_WORDS = {"linuxcnc": set(), "grbl": {"M6", "M7", "G43", "G64", "G61.1", "G90.1", "G59.1", "G59.2", "G59.3"}}
KNOWN_G = {
    "0",
    "1",
    "2",
    "3",
    "4",
    "17",
    "18",
    "19",
    "20",
    "21",
    "40",
    "43",
    "49",
    "61",
    "64",
    "80",
    "90",
    "91",
    "93",
    "94",
}
KNOWN_G |= {"54", "55", "56", "57", "58", "59", "59.1", "59.2", "59.3"}
KNOWN_M = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "30"}
MODAL = (
    {"G0", "G1", "G2", "G3", "G80"},
    {"G17", "G18", "G19"},
    {"G20", "G21"},
    {"G90", "G91"},
    {"G43", "G49"},
    {"G61", "G64"},
    {"M3", "M4", "M5"},
    {"M0", "M1", "M2", "M30"},
)
"""Words of which a line takes one."""
WAIT = 60.0
"""What M0 waits at least, s."""
LETTERS = set("FGHIJKMNPQRSTXYZ")
WORD = re.compile(r"\s*([A-Z])\s*([+-]?(?:\d+\.?\d*|\.\d+))")
COMMENT = re.compile(r"\([^()]*\)")
PLANE_AXES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
"""First and second axis of the plane, and its normal."""


@dataclass(frozen=True)
class State:
    """What the controller holds when a move begins."""

    units: str = ""
    plane: str = "G17"
    distance: str = "G90"
    wcs: str = "G54"
    feed_mode: str = "G94"
    path: str = ""
    selected: int = 0
    tool: int = 0
    length_offset: int = 0
    feed: float = 0.0
    spindle: str = "M5"
    rpm: float = 0.0
    flood: bool = False
    paused: float = 0.0
    """Seconds of dwells since the move before."""


@dataclass(frozen=True)
class Move:
    """One move; an arc has a centre and turns counter-clockwise about the plane's normal where `sense` is 1."""

    kind: Literal["rapid", "feed", "arc"]
    start: Point
    """Not a number where an axis has not been placed yet."""
    end: Point
    line: int
    state: State
    centre: Point = (math.nan,) * 3
    sense: int = 0

    @property
    def key(self) -> tuple[object, ...]:
        """What the machine does in it; equal keys are equal motions."""
        numbers = [None if math.isnan(x) else round(x, 7) for x in (*self.start, *self.end, *self.centre)]
        return (self.kind, self.sense, *numbers)

    @property
    def angle(self) -> float:
        """An arc's angle, rad, above 0; from a place back to itself it is a full turn."""
        a, b, _ = PLANE_AXES[self.state.plane]
        turn = self.sense * (
            math.atan2(self.end[b] - self.centre[b], self.end[a] - self.centre[a])
            - math.atan2(self.start[b] - self.centre[b], self.start[a] - self.centre[a])
        )
        return turn % (2 * math.pi) if abs(turn % (2 * math.pi)) > 1e-9 else 2 * math.pi

    @property
    def length(self) -> float:
        """mm; 0 where the start is not known."""
        if any(math.isnan(x) for x in self.start):
            return 0.0
        if self.kind != "arc":
            return math.dist(self.start, self.end)
        a, b, c = PLANE_AXES[self.state.plane]
        radius = math.hypot(self.start[a] - self.centre[a], self.start[b] - self.centre[b])
        return math.hypot(radius * self.angle, self.end[c] - self.start[c])

    def at(self, share: float) -> Point:
        """The place after a share of the way."""
        if self.kind != "arc":
            x, y, z = (p + share * (q - p) for p, q in zip(self.start, self.end, strict=True))
            return x, y, z
        a, b, c = PLANE_AXES[self.state.plane]
        out = [self.start[a] - self.centre[a], self.start[b] - self.centre[b]]
        last = math.hypot(self.end[a] - self.centre[a], self.end[b] - self.centre[b])
        radius = (1 - share) * math.hypot(*out) + share * last
        turn = math.atan2(out[1], out[0]) + self.sense * share * self.angle
        place = [0.0, 0.0, 0.0]
        place[a] = self.centre[a] + radius * math.cos(turn)
        place[b] = self.centre[b] + radius * math.sin(turn)
        place[c] = self.start[c] + share * (self.end[c] - self.start[c])
        return place[0], place[1], place[2]

    def seconds(self, family: Family) -> float:
        """Length by speed and the dwell before it: nothing of acceleration."""
        rate = RAPID_RATE[family] if self.kind == "rapid" else self.state.feed
        return self.state.paused + (60.0 * self.length / rate if rate > 0 else 0.0)


@dataclass
class Program:
    """A text as the controller would take it."""

    family: Family
    moves: list[Move] = field(default_factory=list)
    refused: tuple[int, str] | None = None
    """Line and reason at which the controller would stop; moves end there."""
    ended: bool = False
    at_end: State = field(default_factory=State)

    @property
    def seconds(self) -> float:
        """The whole program's time."""
        return sum(move.seconds(self.family) for move in self.moves)


class Refused(Exception):
    """What the controller would not take."""


def read(text: str, family: Family) -> Program:
    """Reads a text up to its end or to what the controller would refuse."""
    reader = _Reader(family)
    for number, line in enumerate(text.splitlines(), start=1):
        try:
            reader.take(line, number)
        except Refused as reason:
            reader.program.refused = (number, str(reason))
            break
        if reader.program.ended:
            break
    reader.program.at_end = reader.state
    if family == "linuxcnc" and reader.program.refused is None and not reader.program.ended:
        reader.program.refused = (len(text.splitlines()), "the program has no end")
    return reader.program


def words_of(line: str) -> list[tuple[str, str]]:
    """Letters and numbers of a line, as written; comments are left out."""
    code = COMMENT.sub("", line).split(";")[0].strip().upper()
    if "(" in code or ")" in code:
        raise Refused("a comment is not closed")
    found, place = [], 0
    while place < len(code):
        match = WORD.match(code, place)
        if match is None:
            raise Refused(f"not a word: {code[place:]}")
        found.append((match[1], match[2]))
        place = match.end()
    return found


class _Reader:
    def __init__(self, family: Family) -> None:
        self.family = family
        self.state = State()
        self.motion = ""
        self.begun = False
        self.framed = False
        self.place = [math.nan, math.nan, math.nan]
        self.program = Program(family)

    def take(self, line: str, number: int) -> None:
        if line.strip() == "%":
            self._percent()
            return
        if line.startswith("/"):
            if self.family == "linuxcnc":
                return
            line = line[1:]
        self.begun = True
        words = words_of(line)
        if unknown := {letter for letter, _ in words} - LETTERS:
            raise Refused(f"{min(unknown)} is no word")
        codes = [letter + _plain(value) for letter, value in words if letter in "GM"]
        if any(len(group & set(codes)) > 1 for group in MODAL):
            raise Refused("two words of one group")
        values = {letter: float(value) for letter, value in words if letter not in "GM"}
        if len(values) != sum(letter not in "GM" for letter, _ in words):
            raise Refused("a word stands twice")
        for code in codes:
            known = KNOWN_G if code[0] == "G" else KNOWN_M
            if code[1:] not in known or code in REFUSED_WORDS[self.family]:
                raise Refused(f"{code} is not known")
        self._modes(codes, values)
        self._move(codes, values, number)
        if {"M2", "M30"} & set(codes):
            self.program.ended = True

    def _percent(self) -> None:
        """The first one opens the text when nothing stands before it; the second ends it, and nothing else ends with it."""
        if self.family == "grbl" or (self.begun and not self.framed):
            raise Refused("% is not known here")
        self.program.ended = self.framed
        self.framed = True

    def _modes(self, codes: list[str], values: dict[str, float]) -> None:
        state = self.state
        for code in codes:
            if code in ("G20", "G21"):
                state = replace(state, units=code)
            elif code in PLANE_AXES:
                state = replace(state, plane=code)
            elif code in ("G90", "G91"):
                state = replace(state, distance=code)
            elif code in ("G93", "G94"):
                state = replace(state, feed_mode=code, feed=state.feed if code == state.feed_mode else 0.0)
            elif code.startswith("G5"):
                state = replace(state, wcs=code)
            elif code in ("G61", "G64"):
                state = replace(state, path=f"{code} P{values['P']:g}" if "P" in values else code)
            elif code in ("M3", "M4", "M5"):
                state = replace(state, spindle=code)
            elif code in ("M8", "M9"):
                state = replace(state, flood=code == "M8")
            elif code in ("G0", "G1", "G2", "G3", "G80"):
                self.motion = code
        if "F" in values:
            state = replace(state, feed=values["F"] * _mm(state))
        if "S" in values:
            state = replace(state, rpm=values["S"])
        if "T" in values:
            state = replace(state, selected=int(values["T"]))
        if "M6" in codes or (self.family == "grbl" and "T" in values):
            state = replace(state, tool=state.selected)
        if "G43" in codes:
            state = replace(state, length_offset=int(values.get("H", state.tool)))
        if "G49" in codes:
            state = replace(state, length_offset=0)
        if "M0" in codes:
            state = replace(state, paused=state.paused + WAIT)
        if "G4" in codes:
            if "P" not in values:
                raise Refused("G4 without P")
            state = replace(state, paused=state.paused + values["P"])
        self.state = state

    def _move(self, codes: list[str], values: dict[str, float], number: int) -> None:
        named = [axis for axis in "XYZ" if axis in values]
        arc = self.motion in ("G2", "G3")
        if not named:
            if {"I", "J", "K", "R"} & set(values) and not named and not (arc and self.family == "linuxcnc"):
                raise Refused("an arc without an end")
            if not (arc and {"I", "J", "K"} & set(values)):
                return
        if self.motion not in ("G0", "G1", "G2", "G3"):
            raise Refused("axis words without a motion")
        start, scale = list(self.place), _mm(self.state)
        for axis in named:
            index = "XYZ".index(axis)
            before = self.place[index] if self.state.distance == "G91" else 0.0
            self.place[index] = before + scale * values[axis]
        if self.motion != "G0" and self.state.feed <= 0.0:
            raise Refused("a feed move without a feed")
        if self.motion != "G0" and self.state.feed_mode == "G93" and "F" not in values:
            raise Refused("a feed move without F in inverse time")
        move = Move(
            "arc" if arc else "rapid" if self.motion == "G0" else "feed",
            (start[0], start[1], start[2]),
            (self.place[0], self.place[1], self.place[2]),
            number,
            self.state,
        )
        self.program.moves.append(self._bent(move, values) if arc else move)
        self.state = replace(self.state, paused=0.0)

    def _bent(self, move: Move, values: dict[str, float]) -> Move:
        """The arc about the centre that I, J and K give from the start; both radii must agree as the controller asks."""
        if "R" in values:
            raise Refused("an arc by its radius is not posted")
        a, b, c = PLANE_AXES[move.state.plane]
        if "IJK"[c] in values or not {"IJK"[a], "IJK"[b]} & set(values):
            raise Refused("the arc's centre is not in its plane")
        scale = _mm(move.state)
        centre = [math.nan] * 3
        for axis in (a, b):
            centre[axis] = move.start[axis] + scale * values.get("IJK"[axis], 0.0)
        first = math.hypot(move.start[a] - centre[a], move.start[b] - centre[b])
        last = math.hypot(move.end[a] - centre[a], move.end[b] - centre[b])
        allowed = 0.0283 if self.family == "linuxcnc" else 0.005
        apart = abs(first - last)
        if not first > 0 or apart > 100 * allowed or (apart > allowed and apart > 0.001 * first):
            raise Refused(f"the arc's radii differ by {apart:.4f} mm")
        sense = -1 if self.motion == "G2" else 1
        return replace(move, centre=(centre[0], centre[1], centre[2]), sense=sense)


def _mm(state: State) -> float:
    return 25.4 if state.units == "G20" else 1.0


def _plain(value: str) -> str:
    """`01` and `1.0` are `1`."""
    return f"{float(value):g}"
