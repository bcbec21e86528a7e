"""Small parts and jobs for them: each is planned in a tenth of a second, and its answer is known to the oracles."""

from __future__ import annotations

import copy
import random
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

import styluscam as sc
from arcs import with_arcs
from brute_force import Solid
from controllers import FAMILIES, ONE_TOOL, Family
from convex_tool import Floats, Tool
from matters import Wanted

Mesh: TypeAlias = tuple[Floats, NDArray[np.int64]]
Document: TypeAlias = dict[str, Any]

METRIC: tuple[Family, ...] = ("marlin",)
"""Families whose shipped machine has no inches."""
ONE_ZERO: tuple[Family, ...] = ("marlin",)
"""Families that have one work offset."""
ROUNDED: tuple[Family, ...] = ("fanuc", "okuma", "siemens")
"""Families whose arcs are made in millimetres only: in inches some of the oracle's are not exact enough."""


def stack(sides: int, profile: list[tuple[float, float]], turn: float = 0.0) -> Mesh:
    """Rings of corners (radius, height) from outside in, walls between them, closed by the last: a pit, a bump, a cup."""
    angles = 2 * np.pi * (np.arange(sides) + 0.5) / sides + turn
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.concatenate([np.column_stack([r * ring, np.full(sides, z)]) for r, z in profile])
    triangles: list[tuple[int, int, int]] = []
    for k in range(len(profile) - 1):
        for i in range(sides):
            a, b = k * sides + i, k * sides + (i + 1) % sides
            triangles += [(a, b, b + sides), (a, b + sides, a + sides)]
    last = (len(profile) - 1) * sides
    triangles += [(last, last + i, last + i + 1) for i in range(1, sides - 1)]
    return vertices, np.array(triangles)


def terrain(seed: int, side: int = 5, pitch: float = 4.0, height: float = 1.5) -> Mesh:
    """A grid of points of random height."""
    heights = np.random.default_rng(seed).uniform(0.0, height, (side, side))
    vertices = np.array([[pitch * i, pitch * j, heights[i, j]] for i in range(side) for j in range(side)])
    cells = [side * i + j for i in range(side - 1) for j in range(side - 1)]
    return vertices, np.array([t for c in cells for t in ((c, c + side, c + side + 1), (c, c + side + 1, c + 1))])


def roof(angle_deg: float) -> Mesh:
    """A ridge along X, plane on both sides."""
    height = 8.0 * np.tan(np.radians(angle_deg))
    rows = [(-8.0, 0.0), (0.0, height), (8.0, 0.0)]
    vertices = np.array([[x, y, z] for y, z in rows for x in (0.0, 18.0)])
    return vertices, np.array([(0, 1, 3), (0, 3, 2), (2, 3, 5), (2, 5, 4)])


def lopsided(mesh: Mesh) -> Mesh:
    """The same part stretched and sheared, so that every turn of it shows."""
    vertices, triangles = mesh
    shear = np.array([[1.0, 0.12, 0.0], [0.0, 0.85, 0.0], [0.0, 0.0, 1.0]])
    return vertices @ shear.T + np.array([1.5, -0.75, 0.0]), triangles


PARTS: dict[str, Mesh] = {
    "pit": lopsided(stack(4, [(15, 0), (11, 0), (6, -5)])),
    "bump": lopsided(stack(6, [(15, 0), (11, 0), (6, 5)])),
    "cup": lopsided(stack(8, [(14, 0), (11, 0), (8, -3), (5, -4.5)])),
    "steps": lopsided(stack(5, [(16, 0), (12, 0), (9, -2), (8, -2.2), (5, -6)])),
    "spire": lopsided(stack(4, [(13, 0), (9, 0), (4, 6)])),
    "terrain": terrain(1),
    "hills": terrain(2, side=4, pitch=6.0, height=3.0),
    "roof": lopsided(roof(35.0)),
}
ROUND: dict[str, Mesh] = {
    "cone": stack(360, [(13, 0), (10, 0), (5, -5)]),
    "hill": stack(360, [(13, 0), (10, 0), (5, 5)]),
}
LEVELLED = ["pit", "bump", "cup", "steps", "spire"]

