"""The public names with their types; ``__init__.py`` loads them when they are used."""

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
from styluscam.flank.path import flank_program
from styluscam.flank.positions import FlankError, FlankPositions, flank_positions
from styluscam.flank.rails import Rail
from styluscam.judging.engagement import RunEngagement, engagement
from styluscam.judging.simulation import Simulation, simulate
from styluscam.judging.verification import Report, check_program, verify, verify_file
from styluscam.offset.positions import drop_cutter, push_cutter, slope_matched_offset, waterline, waterlines
from styluscam.offset.surface import OffsetSurface, offset_surface
from styluscam.parts.part import Part
from styluscam.pocketing.path import PocketPath, pocket_path
from styluscam.programs.cutting import CuttingData, cutting_data
from styluscam.programs.job import Job, job_schema, starter_job
from styluscam.programs.machine import Machine
from styluscam.programs.planning import Plan, Posted, plan, post, read_gcode
from styluscam.programs.program import Program
from styluscam.programs.running import RunResult, run
from styluscam.tools.tool import Tool

__all__ = [
    "CancelToken",
    "Cancelled",
    "CuttingData",
    "FlankError",
    "FlankPositions",
    "GeometryError",
    "Job",
    "JobError",
    "Machine",
    "MachineError",
    "OffsetSurface",
    "Part",
    "Plan",
    "PlanError",
    "PocketPath",
    "Posted",
    "Program",
    "Rail",
    "Report",
    "RunEngagement",
    "RunResult",
    "Simulation",
    "StylusError",
    "Tool",
    "ToolError",
    "VerifyError",
    "__version__",
    "check_program",
    "cutting_data",
    "drop_cutter",
    "engagement",
    "flank_positions",
    "flank_program",
    "job_schema",
    "offset_surface",
    "plan",
    "pocket_path",
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
