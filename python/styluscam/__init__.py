"""StylusCAM: toolpaths for tools of any convex shape, from CAD faces to verified G-code.

Lengths are mm, angles rad (degrees where a name ends in ``_deg``), feeds mm/min. Arrays are float64 numpy,
C order. Every long call takes ``progress(phase, fraction)``, which is called on the calling thread and cancels by
returning ``False`` (a phase may come again: levels that were missing are looked for after the others), and ``cancel``, a
:class:`CancelToken`; the GIL is released meanwhile, and the same input gives the same bytes for any number of threads.
"""

from __future__ import annotations

from styluscam._engine import CancelToken, __version__
from styluscam.errors import (
    Cancelled,
    GeometryError,
    JobError,
    MachineError,
    PlanError,
    StylusError,
    ToolError,
    VerifyError,
)
from styluscam.judging.simulation import Simulation, simulate
from styluscam.judging.verification import Report, check_program, verify, verify_file
from styluscam.offset.positions import drop_cutter, push_cutter, slope_matched_offset, waterline, waterlines
from styluscam.offset.surface import OffsetSurface, offset_surface
from styluscam.parts.part import Part
from styluscam.programs.job import Job, job_schema, starter_job
from styluscam.programs.machine import Machine
from styluscam.programs.planning import Plan, Posted, plan, post, read_gcode
from styluscam.programs.program import Program
from styluscam.programs.running import RunResult, run
from styluscam.tools.tool import Tool

__all__ = [
    "CancelToken",
    "Cancelled",
    "GeometryError",
    "Job",
    "JobError",
    "Machine",
    "MachineError",
    "OffsetSurface",
    "Part",
    "Plan",
    "PlanError",
    "Posted",
    "Program",
    "Report",
    "RunResult",
    "Simulation",
    "StylusError",
    "Tool",
    "ToolError",
    "VerifyError",
    "__version__",
    "check_program",
    "drop_cutter",
    "job_schema",
    "offset_surface",
    "plan",
    "post",
    "push_cutter",
    "read_gcode",
    "run",
    "simulate",
    "slope_matched_offset",
    "starter_job",
    "verify",
    "verify_file",
    "waterline",
    "waterlines",
]


def __dir__() -> list[str]:
    """The public names only; modules are imported by theirs."""
    return sorted(__all__)
