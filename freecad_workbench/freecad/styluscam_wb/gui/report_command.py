# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command "Report": the job's verification as one HTML page, beside the document and in the browser."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from .. import engine, verification
from ..long_work import Run, long_work
from . import chosen
from .command import Command
from .messages import translated


def write(job: Any, path: FilePath, run: Run) -> FilePath:
    """Verifies a job and writes its report, whole or not at all; `run` runs what takes long.

    Raises:
        styluscam.StylusError: a package that reports need is missing, or the file cannot be written.
        What `verification.verify_job` raises.
    """
    require_packages()
    from styluscam.files import write_whole
    from styluscam.report import report_page

    subject = verification.verify_job(job, run).subject
    write_whole(path, run(lambda progress: report_page(subject, progress)))
    return path


def require_packages() -> None:
    """Makes sure that a report can be made.

    Raises:
        EngineMissingError: there is no engine.
        styluscam.StylusError: a package that reports need is missing.
    """
    engine.styluscam()
    from styluscam.report import require_extra

    require_extra()


def place_of(job: Any) -> FilePath | None:
    """Beside the document; asked for where that is not saved, None where the user gives none."""
    document = job.Document.FileName
    if document:
        name = FilePath(document)
        return name.with_name(f"{name.stem}-{_file_name(job.Label)}.html")
    title, kinds = translated("Report"), translated("Web pages (*.html)")
    chosen_name, _ = QtWidgets.QFileDialog.getSaveFileName(FreeCADGui.getMainWindow(), title, "", kinds)
    return FilePath(chosen_name) if chosen_name else None


def _file_name(label: str) -> str:
    return "".join(letter if letter.isalnum() or letter in "-_ " else "-" for letter in label)


def open_page(path: FilePath) -> None:
    """Opens a page in the browser; where there is none, the report view states where the page is."""
    if not QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(path))):
        FreeCAD.Console.PrintWarning(f"StylusCAM: no browser opens {path}\n")


class WriteReport(Command):
    """Writes the report of the job in front and opens it."""

    name = "Report"
    icon = "report"
    menu_text = "Report"
    tool_tip = "Verifies the job and writes its report, one page for the browser, beside the document"

    def IsActive(self) -> bool:
        """With a job, and while no panel is open."""
        return chosen.is_job_free()

    def run(self) -> None:
        """Writes, then opens."""
        job = chosen.job()
        require_packages()  # before anybody is asked for a file
        path = place_of(job)
        if path is None:
            return
        with long_work(f"{job.Label}: report") as work:
            write(job, path, work)
        FreeCAD.Console.PrintMessage(f"StylusCAM: report: {path}\n")
        open_page(path)


def commands() -> list[Command]:
    """The command."""
    return [WriteReport()]
