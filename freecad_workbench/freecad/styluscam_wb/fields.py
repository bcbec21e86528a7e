# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operation's properties, made from the engine's job schema: name, type, tool tip, default, choices, owners.

A new key or kind of the engine becomes a property without a line here. Keys that FreeCAD's own properties fill are
named in `HOST`; names that differ from their keys' stand in `NAMES`, because saved documents hold them.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, replace
from typing import Any

from .schema import KIND, NOT_OF, Choice, JobSchema, Key, Schema, Table, without

OPERATION, PROCESS, PART, SHEET, SETUP, JOB = "operation", "process", "part", "sheet", "setup", "job"

PATHS = {
    OPERATION: ("operations",),
    PROCESS: ("process",),
    SHEET: ("setup", "sheet"),
    PART: ("part",),
    SETUP: ("setup",),
    JOB: (),
}
"""Where each section stands in the document."""

HOST = {
    OPERATION: {"id", "tool", "faces", "channel", "z_top", "z_bottom", "feeds", "spindle", "coolant", "rest_machining"},
    PROCESS: set[str](),
    SHEET: set[str](),
    PART: {"file", "faces", "units"},
    SETUP: {"up", "rotation", "chuck", "zero", "wcs", "clearance", "retract", "sheet"},
    JOB: {
        "schema",
        "title",
        "units",
        "part",
        "setup",
        "process",
        "tools",
        "operations",
        "machine",
        "machines",
        "output",
    },
}
"""Keys that follow from FreeCAD's own: label, tool controller, base geometry, depths, heights, feeds, coolant, model. Channels
and what operations before left are none of them: an operation there is one program."""

NAMES = {
    (OPERATION, KIND): "Strategy",
    (PROCESS, KIND): "Process",
    (PART, "tolerance"): "ModelTolerance",
    (JOB, "accept"): "AcceptedRisks",
}
"""Properties whose name is not their key's."""

PREFIXES = {SHEET: "Sheet"}

LENGTH, DISTANCE, ANGLE, SPEED = (
    "App::PropertyLength",
    "App::PropertyDistance",
    "App::PropertyAngle",
    "App::PropertySpeed",
)
FLOAT, INTEGER, BOOL = "App::PropertyFloat", "App::PropertyInteger", "App::PropertyBool"
TEXT, TEXTS, CHOICE = "App::PropertyString", "App::PropertyStringList", "App::PropertyEnumeration"

UNITS = {"mm": LENGTH, "deg": ANGLE, "mm/min": SPEED}
"""Types of numbers by the schema's unit."""

EXAMPLE = "x-example"
"""What the schema states of a key as an example: TOML."""

ADVANCED = "x-advanced"
"""What the schema states of a key that is rarely changed."""

TAKES_SHEET = "x-takes-sheet"
"""What the schema states of a process that works on a sheet, and of a key that is for sheets alone."""

SECONDS = 60.0
"""FreeCAD's speeds are mm/s, the document's mm/min."""


class FieldError(ValueError):
    """A property whose value is none for its key; the message names it."""


@dataclass(frozen=True)
class Range:
    """The least and the greatest value of a number, in the schema's unit."""

    low: float
    high: float
    is_open: bool
    """Whether the least value itself is none."""

    def holds(self, value: float) -> bool:
        """Whether a value lies in it."""
        return self.low <= value <= self.high and not (self.is_open and value == self.low)

    def in_words(self, unit: str) -> str:
        """The range as text: `above 0 to 100 mm`."""
        above = "above " if self.is_open else ""
        return f"{above}{self.low:g} to {self.high:g} {unit}".rstrip()


