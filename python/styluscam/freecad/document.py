"""One FreeCAD document: what is asked of FreeCAD, and what it found."""

from __future__ import annotations

import threading
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from styluscam.errors import StylusError
from styluscam.files import reason
from styluscam.freecad.finding import freecad_command
from styluscam.freecad.process import ask
from styluscam.types import Document

DAMAGED = "take an older copy, as FreeCAD leaves them beside it (.FCBak)"
"""What to do about a damaged document."""

PROTOCOL = 1
"""Of requests and reports; package and addon may be of different versions."""


@dataclass(frozen=True)
class Options:
    """What is asked of FreeCAD, the same for each document of a run.

    Attributes:
        post: a machine, or "" for each job's own post.
        jobs: labels or names of jobs; none for all.
        settings: ``LABEL.Property=value``, in order.
        save: whether the computed document is written back where nothing was found.
        addon: the addon's folder where it is not installed in FreeCAD.
        command: FreeCAD's program without a window and its first words; found by itself where it is left out.
    """

    post: str = ""
    jobs: Sequence[str] = ()
    settings: Sequence[str] = ()
    save: bool = False
    addon: Path | None = None
    command: Sequence[str] = ()


@dataclass
class DocumentRun:
    """What became of a document.

    Attributes:
        file: the document.
        report: what FreeCAD reports: versions, notes, settings, jobs with operations and programs, texts left out.
        texts: the programs' texts by job and number, as they stand in the report.
        copy: the computed document, where it is to be written.
        error: why there are no programs: class, code, where, message, hint, exit_code.
        written: files that were written.
        printed: everything that FreeCAD printed.
    """

    file: Path
    report: Document = field(default_factory=dict)
    texts: list[list[str]] = field(default_factory=list)
    copy: bytes | None = None
    error: Document | None = None
    written: list[Path] = field(default_factory=list)
    printed: str = ""

    @property
    def jobs(self) -> list[Document]:
        """The jobs' parts of the report."""
        return list(self.report.get("jobs", []))

    @property
    def errors(self) -> list[Document]:
        """All errors, the document's own first."""
        found = [self.error, *(job["error"] for job in self.jobs)]
        return [error for error in found if error is not None]

    @property
    def exit_code(self) -> int:
        """The worst of its errors; 0 where there is none."""
        return max((int(error["exit_code"]) for error in self.errors), default=0)

    def to_dict(self) -> Document:
        """Everything but the texts."""
        return {
            "file": str(self.file),
            "ok": self.exit_code == 0,
            "exit_code": self.exit_code,
            "error": self.error,
            **{key: self.report.get(key, empty) for key, empty in EMPTY.items()},
            "written": [str(path) for path in self.written],
        }


EMPTY: Document = {"freecad": "", "styluscam": "", "notes": [], "set": [], "jobs": []}
"""Of a report that has not come about."""


def run_document(file: Path, options: Options, stop: threading.Event | None = None) -> DocumentRun:
    """Has FreeCAD compute, verify and post a document; nothing is written.

    Raises:
        StylusError: the file is no document, FreeCAD is not there, or ends without a report.
        Cancelled: by ``stop``.
    """
    require_document(file)
    request = {
        "protocol": PROTOCOL,
        "file": str(file.resolve()),
        "post": options.post,
        "jobs": list(options.jobs),
        "set": list(options.settings),
        "copy": options.save,
    }
    addon = None if options.addon is None else options.addon.resolve()
    answer = ask(list(options.command) or freecad_command(), addon, request, stop)
    texts = [[program.pop("text") for program in job["programs"]] for job in answer.report.get("jobs", [])]
    error = answer.report.pop("error")
    return DocumentRun(file, answer.report, texts, answer.copy, error, printed=answer.printed)


def require_document(file: Path) -> None:
    """Asks whether a file is a FreeCAD document before FreeCAD is started for it.

    Raises:
        StylusError: it is none, or cannot be read.
    """
    try:
        if file.exists() and not file.is_file():
            raise _unreadable(file, "it is no file", "give a file that FreeCAD has saved (.FCStd)")
        with zipfile.ZipFile(file) as archive:
            ElementTree.fromstring(archive.read("Document.xml"))  # FreeCAD opens the half of a document without a word
            damaged = archive.testzip()
    except (zipfile.BadZipFile, KeyError) as error:
        raise _unreadable(file, "it is no FreeCAD document", "give a file that FreeCAD has saved (.FCStd)") from error
    except (ElementTree.ParseError, zlib.error, EOFError) as error:
        raise _unreadable(file, f"it is damaged: {error}", DAMAGED) from error
    except (OSError, ValueError) as error:
        raise _unreadable(file, f"cannot be read: {reason(error)}", "look at its name") from error
    if damaged:
        raise _unreadable(file, f"it is damaged: {damaged} in it cannot be read", DAMAGED)


def require_addon(folder: Path) -> None:
    """Asks whether a folder is the addon's: FreeCAD ignores another one in silence.

    Raises:
        StylusError: it is not.
    """
    if not (folder / "freecad" / "styluscam_wb").is_dir():
        message = f"{folder}: it is not the addon's folder"
        hint = "name the folder that holds its package.xml"
        raise StylusError(message, code="addon-missing", where="--addon", hint=hint)


def _unreadable(file: Path, why: str, hint: str) -> StylusError:
    return StylusError(f"{file}: {why}", code="unreadable", where=str(file), hint=hint)
