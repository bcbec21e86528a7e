"""FreeCAD as a process: started with a request, watched, ended when nobody waits for it any more."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from styluscam.errors import Cancelled, StylusError
from styluscam.types import Document

SCRIPT = Path(__file__).parent / "inside" / "styluscam_document_run.py"

PACKAGE = Path(__file__).parents[1]
"""What FreeCAD is to use as its engine."""

PATIENCE = 0.1
"""Seconds between two looks at whether to stop."""

GRACE = 5.0
"""Seconds that a FreeCAD has to end by itself when it is not needed any more."""

LAST_LINES = 12
"""Of what FreeCAD printed, in the message about its end."""


class Answer(NamedTuple):
    """What a FreeCAD left."""

    report: Document
    printed: str
    copy: bytes | None
    """The computed document, where it was asked for."""


def ask(command: Sequence[str], addon: Path | None, request: Document, stop: threading.Event | None) -> Answer:
    """Starts FreeCAD with a request (see the addon's `headless.run`) and waits for its report.

    Raises:
        StylusError: FreeCAD cannot be started, or ends without a report.
        Cancelled: by ``stop``; FreeCAD has ended then.
    """
    with tempfile.TemporaryDirectory(prefix="styluscam-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        copy = folder / "copy.FCStd"
        whole = {**request, "package": str(PACKAGE), "addon": str(addon or "")}
        whole["copy"] = str(copy) if request["copy"] else ""
        (folder / "request.json").write_text(json.dumps(whole), encoding="utf-8")
        options = ["-M", str(addon)] if addon else []
        with (folder / "printed.txt").open("wb") as log:
            code = _run([*command, *options, str(SCRIPT), "--", str(folder / "request.json")], log.fileno(), stop)
        printed = (folder / "printed.txt").read_text(encoding="utf-8", errors="replace")
        try:
            report: Document = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise _ended(command, code, printed) from error
        return Answer(report, printed, copy.read_bytes() if copy.is_file() else None)


def _run(words: Sequence[str], log: int, stop: threading.Event | None) -> int:
    """The exit code of a program; it does not live longer than this call."""
    try:
        process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
        )
    except OSError as error:
        message = f"{words[0]}: FreeCAD cannot be started: {error.strerror or error}"
        raise StylusError(message, code="freecad-missing", where=str(words[0]), hint="try it in a terminal") from error
    try:
        while True:
            with contextlib.suppress(subprocess.TimeoutExpired):
                return process.wait(PATIENCE)
            if stop is not None and stop.is_set():
                raise Cancelled("cancelled", code="cancelled")
    finally:
        _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a program that is still there, and what it has started: first it is asked to, by the end of its input."""
    if process.stdin is not None:
        with contextlib.suppress(OSError):
            process.stdin.close()
    if process.poll() is not None:
        return
    for number in (signal.SIGTERM, getattr(signal, "SIGKILL", signal.SIGTERM)):
        with contextlib.suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(process.pid, number)
            else:
                process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(GRACE)
            return


def _ended(command: Sequence[str], code: int, printed: str) -> StylusError:
    """FreeCAD is gone and has left nothing: it crashed, or the command is another program's."""
    how = f"by signal {-code}" if code < 0 else f"with exit code {code}"
    lines = [line.strip() for line in printed.splitlines() if line.strip()][-LAST_LINES:]
    last = f"; it printed last: {' / '.join(lines[-3:])}" if lines else ""
    return StylusError(
        f"FreeCAD ended {how} and left no report{last}",
        code="freecad-crashed" if code < 0 else "freecad-ended",
        where=" ".join(command),
        hint="run it again with --debug, and look whether FreeCAD starts and opens the document",
    )