@dataclass(frozen=True)
class Field:
    """A property and the key of the job document that it fills."""

    name: str
    type: str
    section: str
    key: str
    text: str
    """The tool tip."""
    default: Any = None
    """In the document's units; None: what FreeCAD gives a new property."""
    choices: tuple[str, ...] = ()
    """Words of an enumeration; an empty one stands for a key that is left out."""
    kinds: tuple[str, ...] | None = None
    """Kinds of the section that own the key; None: all."""
    variant: str = ""
    """The value is a table with this one key: `step = { height = 0.5 }`."""
    optional: bool = False
    """0, or nothing, leaves the key out."""
    is_json: bool = False
    """A text that holds the value as JSON."""
    is_advanced: bool = False
    """Rarely changed."""
    takes_sheet: bool = False
    """For sheets alone."""
    range: Range | None = None
    """Of a number."""
    unit: str = ""
    """The schema's unit; empty for words and pure numbers."""
    words: tuple[Choice, ...] = ()
    """What an enumeration, or the items of a list, may be, with what each means."""

    @property
    def title(self) -> str:
        """Its name as words: `Sheet max wall angle`."""
        return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", self.name).capitalize()

    def is_of(self, kind: str) -> bool:
        """Whether a kind of its section owns the key."""
        return self.kinds is None or kind in self.kinds

    def is_at(self, where: str) -> bool:
        """Whether a path of the job document names its key: `operations[0].step`, or something inside it."""
        names = re.sub(r"\[\d+\]", "", where).split(".")
        own = [*PATHS[self.section], self.key]
        return names[: len(own)] == own

    def is_in(self, table: str) -> bool:
        """Whether its key stands in a table of the document: `operations`."""
        return PATHS[self.section][:1] == (table,)

    def document_value(self, value: Any) -> Any:
        """The key's value for a property's, None where the key is left out.

        Raises:
            FieldError: a text that is not JSON.
        """
        value = getattr(value, "Value", value)
        if self.type == TEXTS:
            value = list(value)
        if self.optional and not value:
            return None
        if self.is_json:
            value = self._parsed(value)
        if self.type == SPEED:
            value *= SECONDS
        return {self.variant: value} if self.variant else value

    def property_value(self, value: Any) -> Any:
        """The property's value for a key's."""
        if self.variant:
            value = value[self.variant]
        if self.is_json:
            return json.dumps(value)
        return value / SECONDS if self.type == SPEED else value

    def _parsed(self, text: str) -> Any:
        try:
            return json.loads(text)
        except ValueError as error:
            raise FieldError(f"{self.name} is not JSON ({error}): {text!r}") from error


def fields_of(schema: JobSchema, kind: str = "") -> tuple[Field, ...]:
    """All properties, in the order of sections and keys; those of an operation's kind as that states them, where it is named."""
    own = schema.tables(*PATHS[OPERATION])[kind].keys if kind else {}
    found = [
        field
        for section, path in PATHS.items()
        for table in [schema.table(*path)]
        for shared in table.keys.values()
        for key in [own.get(shared.name, shared) if section == OPERATION and shared.name != KIND else shared]
        if key.name not in HOST[section]
        for field in _fields(section, table, key)
    ]
    names = [field.name for field in found]
    doubled = {name for name in names if names.count(name) > 1}
    return tuple(_told_apart(field) if field.name in doubled else field for field in found)


def kind_field(fields: tuple[Field, ...], section: str) -> Field:
    """The property that names a section's kind."""
    return next(field for field in fields if (field.section, field.key) == (section, KIND))


def _told_apart(field: Field) -> Field:
    """Keys of one name in two sections: the operation keeps it, others have their section before it."""
    if field.section == OPERATION:
        return field
    return replace(field, name=field.section.capitalize() + field.name)


def _fields(section: str, table: Table, key: Key) -> list[Field]:
    """The properties of a key: one, or one a variant of an either-or."""
    entry = key.entry
    variants = _variants(entry)
    if not variants:
        type_, is_json = _type(key)
        return [_field(section, key, type_, is_json=is_json)]
    optional = len(variants) > 1 or key.nullable  # one of several is stated, and a single one that is required always
    found = []
    for number, (variant, value) in enumerate(variants.items()):
        merged = {"x-unit": entry.get("x-unit", ""), **value}
        name = _name(section, key.name) + ("" if number == 0 else _camel(variant))
        is_list = value["type"] == "array"
        texts = (entry, value) if number else (entry,)
        about = [str(one["description"]) for one in texts if "description" in one]
        found.append(
            Field(
                name,
                TEXT if is_list else _number_type(merged),
                section,
                key.name,
                _text("\n".join(about), merged, optional=optional, is_json=is_list),
                _first_of(_default(key), variant),
                kinds=without(value.get(NOT_OF, ()), key.kinds, table.kinds),
                variant=variant,
                optional=optional,
                is_json=is_list,
                is_advanced=bool(entry.get(ADVANCED)),
                takes_sheet=bool(entry.get(TAKES_SHEET)),
                range=None if is_list else _range(merged),
                unit=_unit(merged),
            )
        )
    return found


