"""Every program that LinuxCNC ships: what the tracer shows of it goes where LinuxCNC's own interpreter goes."""

from __future__ import annotations

import math
import os
import random
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import TypeAlias

import pytest

import ngc_words
import roots
import rs274
from styluscam import _engine
from styluscam.drawing.viewing import subroutines_in
from styluscam.errors import VerifyError

pytestmark = pytest.mark.world

Position: TypeAlias = tuple[float, float, float]
Offsets: TypeAlias = tuple[Position, Position, float]
"""Zero of the work coordinates and of those within them, mm, and their turn, rad."""

SHARED = Path("usr/share")
FOLDERS = ("linuxcnc/ncfiles", "doc/linuxcnc/examples", "axis/images")
ZERO: Position = (0.0, 0.0, 0.0)
UNKNOWN_TOOLS = dict.fromkeys(range(1, 100), 0.0)
"""As the tracer takes them: without length, and without diameter: compensation changes nothing."""

ROUNDED = 0.003
"""mm: half of the last digit that the interpreter prints, in inches, and what offsets add."""

REFUSED = {"nestedcall.ngc": "this O-word is not known"}
"""Faults that LinuxCNC finds too."""

ELSEWHERE = {
    "lathe_g70_71_demo.ngc": "the passes of G71 are not shown",
    "lathe_g7x_face_boring.ngc": "the passes of G72 are not shown",
    "lathe_g7x_quadrants.ngc": "the passes of G71 and G72 are not shown",
    "smartprobe.ngc": "the interpreter alone has its probes end 0.254 mm before their ends",
    "x-trim.ngc": "the interpreter alone has its probes end 0.254 mm before their ends",
}
"""Programs that are traced otherwise, and why."""


@pytest.fixture(scope="module")
def samples() -> list[Path]:
    """The programs."""
    try:
        roots.run("trixie", ["true"])
    except roots.Unavailable as error:
        if os.environ.get("CI"):
            pytest.fail(str(error))
        pytest.skip(str(error))
    return [path for folder in FOLDERS for path in sorted((_share() / folder).rglob("*.ngc"))]


def _share() -> Path:
    return roots.roots_dir() / "trixie" / SHARED


@lru_cache(maxsize=1)
def libraries() -> list[Path]:
    """The folders of LinuxCNC's own subroutines."""
    return sorted({path.parent for path in (_share() / FOLDERS[0]).rglob("*.ngc")})


@cache
def traced(path: Path) -> list[Position] | str:
    """Where the moves end, or what keeps the program from being shown: a stable name."""
    try:
        program, _ = _engine.trace_gcode(path.read_text(encoding="utf-8"), subroutines_in([path.parent, *libraries()]))
    except VerifyError as error:
        return f"{error.code}: {error}"
    return _ends(program)


def _ends(program: _engine.Program) -> list[Position]:
    return [(float(x), float(y), float(z)) for x, y, z in program.columns()[1]]


def test_they_are_shown_or_only_define_subroutines_or_move_nothing(samples: list[Path]) -> None:
    found: dict[str, list[str]] = {}
    for path in samples:
        path_of_ours = traced(path)
        kind = path_of_ours.split(": ")[0] if isinstance(path_of_ours, str) else "shown"
        found.setdefault(kind, []).append(path.name)
    print({kind: len(names) for kind, names in found.items()})
    still, libraries_only, shown = (found.pop(kind) for kind in ("trace-no-moves", "trace-only-subroutines", "shown"))
    assert [name for names in found.values() for name in names] == list(REFUSED)
    assert all(
        path_of_ours.endswith(REFUSED[path.name])
        for path in samples
        if path.name in REFUSED
        for path_of_ours in [traced(path)]
    )
    assert len(shown) >= 75 and len(still) <= 40 and len(libraries_only) <= 230


def test_they_go_where_linuxcnc_goes(samples: list[Path]) -> None:
    elsewhere, compared = set[str](), 0
    for path in samples:
        ours = traced(path)
        if isinstance(ours, str):
            continue
        folders = [f"/{folder.relative_to(_share().parents[1])}" for folder in (path.parent, *libraries())]
        interpreted = rs274.interpret(path.read_text(encoding="utf-8"), tools=UNKNOWN_TOOLS, subroutines=folders)
        theirs = list(positions_of(interpreted))
        compared += bool(theirs)
        if not goes_along(ours, theirs):
            elsewhere.add(path.name)
    assert elsewhere == set(ELSEWHERE)
    assert compared >= 40


@pytest.mark.parametrize("seed", range(40))
def test_random_programs_go_where_linuxcnc_goes(samples: list[Path], seed: int) -> None:
    text = ngc_words.program(random.Random(seed))
    interpreted = rs274.interpret(text, tools=UNKNOWN_TOOLS)
    try:
        program, _ = _engine.trace_gcode(text, lambda _: None)
    except VerifyError:
        assert not interpreted.ok, text
    else:
        assert goes_along(_ends(program), list(positions_of(interpreted))), text


def goes_along(ours: Sequence[Position], theirs: Sequence[Position | None]) -> bool:
    """Whether our positions are theirs, as far as those go; None stands for any number of positions."""
    mine, open_end = iter(moved(ours)), False
    for position in moved(theirs):
        if position is None:
            open_end = True
            continue
        candidates = mine if open_end else [next(mine, None)]
        open_end = False
        if not any(one is not None and math.dist(one, position) <= ROUNDED for one in candidates):
            return False
    return True


def moved(positions: Sequence[Position | None]) -> Iterator[Position | None]:
    """The positions without those where nothing moves, from the machine's zero on."""
    last: Position | None = ZERO
    for position in positions:
        if position is None or last is None or math.dist(position, last) > ROUNDED:
            yield position
            last = position


def positions_of(interpreted: rs274.Interpretation) -> Iterator[Position | None]:
    """Where the interpreter's moves end, in the coordinates of the first one, mm; None for curves, whose ends it hides."""
    work, local, turn = ZERO, ZERO, 0.0
    first: Offsets | None = None
    last = ZERO
    for call in interpreted:
        scale = 25.4 if call.unit == "inch" else 1.0
        if call.kind == "SET_G5X_OFFSET":
            work = _scaled(call.numbers[1:4], scale)
        elif call.kind == "SET_G92_OFFSET":
            local = _scaled(call.numbers[:3], scale)
        elif call.kind == "SET_XY_ROTATION":
            turn = math.radians(call.numbers[0])
        elif call.kind == "PROGRAM_END":
            return
        elif call.kind == "NURBS_FEED":
            yield None
        elif call.kind in (*rs274.MOVES, "STRAIGHT_PROBE", "RIGID_TAP"):
            position = call.mm if call.kind in rs274.MOVES else _scaled(call.numbers[:3], scale)
            first = first or (work, local, turn)
            shown = _called(_in_space(position, (work, local, turn)), first)
            yield shown
            if call.kind == "RIGID_TAP":
                yield last  # back again
            else:
                last = shown


def _scaled(numbers: Sequence[float], scale: float) -> Position:
    x, y, z = numbers
    return x * scale, y * scale, z * scale


def _turned(position: Position, angle: float) -> Position:
    x, y, z = position
    return x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), z


def _sum(a: Position, b: Position, sign: float = 1.0) -> Position:
    return a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2]


def _in_space(position: Position, offsets: Offsets) -> Position:
    work, local, turn = offsets
    return _sum(_turned(_sum(position, local), turn), work)


def _called(position: Position, offsets: Offsets) -> Position:
    work, local, turn = offsets
    return _sum(_turned(_sum(position, work, -1.0), -turn), local, -1.0)
