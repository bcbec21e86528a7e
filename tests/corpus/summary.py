"""The table as a page: counts, times, what was not expected with its command, all sentences."""

from __future__ import annotations

import re
from collections import Counter, defaultdict

import numpy as np
from outcomes import AS_WRITTEN, Outcome

WORST = ("crash", "gouge", "misplaced", "timeout", "findings", "refused", "done")
"""Outcomes, the worst first."""
NUMBERS = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?")


def markdown(rows: list[Outcome]) -> str:
    """The page; its part before the first `##` is the short form."""
    counts = Counter(row.outcome for row in rows)
    written = [row for row in rows if row.variant == AS_WRITTEN]
    times = np.array([row.new_seconds + row.run_seconds for row in rows] or [0.0])
    lines = [
        "# Corpus",
        "",
        f"{len(rows)} runs of {len({row.part for row in rows})} parts: "
        + ", ".join(f"{counts[kind]} {kind}" for kind in WORST if counts[kind]),
        f"as `new` wrote them: {sum(row.outcome == 'done' for row in written)} of {len(written)} done; "
        f"as expected: {sum(not row.wrong for row in written)}; all runs as expected: {sum(not row.wrong for row in rows)}",
        f"`new` + `run`: median {np.median(times):.1f} s, p95 {np.percentile(times, 95):.1f} s, max {times.max():.1f} s; "
        f"peak memory {max((row.peak_mb for row in rows), default=0):.0f} MB",
        f"done with warnings: {sum(row.outcome == 'done' and bool(row.kinds) for row in rows)}",
        f"programs checked against the modeller's triangles: {sum(row.samples > 0 for row in rows)}, "
        f"{sum(row.samples for row in rows)} positions",
        "",
    ]
    lines += _by_variant(rows) + _unexpected(rows) + _warned(rows) + _slow(rows) + _sentences(rows)
    return "\n".join(lines) + "\n"


def _by_variant(rows: list[Outcome]) -> list[str]:
    lines = ["## By variant", "", "| variant | " + " | ".join(WORST) + " |", "|---" * (len(WORST) + 1) + "|"]
    for variant in sorted({row.variant for row in rows}):
        counts = Counter(row.outcome for row in rows if row.variant == variant)
        lines.append(f"| {variant} | " + " | ".join(str(counts[kind]) for kind in WORST) + " |")
    return [*lines, ""]


def _unexpected(rows: list[Outcome]) -> list[str]:
    wrong = sorted(
        (row for row in rows if row.wrong), key=lambda row: (WORST.index(row.outcome), row.part, row.variant)
    )
    lines = ["## Not as expected, the worst first", ""]
    for kind in WORST:
        of_kind = [row for row in wrong if row.outcome == kind]
        if not of_kind:
            continue
        lines += [f"### {kind}: {len(of_kind)}", ""]
        for row in of_kind:
            kinds = f" {row.kinds}" if row.kinds else ""
            lines.append(f"- **{row.part}** {row.variant}: {row.wrong}.{kinds} {row.detail[:300]}")
            lines.append(f"  `{row.command}`")
        lines.append("")
    return lines


def _warned(rows: list[Outcome]) -> list[str]:
    lines = ["## Done with warnings", ""]
    for row in rows:
        if row.outcome == "done" and row.kinds:
            lines.append(f"- {row.part} {row.variant}: " + ", ".join(f"{n} {kind}" for kind, n in row.kinds.items()))
    return [*lines, ""]


def _slow(rows: list[Outcome]) -> list[str]:
    slow = sorted(rows, key=lambda row: -(row.new_seconds + row.run_seconds))[:25]
    lines = ["## Slowest", "", "| part | variant | new s | run s | CPU s | MB |", "|---|---|---|---|---|---|"]
    for row in slow:
        seconds = f"{row.new_seconds:.1f} | {row.run_seconds:.1f} | {row.cpu:.1f} | {row.peak_mb:.0f}"
        lines.append(f"| {row.part} | {row.variant} | {seconds} |")
    return [*lines, ""]


def _sentences(rows: list[Outcome]) -> list[str]:
    groups: dict[str, list[Outcome]] = defaultdict(list)
    for row in rows:
        if row.outcome in ("refused", "findings", "crash"):
            groups[NUMBERS.sub("N", row.detail.replace(row.part, "PART"))].append(row)
    lines = ["## Sentences", ""]
    for members in sorted(groups.values(), key=len, reverse=True):
        lines.append(
            f"- {len(members)} x {members[0].outcome}: {members[0].detail[:500]} ({members[0].part}, {members[0].variant})"
        )
    return [*lines, ""]
