# SPDX-License-Identifier: LGPL-2.1-or-later
"""From an exception to an exit code and a record: what, where, what to do."""

from __future__ import annotations

import traceback
from typing import Any

FOUND, INPUT, CANCELLED, FAULT = 1, 2, 3, 4
"""Exit codes besides 0: verification found an error; wrong input; cancelled; a fault of ours."""

ADDON = __name__.rpartition(".headless")[0]
"""Errors that this package raises are about what it was given."""


class RunError(ValueError):
    """A document or a request that cannot be run; the message states what, where and what to do."""


class FailedOperationError(RunError):
    """Carries an operation's error, its cause, with the operation's label."""

    def __init__(self, label: str) -> None:
        super().__init__(label)
        self.label = label


def record(error: BaseException, where: str = "") -> dict[str, Any]:
    """An error as plain data; with a traceback where it is a fault of ours."""
    if isinstance(error, FailedOperationError) and error.__cause__ is not None:
        found = record(error.__cause__, where)
        message = found["message"].removeprefix(f"{error.label}: ")
        return found | {"message": f"{error.label}: {message}"}
    exit_code = code_of(error)
    found = {
        "class": type(error).__name__,
        "code": str(
            getattr(error, "code", "") or ("internal" if exit_code == FAULT else _dashed(type(error).__name__))
        ),
        "where": str(getattr(error, "where", "") or where),
        "message": _message(error, exit_code),
        "hint": str(getattr(error, "hint", "") or ""),
        "exit_code": exit_code,
    }
    if exit_code == FAULT:
        found["traceback"] = "".join(traceback.format_exception(error))
    return found


def code_of(error: BaseException) -> int:
    """The exit code that an error asks for."""
    if _is(error, "VerificationError"):
        return FOUND
    if _is(error, "StylusError"):
        return {"cancelled": CANCELLED, "internal": FAULT}.get(str(getattr(error, "code", "")), INPUT)
    if isinstance(error, MemoryError) or type(error).__module__.startswith(ADDON):
        return INPUT
    return FAULT


def _message(error: BaseException, exit_code: int) -> str:
    if isinstance(error, MemoryError):
        return "not enough memory for this model at this tolerance: give a larger ModelTolerance"
    return f"a fault of StylusCAM: {error!r}" if exit_code == FAULT else " ".join(str(error).split())


def _is(error: BaseException, name: str) -> bool:
    """By name: the engine may be what is missing."""
    return any(kind.__name__ == name for kind in type(error).__mro__)


def _dashed(name: str) -> str:
    """PostError as post-error."""
    return "".join(f"-{letter.lower()}" if letter.isupper() else letter for letter in name).lstrip("-")
