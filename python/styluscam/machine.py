"""Controllers: shipped or from a file."""

from __future__ import annotations

import json
from pathlib import Path

from styluscam import _engine
from styluscam.errors import MachineError
from styluscam.files import read_text
from styluscam.types import Document


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
        """From a machine file (TOML)."""
        text = read_text(path, MachineError)
        try:
            return cls(_engine.Machine.from_toml(text))
        except MachineError as error:
            place = f"{path}: {error.where}" if error.where else str(path)
            raise MachineError(f"{place}: {error}", code=error.code, where=place, hint=error.hint) from error

    @classmethod
    def find(cls, name: str) -> Machine:
        """A machine file, or a shipped machine by its name."""
        return cls.read(name) if name.endswith(".toml") or Path(name).is_file() else cls.shipped(name)

    @classmethod
    def of_section(cls, section: Document, folder: Path) -> Machine:
        """The machine that a job's ``[machine]`` names; files are relative to ``folder``."""
        file = section.get("file")
        machine = cls.read(folder / file) if file else cls.shipped(str(section["name"]))
        options = section.get("options")
        return cls(machine.engine.with_options(json.dumps(options))) if options else machine

    @staticmethod
    def names() -> list[str]:
        """Names of the shipped machines."""
        return _engine.shipped_machines()

    @property
    def name(self) -> str:
        """Its name."""
        return self.engine.name

    @property
    def description(self) -> str:
        """What it is."""
        return self.engine.description

    @property
    def resolution_mm(self) -> float:
        """One unit of the last posted place, mm."""
        return self.engine.resolution_mm
