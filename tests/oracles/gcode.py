"""Reads posted text as the controllers would, from their manuals alone: states, moves and what would be refused.

Only what 3-axis programs use: G0 to G4, G17 to G19, G20, G21, G40, G43, G49, G53 to G59.3, G61, G64, G80, G90, G91, G93, G94,
M0 to M9, M30, F, S, T, H, comments; G28 of Fanuc. Other families are translated to these words line by line (`dialects`).
Lengths are mm, feeds mm/min, times s; positions are the point that the text moves.

An axis sent to a machine position (G53, G28, SUPA, M91) is at a position that the text does not know: not a number. Only Z
sent to the machine's zero, or above it, is known to be above everything, and is infinite: machines have their Z zero at the top.

Sources: LinuxCNC documentation, "G Codes", "M Codes", "G Code Overview"; Grbl v1.1 Commands, gcode.c of grbl 1.1h.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

from controllers import ARC_ERROR, ENDLESS, RAPID_RATE, Family, Refused
from dialects import translator, words_of

Point: TypeAlias = tuple[float, float, float]

REFUSED_WORDS: dict[str, set[str]] = {"grbl": {"M6", "M7", "G43", "G64", "G61.1", "G90.1", "G59.1", "G59.2", "G59.3"}}
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
    "53",
    "61",
    "64",
    "80",
    "90",
    "91",
    "93",
    "94",
}
OFFSETS = {"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"}
KNOWN_G |= {code[1:] for code in OFFSETS}
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
COMMENT = re.compile(r"\([^()]*\)")
PLANE_AXES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
"""First and second axis of the plane, and its normal."""
SETS: dict[str, tuple[str, object]] = {
    **{code: ("units", code) for code in ("G20", "G21")},
    **{code: ("plane", code) for code in PLANE_AXES},
    **{code: ("distance", code) for code in ("G90", "G91")},
    **{code: ("wcs", code) for code in OFFSETS},
    **{code: ("spindle", code) for code in ("M3", "M4", "M5")},
    "M8": ("flood", True),
    "M9": ("flood", False),
}
"""Codes that set one field of the state, and to what."""
DROPS_LENGTH: tuple[Family, ...] = ("fanuc",)
"""Families whose G53 and G28 of Z take the tool's length away."""


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
    """Not a number where an axis has not been placed yet, or stands at a machine position; Z at its top is infinite."""
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
    def placed(self) -> bool:
        """Whether both ends are known."""
        return all(math.isfinite(x) for x in (*self.start, *self.end))

    @property
    def angle(self) -> float:
        """An arc's angle, rad, above 0; from a position back to itself it is a full turn."""
        a, b, _ = PLANE_AXES[self.state.plane]
        turn = self.sense * (
            math.atan2(self.end[b] - self.centre[b], self.end[a] - self.centre[a])
            - math.atan2(self.start[b] - self.centre[b], self.start[a] - self.centre[a])
        )
        return turn % (2 * math.pi) if abs(turn % (2 * math.pi)) > 1e-9 else 2 * math.pi

    @property
    def length(self) -> float:
        """mm; 0 where one of the ends is not known."""
        if not self.placed:
            return 0.0
        if self.kind != "arc":
            return math.dist(self.start, self.end)
        a, b, c = PLANE_AXES[self.state.plane]
        radius = math.hypot(self.start[a] - self.centre[a], self.start[b] - self.centre[b])
        return math.hypot(radius * self.angle, self.end[c] - self.start[c])

    def at(self, share: float) -> Point:
        """The position after a share of the move."""
        if self.kind != "arc":
            x, y, z = (p + share * (q - p) for p, q in zip(self.start, self.end, strict=True))
            return x, y, z
        a, b, c = PLANE_AXES[self.state.plane]
        out = [self.start[a] - self.centre[a], self.start[b] - self.centre[b]]
        last = math.hypot(self.end[a] - self.centre[a], self.end[b] - self.centre[b])
        radius = (1 - share) * math.hypot(*out) + share * last
        turn = math.atan2(out[1], out[0]) + self.sense * share * self.angle
        position = [0.0, 0.0, 0.0]
        position[a] = self.centre[a] + radius * math.cos(turn)
        position[b] = self.centre[b] + radius * math.sin(turn)
        position[c] = self.start[c] + share * (self.end[c] - self.start[c])
        return position[0], position[1], position[2]

    def seconds(self, family: Family) -> float:
        """Length by speed and the dwell before it: nothing of acceleration. Marlin's rapids run at the last F."""
        rate = RAPID_RATE[family] if self.kind == "rapid" and family != "marlin" else self.state.feed
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


