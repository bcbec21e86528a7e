"""Tool files: the JSON document of one tool, with a name for people around what the engine takes.

The engine checks a document; what it refuses is reported here in the words of the file: which key, and what was meant.
"""

from __future__ import annotations

import difflib
import json
import math
import re
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from styluscam import _engine
from styluscam.arguments import json_of
from styluscam.errors import ToolError
from styluscam.files import read_text
from styluscam.types import Document

SCHEMA = 1
"""The schema of tool files and libraries that this version reads and writes."""

NAMING = ("schema", "name", "title")
"""Keys around the tool: the engine does not see them."""

TOOL = ("profile", "base", "shank_diameter", "length", "holder", "flutes", "cutter_material")
"""Keys of the tool itself."""

REFERENCE = re.compile(r"(.+?\.(?:json|fctb))(?::(.+))?", re.IGNORECASE | re.DOTALL)
"""A tool file, or a library and a name in it."""

NUMBERS = re.compile(r"\[\n[-+.\deE,\s]+\]")
"""A list of numbers over several lines."""


def read_json(path: str | Path, what: str) -> Document:
    """The JSON object in a file; ``what`` it should have been is named when it is none.

    Raises:
        ToolError: the file cannot be read or is no JSON object.
    """
    try:
        document = parsed(read_text(path, ToolError).removeprefix("\ufeff"))
    except ValueError as error:
        message = f"{path}: not {what}: {error}"
        raise ToolError(message, code="unreadable", where=str(path), hint="it must be JSON") from error
    except RecursionError as error:
        message = f"{path}: not {what}: it is nested too deeply"
        raise ToolError(message, code="unreadable", where=str(path)) from error
    if not isinstance(document, dict):
        message = f"{path}: not {what}: a JSON object is expected"
        raise ToolError(message, code="unreadable", where=str(path), hint='it begins with {"schema": 1, ...')
    found: Document = document
    return found


def parsed(text: str) -> object:
    """What a JSON text holds; ValueError for a key that stands twice in an object and for numbers that are not finite."""
    return json.loads(text, object_pairs_hook=_once, parse_float=_finite, parse_constant=_finite)


def engine_text(document: Document, where: str) -> str:
    """The text that the engine takes of a tool's document.

    Raises:
        ToolError: it holds what JSON cannot: a number that is not finite, an object of Python; the key is named.
    """
    try:
        return json_of(bare(document), "tool", ToolError)
    except ToolError as error:
        raise ToolError(f"{where}: {error}", code="document", where=error.where, hint=error.hint) from error


def _once(pairs: list[tuple[str, object]]) -> Document:
    """An object whose keys each stand once: of two, a reader would see one and JSON take the other."""
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {twice!r} is given twice in one object")
    return found


def _finite(text: str) -> float:
    """A number that a length can be: JSON's readers take NaN and 1e999 too."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is not a finite number")
    return number


def check_schema(document: Document, where: str) -> None:
    """Refuses documents of a later version; one without a schema is of the first."""
    schema = document.get("schema", SCHEMA)
    if not isinstance(schema, int) or isinstance(schema, bool) or schema < 1:
        raise ToolError(f"{where}: schema = {schema!r}: a whole number from 1", code="schema", where=where)
    if schema > SCHEMA:
        message = f"{where}: written by a newer StylusCAM: schema {schema}, and this version reads up to {SCHEMA}"
        raise ToolError(message, code="schema", where=where, hint="update StylusCAM: pip install -U styluscam")


def check_keys(document: Document, allowed: Iterable[str], where: str) -> None:
    """Refuses a key that is not known, with the one that was probably meant."""
    known = list(allowed)
    for key in document:
        if key not in known:
            raise ToolError(f"{where}: unknown key {key!r}", code="unknown-key", where=where, hint=_meant(key, known))


def check_text(document: Document, keys: Iterable[str], where: str) -> None:
    """Names and titles are one line of text."""
    for key in keys:
        value = document.get(key, "")
        if not isinstance(value, str) or any(ord(c) < 32 or 0xD800 <= ord(c) < 0xE000 for c in value):
            raise ToolError(f"{where}: {key} must be one line of text", code="document", where=where)


def check_tool(document: Document, where: str) -> None:
    """Refuses keys that no tool has, at its top and in its profile; the engine checks ranges."""
    check_keys(document, NAMING + TOOL, where)
    check_text(document, ("name", "title"), where)
    if "profile" not in document:
        raise ToolError(f"{where}: no profile", code="document", where=where, hint=f"add {_example()}")
    check_profile(document["profile"], f"{where}: profile")


def check_profile(profile: object, where: str) -> None:
    """Refuses a kind or a key that the engine's profiles do not have."""
    if not isinstance(profile, dict) or "kind" not in profile:
        raise ToolError(f"{where}: not a profile", code="document", where=where, hint=f"write {_example()}")
    kind, kinds = profile["kind"], profile_keys()
    if not isinstance(kind, str) or kind not in kinds:
        hint = _meant(str(kind), list(kinds))
        raise ToolError(f"{where}: unknown kind {kind!r}", code="unknown-kind", where=where, hint=hint)
    check_keys(profile, kinds[kind], f"{where} of kind {kind}")


@lru_cache(maxsize=1)
def profile_keys() -> dict[str, tuple[str, ...]]:
    """Keys by kind of profile, as the engine's schema has them."""
    definitions = json.loads(_engine.job_schema())["$defs"]
    found: dict[str, tuple[str, ...]] = {}
    for variant in definitions["ProfileDocument"]["oneOf"]:
        properties = _properties(variant, definitions)
        found[str(properties["kind"]["const"])] = tuple(properties)
    return found


def _properties(schema: Document, definitions: Document) -> Document:
    """The properties of an object's schema, those behind a reference included."""
    merged: Document = {}
    if "$ref" in schema:
        merged |= _properties(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    for part in schema.get("allOf", ()):
        merged |= _properties(part, definitions)
    merged |= schema.get("properties", {})
    return merged


def bare(document: Document) -> Document:
    """What the engine takes: the document without name, title and schema."""
    return {key: value for key, value in document.items() if key not in NAMING}


def text_of(document: Document) -> str:
    """A document as a file's text: numbers as short as they can be and exact, lists of numbers on one line."""
    text = json.dumps(document, indent=2, ensure_ascii=False)
    return NUMBERS.sub(lambda found: f"[{' '.join(found[0][1:-1].split())}]", text) + "\n"


def file_and_name(name: str) -> tuple[str, str]:
    """The file and the tool in it that a name means: ``shop.json:clothoid:small``; no file for a shipped tool's name."""
    found = REFERENCE.fullmatch(name)
    return (found[1], found[2] or "") if found else ("", name)


def file_name(name: str) -> str:
    """A tool's name as a file name without an ending: ``clothoid:medium`` becomes ``clothoid-medium``."""
    return re.sub(r"[^\w.+-]+", "-", name).strip("-.") or "tool"


def _meant(word: str, known: list[str]) -> str:
    near = difflib.get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"


def _example() -> str:
    return '"profile": {"kind": "ball", "diameter": 10.0}'
