"""Machines that sections of jobs name: errors name the key of the job."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from conftest import box, milling_document

import styluscam as sc
from styluscam.programs.machine import Machine

BALL = {"kind": "ball", "diameter": 6.0}
GRBL_S = (
    "header, units, smoothing_tolerance, decimals, block_numbers, comments, split_rapids, feed_mode, program_number"
)


@pytest.mark.parametrize("path", ("machine", "machines.finish"))
@pytest.mark.parametrize(
    ("section", "code", "key", "hint"),
    (
        ({"name": "grbll"}, "machine-unknown", ".name", "grblhal"),
        ({"name": "grbl", "options": {"foo": 1}}, "machine-unknown-option", ".options.foo", GRBL_S),
        ({"name": "grbl", "options": {"decimal": 1}}, "machine-unknown-option", ".options.decimal", '"decimals"'),
        ({"name": "grbl", "options": {"units": "mile"}}, "machine-option", ".options.units", "that the option takes"),
        ({"name": "grbl", "options": {"units": None}}, "argument", ".options.units", ""),
        ({"name": "grbl", "options": ["units"]}, "argument", ".options", ""),
        ({"file": 5}, "argument", ".file", ""),
        ({"name": "grbl", "file": "mine.toml"}, "argument", "", "remove one"),
        ({}, "argument", "", "add one"),
    ),
)
def test_what_is_wrong_in_a_section_is_named_by_its_path(
    section: dict[str, Any], code: str, key: str, hint: str, path: str, tmp_path: Path
) -> None:
    with pytest.raises(sc.MachineError) as caught:
        Machine.of_section(section, tmp_path, path)
    assert (caught.value.code, caught.value.where) == (code, f"{path}{key}")
    assert str(caught.value).startswith(f"{path}{key}: ") and hint in caught.value.hint


def test_what_is_wrong_in_a_file_is_named_by_the_file(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text('schema = 1\nextends = "grbll"\nname = "mine"\n', encoding="utf-8")
    with pytest.raises(sc.MachineError) as caught:
        Machine.of_section({"file": "mine.toml"}, tmp_path, "machines.finish")
    assert caught.value.code == "machine-unknown" and caught.value.where == f"{tmp_path / 'mine.toml'}: extends"


@pytest.mark.parametrize(
    ("section", "where"),
    (({"name": "grbll"}, "machine.name"), ({"name": "grbl", "options": {"foo": 1}}, "machine.options.foo")),
)
def test_a_job_names_its_key(section: dict[str, Any], where: str) -> None:
    document = milling_document("zig-zag", BALL, stepover=3.0, tolerance=0.01) | {"machine": section}
    with pytest.raises(sc.MachineError) as caught:
        sc.Job.from_dict(document, part=sc.Part.from_mesh(*box([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]))).machine()
    assert caught.value.where == where


def test_a_section_without_a_path_is_a_job_s_machine(tmp_path: Path) -> None:
    assert Machine.of_section({"name": "grbl"}, tmp_path).name == "grbl"
    with pytest.raises(sc.MachineError) as caught:
        Machine.of_section({"name": "grbl", "options": {"foo": 1}}, tmp_path)
    assert caught.value.where == "machine.options.foo"


def test_an_option_outside_a_job_is_named_alone() -> None:
    with pytest.raises(sc.MachineError) as caught:
        sc.Machine("grbl").with_options({"foo": 1})
    assert caught.value.where == "options.foo"
