"""Translates one line of Fanuc, Okuma, Marlin or Siemens text into words of LinuxCNC, as their manuals mean it.

A translator holds what the controller remembers and `gcode` does not. What is not posted (canned cycles, arcs by a radius,
tools by name) is refused here too, though the controllers take it: no sound program has it, so it is a spoilt one.

Sources. Fanuc: 16i/18i-PB operator's manual B-63684EN p. 129 (sequence numbers), B-63682EN p. 54 (decimal point),
0i-MB B-63844EN p. 204 (G53 and G28 drop H), data server B-62694EN p. 88 (frame). Okuma: 6087-E P-274 (G table), Autodesk
okuma.cps of 2026. Marlin: parser.cpp, parser.h, queue.cpp, gcode.cpp, G0_G1.cpp, G2_G3.cpp, G4.cpp. Siemens: NC programming
12/2019 p. 44 to 52, 95, 108, 145, 188 to 205, 1108; Fundamentals 11/2006 p. 63; Tool Offset W1 p. 17, 33.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeAlias

from controllers import CYCLE, Family, Refused
from klartext import Klartext

Word: TypeAlias = tuple[str, str]
Translator: TypeAlias = Callable[[str], str]

WORD = re.compile(r"\s*([A-Z])\s*([+-]?(?:\d+\.?\d*|\.\d+))")
PARENS = re.compile(r"\([^()]*\)")
OFFSETS = [f"G{number}" for number in (54, 55, 56, 57, 58, 59)] + ["G59.1", "G59.2", "G59.3"]
"""Words of LinuxCNC for the work offsets from 1."""
MODES = {"G17", "G18", "G19", "G40", "G90", "G91", "G93", "G94"}
MOTIONS = {"G0", "G1", "G2", "G3"}
SWITCHES = {"M0", "M1", "M2", "M3", "M4", "M5", "M6", "M7", "M8", "M9", "M30"}


def translator(family: Family) -> Translator:
    """A fresh one for a text."""
    if family == "heidenhain":
        return Klartext().line
    made: dict[str, Callable[[], Translator]] = {
        "fanuc": lambda: _Fanuc().line,
        "okuma": lambda: _Okuma().line,
        "marlin": lambda: marlin,
        "siemens": lambda: _Siemens().line,
    }
    return made[family]() if family in made else lambda line: line


def words_of(code: str) -> list[Word]:
    """Letters and numbers, as written, of a line without its remarks."""
    found, read = [], 0
    code = code.strip().upper()
    while read < len(code):
        match = WORD.match(code, read)
        if match is None:
            raise Refused(f"not a word: {code[read:]}")
        found.append((match[1], match[2]))
        read = match.end()
    return found


def _codes(words: list[Word]) -> list[str]:
    """The G and M words without needless zeros."""
    return [f"{letter}{float(value):g}" for letter, value in words if letter in "GM"]


def _values(words: list[Word]) -> dict[str, str]:
    """All other words but block numbers."""
    values = {letter: value for letter, value in words if letter not in "GMN"}
    if len(values) != sum(letter not in "GMN" for letter, _ in words):
        raise Refused("a word stands twice")
    return values


def _joined(codes: list[str], values: dict[str, str]) -> str:
    return " ".join([*codes, *(letter + value for letter, value in values.items())])


def _require_known(codes: list[str], known: set[str]) -> None:
    if unknown := [code for code in codes if code not in known]:
        raise Refused(f"{unknown[0]} is not known")


def _without_parens(line: str) -> str:
    code = PARENS.sub("", line)
    if "(" in code or ")" in code:
        raise Refused("a comment is not closed")
    return code


def _require_points(values: dict[str, str], letters: str) -> None:
    """Without a point a number counts in least increments, or not, as a parameter stands."""
    for letter in set(letters) & set(values):
        if "." not in values[letter] and float(values[letter]) != 0.0:
            raise Refused(f"{letter}{values[letter]} has no point")


def _seconds(values: dict[str, str], letter: str, *, unit: float = 1.0) -> str:
    """A dwell, which stands in a block of its own."""
    if set(values) != {letter}:
        raise Refused(f"a dwell takes {letter} alone")
    return f"G4 P{float(values[letter]) * unit:.9f}"


class _Fanuc:
    """Series 0i to 30i. A block with / before it runs or does not, as a switch stands: here it does not."""

    KNOWN = (
        MOTIONS | MODES | SWITCHES | set(OFFSETS[:6]) | {"G4", "G20", "G21", "G28", "G43", "G49", "G53", "G80", "G92"}
    )
    POINTED = "XYZIJKF"

    def __init__(self) -> None:
        self.framed = False
        self.offset = "0"

    def line(self, line: str) -> str:
        """Its translation."""
        if line.startswith("%"):
            if self.framed:
                raise Refused("the text ends before the program does")
            self.framed = True
            return ""
        if line.startswith("/"):
            return ""
        code = _without_parens(line).strip()
        return "" if self.is_name(code) else self.block(words_of(code))

    def is_name(self, code: str) -> bool:
        """Whether a line is the program's number."""
        return re.fullmatch(r"O\d{1,8}", code) is not None

    def block(self, words: list[Word]) -> str:
        """Its translation."""
        codes, values = _codes(words), _values(words)
        if {"G98", "G99", "G81"} & set(codes):
            raise Refused(CYCLE)
        _require_known(codes, self.KNOWN)
        if "G92" in codes:
            raise Refused("G92 moves the zero point")
        if "G4" in codes:
            return _seconds(values, "P", unit=0.001) if "." not in values.get("P", "") else self._refuse_dwell()
        _require_points(values, self.POINTED)
        if "G43" in codes:
            self.offset = values.setdefault("H", self.offset)
        return _joined(codes, values)

    @staticmethod
    def _refuse_dwell() -> str:
        raise Refused("P of a dwell takes no point")


