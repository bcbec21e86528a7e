"""Programs with a leaning tool for machines with two rotary axes: there and back, and against LinuxCNC."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import roots
import rs274
import styluscam as sc
from styluscam import _engine

F = npt.NDArray[np.float64]

TOOL = {"profile": {"kind": "flat", "diameter": 8.0}}
TIP_CONTROL = {"on": "G43.4 H{{ tool.length_offset }}", "off": "G49"}


@pytest.fixture(scope="module")
def program() -> sc.Program:
    """A strip between two rails that are turned by 20 deg against each other."""
    lean = 30.0 * math.tan(math.radians(20.0))
    positions = sc.flank_positions([[0, 0, 0], [60, 0, 0]], [[0, 0, 30], [60, lean, 30]], TOOL, 40)
    return sc.flank_program(positions, feed=800.0, clearance=40.0, lead=3.0)


def axis(
    letter: str, carries: str, direction: Any, pivot: Any = (0.0, 0.0, 0.0), most: float = 360.0
) -> dict[str, Any]:
    return {
        "letter": letter,
        "carries": carries,
        "direction": list(direction),
        "pivot": list(pivot),
        "limits_deg": [-most, most],
    }


def document(axes: Any, control: dict[str, str] | None = None, **rules: Any) -> dict[str, Any]:
    rotary = {"axes": list(axes), **({} if control is None else {"tip_control": control}), **rules}
    return {
        "extends": "linuxcnc",
        "name": "five",
        "number": {"mm": {"linear": 5, "feed": 1, "inverse_time": 6}},
        "feed": {"mode": "inverse-time" if control is None else "per-minute"},
        "rotary": rotary,
    }


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
AT, OFFSET = np.array([5.0, 12.0, -80.0]), np.array([0.0, -42.0, 13.0])
TRUNNION = axis("A", "table", X, AT + OFFSET), axis("C", "table", Z, AT)
ARM = 160.0
BRIDGE = axis("C", "head", Z), axis("B", "head", (0.0, -1.0, 0.0), (0.0, 0.0, ARM))
MACHINES = {
    "tilting table": (axis("A", "table", X, (5.0, -30.0, -80.0)), axis("C", "table", Z, (5.0, 12.0, 0.0))),
    "trunnion with an offset": TRUNNION,
    "fork head": (axis("C", "head", Z), axis("A", "head", X, (0.0, 0.0, 160.0))),
    "bridge mill": BRIDGE,
    "head and table": (axis("B", "head", Y, (3.0, 0.0, 120.0)), axis("C", "table", Z, (5.0, 12.0, 0.0))),
    "nutating table": (axis("B", "table", (0.0, 1.0, 1.0), (0.0, 0.0, -50.0)), axis("C", "table", Z)),
}


def words(text: str, letters: str) -> F:
    """The values of all words of a program's blocks, (N, letters), from the first on in which all have been stated."""
    values: dict[str, float] = {}
    rows = []
    for line in text.splitlines():
        if line.startswith("("):
            continue
        found = {word[0]: float(word[1:]) for word in line.split() if word[0] in letters}
        values.update(found)
        if found and len(values) == len(letters):
            rows.append([values[letter] for letter in letters])
    return np.array(rows)


def away(points: F, line: F) -> float:
    """The largest distance of points (N, 3) from a polyline (M, 3), mm."""
    along = np.diff(line, axis=0)
    squares = np.maximum((along**2).sum(axis=1), 1e-30)
    shares = np.clip(np.einsum("nmk,mk->nm", points[:, None] - line[:-1], along) / squares, 0.0, 1.0)
    feet = line[:-1] + shares[..., None] * along
    return float(np.linalg.norm(points[:, None] - feet, axis=2).min(axis=1).max())


def arrivals(program: sc.Program, machine: sc.Machine, back: sc.Program) -> npt.NDArray[np.intp]:
    """Index of the read move with which each move of the program ends."""
    lines = _engine.lines_of_moves(program.engine, machine.engine)
    return np.searchsorted(back.moves["line"], lines, side="right") - 1


@pytest.mark.parametrize("axes", MACHINES.values(), ids=MACHINES)
@pytest.mark.parametrize("control", [None, TIP_CONTROL], ids=["machine", "tip"])
def test_a_text_leads_back_to_the_tips_and_axes(program: sc.Program, axes: Any, control: Any) -> None:
    machine = sc.Machine(document(axes, control))
    back = sc.read_gcode(sc.post(program, machine).text, machine)
    ends = back.moves[arrivals(program, machine, back)]
    # half a unit of 1e-5 mm on each axis, and of 1e-5 deg on arms of up to 200 mm
    assert np.linalg.norm(ends["end"] - program.moves["end"], axis=1).max() < 1e-4
    assert np.abs(ends["axis"] - program.moves["axis"]).max() < 1e-5
    assert (ends["kind"] == program.moves["kind"]).all() and np.allclose(ends["feed"], program.moves["feed"], rtol=2e-3)
    # between them the tip keeps to its straight moves, as the reader's moves keep to its path
    assert away(back.moves["end"][2:], program.moves["end"]) < 0.001 + 2e-4


