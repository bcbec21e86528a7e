"""Whether a changed program matters: for the part, for safety, for the time or for the machine's state.

The sound program is the measure of what was intended, the part and the job's limits of what is allowed. Nothing is asked
of the verifier that is tested. What changed is looked at, and of much that changed a dozen positions.

Z at the machine's top is above every clearance height: a rapid may go there straight up from wherever the tool is, go across
there, and come down from there as from the clearance height. Any other machine position is an unknown one: no feed may go
there or come from there, and no rapid below the clearance height.
"""

from __future__ import annotations

import difflib
import itertools
import math
import re
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from brute_force import ROUGH, Solid
from controllers import Family
from convex_tool import Floats, Tool
from gcode import Move, Program, State, read

MOST = 12
"""Changed moves that are looked at, at most."""
FEED_SHARE = 0.02
"""Share by which a feed may miss the wanted one."""
TIME_SHARE = 0.02
"""Share of the whole time that may be lost or won."""
SURE = 2e-4
"""What rough searches may miss, mm: nearer to a limit nothing is counted as mattering."""
GOUGE = 0.001
BLOCK_NUMBER = re.compile(r"^\d+ ")
"""Of Klartext: they count on behind a line that is new."""
ROUNDED = 0.002
"""What the last digit of an inch may take off a height, mm."""


@dataclass(frozen=True)
class Wanted:
    """What the job asks for, in the program's own coordinates."""

    solid: Solid
    tools: dict[int, Tool]
    """By number; tip at the point that the text moves."""
    holders: dict[int, Tool]
    """What is above the tools that have a holder."""
    excess: float
    """How far off the part a contact move may be, mm."""
    clearance: float
    """Height from which rapids may go across, mm."""
    retract: float
    """Height down to which rapids may come, mm."""
    family: Family
    axes: tuple[tuple[float, float], ...] | None
    """Lowest and highest position of X, Y and Z, mm, where the machine states so."""
    forming: bool
    """Whether levels must come one below the other."""


@dataclass
class Verdict:
    """Why a change matters, and where it can be seen."""

    reasons: list[str] = field(default_factory=list)
    lines: set[int] = field(default_factory=set)
    """Lines of the changed text: those that were changed, and the moves that are not those of the sound text."""
    whole: bool = False
    """Whether most of the program is affected: no one line is to blame."""
    positions: list[Floats] = field(default_factory=list)
    """Where the part is left unfinished, mm."""

    @property
    def matters(self) -> bool:
        """Whether a verifier must object."""
        return bool(self.reasons)


def weigh(sound: str, changed: str, wanted: Wanted) -> Verdict:
    """Compares two texts for the same job."""
    before, after = read(sound, wanted.family), read(changed, wanted.family)
    verdict = Verdict(lines=changed_lines(sound, changed))
    seen = after.refused[0] if after.refused else after.moves[0].line if after.moves else 0
    verdict.lines |= set(range(min(verdict.lines, default=seen), seen))  # modes hold from where they stand
    if after.refused is not None:
        verdict.reasons.append(f"refused at line {after.refused[0]}: {after.refused[1]}")
        verdict.lines.add(after.refused[0])
        return verdict
    if before.ended and not after.ended:
        verdict.reasons.append("the program does not end")
        verdict.lines.add(len(changed.splitlines()))
    pairs, new, gone = _matched(before, after)
    _weigh_states(pairs, before, after, verdict)
    weigh_moves(new, wanted, verdict)
    _weigh_left(gone, after, wanted, verdict)
    _weigh_order(before, after, wanted, verdict)
    _weigh_ends(after, wanted, verdict)
    _weigh_range(after, wanted, verdict)
    comparable = _unknown(before) == _unknown(after)
    if comparable and before.seconds and abs(after.seconds / before.seconds - 1) > TIME_SHARE:
        verdict.reasons.append(f"time {before.seconds:.1f} s becomes {after.seconds:.1f} s")
    verdict.whole = len(verdict.lines) > 0.5 * len(after.moves)
    return verdict


def _unknown(program: Program) -> int:
    """Moves whose length, and with it their time, is not known."""
    return sum(not move.placed for move in program.moves)


def changed_lines(sound: str, changed: str) -> set[int]:
    """Lines of the changed text that differ in more than their block number, and where lines are missing their neighbours."""
    found: set[int] = set()
    old, new = ([BLOCK_NUMBER.sub("", line) for line in text.splitlines()] for text in (sound, changed))
    matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
    for tag, _, _, first, last in matcher.get_opcodes():
        if tag == "delete":
            found |= {first, first + 1}
        elif tag != "equal":
            found |= set(range(first + 1, last + 1))
    return found


