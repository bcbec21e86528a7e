"""What the command line prints: results on stdout, progress and errors on stderr.

The CAD kernel prints to the process's stdout when it likes. So that a script reading ``--json`` gets one
document and nothing else, :func:`shielded` keeps the real stdout to itself while a command runs.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import sys
from collections.abc import Iterator
from typing import TextIO

from styluscam.errors import StylusError
from styluscam.records import plain

WIDTH = 110
"""Columns of tables where stdout is no terminal."""

_stdout: list[TextIO] = []


@contextlib.contextmanager
def shielded() -> Iterator[None]:
    """Sends to nowhere what anyone but :func:`stdout` writes to the process's stdout."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
        kept = os.dup(1)
    except OSError:  # started without a stdout
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    stream = os.fdopen(kept, "w", encoding="utf-8", errors="replace", closefd=False)
    try:
        os.dup2(nowhere, 1)
        _stdout.append(stream)
        with contextlib.redirect_stdout(stream):  # typer prints its help there
            yield
    finally:
        _stdout.remove(stream)
        _flush_c()
        with contextlib.suppress(OSError):  # reported where it could not be written
            stream.close()
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def _flush_c() -> None:
    """What C and C++ code still holds in its buffers must not come out later."""
    with contextlib.suppress(OSError, TypeError, AttributeError):
        ctypes.CDLL(None).fflush(None)


def stdout() -> TextIO | None:
    """The stream for results; None where the process was started without one."""
    return _stdout[-1] if _stdout else sys.stdout


@contextlib.contextmanager
def _writing() -> Iterator[None]:
    """A reader that has gone away is no fault: the command's work goes on. A full disk is the user's to know of.

    Raises:
        StylusError: the result cannot be written.
    """
    try:
        yield
    except BrokenPipeError:
        pass
    except OSError as error:
        message = f"stdout: cannot be written: {error.strerror or error}"
        raise StylusError(message, code="unwritable", where="stdout", hint="redirect it elsewhere") from error


def say(text: str = "") -> None:
    """A line of the result."""
    stream = stdout()
    if stream is not None:
        with _writing():
            stream.write(text + "\n")
            stream.flush()


def say_json(document: object) -> None:
    """The one document that ``--json`` prints."""
    say(json.dumps(document, indent=2, ensure_ascii=False, default=plain))


def complain(text: str) -> None:
    """A line on stderr."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):  # nobody is left to report to
            sys.stderr.write(text + "\n")
            sys.stderr.flush()


def table(columns: dict[str, str], rows: list[list[str]]) -> None:
    """A table; ``columns`` gives each heading its justification."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for heading, justify in columns.items():
        drawn.add_column(heading, justify="right" if justify == "right" else "left", no_wrap=True)
    for row in rows:
        drawn.add_row(*row)
    stream = stdout()
    if stream is None:
        return
    width = None if stream.isatty() else WIDTH
    console = Console(file=stream, width=width, markup=False, highlight=False, legacy_windows=False)
    with _writing():
        console.print(drawn)
        stream.flush()


def fields(rows: list[tuple[str, str]]) -> None:
    """Names and values, one per line, the values below each other."""
    width = max((len(name) for name, _ in rows), default=0)
    for name, value in rows:
        say(f"{name:<{width}}  {value}".rstrip())
