"""Translates Heidenhain Klartext line by line into words of LinuxCNC, as its manuals mean it.

What is not posted (arcs by radius or angle, labels, other cycles) is refused, though the control takes it.

Sources: TNC 320 user's manual 7/2008 p. 155 (CC, C); TNC 426/430 p. 134 (TOOL CALL); TNC 620 Klartext 10/2017 p. 154
(blocks); TNC 640 ISO technical information p. 631 (ranges); TNC 620 cycle programming p. 276 (cycle 32); Autodesk's post
rev 42300 (inches: F in tenths, cycle 247, M91).
"""

from __future__ import annotations

import re

from controllers import CYCLE, Refused

NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)"
AXIS = re.compile(rf"(I?)([XYZ])({NUMBER})")
FEED = re.compile(rf"F({NUMBER})")
SWITCH = re.compile(r"M(\d+)")
SWITCHES = {0: "M0", 1: "M1", 2: "M2", 3: "M3", 4: "M4", 5: "M5", 7: "M7", 8: "M8", 9: "M9", 30: "M30"}
SWITCHES |= {13: "M3 M8", 14: "M4 M8", 91: "G53"}
PLANES = {"Z": "G17", "Y": "G18", "X": "G19"}
DATUMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"]
LARGEST = 99999.9999


