"""What a profile that fits gains: passes, length and time on a steep and on a gentle plane, at equal scallop.

Run: ``python bench/profile_gain.py``; ``docs/performance.md`` is written again. Tools of one diameter finish a plane of
20 x 40 mm: levels on one of 80 degrees, rows on one of 10 degrees. The scallop is measured in numpy from the lines of the
posted text and the tool's profile in section, with nothing that planned it: what stands over the plane, along its normal,
between the passes.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from page import table, write

import styluscam as sc

Floats = npt.NDArray[np.float64]

SCALLOP, DIAMETER, FEED = 0.01, 10.0, 1500.0
"""mm; mm; mm/min."""
LONG, WIDE = 20.0, 40.0
"""The plane, down its slope and along it, mm."""
STEEP, GENTLE = 80.0, 10.0
"""Slopes, deg."""
SLOPE = "Face1"
"""The plane's face."""
FINE = 400
"""Positions along the plane for each pass, at which it is measured."""
TOUCHES = 0.003
"""A tool so near touches the plane, mm."""
HALVINGS = 20
TOLERANCE = 0.001

PROFILES: dict[str, dict[str, Any]] = {
    "ball": {"kind": "ball"},
    "barrel R60": {"kind": "barrel", "radius": 60.0, "tip_radius": 2.0},
    "clothoid": {"kind": "clothoid"},
    "ellipse, standing": {"kind": "ellipse", "radial": 5.0, "axial": 15.0},
    "ellipse, lying": {"kind": "ellipse", "radial": 5.0, "axial": 2.0},
    "bull-nose R1": {"kind": "bull-nose", "corner_radius": 1.0},
}


def wedge(slope_deg: float) -> sc.Part:
    """A plane that rises along X, on a block."""
    run, rise = (LONG * part for part in (math.cos(math.radians(slope_deg)), math.sin(math.radians(slope_deg))))
    section = np.array([[0.0, 0.0], [run, rise], [run + 20.0, rise], [run + 20.0, -5.0], [-30.0, -5.0], [-30.0, 0.0]])
    count = len(section)
    vertices = np.array([[x, y, z] for y in (0.0, WIDE) for x, z in section])
    quads = [[i, i + count, (i + 1) % count + count, (i + 1) % count] for i in range(count)]
    faces = [1, 2, 3, 4, 5, 6]
    ends = [[0, 1, 2, 3], [0, 3, 4, 5]]
    quads += [[*reversed(end)] for end in ends] + [[corner + count for corner in end] for end in ends]
    triangles = [half for a, b, c, d in quads for half in ([a, b, c], [a, c, d])]
    ids = np.repeat([*faces, 7, 7, 8, 8], 2)
    return sc.Part.from_mesh(vertices, np.array(triangles)[:, ::-1], face_ids=ids)


def stepover(tool: sc.Tool, slope_deg: float) -> float:
    """The largest distance of rows in plan with which no more than the scallop stands, mm, by halving."""
    low, high = 0.0, DIAMETER
    rise = math.tan(math.radians(slope_deg))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        rows = np.arange(-3.0, 4.0) * middle
        fits = scallop(np.column_stack([rows, rise * rows]), tool, slope_deg) <= SCALLOP
        low, high = (middle, high) if fits else (low, middle)
    return low


def job(profile: dict[str, Any], slope_deg: float) -> sc.Job:
    """Levels on a steep plane, rows on a gentle one, both as far apart as the scallop allows."""
    if slope_deg > 45.0:
        kind: dict[str, Any] = {"kind": "z-level", "step": {"scallop": SCALLOP}}
    else:
        tool = sc.Tool.from_dict({"profile": {"diameter": DIAMETER} | profile})
        kind = {"kind": "zig-zag", "stepover": round(stepover(tool, slope_deg), 3), "angle_deg": 90.0}
    operation = {"tool": "tool", "tolerance": TOLERANCE, "feeds": {"cut": FEED, "plunge": 300.0}, "links": "low"}
    operation["spindle"] = {"mode": "fixed", "rpm": 8000.0}
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": "wedge.stl", "units": "mm", "faces": [SLOPE]},
            "process": {"kind": "milling"},
            "setup": {"zero": "model"},
            "tools": {"tool": {"profile": {"diameter": DIAMETER} | profile}},
            "machine": {"name": "linuxcnc", "options": {"decimals": 4}},
            "operations": [operation | kind],
        },
        part=wedge(slope_deg),
    )


