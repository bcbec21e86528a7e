# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool's positions along the path of an operation whose tool leans: its axis at each, and what it sweeps."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import flanked
from ..flanked import Poses
from . import chosen, legend, pictures, scene
from .command import Command
from .messages import translated
from .picture_command import PictureCommand
from .picture_switch import Shown

KEY = "axes"

AXIS: scene.Colour = (0x00, 0x9E, 0x8F)
"""Of the tool's axis; seen on light and dark views, and beside the colours of paths."""

WIDTH = 1.5

USUAL = 30.0
"""How long the axis is drawn of a tool that states no length, mm."""


def draw(job: Any, obj: Any) -> None:
    """Draws the axes along an operation's path.

    Raises:
        NoFlankError, PostError: it has none.
    """
    poses = flanked.poses_of(obj)
    length = _length(obj)
    count = len(poses.tips)
    points = np.concatenate([poses.tips, poses.tips + length * poses.axes])
    at = np.arange(count)
    index = np.concatenate([scene.between(np.stack([at, at + count], axis=1)), at + count, [-1]])
    node = scene.separator("StylusCAM_Axes", *scene.lines(points, index, AXIS, WIDTH))
    pictures.show(pictures.Picture(job.Document.Name, KEY, node, _card(obj, poses, length), operation=obj))


def _length(obj: Any) -> float:
    """How long the axis is drawn: as long as the tool's cutting edge."""
    tool = obj.ToolController.Tool
    lengths = (float(getattr(getattr(tool, name, None), "Value", 0.0)) for name in ("CuttingEdgeHeight", "Length"))
    return next((length for length in lengths if length > 0.0), USUAL)


def _card(obj: Any, poses: Poses, length: float) -> legend.Card:
    lean = np.degrees(np.arccos(np.clip(poses.axes[:, 2], -1.0, 1.0)))
    card = legend.Card(KEY, f"{obj.Label}: {translated('tool axes')}")
    card.add_swatch(AXIS, f"{len(poses.tips)} {translated('positions')}, {length:g} mm {translated('from the tip up')}")
    card.add_line(f"{translated('leans by')} {lean.min():.1f} {translated('to')} {lean.max():.1f} deg")
    return card


class ShowAxes(PictureCommand):
    """Draws the axes of an operation of the job in front; takes them away where they are shown."""

    key = KEY
    name = "ToolAxes"
    icon = "tool-axes"
    menu_text = "Tool axes"
    tool_tip = "Draws the axis of a leaning tool at each position of its path; again to take it away"

    def draw(self, job: Any) -> None:
        """Draws."""
        draw(job, chosen.operation(flanked.is_flank, flanked.PLURAL))


class AxesPreview(Shown):
    """The axes in the panel."""

    key = KEY
    name = ShowAxes.name
    menu_text = ShowAxes.menu_text
    tool_tip = "Draws the tool's axis at each position of the path; Apply computes the path"

    def applies(self, obj: Any) -> bool:
        """To operations whose tool leans."""
        return flanked.is_flank(obj)

    def draw(self, job: Any, obj: Any) -> None:
        """Draws."""
        draw(job, obj)


def commands() -> list[Command]:
    """The command."""
    return [ShowAxes()]
