"""Defects of feeds, spindle, states and frames: words that every family has in some form."""

from __future__ import annotations

import itertools
import math
import random
import re

from spoiling import NUMBER, Text, before, chosen, header, kind, kind_but, kind_of, respelt, without


def _feeds(text: Text) -> list[int]:
    """Lines that say a feed for cuts."""
    return [n for n in text.numbers_of(rf"F{NUMBER}$") if not text.lines[n - 1].startswith("G0 ")]


def _feed_times(text: Text, random_: random.Random, factor: float) -> str | None:
    number = chosen(random_, _feeds(text))
    if number is None:
        return None
    return text.replaced(number, rf"F({NUMBER})$", lambda word: f"F{text.feed(float(word[1]) * factor)}")


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
    number = chosen(random_, _feeds(text))
    return None if number is None else text.replaced(number, rf" F{NUMBER}$", "")


@kind
def units_removed(text: Text, random_: random.Random) -> str | None:
    return header(text, text.dialect.units, "")


@kind
def units_swapped(text: Text, random_: random.Random) -> str | None:
    """Both where Klartext states it, at its beginning and its end."""
    words = (text.dialect.metric, text.dialect.imperial)
    for word, other in (words, words[::-1]):
        numbers = text.numbers_of(rf"{word}(?=$| )")
        lines = [line.replace(word, other) if n in numbers else line for n, line in enumerate(text.lines, 1)]
        if numbers:
            return "\n".join(lines) + "\n"
    return None


@kind_but("heidenhain")
def units_change(text: Text, random_: random.Random) -> str | None:
    """The other unit from the middle on."""
    is_metric = bool(text.numbers_of(rf"\b{text.dialect.metric}\b"))
    number = chosen(random_, [m.line for m in text.contacts if "F" not in text.lines[m.line - 1]])
    code = text.dialect.imperial if is_metric else text.dialect.metric
    return None if number is None else text.with_code(number, code)


@kind_but("heidenhain")
def incremental(text: Text, random_: random.Random) -> str | None:
    """From the last line before the cuts on that states that they are absolute."""
    contacts = text.contacts
    numbers = [n for n in text.numbers_of(r"\bG90\b") if contacts and n < contacts[0].line]
    return text.replaced(numbers[-1], r"\bG90\b", "G91") if numbers else None


@kind
def incremental_from_here(text: Text, random_: random.Random) -> str | None:
    number = chosen(random_, [m.line for m in text.contacts])
    if number is not None and text.family == "heidenhain" and text.moves[-1].state.distance == "G90":
        line = text.lines[number - 1]
        return text.with_line(number, f"G91 {line}") if line.startswith("G1") else None
    return None if number is None else text.with_code(number, "G91")


@kind_but("marlin")
def work_plane(text: Text, random_: random.Random) -> str | None:
    if text.family == "heidenhain":
        return header(text, r"^(TOOL CALL \d+) Z", rf"\1 {random_.choice('XY')}")
    return header(text, r"G17\b", random_.choice(["G18", "G19"]))


@kind_but("marlin")
def work_offset(text: Text, random_: random.Random) -> str | None:
    return header(text, text.dialect.wcs, random_.choice(text.dialect.others))


def _calls(text: Text) -> list[int]:
    """Lines that name a tool which is changed to: on Siemens T stands before M6."""
    numbers = text.numbers_of(text.dialect.tool)
    if text.family == "siemens":
        return [n for n in numbers if text.lines[n : n + 1] == ["M6"]]
    return numbers


@kind_but("grbl", "marlin")
def tool_number(text: Text, random_: random.Random) -> str | None:
    """Another tool of the job, or one that it does not have."""
    number = chosen(random_, _calls(text))
    if number is None:
        return None
    return text.replaced(number, r"(T|TOOL CALL )(\d+)", lambda word: f"{word[1]}{_other(int(word[2]))}")


def _other(tool: int) -> int:
    return 3 - tool if tool in (1, 2) else tool + 1


@kind_but("grbl", "marlin")
def tool_change_missing(text: Text, random_: random.Random) -> str | None:
    return without(text, random_, text.numbers_of(text.dialect.change))