PROFILES: list[Document] = [
    {"kind": "ball", "diameter": 4.0},
    {"kind": "clothoid", "diameter": 5.0},
    {"kind": "bull-nose", "diameter": 4.0, "corner_radius": 1.0},
    {"kind": "tapered-ball", "tip_radius": 1.0, "half_angle_deg": 20.0, "diameter": 5.0},
    {"kind": "ball", "diameter": 6.0, "tip_flat": 0.5},
    {"kind": "clothoid", "diameter": 4.0, "tip_flat": 0.5},
]
SHEETS: list[tuple[Document, str]] = [
    ({"thickness": 0.8}, "back"),
    ({"thickness": 1.0}, "tool"),
    ({"thickness": 0.6, "law": "sine"}, "back"),
    ({"thickness": 1.2}, "mid"),
]


@dataclass(frozen=True)
class Case:
    """A part and a job for it."""

    name: str
    mesh: Mesh
    document: Document
    family: Family
    arcs: int = 0
    """Arcs to a loop about the model's axis; 0 leaves the chords."""

    @property
    def job(self) -> sc.Job:
        return sc.Job.from_dict(self.document, part=sc.Part.from_mesh(*self.mesh))

    @cached_property
    def text(self) -> str:
        """The sound program."""
        text = sc.post(sc.plan(self.job)).text
        if not self.arcs:
            return text
        zero = self.document["setup"].get("zero", [0.0, 0.0, 0.0])
        is_pit = self.mesh[0][-1, 2] < 0
        return with_arcs(text, self.family, (-zero[0], -zero[1]), inside=is_pit, pieces=self.arcs)

    @cached_property
    def wanted(self) -> Wanted:
        """What the oracle must know of the job; its part is turned about Z alone."""
        setup, sheet = self.document["setup"], self.document["setup"].get("sheet")
        model_face = self.document["part"].get("model_face")
        tools = {t.get("number", 1): _tool(t, sheet, model_face) for t in self.document["tools"].values()}
        turn = np.radians(setup.get("rotation", 0.0))
        turned = (
            self.mesh[0] @ np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]).T
        )
        raised = _tool(self.document["tools"]["tool"] | {"reference": "tip"}, sheet, model_face).raised
        top = float(turned[:, 2].max()) + raised
        zero = setup.get("zero", "sheet-top" if sheet else "model")
        named = {"sheet-top": [0.0, 0.0, top], "model": [0.0, 0.0, 0.0]}
        origin: list[float] = named[zero] if isinstance(zero, str) else zero
        return Wanted(
            Solid((turned - np.array(origin))[self.mesh[1]]),
            tools,
            {
                t.get("number", 1): _holder(t, sheet, model_face)
                for t in self.document["tools"].values()
                if "holder" in t
            },
            max(operation.get("tolerance", 0.005) for operation in self.document["operations"]),
            top - origin[2] + setup.get("clearance", 10.0),
            top - origin[2] + setup.get("retract", 2.0),
            self.family,
            AXES if "file" in self.document["machine"] else None,
            sheet is not None and all(operation["kind"] != "zig-zag" for operation in self.document["operations"]),
        )


def _tool(section: Document, sheet: Document | None, model_face: str | None) -> Tool:
    tool = Tool.of(section["profile"], sheet, model_face)
    centre = section["profile"]["diameter"] / 2 if section.get("reference") == "center" else 0.0
    return replace(tool, raised=tool.raised + centre)


def _holder(section: Document, sheet: Document | None, model_face: str | None) -> Tool:
    return _tool(section, sheet, model_face).holder(section["holder"]["diameter"], section["length"])


