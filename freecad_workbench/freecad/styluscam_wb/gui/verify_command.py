# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command "Verify": the job's operations of ours, posted in memory and compared with the model."""

from __future__ import annotations

from . import chosen
from .command import Command


class Verify(Command):
    """Verifies the job in front and lists the findings."""

    name = "Verify"
    icon = "verify"
    menu_text = "Verify"
    tool_tip = (
        "Posts the job's StylusCAM operations in memory, holds every move against the model and lists what it finds"
    )

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        return chosen.is_job_free()

    def run(self) -> None:
        """Verifies, then opens the panel."""
        import FreeCADGui

        from .. import verification
        from ..long_work import long_work
        from .findings_panel import FindingsPanel

        job = chosen.job()
        with long_work(f"{job.Label}: verification") as run:
            verified = verification.verify_job(job, run)
        FreeCADGui.Control.showDialog(FindingsPanel(verified))


def commands() -> list[Command]:
    """The command."""
    return [Verify()]
