"""Controllers: shipped or from a file."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from styluscam import _engine
from styluscam.errors import MachineError
from styluscam.files import read_text
from styluscam.types import Document


@dataclass(frozen=True)
class Trial:
    """One thing that was tried on a machine file: see :meth:`Machine.check`."""

    name: str
    outcome: str
    """"passed"; "without" where the file says that the machine does not have it; "failed"."""
    message: str
    code: str
    where: str
    line: str
    """The posted line at fault; empty where there is none."""
    hint: str
    text: str
    """What was posted; empty where nothing was."""


class Machine:
    """What a controller understands and how programs for it are written."""

    def __init__(self, engine: _engine.Machine) -> None:
        self.engine = engine

    @classmethod
    def shipped(cls, name: str) -> Machine:
        """A shipped machine: see :meth:`names`."""
        return cls(_engine.Machine.shipped(name))

    @classmethod
    def read(cls, path: str | Path) -> Machine:
        """From a machine file (TOML). Files that it extends are looked for beside it."""
        text = read_text(path, MachineError)
        try:
            return cls(_engine.Machine.from_toml(text, str(Path(path).parent)))
        except MachineError as error:
            place = f"{path}: {error.where}" if error.where else str(path)
            said = str(error).removeprefix(f"{error.where}: ")
            raise MachineError(f"{place}: {said}", code=error.code, where=place, hint=error.hint) from error

    @classmethod
    def find(cls, name: str) -> Machine:
        """A shipped machine by its name, or a machine file."""
        is_file = name.endswith(".toml") or (name not in cls.names() and Path(name).is_file())
        return cls.read(name) if is_file else cls.shipped(name)

    @classmethod
    def of_section(cls, section: Document, folder: Path) -> Machine:
        """The machine that a job's ``[machine]`` names; files are relative to ``folder``."""
        file = section.get("file")
        machine = cls.read(folder / file) if file else cls.shipped(str(section["name"]))
        options = section.get("options")
        return machine.with_options(options) if options else machine

    @staticmethod
    def names() -> list[str]:
        """Names of the shipped machines."""
        return _engine.shipped_machines()

    def with_options(self, options: Document) -> Machine:
        """The same machine with other values for its options: ``units``, ``decimals``, ``block_numbers``, ..."""
        return Machine(self.engine.with_options(json.dumps(options)))

    def check(self) -> list[Trial]:
        """Posts a torture program, reads it back and compares; one entry for everything that was tried."""
        return [Trial(*entry) for entry in self.engine.check()]

    def to_toml(self) -> str:
        """The whole of it as a machine file that extends nothing."""
        return self.engine.to_toml()

    @cached_property
    def document(self) -> Document:
        """Everything that the file says."""
        document: dict[str, Any] = json.loads(self.engine.to_json())
        return document

    @property
    def name(self) -> str:
        """Its name."""
        return self.engine.name

    @property
    def description(self) -> str:
        """What it is."""
        return self.engine.description

    @property
    def evidence(self) -> str:
        """How well its facts are known: "read", "partly" or "unverified"."""
        return str(self.document["source"]["evidence"])

    @property
    def resolution_mm(self) -> float:
        """One unit of the last posted place, mm."""
        return self.engine.resolution_mm


def starter(name: str, base: Machine, extends: str) -> str:
    """The text of a new machine file that begins as ``base``, which is called ``extends``."""
    document = base.document
    limits = document["limits"]
    decimals = document["number"]["mm"]["linear"]
    return f"""\
# A machine file. What it does not say is as in "{extends}": `styluscam machine show {extends} --toml` prints all of that.
# `styluscam machine check` posts a torture program by it and reads the text back.
schema = 1
extends = "{extends}"
name = "{name}"
description = "{name}, made from {extends}"

[source]
evidence = "unverified" # "read" once every fact below was read in the manual
read = [] # the manual's title and page for each fact

[limits] # mm, mm/min and rev/min, with the zero point where the job puts it
# x = [-200.0, 200.0]
# y = [-150.0, 150.0]
# z = [-100.0, 50.0]
# max_feed = 5000.0
# max_rpm = 24000.0
rapid_rate = {limits["rapid_rate"]}

[number]
mm = {{ linear = {decimals}, feed = {document["number"]["mm"]["feed"]} }}
# point = "always" # 10. instead of 10

[line]
max_chars = {document["line"]["max_chars"]}

# [block_number] # N words
# start = 10
# step = 10

# [templates] # what stands around the moves: `{{{{ header }}}}`, `{{{{ wcs }}}}`, `{{{{ retract }}}}`, ... (docs/posts.md)
# program_end = \"\"\"
# {{{{ retract }}}}
# {{{{ end }}}}
# \"\"\"
"""


def differences(one: Document, other: Document, path: str = "") -> list[tuple[str, object, object]]:
    """Keys at which two machine documents differ, with both values; None where one has none."""
    rows: list[tuple[str, object, object]] = []
    for key in sorted(set(one) | set(other)):
        here, there = one.get(key), other.get(key)
        if here == there:
            continue
        place = f"{path}.{key}" if path else key
        if isinstance(here, dict) and isinstance(there, dict):
            rows += differences(here, there, place)
        else:
            rows.append((place, here, there))
    return rows
