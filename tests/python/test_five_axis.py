"""Programs with a leaning tool for machines with two rotary axes: there and back, and against LinuxCNC's published kinematics."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pytest

import styluscam as sc

F = npt.NDArray[np.float64]

TOOL = {"profile": {"kind": "flat", "diameter": 8.0}}
FINE = {"name": "linuxcnc", "options": {"decimals": 5}}


@pytest.fixture(scope="module")
def program() -> sc.Program:
    """A strip between two rails that are turned by 20 deg against each other."""
    lean = 30.0 * math.tan(math.radians(20.0))
    positions = sc.flank_positions([[0, 0, 0], [60, 0, 0]], [[0, 0, 30], [60, lean, 30]], TOOL, 40)
    return sc.flank_program(positions, feed=800.0, clearance=40.0, lead=3.0)


def table(
    letter: Literal["A", "B", "C"], direction: Any, pivot: Any = (0.0, 0.0, 0.0), most: float = 360.0
) -> sc.RotaryAxis:
    return sc.RotaryAxis(letter, "table", direction, pivot, (-most, most))


def head(
    letter: Literal["A", "B", "C"], direction: Any, pivot: Any = (0.0, 0.0, 0.0), most: float = 360.0
) -> sc.RotaryAxis:
    return sc.RotaryAxis(letter, "head", direction, pivot, (-most, most))


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
MACHINES = {
    "tilting table": (table("A", X, (5.0, -30.0, -80.0)), table("C", Z, (5.0, 12.0, 0.0))),
    "fork head": (head("C", Z), head("A", X, (0.0, 0.0, 160.0))),
    "head and table": (head("B", Y, (3.0, 0.0, 120.0)), table("C", Z, (5.0, 12.0, 0.0))),
    "nutating table": (table("B", (0.0, 1.0, 1.0), (0.0, 0.0, -50.0)), table("C", Z)),
}


def words(text: str, letters: str) -> F:
    """The values of all words of a program, line by line, (N, letters), from its first move on."""
    values = dict.fromkeys(letters, 0.0)
    rows = []
    for line in text.splitlines():
        found = {word[0]: float(word[1:]) for word in line.split() if word[0] in letters}
        values.update(found)
        if found.keys() & set("XYZ"):
            rows.append([values[letter] for letter in letters])
    return np.array(rows)


def away(points: F, line: F) -> float:
    """The largest distance of points (N, 3) from a polyline (M, 3), mm."""
    along = np.diff(line, axis=0)
    squares = np.maximum((along**2).sum(axis=1), 1e-30)
    shares = np.clip(np.einsum("nmk,mk->nm", points[:, None] - line[:-1], along) / squares, 0.0, 1.0)
    feet = line[:-1] + shares[..., None] * along
    return float(np.linalg.norm(points[:, None] - feet, axis=2).min(axis=1).max())


@pytest.mark.parametrize("axes", MACHINES.values(), ids=MACHINES)
@pytest.mark.parametrize("control", [None, ("G43.4 H1", "G49")], ids=["machine", "tip"])
def test_a_text_leads_back_to_the_tips_and_axes(program: sc.Program, axes: Any, control: Any) -> None:
    machine = sc.FiveAxes(*axes, tip_control=control)
    tips, directions = machine.read(machine.post(program, FINE), FINE)
    # half a unit of 1e-5 mm on each axis, and of 1e-5 deg on arms of up to 200 mm
    near = 1e-4
    apart = np.linalg.norm(tips[:, None] - program.moves["end"], axis=2)
    assert apart.min(axis=0).max() < near
    assert np.abs(directions[apart.argmin(axis=0)] - program.moves["axis"]).max() < 1e-5


def test_a_tilting_table_goes_as_linuxcnc_takes_it_to_go(program: sc.Program) -> None:
    """LinuxCNC, "5-Axis Kinematics", XYZAC trunnion: forward, with the point of rotation and an offset between both axes."""
    at, offset = np.array([5.0, 12.0, -80.0]), np.array([0.0, -42.0, 13.0])
    axes = table("A", X, tuple(at + offset)), table("C", Z, tuple(at))
    text = sc.FiveAxes(*axes, tip_tolerance=0.002).post(program, FINE)
    joints = words(text, "XYZAC")

    def forward(joints: F) -> tuple[F, F]:
        a, c = np.radians(joints[:, 3]), np.radians(joints[:, 4])
        x, y, z = (joints[:, :3] - at - offset * [0, 1, 1]).T
        (sa, ca), (s, k) = (np.sin(a), np.cos(a)), (np.sin(c), np.cos(c))
        tip = [k * x + s * ca * y + s * sa * z + s * offset[1], -s * x + k * ca * y + k * sa * z + k * offset[1]]
        up = np.column_stack([s * sa, k * sa, ca])
        return np.column_stack([*tip, -sa * y + ca * z + offset[2]]) + at, up

    tips, directions = forward(joints)
    ends = program.moves["end"]
    apart = np.linalg.norm(tips[:, None] - ends, axis=2)
    assert apart.min(axis=0).max() < 1e-4
    assert np.abs(directions[apart.argmin(axis=0)] - program.moves["axis"]).max() < 1e-5
    # between the lines of the text all axes go evenly: the tip keeps to its straight moves
    shares = np.linspace(0.0, 1.0, 9)[:, None, None]
    between = (joints[:-1] + shares * (joints[1:] - joints[:-1])).reshape(-1, 5)
    assert away(forward(between)[0], ends) < 0.002 + 1e-4
    coarse = sc.FiveAxes(*axes, tip_tolerance=10.0).post(program, FINE)
    joints = words(coarse, "XYZAC")
    between = (joints[:-1] + shares * (joints[1:] - joints[:-1])).reshape(-1, 5)
    assert len(joints) == len(program.moves) and away(forward(between)[0], ends) > 0.004


def test_a_bridge_mill_goes_as_linuxcnc_takes_it_to_go(program: sc.Program) -> None:
    """LinuxCNC, 5axiskins: the tip hangs from the pivot of B, at C round it."""
    length = 160.0
    text = sc.FiveAxes(head("C", Z), head("B", (0.0, -1.0, 0.0), (0.0, 0.0, length))).post(program, FINE)
    joints = words(text, "XYZBC")
    b, c = np.radians(joints[:, 3]), np.radians(joints[:, 4])
    hanging = length * np.column_stack([np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), 1.0 - np.cos(b)])
    ends = program.moves["end"]
    apart = np.linalg.norm((joints[:, :3] + hanging)[:, None] - ends, axis=2)
    assert apart.min(axis=0).max() < 1e-4


def test_feeds_are_those_of_the_tip(program: sc.Program) -> None:
    machine = sc.FiveAxes(*MACHINES["tilting table"])
    text = machine.post(program, FINE)
    tips, _ = machine.read(text, FINE)
    rates = [line.rsplit("F", 1)[1] for line in text.splitlines() if line.startswith("G93 G1")]
    moves = [line for line in text.splitlines() if set("XYZ") & {word[0] for word in line.split()}]
    feeds = [
        float(line.rsplit("F", 1)[1]) * np.linalg.norm(tips[number] - tips[number - 1])
        for number, line in enumerate(moves)
        if line.startswith("G93 G1")
    ]
    assert len(rates) == len(feeds) and np.allclose(feeds, 800.0, rtol=2e-3)


@pytest.mark.parametrize(
    ("axes", "code"),
    [
        ((table("A", X, most=5.0), table("C", Z)), "rotary-limit"),
        ((table("A", X), table("A", Z)), "rotary-letter"),
        ((table("A", X), head("C", (2.0, 0.0, 0.0))), "rotary-parallel"),
        ((table("A", (0.0, 0.0, 0.0)), table("C", Z)), "rotary-axis"),
        ((table("A", (math.nan, 0.0, 0.0)), table("C", Z)), "rotary-axis"),
        ((table("B", (0.0, 0.1, 1.0)), table("C", Z)), "rotary-unreachable"),
    ],
)
def test_axes_that_cannot_do_it_are_named(program: sc.Program, axes: Any, code: str) -> None:
    with pytest.raises(sc.MachineError) as caught:
        sc.FiveAxes(*axes).post(program, FINE)
    assert caught.value.code == code and caught.value.hint


@pytest.mark.parametrize("form", [{"tip_tolerance": 0.0}, {"tip_tolerance": math.nan}, {"angle_decimals": 0}])
def test_forms_that_are_none_are_named(program: sc.Program, form: dict[str, Any]) -> None:
    with pytest.raises(sc.MachineError) as caught:
        sc.FiveAxes(*MACHINES["fork head"], **form).post(program, FINE)
    assert caught.value.code == "rotary-form"


def test_other_controllers_and_texts_are_refused(program: sc.Program) -> None:
    machine = sc.FiveAxes(*MACHINES["fork head"])
    for name in ("heidenhain", "marlin"):
        with pytest.raises(sc.MachineError):
            machine.post(program, name)
    for text in ("G0 XA", "G1 U3", "G1 Xnan Y0", "O100 sub"):
        with pytest.raises(sc.MachineError):
            machine.read(text, FINE)
    with pytest.raises(sc.MachineError, match="three axes"):
        sc.post(program, "linuxcnc")
