"""What tests do where a program from outside cannot be had."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

import pytest

import roots


@contextlib.contextmanager
def needed(what: str) -> Iterator[None]:
    """Fails where everything must be tested; elsewhere reports loudly what was not."""
    try:
        yield
    except roots.Unavailable as reason:
        if os.environ.get("CI"):
            pytest.fail(f"{what} is needed: {reason}")
        pytest.skip(f"NOT TESTED with {what}: {reason}")
