# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors as sentences, and which of them a user can mend."""

from __future__ import annotations

from . import documents, engine, key_labels, machines, motion, properties, tool_keys, tools, wires
from .texts import translated


class OperationError(ValueError):
    """An operation that cannot be computed; the message states why and what to do."""


EXPECTED = (
    OperationError,
    documents.DocumentError,
    engine.EngineMissingError,
    machines.ArgumentError,
    motion.MotionError,
    properties.PropertyError,
    tool_keys.ValueTextError,
    tools.ToolError,
    wires.WireError,
)
"""Errors of the addon that state what a user can do; the engine's have a hint."""


def is_fault(error: BaseException) -> bool:
    """Whether an error is a fault of ours, and not something that a user can mend: its traceback is worth printing."""
    return not (isinstance(error, EXPECTED) or hasattr(error, "hint"))


def sentence(error: BaseException, message: str = "", hint: str = "") -> str:
    """An error's message, and its hint what to do; both as they are, or as they are given."""
    message = message or str(error) or type(error).__name__
    hint = hint or getattr(error, "hint", "")
    return f"{message}: {hint}" if hint and hint not in message else message


def reason(error: BaseException) -> str:
    """An error's message, and its hint what to do, in the words of an operation's panel."""
    if not hasattr(error, "hint"):
        return sentence(error)
    where = str(getattr(error, "where", ""))
    return sentence(error, in_labels(str(error), where), in_labels(error.hint, where))


def in_labels(text: str, where: str = "operations") -> str:
    """A text of the engine's in the words of the panel; `where` is the path in the job document that it is about."""
    return key_labels.in_labels(text, where, properties.fields(), translated) if engine.is_there() else text
