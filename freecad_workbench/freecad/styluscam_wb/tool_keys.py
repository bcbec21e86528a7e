# SPDX-License-Identifier: LGPL-2.1-or-later
"""The keys of a tool document as the engine's schema has them: what a form shows a row for, and how a text holds a value."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any

from .schema import KIND, Choice, JobSchema, Key, Schema

TOOLS, PROFILE = "tools", "profile"

HOST = {"number", "length_offset", "library", "reference"}
"""Keys of a job's tool that no bit has: its tool controller and its file stand for them."""

NUMBER, WHOLE, TEXT, LIST, POINTS, NAMED = "number", "whole", "text", "list", "points", "named"
"""What a value is: a number, a whole one, a text, some numbers, points (radius, height), numbers by name."""

WORD = re.compile(r"[^\d\W]\w*")


class ValueTextError(ValueError):
    """A text that holds no value of its key; the message states what is expected, `where` the key's path."""

    where = ""


@dataclass(frozen=True)
class ToolKey:
    """A key of the document with one value."""

    table: str
    """The table that it stands in: `profile`, `base`; empty for the tool's own."""
    name: str
    type: str
    unit: str
    text: str
    """The tool tip."""
    default: Any
    """What holds when it is left out; None where the engine decides."""
    required: bool
    count: int | None = None
    """How many numbers a list has; None: any."""

    @property
    def path(self) -> str:
        """Its path in the document, as errors name it."""
        return f"{self.table}.{self.name}" if self.table else self.name

    @property
    def label(self) -> str:
        """Its name as words: `Half angle`."""
        return self.name.removesuffix("_deg").replace("_", " ").capitalize()

    @property
    def is_optional(self) -> bool:
        """Whether leaving it out means something of its own."""
        return not self.required and self.default is None


@dataclass(frozen=True)
class ToolTable:
    """A table of the document: its kinds with the keys of each; a single one without a word where it has no kinds."""

    name: str
    label: str
    text: str
    required: bool
    kinds: tuple[Choice, ...]
    keys: dict[str, tuple[ToolKey, ...]]


def tables_of(schema: JobSchema) -> tuple[ToolTable, ...]:
    """The tables of a tool, the profile first, and last the tool's own keys under an empty name."""
    own = {name: key for name, key in schema.table(TOOLS).keys.items() if name not in HOST}
    tables = [name for name, key in own.items() if _is_table(key)]
    found = [_table(schema, own[name]) for name in sorted(tables, key=lambda name: name != PROFILE)]
    plain = tuple(_key("", key) for name, key in own.items() if name not in tables)
    return (*found, ToolTable("", "", "", True, (), {"": plain}))


def _is_table(key: Key) -> bool:
    return "properties" in key.entry or any("properties" in one for one in key.entry.get("oneOf", ()))


def _table(schema: JobSchema, key: Key) -> ToolTable:
    tables = schema.tables(TOOLS, key.name)
    kinds = tuple(kind for table in tables.values() for kind in table.kinds)
    keys = {
        word: tuple(_key(key.name, one) for one in table.keys.values() if one.name != KIND)
        for word, table in tables.items()
    }
    text = str(key.entry.get("description", ""))
    return ToolTable(key.name, key.name.replace("_", " ").capitalize(), text, key.name == PROFILE, kinds, keys)


def _key(table: str, key: Key) -> ToolKey:
    entry = key.entry
    alternatives = entry.get("anyOf", ())
    if alternatives:  # a list, or the file that holds it: a bit holds the list
        entry = next((one for one in alternatives if one.get("type") == "array"), entry)
    type_ = _type(entry)
    unit = str(entry.get("x-unit", ""))
    default = entry.get("default")
    if default is None and type_ == NAMED:
        default = {}
    count = entry.get("minItems") if entry.get("minItems") == entry.get("maxItems") else None
    return ToolKey(table, key.name, type_, unit, _tip(entry, unit), default, key.required, count)


def _type(entry: Schema) -> str:
    stated = entry.get("type")
    if stated == "array":
        return POINTS if entry["items"].get("type") == "array" else LIST
    return {"number": NUMBER, "integer": WHOLE, "object": NAMED}.get(str(stated), TEXT)


def _tip(entry: Schema, unit: str) -> str:
    """What it is, and its range."""
    lines = [str(entry.get("description", ""))]
    low = entry.get("exclusiveMinimum", entry.get("minimum"))
    if low is not None and "maximum" in entry:
        above = "above " if "exclusiveMinimum" in entry else ""
        lines.append(f"Range: {above}{low:g} to {entry['maximum']:g} {unit}".rstrip())
    return "\n".join(lines)


# --- values as texts ----------------------------------------------------------------------------------------------


def text_of(key: ToolKey, value: Any) -> str:
    """A value as it is shown in a line, or in lines; numbers are exact."""
    if value is None:
        return ""
    if key.type == POINTS:
        return "\n".join(", ".join(_shortest(number) for number in point) for point in value)
    if key.type == LIST:
        return ", ".join(_shortest(number) for number in value)
    if key.type == NAMED:
        return ", ".join(f"{name} = {_shortest(number)}" for name, number in value.items())
    return str(value)


def value_of(key: ToolKey, text: str) -> Any:
    """The value in a text; None where it is left out.

    Raises:
        ValueTextError: it holds none.
    """
    text = text.strip()
    if not text:
        return None
    try:
        return _parsed(key, text)
    except ValueTextError as error:
        error.where = key.path
        raise


def _parsed(key: ToolKey, text: str) -> Any:
    if key.type == POINTS:
        return [_numbers(line, f"line {number}", 2) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    if key.type == LIST:
        return _numbers(text, key.label.lower(), key.count)
    if key.type == WHOLE:
        if not text.isdecimal():
            raise ValueTextError(f"{text!r}: a whole number is expected")
        return int(text)
    if key.type == NAMED:
        return dict(_named(part) for part in re.split(r"[,;\n]", text) if part.strip())
    return text


def _shortest(number: float) -> str:
    return json.dumps(number)


def _numbers(text: str, what: str, count: int | None) -> list[float]:
    words = [word for word in re.split(r"[,;\s\[\]]+", text) if word]
    try:
        found = [float(word) for word in words]
    except ValueError:
        found = []
    if not found or (count is not None and len(found) != count):
        wanted = "numbers" if count is None else f"{count} numbers"
        raise ValueTextError(f"{what}: {text.strip()!r}: {wanted} are expected, separated by a comma")
    return found


def _named(part: str) -> tuple[str, float]:
    name, _, number = (word.strip() for word in part.partition("="))
    try:
        if WORD.fullmatch(name):
            return name, float(number)
    except ValueError:
        pass
    raise ValueTextError(f"{part.strip()!r}: a name and a number are expected, as in a = 6")


# --- what an error concerns ---------------------------------------------------------------------------------------


def concerned(where: str, message: str, paths: list[str]) -> str:
    """The path, of these, that an error of the engine concerns; empty where it names none.

    `where` names it in some errors; in others the message begins with the key: `diameter = -1: ...`,
    `points[1] (r = 1): ...`, `z, character 3: ...`.
    """
    if where in paths:
        return where
    found = re.match(r"([\w.]+?)(\[\d+\])?( is |( = |[:, ]).*)", message)
    name = found[1] if found else ""
    fitting = [path for path in paths if path in (name, f"{PROFILE}.{name}")]
    return fitting[0] if fitting else ""