def trunnion(joints: F) -> tuple[F, F]:
    """LinuxCNC, "5-Axis Kinematics", XYZAC trunnion: forward, with the point of rotation and an offset between both axes."""
    a, c = np.radians(joints[:, 3]), np.radians(joints[:, 4])
    x, y, z = (joints[:, :3] - AT - OFFSET * [0, 1, 1]).T
    (sa, ca), (s, k) = (np.sin(a), np.cos(a)), (np.sin(c), np.cos(c))
    tip = [k * x + s * ca * y + s * sa * z + s * OFFSET[1], -s * x + k * ca * y + k * sa * z + k * OFFSET[1]]
    return np.column_stack([*tip, -sa * y + ca * z + OFFSET[2]]) + AT, np.column_stack([s * sa, k * sa, ca])


def test_a_tilting_table_goes_as_linuxcnc_takes_it_to_go(program: sc.Program) -> None:
    machine = sc.Machine(document(TRUNNION, tip_tolerance=0.002))
    text = sc.post(program, machine).text
    joints = words(text, "XYZAC")
    tips, directions = trunnion(joints)
    ends = program.moves["end"]
    apart = np.linalg.norm(tips[:, None] - ends, axis=2)
    assert apart.min(axis=0).max() < 1e-4
    assert np.abs(directions[apart.argmin(axis=0)] - program.moves["axis"]).max() < 1e-5
    # between the lines of the text all axes go evenly: the tip keeps to its straight moves
    shares = np.linspace(0.0, 1.0, 9)[:, None, None]
    between = (joints[:-1] + shares * (joints[1:] - joints[:-1])).reshape(-1, 5)
    assert away(trunnion(between)[0], ends) < 0.002 + 1e-4
    # and the reader's moves, far more of them, keep to where the tip really is
    read = sc.read_gcode(text, machine).moves["end"][1:]
    assert away(trunnion(between)[0], read) < 2e-4 and away(read, trunnion(between)[0]) < 0.05


def test_a_coarse_text_is_read_as_it_moves(program: sc.Program) -> None:
    machine = sc.Machine(document(TRUNNION, tip_tolerance=10.0))
    text = sc.post(program, machine).text
    joints = words(text, "XYZAC")
    shares = np.linspace(0.0, 1.0, 9)[:, None, None]
    between = (joints[:-1] + shares * (joints[1:] - joints[:-1])).reshape(-1, 5)
    assert len(joints) == len(program.moves)
    assert away(trunnion(between)[0], program.moves["end"]) > 0.004
    read = sc.read_gcode(text, machine)
    assert len(read.moves) > 4 * len(joints) and (np.diff(read.moves["line"].astype(int)) >= 0).all()
    assert away(trunnion(between)[0], read.moves["end"]) < 2e-4


def test_a_bridge_mill_goes_as_linuxcnc_takes_it_to_go(program: sc.Program) -> None:
    """LinuxCNC, 5axiskins: the tip hangs from the pivot of B, at C round it."""
    joints = words(sc.post(program, document(BRIDGE)).text, "XYZBC")
    b, c = np.radians(joints[:, 3]), np.radians(joints[:, 4])
    hanging = ARM * np.column_stack([np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), 1.0 - np.cos(b)])
    apart = np.linalg.norm((joints[:, :3] + hanging)[:, None] - program.moves["end"], axis=2)
    assert apart.min(axis=0).max() < 1e-4


