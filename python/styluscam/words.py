"""Times and places as people read them."""

from __future__ import annotations

from collections.abc import Sequence


def clock(seconds: float) -> str:
    """Hours, minutes and seconds."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def place(point: Sequence[float]) -> str:
    """Coordinates as G-code names them."""
    return " ".join(f"{axis}{value:.3f}" for axis, value in zip("XYZ", point, strict=True))
