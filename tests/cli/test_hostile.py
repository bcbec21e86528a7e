"""Odd folders, odd values, odd ends of pipes: one line, the right exit code, never a traceback."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from styluscam.cli.app import app

from .conftest import CHECKOUT
from .test_trust import JOB, PLATE


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder with a plate and a job for it, as the current one."""
    trimesh = pytest.importorskip("trimesh")
    trimesh.Trimesh(*PLATE, process=False).export(tmp_path / "plate.stl")
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def styluscam(words: str, **streams: Any) -> subprocess.CompletedProcess[str]:
    """A command line in a shell, with pipes and redirections."""
    environment = os.environ | {"PYTHONPATH": str(CHECKOUT / "python"), "S": f"{sys.executable} -m styluscam"}
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", words],
        capture_output=True,
        text=True,
        env=environment,
        timeout=60,
        check=False,
    )


def commands(group: Any = None, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every command with the words that call it."""
    group = typer.main.get_command(app) if group is None else group
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, (*path, name))
        else:
            yield (*path, name), command


@pytest.mark.parametrize(
    ("words", "command"), list(commands()), ids=lambda value: " ".join(value) if isinstance(value, tuple) else ""
)
def test_every_command_gives_json_errors_included(words, command, cli):
    options = {option for parameter in command.params for option in parameter.opts}
    assert "--json" in options and "--debug" in options
    ran = cli(*words, "--json", "--no-such-option")
    assert ran.code == 2 and ran.err == ""
    assert ran.json["error"]["code"] == "usage"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux alone")
@pytest.mark.parametrize("words", ["$S machine list", "$S machine list --json", "$S schema", "$S --help"])
def test_a_full_disk_behind_stdout_is_stated_in_a_line(words):
    ran = styluscam(f"{words} >/dev/full")
    assert ran.returncode == 2, ran.stderr
    assert ran.stderr.endswith("cannot be written: No space left on device; redirect it elsewhere\n")
    assert ran.stderr.count("\n") == 1


def test_without_stdout_or_its_reader_the_work_goes_on(desk):
    assert styluscam("$S run job.toml >&-").returncode == 0
    assert (desk / "plate.ngc").is_file()
    assert styluscam("$S machine list >&- 2>&-").returncode == 0
    ran = styluscam("$S schema | head -c 10")
    assert ran.stderr == "" and ran.returncode == 0


def test_a_job_comes_through_a_pipe(desk):
    assert styluscam("cat job.toml | $S run /dev/stdin --quiet").returncode == 0
    assert (desk / "plate.ngc").is_file()


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="Linux alone")
def test_devices_without_an_end_are_refused(desk, cli):
    for words in (
        ["run", "/dev/zero"],
        ["verify", "/dev/zero", "--job", "job.toml"],
        ["machine", "show", "/dev/zero.toml"],
    ):
        ran = cli(*words)
        assert ran.code == 2 and ran.err.count("\n") == 1
    assert "it is a device, not a file" in cli("run", "/dev/zero").err


@pytest.mark.parametrize(
    "folder", ["a b", "ünï-çødé 漢字", "with'quote", 'with"double', "$HOME", "-dash", "new\nline", "a.b.c"]
)
def test_odd_folders_work(desk, cli, folder):
    target = desk / folder
    target.mkdir()
    (target / "job.toml").write_text(JOB, encoding="utf-8")
    (target / "plate.stl").write_bytes((desk / "plate.stl").read_bytes())
    ran = cli("run", target / "job.toml", "--json")
    assert ran.code == 0, ran.json
    assert (target / "plate.ngc").is_file()
    verified = cli("verify", target / "plate.ngc", "--job", target / "job.toml", "--json")
    assert verified.code == 0 and verified.json["file"] == str(target / "plate.ngc")


ODD = {
    "air that is no number": (["post", "plate.program.json", "-m", "grbl", "-o", "x.nc", "--air", "nan"], "--air nan"),
    "air beyond the world": (
        ["post", "plate.program.json", "-m", "grbl", "-o", "x.nc", "--air", "1e300"],
        "--air 1e+300",
    ),
    "no machine of that name": (
        ["view", "plate.ngc", "--machine", "nope"],
        'error: machine.name: there is no machine "nope"',
    ),
    "a folder for a program": (["verify", ".", "--job", "job.toml"], "error: .: cannot be read: Is a directory"),
    "a folder for a job": (["run", "."], "error: .: cannot be read: Is a directory"),
    "no job at all": (["run", ""], "error: .: cannot be read"),
    "no tool at all": (["tool", "show", ""], "tool"),
}


@pytest.mark.parametrize("odd", ODD)
def test_odd_values_are_one_line(desk, cli, odd):
    assert cli("run", "job.toml", "--quiet").code == 0
    words, stated = ODD[odd]
    ran = cli(*words)
    assert ran.code == 2 and stated in ran.err and ran.err.count("\n") == 1, ran.err
    assert json.loads(cli(*words, "--json").out)["error"]["message"]
    assert not Path("x.nc").exists()


def test_what_a_machine_check_keeps_is_in_its_json(desk, cli):
    ran = cli("machine", "check", "grbl", "--keep", "texts", "--json")
    assert ran.code == 0 and len(ran.json["written"]) > 10
    assert all(Path(path).is_file() for path in ran.json["written"])
    ran = cli("machine", "new", "mine", "--from", "grbl", "--json")
    assert ran.json == {"written": ["mine.toml"]}
    assert cli("machine", "new", "more", "--from", "grbl", "--quiet").out == ""
