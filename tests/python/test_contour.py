"""Contours along edges: the path against its closed form, and the verifier of the posted text."""

from __future__ import annotations

import itertools
import math
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from meridian import FIXTURES

PLATE = ((0.0, 0.0), (80.0, 50.0))
POCKET = ((10.0, 10.0), (34.0, 28.0))
BOSS = ((58.0, 25.0), 8.0)
TOP, BOSS_TOP = 12.0, 17.0
OUTLINE = ["Edge4", "Edge6", "Edge8", "Edge9"]
RIM = ["Edge10", "Edge11", "Edge12", "Edge13"]
FRONT, RIGHT, SLOT, CIRCLE = "Edge6", "Edge8", ["Edge14", "Edge15", "Edge16", "Edge17"], ["Edge18"]
OFF = 0.006
"""The tolerance, and what rounding costs, mm."""
FLAT = {"kind": "flat", "diameter": 6.0}
STOCK = {"stock": {"kind": "box", "sides": 8.0, "top": 1.0}}


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


def job(
    edges: list[str] | None,
    side: str,
    profile: Any = None,
    file: Path = FIXTURES / "edges.step",
    machine: str = "linuxcnc",
    **keys: Any,
) -> sc.Job:
    operation = {
        "kind": "contour",
        "tool": "mill",
        "step": {"height": 3.0},
        "edge_side": side,
        "edge_names": edges,
        "feeds": {"cut": 600.0, "plunge": 200.0},
        "spindle": {"mode": "fixed", "rpm": 8000.0},
        "direction": "climb",
    }
    setup = keys.pop("setup", {})
    operation |= keys
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(file), "faces": "all"},
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "clearance": 30.0, "retract": 14.0, **setup},
            "machine": {"name": machine},
            "tools": {"mill": {"number": 1, "length": 60.0, "profile": profile or FLAT}},
            "operations": [{key: value for key, value in operation.items() if value is not None}],
        }
    )


def text_of(asked: sc.Job, machine: str = "linuxcnc") -> str:
    return sc.post(sc.plan(asked), machine).text


def kinds(text: str, asked: sc.Job) -> set[str]:
    return {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]}


def unreached(text: str, asked: sc.Job) -> float:
    found = [finding for finding in sc.verify(text, asked).to_dict()["findings"] if finding["kind"] == "unreached"]
    return sum(finding["value"] for finding in found)


def level(text: str, height: float) -> np.ndarray:
    """The ends of level feeds at one height of the tip, mm."""
    read = sc.read_gcode(text, "linuxcnc").moves
    ends = read["end"]
    on = np.abs(ends[:, 2] - height) < 6e-4
    along = np.flatnonzero(on[1:] & on[:-1])
    return ends[np.unique([*along, *(along + 1)])][:, :2]


def heights(text: str) -> list[float]:
    """The heights of level feeds, from the top down, mm."""
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    flat = np.abs(np.diff(ends[:, 2])) < 1e-6
    return sorted({round(float(z), 4) for z in ends[1:][flat][:, 2] if z < 20.0}, reverse=True)


