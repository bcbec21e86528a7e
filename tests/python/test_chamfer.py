"""Sharp edges that are chamfered: the path against its closed form, and the verifier of the posted text."""

from __future__ import annotations

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
SLOT = ((10.0, 38.0), (34.0, 38.8))
BOSS = ((58.0, 25.0), 8.0)
TOP, BOSS_TOP = 12.0, 17.0
OFF = 0.003
"""What rounding may cost a posted position, mm, and the path keeps out for it and for the part's triangles."""
CHORD = 0.006
"""What the boss' triangles and chords about corners may cost beyond that, mm."""
V90 = {"kind": "v", "tip_diameter": 0.0, "angle_deg": 90.0, "diameter": 10.0}


@pytest.fixture(autouse=True)
def _step() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")


def job(profile: Any = None, machine: str = "linuxcnc", faces: Any = "all", **keys: Any) -> sc.Job:
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / "edges.step"), "faces": faces},
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "clearance": 30.0, "retract": 14.0},
            "machine": {"name": machine},
            "tools": {"v": {"number": 1, "length": 60.0, "profile": profile or V90}},
            "operations": [
                {
                    "kind": "chamfer",
                    "tool": "v",
                    "width": 0.5,
                    "feeds": {"cut": 600.0, "plunge": 200.0},
                    "spindle": {"mode": "fixed", "rpm": 8000.0},
                    **keys,
                }
            ],
        }
    )


def text_of(asked: sc.Job, machine: str = "linuxcnc") -> str:
    return sc.post(sc.plan(asked), machine).text


def kinds(text: str, asked: sc.Job) -> set[str]:
    return {finding["kind"] for finding in sc.verify(text, asked).to_dict()["findings"]}


def unreached(text: str, asked: sc.Job) -> float:
    found = [finding for finding in sc.verify(text, asked).to_dict()["findings"] if finding["kind"] == "unreached"]
    return sum(finding["value"] for finding in found)


def cut(text: str, height: float) -> np.ndarray:
    """The positions of feeds at one height of the tip, mm."""
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    return ends[np.abs(ends[:, 2] - height) < 6e-4][:, :2]


def outside(points: np.ndarray, low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    """Distances from a rectangle, mm; negative inside of it."""
    middle, half = np.add(low, high) / 2, np.subtract(high, low) / 2
    over = np.abs(points - middle) - half
    return np.where((over <= 0).all(axis=1), over.max(axis=1), np.hypot(*np.maximum(over, 0.0).T))


def check_path(text: str, expected: float, below: float) -> None:
    """The axis is as far beside each edge as the cone asks for, all around it."""
    level = cut(text, TOP - below)
    plate, pocket = outside(level, *PLATE), outside(level, *POCKET)
    around, within = plate > 0, pocket < 0
    assert (around | within | (outside(level, *SLOT) < 0)).all() and around.sum() > 8 and within.sum() >= 4
    assert (plate[around] > expected - 0.0005).all() and (plate[around] < expected + CHORD).all()
    assert np.allclose(-pocket[within], expected, atol=OFF)
    # to the corners, where lines meet
    for axis in (0, 1):
        assert level[within][:, axis].min() == pytest.approx(POCKET[0][axis] + expected, abs=2 * OFF)
        assert level[around][:, axis].max() == pytest.approx(PLATE[1][axis] + expected, abs=2 * OFF + CHORD)
    boss = np.hypot(*(cut(text, BOSS_TOP - below) - BOSS[0]).T) - BOSS[1]
    assert len(boss) > 30 and (boss > expected - OFF).all() and (boss < expected + CHORD).all()


@pytest.mark.parametrize("direction", ["climb", "conventional"])
def test_the_path_is_the_edge_s_parallel_at_the_cone_s_radius(direction: str) -> None:
    asked = job(direction=direction)
    text = text_of(asked)
    check_path(text, expected=0.5, below=1.0)
    assert kinds(text, asked) == {"unreached"}
    # eight ends of the pocket's edges, each the axis' distance long, and both sides and ends of the slot
    assert unreached(text, asked) == pytest.approx(8 * 0.5 + 2 * (24.0 + 0.8), abs=0.3)
    # with the material on the right, around the boss clockwise
    boss = cut(text, BOSS_TOP - 1.0) - BOSS[0]
    turn = (boss[:-1, 0] * boss[1:, 1] - boss[:-1, 1] * boss[1:, 0]).sum()
    assert (turn < 0) == (direction == "climb")


@pytest.mark.parametrize("seed", range(5))
def test_any_cone_width_and_offset_give_their_own_parallel(seed: int) -> None:
    drawn = random.Random(seed)
    width, angle, tip, offset = (
        round(drawn.uniform(*ends), 3) for ends in ((0.1, 1.5), (50.0, 130.0), (0.0, 1.0), (0.05, 0.8))
    )
    profile = {"kind": "v", "tip_diameter": tip, "angle_deg": angle, "diameter": 14.0}
    asked = job(profile, width=width, tip_offset=offset)
    text = text_of(asked)
    slope = math.tan(math.radians(angle / 2))
    check_path(text, expected=0.5 * tip + offset * slope, below=offset + width / slope)
    assert kinds(text, asked) == {"unreached"}


MACHINES = sorted(file.stem for file in (FIXTURES.parent / "rust" / "post" / "machines").glob("*.toml"))


@pytest.mark.parametrize("machine", MACHINES)
def test_every_machine_posts_it_and_its_text_is_found_sound(machine: str) -> None:
    asked = job(machine=machine, width=0.3)
    assert kinds(text_of(asked, machine), asked) == {"unreached"}


def moved(text: str, by: float) -> str:
    """The text with all heights of the operation's feeds moved, mm."""
    return re.sub(r"Z(1\d\.?\d*)", lambda found: f"Z{float(found[1]) + by:.3f}", text)


@pytest.mark.parametrize(("by", "kind"), [(0.05, "excess"), (-0.05, "gouge"), (0.01, "excess"), (-0.005, "gouge")])
def test_a_tool_that_is_too_high_or_too_low_is_found(by: float, kind: str) -> None:
    asked = job()
    assert kinds(moved(text_of(asked), by), asked) == {kind, "unreached"}


def runs(text: str) -> list[str]:
    """Head and stretches of a text, each from its first rapid at clearance."""
    return re.split(r"(?=^G0 Z47$)", text, flags=re.MULTILINE)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_an_edge_that_is_left_out_is_found(number: int) -> None:
    asked = job()
    parts = runs(text_of(asked))
    assert len(parts) == 5  # behind the last there is the end alone
    without = "".join(part for i, part in enumerate(parts) if i != number)
    assert "excess" in kinds(without, asked)
    assert "excess" in kinds(text_of(job(edge_names=["Edge38"])), asked)


def test_the_opposite_wall_of_a_slot_is_not_touched_and_its_gouge_is_found() -> None:
    # its bottom is 0.8 mm wide: the cone's tip fits only where it is narrow there
    narrow = job(width=0.2, tip_offset=0.2)
    assert unreached(text_of(narrow), narrow) < 6.0
    wide = job(width=0.2, tip_offset=0.5)
    assert unreached(text_of(wide), wide) > 49.0
    # the path of the narrow one with the tip where the wide one has it enters the opposite wall
    assert "gouge" in kinds(moved(text_of(narrow), -0.3), wide)


def test_a_plunge_onto_the_edge_is_found() -> None:
    asked = job()
    text = re.sub(r"^G1 Z11\.7 ", "G1 Z11 ", text_of(asked), count=1, flags=re.MULTILINE)
    assert kinds(text, asked) == {"steep-entry", "unreached"}


def frustum(path: Path, draft: float, foot: bool = False) -> Path:
    """An STL file of a block of 20 x 16 x 8 mm at its top whose sides lean out, its top at Z8."""
    out = 8.0 * math.tan(math.radians(draft))
    low = [(-out, -out, 0.0), (20 + out, -out, 0.0), (20 + out, 16 + out, 0.0), (-out, 16 + out, 0.0)]
    high = [(0.0, 0.0, 8.0), (20.0, 0.0, 8.0), (20.0, 16.0, 8.0), (0.0, 16.0, 8.0)]
    sides = [[low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]] for i in range(4)]
    quads = [low[::-1], high, *sides]
    lines = ["solid frustum"]
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            corners = "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in triangle)
            lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    path.write_text("\n".join([*lines, "endsolid frustum\n"]), encoding="ascii")
    return path


