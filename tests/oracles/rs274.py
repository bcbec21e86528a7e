"""Reads G-code with LinuxCNC's own interpreter and gives back the canonical calls it makes.

    python3 tests/oracles/rs274.py part.ngc

What the interpreter's numbers are, as tried on LinuxCNC 2.9.4:

* Lengths come in the units in force (`Call.unit`), rounded to four decimals; `Call.mm` converts.
* They are program coordinates: work offsets and tool lengths are not added to a word that is given.
  But G43, G49, G10, G52 and G92 change the coordinates of the position where the tool stands, and an
  axis that the next move does not name keeps that changed value.
* Every program starts in mm at the origin with feed 0 and ends with resets (feed 0, spindle off).
* The exit code is 1 after the first bad line, a tool not in the table, or no end (M2, M30, %).
"""

from __future__ import annotations

import argparse
import dataclasses
import re
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import roots

ROOT = "trixie"
TOOLS: Mapping[int, float] = {number: 50.0 + number for number in range(1, 100)}
"""Length by tool number: none is 0 and no two are the same, so that a wrong H word shows."""

MOVES = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED")
TEXTS = ("COMMENT", "MESSAGE")

AXES = {"XY": ("x", "y", "z"), "YZ": ("y", "z", "x"), "XZ": ("z", "x", "y")}
"""A plane's first and second axis, and its normal, in ARC_FEED's order."""

LINE = re.compile(r"\s*(\d+) +N(?:\.+|(\d+)) *([A-Z][A-Z0-9_]*)\((.*)\)")


@dataclasses.dataclass(frozen=True)
class Call:
    """One canonical call, with what was in force when it was made."""

    number: int
    """The call's index in the interpreter's output, from 1."""
    line: int | None
    """The N word of the program's line."""
    kind: str
    words: tuple[str, ...]
    """The arguments as printed; a comment or message is one."""
    unit: str
    """`mm` or `inch`: of every length and feed in this call."""
    feed: float
    """Units per minute in force (also after SET_FEED_RATE itself)."""
    x: float | None = None
    y: float | None = None
    z: float | None = None
    """Where the move ends; None when the call is not a move."""
    a: float | None = None
    b: float | None = None
    c: float | None = None
    center: tuple[float | None, float | None, float | None] | None = None
    """An arc's centre as x, y, z; None along its axis."""
    turns: int = 0
    """An arc's sense and turns: 1 and more counter-clockwise, -1 and less clockwise."""

    @property
    def mm(self) -> tuple[float, float, float]:
        """Where the move ends, in mm."""
        if self.x is None or self.y is None or self.z is None:
            raise ValueError(f"{self.kind} is not a move")
        scale = 25.4 if self.unit == "inch" else 1.0
        return self.x * scale, self.y * scale, self.z * scale

    @property
    def numbers(self) -> tuple[float, ...]:
        """The arguments as numbers."""
        return tuple(float(word) for word in self.words)


@dataclasses.dataclass(frozen=True)
class Interpretation:
    """All that the interpreter printed about a program."""

    calls: tuple[Call, ...]
    returncode: int
    stderr: str
    other: tuple[str, ...]
    """Lines of output that are no canonical call, such as those of (PRINT, ...)."""

    def __iter__(self) -> Iterator[Call]:
        """Goes through the calls."""
        return iter(self.calls)

    @property
    def ok(self) -> bool:
        """True when the interpreter read every line up to the program's end."""
        return self.returncode == 0 and not self.error

    @property
    def error(self) -> str:
        """The reason and the offending line, or nothing."""
        return "\n".join(line for line in self.stderr.splitlines() if line and line != "executing")

    @property
    def moves(self) -> tuple[Call, ...]:
        """The calls that move the tool."""
        return self.of(*MOVES)

    def of(self, *kinds: str) -> tuple[Call, ...]:
        """The calls of these kinds."""
        return tuple(call for call in self.calls if call.kind in kinds)


