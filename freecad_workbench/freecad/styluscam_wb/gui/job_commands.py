# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM's own commands at both ends of a job, under our names: making it and posting it."""

from __future__ import annotations

from .. import post_list, settings
from . import posted_files
from .command import Command, job_in_front


class MakeJob(Command):
    """CAM's dialog of a new job."""

    name = "Job"
    icon = "job"
    menu_text = "New job"
    tool_tip = "Makes a CAM job of the selected model"

    def run(self) -> None:
        """Opens it."""
        import FreeCADGui

        with post_list.beginning_with(settings.machine()):
            FreeCADGui.runCommand("CAM_Job")


class Post(Command):
    """CAM's own posting, which verifies what is ours."""

    name = "Post"
    icon = "post"
    menu_text = "Post"
    tool_tip = "Writes the machine's program of the job; paths of StylusCAM are verified before"

    def IsActive(self) -> bool:
        """With a job."""
        return job_in_front() is not None

    def run(self) -> None:
        """Selects the job and posts it."""
        import FreeCADGui

        from ..posts import processor

        job = job_in_front()
        posted_files.check_target(job)
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)
        with processor.kept_refusals() as refused, posted_files.named_in_status_bar(job):
            FreeCADGui.runCommand("CAM_Post")
        if refused:
            raise refused[0]


def before() -> list[Command]:
    """What comes before operations."""
    return [MakeJob()]


def after() -> list[Command]:
    """What comes after them."""
    return [Post()]
