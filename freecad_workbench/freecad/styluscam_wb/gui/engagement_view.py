# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engagement map: a pocket's path in colours by its engagement angle, from 0 to the bound, with a legend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import engaged
from ..engaged import Engaged
from ..long_work import long_work
from . import chosen, heat_colours, legend, path_colours, pictures, scene
from .command import Command
from .heat_colours import short
from .messages import translated
from .picture_command import PictureCommand
from .picture_switch import Shown

if TYPE_CHECKING:
    from styluscam.types import IntArray

KEY = "engagement"

WIDTH = 2.0

ABOVE_DEG = 0.5
"""What the bound may be exceeded by, as in the verification."""

NOTHING_DEG = 0.05
"""A smaller angle is none: a link through what is cleared."""

FREE: scene.Colour = (0x8C, 0x96, 0xA0)
"""Of moves that engage nothing; grey, visible on light and dark."""

ENTRY: scene.Colour = path_colours.KINDS[path_colours.DOWN].colour


def colours_of(shown: Engaged) -> IntArray:
    """The colour (N, 3) of each position."""
    angles, is_entry = shown.found.angles_deg, shown.found.is_entry.astype(bool)
    found = heat_colours.scaled(angles / shown.bound_deg)
    found[angles < NOTHING_DEG] = FREE
    found[angles > shown.bound_deg + ABOVE_DEG] = heat_colours.OVER
    found[is_entry] = ENTRY
    return found


def show(job: Any, obj: Any, shown: Engaged) -> None:
    """Draws a map in place of the operation's path."""
    name = str(job.Document.Name)
    runs = np.split(np.arange(len(shown.found.points)), shown.found.ends[:-1])
    index = scene.through([run for run in runs if len(run) > 1])
    nodes = scene.coloured_lines(shown.found.points, index, colours_of(shown), WIDTH)
    worst = shown.found.worst
    marks = [] if worst is None else [scene.marker(shown.found.points[worst])]
    node = scene.separator("StylusCAM_Engagement", *nodes, *marks)

    def path_legend() -> None:
        path_colours.show_legend(name)

    pictures.show(pictures.Picture(name, KEY, node, _card(obj, shown), [obj], path_legend, obj))


def _card(obj: Any, shown: Engaged) -> legend.Card:
    found, bound = shown.found, shown.bound_deg
    card = legend.Card(KEY, f"{obj.Label}: {translated('engagement angle')}, deg")
    card.add_bar(heat_colours.SCALE, ["0", short(bound / 2.0), short(bound)])
    card.add_swatch(FREE, translated("engages nothing"))
    if found.is_entry.any():
        card.add_swatch(ENTRY, translated("entry: not bounded"))
    if found.worst is None:
        card.add_line(translated("nowhere"))
        return card
    largest = float(found.angles_deg[found.worst])
    if largest > bound + ABOVE_DEG:
        card.add_swatch(heat_colours.OVER, f"> {short(bound)}")
    x, y, z = found.points[found.worst]
    card.add_line(f"{translated('largest')}: {largest:.1f}\n{translated('at')} X {x:.3f} Y {y:.3f} Z {z:.3f}")
    return card


def draw(job: Any, obj: Any) -> None:
    """Measures an operation's path, then draws it.

    Raises:
        What `engaged.engaged_of` raises.
    """
    with long_work(f"{obj.Label}: engagement") as run:
        shown = engaged.engaged_of(job, obj, run)
    show(job, obj, shown)


class ShowEngagement(PictureCommand):
    """Draws the map of a pocket of the job in front; takes it away where it is shown."""

    key = KEY
    name = "EngagementMap"
    icon = "engagement-map"
    menu_text = "Engagement map"
    tool_tip = "Colours a pocket's path by its engagement angle, from 0 to the bound; again to take it away"

    def draw(self, job: Any) -> None:
        """Measures, then draws."""
        draw(job, chosen.operation(engaged.is_pocket, "pockets"))


class EngagementPreview(Shown):
    """The map in a pocket's panel."""

    key = KEY
    name = ShowEngagement.name
    menu_text = ShowEngagement.menu_text
    tool_tip = "Colours the path by its engagement angle, from 0 to the bound; Apply computes the path"

    def applies(self, obj: Any) -> bool:
        """To pockets."""
        return engaged.is_pocket(obj)

    def draw(self, job: Any, obj: Any) -> None:
        """Measures, then draws."""
        draw(job, obj)


def commands() -> list[Command]:
    """The command."""
    return [ShowEngagement()]