def _call(where: tuple[int, int | None], kind: str, words: tuple[str, ...], state: tuple[str, float, str]) -> Call:
    """Makes the record of one call; a move gets its end, and an arc its centre and turns."""
    unit, feed, plane = state
    call = Call(*where, kind, words, unit, feed)
    if kind not in MOVES:
        return call
    values, turns = call.numbers, 0
    middle: dict[str, float] = {}
    if kind == "ARC_FEED":
        first, second, normal = AXES[plane]
        ends = {first: values[0], second: values[1], normal: values[5]}
        middle = {first: values[2], second: values[3]}
        turns, values = int(values[4]), (ends["x"], ends["y"], ends["z"], *values[6:])
    x, y, z, a, b, c = values
    center = (middle.get("x"), middle.get("y"), middle.get("z")) if middle else None
    return Call(*where, kind, words, unit, feed, x, y, z, a, b, c, center, turns)


def parse(output: str) -> tuple[tuple[Call, ...], tuple[str, ...]]:
    """Reads the interpreter's output: the calls, and the lines that are none."""
    calls: list[Call] = []
    other: list[str] = []
    unit, feed, plane = "mm", 0.0, "XY"
    for text in output.removesuffix("\n").split("\n"):
        found = LINE.fullmatch(text.rstrip())
        if not found:
            other += [text] if text else []
            continue
        number, line, kind, inner = found.groups()
        words = (inner.strip('"'),) if kind in TEXTS else tuple(re.findall(r"[^\s,]+", inner))
        if kind == "USE_LENGTH_UNITS":
            unit = "inch" if words[0] == "CANON_UNITS_INCHES" else "mm"
        elif kind == "SET_FEED_RATE":
            feed = float(words[0])
        elif kind == "SELECT_PLANE":
            plane = words[0].removeprefix("CANON_PLANE_")
        where = int(number), int(line) if line else None
        calls.append(_call(where, kind, words, (unit, feed, plane)))
    return tuple(calls), tuple(other)


def interpret(
    text: str,
    inch: bool = False,
    tools: Mapping[int, float] = TOOLS,
    timeout: float = 120.0,
    subroutines: Sequence[str] = (),
) -> Interpretation:
    """Lets LinuxCNC read a program on a machine whose native unit is mm, or inch.

    The machine's unit is that of the tool lengths in `tools`, not that of the program: a program
    that has neither G20 nor G21 is read in mm in both cases. `subroutines` are folders inside the root. A program that does not
    end within `timeout` seconds raises subprocess.TimeoutExpired.
    """
    with tempfile.TemporaryDirectory(prefix="rs274-") as name:
        job = Path(name)
        (job / "job.ngc").write_text(text, encoding="utf-8", newline="")
        (job / "tool.tbl").write_text(
            "".join(f"T{number} P{number} Z{length:.6f}\n" for number, length in tools.items())
        )
        (job / "job.var").touch()
        (job / "job.ini").write_text(
            f"[TRAJ]\nLINEAR_UNITS = {'inch' if inch else 'mm'}\nANGULAR_UNITS = degree\n"
            f"[RS274NGC]\nSUBROUTINE_PATH = {':'.join(['.', *subroutines])}\n"
        )
        done = roots.run(
            ROOT,
            [
                "rs274",
                "-g",
                "-n",
                "2",
                "-i",
                "job.ini",
                "-t",
                "tool.tbl",
                "-v",
                "job.var",
                "job.ngc",
            ],
            binds=[roots.Bind(job, "/job", writable=True)],
            cwd="/job",
            timeout=timeout,
        )
    calls, other = parse(done.stdout)
    return Interpretation(calls, done.returncode, done.stderr, other)


def main() -> int:
    """Prints the calls of a file, and the interpreter's complaint; returns its exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--inch", action="store_true", help="the machine's native unit is inch")
    options = parser.parse_args()
    result = interpret(options.file.read_text(), inch=options.inch)
    for call in result:
        print(f"{call.line or '':>6} {call.kind}({', '.join(call.words)})")
    if result.error:
        print(result.error, file=sys.stderr)
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