def outside(points: np.ndarray, low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    """Distances from a rectangle, mm; negative inside of it."""
    middle, half = np.add(low, high) / 2, np.subtract(high, low) / 2
    over = np.abs(points - middle) - half
    return np.where((over <= 0).all(axis=1), over.max(axis=1), np.hypot(*np.maximum(over, 0.0).T))


def area(points: np.ndarray) -> float:
    x, y = (points - points[0]).T
    return float(0.5 * (x[:-1] * y[1:] - x[1:] * y[:-1]).sum())


@pytest.mark.parametrize("direction", ["climb", "conventional"])
def test_around_a_plate_the_axis_is_its_radius_beside_it_on_every_level(direction: str) -> None:
    asked = job(OUTLINE, "outside", direction=direction)
    text = text_of(asked)
    assert heights(text) == [14.0, 11.0, 8.0, 5.0, 2.0, 0.0]
    for height in heights(text):
        points = level(text, height)
        beside = outside(points, *PLATE)
        assert (beside > 3.0 - 0.001).all() and (beside < 3.0 + OFF).all()
        # the plate on the right: clockwise
        assert (area(points) < 0.0) == (direction == "climb")
        assert abs(area(points)) == pytest.approx(80 * 50 + 2 * 3 * 130 + math.pi * 9, rel=2e-3)
    assert kinds(text, asked) == set()


def test_within_a_pocket_lines_meet_in_its_corners() -> None:
    asked = job(RIM, "inside")
    text = text_of(asked)
    assert heights(text) == [14.0, 11.0, 8.0, 6.0]
    points = level(text, 6.0)
    for axis in (0, 1):
        assert points[:, axis].min() == pytest.approx(POCKET[0][axis] + 3.0, abs=OFF)
        assert points[:, axis].max() == pytest.approx(POCKET[1][axis] - 3.0, abs=OFF)
    assert np.allclose(-outside(points, *POCKET), 3.0, atol=OFF)
    # what the tool's radius leaves of eight ends of edges
    assert kinds(text, asked) == {"unreached"} and 8 * 2.5 < unreached(text, asked) <= 8 * 3.0


@pytest.mark.parametrize("fit", ["lines", "arcs"])
def test_around_a_boss_it_goes_in_a_circle(fit: str) -> None:
    asked = job(CIRCLE, "outside", fit=fit)
    text = text_of(asked)
    assert heights(text) == [14.0, 12.0]
    radius = np.hypot(*(level(text, 12.0) - BOSS[0]).T) - BOSS[1]
    assert (radius > 3.0 - 0.001).all() and (radius < 3.0 + OFF).all()
    assert kinds(text, asked) == set()
    assert (len(text.splitlines()) < 60) == (fit == "arcs")


def test_without_names_the_level_faces_edges_on_that_side_are_taken() -> None:
    asked = job(None, "outside")
    text = text_of(asked)
    assert kinds(text, asked) == set()
    assert heights(text) == [14.0, 12.0, 11.0, 8.0, 5.0, 2.0, 0.0]  # the boss ends at Z12


@pytest.mark.parametrize(("side", "y"), [("right", -3.0), ("on", 0.0)])
def test_along_an_open_edge_the_tool_is_on_the_side_asked_for(side: str, y: float) -> None:
    asked = job([FRONT], side)
    text = text_of(asked)
    points = level(text, heights(text)[-1])
    assert np.allclose(points[:, 1], y, atol=OFF)
    assert points[:, 0].min() == pytest.approx(0.0, abs=OFF) and points[:, 0].max() == pytest.approx(80.0, abs=OFF)
    assert heights(text)[-1] == (0.0 if side == "right" else TOP)
    assert kinds(text, asked) == set()


def test_an_open_line_runs_from_the_first_named_edge_on() -> None:
    for names, start in (([FRONT, RIGHT], [0.0, 0.0]), ([RIGHT, FRONT], [80.0, 50.0])):
        assert level(text_of(job(names, "on", direction="same")), TOP)[0] == pytest.approx(start, abs=OFF)
    points = level(text_of(job([FRONT, RIGHT], "right", direction="same")), 0.0)
    assert points[0] == pytest.approx([0.0, -3.0], abs=OFF) and points[-1] == pytest.approx([83.0, 50.0], abs=OFF)
    assert len(points) > 10  # round the corner


def test_alternate_runs_to_and_fro() -> None:
    text = text_of(job([FRONT], "right", direction="alternate", setup=STOCK))
    ends = [level(text, height)[-1][0] for height in heights(text)]
    assert all(abs(a - b) > 79.0 for a, b in itertools.pairwise(ends))


@pytest.mark.parametrize(
    ("profile", "radius"),
    [
        ({"kind": "ball", "diameter": 6.0}, lambda h: math.sqrt(h * (6.0 - h)) if h < 3.0 else 3.0),
        ({"kind": "bull-nose", "diameter": 6.0, "corner_radius": 1.0}, None),
        ({"kind": "clothoid", "diameter": 6.0}, None),
        ({"kind": "v", "tip_diameter": 0.0, "angle_deg": 90.0, "diameter": 6.0}, lambda h: min(h, 3.0)),
    ],
    ids=lambda given: given["kind"] if isinstance(given, dict) else "",
)
@pytest.mark.parametrize("edges", [OUTLINE, CIRCLE], ids=["plate", "boss"])
def test_the_silhouette_of_any_tool_touches_the_plane_through_the_edge(
    profile: Any, radius: Any, edges: list[str]
) -> None:
    asked = job(edges, "outside", profile, step={"height": 1.0}, setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) == set()
    for height in heights(text):
        points = level(text, height)
        beside = outside(points, *PLATE) if edges == OUTLINE else np.hypot(*(points - BOSS[0]).T) - BOSS[1]
        expected = 3.0 if radius is None else radius(BOSS_TOP + 1.0 - height)
        if radius is not None or height < BOSS_TOP - 3.0:
            assert beside.min() == pytest.approx(expected, abs=OFF)


@pytest.mark.parametrize("angle", [1.0, 3.0, 8.0])
@pytest.mark.parametrize(("edges", "side"), [(RIM, "inside"), (OUTLINE, "outside"), ([FRONT], "right")])
def test_no_ramp_is_steeper_than_stated(angle: float, edges: list[str], side: str) -> None:
    asked = job(edges, side, entry_angle_deg=angle, setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) <= {"unreached"}
    read = sc.read_gcode(text, "linuxcnc").moves
    steps = np.diff(read["end"], axis=0)
    run, fall = np.hypot(steps[:, 0], steps[:, 1]), -steps[:, 2]
    ramps = (run > 0.0) & (fall > 1e-6)
    assert ramps.any() and (fall[ramps] <= math.tan(math.radians(angle)) * run[ramps] + 0.0021).all()
    assert fall[ramps].sum() / run[ramps].sum() == pytest.approx(math.tan(math.radians(angle)), rel=0.02)
    # straight down only above the stock, or through what is cleared
    plunges = (run == 0.0) & (fall > 0.0)
    assert read["end"][1:][plunges][0, 2] > BOSS_TOP + 1.0


def test_the_finish_pass_takes_what_the_levels_leave() -> None:
    keys = {"radial_stock_to_leave": 0.3, "axial_stock_to_leave": 0.2, "finish": True}
    asked = job(RIM, "inside", **keys)
    text = text_of(asked)
    assert heights(text)[-2:] == [6.2, 6.0]
    # the last of this height leads across to the finish pass
    assert np.allclose(-outside(level(text, 6.2)[:-1], *POCKET), 3.3, atol=OFF)
    assert np.allclose(-outside(level(text, 6.0), *POCKET), 3.0, atol=OFF)
    assert kinds(text, asked) == {"unreached"}
    rough = job(RIM, "inside", radial_stock_to_leave=0.3, axial_stock_to_leave=0.2)
    assert heights(text_of(rough))[-1] == 6.2 and kinds(text_of(rough), rough) == {"unreached"}
    # each is found as the other
    assert "missing-level" in kinds(text_of(rough), asked)
    assert {"missing-pass", "gouge", "stock-to-leave"} & kinds(text, job(RIM, "inside", radial_stock_to_leave=0.3))


@pytest.mark.parametrize("lead", ["tangent", "vertical"])
def test_leads_come_in_beside_the_wall(lead: str) -> None:
    for edges, side, keys in ((OUTLINE, "outside", {}), (RIM, "inside", {"plunge": True})):
        asked = job(edges, side, lead=lead, **keys)
        text = text_of(asked)
        assert "(role lead)" in text and kinds(text, asked) <= {"unreached"}


TABS = {"count": 3, "width": 3.0, "height": 1.5}


@pytest.mark.parametrize(("edges", "side"), [(OUTLINE, "outside"), (CIRCLE, "outside"), (RIM, "inside")])
def test_tabs_stay(edges: list[str], side: str) -> None:
    asked = job(edges, side, tabs=TABS, setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) <= {"unreached"}
    assert {"tabs", "missing-pass"} & kinds(text_of(job(edges, side, setup=STOCK)), asked)
    assert kinds(text, job(edges, side, setup=STOCK)) & {"missing-pass", "missing-level"}


MACHINES = sorted(file.stem for file in (FIXTURES.parent / "rust" / "post" / "machines").glob("*.toml"))


@pytest.mark.parametrize("machine", MACHINES)
def test_every_machine_posts_it_and_its_text_is_found_sound(machine: str) -> None:
    asked = job(RIM, "inside", machine=machine, radial_stock_to_leave=0.2, finish=True, tolerance=0.01)
    assert kinds(text_of(asked, machine), asked) == {"unreached"}


def moved(text: str, axis: str, by: float) -> str:
    """The text with one coordinate of the operation's moves changed, mm."""
    head, body = text.split("(operation", 1)
    return (
        head + "(operation" + re.sub(rf"{axis}(-?\d+\.?\d*)", lambda found: f"{axis}{float(found[1]) + by:.3f}", body)
    )


@pytest.mark.parametrize("by", [0.02, -0.02])
@pytest.mark.parametrize("axis", ["X", "Y"])
@pytest.mark.parametrize(("edges", "side"), [(OUTLINE, "outside"), (RIM, "inside")])
def test_a_path_that_is_moved_sideways_is_found_on_both_sides(
    edges: list[str], side: str, axis: str, by: float
) -> None:
    asked = job(edges, side)
    assert {"gouge", "excess"} <= kinds(moved(text_of(asked), axis, by), asked)


@pytest.mark.parametrize("by", [0.02, -0.02])
def test_a_line_on_an_edge_and_beside_an_open_one_that_is_moved_is_found(by: float) -> None:
    asked = job([FRONT], "on")
    assert "excess" in kinds(moved(text_of(asked), "Y", by), asked)
    asked = job([FRONT], "right")
    assert ("gouge" if by > 0 else "excess") in kinds(moved(text_of(asked), "Y", by), asked)


@pytest.mark.parametrize(("edges", "side"), [(OUTLINE, "outside"), (RIM, "inside"), ([FRONT], "right")])
@pytest.mark.parametrize("height", [8.0, 11.0])
def test_a_level_that_is_raised_or_missing_is_found(edges: list[str], side: str, height: float) -> None:
    asked = job(edges, side)
    text = text_of(asked)
    raised = re.sub(rf"Z{height:g}(?![\d.])", f"Z{height + 0.05:g}", text)
    assert raised != text and "missing-level" in kinds(raised, asked)
    other = text_of(job(edges, side, step={"list": [3.0, 4.5]}))
    assert "missing-level" in kinds(other, asked)


def test_a_stretch_over_which_the_tool_is_raised_is_found() -> None:
    asked = job(OUTLINE, "outside")
    lines = text_of(asked).splitlines()
    # along the left side, on the last level
    at = max(i for i, line in enumerate(lines) if line == "Y50")
    lines[at : at + 2] = ["G0 Z47", "Y50", "G1 Z0 F200", f"{lines[at + 1]} F600"]
    found = kinds("\n".join([*lines, ""]), asked)
    assert "missing-pass" in found and "gouge" not in found


def test_the_finish_pass_that_is_missing_is_found() -> None:
    asked = job(RIM, "inside", radial_stock_to_leave=0.3, finish=True)
    text = text_of(asked)
    lines = text.splitlines()
    ramp = max(i for i, line in enumerate(lines) if line == "(role ramp)")
    last = max(i for i, line in enumerate(lines) if line.startswith("G0 Z"))
    assert "missing-pass" in kinds("\n".join([*lines[:ramp], "(role none)", *lines[last:], ""]), asked)


def test_the_wrong_side_is_found() -> None:
    asked = job([FRONT], "right")
    other = moved(text_of(asked), "Y", 6.0)
    assert {"gouge", "missing-level"} <= kinds(other, asked)
    # above the part neither enters it
    high = {"z_top": 14.0, "z_bottom": 13.0}
    left, right = (job([FRONT], side, **high) for side in ("left", "right"))
    assert kinds(text_of(left), left) == set() == kinds(text_of(right), right)
    assert "missing-level" in kinds(text_of(left), right) and "missing-level" in kinds(text_of(right), left)


@pytest.mark.parametrize(("edges", "side"), [(OUTLINE, "outside"), (RIM, "inside"), ([FRONT], "right")])
def test_climb_and_conventional_exchanged_are_found(edges: list[str], side: str) -> None:
    climb, other = (job(edges, side, direction=direction) for direction in ("climb", "conventional"))
    assert "cut-direction" in kinds(text_of(climb), other) and "cut-direction" in kinds(text_of(other), climb)
    free = job(edges, side, direction="alternate")
    assert kinds(text_of(free), free) <= {"unreached"}


def test_a_path_ends_where_another_wall_stands() -> None:
    # a wall of the pocket from its one end to the other
    asked = job(["Edge13"], "left")
    text = text_of(asked)
    points = level(text, 6.0)
    assert np.allclose(points[:, 0], POCKET[1][0] - 3.0, atol=OFF)
    ends = [POCKET[0][1] + 3.0, POCKET[1][1] - 3.0]
    assert [points[:, 1].min(), points[:, 1].max()] == pytest.approx(ends, abs=OFF)
    assert kinds(text, asked) == {"unreached"} and 2 * 2.5 < unreached(text, asked) <= 2 * 3.0
    # on its other side there is nothing but the part
    assert kinds(text_of(job(["Edge13"], "right")), job(["Edge13"], "right")) == {"unreached"}


def box(path: Path, lean: float = 0.0) -> Path:
    """An STL file of a block of 20 x 16 x 8 mm at its top, its sides leaning out by so much."""
    low = [(-lean, -lean, 0.0), (20 + lean, -lean, 0.0), (20 + lean, 16 + lean, 0.0), (-lean, 16 + lean, 0.0)]
    high = [(0.0, 0.0, 8.0), (20.0, 0.0, 8.0), (20.0, 16.0, 8.0), (0.0, 16.0, 8.0)]
    quads = [low[::-1], high, *([low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]] for i in range(4))]
    lines = ["solid box"]
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            corners = "".join(f"vertex {x} {y} {z}\n" for x, y, z in triangle)
            lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    path.write_text("\n".join([*lines, "endsolid box\n"]), encoding="ascii")
    return path