@pytest.mark.world
def test_linuxcnc_reads_the_same_positions_of_all_axes(program: sc.Program) -> None:
    """Its interpreter takes every block, and its kinematics lead to the tips and axes that ours reads."""
    machine = sc.Machine(document(TRUNNION))
    text = sc.post(program, machine).text
    try:
        found = rs274.interpret(text)
    except roots.Unavailable as reason:
        pytest.skip(f"NOT TESTED with LinuxCNC: {reason}")
    assert found.ok, found.error
    moves = [call for call in found.moves if None not in (call.x, call.a, call.c)]
    theirs = np.array([(*call.mm, call.a, call.c) for call in moves], dtype=np.float64)
    # its numbers have four decimals
    stated = words(text, "XYZAC")
    assert len(stated) > 150 and np.abs(theirs[-len(stated) :] - stated).max() <= 5.1e-5
    tips, directions = trunnion(theirs)
    back = sc.read_gcode(text, machine).moves
    last = back[np.r_[np.flatnonzero(np.diff(back["line"])), len(back) - 1]]
    assert np.abs(tips[-150:] - last["end"][-150:]).max() < 4e-4
    assert np.abs(directions[-150:] - last["axis"][-150:]).max() < 1e-5
    assert {call.kind for call in moves} == {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED"}


def test_feeds_are_those_of_the_tip(program: sc.Program) -> None:
    machine = sc.Machine(document(TRUNNION))
    text = sc.post(program, machine).text
    back = sc.read_gcode(text, machine).moves
    rates = {
        n: float(line.rsplit("F", 1)[1]) for n, line in enumerate(text.splitlines(), 1) if "F" in line.split("(")[0]
    }
    lengths = np.linalg.norm(np.diff(back["end"], axis=0), axis=1)
    assert len(rates) > 100
    for line, rate in rates.items():
        length = lengths[np.flatnonzero(back["line"] == line) - 1].sum()
        assert rate * length == pytest.approx(800.0, rel=2e-3)
        assert np.allclose(back["feed"][back["line"] == line], rate * length, rtol=1e-9)
    assert "G93" in text and "G94" not in text


def test_a_text_begins_with_its_angles_and_ends_without_tip_control(program: sc.Program) -> None:
    lines = sc.post(program, document(MACHINES["tilting table"], TIP_CONTROL)).text.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("G0 A"))
    assert lines[first].split()[2].startswith("C") and lines[first + 1] == "G43.4 H1"
    assert lines[first + 2].startswith("G0 Z") and lines[first + 3].startswith("X")
    assert [line for line in lines if not line.startswith("(")][-2:] == ["G49", "M2"]


def test_a_text_in_pieces_is_the_same(program: sc.Program, tmp_path: Path) -> None:
    for control in (None, TIP_CONTROL):
        machine = sc.Machine(document(MACHINES["fork head"], control))
        _engine.post_to(program.engine, machine.engine, str(tmp_path / "part.ngc"))
        assert (tmp_path / "part.ngc").read_bytes().decode() == sc.post(program, machine).text


@pytest.mark.parametrize(
    ("axes", "code"),
    [
        ((axis("A", "table", X, most=5.0), axis("C", "table", Z)), "rotary-limit"),
        ((axis("B", "table", (0.0, 0.1, 1.0)), axis("C", "table", Z)), "rotary-unreachable"),
    ],
)
def test_axes_that_cannot_do_it_are_named(program: sc.Program, axes: Any, code: str) -> None:
    with pytest.raises(sc.MachineError) as caught:
        sc.post(program, document(axes))
    assert caught.value.code == code and caught.value.hint and caught.value.where.startswith("moves[")


GOOD = axis("A", "table", X), axis("C", "table", Z)


@pytest.mark.parametrize(
    ("axes", "rules", "key"),
    [
        ((axis("A", "table", X), axis("A", "table", Z)), {}, "rotary.axes[1].letter"),
        ((axis("A", "table", X), axis("C", "head", (2.0, 0.0, 0.0))), {}, "rotary.axes[1].direction"),
        ((axis("A", "table", (0.0, 0.0, 0.0)), axis("C", "table", Z)), {}, "rotary.axes[0].direction"),
        ((axis("A", "table", X, most=-1.0), axis("C", "table", Z)), {}, "rotary.axes[0].limits_deg"),
        ((axis("U", "table", X), axis("C", "table", Z)), {}, "rotary.axes[0].letter"),
        (GOOD, {"tip_tolerance": 0.0}, "rotary.tip_tolerance"),
        (GOOD, {"angle_decimals": 0}, "rotary.angle_decimals"),
        (GOOD, {"tip_control": {"on": "follow", "off": "G49"}}, "rotary.tip_control.on"),
        (GOOD, {"tip_control": {"on": "G49", "off": "G49"}}, "rotary.tip_control.off"),
        (GOOD, {"tip_control": {"on": "G43.4 H{{ tool.size }}", "off": "G49"}}, "rotary.tip_control.on, line 1"),
    ],
)
def test_machines_that_are_none_are_named(axes: Any, rules: dict[str, Any], key: str) -> None:
    with pytest.raises(sc.MachineError) as caught:
        sc.Machine(document(axes, **rules))
    assert caught.value.where == key and caught.value.hint


def test_what_rotary_axes_need_is_stated() -> None:
    rotary = {"axes": list(GOOD)}
    for changes, key in (
        ({"feed": {"mode": "per-minute"}}, "feed.mode"),
        ({"motion": {"lathe": "radius"}, "cycle": False}, "rotary"),
        ({"extends": "siemens"}, "rotary"),
        ({"extends": "heidenhain"}, "rotary"),
        ({"extends": "marlin"}, "feed.mode"),
    ):
        with pytest.raises(sc.MachineError) as caught:
            sc.Machine({"extends": "linuxcnc", "name": "five", "rotary": rotary, **changes})
        assert caught.value.where == key, changes