def _matched(before: Program, after: Program) -> tuple[list[tuple[Move, Move]], list[Move], list[Move]]:
    """Moves that are in both, and those that are in one alone."""
    matcher = difflib.SequenceMatcher(None, [m.key for m in before.moves], [m.key for m in after.moves], autojunk=False)
    pairs: list[tuple[Move, Move]] = []
    new: list[Move] = []
    gone: list[Move] = []
    for tag, a, b, c, d in matcher.get_opcodes():
        if tag == "equal":
            pairs += zip(before.moves[a:b], after.moves[c:d], strict=True)
        else:
            gone += before.moves[a:b]
            new += after.moves[c:d]
    return pairs, new, gone


def _weigh_states(pairs: list[tuple[Move, Move]], before: Program, after: Program, verdict: Verdict) -> None:
    differing: Counter[str] = Counter()
    for old, new in pairs:
        names = _differences(old, new)
        differing.update(names)
        if names:
            verdict.lines.add(new.line)
    for name in _differences_of(before.at_end, after.at_end) - {"feed"}:
        differing.update([name])
        verdict.lines |= {after.moves[-1].line, after.moves[-1].line + 1} if after.moves else set()
    verdict.reasons += [f"{name} differs on {count} moves" for name, count in sorted(differing.items())]


def _differences(old: Move, new: Move) -> set[str]:
    names = _differences_of(old.state, new.state)
    return names - {"feed"} if new.kind == "rapid" else names


def _differences_of(old: State, new: State) -> set[str]:
    names = ("units", "plane", "distance", "wcs", "feed_mode", "path", "tool", "length_offset", "spindle", "flood")
    found = {name for name in names if getattr(old, name) != getattr(new, name)}
    if old.spindle != "M5" and old.rpm != new.rpm:
        found.add("rpm")
    if abs(new.feed - old.feed) > FEED_SHARE * old.feed:
        found.add("feed")
    if new.paused > old.paused + 0.5:
        found.add("dwell")
    return found


def weigh_moves(new: list[Move], wanted: Wanted, verdict: Verdict) -> None:
    """Moves that the sound program does not have, against part and clearance height."""
    verdict.lines |= {move.line for move in new}
    for move in _some(new):
        tool = wanted.tools.get(move.state.tool) or next(iter(wanted.tools.values()))
        if not move.placed:
            verdict.reasons += [f"line {move.line}: {reason}" for reason in _faults_of_unknown(move, wanted)]
            continue
        verdict.reasons += [f"line {move.line}: {reason}" for reason in _faults(move, tool, wanted)]


def _faults_of_unknown(move: Move, wanted: Wanted) -> list[str]:
    """A move from or to a position that the text does not know: it may only lift, or cross at a height that is known.

    From the machine's top straight down a feed is only slow.
    """
    if move.kind != "rapid":
        straight = math.isinf(move.start[2]) and move.start[:2] == move.end[:2] and math.isfinite(move.end[2])
        if move.kind == "feed" and straight:
            return []
        return [f"a {move.kind} move from or to an unknown position"]
    low, high = sorted((move.start[2], move.end[2]))
    still = all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(move.start[:2], move.end[:2], strict=True))
    clear = wanted.clearance - ROUNDED
    if math.isinf(move.end[2]):
        return [] if still or move.start[2] >= clear else ["a rapid across to the machine's top, from below"]
    if math.isinf(move.start[2]):
        least = wanted.retract - ROUNDED if still and not math.isnan(move.end[0] + move.end[1]) else clear
        return [] if move.end[2] >= least else ["a rapid from the machine's top, down"]
    lifts = still and math.isnan(move.start[0]) and math.isnan(move.start[1]) and move.end[2] >= clear
    across = not math.isnan(low + high) and low >= clear
    return [] if lifts or across else ["a rapid from or to an unknown position, low"]


