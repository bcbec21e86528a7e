"""Progress and cancelling, as every long call of the package has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from styluscam.errors import Cancelled

Progress: TypeAlias = Callable[[str, float], bool | None]


def report(progress: Progress | None, phase: str, fraction: float) -> None:
    """Report a phase to `progress`; raises Cancelled when it answers False."""
    if progress is not None and progress(phase, fraction) is False:
        raise Cancelled("cancelled while reading the part", code="cancelled", where="part")


class AttemptSteps:
    """Progress of meshing and checking, which may take several attempts: it moves on, and never back."""

    # Where the first attempt begins and the last would end; what an attempt leaves of that range; the mesher's part of it.
    BEGIN, END, LEFT, MESHER = 0.3, 0.9, 0.25, 1.0 / 3.0
    STEP = 0.005

    def __init__(self, progress: Progress | None) -> None:
        """Report to `progress`."""
        self.progress = progress
        self.attempt = -1
        self.reported = 0.0

    def begin(self) -> None:
        """The mesher starts once more."""
        self.attempt += 1
        self._report("mesh", 0.0)

    def checked(self, share: float) -> None:
        """This share of the mesher's triangles is checked."""
        self._report("check", self.MESHER + (1.0 - self.MESHER) * share)

    def _report(self, phase: str, share: float) -> None:
        span = self.END - self.BEGIN
        start, end = (self.END - span * self.LEFT**k for k in (self.attempt, self.attempt + 1))
        now = start + (end - start) * share
        if now >= self.reported + self.STEP or share == 0.0:
            self.reported = max(now, self.reported)
            report(self.progress, phase, self.reported)
