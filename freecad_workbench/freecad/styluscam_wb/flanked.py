# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations that mill with the side of a leaning tool: where it stands, and what verification measures of their surfaces."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import documents, ops, verification
from .long_work import Run

if TYPE_CHECKING:
    from styluscam.judging.flanks import FlankSurface
    from styluscam.types import FloatArray

FLANK = "flank"
"""The kind of operation whose tool leans."""

PLURAL = "operations with a leaning tool"

WORDS = re.compile(r"([XYZIJK])(-?[\d.]+)")


class NoFlankError(ValueError):
    """There is no leaning tool, or no surface that was measured; the message states why."""

    hint = ""  # it stands in the message


@dataclass(frozen=True)
class Poses:
    """Where the tool stands at the ends of an operation's feed moves; document coordinates, mm."""

    tips: FloatArray
    """(N, 3)"""
    axes: FloatArray
    """Unit vectors (N, 3) from there up the tool."""


@dataclass(frozen=True)
class Flanked:
    """The surfaces of an operation, as its posted text leaves them."""

    surfaces: list[FlankSurface]
    allowed: float
    """What the operation allows to be left or cut too deep, mm."""


def is_flank(obj: Any) -> bool:
    """Whether an operation of ours mills with the side of a leaning tool."""
    return ops.is_of_kind(obj, FLANK)


def poses_of(obj: Any) -> Poses:
    """Where the tool stands along the path that an operation has.

    Raises:
        NoFlankError: it has none.
    """
    _refuse_others(obj)
    lines = [line for line in obj.Path.toGCode().splitlines() if line.startswith("G1 ")]
    found = [dict(WORDS.findall(line)) for line in lines]
    tips = np.array([[float(words[axis]) for axis in "XYZ"] for words in found]).reshape(-1, 3)
    axes = np.array(
        [[float(words.get(axis, up)) for axis, up in zip("IJK", (0, 0, 1), strict=True)] for words in found]
    )
    if not len(tips):
        raise NoFlankError(f"{obj.Label} has no path: compute it first")
    return Poses(tips, axes.reshape(-1, 3))


def _refuse_others(obj: Any) -> None:
    if not is_flank(obj):
        raise NoFlankError(f"{obj.Label} is not milled with the side of a leaning tool: select an operation that is")
    verification.refuse_uncomputed(obj)


def flanked_of(job: Any, obj: Any, run: Run) -> Flanked:
    """What an operation leaves of its surfaces, from its posted text; `run` runs what takes long.

    Raises:
        NoFlankError: the operation is of another kind.
        PostError, MotionError, ToolError, styluscam.StylusError: it is not computed, or cannot be posted.
    """
    _refuse_others(obj)
    draft = verification.draft_of(job, [obj], documents.machine_of(job))
    report = draft.report(draft.text_to_verify(), run)
    surfaces = [surface for one in report.flanks for surface in one.faces]
    if not surfaces:
        raise NoFlankError(f"{obj.Label}: verification measured no surface")
    return Flanked(surfaces, float(documents.operation_section(obj)["max_error"]))