@kind_of("linuxcnc", "fanuc", "okuma", "siemens")
def length_offset(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, text.dialect.length, r"([HD])(\d)", r"\1\g<2>0")


@kind_of("linuxcnc", "fanuc", "okuma", "siemens")
def length_offset_of_another_tool(text: Text, random_: random.Random) -> str | None:
    """The next number: H2 for H1."""
    return respelt(text, random_, text.dialect.length, r"([HD])(\d)", lambda w: f"{w[1]}{int(w[2]) + 1}")


@kind_of("linuxcnc", "fanuc", "okuma", "siemens")
def length_offset_missing(text: Text, random_: random.Random) -> str | None:
    """Its words; the line where there are no others."""
    number = chosen(random_, text.numbers_of(text.dialect.length))
    if number is None:
        return None
    return text.with_line(number, re.sub(text.dialect.length_words, "", text.lines[number - 1]).strip() or None)


@kind_of("linuxcnc", "fanuc", "okuma", "siemens")
def length_cancelled(text: Text, random_: random.Random) -> str | None:
    """The length is taken away among the cuts."""
    numbers = [m.line for m in text.contacts]
    return before(text, random_, numbers, text.dialect.length_off)


@kind_of("linuxcnc", "siemens", "heidenhain")
def path_tolerance(text: Text, random_: random.Random) -> str | None:
    return _tolerance(text, text.dialect.loose)


@kind_of("linuxcnc", "siemens", "heidenhain")
def path_tolerance_without_number(text: Text, random_: random.Random) -> str | None:
    return _tolerance(text, text.dialect.bare)


@kind_of("linuxcnc", "siemens", "heidenhain")
def path_tolerance_missing(text: Text, random_: random.Random) -> str | None:
    """All lines of it."""
    pattern = text.dialect.tolerance.replace(r"32\.1 .*$", r"32\.")
    lines = [line for line in text.lines if not (pattern and re.match(pattern, line))]
    return "\n".join(lines) + "\n" if len(lines) < len(text.lines) else None


def _tolerance(text: Text, by: str) -> str | None:
    pattern = text.dialect.tolerance
    numbers = [n for n, line in enumerate(text.lines, 1) if pattern and re.match(pattern, line)]
    return text.with_line(numbers[0], by) if numbers else None


@kind
def spindle_missing(text: Text, random_: random.Random) -> str | None:
    return without(text, random_, text.numbers_of(r"\bM[34]\b"))


@kind
def spindle_turned(text: Text, random_: random.Random) -> str | None:
    turned = {"3": "M4", "4": "M3"}
    return respelt(text, random_, r"\bM[34]\b", r"\bM([34])\b", lambda word: turned[word[1]])


@kind
def spindle_speed(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"\bS\d+", r"S(\d+)", r"S\g<1>0")


@kind
def spindle_on(text: Text, random_: random.Random) -> str | None:
    """A stylus that should stand turns."""
    number = chosen(random_, text.numbers_of(r"^M5$"))
    words = {"marlin": "M3 S5000", "heidenhain": "TOOL CALL Z S5000\nM3"}.get(text.family, "S5000 M3")
    return None if number is None else text.with_line(number, words)


@kind
def coolant_missing(text: Text, random_: random.Random) -> str | None:
    return without(text, random_, text.numbers_of(r"\bM8\b"))


@kind
def mist_for_flood(text: Text, random_: random.Random) -> str | None:
    return respelt(text, random_, r"\bM8\b", r"\bM8\b", "M7")


@kind
def dwell(text: Text, random_: random.Random) -> str | None:
    """The tool stands on the part for a minute."""
    return before(text, random_, [m.line for m in text.contacts], text.dwell(60.0))


@kind_but("marlin")
def end_missing(text: Text, random_: random.Random) -> str | None:
    """The line that states it; Klartext loses END PGM too, as a file that was cut off does."""
    numbers = text.numbers_of(text.dialect.ends)
    if not numbers:
        return None
    lines = [line for n, line in enumerate(text.lines, 1) if n not in numbers and not line.startswith("END PGM")]
    return "\n".join(lines) + "\n"