def _faults(move: Move, tool: Tool, wanted: Wanted) -> list[str]:
    travels = move.kind == "arc" or math.dist(move.start[:2], move.end[:2]) > 1e-6
    falls = move.end[2] < move.start[2] - 1e-6
    shares = np.linspace(0.0, 1.0, 33 if move.kind == "arc" else 17)
    tips = np.array([move.at(share) for share in shares])
    values = wanted.solid.clearances(tool, tips, ROUGH)
    found = []
    depth = -values.min()
    if depth > GOUGE + SURE:
        found.append(f"{move.kind} enters the part by {depth:.4f} mm")
    holder = wanted.holders.get(move.state.tool)
    if holder is not None and (depth := -wanted.solid.clearances(holder, tips, ROUGH).min()) > GOUGE + SURE:
        found.append(f"the holder enters the part by {depth:.4f} mm")
    if move.kind == "rapid":
        lowest = min(move.start[2], move.end[2])
        if travels and lowest < wanted.clearance - ROUNDED:
            found.append(f"rapid across at Z{lowest:.3f}")
        if falls and move.end[2] < wanted.retract - ROUNDED:
            found.append(f"rapid down to Z{move.end[2]:.3f}")
    elif travels and values.max() > wanted.excess + SURE:
        found.append(f"{move.kind} is {values.max():.4f} mm off the part")
    return found


def _weigh_left(gone: list[Move], after: Program, wanted: Wanted, verdict: Verdict) -> None:
    """Positions of the part that only missing moves touched: how far the changed program stays from them."""
    contacts = [m for m in gone if m.kind == "arc" or (m.kind == "feed" and math.dist(m.start[:2], m.end[:2]) > 1e-6)]
    tips = _tips([m for m in after.moves if m.kind != "rapid" and m.placed])
    for move in _some(contacts):
        tool = wanted.tools.get(move.state.tool) or next(iter(wanted.tools.values()))
        spot = wanted.solid.nearest(tool, np.array(move.at(0.5)), 2 * wanted.excess)
        if spot is None:
            continue
        near = np.hypot(*(tips[:, :2] - spot[:2]).T) < tool.radius + 1.0
        left = float(tool.distance(spot - tips[near]).min(initial=math.inf))
        if left > 2 * wanted.excess + SURE:
            verdict.reasons.append(f"{left:.4f} mm are left at X{spot[0]:.2f} Y{spot[1]:.2f} Z{spot[2]:.2f}")
            verdict.positions.append(spot)


def _tips(moves: list[Move]) -> Floats:
    """Positions along moves, no farther apart than a twentieth of a millimetre, or two hundred to a move."""
    tips = [np.empty((0, 3))]
    for move in moves:
        shares = np.linspace(0.0, 1.0, 2 + min(200, int(move.length / 0.05)))
        if move.kind == "arc":
            tips.append(np.array([move.at(share) for share in shares]))
        else:
            start, end = np.array(move.start), np.array(move.end)
            tips.append(start + shares[:, None] * (end - start))
    return np.concatenate(tips)


def _weigh_order(before: Program, after: Program, wanted: Wanted, verdict: Verdict) -> None:
    """In forming a level must not come after a lower one."""
    if not wanted.forming:
        return
    first = _rises(before)
    later = {key: line for key, line in _rises(after).items() if key not in first}
    if later:
        verdict.reasons.append(f"a level is formed after a lower one at line {min(later.values())}")
        verdict.lines |= set(later.values())


def _weigh_ends(after: Program, wanted: Wanted, verdict: Verdict) -> None:
    """The tool must stand above the clearance height where it is changed and where the program ends."""
    pairs = itertools.zip_longest(after.moves, after.moves[1:])
    for last, following in pairs:
        ends = following is None or following.state.tool != last.state.tool
        if ends and last.end[2] < wanted.clearance - ROUNDED:
            verdict.reasons.append(f"line {last.line}: left at Z{last.end[2]:.3f}")
            verdict.lines |= {last.line, last.line + 1}


def _weigh_range(after: Program, wanted: Wanted, verdict: Verdict) -> None:
    """Positions beyond the machine's axes."""
    if wanted.axes is None:
        return
    for move in after.moves:
        if any(
            not (low <= x <= high) for x, (low, high) in zip(move.end, wanted.axes, strict=True) if math.isfinite(x)
        ):
            verdict.reasons.append(f"line {move.line}: beyond the axes")
            verdict.lines.add(move.line)


def _rises(program: Program) -> dict[object, int]:
    """Level contact moves that lie higher than one before them."""
    lowest = math.inf
    found: dict[object, int] = {}
    for move in program.moves:
        level = abs(move.end[2] - move.start[2]) < 1e-6 and math.dist(move.start[:2], move.end[:2]) > 1e-6
        if move.kind == "rapid" or not level:
            continue
        if move.end[2] > lowest + 1e-3:
            found[move.key] = move.line
        lowest = min(lowest, move.end[2])
    return found


def _some(moves: list[Move]) -> list[Move]:
    """A dozen of them, spread evenly, the first and the last among them."""
    if len(moves) <= MOST:
        return moves
    return [moves[round(i * (len(moves) - 1) / (MOST - 1))] for i in range(MOST)]