def outline(tool: sc.Tool) -> Floats:
    """The tool in section, points (K, 2) from side to side."""
    radii = 0.5 * DIAMETER * np.sin(np.linspace(0.0, 0.5 * np.pi, 4001))
    heights = np.array([tool.height_at_radius(float(radius)) for radius in radii])
    return np.concatenate([np.column_stack([-radii, heights])[:0:-1], np.column_stack([radii, heights])])


def scallop(tips: Floats, tool: sc.Tool, slope_deg: float) -> float:
    """The most that stands over the plane between the lowest and the highest of tips (N, 2), mm."""
    sine, cosine = math.sin(math.radians(slope_deg)), math.cos(math.radians(slope_deg))
    turn = np.array([[cosine, sine], [-sine, cosine]])
    profile = outline(tool) @ turn.T
    number = profile[:, 1].argmin()
    lowest = profile[number, 0]
    # what of the outline faces the plane: from where it is farthest up the plane to where it is farthest down
    ends = sorted((int(profile[:, 0].argmin()), int(profile[:, 0].argmax())))
    below = profile[ends[0] : ends[1] + 1]
    below = below[np.argsort(below[:, 0])]
    along = tips @ turn.T
    # where it is deepest the tool touches the plane; beyond the plane it is on its edges, and higher
    along[:, 1] -= along[:, 1].min() + below[:, 1].min()
    along = along[along[:, 1] + below[:, 1].min() < TOUCHES]
    contacts = np.sort(along[:, 0] + lowest)
    at = np.concatenate([np.linspace(a, b, FINE) for a, b in itertools.pairwise(contacts)])
    left = np.full(at.shape, np.inf)
    for s, n in along:
        left = np.minimum(left, n + np.interp(at - s, below[:, 0], below[:, 1], left=np.inf, right=np.inf))
    return float(left.max())


@dataclass(frozen=True)
class Finished:
    """A plane finished with a profile."""

    passes: int
    length: float
    """Feed moves, mm."""
    seconds: float
    scallop: float
    errors: int

    def row(self, slope_deg: float, name: str, ball: Finished) -> list[str]:
        return [
            f"{slope_deg:g}",
            name,
            f"{self.passes}",
            f"{self.length:.0f}",
            f"{self.seconds:.1f}",
            f"{ball.seconds / self.seconds:.2f}",
            f"{1000.0 * self.scallop:.1f}",
            "none" if not self.errors else f"{self.errors}",
        ]


def finished(profile: dict[str, Any], slope_deg: float) -> Finished:
    """The job, posted and verified."""
    asked = job(profile, slope_deg)
    program = sc.post(sc.plan(asked))
    report = sc.verify(program, asked)
    path = sc.read_gcode(program.text, "linuxcnc")
    moves = path.moves
    ends = moves["end"]
    starts = np.concatenate([ends[:1], ends[:-1]])
    # passes go along Y
    passes = (moves["kind"] != 0) & (np.abs(ends - starts)[:, 1] > 0.5 * WIDE)
    tips = np.unique(np.round(ends[passes][:, [0, 2]], 4), axis=0)
    length = float(np.linalg.norm(ends - starts, axis=1)[moves["kind"] != 0].sum())
    errors = sum(finding.severity == "error" for finding in report.findings)
    tool = sc.Tool.from_dict({"profile": {"diameter": DIAMETER} | profile})
    return Finished(len(tips), length, float(path.times(asked.machine())[-1]), scallop(tips, tool, slope_deg), errors)


HEADS = ("slope deg", "profile D10", "passes", "feed mm", "s", "times as fast as the ball", "scallop um", "errors")


def main() -> None:
    """The table."""
    rows = []
    for slope_deg in (STEEP, GENTLE):
        found = {name: finished(profile, slope_deg) for name, profile in PROFILES.items()}
        rows += [one.row(slope_deg, name, found["ball"]) for name, one in found.items()]
    print(table(HEADS, rows))
    write("profiles-gain", f"Scallop asked for: {1000.0 * SCALLOP:g} um.\n\n{table(HEADS, rows)}")


if __name__ == "__main__":
    main()
