# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sheet of a job, flat and formed, with its die, in the document's coordinates: what is drawn instead of a block of stock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import documents, engine, ops, properties, verification
from .long_work import Run

if TYPE_CHECKING:
    from styluscam.drawing.shapes import Shape


class NoSheetError(ValueError):
    """The job has no sheet to show; the message states why."""

    hint = ""  # it stands in the message


def shapes_of(job: Any, run: Run) -> tuple[Shape, ...]:
    """The shapes of the job's sheet, as its first operation of ours with a sheet describes it; `run` runs what takes long.

    Raises:
        NoSheetError: no active operation forms a sheet.
        DocumentError, ToolError, styluscam.StylusError: it is not described yet, or the model cannot be read.
    """
    ours = [obj for obj in verification.active_operations(job) if ops.is_ours(obj)]
    forming = [obj for obj in ours if properties.takes_sheet(obj)]
    if not forming:
        raise NoSheetError(
            f"{job.Label} has no active operation of StylusCAM that forms a sheet: there is none to show"
        )
    first = forming[0]
    sc = engine.styluscam()
    part = ops.engine_part(first, run)
    described = sc.Job.from_dict(documents.job_document(job, [first], part, documents.machine_of(job)), part=part)
    from styluscam.drawing.shapes import shapes_of as made

    shapes: tuple[Shape, ...] = run(lambda _: made(described, described.scene()))
    return shapes
