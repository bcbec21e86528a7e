"""The job document: everything that is planned comes from one."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, channel_of, document_of, file_of, json_of, refused
from styluscam.errors import JobError, ToolError
from styluscam.files import reason, require_end
from styluscam.parts import springback, wires
from styluscam.parts.arrays import PartArrays
from styluscam.parts.formats import BREP_ENDINGS, MESH_ENDINGS
from styluscam.parts.part import Part, PartLike
from styluscam.programs import stockfile
from styluscam.programs.cutting import CuttingData, limits_of, table_text
from styluscam.programs.machine import Machine
from styluscam.tools import pointsfile
from styluscam.tools.tool import Tool
from styluscam.tools.toolfile import TOOL
from styluscam.types import Document, FloatArray, Progress
from styluscam.words import counted, shortened

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

JobLike: TypeAlias = "Job | Document | str | os.PathLike[str]"
"""A job, its document, or a job file."""

MAIN_CHANNEL = "main"
"""The channel that every job has."""

WANTED = "a Job, a dict or the name of a job file"


class Job:
    """A checked job: ``Job("job.toml")``, ``Job({...})``. Relative paths in it resolve against ``folder``."""

    engine: _engine.Job
    folder: Path
    name: str
    file: Path | None
    document: Document
    cutting_data: dict[str, CuttingData]
    """What feeds and spindles that the document leaves out follow from, by the operation's id."""
    _target: Part | None
    """The part in the file, once it was read."""
    _part: Part | None
    """The part as it is formed, once it was asked for."""
    _stock: Part | None
    """The body in the stock's file, once it was read."""
    _handed: Part | None
    """The part that stands for the file, where a caller gave one."""
    _tool_files: list[Path]

    def __init__(self, source: JobLike) -> None:
        """As :meth:`of`."""
        vars(self).update(vars(Job.of(source)))

    @classmethod
    def _built(
        cls,
        engine: _engine.Job,
        folder: Path,
        name: str = "job",
        *,
        part: Part | None = None,
        file: Path | None = None,
        tool_files: Sequence[Path] = (),
        written: object = None,
    ) -> Job:
        """``written`` is the document as its author wrote it: what it leaves out of feeds follows from its material."""
        job = cls.__new__(cls)
        job.engine, job.folder, job.name, job.file = engine, folder, name, file
        job._target = job._handed = part
        job._part = job._stock = None
        job.document = json.loads(engine.to_json())
        job._tool_files = []
        job._take_wires()
        job._take_tools()
        job._tool_files += tool_files
        job.cutting_data = {}
        job._take_cutting_data(written)
        return job

    def __repr__(self) -> str:
        """Its title, part, operations and machine."""
        kinds = ", ".join(dict.fromkeys(str(one["kind"]) for one in self.operations))
        part = shortened(Path(self.document["part"]["file"]).name, 30)
        machine = self.document["machine"].get("name") or Path(self.document["machine"]["file"]).name
        what = f"{part}, {counted(len(self.operations), 'operation')} ({shortened(kinds, 30)})"
        return f"<Job {shortened(self.title, 30)!r}: {what}, for {shortened(machine, 20)}>"

    def __eq__(self, other: object) -> bool:
        """Whether the documents are equal, with the same files or parts."""
        if not isinstance(other, Job):
            return NotImplemented
        if self.engine.to_json() != other.engine.to_json() or (self._handed is None) != (other._handed is None):
            return False
        return self._handed == other._handed and self.folder.resolve() == other.folder.resolve()

    def __hash__(self) -> int:
        """As equality compares."""
        return hash(self.engine.to_json())

    def __getstate__(self) -> Document:
        """For pickle and copy; a part that was read travels along."""
        return {**vars(self), "engine": self.engine.to_json(), "_part": None, "_stock": None}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        vars(self).update(state, engine=_engine.Job.from_json(state["engine"]))

    @classmethod
    def of(cls, source: JobLike, argument: str = "job") -> Job:
        """From what a call takes for a job: one, its document, or a job file.

        Raises:
            JobError: it is none of these; or as :meth:`read`.
        """
        if isinstance(source, Job):
            return source
        if isinstance(source, Mapping):
            return cls.from_dict(document_of(source, argument, WANTED, JobError))
        return cls.read(file_of(source, argument, WANTED, JobError, "Job.from_toml(text) takes a text"))

    @classmethod
    def read(cls, path: FileName) -> Job:
        """From a TOML (or JSON) file.

        Raises:
            JobError: with the key, its value and what is allowed.
        """
        path = file_of(path, "path", A_FILE, JobError, "Job.from_toml(text) takes a text")
        _require_no_other(path)
        try:
            require_end(path)
            text = path.read_text(encoding="utf-8")
        except FileNotFoundError as error:
            message = f"{path}: no such file"
            raise JobError(message, code="no-such-file", where=str(path), hint="check the path") from error
        except (OSError, ValueError) as error:
            text_only = isinstance(error, UnicodeDecodeError)
            why = "not a job: it is not text in UTF-8" if text_only else f"cannot be read: {reason(error)}"
            raise JobError(f"{path}: {why}", code="unreadable", where=str(path), hint="name a job file") from error
        # a job that comes through a pipe speaks of files from here
        folder = Path.cwd() if path.is_fifo() else path.resolve().parent
        engine, files, written = _of_json(text, folder) if path.suffix == ".json" else _of_toml(text, folder)
        return cls._built(engine, folder, path.stem, file=path, tool_files=files, written=written)

    @classmethod
    def from_toml(cls, text: str, folder: FileName = ".") -> Job:
        """From a text as job files hold it.

        Raises:
            JobError: with the key, its value and what is allowed.
        """
        if not isinstance(text, str):
            raise refused("text", text, "the text of a job file", JobError)
        origin = file_of(folder, "folder", "the name of a folder (str or Path)", JobError)
        engine, files, written = _of_toml(text, origin)
        return cls._built(engine, origin, tool_files=files, written=written)

    @classmethod
    def from_dict(cls, document: Document, folder: FileName = ".", part: PartLike | None = None) -> Job:
        """From a dict; ``part`` stands for the file that the document names, where a caller has it at hand.

        Raises:
            JobError: with the key, its value and what is allowed.
        """
        origin = file_of(folder, "folder", "the name of a folder (str or Path)", JobError)
        document, files = _resolved(document_of(document, "document", "a dict with a job's keys", JobError), origin)
        text = json_of(document, "document", JobError)
        known = None if part is None else Part.of(part)
        return cls._built(_engine.Job.from_json(text), origin, part=known, tool_files=files, written=json.loads(text))

    @staticmethod
    def check(text: str) -> None:
        """Raises what :meth:`read` would raise for a file with this TOML."""
        _engine.Job.from_toml(text)

    def to_dict(self) -> Document:
        """The document with all its defaults."""
        return self.document

    @property
    def title(self) -> str:
        """The job's name, or its part's file."""
        return str(self.document["title"] or Path(self.document["part"]["file"]).name)

    @property
    def output(self) -> str:
        """The file that its G-code is written to, the main channel's: as it names it, or by its own name."""
        return str(self.document["output"]["file"]) or f"{self.name}.ngc"

    @property
    def operations(self) -> list[Document]:
        """The operations in order, with all their defaults; each has the id by which programs and reports call it."""
        sections = enumerate(self.document["operations"], start=1)
        return [{**section, "id": section["id"] or f"{section['kind']}-{number}"} for number, section in sections]

    def _take_tools(self) -> None:
        """Puts tools of libraries and files instead of their names, and notes the files."""
        named = {name: tool["library"] for name, tool in self.document["tools"].items() if "library" in tool}
        if not named:
            return
        for name, library in named.items():
            section = self.document["tools"][name]
            section.pop("library")
            tool = _tool(library, self.folder, f"tools.{name}.library")
            self.document["tools"][name] = {**tool.to_dict(), **section}
            self._tool_files += tool.files
        self.engine = _engine.Job.from_json(json.dumps(self.document))
        self.document = json.loads(self.engine.to_json())

    def _take_wires(self) -> None:
        """Puts the polylines of files instead of their names, and notes the files."""
        files = wires.with_wires(self.document, self.folder)
        if files:
            self._tool_files += files
            self.engine = _engine.Job.from_json(json.dumps(self.document))
            self.document = json.loads(self.engine.to_json())

    def _take_cutting_data(self, written: object) -> None:
        """Puts in the feeds and spindles that the document leaves out, where it states what is milled."""
        process = self.document["process"]
        if process.get("material") is None or self.engine.forms:
            return
        named = process.get("cutting_data")
        table = None if named is None else table_text(self.folder / named)
        self._tool_files += [] if named is None else [Path(named)]
        limits = json.dumps(limits_of(self.machine()))
        self.engine, filled = self.engine.with_cutting_data(json.dumps(written), table, limits)
        self.document = json.loads(self.engine.to_json())
        self.cutting_data = {one["id"]: CuttingData(**one["data"]) for one in json.loads(filled)}

    def inputs(self) -> list[Path]:
        """The files that the job is read from: itself, the part's, the machine's, the tools' and those of boundaries."""
        machines = [json.loads(self.engine.machine_of(channel)).get("file") for channel in self.channels]
        named = [self.document["part"]["file"], *machines, *dict.fromkeys(self._tool_files)]
        measured = [] if self._springback is None else springback.files(self._springback)
        own = [] if self.file is None else [self.file]
        mesh, before = stockfile.section_of(self.document, "mesh"), self._before()
        named += [] if mesh is None else [mesh["file"]]
        earlier = [] if before is None else [*before[0].inputs(), before[1]]
        return own + [self.folder / name for name in [*named, *measured] if name] + earlier

    @property
    def _springback(self) -> Document | None:
        section: Document | None = self.document["part"].get("springback")
        return section

    def target(self, progress: Progress | None = None) -> Part:
        """The target: the part in the file, read once."""
        if self._target is None:
            section = self.document["part"]
            self._target = Part.read(
                self.folder / section["file"], section["tolerance"], section.get("units"), progress
            )
        return self._target

    def part(self, progress: Progress | None = None) -> Part:
        """The part as it is formed: the :meth:`target`, with its springback compensated where the job has that.

        Raises:
            GeometryError: a file cannot be read.
            JobError: the springback does not fit the part.
        """
        if self._part is None:
            target = self.target(progress)
            self._part = target.shaped(self.engine, self._deviations()) if self.engine.shapes else target
        return self._part

    def stock(self, progress: Progress | None = None) -> Part | None:
        """The body in the stock's file, read once; None where the job names none.

        Raises:
            GeometryError: it cannot be read.
        """
        if self._stock is None:
            self._stock = stockfile.body(self.document, self.folder, progress)
        return self._stock

    def _deviations(self) -> list[tuple[FloatArray, FloatArray]]:
        return [] if self._springback is None else springback.read_deviations(self._springback, self.folder)

    @property
    def channels(self) -> tuple[str, ...]:
        """The channels of its process, programs that run side by side: ``"main"`` first."""
        return tuple(self.engine.channels)

    def scene(self, progress: Progress | None = None, channel: str = MAIN_CHANNEL) -> _engine.Scene:
        """The part as it lies on the machine of a channel.

        Raises:
            JobError: the job has no such channel.
        """
        channel_of(channel, self.channels, JobError)
        part, stock = self.part(progress), self.stock(progress)
        body = None if stock is None else stock.engine
        return _engine.Scene(self.engine, part.engine, channel, body, self._earlier(progress))

    def _earlier(self, progress: Progress | None) -> _engine.Earlier | None:
        """What the program cut that left the stock; None where the job names none."""
        before = self._before()
        if before is None:
            return None
        job, file = before
        text = stockfile.program(file, job.file or job.folder)
        return job.scene(progress).left_by(job.engine, job.machine().engine, text)

    def _before(self) -> tuple[Job, Path] | None:
        """The job that left the stock, which comes not back to this one by those before it, and its program's file."""
        first, before = None, self
        seen = set() if self.file is None else {self.file.resolve()}
        while (section := stockfile.section_of(before.document, "program")) is not None:
            earlier = Job.read(before.folder / section["job"])
            file = before.folder / section["file"] if section.get("file") else earlier.folder / earlier.output
            first = first or (earlier, file)
            stockfile.require_new((before.folder / section["job"]).resolve(), seen)
            seen.add((before.folder / section["job"]).resolve())
            before = earlier
        return first

    def tools(self) -> dict[str, Tool]:
        """The job's tools by name: profile, base, shank and holder."""
        sections = self.document["tools"].items()
        return {name: Tool.from_dict({key: tool[key] for key in TOOL if key in tool}) for name, tool in sections}

    def machine(self, channel: str = MAIN_CHANNEL) -> Machine:
        """The machine that the job names for a channel.

        Raises:
            JobError: the job has no such channel.
        """
        section = json.loads(self.engine.machine_of(channel_of(channel, self.channels, JobError)))
        path = "machine" if channel == MAIN_CHANNEL else f"machines.{channel}"
        return Machine.of_section(section, self.folder, path)