@kind
def program_stop(text: Text, random_: random.Random) -> str | None:
    """The tool waits on the part until somebody comes."""
    return before(text, random_, [m.line for m in text.contacts], "M0")


@kind
def spindle_stops(text: Text, random_: random.Random) -> str | None:
    """M5 among the cuts."""
    return before(text, random_, [m.line for m in text.contacts if m.state.spindle != "M5"], "M5")


@kind_but("grbl", "marlin")
def end_early(text: Text, random_: random.Random) -> str | None:
    """The end among the cuts, where the controller does not look at what follows."""
    return before(text, random_, [m.line for m in text.contacts], text.dialect.early)


@kind_of("linuxcnc", "fanuc")
def percent_inside(text: Text, random_: random.Random) -> str | None:
    """Two programs in one file: the first one's last % ends the text."""
    changed = before(text, random_, [m.line for m in text.contacts], "%")
    return "%\n" + changed if changed is not None and not text.text.startswith("%") else changed


@kind_but("grbl")
def block_deleted(text: Text, random_: random.Random) -> str | None:
    """A slash before the lift: it is left out, or as a switch stands."""
    number = chosen(random_, [lift.line for _, lift in text.lifts])
    return None if number is None else text.with_line(number, f"/{text.lines[number - 1]}")


@kind_but("grbl")
def block_of_a_cut_deleted(text: Text, random_: random.Random) -> str | None:
    """A slash before a move that cuts."""
    number = chosen(random_, [m.line for m in text.contacts])
    return None if number is None else text.with_line(number, f"/{text.lines[number - 1]}")


@kind
def newline_lost(text: Text, random_: random.Random) -> str | None:
    """Two moves in one line."""
    pairs = [a.line for a, b in itertools.pairwise(text.contacts) if b.line == a.line + 1]
    number = chosen(random_, pairs)
    if number is None:
        return None
    lines = list(text.lines)
    lines[number - 1 : number + 1] = [f"{lines[number - 1]} {lines[number]}"]
    return "\n".join(lines) + "\n"


@kind
def commented_out(text: Text, random_: random.Random) -> str | None:
    """A lift, from which no other follows, or a rapid across is a remark."""
    rapids = [m for m in text.moves if m.kind == "rapid" and m.start[:2] != m.end[:2] and math.isfinite(m.end[0])]
    number = chosen(random_, [m.line for m in [*rapids, *(lift for _, lift in text.lifts)]])
    return None if number is None else text.with_line(number, text.remark(text.lines[number - 1]))


@kind
def word_commented_out(text: Text, random_: random.Random) -> str | None:
    """The last word of a contact move of two axes is in a remark."""
    pattern = rf"^(.*[XYZ]{NUMBER}) ([XYZ]{NUMBER})$"
    numbers = [m.line for m in text.contacts if re.match(pattern, text.lines[m.line - 1])]
    number = chosen(random_, numbers)
    return None if number is None else text.replaced(number, pattern, lambda m: f"{m[1]} {text.remark(m[2])}")


@kind_but("heidenhain")
def decimal_comma(text: Text, random_: random.Random) -> str | None:
    """Where the control does not take one: Klartext may have it."""
    return respelt(text, random_, r"[XYZ]-?\d+\.\d", r"([XYZ]-?\d+)\.", r"\1,")


@kind
def offset_by_g92(text: Text, random_: random.Random) -> str | None:
    """The zero point is moved."""
    klartext = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0.1"
    line = klartext if text.family == "heidenhain" else "G92 X0.1"
    return before(text, random_, [m.line for m in text.moves], line)


@kind_but("marlin", "heidenhain")
def inverse_time(text: Text, random_: random.Random) -> str | None:
    return header(text, r"G94\b", "G93")


@kind_but("marlin", "heidenhain")
def comment_open(text: Text, random_: random.Random) -> str | None:
    """A bracket that is not closed, of a remark or a cycle."""
    numbers = [n for n, line in enumerate(text.lines, 1) if re.match(r"[^;]*\(.*\)$", line)]
    number = chosen(random_, numbers)
    return None if number is None else text.with_line(number, text.lines[number - 1][:-1])
