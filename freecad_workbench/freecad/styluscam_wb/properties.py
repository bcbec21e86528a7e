# SPDX-License-Identifier: LGPL-2.1-or-later
"""The engine's fields as properties of a FreeCAD operation: added, kept up to date, shown where they apply, read."""

from __future__ import annotations

from functools import lru_cache
from types import ModuleType
from typing import Any

from . import engine
from .fields import (
    CHOICE,
    JOB,
    OPERATION,
    PATHS,
    PROCESS,
    SHEET,
    TAKES_SHEET,
    Field,
    FieldError,
    fields_of,
    kind_field,
)
from .schema import KIND, Choice, JobSchema

GROUP = "Stylus"
"""The group of the property editor."""

SHOWN, HIDDEN = (0, []), (2, ["Hidden"])
"""FreeCAD's modes of the property editor: as they are set, and as they are read."""


class PropertyError(ValueError):
    """A property that cannot be added or read; the message names operation and property."""


def schema() -> JobSchema:
    """The engine's job schema.

    Raises:
        EngineMissingError: there is no engine.
    """
    return _read(engine.styluscam())[0]


def fields() -> tuple[Field, ...]:
    """All fields.

    Raises:
        EngineMissingError: there is no engine.
    """
    return _read(engine.styluscam())[1]


@lru_cache(maxsize=1)
def _read(styluscam: ModuleType) -> tuple[JobSchema, tuple[Field, ...]]:
    """Schema and fields of an engine: read once a session."""
    found = JobSchema(styluscam.job_schema())
    return found, fields_of(found)


def update(obj: Any) -> None:
    """Adds what is missing, with the engine's defaults, and brings choices up to date; values stay.

    Raises:
        PropertyError: FreeCAD has a property of that name itself.
    """
    for field in fields():
        is_new = not hasattr(obj, field.name)
        if is_new:
            obj.addProperty(field.type, field.name, GROUP, field.text)
        elif obj.getGroupOfProperty(field.name) != GROUP:
            raise PropertyError(f"{obj.Label}: the engine's key {field.key} needs a name of its own in the addon")
        if field.type == CHOICE:
            _set_choices(obj, field)
        if is_new and field.default is not None:
            setattr(obj, field.name, field.property_value(field.default))
    show_owned(obj)


def _set_choices(obj: Any, field: Field) -> None:
    """The engine's words, and the operation's own where a later version knew more: the engine refuses it by name."""
    known = obj.getEnumerationsOfProperty(field.name)
    value = str(getattr(obj, field.name)) if known else ""
    choices = list(field.choices)
    if known and value not in choices:
        choices.append(value)
    if known == choices:
        return
    setattr(obj, field.name, choices)
    if known:
        setattr(obj, field.name, value)


def show_owned(obj: Any) -> None:
    """Hides the properties of other kinds, and the sheet's where the process takes none."""
    if not engine.is_there():
        return
    if not are_complete(obj):
        return  # its properties are being added
    for field in fields():
        mode, words = SHOWN if is_shown(obj, field) else HIDDEN
        if list(obj.getEditorMode(field.name)) != words:
            obj.setEditorMode(field.name, mode)


def is_shown(obj: Any, field: Field) -> bool:
    """Whether a field applies to the operation as it stands: to its kind, its process and whether that takes a sheet."""
    kinds = _kinds_of(obj, fields())
    return field.is_of(kinds.get(field.section, "")) and (takes_sheet(obj) or not _is_of_sheet(field))


def is_word_shown(obj: Any, choice: Choice) -> bool:
    """Whether a word of a list applies to the operation as it stands: whether its process takes a sheet, if it is for sheets."""
    return takes_sheet(obj) or not choice.stated.get(TAKES_SHEET)


def kind_of(obj: Any) -> str:
    """The operation's kind; none while it has no properties, or there is no engine."""
    return str(getattr(obj, kind_field(fields(), OPERATION).name, "")) if engine.is_there() else ""


def are_complete(obj: Any) -> bool:
    """Whether the operation has all of the engine's properties yet."""
    return all(hasattr(obj, field.name) for field in fields())


def _is_of_sheet(field: Field) -> bool:
    return field.section == SHEET or field.takes_sheet


def kind_properties() -> tuple[str, ...]:
    """Names of the properties that decide which others apply."""
    return tuple(field.name for field in fields() if field.key == KIND)


def _kinds_of(obj: Any, known: tuple[Field, ...]) -> dict[str, str]:
    """The chosen kind of each section that has kinds."""
    return {field.section: str(getattr(obj, field.name)) for field in known if field.key == KIND}


def takes_sheet(obj: Any) -> bool:
    """Whether the operation's process works on a sheet.

    Raises:
        EngineMissingError: there is no engine.
    """
    process = getattr(obj, kind_field(fields(), PROCESS).name)
    kinds = schema().table(*PATHS[PROCESS]).kinds
    return any(kind.word == process and bool(kind.stated.get(TAKES_SHEET)) for kind in kinds)


def section(obj: Any, name: str, *keys: str) -> dict[str, Any]:
    """A section of the document, or these keys of it: what its kind owns and is not left out.

    Raises:
        PropertyError: a value that is none.
    """
    known = fields()
    kind = _kinds_of(obj, known).get(name, "")
    without_sheet = not takes_sheet(obj)
    found: dict[str, Any] = {}
    for field in known:
        if field.section != name or not field.is_of(kind) or (keys and field.key not in keys):
            continue
        if without_sheet and _is_of_sheet(field):
            continue
        try:
            value = field.document_value(getattr(obj, field.name))
        except FieldError as error:
            raise PropertyError(f"{obj.Label}: {error}") from error
        if value is not None:
            found[field.key] = {**found[field.key], **value} if field.variant and field.key in found else value
    return found


def number_in_range(obj: Any, name: str) -> float:
    """A number of an operation, in its key's unit: for what is needed before the document is read as a whole.

    Raises:
        PropertyError: its key does not allow it.
    """
    field = next(field for field in fields() if field.name == name)
    value = float(getattr(obj, name).Value)
    if field.range is not None and not field.range.holds(value):
        allowed = field.range.in_words(field.unit)
        raise PropertyError(f"{name} = {value:g} {field.unit}: allowed is {allowed}")
    return value


def of_kind(kind: str) -> dict[str, Any]:
    """What a new operation of a kind starts with where that differs from the other kinds' of the same key, by property."""
    own = fields_of(schema(), kind)
    return {
        field.name: field.property_value(theirs.default)
        for field, theirs in zip(fields(), own, strict=True)
        if theirs.default is not None and theirs.default != field.default
    }


def shared() -> tuple[str, ...]:
    """Names of the properties that all operations of one program must agree on."""
    return tuple(field.name for field in fields() if field.section not in (OPERATION, JOB))
