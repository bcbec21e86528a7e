"""The whole way of a tool along a strip as a program: to it, in, along it, out, and away."""

from __future__ import annotations

import json
import math

from styluscam import _engine
from styluscam.arguments import refused
from styluscam.errors import GeometryError
from styluscam.flank.positions import FlankPositions
from styluscam.programs.program import Program


def flank_program(
    positions: FlankPositions,
    *,
    feed: float,
    clearance: float,
    extension: float = 0.0,
    lead: float = 0.0,
    rpm: float | None = None,
    tool_number: int = 1,
) -> Program:
    """A program along the positions, for :func:`styluscam.cl_text`. Lengths mm, ``feed`` mm/min, ``rpm`` rev/min.

    The tool comes down along its axis from ``clearance`` above, goes in over ``lead`` at 45 deg from the free side and behind the
    first position, and on over ``extension`` as it stands in the first position; likewise out. Without a lead it comes down
    beside the surface it touches.

    Raises:
        GeometryError: a length below 0, a feed or a clearance that is not above 0.
    """
    for name, value, least in (
        ("feed", feed, math.ulp(0.0)),
        ("clearance", clearance, math.ulp(0.0)),
        ("extension", extension, 0.0),
        ("lead", lead, 0.0),
    ):
        if not (math.isfinite(value) and value >= least):
            raise refused(name, value, "a length or feed above 0" if least else "a length from 0 on", GeometryError)
    contacts = positions.contacts.mean(axis=1)
    ways = (extension, lead, clearance)
    moves = json.loads(_engine.flank_pass(positions.tips, positions.axes, contacts, ways, feed))
    events: list[dict[str, object]] = [{"before": 0, "kind": "tool-change", "tool": 0}]
    if rpm is not None:
        events.append({"before": 0, "kind": "spindle-on", "rpm": float(rpm), "direction": "clockwise"})
    document = {
        "schema": 1,
        "setup": _setup(positions, clearance),
        "tools": [_tool(positions, tool_number)],
        "operations": [{"id": "flank", "kind": "flank", "tool": 0}],
        "moves": moves,
        "events": events,
    }
    return Program.from_json(json.dumps(document))


def _setup(positions: FlankPositions, clearance: float) -> dict[str, object]:
    contacts = positions.contacts.reshape(-1, 3)
    return {
        "title": "flank",
        "wcs": "G54",
        "zero": "as the rails",
        "part_min": contacts.min(axis=0).tolist(),
        "part_max": contacts.max(axis=0).tolist(),
        "clearance": clearance,
        "notes": [],
    }


def _tool(positions: FlankPositions, number: int) -> dict[str, object]:
    return {
        "name": positions.tool.name or "tool",
        "number": number,
        "length_offset": number,
        "description": positions.tool.description,
        "reference": "tip",
        "reference_height": 0.0,
        "diameter": positions.tool.diameter,
    }