def _field(section: str, key: Key, type_: str, *, is_json: bool) -> Field:
    entry = key.entry
    words = tuple(choice.word for choice in key.choices)
    if words and key.nullable:
        words = ("", *words)
    optional = key.nullable or is_json or type_ == TEXTS
    return Field(
        _name(section, key.name),
        type_,
        section,
        key.name,
        _text(entry.get("description", ""), entry, optional=optional, is_json=is_json),
        _default(key),
        words,
        key.kinds,
        optional=optional,
        is_json=is_json,
        is_advanced=bool(entry.get(ADVANCED)),
        takes_sheet=bool(entry.get(TAKES_SHEET)),
        range=_range(entry),
        unit=_unit(entry),
        words=key.choices or key.item_choices,
    )


def _default(key: Key) -> Any:
    """What a new operation starts with: the default; of a key that must be given, the engine's example."""
    example = key.entry.get(EXAMPLE)
    if key.has_default or not key.required or example is None:
        return key.entry.get("default")
    return _number_in(example)


def _number_in(example: str) -> Any:
    """A number, or a table with one, as TOML writes it; Python 3.10 reads no TOML. None for anything else."""
    table = re.fullmatch(r"\{ *([\w-]+) *= *(\S+) *\}", example)
    try:
        return {table[1]: float(table[2])} if table else float(example)
    except ValueError:
        return None


def _first_of(default: Any, variant: str) -> Any:
    return default if isinstance(default, dict) and variant in default else None


def _variants(entry: Schema) -> dict[str, Schema]:
    """An either-or of tables with one number, or one list of numbers, each: its keys, and their schemas."""
    found: dict[str, Schema] = {}
    for one in entry.get("oneOf", ()):
        properties = one.get("properties", {})
        if len(properties) != 1:
            return {}
        ((name, value),) = properties.items()
        if "number" not in (value.get("type"), value.get("items", {}).get("type")):
            return {}
        found[name] = {**{key: one[key] for key in ("x-unit", "description", NOT_OF) if key in one}, **value}
    return found


def _type(key: Key) -> tuple[str, bool]:
    """The property's type, and whether it is a text that holds JSON."""
    entry = key.entry
    if key.choices:
        return CHOICE, False
    stated = entry.get("type")
    if stated == "number":
        return _number_type(entry), False
    plain = {"integer": INTEGER, "string": TEXT}
    if not key.nullable:
        plain["boolean"] = BOOL
    if isinstance(stated, str) and stated in plain:
        return plain[stated], False
    if stated == "array" and ("$ref" in entry["items"] or entry["items"].get("type") == "string"):
        return TEXTS, False
    return TEXT, True


def _number_type(entry: Schema) -> str:
    type_ = UNITS.get(entry.get("x-unit", ""), FLOAT)
    return DISTANCE if type_ == LENGTH and _lowest(entry) < 0.0 else type_


def _lowest(entry: Schema) -> float:
    """The least value of a length: whether its property may be negative depends on it, so it is never assumed."""
    low = entry.get("exclusiveMinimum", entry.get("minimum"))
    if low is None:
        what = entry.get("description") or json.dumps(entry)
        raise FieldError(f"a length without a minimum in the job schema ({what}): state its range in the engine's key")
    return float(low)


def _range(entry: Schema) -> Range | None:
    low = entry.get("exclusiveMinimum", entry.get("minimum"))
    if low is None or "maximum" not in entry:
        return None
    return Range(float(low), float(entry["maximum"]), "exclusiveMinimum" in entry)


def _unit(entry: Schema) -> str:
    unit = str(entry.get("x-unit", ""))
    return "" if unit == "1" else unit


def _text(description: str, entry: Schema, *, optional: bool = False, is_json: bool = False) -> str:
    """The tool tip: what it is, its range, its form, its words."""
    lines = [description]
    allowed = _range(entry)
    if allowed:
        lines.append(f"Range: {allowed.in_words(_unit(entry))}")
    if is_json:
        lines.append("As JSON")
    if optional:
        lines.append("0 or empty: not stated")
    lines += [f"{word['const']}: {word.get('description', '')}" for word in entry.get("oneOf", ()) if "const" in word]
    return "\n".join(line for line in lines if line)


def _name(section: str, key: str) -> str:
    return NAMES.get((section, key)) or PREFIXES.get(section, "") + _camel(key.removesuffix("_deg"))


def _camel(key: str) -> str:
    return "".join(word.capitalize() for word in key.replace("-", "_").split("_"))
