"""Random programs of the RS-274NGC language: offsets, homes, cycles, arcs, polar words, parameters."""

from __future__ import annotations

import random
from collections.abc import Callable

START = "G21 G90 F100 S100 M3\nG0 X1 Y2 Z3\n"

Word = Callable[[random.Random], str]


def program(draw: random.Random) -> str:
    """A program of a few dozen blocks; it turns coordinate systems, or has offsets within them and every plane, not both.

    LinuxCNC 2.9.4 loses the position of the tip where both meet.
    """
    blocks = [*EVERYWHERE, *(TURNED if draw.random() < 0.5 else SHIFTED)]
    return START + "".join(f"{draw.choice(blocks)(draw)}\n" for _ in range(draw.randint(5, 25))) + "M2\n"


def _length(draw: random.Random, low: float = -20.0, high: float = 20.0) -> str:
    return f"{draw.uniform(low, high):.3f}"


def _axes(draw: random.Random) -> str:
    names = [axis for axis in "XYZ" if draw.random() < 0.5] or [draw.choice("XYZ")]
    return " ".join(axis + _length(draw) for axis in names)


def _line(draw: random.Random) -> str:
    return f"{draw.choice(['G0', 'G1'])} {_axes(draw)}"


def _mode(draw: random.Random) -> str:
    return draw.choice(["G90", "G91", "G17", "G18", "G19", "G98", "G99", "G80", "G7", "G8", "G54", "G55", "G56"])


def _zero(draw: random.Random) -> str:
    return f"G10 {draw.choice(['L2', 'L20'])} P{draw.randint(0, 4)} {_axes(draw)}"


def _machine_position(draw: random.Random) -> str:
    return f"G90 G53 G0 {_axes(draw)}"


def _home(draw: random.Random) -> str:
    return draw.choice(["G28", "G30", f"G28 {_axes(draw)}", f"G30 {_axes(draw)}", "G28.1", "G30.1"])


def _tool_length(draw: random.Random) -> str:
    return f"G10 {draw.choice(['L1', 'L10', 'L11'])} P1 Z{_length(draw)}"


def _arc_by_radius(first: str, second: str, plane: int) -> Word:
    def word(draw: random.Random) -> str:
        ends = f"{first}{_length(draw)} {second}{_length(draw)}"
        return f"G{plane} G90 {draw.choice(['G2', 'G3'])} {ends} R{draw.choice([60, -80, 100])}"

    return word


def _helix(draw: random.Random) -> str:
    centre = f"I{_length(draw)} J{_length(draw)}"
    return f"G17 {draw.choice(['G2', 'G3'])} {centre} Z{_length(draw)} P{draw.randint(1, 3)}"


def _cycle(draw: random.Random) -> str:
    cycle = draw.choice(["G81", "G82 P0.1", "G83 Q3", "G73 Q4", "G85", "G86 P0", "G89 P0"])
    return (
        f"G80 G0 Z12\nG17 G90 {cycle} X{_length(draw)} Y{_length(draw)} R{_length(draw, 5, 10)} Z{_length(draw, -5, 4)}"
    )


def _row(draw: random.Random) -> str:
    depths = f"R{_length(draw, -5, 5)} Z{_length(draw, -5, -1)}"
    return f"G80\nG17 G91 G81 X{_length(draw)} Y{_length(draw)} {depths} L{draw.randint(1, 3)}\nG80 G90"


def _polar(draw: random.Random) -> str:
    return draw.choice(
        [f"G17 G90 G0 @{_length(draw, 1, 20)} ^{_length(draw, 0, 360)}", f"G17 G91 G1 ^{_length(draw, 0, 90)}"]
    )


def _computed(draw: random.Random) -> str:
    return draw.choice([f"#1=[{_length(draw)}+#5420*0.5]\nG0 X[#1] Y[#5422+1]", "G0 X[#<_x>+1] Z[#<_abs_z>/2]"])


def _turned_zero(draw: random.Random) -> str:
    return f"G10 L2 P{draw.randint(0, 3)} {_axes(draw)} R{draw.choice([0, 30, -45, 90])}"


def _local(draw: random.Random) -> str:
    return draw.choice([f"G92 {_axes(draw)}", f"G52 {_axes(draw)}", "G92.1", "G92.2", "G92.3"])


EVERYWHERE: tuple[Word, ...] = (
    *(_line, _line, _mode, _zero, _machine_position, _home, _tool_length, _helix),
    *(_arc_by_radius("X", "Y", 17), _cycle, _row, _polar, _computed),
)
TURNED: tuple[Word, ...] = (_turned_zero, _turned_zero)
SHIFTED: tuple[Word, ...] = (_local, _local, _arc_by_radius("X", "Z", 18), _arc_by_radius("Y", "Z", 19))