PROGRAMS = (".ngc", ".nc", ".gcode", ".tap", ".cnc", ".mpf", ".h")
"""Endings of G-code that people take for a job's."""


def _require_no_other(path: Path) -> None:
    """Reports what a file is that is taken for a job, where its ending shows it."""
    ending, name = path.suffix.lower(), shlex.quote(str(path))
    if ending in BREP_ENDINGS + MESH_ENDINGS:
        message, hint = "this is a part, not a job", f"styluscam new {name} writes a job for it"
    elif ending in PROGRAMS:
        message, hint = "this is G-code, not a job", f"styluscam verify {name} --job JOB.toml checks it"
    else:
        return
    raise JobError(f"{path}: {message}", code="not-a-job", where=str(path), hint=hint)


def _tool(library: str, folder: Path, key: str) -> Tool:
    """A shipped tool, a tool file's, or one of a library in a file."""
    try:
        return Tool.find(library, folder)
    except ToolError as error:
        raise ToolError(f"{key}: {error}", code=error.code, where=key, hint=error.hint) from error


def _resolved(document: Document, folder: Path) -> tuple[Document, list[Path]]:
    """The document with points instead of the files that its tools' profiles name, and the files."""
    tools, files = document.get("tools"), list[Path]()
    if not isinstance(tools, dict):
        return document, files
    taken = {}
    for name, tool in tools.items():
        taken[name], named = pointsfile.resolved(tool, folder) if isinstance(tool, dict) else (tool, [])
        files += named
    return {**document, "tools": taken}, files


