# SPDX-License-Identifier: LGPL-2.1-or-later
"""Properties set by text: LABEL.Property=value, the value as FreeCAD reads it, and never one that is lost in silence."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import FreeCAD

from .. import ops, properties
from .failures import RunError
from .objects import find, near, one_line

TRUE, FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")

UNITS_ASSUMED = ("mm", "deg")
"""A length without a unit is in mm and an angle in degrees, as FreeCAD's scripts have them; a bare speed would be mm/s."""

UNITS = (*UNITS_ASSUMED, "mm/min")
"""What messages propose."""

EQUAL = 1e-9
"""Relative: numbers that FreeCAD gives back differ in their last digits."""


@dataclass
class Change:
    """A property that was set."""

    obj: Any
    name: str
    text: str
    before: str
    value: Any
    """What FreeCAD made of the text."""
    expression: str = ""
    """What drove the property until then."""

    def record(self) -> dict[str, str]:
        """As plain data."""
        return {
            "object": self.obj.Label,
            "property": self.name,
            "value": shown(self.value),
            "before": self.before,
            "expression": self.expression,
        }


def apply(document: Any, texts: list[str]) -> list[Change]:
    """Sets the properties, in order.

    Raises:
        RunError: no such object or property, a value that is none for it, or one without effect.
    """
    changes = []
    for text in texts:
        try:
            changes.append(_set(document, text))
        except RunError as error:
            raise RunError(f"--set {text!r}: {error}") from error
    for change in changes:
        _require_effect(change)
    return changes


def require_kept(changes: list[Change]) -> None:
    """Asks after computing whether the values are still there.

    Raises:
        RunError: computing has replaced one.
    """
    last = {(change.obj.Name, change.name): change for change in changes}
    for change in last.values():
        now = getattr(change.obj, change.name)
        if not _same(now, change.value):
            raise RunError(
                f"--set {change.text!r}: computing the document has made it {shown(now)} again: "
                "set what it is computed from"
            )


def _set(document: Any, text: str) -> Change:
    target, equals, value = text.partition("=")
    label, dot, name = target.strip().rpartition(".")
    if not (equals and dot and label and name):
        raise RunError("write LABEL.Property=value, as Cup.Step=0.3")
    obj = find(document, label)
    _require_settable(obj, name)
    before = getattr(obj, name)
    wanted = _parsed(document, obj, name, value.strip())
    expression = dict(obj.ExpressionEngine).get(name, "")
    if expression:
        obj.setExpression(name, None)
    try:
        setattr(obj, name, wanted)
    except Exception as error:
        raise RunError(f"FreeCAD does not take this value: {one_line(error)}") from error
    now = getattr(obj, name)
    if not _same(now, wanted):
        raise RunError(f"FreeCAD makes {shown(now)} of it: the property does not take {value.strip()}")
    return Change(obj, name, text, shown(before), now, expression)


def _require_settable(obj: Any, name: str) -> None:
    if name not in obj.PropertiesList:
        raise RunError(f"{obj.Label} has no property {name!r}: {near(name, obj.PropertiesList)}")
    if "ReadOnly" in obj.getEditorMode(name):
        raise RunError(f"{obj.Label}.{name} is computed by FreeCAD and cannot be set")


def _parsed(document: Any, obj: Any, name: str, text: str) -> Any:
    """A text as a value of a property's type."""
    kind = obj.getTypeIdOfProperty(name).removeprefix("App::Property")
    current = getattr(obj, name)
    if isinstance(current, FreeCAD.Units.Quantity):
        return _quantity(text, current)
    if kind == "Enumeration":
        return _choice(text, obj.getEnumerationsOfProperty(name))
    if name == "ToolController":
        return _controller(document, text)
    parser = PARSERS.get(kind)
    if parser is None:
        raise RunError(f"{obj.Label}.{name} cannot be set from a text ({kind}): set it in FreeCAD")
    return parser(text)


