"""The errors that reach a user: one tree, each with a stable code, a position and a hint."""

from __future__ import annotations

import re
from collections.abc import Callable

LONG = re.compile(r"(?<== )-?(?:\d{17,}(?:\.\d+)?|0\.0{6,}\d+)")
"""A value with more digits than a number has."""


class StylusError(Exception):
    """Base of all; the message is one line: what, where, what to do."""

    def __init__(self, message: str, *, code: str, where: str = "", hint: str = "") -> None:
        """`code` is stable; `where` is a path in the job document or file:line; `hint` states what to do."""
        super().__init__(LONG.sub(lambda found: f"{float(found[0]):g}", message))
        self.code = code
        self.where = where
        self.hint = hint

    def __reduce__(self) -> tuple[Callable[..., StylusError], tuple[object, ...]]:
        """For pickle and copy, which know nothing of keywords: errors come out of worker processes too."""
        return _again, (type(self), str(self), self.code, self.where, self.hint)


def _again(kind: type[StylusError], message: str, code: str, where: str, hint: str) -> StylusError:
    """An error as it was."""
    return kind(message, code=code, where=where, hint=hint)


class JobError(StylusError):
    """The job document is wrong."""


class GeometryError(StylusError):
    """A part cannot be read, or its geometry cannot be used."""


class ToolError(StylusError):
    """A tool's profile or measures are wrong."""


class PlanError(StylusError):
    """No path can be planned."""


class MachineError(StylusError):
    """A machine file, a post or a program for a machine is wrong."""


class VerifyError(StylusError):
    """Verification could not be carried out."""


class Cancelled(StylusError):
    """The user stopped the work."""