def document(
    kind: str, profile: Document, machine: Document, *, sheet: tuple[Document, str] | None = None, **operation: Any
) -> Document:
    """A job for a part that is handed over as it is."""
    pitch = {"step": {"height": 1.2}} if kind == "z-level" else {"stepover": 2.0, "angle_deg": 20.0}
    made: Document = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm"},
        "setup": {},
        "process": {"kind": "milling"},
        "tools": {"tool": {"number": 1, "profile": copy.deepcopy(profile)}},
        "operations": [{"kind": kind, "tool": "tool", **pitch, **operation}],
        "machine": machine,
    }
    if sheet is None:
        made["operations"][0].setdefault("spindle", {"mode": "off"})  # as in texts that are written by hand
    else:
        made["process"] = {"kind": "spif"}
        made["part"]["model_face"] = sheet[1]
        made["setup"]["sheet"] = copy.deepcopy(sheet[0]) | {"max_wall_angle_deg": 75.0}
        # rows alone form no sheet; bumps are no trays: what is checked here is the program
        made["accept"] = ["flange", "bridged", "unreached", *(["punch"] if kind == "zig-zag" else [])]
    return made


AXES = ((-60.0, 60.0), (-60.0, 60.0), (-30.0, 60.0))
LIMITS = (
    "".join(f"{axis} = {list(ends)}\n" for axis, ends in zip("xyz", AXES, strict=True))
    + "max_feed = 3000.0\nmax_rpm = 6000.0\n"
)
"""Of the machines with limits: no sound program comes near them."""


def machines(folder: Path) -> dict[str, tuple[Document, Family]]:
    """The shipped machines, and the same ones with limits, in inches where they have inches, as files."""
    found: dict[str, tuple[Document, Family]] = {}
    for family in FAMILIES:
        file = folder / f"{family}_limits.toml"
        unit = "" if family in METRIC else '[units]\noutput = "inch"\n\n'
        text = f'schema = 1\nextends = "{family}"\nname = "{family}-limits"\n\n{unit}[limits]\n{LIMITS}'
        if not file.exists():
            file.write_text(text, encoding="utf-8")
        found[family] = {"name": family}, family
        found[f"{family} with limits{', in inches' if unit else ''}"] = {"file": str(file)}, family
    return found


def _machine(draw: random.Random, folder: Path, family: Family | None) -> tuple[str, Document, Family]:
    """One of all machines, or of a family's."""
    offered = [(name, *found) for name, found in machines(folder).items() if family in (None, found[1])]
    return draw.choice(offered)


def made_case(number: int, folder: Path, family: Family | None = None) -> Case:
    """The case of a number, of any family or the one asked for: part, tool, strategy, sheet, machine and set-up drawn from it."""
    draw = random.Random(number)
    kind = draw.choice(["z-level", "z-level", "zig-zag"])
    part = draw.choice(LEVELLED if kind == "z-level" else list(PARTS))
    machine, section, family = _machine(draw, folder, family)
    profile = draw.choice(PROFILES)
    sheet = draw.choice([None, None, *SHEETS])
    made = document(kind, profile, section, sheet=sheet)
    if draw.random() < 0.5:
        made["setup"]["rotation"] = draw.choice([30.0, -72.5, 90.0])
    if draw.random() < 0.3:
        made["setup"]["zero"] = [2.0, -3.0, 1.25]
    if profile["kind"] == "ball" and "tip_flat" not in profile and draw.random() < 0.5:
        made["tools"]["tool"]["reference"] = "center"
    if sheet is None:
        made["operations"][0] |= _milled(draw)
    if draw.random() < 0.5:
        made["setup"] |= draw.choice(
            [{"clearance": 5.0, "retract": 0.5}, {"wcs": "G55"}, {"clearance": 20.0, "wcs": "G56"}]
        )
        if family in ONE_ZERO:
            made["setup"].pop("wcs", None)
    if draw.random() < 0.5:
        made["operations"][0] |= draw.choice([{"direction": "same"}, {"feeds": {"cut": 900.0, "plunge": 150.0}}])
    if draw.random() < 0.3:
        made["tools"]["tool"] |= {"length": 30.0, "holder": {"diameter": 16.0, "length": 20.0}}
    if family not in ONE_TOOL and draw.random() < 0.25:
        _add_second(made, draw)
    return Case(f"{number}: {kind} of {part} by {profile['kind']} on {machine}", PARTS[part], made, family)