def _of_toml(text: str, folder: Path) -> tuple[_engine.Job, list[Path], object]:
    """The job in a TOML text, the files with points that it names, and the document; what is no TOML the engine reports."""
    try:
        document = tomllib.loads(text)
    except (ValueError, RecursionError):
        return _engine.Job.from_toml(text), [], None
    document, files = _resolved(document, folder)
    engine = _engine.Job.from_json(json_of(document, "job", JobError)) if files else _engine.Job.from_toml(text)
    return engine, files, document


def _of_json(text: str, folder: Path) -> tuple[_engine.Job, list[Path], object]:
    """As :func:`_of_toml`, of a JSON text."""
    try:
        document = json.loads(text)
    except (ValueError, RecursionError):
        return _engine.Job.from_json(text), [], None
    document, files = _resolved(document, folder) if isinstance(document, dict) else (document, [])
    return _engine.Job.from_json(json.dumps(document) if files else text), files, document


def job_schema() -> Document:
    """The JSON Schema of the job document."""
    schema: Document = json.loads(_engine.job_schema())
    for variant in schema["$defs"]["ProfileDocument"]["oneOf"]:
        if variant.get("properties", {}).get("kind", {}).get("const") == "points":
            file = {"type": "string", "description": "A file with radius and height in two columns, instead of them."}
            variant["properties"]["points"] = {"anyOf": [variant["properties"]["points"], file]}
    return schema


