# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors as sentences, and which of them a user can mend."""

from __future__ import annotations

from . import documents, engine, machines, motion, properties, tool_keys, tools, wires


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


def reason(error: BaseException) -> str:
    """An error's message, and its hint what to do."""
    hint = getattr(error, "hint", "")
    message = str(error) or type(error).__name__
    return f"{message}: {hint}" if hint and hint not in message else message