def test_three_axes_refuse_a_leaning_tool_and_angles(program: sc.Program) -> None:
    with pytest.raises(sc.MachineError, match="no rotary axes") as caught:
        sc.post(program, "linuxcnc")
    assert "[rotary]" in caught.value.hint
    text = sc.post(program, document(GOOD)).text
    with pytest.raises(sc.VerifyError) as unread:
        sc.read_gcode(text, "linuxcnc")
    assert unread.value.code == "read-unknown-word"


HEAD = "T1 M6\nG21 G90 G17 G93 G43 H1\n"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G0 Z9\nX0 Y0\nG1 X5 F9\nM2", "read-feed-from-unknown"),
        ("G0 A0\nZ9\nX0 Y0\nG1 X5 F9\nM2", "read-feed-from-unknown"),
        ("G0 Z9\nX0 Y0 A0\nM2", "read-never-placed"),
        ("G0 A0 B0\nM2", "read-unknown-word"),
        ("G0 A0 A1\nM2", "read-word-twice"),
        ("G91 G0 A1\nM2", "read-incremental-from-unknown"),
        ("G0 A30 C0\nG0 X0 Y0 Z9\nG38.2 Z0 F9\nM2", "read-not-read"),
        ("G0 A30 C0\nG0 X0 Y0 Z9\nG53 G0 A0\nG1 X5 F9\nM2", "read-feed-from-unknown"),
        ("G0 A30 C0\nG0 X0 Y0 Z9\nG81 X5 Y5 Z0 R2 A3 F9\nM2", "read-stray-word"),
        ("G0 A30 C0\nG0 X0 Y0 Z9\nG55\nM2", "read-not-read"),
    ],
)
def test_texts_that_state_no_pose_are_refused(text: str, code: str) -> None:
    with pytest.raises(sc.VerifyError) as caught:
        sc.read_gcode(HEAD + text, document(GOOD))
    assert caught.value.code == code


def test_turns_on_the_spot_arcs_and_holes_are_read_as_they_go() -> None:
    table = document((axis("A", "table", X), axis("C", "table", Z)))
    read = lambda text: sc.read_gcode(HEAD + text + "\nM2", table).moves  # noqa: E731
    start = "G0 A0 C0\nZ50\nX10 Y0\n"
    # a turn on the axis takes as long as a mm for each degree, and the tool stays
    spot = read("G0 A0 C0\nZ50\nX0 Y0\nG1 C90 F2")
    assert np.allclose(spot["end"][-1], [0, 0, 50]) and set(spot["feed"][2:]) == {180.0}
    # beside it the part turns under the tool: clockwise about it, as long as the arc
    ring = read(start + "G1 C90 F2")[2:]
    assert np.allclose(np.linalg.norm(ring["end"][:, :2], axis=1), 10.0) and np.allclose(ring["end"][-1], [0, -10, 50])
    assert np.allclose(ring["feed"], 2 * 10 * math.pi / 2, rtol=1e-5) and len(ring) > 100
    # upright and at 0 nothing changes: arcs stay arcs
    arc = sc.read_gcode(HEAD + start + "G3 X0 Y10 I-10 F9\nM2", table)
    assert arc.moves["kind"][-1] == 3 and len(arc.moves) == 3
    # an arc of a table that has turned is one in another plane
    turned = read("G0 A90 C0\nZ50\nX10 Y0\nG3 X0 Y10 I-10 F9")
    ends = turned["end"]
    assert (
        np.allclose(ends[-1], [0, 50, -10]) and np.allclose(ends[:, 1], 50) and np.allclose(turned["axis"], [0, 1, 0])
    )
    assert np.allclose(np.linalg.norm(ends[2:, [0, 2]], axis=1), 10.0, atol=1e-9) and len(turned) > 50
    # F of one minute is the linear axes' where the tip is not tracked
    minute = sc.read_gcode(HEAD.replace("G93", "G94") + start + "G1 X20 C90 F100\nM2", table)
    assert minute.duration == pytest.approx(6.0) and not np.isnan(minute.moves["feed"]).any()


def test_upright_programs_state_their_angles_and_keep_their_arcs(program: sc.Program) -> None:
    for name in ("linuxcnc-trunnion",):
        machine = sc.Machine.shipped(name)
        outcomes = {trial.name: trial for trial in machine.check()}
        assert outcomes["a leaning tool"].outcome == outcomes["leaning tools"].outcome == "passed"
        text = outcomes["arcs in XY"].text
        assert re.search(r"^G0 A0\.? C0\.?$", text, re.MULTILINE) and re.search(r"^G2 ", text, re.MULTILINE)
