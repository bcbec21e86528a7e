"""Controllers: shipped or from a file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, document_of, file_of, json_of, refused, word_of
from styluscam.errors import MachineError
from styluscam.files import read_text
from styluscam.types import Document
from styluscam.words import shortened


@dataclass(frozen=True)
class Trial:
    """One thing that was tried on a machine file: see :meth:`Machine.check`."""

    name: str
    outcome: str
    """"passed"; "without" where the file states that the machine does not have it; "failed"."""
    message: str
    code: str
    where: str
    line: str
    """The posted line at fault; empty where there is none."""
    hint: str
    text: str
    """What was posted; empty where nothing was."""


MachineLike: TypeAlias = "Machine | Document | str | os.PathLike[str]"
"""A machine, its document, the name of a shipped one, or a machine file."""

WANTED = "a Machine, a dict, the name of a shipped machine or of a machine file"

SECTION = {"name", "file", "options"}
"""Keys of a job's ``[machine]``: a dict of these alone names a machine and is none itself."""


class Machine:
    """What a controller understands and how programs for it are written: ``Machine("grbl")``, ``Machine("mine.toml")``."""

    engine: _engine.Machine

    def __init__(self, source: MachineLike) -> None:
        """As :meth:`of`."""
        self.engine = Machine.of(source).engine

    @classmethod
    def _built(cls, engine: _engine.Machine) -> Machine:
        machine = cls.__new__(cls)
        machine.engine = engine
        return machine

    def __repr__(self) -> str:
        """Its name and what it is."""
        return f"<Machine {self.name!r}: {shortened(self.description)}>"

    def __eq__(self, other: object) -> bool:
        """Whether all that their files state, options included, is the same."""
        return self.document == other.document if isinstance(other, Machine) else NotImplemented

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self.engine.to_json())

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        return {"engine": self.engine.to_toml()}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        self.engine = _engine.Machine.from_toml(state["engine"])

    @classmethod
    def of(cls, source: MachineLike, argument: str = "machine") -> Machine:
        """From what a call takes for a machine: one, its document, a job's ``[machine]``, a shipped name or a machine file.

        Raises:
            MachineError: it is none of these, or the machine cannot be used.
        """
        if isinstance(source, Machine):
            return source
        if isinstance(source, Mapping):
            document = document_of(source, argument, WANTED, MachineError)
            named = {"name", "file"} & set(document) and set(document) <= SECTION
            return cls.of_section(document, Path(), argument) if named else cls.from_dict(document)
        path = file_of(source, argument, WANTED, MachineError)
        return cls.find(source) if isinstance(source, str) else cls.read(path)

    @classmethod
    def shipped(cls, name: str) -> Machine:
        """A shipped machine: see :meth:`names`."""
        name = word_of(name, "name", "the name of a shipped machine", MachineError)
        return cls._built(_engine.Machine.shipped(name, "machine"))

    @classmethod
    def from_dict(cls, document: Document, folder: str | Path = ".") -> Machine:
        """From what a machine file holds; files that it extends are looked for in ``folder``.

        Raises:
            MachineError: a key is unknown, missing or out of range.
        """
        document = document_of(document, "document", "a dict with what a machine file holds", MachineError)
        stated = {key: _stated(value) for key, value in document.items() if value is not None}
        text = json_of(stated, "document", MachineError)
        return cls._built(_engine.Machine.from_json(text, str(folder)))

    @classmethod
    def read(cls, path: FileName) -> Machine:
        """From a machine file (TOML). Files that it extends are looked for beside it."""
        path = file_of(path, "path", A_FILE, MachineError)
        text = read_text(path, MachineError)
        try:
            return cls._built(_engine.Machine.from_toml(text, str(path.parent)))
        except MachineError as error:
            key_path = f"{path}: {error.where}" if error.where else str(path)
            message = str(error).removeprefix(f"{error.where}: ")
            raise MachineError(f"{key_path}: {message}", code=error.code, where=key_path, hint=error.hint) from error

    @classmethod
    def find(cls, name: str) -> Machine:
        """A shipped machine by its name, or a machine file."""
        name = word_of(name, "name", "the name of a shipped machine or of a machine file", MachineError)
        is_file = name.endswith(".toml") or (name not in cls.names() and Path(name).is_file())
        return cls.read(name) if is_file else cls.shipped(name)

    @classmethod
    def of_section(cls, section: Document, folder: Path, path: str = "machine") -> Machine:
        """The machine that a section of a job names; files are relative to ``folder``.

        ``path`` is that of the section, ``machine`` or ``machines.support``: errors name its keys by it.
        """
        file, name = section.get("file"), section.get("name")
        if (file is None) == (name is None):
            given, hint = ("neither is stated", "add one") if file is None else ("both are stated", "remove one")
            raise MachineError(f"{path}: give either name or file, {given}", code="argument", where=path, hint=hint)
        if file is None:
            machine = cls._built(_engine.Machine.shipped(str(name), path))
        else:
            machine = cls.read(folder / file_of(file, f"{path}.file", A_FILE, MachineError))
        options = section.get("options")
        return machine._with_options(options, path) if options else machine

    @staticmethod
    def names() -> list[str]:
        """Names of the shipped machines."""
        return _engine.shipped_machines()

    def with_options(self, options: Document) -> Machine:
        """The same machine with other values for its options: ``units``, ``decimals``, ``block_numbers``, ..."""
        return self._with_options(options)

    def _with_options(self, options: Document, section: str = "") -> Machine:
        """As :meth:`with_options`; ``section`` is the path of what sets them, empty outside a document."""
        path = f"{section}.options" if section else "options"
        options = document_of(options, path, "a dict of options and their values", MachineError)
        values = {key: value for key, value in options.items() if isinstance(value, str | bool | int | float)}
        if values != options:
            key, value = next((key, value) for key, value in options.items() if key not in values)
            raise refused(f"{path}.{key}", value, "a number, a text, True or False", MachineError)
        return Machine._built(self.engine.with_options(json.dumps(values), section))

    def check(self) -> list[Trial]:
        """Posts a torture program, reads it back and compares; one entry for everything that was tried."""
        return [Trial(*entry) for entry in self.engine.check()]

    def to_toml(self) -> str:
        """The whole of it as a machine file that extends nothing."""
        return self.engine.to_toml()

    @cached_property
    def document(self) -> Document:
        """Everything that the file states."""
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
        """One unit of the last posted digit, mm."""
        return self.engine.resolution_mm


def _stated(value: object) -> object:
    """A document without the keys that hold None: what is not stated."""
    if isinstance(value, Mapping):
        return {key: _stated(part) for key, part in value.items() if part is not None}
    return [_stated(part) for part in value] if isinstance(value, list | tuple) else value


def starter(name: str, base: Machine, extends: str) -> str:
    """The text of a new machine file that begins as ``base``, which is called ``extends``."""
    document = base.document
    limits = document["limits"]
    decimals = document["number"]["mm"]["linear"]
    return f"""\
# A machine file. What it does not state is as in "{extends}": `styluscam machine show {extends} --toml` prints all of that.
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
        key_path = f"{path}.{key}" if path else key
        if isinstance(here, dict) and isinstance(there, dict):
            rows += differences(here, there, key_path)
        else:
            rows.append((key_path, here, there))
    return rows
