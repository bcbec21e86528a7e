"""Rows of `zig-zag` in flat sheet, layer by layer: no pass presses the sheet deeper than `max_increment`, and what is found in
spoiled ones."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
RADIUS, TOLERANCE = 5.0, 0.01
ACCEPTED = ["wall-angle", "bridged", "unreached"]
INCREMENT = {"max_increment": 2.0, "stepover": 4.0}


def job(part: str, machine: str = "linuxcnc", process: Any = None, **keys: Any) -> sc.Job:
    """Rows 3 mm apart over a part's flat sheet."""
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": {"file": str(FIXTURES / f"{part}.step"), "model_face": "tool"},
            "setup": {"sheet": {"thickness": 1.0}},
            "process": process or {"kind": "spif"},
            "tools": {"ball": {"number": 1, "profile": {"kind": "ball", "diameter": 2.0 * RADIUS}}},
            "machine": {"name": machine},
            "accept": ACCEPTED,
            "operations": [{"kind": "zig-zag", "tool": "ball", "stepover": 3.0, "tolerance": TOLERANCE, **keys}],
        }
    )


def facts(plan: sc.Plan) -> dict[str, float]:
    return {fact.fact: fact.value for fact in plan.summary()[0].operations[0].facts}


def verified(asked: sc.Job) -> tuple[sc.Plan, str]:
    plan = sc.plan(asked)
    posted = sc.post(plan)
    report = sc.verify(posted, asked)
    assert report.ok and report.gouge_max <= 0.001 and report.excess_max <= TOLERANCE, report.findings
    assert not kinds(report, asked)
    return plan, posted.text


def kinds(report: Any, asked: sc.Job) -> set[str]:
    """What is found, but for what the job accepts."""
    return {finding.kind for finding in report.findings} - set(asked.to_dict()["accept"])


def found(text: str, asked: sc.Job) -> dict[str, Any]:
    """The worst finding of each kind that is an error."""
    errors = [finding for finding in sc.verify(text, asked).findings if finding.severity == "error"]
    return {finding.kind: finding for finding in sorted(errors, key=lambda finding: finding.value or 0.0)}


def pushes(program: sc.Program, angle_deg: float, spacing: float = 1.0) -> np.ndarray:
    """How far each row presses the sheet down at most, mm, from the moves alone: the sheet as heights at nodes, the lowest of the
    ball's at every position before."""
    moves = program.moves
    ends, rapid = moves["end"], moves["kind"] == 0
    sin, cos = np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))
    along, across = ends[:, 0] * cos + ends[:, 1] * sin, ends[:, 1] * cos - ends[:, 0] * sin
    is_row = np.abs(np.diff(across, prepend=np.nan)) < 2e-3
    forward = np.sign(np.diff(along, prepend=np.nan))
    low = ends.min(axis=0)[:2] - RADIUS
    count = np.ceil((ends.max(axis=0)[:2] + RADIUS - low) / spacing).astype(int) + 1
    sheet = np.zeros(count)
    nodes = [low[axis] + spacing * np.arange(count[axis]) for axis in (0, 1)]
    deepest, pending, row = [], [], None

    def press() -> None:
        if not pending:
            return
        tips = np.concatenate(pending)
        pending.clear()
        box = [
            np.searchsorted(nodes[axis], [tips[:, axis].min() - RADIUS, tips[:, axis].max() + RADIUS])
            for axis in (0, 1)
        ]
        x, y = nodes[0][slice(*box[0])], nodes[1][slice(*box[1])]
        pressed = np.full((len(x), len(y)), np.inf)
        for tip in tips:
            near = [np.searchsorted(axis, [at - RADIUS, at + RADIUS]) for axis, at in ((x, tip[0]), (y, tip[1]))]
            square = (x[slice(*near[0]), None] - tip[0]) ** 2 + (y[None, slice(*near[1])] - tip[1]) ** 2
            height = np.where(
                square <= RADIUS**2, tip[2] + RADIUS - np.sqrt(np.maximum(RADIUS**2 - square, 0.0)), np.inf
            )
            part = pressed[slice(*near[0]), slice(*near[1])]
            np.minimum(part, height, out=part)
        before = sheet[slice(*box[0]), slice(*box[1])]
        deepest.append(np.maximum(before - pressed, 0.0).max())
        np.minimum(before, pressed, out=before)

    for index in range(1, len(ends)):
        now = (round(across[index], 2), forward[index]) if is_row[index] and not rapid[index] else None
        if now != row:
            press()
        row = now
        if not rapid[index]:
            start, end = ends[index - 1], ends[index]
            steps = max(int(np.ceil(np.linalg.norm(end - start) / 0.5)), 1)
            pending.append(start + np.linspace(0.0, 1.0, steps + 1)[1:, None] * (end - start))
    press()
    return np.array(deepest)


@pytest.mark.parametrize(
    ("part", "machine", "angle", "keys"),
    [
        ("cone_cup", "linuxcnc", 20.0, {"direction": "same", "links": "low", "lead": "vertical"}),
        ("pyramid", "grbl", 0.0, {"turns": "rounded", "fit": "arcs"}),
        ("matrix/two_cups", "linuxcnc", 90.0, {"turns": "looped", "turn_radius": 2.0}),
        ("pyramid", "heidenhain", 45.0, {"cross": True}),
    ],
)
def test_no_pass_presses_the_sheet_deeper(part: str, machine: str, angle: float, keys: Any) -> None:
    asked = job(part, machine, angle_deg=angle, **INCREMENT, **keys)
    plan, _ = verified(asked)
    depth = -plan.programs["main"].moves["end"][:, 2].min()
    assert facts(plan)["layers"] == np.ceil((depth - TOLERANCE) / INCREMENT["max_increment"])
    if "fit" not in keys:  # arcs are no chords
        deepest = pushes(plan.programs["main"], angle)
        # positions half a millimetre apart leave the sheet 0.5^2 / 8 R higher between them
        assert 0.9 * INCREMENT["max_increment"] < deepest.max() <= INCREMENT["max_increment"] + 0.01


