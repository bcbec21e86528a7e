"""Makes docs/gallery.md and its pictures from the jobs below: each is planned, posted, verified and drawn.

.venv/bin/python docs/gallery.py [NAME ...]
"""

from __future__ import annotations

import json
import sys
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from PIL import Image

import styluscam as sc
from styluscam.drawing.picture import plan_picture

HERE = Path(__file__).parent
IMAGES = HERE / "images" / "gallery"
FIXTURES = HERE.parent / "fixtures"
SIZE = (900, 600)
COLOURS = 96
"""Of a picture's palette."""


@dataclass(frozen=True)
class Example:
    """A job of one operation, with its title."""

    name: str
    title: str
    text: str
    part: str
    operation: dict[str, Any]
    process: dict[str, Any] = field(default_factory=lambda: {"kind": "spif"})
    setup: dict[str, Any] = field(default_factory=dict)
    more: dict[str, Any] = field(default_factory=dict)
    part_keys: dict[str, Any] = field(default_factory=dict)
    law: str = "constant"
    sheet: dict[str, Any] = field(default_factory=dict)
    machine: dict[str, Any] = field(default_factory=lambda: {"name": "linuxcnc"})

    def document(self) -> dict[str, Any]:
        """The job."""
        part: dict[str, Any] = {"file": str(FIXTURES / f"{self.part}.step"), **self.part_keys}
        setup = deepcopy(self.setup)
        common: dict[str, Any] = {"tool": "stylus", "tolerance": 0.01, "feeds": {"cut": 1500.0, "plunge": 300.0}}
        if self.process["kind"] == "milling":
            common["spindle"] = {"mode": "fixed", "rpm": 8000.0}
        else:
            part["model_face"] = "tool"
            setup["sheet"] = {"thickness": 1.0, "law": self.law, **self.sheet}
        return {
            "schema": 1,
            "title": self.title,
            "part": part,
            "setup": setup,
            "process": self.process,
            "tools": {"stylus": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}}},
            "machine": self.machine,
            "operations": [common | self.operation],
            **self.more,
        }


LEVELS = {"kind": "z-level", "step": {"height": 1.5}}