def read(text: str, family: Family) -> Program:
    """Reads a text up to its end or to what the controller would refuse."""
    reader, translate = _Reader(family), translator(family)
    for number, line in enumerate(text.splitlines(), start=1):
        try:
            reader.take(translate(line), number)
        except Refused as reason:
            reader.program.refused = (number, str(reason))
            break
        if reader.program.ended:
            break
    reader.program.at_end = reader.state
    if family not in ENDLESS and reader.program.refused is None and not reader.program.ended:
        reader.program.refused = (len(text.splitlines()), "the program has no end")
    return reader.program


def _code(line: str) -> str:
    """The line without its remarks."""
    code = COMMENT.sub("", line).split(";")[0]
    if "(" in code or ")" in code:
        raise Refused("a comment is not closed")
    return code


class _Reader:
    def __init__(self, family: Family) -> None:
        self.family = family
        self.state = State()
        self.motion = ""
        self.known = KNOWN_G | ({"28"} if family == "fanuc" else set())
        self.begun = False
        self.framed = False
        self.position = [math.nan, math.nan, math.nan]
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
        words = words_of(_code(line))
        if unknown := {letter for letter, _ in words} - LETTERS:
            raise Refused(f"{min(unknown)} is no word")
        codes = [letter + _plain(value) for letter, value in words if letter in "GM"]
        if any(len(group & set(codes)) > 1 for group in MODAL):
            raise Refused("two words of one group")
        values = {letter: float(value) for letter, value in words if letter not in "GM"}
        if len(values) != sum(letter not in "GM" for letter, _ in words):
            raise Refused("a word stands twice")
        for code in codes:
            known = self.known if code[0] == "G" else KNOWN_M
            if code[1:] not in known or code in REFUSED_WORDS.get(self.family, set()):
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
        for code in codes:
            self._mode(code, values)
        self._registers(codes, values)
        self._pauses(codes, values)

    def _mode(self, code: str, values: dict[str, float]) -> None:
        """One modal code."""
        state = self.state
        if code in SETS:
            field, value = SETS[code]
            state = replace(state, **{field: value})
        elif code in ("G93", "G94"):
            state = replace(state, feed_mode=code, feed=state.feed if code == state.feed_mode else 0.0)
        elif code in ("G61", "G64"):
            named = [f"{letter}{values[letter]:g}" for letter in "PQ" if letter in values]
            state = replace(state, path=" ".join([code, *named]))
        elif code in MODAL[0]:
            self.motion = code
        self.state = state

    def _registers(self, codes: list[str], values: dict[str, float]) -> None:
        """Feed, speed, tool and its length, after the modes of the line."""
        state = self.state
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
        self.state = state

    def _pauses(self, codes: list[str], values: dict[str, float]) -> None:
        """Stops and dwells before the line's move."""
        if "M0" in codes:
            self.state = replace(self.state, paused=self.state.paused + WAIT)
        if "G4" in codes:
            if "P" not in values:
                raise Refused("G4 without P")
            self.state = replace(self.state, paused=self.state.paused + values["P"])

    def _move(self, codes: list[str], values: dict[str, float], number: int) -> None:
        named = [axis for axis in "XYZ" if axis in values]
        if {"G28", "G53"} & set(codes):
            self._go_to_machine(codes, values, number)
            return
        arc = self.motion in ("G2", "G3")
        if not named:
            if {"I", "J", "K", "R"} & set(values) and not named and not (arc and self.family == "linuxcnc"):
                raise Refused("an arc without an end")
            if not (arc and {"I", "J", "K"} & set(values)):
                return
        if self.motion not in ("G0", "G1", "G2", "G3"):
            raise Refused("axis words without a motion")
        start, scale = list(self.position), _mm(self.state)
        for axis in named:
            index = "XYZ".index(axis)
            before = self.position[index] if self.state.distance == "G91" else 0.0
            self.position[index] = before + scale * values[axis]
        if self.motion != "G0" and self.state.feed <= 0.0:
            raise Refused("a feed move without a feed")
        if self.motion != "G0" and self.state.feed_mode == "G93" and "F" not in values:
            raise Refused("a feed move without F in inverse time")
        move = Move(
            "arc" if arc else "rapid" if self.motion == "G0" else "feed",
            (start[0], start[1], start[2]),
            (self.position[0], self.position[1], self.position[2]),
            number,
            self.state,
        )
        self.program.moves.append(self._bent(move, values) if arc else move)
        self.state = replace(self.state, paused=0.0)

    def _go_to_machine(self, codes: list[str], values: dict[str, float], number: int) -> None:
        """G53 to a machine position; G28 there through a work position."""
        named = [axis for axis in "XYZ" if axis in values]
        home = "G28" in codes
        if not named or (not home and (self.motion not in ("G0", "G1") or self.state.distance == "G91")):
            raise Refused("a machine position without axes or motion, or incremental")
        if home:
            between = [values.get(axis, math.nan) * _mm(self.state) for axis in "XYZ"]
            if self.state.distance == "G91":
                between = [position + step for position, step in zip(self.position, between, strict=True)]
            self._rapid_through(
                [a if math.isnan(b) else b for a, b in zip(self.position, between, strict=True)], number
            )
        if "Z" in named and self.family in DROPS_LENGTH:
            self.state = replace(self.state, length_offset=0)
        positions = list(self.position)
        for axis in named:
            top = axis == "Z" and (home or values["Z"] >= 0.0)
            positions["XYZ".index(axis)] = math.inf if top else math.nan
        kind: Literal["rapid", "feed"] = "rapid" if home or self.motion == "G0" else "feed"
        if kind == "feed" and self.state.feed <= 0.0:
            raise Refused("a feed move without a feed")
        self._append(kind, positions, number)

    def _rapid_through(self, positions: list[float], number: int) -> None:
        if any(not math.isnan(b) and a != b for a, b in zip(self.position, positions, strict=True)):
            self._append("rapid", positions, number)

    def _append(self, kind: Literal["rapid", "feed"], positions: list[float], number: int) -> None:
        start = self.position
        self.position = positions
        ends = (start[0], start[1], start[2]), (positions[0], positions[1], positions[2])
        self.program.moves.append(Move(kind, *ends, number, self.state))
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
        apart = abs(first - last)
        if math.isnan(apart):
            raise Refused("an arc from a position that is not known")
        if not first > 0 or self._too_far(apart, first):
            raise Refused(f"the arc's radii differ by {apart:.4f} mm")
        sense = -1 if self.motion == "G2" else 1
        return replace(move, centre=(centre[0], centre[1], centre[2]), sense=sense)

    def _too_far(self, apart: float, radius: float) -> bool:
        """Whether an arc's radii differ by more than the controller allows; Marlin looks at nothing."""
        allowed = ARC_ERROR.get(self.family, math.inf)
        if self.family not in ("linuxcnc", "grbl"):
            return apart > allowed
        return apart > 100 * allowed or (apart > allowed and apart > 0.001 * radius)


def _mm(state: State) -> float:
    return 25.4 if state.units == "G20" else 1.0


def _plain(value: str) -> str:
    """`01` and `1.0` are `1`."""
    return f"{float(value):g}"
