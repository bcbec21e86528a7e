"""Programs of documents to files: all of a document's, or none of them; never one over another of the same run."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from styluscam.errors import StylusError
from styluscam.files import Buffer, is_file, require_new, require_writable, write_all_whole
from styluscam.freecad.document import DocumentRun
from styluscam.freecad.views import with_views


class Writer:
    """Writes what the documents of one run make."""

    def __init__(self, inputs: Sequence[Path], out: Path | None, force: bool) -> None:
        """`inputs` are never replaced by a program; `out` is the one program's file; `force` replaces where FreeCAD asks."""
        self._inputs = list(inputs)
        self._out = out
        self._force = force
        self._taken: dict[str, str] = {}

    def write(self, run: DocumentRun) -> None:
        """Writes a document's programs, and the document itself where that is asked for.

        Raises:
            StylusError: they cannot be written; none is, then.
        """
        if run.exit_code:
            return
        programs = self._named(run)
        require_writable(programs, self._inputs)
        files: dict[Path, str | Buffer] = dict(programs)
        if run.copy is not None:
            require_replaceable(run.file)
            files[run.file] = with_views(run.file, run.copy)
        write_all_whole(files)
        run.written = list(files)

    def _named(self, run: DocumentRun) -> dict[Path, str]:
        """Texts by their files."""
        pairs = [
            (program, job["label"], text)
            for job, texts in zip(run.jobs, run.texts, strict=True)
            for program, text in zip(job["programs"], texts, strict=True)
        ]
        if self._out is not None and len(pairs) != 1:
            raise StylusError(
                f"--out names one file, and {run.file} makes {len(pairs)} programs",
                code="outputs",
                where="--out",
                hint="choose one job with --job, or leave --out out: FreeCAD's names are used",
            )
        found = {}
        for program, label, text in pairs:
            path = self._path(program["file"], str(run.report.get("policy", "")))
            self._take(path, f"{run.file}, {label}")
            program["file"] = str(path)
            found[path] = text
        return found

    def _path(self, name: str, policy: str) -> Path:
        """Where a program goes: FreeCAD's preference rules what becomes of a file that is there."""
        if self._out is not None:
            require_new(self._out, self._force, StylusError, "choose another name")
            return self._out
        path = Path(name)
        if policy == "unique":
            while is_file(path):
                path = path.with_name(f"{path.stem}-1{path.suffix}")
        elif policy == "ask" and is_file(path) and not self._force:
            raise StylusError(
                f"{path}: the file exists, and FreeCAD is set to ask before it replaces files",
                code="exists",
                where=str(path),
                hint="add --force, or change FreeCAD's preference for output files",
            )
        return path

    def _take(self, path: Path, owner: str) -> None:
        key = os.path.normcase(path.resolve())
        other = self._taken.get(key)
        if other is not None:
            raise StylusError(
                f"{path}: two programs of this run have this name: of {other} and of {owner}",
                code="outputs",
                where=str(path),
                hint="put %d, %j or %S into the jobs' output files",
            )
        self._taken[key] = owner


def require_replaceable(file: Path) -> None:
    """Asks whether a document may be saved over.

    Raises:
        StylusError: it is read-only.
    """
    if not os.access(file, os.W_OK) or not file.stat().st_mode & 0o222:
        message = f"{file}: it is read-only: it cannot be saved"
        raise StylusError(message, code="unwritable", where=str(file), hint="leave --save out, or copy the document")
