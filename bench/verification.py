"""Verification: seconds from a text to a report, phase by phase, and how long a cancelled verifier goes on.

.venv/bin/python bench/verification.py            # rewrites the part "verification" of docs/performance.md
.venv/bin/python bench/verification.py NAME ...   # only prints some cases, by the beginning of their names
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import planning
from page import machine, table, write

import styluscam as sc
from styluscam.judging import verification

ROUNDS = 3
"""The quickest of so many counts."""

CANCELS = 8
"""Moments, spread evenly over a verification, at which it is cancelled."""


def cases() -> Iterator[tuple[str, Callable[[], sc.Part], dict[str, Any]]]:
    """Names, parts and jobs."""
    for profile in ("ball", "clothoid"):
        for kind, what in (("zig-zag", "rows"), ("z-level", "levels")):
            tool = planning.tool(profile, 6.0)
            yield f"cap R60, {profile} D6, {what} 0.5 mm", planning.cap, planning.job(kind, tool, 0.5)
    terrain = planning.made(planning.terrain(200, 100.0))
    yield "terrain 100 x 100 mm, rows 0.5 mm", terrain, planning.job("zig-zag", planning.tool("ball", 6.0), 0.5)
    pins = planning.made(planning.bosses(8, 6.0, 1.0, 24, 10.0))
    yield "64 pins, flat D2, levels 1 mm", pins, planning.job("z-level", planning.tool("flat", 2.0), 1.0)


class Cancelling:
    """Progress that cancels once some time has passed, and knows when."""

    def __init__(self, after: float) -> None:
        self.begun = time.perf_counter()
        self.after, self.asked = after, 0.0

    def __call__(self, phase: str, fraction: float) -> bool:
        now = time.perf_counter()
        if now - self.begun < self.after:
            return True
        self.asked = self.asked or now
        return False


def measured(part: sc.Part, document: dict[str, Any]) -> list[str]:
    """Lines, seconds, CPU seconds, slowest phases, and the longest time from a cancel to the end."""
    plan = sc.plan(sc.Job.from_dict(document, part=part))
    text = sc.post(plan).text
    best, cpu, phases = float("inf"), 0.0, planning.Phases()
    for _ in range(ROUNDS):
        shown, began, worked = planning.Phases(), time.perf_counter(), time.process_time()
        verification.judge_plan(plan, text, shown)
        seconds = time.perf_counter() - began
        shown("", 1.0)
        if seconds < best:
            best, cpu, phases = seconds, time.process_time() - worked, shown
    longest = max(goes_on(plan, text, best * (i + 0.5) / CANCELS) for i in range(CANCELS))
    return [f"{text.count(chr(10)):,}", f"{best:.2f}", f"{cpu:.2f}", phases.slowest(), f"{longest:.2f}"]


def goes_on(plan: sc.Plan, text: str, after: float) -> float:
    """Seconds that a verification goes on after it was cancelled; 0 when it had ended before."""
    cancelling = Cancelling(after)
    try:
        verification.judge_plan(plan, text, cancelling)
    except sc.Cancelled:
        return time.perf_counter() - cancelling.asked
    return 0.0


def main() -> None:
    wanted = sys.argv[1:]
    rows = []
    for name, part, document in cases():
        if wanted and not any(name.startswith(begin) for begin in wanted):
            continue
        rows.append([name, *measured(part(), document)])
        print(" | ".join(rows[-1]), flush=True)
    if not wanted:
        heads = ["case", "lines", "s", "CPU s", "slowest phases, s", "goes on after a cancel, s"]
        text = "Seconds from a text to its report, contacts compared with the exact model included.\n\n" + table(
            heads, rows
        )
        write("verification", f"{text}\n\n{machine()}")


if __name__ == "__main__":
    main()
