# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a command works on, or a sentence that states what to select."""

from __future__ import annotations

from typing import Any

import FreeCADGui

from .. import ops
from .command import job_in_front


class ChoiceError(ValueError):
    """It is not clear what is meant; the message states what to select."""

    hint = ""  # it stands in the message


def job() -> Any:
    """The job in front.

    Raises:
        ChoiceError: there is none, or it is not clear which.
    """
    found = job_in_front()
    if found is None:
        raise ChoiceError("no job is selected, and the document has none or several: select one")
    return found


def operation() -> Any:
    """The selected operation of ours, or the job's only one.

    Raises:
        ChoiceError: there is none, or it is not clear which.
    """
    selected = [obj for obj in FreeCADGui.Selection.getSelection() if ops.is_ours(obj)]
    ours = selected or [obj for obj in job().Operations.Group if ops.is_ours(obj)]
    if len(ours) != 1:
        raise ChoiceError(f"{len(ours) or 'no'} operations of StylusCAM are in question: select one")
    return ours[0]


def is_job_free() -> bool:
    """Whether there is a job in front, and no panel is open."""
    return job_in_front() is not None and not FreeCADGui.Control.activeDialog()
