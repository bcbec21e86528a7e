"""The whole way of a tool along a strip as a program: to it, in, along it, out, and away."""

from __future__ import annotations

import json
import math

import numpy as np

from styluscam.arguments import refused
from styluscam.errors import GeometryError
from styluscam.flank.positions import FlankPositions
from styluscam.programs.program import Program
from styluscam.types import FloatArray


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
    ends = [_end(positions, number, extension, lead) for number in (0, -1)]
    moves = [_move("rapid", ends[0][-1] + clearance * positions.axes[0], positions.axes[0])]
    moves += [_move("feed", tip, positions.axes[0], feed, "lead") for tip in ends[0][::-1]]
    moves += [_move("feed", tip, axis, feed, "cut") for tip, axis in zip(positions.tips, positions.axes, strict=True)]
    moves += [_move("feed", tip, positions.axes[-1], feed, "lead") for tip in ends[1]]
    moves.append(_move("rapid", ends[1][-1] + clearance * positions.axes[-1], positions.axes[-1]))
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


def _end(positions: FlankPositions, number: int, extension: float, lead: float) -> list[FloatArray]:
    """Tips beyond one end of the positions, from there outwards."""
    inner = 1 if number == 0 else -2
    tip, axis = positions.tips[number], positions.axes[number]
    out = positions.contacts[number].mean(axis=0) - positions.contacts[inner].mean(axis=0)
    free = tip - positions.contacts[number, 0]
    free -= axis * (free @ axis)
    free /= np.linalg.norm(free)
    # along the surface: across the axis, and across the way to it
    out = out - axis * (out @ axis) - free * (out @ free)
    out /= np.linalg.norm(out)
    found = [tip + extension * out] if extension else []
    if lead:
        found.append(tip + (extension + lead * math.sqrt(0.5)) * out + lead * math.sqrt(0.5) * free)
    return found or [tip]


def _move(
    kind: str, tip: FloatArray, axis: FloatArray, feed: float = 0.0, role: str | None = None
) -> dict[str, object]:
    move: dict[str, object] = {
        "kind": kind,
        "end": tip.tolist(),
        "axis": axis.tolist(),
        "feed": feed,
        "operation": 0,
    }
    return move | ({"role": role} if role else {})
