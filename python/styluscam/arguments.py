"""What the public calls take: texts and files distinguished, and one sentence for what no argument can be.

The classes themselves state how they are made of a name, a file or a dict: :meth:`styluscam.Tool.of` and its like.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TypeAlias

import numpy as np

from styluscam import _engine
from styluscam.errors import GeometryError, StylusError, VerifyError
from styluscam.files import is_file, read_gcode_text
from styluscam.types import Document

FileName: TypeAlias = "str | os.PathLike[str]"
"""A file by its name."""

A_FILE = "the name of a file (str or Path)"
"""What is expected where only a file can be meant."""

ENDING = re.compile(r"[^;(%].*\.[A-Za-z]{1,8}[0-9]?")
"""A line that ends as file names do."""

WORDS = re.compile(r"([A-Za-z]\s*[-+]?(\d+(\.\d*)?|\.\d+)\s*)+")
"""A line of nothing but G-code words: `G0 X1.Y2` ends as a file name does, and is none."""

SHOWN = 40
"""Characters of a value that is shown."""


def refused(argument: str, value: object, wanted: str, failure: type[StylusError], hint: str = "") -> StylusError:
    """The error for an argument that is none: it names the argument, what it must be and what it is."""
    message = f"{argument}: expected {wanted}, got {_described(value)}"
    return failure(message, code="argument", where=argument, hint=hint)


def file_of(value: object, argument: str, wanted: str, failure: type[StylusError], hint: str = "") -> Path:
    """The file that a name or a path means.

    Raises:
        StylusError: of class ``failure``: it is neither, or a text of several lines; ``hint`` names what takes those.
    """
    name = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    is_name = isinstance(name, str) and bool(name.strip()) and not (isinstance(value, str) and _is_text(value))
    if not is_name:
        raise refused(argument, value, wanted, failure, hint)
    return Path(str(name))


def word_of(value: object, argument: str, wanted: str, failure: type[StylusError], hint: str = "") -> str:
    """A name, as the texts of libraries and lists hold it.

    Raises:
        StylusError: of class ``failure``: it is no text, an empty one or one of several lines.
    """
    if not isinstance(value, str) or not value.strip() or _is_text(value):
        raise refused(argument, value, wanted, failure, hint)
    return value


def channel_of(value: object, channels: Iterable[str], failure: type[StylusError]) -> str:
    """A channel by its name, among those that there are.

    Raises:
        StylusError: of class ``failure``: it is no name, or none of theirs.
    """
    name = word_of(value, "channel", "the name of a channel", failure)
    _engine.require_channel(name, list(channels), failure.__name__)
    return name


def document_of(value: object, argument: str, wanted: str, failure: type[StylusError]) -> Document:
    """A dict with texts for keys.

    Raises:
        StylusError: of class ``failure``: it is none.
    """
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise refused(argument, value, wanted, failure)
    return dict(value)


def json_of(document: Document, argument: str, failure: type[StylusError]) -> str:
    """A document as JSON; what numpy and pathlib make of numbers and names is taken for these.

    Raises:
        StylusError: of class ``failure``: it holds what no file can, with the key.
    """
    try:
        return json.dumps(document, default=_plain, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        key, value = next(_unfit(document, ""), ("", document))
        raise refused(key or argument, value, "a text, a finite number, a list or a dict", failure) from error


def _plain(value: object) -> object:
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(type(value).__name__)


def _unfit(value: object, key: str) -> Iterator[tuple[str, object]]:
    """Where a document holds what JSON cannot, and that."""
    if isinstance(value, Mapping):
        for name, part in value.items():
            yield from _unfit(part, f"{key}.{name}" if key else str(name))
    elif isinstance(value, list | tuple):
        for number, part in enumerate(value):
            yield from _unfit(part, f"{key}[{number}]")
    else:
        try:
            json.dumps(value, default=_plain, allow_nan=False)
        except (TypeError, ValueError):
            yield key, value


def gcode_of(value: object, argument: str = "text") -> str:
    """A program's text, or that of the file that a path or a name means.

    A ``str`` is a name where it is a single line that is an existing file, or ends as file names do (``out/cup.ngc``);
    everything else is the text itself.

    Raises:
        VerifyError: the file cannot be read, or the value is neither.
    """
    if isinstance(value, str) and (_is_text(value) or not (_ends_as_a_file(value.strip()) or is_file(Path(value)))):
        return value
    return read_gcode_text(file_of(value, argument, "G-code, or the name of its file,", VerifyError))


def number_of(value: object, argument: str) -> float:
    """A number.

    Raises:
        GeometryError: it is none.
    """
    if not isinstance(value, str | bytes | bytearray):
        try:
            return float(value)  # type: ignore[arg-type]  # refused below
        except (TypeError, ValueError, OverflowError):
            pass
    raise refused(argument, value, "a number", GeometryError)


def _ends_as_a_file(line: str) -> bool:
    return bool(ENDING.fullmatch(line)) and not WORDS.fullmatch(line)


def _is_text(value: str) -> bool:
    return "\n" in value or "\r" in value


def _described(value: object) -> str:
    """A value in few words: its type, and itself where that is short."""
    if value is None:
        return "None"
    kind = type(value).__name__
    if isinstance(value, str):
        lines = value.count("\n") + (not value.endswith("\n"))
        if not value.strip():
            return f"an empty text ({kind})"
        shown = value if len(value) <= SHOWN else value[: SHOWN - 3] + "..."
        return f"a text of {lines} lines ({kind})" if _is_text(value) else f"{kind} {shown!r}"
    if isinstance(value, bool | int | float) and len(repr(value)) <= SHOWN:
        return f"{kind} {value!r}"
    return f"a value of type {kind}"
