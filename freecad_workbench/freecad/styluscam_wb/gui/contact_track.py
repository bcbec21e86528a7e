# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command "Contact track": where the tool touches the model along the job's paths, as a line in the view."""

from __future__ import annotations

from typing import Any

from .. import contacts, verification
from ..contacts import ContactTrack
from ..long_work import long_work
from . import legend, pictures, scene
from .command import Command
from .messages import translated
from .picture_command import PictureCommand

KEY = "contacts"

COLOUR: scene.Colour = (0xD0, 0x1C, 0x8B)
"""Magenta: not a colour of paths, and apart from all of a heat map's scale."""

WIDTH = 2.5


class NoContactError(ValueError):
    """The tool touches the model nowhere; the message states where to look."""

    hint = ""  # it stands in the message


def show(job: Any, track: ContactTrack) -> None:
    """Draws a track."""
    drawn = scene.lines(track.points, scene.through(track.runs), COLOUR, WIDTH)
    node = scene.separator("StylusCAM_ContactTrack", *drawn)
    card = legend.Card(KEY, translated("Contact track"))
    text = translated("{count} measured contacts; between them along the path")
    card.add_swatch(COLOUR, text.format(count=len(track.measured)))
    pictures.show(pictures.Picture(job.Document.Name, KEY, node, card))


class ShowContactTrack(PictureCommand):
    """Verifies the job in front and draws its contacts; takes them away where they are shown."""

    key = KEY
    name = "ContactTrack"
    icon = "contact-track"
    menu_text = "Contact track"
    tool_tip = "Draws where the tool touches the model along the job's paths; again to take it away"

    def draw(self, job: Any) -> None:
        """Verifies, then draws."""
        with long_work(f"{job.Label}: contacts") as run:
            verified = verification.verify_job(job, run)
        track = contacts.track_of(verified)
        if not track.runs:
            raise NoContactError(f"{job.Label}: the tool touches the model nowhere: verify it to see why")
        show(job, track)


def commands() -> list[Command]:
    """The command."""
    return [ShowContactTrack()]
