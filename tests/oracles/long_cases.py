"""Cases of a test, of which some are left to ``make test-long``."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import Any

import pytest


def some_long(names: Iterable[str], long: Container[str]) -> list[Any]:
    """The names as parameters of a test; those in ``long`` with the mark of that name."""
    return [pytest.param(name, marks=[pytest.mark.long] if name in long else []) for name in names]
