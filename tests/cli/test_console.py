"""What all commands have in common: help, start-up, a clean stdout, exit codes."""

from __future__ import annotations

import ctypes
import json
import os
import subprocess
import sys

import pytest

import styluscam as sc

from .conftest import CHECKOUT, FIXTURES

ENVIRONMENT = os.environ | {"PYTHONPATH": str(CHECKOUT / "python"), "PYTHONUNBUFFERED": ""}


def python(*arguments):
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, env=ENVIRONMENT, check=False)


def test_importing_styluscam_loads_nothing_but_numpy():
    heavy = ("typer", "click", "rich", "OCP", "matplotlib", "jinja2", "trimesh", "networkx", "lxml")
    ran = python("-c", f"import sys, styluscam; print([name for name in {heavy} if name in sys.modules])")
    assert ran.stdout == "[]\n", ran.stderr


def test_help_loads_no_extra():
    heavy = ("OCP", "matplotlib", "jinja2", "trimesh", "rich")
    code = "import sys; from styluscam.cli import invoke; invoke(['--help']);"
    assert python("-c", f"{code} print([name for name in {heavy} if name in sys.modules])").stdout.endswith("[]\n")


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"]])
def test_without_a_command_there_is_help(cli, arguments):
    ran = cli(*arguments)
    assert ran.code == 0 and ran.err == ""
    for command in ("run", "plan", "new", "verify", "part", "machine", "schema", "doctor"):
        assert f"\n  {command} " in ran.out
    assert "Exit codes" in ran.out and "...\n" not in ran.out.partition("\n")[2]


@pytest.mark.parametrize("command", ["run", "plan", "new", "verify", "schema", "doctor", "part show", "machine list"])
def test_every_command_has_help_and_json(cli, command):
    ran = cli(*command.split(), "--help")
    assert ran.code == 0 and "--json" in ran.out and f"Usage: styluscam {command}" in ran.out


@pytest.mark.parametrize("group", ["part", "machine"])
def test_a_group_alone_shows_its_commands(cli, group):
    ran = cli(group)
    assert ran.code == 0 and "show" in ran.out


def test_python_m_and_the_entry_point_are_the_same():
    ran = python("-m", "styluscam", "--version")
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, f"styluscam {sc.__version__}\n", "")
    ran = python(
        "-c", "import sys; sys.argv = ['styluscam', 'run', 'none.toml']; from styluscam.cli import main; main()"
    )
    assert ran.returncode == 2 and ran.stdout == "" and ran.stderr.count("\n") == 1


def test_stdout_is_one_json_document_whatever_the_kernel_prints(cli, monkeypatch):
    from styluscam.cli import part

    read = part.read_part

    def chattering(*arguments):
        ctypes.CDLL(None).puts(b"** statistics on transfer **")
        os.write(1, b"** written at once **")
        return read(*arguments)

    monkeypatch.setattr(part, "read_part", chattering)
    ran = cli("part", "show", FIXTURES / "cone_cup.step", "--json")
    assert ran.code == 0 and ran.err == ""
    assert len(json.loads(ran.out)["faces"]) == 10
    assert "**" not in cli("part", "show", FIXTURES / "cone_cup.step").out


def test_what_c_code_still_holds_does_not_come_out_later():
    code = """
import ctypes
from styluscam.cli import invoke, schema
def chattering():
    ctypes.CDLL(None).puts(b"** still in the buffer **")
    return {"a": 1}
schema.job_schema = chattering
invoke(["schema"])
print("after")
"""
    assert python("-c", code).stdout == '{\n  "a": 1\n}\nafter\n'


def test_a_message_of_many_lines_becomes_one(cli, monkeypatch):
    from styluscam.cli import part

    def failing(*arguments):
        raise sc.GeometryError("first\n  second", code="lines", where="part.step", hint="do\nthis")

    monkeypatch.setattr(part, "read_part", failing)
    assert cli("part", "show", "part.step").err == "error: part.step: first second; do this\n"


def test_stdout_is_given_back(cli):
    assert cli("--version").out == cli("--version").out == f"styluscam {sc.__version__}\n"


def test_a_reader_that_goes_away_is_no_fault():
    command = f"{sys.executable} -m styluscam schema | head -c 10; exit ${{PIPESTATUS[0]}}"
    ran = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=ENVIRONMENT, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (KeyboardInterrupt(), 130),
        (sc.Cancelled("cancelled", code="cancelled"), 3),
        (sc.PlanError("no path", code="empty", where="operations[0]", hint="more"), 2),
        (sc.VerifyError("the header changed the moves", code="internal"), 4),
        (RuntimeError("broken"), 4),
        (MemoryError(), 2),
    ],
)
def test_exit_codes(cli, monkeypatch, error, code):
    from styluscam.cli import part

    def failing(*arguments):
        raise error

    monkeypatch.setattr(part, "read_part", failing)
    ran = cli("part", "show", "part.step")
    assert ran.code == code and ran.out == ""
    assert ran.err.count("\n") == 1 and "Traceback" not in ran.err
    assert "Traceback" in cli("part", "show", "part.step", "--debug").err
    as_json = cli("part", "show", "part.step", "--json")
    assert as_json.code == code and list(as_json.json) == ["error"] and as_json.err == ""


def test_schema(cli):
    schema = cli("schema").json
    assert schema == sc.job_schema() == cli("schema", "--json").json
    assert {"part", "tools", "operations", "machine"} <= set(schema["properties"])


def test_machines(cli):
    listed = cli("machine", "list")
    assert listed.code == 0
    for name in sc.Machine.names():
        assert any(line.startswith(f"{name} ") for line in listed.out.splitlines())
        assert sc.Machine.shipped(name).description in cli("machine", "show", name).out
        assert cli("machine", "show", name, "--json").json["name"] == name
    assert [machine["name"] for machine in cli("machine", "list", "--json").json] == sc.Machine.names()


def test_machine_show_reads_a_file(cli):
    shown = cli("machine", "show", CHECKOUT / "rust/post/machines/grbl.toml", "--json")
    assert shown.code == 0 and shown.json == cli("machine", "show", "grbl", "--json").json


def test_doctor(cli):
    ran = cli("doctor")
    assert ran.code == 0 and sc.__version__ in ran.out and "works" in ran.out
    document = cli("doctor", "--json").json
    assert document["engine_ok"] is True and set(document["extras"]) == {"step", "mesh", "plot", "report"}
    assert document["packages"]["numpy"]


def test_doctor_names_what_is_missing(cli, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    ran = cli("doctor")
    assert ran.code == 0 and "not there: matplotlib; pip install 'styluscam[plot]'" in ran.out


def test_doctor_notices_a_broken_engine(cli, monkeypatch):
    from styluscam.cli import doctor

    monkeypatch.setattr(doctor, "drop_cutter", lambda *arguments: [1.5])
    assert cli("doctor").code == 4