def leaning(path: Path, **keys: Any) -> sc.Job:
    document = job(**keys).to_dict()
    document["part"] = {"file": str(path), "units": "mm", "faces": "all"}
    return sc.Job.from_dict(document)


@pytest.mark.parametrize("draft", [5.0, 20.0])
def test_beside_a_wall_that_leans_the_chamfer_is_as_wide_and_deeper(tmp_path: Path, draft: float) -> None:
    asked = leaning(frustum(tmp_path / "frustum.stl", draft))
    text = text_of(asked)
    below = 0.5 + 0.5 / (1.0 - math.tan(math.radians(draft)))
    level = cut(text, 8.0 - below)
    beside = (np.abs(level - (10.0, 8.0)) - (10.0, 8.0)).max(axis=1)
    # the lines beside two edges meet: about the corner the tool would enter what comes out below it
    assert len(level) == 6 and np.allclose(beside, below - 0.5, atol=OFF)
    assert kinds(text, asked) == set()
    assert kinds(text.replace(" X20.", " X20.1"), asked) <= {"excess", "gouge"}


def test_a_wall_that_leans_as_the_cone_does_is_refused(tmp_path: Path) -> None:
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(leaning(frustum(tmp_path / "frustum.stl", 44.0)))
    assert caught.value.code == "flat-wall"


def test_a_wide_shank_ends_a_stretch_beside_what_stands_higher() -> None:
    document = job(edge_names=["Edge8"]).to_dict()
    document["tools"]["v"] = {"number": 1, "profile": {**V90, "diameter": 4.0}, "shank_diameter": 46.0}
    asked = sc.Job.from_dict(document)
    text = text_of(asked)
    assert kinds(text, asked) == {"unreached"}
    assert unreached(text, asked) > 20.0


@pytest.mark.parametrize(
    ("keys", "code", "where"),
    [
        ({"profile": {"kind": "ball", "diameter": 6.0}}, "no-cone", "operations[0].tool"),
        ({"tip_offset": 6.0}, "narrow-tool", "operations[0].width"),
        ({"faces": ["Face10"]}, "no-edge", "operations[0].faces"),
        ({"edge_names": ["Edge1"]}, "no-edge", "operations[0].edge_names[0]"),
        ({"edge_names": ["Edge900"]}, "unknown", "operations[0].edge_names[0]"),
        ({"edge_names": ["Edge14"]}, "no-room", "operations[0].tool"),
        ({"width": 9.0, "profile": {**V90, "diameter": 60.0}}, "wide-chamfer", "operations[0].width"),
        ({"lead": "tangent"}, "conflict", "operations[0].lead"),
    ],
)
def test_what_cannot_be_chamfered_is_refused_with_what_to_do(keys: dict[str, Any], code: str, where: str) -> None:
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(**keys))
    assert caught.value.code == code
    assert getattr(caught.value, "where", where) == where