class _Okuma(_Fanuc):
    """OSP. G15 H calls the work offset, G56 H the length, and G53 takes it back; there is no G28, G43, G49 or G54.

    F needs no point: the maker's post writes none.
    """

    KNOWN = MOTIONS | MODES | SWITCHES | {"G4", "G15", "G20", "G21", "G53", "G56", "G80"}
    POINTED = "XYZIJK"

    def is_name(self, code: str) -> bool:
        """Whether a line is the program's name."""
        return re.fullmatch(r"O[A-Z0-9]+", code) is not None

    def block(self, words: list[Word]) -> str:
        """Its translation."""
        codes, values = _codes(words), _values(words)
        _require_known(codes, self.KNOWN)
        if "G4" in codes:
            return _seconds(values, "F")
        _require_points(values, self.POINTED)
        if "G56" in codes and "H" not in values:
            raise Refused("G56 without H")
        taken = [{"G56": "G43", "G53": "G49"}.get(code, code) for code in codes]
        if "G15" in codes:
            number = int(values.pop("H", "0"))
            if not 1 <= number <= len(OFFSETS):
                raise Refused("no such work offset")
            taken[codes.index("G15")] = OFFSETS[number - 1]
        return _joined(taken, values)


MARLIN_MOST = 95
"""Characters of a line; the rest is dropped."""
MARLIN_WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))?")
MARLIN_KNOWN = {"G0", "G1", "G2", "G3", "G4", "G20", "G21", "G28", "G90", "G91", "G92"}
MARLIN_KNOWN |= {"M0", "M1", "M3", "M4", "M5", "M7", "M8", "M9", "M30"}


def marlin(line: str) -> str:
    """Marlin 2.1 on the worst build: with spindle, coolant and inches, and rapids at a rate of their own or at the last F.

    A line is one command; a second one on it is not looked at, and a line that is not known is reported and not run. Numbers
    end where they cannot go on, words that stand twice count as the last of them. M30 deletes a file and G28 homes: that is
    refused, no program means it. F0 is passed over.
    """
    code = line.split(";", maxsplit=1)[0].strip()[:MARLIN_MOST]
    found = [(match[1], match[2]) for match in MARLIN_WORD.finditer(code)]
    if not found or not re.match(r"[GM]\d", code):
        return ""
    command = f"{found[0][0]}{float(found[0][1]):g}"
    if command not in MARLIN_KNOWN:
        return ""
    if command in ("G28", "G92", "M30"):
        raise Refused(f"{command} homes, moves the zero point or deletes a file")
    values = {letter: value for letter, value in found[1:] if value and letter not in "GM"}
    if command == "G4":
        seconds = float(values["S"]) if "S" in values else int(float(values.get("P", "0"))) / 1000.0
        return f"G4 P{seconds:.9f}"
    if float(values.get("F", "1")) <= 0.0:
        del values["F"]
    taken = {"M3": "S", "M4": "S"}.get(command, "XYZIJF" if command in MOTIONS else "")
    return _joined([command], {letter: value for letter, value in values.items() if letter in taken})