def test_meshes_have_the_edges_of_their_level_faces(tmp_path: Path) -> None:
    document = job(None, "outside", file=box(tmp_path / "box.stl")).to_dict()
    document["part"]["units"] = "mm"
    asked = sc.Job.from_dict(document)
    text = text_of(asked)
    beside = outside(level(text, 0.0), (0.0, 0.0), (20.0, 16.0))
    assert (beside > 3.0 - 0.001).all() and (beside < 3.0 + OFF).all() and kinds(text, asked) == set()
    document["part"]["file"] = str(box(tmp_path / "frustum.stl", 2.0))
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(sc.Job.from_dict(document))
    assert caught.value.code == "no-edge"


def test_without_an_upright_wall_the_depth_has_to_be_stated(tmp_path: Path) -> None:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    writer = STEPControl_Writer()
    writer.Transfer(BRepPrimAPI_MakeCone(10.0, 6.0, 8.0).Shape(), STEPControl_AsIs)
    writer.Write(str(tmp_path / "cone.step"))
    top = {"z_bottom": 8.0, "setup": STOCK}
    codes = set()
    for edge in ("Edge1", "Edge2", "Edge3"):
        with pytest.raises(sc.StylusError) as caught:
            sc.plan(job([edge], "outside", file=tmp_path / "cone.step", setup=STOCK))
        codes.add((caught.value.code, caught.value.where))
        if caught.value.code != "missing":
            continue
        asked = job([edge], "outside", file=tmp_path / "cone.step", **top)
        radius = np.hypot(*level(text_of(asked), 8.0).T)
        assert radius.min() == pytest.approx(radius.max(), abs=OFF) and kinds(text_of(asked), asked) == set()
    assert codes == {("missing", "operations[0].z_bottom"), ("not-level", "operations[0].edge_names[0]")}