def _controller(document: Any, text: str) -> Any:
    found = find(document, text)
    if not {"Tool", "ToolNumber"} <= set(found.PropertiesList):
        raise RunError(f"{found.Label} is no tool controller")
    return found


def _quantity(text: str, current: Any) -> Any:
    try:
        found = FreeCAD.Units.Quantity(text)
    except Exception as error:
        raise RunError(
            f"{text!r} is no quantity ({one_line(error)}): write a number and a unit, as '0.3 mm'"
        ) from error
    if not text or not math.isfinite(found.Value):
        raise RunError(f"{text!r} is no quantity: write a number and a unit, as '0.3 mm'")
    if found.Unit == current.Unit:
        return found
    unit = _unit(current)
    if found.Unit != FreeCAD.Units.Unit():
        raise RunError(f"{text} is of another kind than the property: it takes {unit or 'a number without a unit'}")
    if unit not in UNITS_ASSUMED:
        raise RunError(f"{text} has no unit: write {text} {unit}")
    return FreeCAD.Units.Quantity(found.Value, current.Unit)


def _unit(quantity: Any) -> str:
    """The unit in which a person gives such a quantity."""
    for unit in UNITS:
        if FreeCAD.Units.Quantity(1.0, unit).Unit == quantity.Unit:
            return unit
    return str(quantity.getUserPreferred()[2])


def _switch(text: str) -> bool:
    if text.lower() in (*TRUE, *FALSE):
        return text.lower() in TRUE
    raise RunError(f"{text!r} is neither true nor false")


def _number(text: str) -> float:
    try:
        found = float(text)
    except ValueError:
        found = math.nan
    if not math.isfinite(found):
        raise RunError(f"{text!r} is no number")
    return found


def _whole(text: str) -> int:
    found = _number(text)
    if found != round(found):
        raise RunError(f"{text!r} is no whole number")
    return int(found)


def _choice(text: str, choices: list[str]) -> str:
    if text not in choices:
        raise RunError(f"{text!r} is none of its choices: {near(text, choices, shown=20)}")
    return text


def _words(text: str) -> list[str]:
    """A JSON list, or words with commas."""
    if not text.startswith("["):
        return [word.strip() for word in text.split(",") if word.strip()]
    try:
        found = json.loads(text)
    except ValueError as error:
        raise RunError(f"{text!r} is no JSON list: {error}") from error
    if not all(isinstance(word, str) for word in found):
        raise RunError(f"{text!r} is no list of texts")
    return list(found)


PARSERS: dict[str, Callable[[str], Any]] = {
    "Bool": _switch,
    **dict.fromkeys(("Integer", "IntegerConstraint", "Percent"), _whole),
    **dict.fromkeys(("Float", "FloatConstraint", "Precision"), _number),
    **dict.fromkeys(("String", "File", "Path", "Font"), str),
    "StringList": _words,
}
"""By the type of the property, where its value is no quantity."""


def _require_effect(change: Change) -> None:
    """A property that the chosen kind does not own is not sent to the engine."""
    if not ops.is_ours(change.obj):
        return
    for field in properties.fields():
        if field.name == change.name and not properties.is_shown(change.obj, field):
            strategy = f"{change.obj.Strategy} in {change.obj.Process}"
            raise RunError(f"--set {change.text!r}: it has no effect: {strategy} has no {change.name}")


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, FreeCAD.Units.Quantity) and isinstance(other, FreeCAD.Units.Quantity):
        one, other = one.Value, other.Value
    if isinstance(one, float) and isinstance(other, float | int):
        return math.isclose(one, other, rel_tol=EQUAL, abs_tol=EQUAL)
    return bool(one == other)


def shown(value: Any) -> str:
    """A property's value as text: exact numbers with FreeCAD's units, objects by their labels."""
    if isinstance(value, FreeCAD.Units.Quantity):
        return str(value)
    if isinstance(value, list):
        return ", ".join(str(each) for each in value)
    return str(getattr(value, "Label", value))