FURTHER: list[Document] = [
    {"kind": "spiral", "step": {"height": 1.2}},
    {"kind": "spiral", "step": {"scallop": 0.06}, "step_min": 0.2},
    {"kind": "z-level", "step": {"list": [0.8, 1.2, 1.0]}},
    {"kind": "z-level", "step": {"scallop": 0.06}, "step_min": 0.2},
    {"kind": "z-level", "step": {"height": 1.2}, "fit": "arcs"},
    {"kind": "spiral", "step": {"height": 1.2}, "fit": "arcs"},
]
"""Operations beyond evenly spaced levels and rows of lines."""
FITTED: tuple[Family, ...] = ("linuxcnc", "grbl", "siemens")
"""Families whose arcs the engine fits for this."""


def further_case(number: int, folder: Path, family: Family | None = None) -> Case:
    """The case of a number, of the operation `number` among `FURTHER` in turn."""
    draw = random.Random(f"further {number}")
    operation = copy.deepcopy(FURTHER[number % len(FURTHER)])
    is_fitted = "fit" in operation
    if is_fitted and family is None:
        family = draw.choice(FITTED)
    machine, section, family = _machine(draw, folder, family)
    parts = ROUND if is_fitted else {name: PARTS[name] for name in ("pit", "bump")}
    part, mesh = draw.choice(list(parts.items()))
    profile = draw.choice(PROFILES[:2])
    # a bump is no sheet's inside
    sheet = draw.choice([None, SHEETS[0]]) if mesh[0][-1, 2] < 0 else None
    made = document(operation["kind"], profile, section, sheet=sheet)
    made["operations"] = [{"tool": "tool", **operation}]
    if sheet is None:
        made["operations"][0] |= _milled(draw)
    steps = ", ".join(f"{key} {value}" for key, value in operation.items())
    return Case(f"further {number}: {steps} of {part} by {profile['kind']} on {machine}", mesh, made, family)


def _milled(draw: random.Random) -> Document:
    """Spindle and coolant of a milling operation."""
    turning = {
        "mode": "fixed",
        "rpm": draw.choice([3000.0, 5500.0]),
        "direction": draw.choice(["clockwise", "counterclockwise"]),
    }
    return {"spindle": turning, "coolant": draw.choice(["flood", "flood", "off"])}


def arc_case(number: int, folder: Path, family: Family | None = None) -> Case:
    """The case of a number on a round part: its loops are arcs, whole circles, halves or quarters; lines in Klartext."""
    draw = random.Random(number)
    part, mesh = draw.choice(list(ROUND.items()))
    machine, section, family = _machine(draw, folder, family)
    if family in ROUNDED:
        machine, section = family, {"name": family}
    profile = draw.choice([PROFILES[0], PROFILES[2]])
    made = document("z-level", profile, section)
    made["setup"]["zero"] = [draw.choice([0.0, 2.0]), -3.0, 0.0]
    pieces = 0 if family == "heidenhain" else draw.choice([1, 2, 4])
    return Case(
        f"arcs {number}: {part} by {profile['kind']} on {machine}, {pieces} to a loop", mesh, made, family, pieces
    )


def _add_second(made: Document, draw: random.Random) -> None:
    """A second operation with a tool of its own."""
    made["tools"]["second"] = {"number": 2, "profile": {"kind": "ball", "diameter": 3.0}}
    second = copy.deepcopy(made["operations"][0])
    second.pop("step", None)
    if "spindle" in second:
        second |= _milled(draw)
    second["feeds"] = {"cut": 1100.0, "plunge": 200.0}
    made["operations"].append(
        second | {"kind": "zig-zag", "tool": "second", "stepover": 3.0, "angle_deg": draw.choice([0.0, 75.0])}
    )