SIEMENS_NAMES = {"SUPA": "G53", "SOFT": "", "BRISK": "", "COMPCAD": "", "COMPOF": "", "FFWON": "", "FFWOF": ""}
CYCLE832_KINDS = {"_OFF": "0", "_FINISH": "1", "_SEMIFIN": "2", "_ROUGH": "3"}
SIEMENS_WORDS = {"M17": "M2", "G71": "G21", "G710": "G21", "G700": "G20", "G60": "G61", "G153": "G53"}
CYCLE832 = re.compile(r"CYCLE832\(([^()]*)\)")


class _Siemens:
    """Sinumerik 840D sl. D0 takes the length away, and it is not there again before a D is written: what a tool change does
    to D is a machine datum. CYCLE832 is the path's tolerance, whatever its dynamics; its kind 0 is none. M6 changes, T makes
    ready. G71 is G710 where feeds are metric anyway; G70 would leave them so, and is refused.
    """

    KNOWN = MOTIONS | MODES | SWITCHES | set(OFFSETS[:4]) | {"G4", "G53", "G60", "G64", "G153", "G500", "G700", "G710"}
    KNOWN |= {"G71", "M17"}

    def line(self, line: str) -> str:
        """Its translation."""
        code = line.split(";", maxsplit=1)[0].strip().upper()
        if code.startswith(("/", "%_N_")):
            return ""
        code = re.sub(r"^N\d+\s*", "", code)
        if re.fullmatch(r'MSG\(("[^"]*")?\)', code):
            return ""
        if re.match(r"M?CALL\b|CYCLE8(?!32)", code):
            raise Refused(CYCLE)
        cycle = CYCLE832.fullmatch(code)
        if cycle is not None:
            return self._tolerance(cycle[1])
        names = [name for name in code.split() if name in SIEMENS_NAMES]
        rest = " ".join(word.replace("=", "") for word in code.split() if word not in SIEMENS_NAMES)
        words = words_of(rest)
        codes, values = _codes(words), _values(words)
        return self._block([*codes, *(SIEMENS_NAMES[name] for name in names if SIEMENS_NAMES[name])], values)

    def _block(self, codes: list[str], values: dict[str, str]) -> str:
        offsets = [code for code in codes if re.fullmatch(r"G5\d\d", code) and code != "G500"]
        _require_known([code for code in codes if code not in offsets], self.KNOWN)
        if "G500" in codes:
            raise Refused("the work offsets are switched off")
        if "G4" in codes:
            return _seconds(values, "F")
        numbers = [int(code[1:]) - 500 for code in offsets]
        if any(not 5 <= number <= len(OFFSETS) for number in numbers):
            raise Refused(f"{offsets[0]} is no work offset")
        taken = [SIEMENS_WORDS.get(code, code) for code in codes if code not in offsets]
        taken += [OFFSETS[number - 1] for number in numbers]
        if "D" in values:
            edge = int(values.pop("D"))
            taken += ["G43" if edge else "G49"]
            values |= {"H": str(edge)} if edge else {}
        return _joined(taken, values)

    def _tolerance(self, inner: str) -> str:
        """The path's tolerance, or that there is none."""
        values = [value.strip() for value in inner.split(",")]
        if values == [""]:
            return "G64"
        try:
            numbers = [float(CYCLE832_KINDS.get(value, value)) for value in values]
        except ValueError:
            raise Refused(f"not numbers: {inner}") from None
        if len(numbers) not in (2, 3):
            raise Refused("CYCLE832 takes two or three numbers")
        return f"G64 P{values[0]}" if int(numbers[1]) % 10 else "G64"