def test_rows_at_once_punch_and_the_finding_names_the_key() -> None:
    asked = job("matrix/two_cups")
    finding = found(sc.post(sc.plan(asked)).text, asked)["punch"]
    assert finding.line and "max_increment" in finding.message


Line = tuple[str, "list[float]"]


@pytest.fixture(scope="module")
def pit() -> tuple[sc.Job, list[Line]]:
    """Rows along a pyramid's walls, 1 mm a layer: lines that each state all coordinates, with these."""
    asked = job("pyramid", max_increment=1.0)
    at, lines = [0.0, 0.0, 10.0], []
    for line in verified(asked)[1].splitlines():
        stated = {} if line.startswith("(") else dict(re.findall(r"([XYZ])(-?[\d.]+)", line))
        at = [float(stated.get(axis, known)) for axis, known in zip("XYZ", at, strict=True)]
        lines.append((spelled(line, at) if stated else line, at))
    return asked, lines


def spelled(line: str, at: list[float]) -> str:
    """A move with all its coordinates."""
    words = [word for word in line.split() if word[0] not in "XYZ"]
    return " ".join([*words, *(f"{axis}{value:.4f}" for axis, value in zip("XYZ", at, strict=True))])


def is_at(height: float, at: list[float]) -> bool:
    return abs(at[2] - height) < 5e-4


def checked(lines: list[str], asked: sc.Job) -> tuple[Any, dict[str, Any]]:
    """The finding of an increment, which has to be what the moves alone show, and all findings."""
    text = "\n".join(lines)
    findings = found(text, asked)
    finding = findings["increment"]
    measured = pushes(sc.read_gcode(text, "linuxcnc"), 0.0, spacing=0.6).max()
    assert finding.line and finding.limit == 1.0 and "max_increment is 1.000 mm" in finding.message
    # by cells of the sheet here and there
    assert finding.value == pytest.approx(measured, abs=0.15)
    return finding, findings


def test_a_layer_left_out_is_found(pit: tuple[sc.Job, list[Line]]) -> None:
    asked, lines = pit
    kept = [line for line, at in lines if not -3.0005 < at[2] < -2.0005]
    assert len(kept) < len(lines) - 100
    finding, _ = checked(kept, asked)
    assert finding.value > 1.9 and finding.position[2] < -3.0


def test_a_layer_too_deep_is_found(pit: tuple[sc.Job, list[Line]]) -> None:
    asked, lines = pit
    deeper = [spelled(line, [*at[:2], -3.25]) if is_at(-3.0, at) else line for line, at in lines]
    finding, findings = checked(deeper, asked)
    assert finding.value == pytest.approx(1.25, abs=0.01)
    # off its plane a row owes the part its contact
    assert "excess" in findings


def test_a_row_left_out_of_a_layer_is_found(pit: tuple[sc.Job, list[Line]]) -> None:
    """The next layer then presses the sheet farther there."""
    asked, lines = pit
    rows = sorted(at[1] for _, at in lines if is_at(-5.0, at))
    row = rows[len(rows) // 2]
    kept = [line for line, at in lines if abs(at[2] + 5.0) > 0.9995 or abs(at[1] - row) > 2e-3]
    assert 0 < len(lines) - len(kept) < 40
    finding, _ = checked(kept, asked)
    assert finding.value > 1.3 and finding.position[1] == pytest.approx(row, abs=2e-3)


def test_a_row_in_a_plane_is_no_row_on_the_floor(pit: tuple[sc.Job, list[Line]]) -> None:
    """In the plane of a layer a move owes the part no contact: what it leaves on the part is found as a pass that is missing."""
    asked, lines = pit
    assert min(at[2] for _, at in lines) < -19.5
    raised = [spelled(line, [*at[:2], -19.0]) if at[2] < -19.0005 else line for line, at in lines]
    finding = found("\n".join(raised), asked)["missing-pass"]
    assert finding.line and finding.value > 0.9


@pytest.mark.parametrize(
    ("part", "process", "keys", "words"),
    [
        ("pyramid", {"kind": "dsif", "support_tool": "below"}, {}, "contacts"),
        ("cap_r60", {"kind": "tpif", "die": "male"}, {}, "frame"),
        ("pyramid", None, {"tolerance": 0.5}, "tolerance"),
    ],
)
def test_where_layers_do_not_fit_the_job_is_refused(part: str, process: Any, keys: Any, words: str) -> None:
    document = job(part).to_dict()
    document["process"] = process or document["process"]
    document["tools"]["below"] = {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}}
    document["operations"][0].update(INCREMENT | keys)
    document["machines"] = {"support": {"name": "linuxcnc"}} if process and process["kind"] == "dsif" else {}
    with pytest.raises(sc.JobError, match=words) as refused:
        sc.Job.from_dict(document)
    assert refused.value.where == "operations[0].max_increment"


def test_rows_too_far_apart_for_their_layers_are_refused() -> None:
    with pytest.raises(sc.JobError, match="higher between such rows") as refused:
        sc.plan(job("pyramid", stepover=6.0, max_increment=0.5))
    # the ball's chord half a millimetre above its tip is 2 sqrt(0.5 (10 - 0.5)) mm long
    assert "4.358" in refused.value.hint
    sc.plan(job("pyramid", stepover=4.358, max_increment=0.5))
