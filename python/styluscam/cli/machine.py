"""``styluscam machine list``, ``show``, ``new``, ``check`` and ``diff``: controllers and their files."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Annotated

import typer

from styluscam import files
from styluscam.cli import console
from styluscam.cli.options import Debug, Force, Json, Quiet
from styluscam.cli.summary import shown_path
from styluscam.errors import MachineError
from styluscam.programs.machine import Machine, Trial, differences, starter
from styluscam.types import Document

app = typer.Typer(help="Describe machines, write machine files and check them.", rich_markup_mode=None)

MACHINE_HELP = "A shipped machine, or a machine file."
Name = Annotated[str, typer.Argument(metavar="NAME|FILE", help=MACHINE_HELP, show_default=False)]
Other = Annotated[str, typer.Argument(metavar="NAME|FILE", help=MACHINE_HELP, show_default=False)]
NewFile = Annotated[str, typer.Argument(metavar="NAME", help="The new machine; NAME.toml is written.")]
From = Annotated[
    str, typer.Option("--from", metavar="NAME|FILE", help="The machine to begin with.", show_default=False)
]
Toml = Annotated[bool, typer.Option("--toml", help="Print all of it as a machine file.")]

Keep = Annotated[
    Path | None,
    typer.Option("--keep", metavar="DIR", help="Write the posted texts into this folder.", show_default=False),
]

EVIDENCE = {"read": "all read at the source", "partly": "not all confirmed", "unverified": "UNVERIFIED"}
"""How a machine's evidence is shown in a list: `show` prints where it was read."""


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("list")
def list_(json: Json = False, debug: Debug = False) -> int:
    """List the shipped machines, and how well their facts are known."""
    machines = [Machine.shipped(name) for name in Machine.names()]
    if json:
        console.say_json([_document(machine) for machine in machines])
    else:
        rows = [[machine.name, machine.description, EVIDENCE[machine.evidence]] for machine in machines]
        console.table({"machine": "left", "what": "left", "evidence": "left"}, rows)
    return 0


@app.command("show")
def show(name: Name, toml: Toml = False, json: Json = False, debug: Debug = False) -> int:
    """Describe a machine and where its facts come from."""
    machine = Machine.find(name)
    if json:
        console.say_json(machine.document)
    elif toml:
        console.say(machine.to_toml().rstrip("\n"))
    else:
        _show(machine)
    return 0


def _show(machine: Machine) -> None:
    document = machine.document
    source = document["source"]
    console.fields(
        [
            ("name", machine.name),
            ("what", machine.description),
            ("family", document["family"]),
            ("last digit", f"{machine.resolution_mm:g} mm"),
            ("work offsets", ", ".join(document["wcs"][:9]) + (", ..." if len(document["wcs"]) > 9 else "")),
            ("tool change", document["tool"]["change"]),
            ("longest line", f"{document['line']['max_chars']} characters"),
            ("evidence", machine.evidence),
        ]
    )
    for title in ("read", "unconfirmed", "notes"):
        for number, line in enumerate(source[title]):
            console.say(f"{title if not number else '':<13} {line}")


@app.command("new")
def new(
    name: NewFile,
    base: From,
    *,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Write a machine file that begins as another machine."""
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*(\.toml)?", Path(name).name):
        raise MachineError(
            f"{name!r} is no name for a machine",
            code="machine-name",
            where="NAME",
            hint="take letters, digits, - and _",
        )
    path = Path(name) if name.endswith(".toml") else Path(f"{name}.toml")
    machine = Machine.find(base)
    files.require_new(path, force, MachineError, "choose another name")
    extends = base if base in Machine.names() else _beside(Path(base), path)
    files.require_writable([path])
    files.write_whole(path, starter(path.stem, machine, extends))
    if json:
        console.say_json({"written": [str(path)]})
    elif not quiet:
        console.say(f"written: {shown_path(path)}")
        console.say(f"next:    fill in its limits, then styluscam machine check {shlex.quote(shown_path(path))}")
    return 0


def _beside(base: Path, path: Path) -> str:
    """A file as another one in its folder names it."""
    if base.resolve().parent != path.resolve().parent:
        raise MachineError(
            f"{base} is in another folder than {path}",
            code="machine-extends",
            where="--from",
            hint="put both files into one folder, or begin with a shipped machine",
        )
    return base.name


@app.command("check")
def check(name: Name, keep: Keep = None, json: Json = False, debug: Debug = False) -> int:
    """Post a torture program by a machine file, read it back and compare. Exit code 1 when something failed."""
    machine = Machine.find(name)
    trials = machine.check()
    written = [] if keep is None else _keep(trials, keep)
    failed = [trial for trial in trials if trial.outcome == "failed"]
    if json:
        names = [str(path) for path in written]
        document = {"name": machine.name, "ok": not failed, "trials": [_tried(trial) for trial in trials]}
        console.say_json({**document, "written": names})
    else:
        if keep is not None:
            console.say(f"written: {len(written)} texts in {shown_path(keep)}")
        console.table({"tried": "left", "outcome": "left", "": "left"}, [_row(trial) for trial in trials])
        _tell_failures(failed)
        passed = sum(trial.outcome == "passed" for trial in trials)
        console.say(
            f"{machine.name}: {passed} passed, {len(failed)} failed, {len(trials) - passed - len(failed)} without"
        )
    return 1 if failed else 0


def _keep(trials: list[Trial], folder: Path) -> list[Path]:
    """Writes the posted texts, a file for each trial that has one; the files."""
    texts = {
        folder / f"{re.sub(r'[^a-z0-9]+', '-', trial.name.lower())}.txt": trial.text for trial in trials if trial.text
    }
    files.require_writable(texts)
    for path, text in texts.items():
        files.write_whole(path, text)
    return list(texts)


def _tell_failures(failed: list[Trial]) -> None:
    """Every failure with its line; equal ones once."""
    alike: dict[tuple[str, str], list[Trial]] = {}
    for trial in failed:
        alike.setdefault((trial.message, trial.line), []).append(trial)
    for trials in alike.values():
        first, more = trials[0], len(trials) - 1
        console.say()
        console.say(f"{first.name}{f' and {more} more' if more else ''}: {first.message}")
        if first.line:
            console.say(f"  {first.where}: {first.line}")
        console.say(f"  {first.hint}")
    console.say()


def _tried(trial: Trial) -> Document:
    return {key: value for key, value in vars(trial).items() if key != "text"}


def _row(trial: Trial) -> list[str]:
    shown = trial.message if len(trial.message) <= 60 else trial.message[:57] + "..."
    return [trial.name, trial.outcome.upper() if trial.outcome == "failed" else trial.outcome, shown]


@app.command("diff")
def diff(name: Name, other: Other, json: Json = False, debug: Debug = False) -> int:
    """List the differences between two machines."""
    rows = differences(Machine.find(name).document, Machine.find(other).document)
    if json:
        console.say_json([{"key": key, "first": here, "second": there} for key, here, there in rows])
    elif not rows:
        console.say("no difference")
    else:
        for key, here, there in rows:
            console.say(key)
            console.say(f"  - {_shown(here)}")
            console.say(f"  + {_shown(there)}")
    return 0


def _shown(value: object) -> str:
    if value is None:
        return "(nothing)"
    text = str(value).strip().replace("\n", "\n    ")
    return text or "(empty)"


def _document(machine: Machine) -> Document:
    return {
        "name": machine.name,
        "description": machine.description,
        "resolution_mm": machine.resolution_mm,
        "evidence": machine.evidence,
    }
