"""The first-light job inside FreeCAD makes the command line's loops."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from freecad_host import EXAMPLE
from program_loops import hausdorff, levels, runs, turns

import styluscam as sc

pytestmark = [pytest.mark.world, pytest.mark.freecad]

APART = 0.007
"""Two tessellators may put the same loop this far apart, mm."""


def read(text: str, machine: str) -> sc.Program:
    return sc.read_gcode(text, sc.Machine.shipped(machine))


def lifted(reference: sc.RunResult) -> np.ndarray:
    """The distance from the command line's zero (the sheet's top) to FreeCAD's (the model's origin)."""
    return np.array([0.0, 0.0, -reference.summary["part_max"][2]])  # the model's top is at Z 0 in the file


def test_it_ends_with_0_and_no_traceback(example: Any) -> None:
    assert example.done.returncode == 0, example.done.stderr[-3000:]
    assert "Traceback" not in example.done.stdout + example.done.stderr
    assert "50 levels" in example.done.stdout


def test_each_loop_is_the_command_lines(example: Any, reference: Any, record_property: Any) -> None:
    expected = reference()
    ours = levels(read(example.text, "linuxcnc"))
    theirs = [loop + lifted(expected) for loop in levels(read(expected.posted.text, "linuxcnc"))]
    assert len(ours) == len(theirs) == 50
    for a, b in zip(ours, theirs, strict=True):  # the order is that of the heights
        assert turns(a) * turns(b) > 0.0
    worst = max(hausdorff(a, b) for a, b in zip(ours, theirs, strict=True))
    record_property("hausdorff_mm", worst)
    print(f"worst Hausdorff distance of a loop: {1000.0 * worst:.3f} um")
    assert worst <= APART


def test_loops_alternate(example: Any) -> None:
    senses = [np.sign(turns(loop)) for loop in levels(read(example.text, "linuxcnc"))]
    assert all(a == -b for a, b in itertools.pairwise(senses))


def test_linuxcnc_reads_the_text(example: Any, linuxcnc: Any) -> None:
    ends = np.array([move.mm for move in linuxcnc(example.text).moves])
    positions = read(example.text, "linuxcnc").positions
    assert len(ends) == len(positions) > 1000
    assert np.abs(ends[1:] - positions[1:]).max() <= 5e-4  # the first goes up from an unknown position


def test_rows_for_grbl_are_the_command_lines(session: Any, reference: Any) -> None:
    text = session["zig-zag grbl"]["post"]["text"]
    expected = reference("grbl", kind="zig-zag", stepover=5.0)
    ours = runs(read(text, "grbl"))
    theirs = [run + lifted(expected) for run in runs(read(expected.posted.text, "grbl"))]
    assert len(ours) == len(theirs) > 0
    for plunge_and_a, plunge_and_b in zip(ours, theirs, strict=True):
        a, b = plunge_and_a[1:], plunge_and_b[1:]
        assert np.linalg.norm(a[0] - b[0]) < np.linalg.norm(a[0] - b[-1])
        assert hausdorff(a, b) <= APART


def test_a_missing_part_is_one_line_and_not_0(freecad: Any) -> None:
    done = freecad.run(EXAMPLE, "/nowhere/part.step", str(freecad.folder / "never.ngc"))
    assert done.returncode == 1
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("freecad_job: ")]
    assert "part.step" in line
    assert not (freecad.folder / "never.ngc").exists()
