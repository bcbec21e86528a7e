# SPDX-License-Identifier: LGPL-2.1-or-later
"""The error map: ruled surfaces in colours by what the moving tool leaves of them along their normals, with a legend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import flanked
from ..flanked import Flanked
from ..long_work import long_work
from . import chosen, legend, pictures, scene
from .command import Command
from .heat_colours import short
from .messages import translated
from .picture_command import PictureCommand
from .picture_switch import Shown

if TYPE_CHECKING:
    from styluscam.judging.flanks import FlankSurface
    from styluscam.types import FloatArray, IntArray

KEY = "flank"

SCALE: tuple[scene.Colour, ...] = (
    (165, 15, 21), (203, 55, 45), (239, 118, 87), (249, 185, 160), (242, 242, 240), (165, 200, 228), (92, 158, 209),
    (36, 108, 178), (8, 64, 129),
)  # fmt: skip
"""From what is cut too deep, red, over what is exact to what is left, blue: readable with any kind of colour vision."""

MISSED: scene.Colour = (0x6E, 0x6E, 0x6E)
"""Where the tool does not come."""

LEAST = 1e-3
"""The map's ends are this far from 0 at least, mm."""

UM = 1000.0
"""In a mm."""


def draw(job: Any, obj: Any) -> None:
    """Verifies an operation's path, then draws what it leaves.

    Raises:
        What `flanked.flanked_of` raises.
    """
    with long_work(f"{obj.Label}: error map") as run:
        shown = flanked.flanked_of(job, obj, run)
    show(job, obj, shown)


def show(job: Any, obj: Any, shown: Flanked) -> None:
    """Draws a map over the model."""
    end = _end(shown)
    nodes = [scene.separator("Surface", *_strip(surface, end)) for surface in shown.surfaces]
    worst = [at for at in map(_worst, shown.surfaces) if at is not None]
    marks = [scene.marker(point) for _, point in sorted(worst, key=lambda found: -abs(found[0]))[:1]]
    node = scene.separator("StylusCAM_Flank", *nodes, *marks)
    pictures.show(pictures.Picture(job.Document.Name, KEY, node, _card(obj, shown, end), operation=obj))


def _end(shown: Flanked) -> float:
    """What the ends of the scale stand for, mm: the largest error."""
    return max(LEAST, *(max(surface.over, surface.under) for surface in shown.surfaces))


def colours_of(left: FloatArray, end: float) -> IntArray:
    """The colour (N, 3) of what is left (N,), mm; `end` is that of the scale's last colour."""
    steps = np.array(SCALE, dtype=np.float64)
    known = np.isfinite(left)
    at = (np.clip(np.where(known, left, 0.0) / end, -1.0, 1.0) + 1.0) / 2.0 * (len(SCALE) - 1)
    found = np.stack([np.interp(at, np.arange(len(SCALE)), steps[:, k]) for k in range(3)], axis=1)
    found[~known] = MISSED
    return found.round().astype(np.int64)


def _strip(surface: FlankSurface, end: float) -> list[Any]:
    """A surface's points as triangles."""
    rows, columns = surface.left.shape
    at = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
    triangles = np.concatenate([np.stack(three, axis=-1).reshape(-1, 3) for three in ((a, b, c), (a, c, d))])
    along, across = np.gradient(surface.points, axis=(0, 1))
    normals = np.cross(along, across).reshape(-1, 3)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    points = surface.points.reshape(-1, 3)
    return scene.faces(points, triangles, normals, colours_of(surface.left.reshape(-1), end), covers=True)


def _worst(surface: FlankSurface) -> tuple[float, FloatArray] | None:
    """The largest error of a surface among its points, and where it is; None where the tool does not come at all."""
    sizes = np.where(np.isfinite(surface.left), np.abs(surface.left), -1.0)
    at = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    return None if sizes[at] < 0.0 else (float(surface.left[at]), surface.points[at])


def _card(obj: Any, shown: Flanked, end: float) -> legend.Card:
    card = legend.Card(KEY, f"{obj.Label}: {translated('error along the normals')}, µm")
    card.add_bar(SCALE, [f"-{short(end * UM)}", "0", f"+{short(end * UM)}"])
    card.add_line(
        f"{translated('red: cut too deep, blue: left over')}; {translated('allowed')}: {short(shown.allowed * UM)}"
    )
    if any(surface.missed > 0.0 for surface in shown.surfaces):
        card.add_swatch(MISSED, translated("the tool does not come there"))
    for surface in shown.surfaces:
        over, under = (short(value * UM) for value in (surface.over, surface.under))
        figures = f"{translated('too deep')} {over}, {translated('left over')} {under}"
        missed = f", {translated('missed')} {100.0 * surface.missed:.1f} %" if surface.missed > 0.0 else ""
        card.add_line(f"{surface.name}: {figures}{missed}")
    return card


class ShowFlank(PictureCommand):
    """Draws the map of an operation of the job in front; takes it away where it is shown."""

    key = KEY
    name = "FlankMap"
    icon = "flank-map"
    menu_text = "Error map"
    tool_tip = "Colours ruled surfaces by what the side of the moving tool leaves of them or cuts too deep; again to take it away"

    def draw(self, job: Any) -> None:
        """Verifies, then draws."""
        draw(job, chosen.operation(flanked.is_flank, flanked.PLURAL))


class FlankPreview(Shown):
    """The map in the panel."""

    key = KEY
    name = ShowFlank.name
    menu_text = ShowFlank.menu_text
    tool_tip = "Colours the surfaces by what the moving tool leaves of them or cuts too deep; Apply computes the path"

    def applies(self, obj: Any) -> bool:
        """To operations whose tool leans."""
        return flanked.is_flank(obj)

    def draw(self, job: Any, obj: Any) -> None:
        """Verifies, then draws."""
        draw(job, obj)


def commands() -> list[Command]:
    """The command."""
    return [ShowFlank()]