@pytest.mark.parametrize("radius", [300.0, 900.0])
def test_a_large_circle_is_followed(tmp_path: Path, radius: float) -> None:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    writer = STEPControl_Writer()
    writer.Transfer(BRepPrimAPI_MakeCylinder(radius, 8.0).Shape(), STEPControl_AsIs)
    writer.Write(str(tmp_path / "disc.step"))
    asked = job(["Edge1"], "outside", file=tmp_path / "disc.step", z_bottom=0.0, step={"height": 8.0}, setup=STOCK)
    beside = np.hypot(*level(text_of(asked), 0.0).T) - radius
    assert (beside > 3.0 - 0.002).all() and (beside < 3.0 + OFF).all()


def test_a_plunge_into_the_stock_is_found() -> None:
    straight = job(RIM, "inside", plunge=True)
    text = text_of(straight)
    assert kinds(text, straight) == {"unreached"}
    assert "steep-entry" in kinds(text, job(RIM, "inside"))
    steep = text_of(job(RIM, "inside", entry_angle_deg=4.0))
    assert "steep-entry" in kinds(steep, job(RIM, "inside"))


def plate(path: Path, seed: int, hole: bool) -> list[np.ndarray]:
    """Writes a plate of Z0 to Z8 with a random border, or one with a random opening; the border in points, mm."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakePrism
    from OCP.GC import GC_MakeArcOfCircle
    from OCP.gp import gp_Pnt, gp_Vec
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    drawn = random.Random(seed)
    count = drawn.randint(4, 9)
    angles = np.linspace(0.0, 2 * math.pi, count, endpoint=False)
    corners = [drawn.uniform(12.0, 28.0) * np.array([math.cos(angle), math.sin(angle)]) for angle in angles]
    wire, border = BRepBuilderAPI_MakeWire(), []
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        ends = [gp_Pnt(*point, 0.0) for point in (a, b)]
        bow = drawn.choice((0.0, 0.0, 0.15, -0.15)) * np.array([b[1] - a[1], a[0] - b[0]])
        if not bow.any():
            wire.Add(BRepBuilderAPI_MakeEdge(*ends).Edge())
            border.append(a + np.linspace(0.0, 1.0, 2000)[:, None] * (b - a))
            continue
        middle = (a + b) / 2 + bow
        arc = GC_MakeArcOfCircle(ends[0], gp_Pnt(*middle, 0.0), ends[1]).Value()
        wire.Add(BRepBuilderAPI_MakeEdge(arc).Edge())
        at = [arc.Value(t) for t in np.linspace(arc.FirstParameter(), arc.LastParameter(), 2000).tolist()]
        border.append(np.array([(point.X(), point.Y()) for point in at]))
    solid = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0.0, 0.0, 8.0)).Shape()
    if hole:
        block = BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -40.0, 0.0), gp_Pnt(40.0, 40.0, 8.0)).Shape()
        solid = BRepAlgoAPI_Cut(block, solid).Shape()
    writer = STEPControl_Writer()
    writer.Transfer(solid, STEPControl_AsIs)
    writer.Write(str(path))
    return border


@pytest.mark.parametrize("seed", range(20))
def test_random_borders_are_followed_at_the_radius(tmp_path: Path, seed: int) -> None:
    is_hole = seed % 2 == 1
    border = np.concatenate(plate(tmp_path / "plate.step", seed, is_hole))
    profile = {"kind": ("flat", "ball", "flat", "clothoid")[seed % 4], "diameter": (4.0, 7.0)[seed % 3 == 0]}
    side = "inside" if is_hole else "outside"
    asked = job(None, side, profile, tmp_path / "plate.step", fit=("lines", "arcs")[seed % 5 == 0], setup=STOCK)
    text = text_of(asked)
    assert kinds(text, asked) <= {"unreached"}
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    points = ends[(np.abs(ends[:, 2]) < 6e-4)][:, :2]
    assert len(points) > 8
    beside = np.array([np.hypot(*(border - point).T).min() for point in points])
    radius = profile["diameter"] / 2
    assert (beside > radius - 0.002).all() and (beside < radius + OFF + 0.002).all()
    # from outside in and from inside out: both are found
    assert {"gouge", "excess"} & kinds(moved(text, "X", 0.02), asked)


@pytest.mark.parametrize(
    ("edges", "side", "keys", "code", "where"),
    [
        (RIM, "left", {}, "wrong-side", "edge_side"),
        ([FRONT], "outside", {}, "wrong-side", "edge_side"),
        (["Edge1"], "right", {}, "not-level", "edge_names[0]"),
        ([FRONT, "Edge900"], "right", {}, "unknown", "edge_names[1]"),
        (OUTLINE, "outside", {"z_bottom": 20.0}, "conflict", "z_bottom"),
        (SLOT, "inside", {}, "no-room", "tool"),
        (RIM, "inside", {"finish": True}, "conflict", "finish"),
        (RIM, "inside", {"step": {"scallop": 0.1}}, "conflict", "step.scallop"),
        (RIM, "inside", {"step": {"height": 0.0001}}, "out-of-range", "step"),
        (RIM, "inside", {"boundary": {"slope_deg": [0.0, 30.0]}}, "conflict", "boundary"),
        (RIM, "on", {"radial_stock_to_leave": 0.2}, "conflict", "radial_stock_to_leave"),
        (RIM, "inside", {"tabs": {"width": 3.0, "height": 1.0}}, "conflict", "tabs"),
        (RIM, "inside", {"tabs": {"count": 90, "width": 3.0, "height": 1.0}}, "tabs", "tabs"),
        (None, "inside", {"faces": ["Face9"]}, "no-edge", "faces"),
    ],
)
def test_what_cannot_be_followed_is_refused_with_what_to_do(
    edges: list[str] | None, side: str, keys: dict[str, Any], code: str, where: str
) -> None:
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(edges, side, **keys))
    error = caught.value
    assert (error.code, error.where) == (code, f"operations[0].{where}") and error.hint
    if code == "wrong-side":
        assert all(word in error.hint for word in ("on", "left" if side == "outside" else "outside"))
