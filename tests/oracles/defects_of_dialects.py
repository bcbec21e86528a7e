"""Defects of words that only some families have: machine positions, compensation, kinds of a tolerance, names."""

from __future__ import annotations

import math
import random
import re

from spoiling import Text, before, chosen, header, kind_but, kind_of, respelt, without


def _to_top(text: Text) -> list[int]:
    """Lines that send Z to the machine's top; the first only lifts from where nobody knows."""
    return [m.line for m in text.moves if math.isinf(m.end[2]) and not math.isinf(m.start[2])]


@kind_of("siemens", "heidenhain")
def machine_place_lost(text: Text, random_: random.Random) -> str | None:
    """The word of the machine position is lost: Z goes to zero of the work."""
    number = chosen(random_, _to_top(text))
    return None if number is None else text.replaced(number, "SUPA | M91", "")


@kind_but("okuma", "marlin")
def machine_place_added(text: Text, random_: random.Random) -> str | None:
    """A rapid across goes to a machine position instead of the work."""
    top = text.dialect.top
    rapids = [m for m in text.moves if m.kind == "rapid" and m.start[:2] != m.end[:2] and m.end[2] == m.start[2]]
    number = chosen(random_, [m.line for m in rapids])
    if number is None:
        return None
    line = text.lines[number - 1]
    return text.with_line(number, f"{line} {top}" if top == "M91" else f"{top}{line}")


@kind_of("fanuc")
def home_by_way_of_zero(text: Text, random_: random.Random) -> str | None:
    """G28 Z0. without G91: through zero of the work."""
    return respelt(text, random_, r"^G91 G28", "G91 ", "")


@kind_of("fanuc")
def absolute_missing(text: Text, random_: random.Random) -> str | None:
    """The G90 behind G28 is missing: what follows is incremental."""
    contacts = text.contacts
    numbers = [n for n in text.numbers_of(r"^G90$") if contacts and n < contacts[-1].line]
    return without(text, random_, numbers)


@kind_but("marlin")
def radius_compensation(text: Text, random_: random.Random) -> str | None:
    """The path is taken for the part's edge."""
    if text.family == "heidenhain":
        numbers = [m.line for m in text.contacts if text.is_bare(m.line)]
        number = chosen(random_, numbers)
        return None if number is None else text.with_line(number, f"{text.lines[number - 1]} RL")
    return header(text, r"\bG40\b", "G41")


@kind_of("siemens")
def tolerance_switched_off(text: Text, random_: random.Random) -> str | None:
    """CYCLE832 of kind 0."""
    numbers = [n for n, line in enumerate(text.lines, 1) if line.startswith("CYCLE832(")]
    number = chosen(random_, numbers)
    return None if number is None else text.replaced(number, r",1,1\)", ",0,1)")


@kind_of("fanuc", "okuma", "siemens")
def first_change_missing(text: Text, random_: random.Random) -> str | None:
    """The whole block of the first tool's change, its path to the top included."""
    changes = text.numbers_of(text.dialect.change)
    contacts = text.contacts
    if not changes or not contacts:
        return None
    moves = [m.line for m in text.moves if math.isfinite(m.end[2])]
    lines = list(text.lines)
    pattern = r"^(T\d+( M6)?|M6|D1|G91 G28 Z0\.|G90|G0 SUPA .*)$"
    kept = [line for n, line in enumerate(lines, 1) if n >= moves[0] or not re.match(pattern, line)]
    return "\n".join(kept) + "\n"


@kind_of("fanuc", "siemens", "heidenhain")
def retract_and_lift_missing(text: Text, random_: random.Random) -> str | None:
    """Neither the lift nor the path to the machine's top before a tool change or the end."""
    pairs = [
        (lift.line, home.line)
        for contact, lift, home in zip(text.moves, text.moves[1:], text.moves[2:], strict=False)
        if contact.kind != "rapid" and lift.kind == "rapid" and math.isinf(home.end[2])
    ]
    if not pairs:
        return None
    lift, home = random_.choice(pairs)
    return "\n".join(line for n, line in enumerate(text.lines, 1) if n not in (lift, home)) + "\n"


@kind_of("marlin")
def motion_word_missing(text: Text, random_: random.Random) -> str | None:
    """A cut without its G1 or L, where every line needs one."""
    pattern = r"^G1 "
    numbers = [m.line for m in text.contacts if re.match(pattern, text.lines[m.line - 1])]
    number = chosen(random_, numbers)
    return None if number is None else text.replaced(number, pattern, "")


@kind_of("marlin")
def two_commands_on_a_line(text: Text, random_: random.Random) -> str | None:
    """Marlin looks at the first alone: the spindle's line takes the coolant's with it."""
    numbers = text.numbers_of(r"^M[34] S\d+$")
    number = next((n for n in numbers if text.lines[n : n + 1] == ["M8"]), None)
    if number is None:
        return None
    lines = list(text.lines)
    lines[number - 1 : number + 1] = [f"{lines[number - 1]} M8"]
    return "\n".join(lines) + "\n"


@kind_of("marlin")
def homing(text: Text, random_: random.Random) -> str | None:
    """A G28 of other controllers, which homes a Marlin machine."""
    return before(text, random_, [m.line for m in text.contacts], "G28 Z")


@kind_of("siemens", "heidenhain")
def parenthesis_for_remark(text: Text, random_: random.Random) -> str | None:
    """A remark of other controllers, which Siemens and Klartext do not take."""
    return before(text, random_, [m.line for m in text.contacts], "(finishing)")


@kind_of("okuma", "siemens")
def foreign_offset(text: Text, random_: random.Random) -> str | None:
    """Fanuc's G54 on an Okuma, which has none; G58 on a Siemens, which shifts the zero point by it."""
    return header(text, text.dialect.wcs, "G54" if text.family == "okuma" else "G58")
