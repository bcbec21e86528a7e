"""The oracle's readers of the families against examples of their manuals, and against one another."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import plain
import styluscam as sc
from controllers import CYCLE, FAMILIES, Family
from gcode import Move, read

from .cases import PARTS, PROFILES, document

GOLDEN = Path(__file__).resolve().parents[2] / "docs" / "machines"
HEADS: dict[Family, str] = {
    "fanuc": "%\nO0001 (A)\nG21 G90 G94 G17 G40 G49 G80\nG54\nT1 M6\n",
    "okuma": "OA\nG21 G90 G94 G17 G40 G80\nG15 H1\nT1 M6\n",
    "marlin": "G21\nG90\n",
    "siemens": "G710\nG90 G94 G17 G40\nG54\nT1\nM6\nD1\n",
    "heidenhain": "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n",
}
REFUSED: list[tuple[Family, str]] = [
    ("fanuc", "G0 X10"),
    ("fanuc", "G4 P0.5"),
    ("fanuc", "G15 H1"),
    ("fanuc", "%"),
    ("fanuc", "(open"),
    ("okuma", "G28 Z0."),
    ("okuma", "G54"),
    ("okuma", "G4 P500"),
    ("okuma", "G0 X10"),
    ("okuma", "G56 Z1."),
    ("marlin", "G28"),
    ("marlin", "M30"),
    ("siemens", "(remark)"),
    ("siemens", "G58"),
    ("siemens", "G21"),
    ("siemens", "G0 X"),
    ("siemens", "G4 F1 X1"),
    ("siemens", "CYCLE832(a,1,1)"),
    ("heidenhain", "2 X+1"),
    ("heidenhain", "2 (remark)"),
    ("heidenhain", "2 L X+1 R0"),
    ("heidenhain", "2 L X+1 RL FMAX"),
    ("heidenhain", "2 CYCL DEF 32.0 TOLERANCE\n3 M3"),
    ("heidenhain", "2 CYCL DEF 247 DATUM SETTING"),
    ("heidenhain", "2 END PGM B MM"),
]
RUNNING_ON = ["X10", "(G0 X10)", "/G0 X10", "M2", "M6 T1", "G43 H1", "g0 X10", "%"]
"""Lines that Marlin reports and does not run."""


@pytest.mark.parametrize(("family", "line"), REFUSED)
def test_what_a_controller_does_not_take(family: Family, line: str) -> None:
    head = HEADS[family]
    program = read(f"{head}{line}\n", family)
    assert program.refused is not None and program.refused[0] > len(head.splitlines())
    assert "no end" not in program.refused[1]


@pytest.mark.parametrize("line", RUNNING_ON)
def test_marlin_goes_on_behind_what_it_does_not_know(line: str) -> None:
    program = read(f"G21\nG90\n{line}\nG0 Y1 F100\n", "marlin")
    assert program.refused is None
    assert [move.line for move in program.moves] == [4]


def test_marlin_looks_at_the_first_command_alone() -> None:
    program = read("G21 G91\nM3 S100 M8\nG1 X1 F50 G0 X2\n", "marlin")
    state = program.at_end
    assert (state.distance, state.flood, state.rpm) == ("G90", False, 100.0)
    assert [(move.kind, move.end[0]) for move in program.moves] == [("feed", 2.0)]


def only_feed(text: str, family: Family) -> Move:
    program = read(text, family)
    (move,) = (move for move in program.moves if move.kind != "rapid")
    return move


def test_arcs_of_the_manuals() -> None:
    """TNC 320 p. 155: a whole circle about a centre; NC programming p. 194: I0 may be left out."""
    circle = "2 L X+45 Y+25 Z+0 R0 FMAX\n3 CC X+25 Y+25\n4 C X+45 Y+25 DR+ F200\n"
    turned = only_feed(HEADS["heidenhain"] + circle, "heidenhain")
    assert turned.sense == 1 and turned.centre[:2] == (25.0, 25.0)
    assert turned.length == pytest.approx(40 * math.pi)
    half = only_feed(HEADS["siemens"] + "G0 X10 Y0 Z0\nG2 X-10 Y0 I-10 F100\n", "siemens")
    assert half.sense == -1 and half.length == pytest.approx(10 * math.pi)


def test_machine_positions() -> None:
    """Z at the top is above everything; where the others are is not known."""
    texts: dict[Family, str] = {
        "linuxcnc": "G0 X1 Y1 Z1\nG53 G0 Z0\n",
        "fanuc": HEADS["fanuc"] + "G0 G43 H1 X1. Y1. Z1.\nG91 G28 Z0.\n",
        "siemens": HEADS["siemens"] + "G0 X1 Y1 Z1\nG0 SUPA Z0 D0\n",
        "heidenhain": HEADS["heidenhain"] + "2 L X+1 Y+1 Z+1 R0 FMAX\n3 L Z+0 R0 FMAX M91\n",
    }
    for family, text in texts.items():
        program = read(text, family)
        assert [move.end for move in program.moves] == [(1.0, 1.0, 1.0), (1.0, 1.0, math.inf)], family
        assert program.at_end.length_offset == (1 if family == "heidenhain" else 0)


def test_home_goes_through_a_work_position() -> None:
    moves = read(HEADS["fanuc"] + "G0 X1. Y1. Z5.\nG28 Z0.\n", "fanuc").moves
    assert [move.end[2] for move in moves] == [5.0, 0.0, math.inf]


def test_feeds_in_inches_are_tenths_in_klartext() -> None:
    text = HEADS["heidenhain"].replace("MM", "INCH") + "2 L X+0 Y+0 Z+1 R0 FMAX\n3 L X+1 R0 F100\n"
    assert only_feed(text, "heidenhain").state.feed == pytest.approx(254.0)


@pytest.mark.parametrize("family", HEADS)
def test_golden_programs_are_taken_up_to_their_holes(family: Family) -> None:
    program = read((GOLDEN / f"{family}.txt").read_text(encoding="utf-8"), family)
    assert program.refused is None or program.refused[1] == CYCLE
    assert any(move.kind == "arc" for move in program.moves)


def test_klartext_comes_back_from_plain_words() -> None:
    text = (GOLDEN / "heidenhain.txt").read_text(encoding="utf-8")
    assert plain.dressed(plain.undressed(text)) == text


def test_all_families_cut_the_same() -> None:
    cuts = [_cuts(family) for family in FAMILIES]
    assert cuts[0]
    assert all(cut == cuts[0] for cut in cuts)


def _cuts(family: Family) -> list[tuple[object, ...]]:
    made = document("z-level", PROFILES[0], {"name": family})
    job = sc.Job.from_dict(made, part=sc.Part.from_mesh(*PARTS["pit"]))
    program = read(sc.post(sc.plan(job)).text, family)
    return [(*move.key, move.state.feed) for move in program.moves if move.kind != "rapid"]
