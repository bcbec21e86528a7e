"""Progress and cancelling, as every long call of the package has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from ..errors import Cancelled

Progress: TypeAlias = Callable[[str, float], bool | None]


def report(progress: Progress | None, phase: str, fraction: float) -> None:
    """Tell `progress` where we are; raises Cancelled when it answers False."""
    if progress is not None and progress(phase, fraction) is False:
        raise Cancelled("cancelled while reading the part", code="cancelled", where="part")