class Klartext:
    """What the control holds from block to block; a block with / before it is left out, as a switch may have it.

    Lengths come with the tool. A tool axis other than Z is another plane. The program ends with M2, M30 or END PGM.
    """

    def __init__(self) -> None:
        self.name = ""
        self.inch = False
        self.awaited = ""
        """How the next line must begin."""
        self.pole: tuple[float, float] | None = None
        self.position: dict[str, float] = {}

    def line(self, line: str) -> str:
        """Its translation."""
        if line.startswith("/") or re.match(r"\d+\s*/", line):
            return ""
        goes_on = line.rstrip().endswith("~")
        code = line.rstrip("~ ").split(";")[0].strip()
        code = re.sub(r"^\d+(\s+|$)", "", code)
        if self.awaited and not code.startswith(self.awaited):
            raise Refused(f"{self.awaited} is missing")
        self.awaited = ""
        if not self.name and not code.startswith("BEGIN PGM"):
            raise Refused("the program does not begin")
        return self._block(code, goes_on=goes_on)

    def _block(self, code: str, *, goes_on: bool) -> str:
        if not code or code.startswith(("* -", "BLK FORM")):
            return ""
        if match := re.fullmatch(r"(BEGIN|END) PGM (\S+) (MM|INCH)", code):
            return self._frame(match[1], match[2], match[3] == "INCH")
        if code.startswith("CYCL DEF") or code.startswith("Q339"):
            return self._cycle(code, goes_on=goes_on)
        if match := re.fullmatch(r"TOOL CALL(?: (\d+))?(?: ([XYZ]))?(?: S(\d+))?", code):
            return self._tool(match[1], match[2], match[3])
        if match := re.fullmatch(r"TOOL DEF (\d+)", code):
            return f"T{match[1]}"
        if match := re.fullmatch(rf"CC X({NUMBER}) Y({NUMBER})", code):
            self.pole = (_number(match[1]), _number(match[2]))
            return ""
        words = code.replace("F MAX", "FMAX").split()
        if words[0] in ("L", "C"):
            return self._motion(words[0], words[1:])
        return " ".join(["M0" if word == "STOP" else _switch(word) for word in words])

    def _frame(self, end: str, name: str, inch: bool) -> str:
        if end == "BEGIN":
            if self.name:
                raise Refused("a program in the program")
            self.name, self.inch = name, inch
            return ("G20" if inch else "G21") + " G17 G90 G94"
        if (name, inch) != (self.name, self.inch):
            raise Refused("the program ends under another name")
        return "M2"

    def _cycle(self, code: str, *, goes_on: bool) -> str:
        if re.match(r"CYCL DEF 247\b", code):
            if not goes_on:
                raise Refused("cycle 247 has no datum")
            self.awaited = "Q339"
            return ""
        if match := re.fullmatch(r"Q339\s*=\s*\+?(\d+)", code):
            number = int(match[1])
            if not 1 <= number <= len(DATUMS):
                raise Refused("no such datum")
            return DATUMS[number - 1]
        if match := re.match(r"CYCL DEF (9|32)\.0\b", code):
            self.awaited = f"CYCL DEF {match[1]}.1"
            return ""
        if match := re.fullmatch(rf"CYCL DEF 9\.1 \S+ ({NUMBER})", code):
            return f"G4 P{_number(match[1]):.9f}"
        if match := re.fullmatch(rf"CYCL DEF 32\.1(?: T({NUMBER}))?", code):
            return f"G64 P{_number(match[1]):.9f}" if match[1] else "G64"
        if match := re.fullmatch(r"CYCL DEF 32\.2 HSC-MODE:([01])", code):
            return ""
        raise Refused(CYCLE)

    def _tool(self, number: str | None, axis: str | None, speed: str | None) -> str:
        words = []
        if number is not None:
            words += [f"T{number}", "M6", f"G43 H{number}"]
        if axis is not None:
            words.append(PLANES[axis])
        return " ".join([*words, *([f"S{speed}"] if speed else [])])

    def _motion(self, kind: str, words: list[str]) -> str:
        axes = [match for word in words if (match := AXIS.fullmatch(word))]
        named = {match[2]: _number(match[3]) for match in axes}
        rest = [word for word in words if not AXIS.fullmatch(word)]
        if len(named) != len(axes):
            raise Refused("an axis stands twice")
        if len({match[1] for match in axes}) > 1:
            raise Refused("absolute and incremental words in one block")
        incremental = any(match[1] for match in axes)
        start = dict(self.position)
        for axis, value in named.items():
            self.position[axis] = value + (start.get(axis, 0.0) if incremental else 0.0)
        turn = self._turn(rest, start) if kind == "C" else ""
        rapid = "FMAX" in rest
        if rapid and kind == "C":
            raise Refused("an arc in rapid")
        code = turn or ("G0" if rapid else "G1")
        head = ["G91" if incremental else "G90", code] if axes else []
        return " ".join([*head, *(f"{axis}{value:.9f}" for axis, value in named.items()), *self._rest(rest)])

    def _turn(self, rest: list[str], start: dict[str, float]) -> str:
        """G2 or G3 and the centre from the start."""
        turns = [word for word in rest if word in ("DR+", "DR-")]
        if self.pole is None or len(turns) != 1 or not {"X", "Y"} <= set(start):
            raise Refused("an arc without centre, sense or start")
        rest.remove(turns[0])
        code = "G3" if turns[0] == "DR+" else "G2"
        return f"{code} I{self.pole[0] - start['X']:.9f} J{self.pole[1] - start['Y']:.9f}"

    def _rest(self, words: list[str]) -> list[str]:
        """Feed and switches; R0 states that the radius is not compensated."""
        found = []
        for word in words:
            if word in ("R0", "FMAX"):
                continue
            if word in ("RL", "RR"):
                raise Refused("the radius is compensated")
            feed = FEED.fullmatch(word)
            found.append(f"F{_number(feed[1]) * (0.1 if self.inch else 1.0):.9f}" if feed else _switch(word))
        if sum(word.startswith("F") for word in words) > 1:
            raise Refused("two feeds")
        return found


def _number(text: str) -> float:
    """Files carry, by the manual, points, and commas too."""
    value = float(text.replace(",", "."))
    if abs(value) > LARGEST:
        raise Refused(f"{text} is too large")
    return value


def _switch(word: str) -> str:
    match = SWITCH.fullmatch(word)
    if match is None or int(match[1]) not in SWITCHES:
        raise Refused(f"not a word: {word}")
    return SWITCHES[int(match[1])]