EXAMPLES = (
    Example("levels", "Levels", "`z-level`: loops at constant heights, from the top down.", "cone_cup", LEVELS),
    Example(
        "scallop",
        "Levels by scallop",
        "`step = { scallop = 0.1 }`: steps follow from the wall's slope, its curvature and the tool.",
        "vwaf",
        {"kind": "z-level", "step": {"scallop": 0.1}},
    ),
    Example(
        "ramps",
        "Levels with ramps",
        "`ramp_angle_deg`: from level to level along the wall; `seam_spread_deg` turns where loops begin.",
        "pyramid",
        {**LEVELS, "ramp_angle_deg": 6.0, "seam_direction_deg": 45.0, "seam_spread_deg": 90.0},
    ),
    Example(
        "spiral",
        "Spiral",
        "`spiral`: one descent that falls evenly between a loop at the top and one at the bottom; here of arcs, `fit`.",
        "cone_cup",
        {"kind": "spiral", "step": {"height": 1.5}, "fit": "arcs"},
    ),
    Example(
        "rows",
        "Rows by scallop",
        "`zig-zag`: parallel rows over the surface; with `scallop` they lie closer on its steeper parts. Milling.",
        "cap_r60",
        {"kind": "zig-zag", "stepover": 4.0, "scallop": 0.05, "angle_deg": 20.0},
        process={"kind": "milling"},
    ),
    Example(
        "turns",
        "Rows with rounded turns",
        '`turns = "rounded"`: from row to row without a corner; "looped" goes round beyond the ends. Milling.',
        "cone_cup",
        {"kind": "zig-zag", "stepover": 3.0, "turns": "rounded", "faces": ["Face1", "Face2", "Face3", "Face4"]},
        process={"kind": "milling"},
    ),
    Example(
        "cross",
        "Rows that cross",
        "`cross = true`: a second set of rows across the first. Milling.",
        "cap_r60",
        {"kind": "zig-zag", "stepover": 5.0, "angle_deg": 45.0, "cross": True},
        process={"kind": "milling"},
    ),
    Example(
        "pocket",
        "Pocket with a bounded engagement angle",
        "`pocket`: clears the stock, here the part's box, level by level, down by helices. Milling.",
        "pyramid",
        {"kind": "pocket", "step": {"height": 8.0}, "engagement_deg": 75.0, "fit": "arcs", "tolerance": 0.02},
        process={"kind": "milling"},
        more={"tools": {"stylus": {"profile": {"kind": "flat", "diameter": 20.0}}}},
    ),
    Example(
        "drill",
        "Drilled holes",
        "`drill`: round upright holes of the tool's diameter, found in the part, by canned cycles. Milling.",
        "drilled",
        {"kind": "drill", "cycle": {"kind": "peck", "peck": 3.0}},
        process={"kind": "milling"},
        more={
            "tools": {"stylus": {"profile": {"kind": "v", "tip_diameter": 0.0, "angle_deg": 118.0, "diameter": 5.0}}}
        },
    ),
    Example(
        "helix-bore",
        "Holes bored along helices",
        "`helix-bore`: round upright holes by a tool narrower than they are, the widest from the inside out. Milling.",
        "drilled",
        {"kind": "helix-bore", "pitch": 0.5},
        process={"kind": "milling"},
        more={"tools": {"stylus": {"profile": {"kind": "flat", "diameter": 4.0}}}},
    ),
    Example(
        "chamfer",
        "Chamfered edges",
        "`chamfer`: sharp edges of level faces by the cone of a V tool; what it cannot reach is listed. Milling.",
        "edges",
        {"kind": "chamfer", "width": 1.0},
        process={"kind": "milling"},
        more={
            "tools": {"stylus": {"profile": {"kind": "v", "tip_diameter": 0.0, "angle_deg": 90.0, "diameter": 10.0}}}
        },
    ),
    Example(
        "contour",
        "Contours along edges",
        "`contour`: along named edges on one side of them, level by level, with ramps, leads, tabs and a finish pass. Milling.",
        "edges",
        {"kind": "contour", "step": {"height": 3.0}, "edge_side": "outside"},
        process={"kind": "milling"},
        more={"tools": {"stylus": {"profile": {"kind": "flat", "diameter": 6.0}}}},
    ),
    Example(
        "constant-scallop",
        "Equal scallop everywhere",
        "`constant-scallop`: contours from the border inwards, as far apart as the scallop allows on every slope. Milling.",
        "vwaf",
        {"kind": "constant-scallop", "scallop": 0.2},
        process={"kind": "milling"},
    ),
    Example(
        "pencil",
        "Pencil",
        "`pencil`: along the concave edges of a square cup, which a ball bridges. Milling.",
        "matrix/pyramid",
        {"kind": "pencil"},
        process={"kind": "milling"},
    ),
    Example(
        "flank",
        "Flank milling",
        "`flank`: the side of a leaning tool along the ruled sides of a twisted blade; two rotary axes. Milling.",
        "blade",
        {"kind": "flank", "tolerance": 0.005},
        process={"kind": "milling"},
        machine={"name": "linuxcnc-trunnion"},
        more={"tools": {"stylus": {"profile": {"kind": "flat", "diameter": 8.0}, "length": 60.0}}},
    ),
    Example(
        "layers",
        "Rows in flat sheet",
        "`max_increment`: rows in layers, none of which presses the sheet farther down at once.",
        "pyramid",
        {"kind": "zig-zag", "stepover": 4.0, "max_increment": 2.5},
        more={"accept": ["wall-angle"]},
    ),
    Example(
        "male-die",
        "Over a male die",
        '`process.kind = "tpif"`: from the die\'s top outwards and down, the clamp frame goes down with the path.',
        "cap_r60",
        LEVELS,
        process={"kind": "tpif", "die": "male"},
        more={"accept": ["solid"]},
    ),
    Example(
        "spinning",
        "Shear spinning",
        '`process.kind = "spinning"`: the meridian in X and Z, a wait of one turn at its end; the part turns under the tool.',
        "cap_r60",
        {"kind": "meridian", "feed_per_rev": 1.0, "spindle": {"mode": "fixed", "rpm": 300.0}},
        process={"kind": "spinning"},
        part_keys={"faces": ["Face1"]},
        law="sine",
        machine={"name": "linuxcnc", "options": {"feed_mode": "per-revolution"}},
        more={"accept": ["solid"]},
    ),
    Example(
        "addendum",
        "Addendum over a male die",
        "`part.addendum`: from the edge of the part a wall goes down to the blank, which is clamped around it.",
        "cap_r60",
        {"kind": "z-level", "step": {"height": 2.0}},
        process={"kind": "tpif", "die": "male"},
        more={
            "accept": ["solid"],
            "part": {
                "file": str(FIXTURES / "cap_r60.step"),
                "model_face": "tool",
                "addendum": {"wall_angle_deg": 45.0, "height": 8.0},
            },
        },
    ),
    Example(
        "stages",
        "Stages",
        "`part.stages = 2`: a wall of 65 degrees in a sheet that withstands 50 in one pass, by way of two gentler walls.",
        "vwaf",
        {"kind": "z-level", "step": {"height": 2.0}},
        sheet={"max_wall_angle_deg": 50.0},
        part_keys={"stages": 2},
    ),
    Example(
        "double-sided",
        "From both sides",
        '`process.kind = "dsif"`: a second tool follows under the sheet; this is the path of the main one.',
        "cone_cup",
        LEVELS,
        process={"kind": "dsif", "support_tool": "below"},
        more={
            "tools": {
                "stylus": {"number": 1, "profile": {"kind": "ball", "diameter": 10.0}},
                "below": {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}},
            },
            "machines": {"support": {"name": "linuxcnc"}},
        },
    ),
)


def draw(example: Example) -> str:
    """Makes the picture of an example, and its part of the page.

    Raises:
        SystemExit: its text has an error.
    """
    job = sc.Job.from_dict(example.document())
    plan = sc.plan(job)
    report = sc.verify(sc.post(plan), job)
    if not report.ok:
        raise SystemExit(f"{example.name}: {[finding.message for finding in report.findings]}")
    path = IMAGES / f"{example.name}.png"
    plan_picture(plan, path)
    with Image.open(path) as picture:
        small = picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS).quantize(COLOURS)
    small.save(path, optimize=True)
    keys = {key: value for key, value in example.operation.items() if key != "kind"}
    stated = ", ".join(f"`{key} = {json.dumps(value)}`" for key, value in keys.items())
    return f"## {example.title}\n\n{example.text} Keys: {stated}.\n\n![{example.title}](images/gallery/{example.name}.png)\n"


def main(names: list[str]) -> None:
    """Draws those named, or all; the page is written when all are."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    parts = [draw(example) for example in EXAMPLES if not names or example.name in names]
    if not names:
        head = (
            "# Gallery\n\n"
            "A job of each kind of operation and process, on the parts of the test fixtures. Each was planned, posted\n"
            "and verified before it was drawn, by `make gallery`.\n"
            "All keys: [the page of operations and processes](operations.md).\n\n"
        )
        (HERE / "gallery.md").write_text(head + "\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
