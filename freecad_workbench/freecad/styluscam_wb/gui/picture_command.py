# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command that draws a picture of the job in front, and takes it away where it is shown."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

from . import chosen, pictures
from .command import Command, job_in_front


class PictureCommand(Command):
    """Draws on the first use, takes away on the next."""

    key: str
    """Of its picture."""

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        return chosen.is_job_free()

    def run(self) -> None:
        """Shows, or takes away."""
        shown_for = job_in_front()
        if shown_for is None or not pictures.remove(shown_for.Document.Name, self.key):
            self.draw(chosen.job())

    @abstractmethod
    def draw(self, job: Any) -> None:
        """Shows the picture of a job."""
