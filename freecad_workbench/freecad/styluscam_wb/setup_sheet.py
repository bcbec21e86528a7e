# SPDX-License-Identifier: LGPL-2.1-or-later
"""The operation's properties in a job's setup sheet: what a shop sets there, new operations begin with."""

from __future__ import annotations

from typing import Any

from Path.Base import SetupSheet
from Path.Base.SetupSheetOpPrototype import OpPrototype

from . import engine, properties
from .fields import CHOICE, OPERATION, Field, kind_field

NAME = "Stylus"
"""The name of all operations of ours in a setup sheet, whatever their kind; documents hold it."""


def property_names() -> list[str]:
    """Properties that a setup sheet may set; none where there is no engine to name them.

    The kind is none of them: the command that makes an operation decides it.
    """
    if not engine.is_there():
        return []
    kind = kind_field(properties.fields(), OPERATION)
    return [field.name for field in _fields() if field != kind]


def stated(job: Any) -> set[str]:
    """Properties that a job's setup sheet sets."""
    return {name for name in property_names() if hasattr(job.SetupSheet, SetupSheet.OpPropertyName(NAME, name))}


def register() -> None:
    """Makes setup sheets know the operation."""
    SetupSheet.RegisterOperation(NAME, _prototype, property_names)


def _fields() -> list[Field]:
    """Properties of the types that CAM's setup sheets know; speeds are none of them in FreeCAD 1.0 and 1.1."""
    return [field for field in properties.fields() if field.type in OpPrototype.PropertyType]


def _prototype(name: str, obj: Any, parentJob: Any = None) -> Any:
    """Fills CAM's stand-in for an operation, which knows `addProperty` and little else."""
    for field in _fields():
        obj.addProperty(field.type, field.name, properties.GROUP, field.text)
        if field.type == CHOICE:
            setattr(obj, field.name, list(field.choices))
    return obj
