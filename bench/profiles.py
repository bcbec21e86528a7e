"""Measures profiles: how long a tool of each kind takes to build, and a million slopes to answer, on one thread.

python bench/profiles.py
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import styluscam as sc
from styluscam.tools import starters

SLOPES = 1_000_000
REPEATS = 5


def best_of(work: Callable[[], object]) -> float:
    """Seconds of the quickest repeat."""
    times = []
    for _ in range(REPEATS):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def main() -> None:
    print(f"{'kind':<20}{'build, ms':>12}{'1e6 slopes, ms':>16}")
    for kind in starters.PROFILES:
        document = {"profile": starters.PROFILES[kind]}
        tool = sc.Tool.from_dict(document)
        slopes = np.random.default_rng(1).uniform(0.0, tool.max_slope, SLOPES)
        build = best_of(lambda document=document: sc.Tool.from_dict(document))
        answer = best_of(lambda tool=tool, slopes=slopes: tool.radius_at(slopes))
        print(f"{kind:<20}{1e3 * build:>12.3f}{1e3 * answer:>16.1f}")


if __name__ == "__main__":
    main()
