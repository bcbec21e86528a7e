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
from styluscam.machine import differences, starter

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
def test_what_is_not_confirmed_is_said_in_the_header(name: str) -> None:
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
    assert machine.evidence == "unverified", "what was read for haas says nothing about this one"


def test_pages_and_golden_programs_are_those_of_the_files() -> None:
    pages = Path(__file__).parents[2] / "docs" / "machine_pages.py"
    done = subprocess.run([sys.executable, pages, "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.world
@pytest.mark.parametrize(("name", "text"), trials("linuxcnc"), ids=lambda value: value[:40].split("\n")[0])
def test_linuxcnc_moves_as_its_trials_say(name: str, text: str) -> None:
    if name == "feeds per revolution":
        pytest.skip("rs274 has no spindle to turn with")
    try:
        found = rs274.interpret(text)
    except roots.Unavailable as reason:
        pytest.skip(f"NOT TESTED with LinuxCNC: {reason}")
    assert found.ok, found.error
    calls = [call for call in found.calls if call.kind in MOVES]
    scale = 25.4 if any(call.unit == "inch" for call in calls) else 1.0
    theirs = scale * np.array([(call.x, call.y, call.z) for call in calls])
    program = sc.read_gcode(text, sc.Machine.shipped("linuxcnc"))
    ours = program.moves["end"]
    if name == "another work offset on the way" or name.startswith("holes: left") or "G38" in text:
        return  # other zero points, cycles that it does not show, a place that nobody knows
    distinct = [rows[np.r_[True, np.abs(np.diff(rows, axis=0)).max(axis=1) > 1e-9]] for rows in (ours, theirs)]
    if name.startswith("holes"):
        assert np.abs(distinct[0].min(axis=0) - distinct[1].min(axis=0)).max() < 1e-6
        return
    # the first move is to a place that our reader knows in full and LinuxCNC axis by axis
    assert np.abs(distinct[0][-20:] - distinct[1][-20:]).max() < 1e-6, name
    assert abs(len(distinct[0]) - len(distinct[1])) <= 1


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
