"""StylusCAM: toolpaths for tools of any convex shape, from CAD faces to verified G-code.

Lengths are mm, angles rad (degrees where a name ends in ``_deg``), feeds mm/min. Arrays are float64 numpy,
C order. Every long call takes ``progress(phase, fraction)``, which is called on the calling thread and cancels by
returning ``False`` (a phase may come again: levels that were missing are looked for after the others), and ``cancel``, a
:class:`CancelToken`; the GIL is released meanwhile, and the same input gives the same bytes for any number of threads.

The names are loaded from their modules when they are first used; their types stand in ``__init__.pyi``.
"""

from __future__ import annotations

import importlib

from styluscam._engine import CancelToken, __version__

_MODULES = {
    "errors": (
        "Cancelled", "GeometryError", "JobError", "MachineError", "PlanError", "StylusError", "ToolError", "VerifyError",
    ),
    "flank.path": ("flank_program",),
    "flank.positions": ("FlankError", "FlankPositions", "flank_positions"),
    "flank.rails": ("Rail",),
    "judging.engagement": ("RunEngagement", "engagement"),
    "judging.simulation": ("Simulation", "simulate"),
    "judging.verification": ("Report", "check_program", "verify", "verify_file"),
    "offset.positions": ("drop_cutter", "push_cutter", "slope_matched_offset", "waterline", "waterlines"),
    "offset.surface": ("OffsetSurface", "offset_surface"),
    "parts.part": ("Part",),
    "pocketing.contour": ("contour_path",),
    "pocketing.path": ("PocketPath", "pocket_path"),
    "programs.cutting": ("CuttingData", "cutting_data"),
    "programs.job": ("Job", "job_schema", "starter_job"),
    "programs.machine": ("Machine",),
    "programs.planning": ("Plan", "Posted", "plan", "post", "read_gcode"),
    "programs.program": ("Program",),
    "programs.running": ("RunResult", "run"),
    "tools.tool": ("Tool",),
}  # fmt: skip
"""The public names by the module that defines them."""

_MODULE_OF = {name: f"{__name__}.{module}" for module, names in _MODULES.items() for name in names}

__all__ = ["CancelToken", "__version__", *_MODULE_OF]  # noqa: PLE0604  # strings, out of the table


def __getattr__(name: str) -> object:
    """A public name, from its module (PEP 562)."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(importlib.import_module(_MODULE_OF[name]), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """The public names only; modules are imported by theirs."""
    return sorted(__all__)
