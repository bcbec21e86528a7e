"""Sound programs pass: no false alarm, and the oracle agrees that they are sound."""

from __future__ import annotations

from pathlib import Path

import pytest

import matters
import styluscam as sc
from controllers import Family
from gcode import read

from .cases import Case, arc_case, made_case

SLICE = 12
ARCS = 4
OF_EACH = 4
OF_THE_TOOL = "tool-radius"
"""A warning of the job's tool, which some of the cases choose sharper than their sheet likes; no program is the reason."""
ADDED: tuple[Family, ...] = ("fanuc", "okuma", "marlin", "siemens", "heidenhain")


def require_sound(case: Case) -> None:
    report = sc.verify(case.text, case.job)
    found = [finding for finding in report.findings if "(accepted by the job)" not in finding["message"]]
    found = [finding["message"] for finding in found if finding["kind"] != OF_THE_TOOL]
    assert report.ok and not found, found
    program = read(case.text, case.family)
    assert program.refused is None
    verdict = matters.Verdict()
    matters.weigh_moves(program.moves, case.wanted, verdict)
    assert not verdict.matters, verdict.reasons


@pytest.mark.parametrize("number", range(SLICE))
def test_a_sound_program_passes(number: int, folder: Path) -> None:
    require_sound(made_case(number, folder))


@pytest.mark.parametrize("number", range(OF_EACH))
@pytest.mark.parametrize("family", ADDED)
def test_a_sound_program_of_each_family_passes(family: Family, number: int, folder: Path) -> None:
    require_sound(made_case(number, folder, family))


@pytest.mark.parametrize("family", ADDED)
def test_a_sound_program_with_arcs_of_each_family_passes(family: Family, folder: Path) -> None:
    require_sound(arc_case(1, folder, family))


@pytest.mark.parametrize("number", range(ARCS))
def test_a_sound_program_with_arcs_passes(number: int, folder: Path) -> None:
    require_sound(arc_case(number, folder))


@pytest.mark.long
@pytest.mark.parametrize("number", range(SLICE, 200))
def test_two_hundred_sound_programs_pass(number: int, folder: Path) -> None:
    require_sound(made_case(number, folder))