class Starter(NamedTuple):
    """A job for a part that has none, and why it is so."""

    text: str
    """TOML, commented."""
    reasons: list[str]
    """Sentences: what the part is taken for, and what follows from it."""
    operations: list[tuple[str, list[str]]]
    """Its operations in order, by their names, each with the sentences that state why it is there."""


def starter_job(
    arrays: PartArrays,
    file: str,
    units: str | None = None,
    *,
    material: str | None = None,
    cutting_data: tuple[str, str] | None = None,
) -> Starter:
    """A commented job for a part: formed where it is a sheet that can be, else milled from stock to finish; it runs as it stands.

    Args:
        arrays: the part.
        file: the part's file, as the job should name it.
        units: of that file, where it does not state them.
        material: what the part is made of; feeds and the spindle follow from it in milling. Aluminium when left out.
        cutting_data: a table of cutting data of one's own: the file as the job should name it, and its text.

    Raises:
        JobError: the material is not in the tables.
    """
    faces = [(f.name, f.kind, f.area_mm2, (f.slope_min_deg, f.slope_max_deg)) for f in arrays.faces]
    engine, gap = Part.from_arrays(arrays).engine, arrays.edge_gap_mm
    return Starter(*_engine.starter(engine, file, faces, units, gap, material=material, cutting_data=cutting_data))
