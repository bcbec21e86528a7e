"""Machines: their files, their trials, and what LinuxCNC's and other people's readers make of posted text."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import roots
import rs274
import styluscam as sc
from styluscam.programs.machine import differences, starter
from styluscam.types import FloatArray

MOVES = {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"}


def trials(machine: str) -> list[tuple[str, str]]:
    """Names and texts of what the torture program is made of, as far as the machine has it."""
    return [(trial.name, trial.text) for trial in sc.Machine.shipped(machine).check() if trial.text]


@pytest.mark.parametrize("name", sc.Machine.names())
def test_every_shipped_machine_passes_its_trial(name: str) -> None:
    machine = sc.Machine.shipped(name)
    failed = [trial for trial in machine.check() if trial.outcome == "failed"]
    assert not failed, failed[0]
    source = machine.document["source"]
    assert source["read"], "what was read must be named"
    if machine.evidence == "read":
        assert not source["unconfirmed"]
    else:
        assert source["unconfirmed"], "what is not confirmed must be named"


@pytest.mark.parametrize("name", sc.Machine.names())
def test_what_is_not_confirmed_is_stated_in_the_header(name: str) -> None:
    machine = sc.Machine.shipped(name)
    text = dict(trials(name))["rapids and lines"].lower()
    assert ("unverified" in text) == (machine.evidence == "unverified")
    assert ("not confirmed" in text) == (machine.evidence != "read")


@pytest.mark.parametrize("name", sc.Machine.names())
def test_a_machine_written_out_is_the_same_machine(name: str, tmp_path: Path) -> None:
    machine = sc.Machine.shipped(name)
    file = tmp_path / "whole.toml"
    file.write_text(machine.to_toml(), encoding="utf-8")
    assert sc.Machine.read(file).document == machine.document


@pytest.mark.parametrize("name", sc.Machine.names())
def test_a_new_file_differs_in_name_and_source_only(name: str, tmp_path: Path) -> None:
    machine = sc.Machine.shipped(name)
    file = tmp_path / "ours.toml"
    file.write_text(starter("ours", machine, name), encoding="utf-8")
    keys = {key for key, _, _ in differences(machine.document, sc.Machine.read(file).document)}
    assert {key.partition(".")[0] for key in keys} <= {"name", "description", "source"}


def test_files_extend_files_beside_them(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text('schema = 1\nextends = "haas"\nname = "base"\n[line]\nmax_chars = 60\n')
    (tmp_path / "ours.toml").write_text('schema = 1\nextends = "base.toml"\nname = "ours"\n[coolant]\nflood = "M80"\n')
    machine = sc.Machine.read(tmp_path / "ours.toml")
    assert (machine.document["line"]["max_chars"], machine.document["coolant"]["flood"]) == (60, "M80")
    assert machine.evidence == "unverified", "what was read for haas is no evidence about this one"


def test_pages_and_golden_programs_are_those_of_the_files() -> None:
    pages = Path(__file__).parents[2] / "docs" / "machine_pages.py"
    done = subprocess.run([sys.executable, pages, "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


SPEAK_ALIKE = [name for name in sc.Machine.names() if name not in ("okuma", "siemens", "heidenhain")]
"""Machines whose programs LinuxCNC's interpreter understands, but for what `common` takes out."""

OTHERS_ONLY = re.compile(r"^(O\d+|G91 G28 .*|(G90 )?G53 .*|M226)$", re.MULTILINE)
"""Lines that mean nothing to it, or go to a position that is not the program's: program numbers, returns, RepRap's stop."""


def common(text: str, machine: str) -> str:
    """A machine's text without what only that machine understands."""
    code = OTHERS_ONLY.sub("", text)
    code = re.sub(r"^(.*G86 [^P\n]*)$", r"\1 P0", code, flags=re.MULTILINE)  # LinuxCNC asks for it
    if sc.Machine.shipped(machine).document["dwell"]["word"] != "P":
        code = re.sub(r"^G4 \S+$", "", code, flags=re.MULTILINE)
    return code if re.search(r"^(M2|M30)$", code, re.MULTILINE) else f"{code}M2\n"


def distinct(positions: FloatArray) -> FloatArray:
    """Positions without those that repeat the one before."""
    return positions[np.r_[True, np.abs(np.diff(positions, axis=0)).max(axis=1) > 1e-9]]


EVERY_TIME = ("linuxcnc", "fanuc", "marlin")


@pytest.mark.world
@pytest.mark.parametrize(
    "machine", [pytest.param(name, marks=[] if name in EVERY_TIME else pytest.mark.long) for name in SPEAK_ALIKE]
)
def test_linuxcnc_moves_as_the_trials_say(machine: str) -> None:
    """A second reader, other people's: its moves are those of ours, to the last digit."""
    compared = 0
    for name, text in trials(machine):
        # other zero points and positions that nobody knows; a spindle that does not turn there
        if name.startswith(
            ("another", "work offset", "probing", "feeds per revolution", "waiting", "leaning", "a leaning")
        ):
            continue
        code = common(text, machine)
        try:
            found = rs274.interpret(code)
        except roots.Unavailable as reason:
            pytest.skip(f"NOT TESTED with LinuxCNC: {reason}")
        assert found.ok, (name, found.error)
        calls = [call for call in found.calls if call.kind in MOVES]
        scale = 25.4 if any(call.unit == "inch" for call in calls) else 1.0
        theirs = distinct(scale * np.array([(call.x, call.y, call.z) for call in calls]))
        ours = distinct(sc.read_gcode(text, sc.Machine.shipped(machine)).moves["end"])
        if name.startswith("holes"):  # each shows cycles in its own way
            assert np.abs(ours.min(axis=0) - theirs.min(axis=0)).max() < 1e-6, name
        else:
            # the first moves are to positions that LinuxCNC learns axis by axis
            count = min(len(ours), len(theirs)) - 2
            assert np.abs(ours[-count:] - theirs[-count:]).max() < 1e-4, name
            assert abs(len(ours) - len(theirs)) <= 2, name
        compared += 1
    assert compared > 15


def test_grbl_gets_nothing_that_its_source_refuses() -> None:
    """gnea/grbl gcode.c: words, groups, 79 characters without spaces and remarks, arcs by .5 mm and .005 mm and 0.1 %."""
    allowed_g = {"0", "1", "2", "3", "4", "17", "18", "19", "20", "21", "40", "49", "53", "54", "55", "56", "57", "58", "59",
                 "61", "80", "90", "91", "91.1", "93", "94"}  # fmt: skip
    allowed_m = {"0", "1", "2", "3", "4", "5", "8", "9", "30"}
    for name, text in trials("grbl"):
        for line in text.splitlines():
            assert not set("?!~$%") & set(line), (name, line)
            code = re.sub(r"\([^)]*\)|;.*|\s", "", line)
            assert len(code) <= 79, (name, line)
            words = re.findall(r"([A-Z])(-?[\d.]+)", code)
            assert "".join(letter + number for letter, number in words) == code, (name, line)
            assert {letter for letter, _ in words} <= set("GMXYZIJKFSTP"), (name, line)
            assert all(number in allowed_g for letter, number in words if letter == "G"), (name, line)
            assert all(number in allowed_m for letter, number in words if letter == "M"), (name, line)
            letters = [letter for letter, _ in words if letter not in "GM"]
            assert len(letters) == len(set(letters)), (name, line)
            if "P" in letters:
                assert "G4" in code, "GRBL's arcs take no turns"
