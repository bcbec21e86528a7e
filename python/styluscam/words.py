"""Times, counts and positions as people read them."""

from __future__ import annotations

from collections.abc import Sequence


def clock(seconds: float) -> str:
    """Hours, minutes and seconds."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def counted(number: int, one: str, many: str = "") -> str:
    """A number with its word: ``1 pass``, ``2 passes``."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def size(low: Sequence[float], high: Sequence[float]) -> str:
    """A box by its three lengths, mm."""
    return f"{' x '.join(f'{b - a:.6g}' for a, b in zip(low, high, strict=True))} mm"


def shortened(text: str, length: int = 60) -> str:
    """A text on one line, cut where it is longer."""
    line = " ".join(text.split())
    return line if len(line) <= length else f"{line[: length - 3]}..."


def position(point: Sequence[float]) -> str:
    """Coordinates as G-code names them."""
    return " ".join(f"{axis}{value:.3f}" for axis, value in zip("XYZ", point, strict=True))
