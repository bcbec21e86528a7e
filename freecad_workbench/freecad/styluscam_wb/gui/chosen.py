# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a command works on, or a sentence that states what to select."""

from __future__ import annotations

from collections.abc import Callable
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


def operation(applies: Callable[[Any], bool] = ops.is_ours, plural: str = "operations of StylusCAM") -> Any:
    """The selected operation of ours, or the job's only one that applies; `plural` names those.

    Raises:
        ChoiceError: there is none, or it is not clear which.
    """
    selected = [obj for obj in FreeCADGui.Selection.getSelection() if ops.is_ours(obj)]
    found = selected or [obj for obj in job().Operations.Group if applies(obj)]
    if len(found) != 1:
        raise ChoiceError(f"{len(found) or 'no'} {plural} are in question: select one")
    return found[0]


def is_job_free() -> bool:
    """Whether there is a job in front, and no panel is open."""
    return job_in_front() is not None and not FreeCADGui.Control.activeDialog()
