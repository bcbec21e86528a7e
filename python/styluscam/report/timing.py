"""When the tool is where: seconds at the end of each move."""

from __future__ import annotations

import numpy as np

from styluscam.program import RAPID, Program
from styluscam.types import FloatArray

RAPID_RATE = 3000.0
"""mm/min, where the machine's own is not known; as :attr:`Program.duration` has it."""


def end_times(program: Program) -> FloatArray:
    """Seconds from the start to the end of each move, (N,), at the programmed feeds and with dwells.

    Acceleration is not counted; ways from or to places that are not known take no time.
    """
    moves = program.moves
    if not len(moves):
        return np.zeros(0)
    way = np.linalg.norm(np.diff(moves["end"], axis=0, prepend=moves["end"][:1]), axis=1)
    rate = np.where(moves["kind"] == RAPID, RAPID_RATE, moves["feed"])
    takes = np.divide(60.0 * way, rate, out=np.zeros(len(moves)), where=(rate > 0.0) & np.isfinite(way))
    for event in program.events:
        if event["kind"] == "dwell":
            takes[min(int(event["before"]), len(moves) - 1)] += float(event["seconds"])
    return np.cumsum(takes)
