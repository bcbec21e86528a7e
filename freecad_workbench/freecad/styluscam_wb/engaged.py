# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engagement angle along a pocket's path: of its posted text, read back as the machine reads it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import documents, engine, motion_track, ops, tools, verification
from .long_work import Run

if TYPE_CHECKING:
    from styluscam.judging.engagement_map import EngagementMap

POCKET = "pocket"
"""The kind of operation whose engagement is bounded."""

POINTS = 150_000
"""Of a map that is drawn at most: a view that is turned redraws all of them."""


class NoEngagementError(ValueError):
    """There is no path whose engagement is bounded; the message states why."""

    hint = ""  # it stands in the message


@dataclass(frozen=True)
class Engaged:
    """A measured path; positions in document coordinates, mm."""

    found: EngagementMap
    bound_deg: float
    """What the operation asks for."""


def is_pocket(obj: Any) -> bool:
    """Whether an operation of ours has an engagement that is bounded."""
    return ops.is_of_kind(obj, POCKET)


def is_computed(obj: Any) -> bool:
    """Whether a path is there that belongs to what the operation shows."""
    return ops.has_motion(obj) and not {"Touched", "Invalid"} & set(obj.State)


def engaged_of(job: Any, obj: Any, run: Run) -> Engaged:
    """The engagement along the path of a pocket; `run` runs what takes long.

    Raises:
        NoEngagementError: the operation is none.
        PostError, MotionError, ToolError, styluscam.StylusError: it is not computed, or cannot be posted.
    """
    if not is_pocket(obj):
        raise NoEngagementError(f"{obj.Label} is no pocket: only a pocket's engagement angle is bounded; select one")
    verification.refuse_uncomputed(obj)
    from styluscam.judging.engagement_map import Stock, engagement_map

    program = motion_track.track_of(job, obj).subject.program
    section = documents.operation_section(obj)
    low, high = ops.engine_part(obj, run).bounds
    hole = section.get("entry_hole")
    stock = Stock(
        (float(low[0]), float(low[1])),
        (float(high[0]), float(high[1])),
        float(section.get("z_top", high[2])),
        [(hole["x"], hole["y"], hole["diameter"])] if hole else (),
    )
    tool = engine.styluscam().Tool.from_dict(tools.tool_document(obj.ToolController.Tool))
    found: EngagementMap = run(lambda progress: engagement_map(program, tool, stock, progress))
    return Engaged(found.thinned(POINTS), section["engagement_deg"] + section.get("growth_deg", 0.0))
