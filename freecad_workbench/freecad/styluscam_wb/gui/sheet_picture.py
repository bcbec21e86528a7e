# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command "Sheet": the job's blank, its formed sheet and its die, instead of FreeCAD's block of stock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import sheet
from ..long_work import long_work
from . import legend, pictures, scene
from .command import Command
from .messages import translated
from .picture_command import PictureCommand

if TYPE_CHECKING:
    from styluscam.drawing.shapes import Shape

KEY = "sheet"

NODE = "StylusCAM_Sheet"

OUTLINE = 0.5
"""Of a colour: that of its edges."""

EDGE = 1.0
"""Width of an edge, pixels."""


def show(job: Any, shapes: tuple[Shape, ...]) -> None:
    """Draws the shapes; the stock and the model, for which they stand, are not drawn meanwhile."""
    card = legend.Card(KEY, translated("Sheet"))
    parts = []
    # what one looks through comes last
    for shape in sorted(shapes, key=lambda one: -one.look.opacity):
        parts.append(_node(shape))
        card.add_swatch(shape.look.colour, translated(shape.words))
    node = scene.separator(NODE, *parts)
    hidden = [*pictures.stands_for(job), *([job.Stock] if job.Stock is not None else [])]
    pictures.show(pictures.Picture(job.Document.Name, KEY, node, card, hidden))


def _node(shape: Shape) -> Any:
    """Its faces and its edges."""
    dark = tuple(int(OUTLINE * part) for part in shape.look.colour)
    colours = np.tile(np.array(shape.look.colour), (len(shape.vertices), 1))
    faces = scene.faces(shape.vertices, shape.triangles, shape.normals, colours, 1.0 - shape.look.opacity)
    edges = scene.lines(shape.vertices, scene.between(shape.edges), (dark[0], dark[1], dark[2]), EDGE)
    return scene.separator(f"{NODE}_{shape.key.replace('-', '_')}", *faces, *edges)


class ShowSheet(PictureCommand):
    """Draws the sheet of the job in front; takes it away where it is shown."""

    key = KEY
    name = "Sheet"
    icon = "sheet"
    menu_text = "Sheet"
    tool_tip = "Draws the job's blank, formed sheet and die instead of the block of stock; again to take them away"

    def draw(self, job: Any) -> None:
        """Makes the shapes, then draws them."""
        with long_work(f"{job.Label}: sheet") as run:
            shapes = sheet.shapes_of(job, run)
        show(job, shapes)


def commands() -> list[Command]:
    """The command."""
    return [ShowSheet()]
