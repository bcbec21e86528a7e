"""The keys of a tool as the engine's schema has them, and their values as texts, without FreeCAD."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from freecad_host import addon_module

import styluscam as sc
from styluscam.tools import starters

schema = addon_module("schema")
tool_keys = addon_module("tool_keys")


def tables(document: dict[str, Any] | None = None) -> dict[str, Any]:
    found = tool_keys.tables_of(schema.JobSchema(document or sc.job_schema()))
    return {table.name: table for table in found}


def test_tables_are_those_of_a_tool() -> None:
    found = tables()
    assert list(found) == ["profile", "base", "holder", ""]
    assert [kind.word for kind in found["profile"].kinds] == list(starters.profiles())
    assert found["profile"].required and not found["base"].required
    assert {key.path for key in found[""].keys[""]} == {"length", "shank_diameter", "flutes", "cutter_material"}


def test_a_new_kind_and_a_range_need_no_line_here() -> None:
    document = copy.deepcopy(sc.job_schema())
    width = {"type": "number", "x-unit": "mm", "description": "How wide.", "exclusiveMinimum": 0, "maximum": 9}
    document["$defs"]["ProfileDocument"]["oneOf"].append(
        {"properties": {"kind": {"const": "odd"}, "width": width}, "required": ["kind", "width"], "description": "Odd."}
    )
    (key,) = tables(document)["profile"].keys["odd"]
    assert (key.path, key.label, key.type, key.unit, key.required) == ("profile.width", "Width", "number", "mm", True)
    assert key.text == "How wide.\nRange: above 0 to 9 mm"


def test_texts_hold_the_values_exactly() -> None:
    profile = tables()["profile"]
    tried = set()
    for kind, document in starters.profiles().items():
        for key in profile.keys[kind]:
            if key.name in document and key.type != tool_keys.NUMBER:
                tried.add(key.type)
                assert tool_keys.value_of(key, tool_keys.text_of(key, document[key.name])) == document[key.name]
    assert tried == {tool_keys.TEXT, tool_keys.LIST, tool_keys.POINTS, tool_keys.NAMED}


@pytest.mark.parametrize(
    ("kind", "name", "text", "message"),
    [
        ("points", "points", "0, 0\n1 2 3", "line 2: '1 2 3': 2 numbers are expected"),
        ("formula", "t", "0", "t: '0': 2 numbers are expected"),
        ("formula", "parameters", "a = 1, b", "'b': a name and a number are expected"),
        ("formula", "parameters", "1 = 2", "'1 = 2': a name and a number are expected"),
    ],
)
def test_texts_that_hold_no_value(kind: str, name: str, text: str, message: str) -> None:
    key = next(key for key in tables()["profile"].keys[kind] if key.name == name)
    with pytest.raises(tool_keys.ValueTextError, match=message.replace("[", r"\[")) as caught:
        tool_keys.value_of(key, text)
    assert caught.value.where == f"profile.{name}"


def test_nothing_is_left_out() -> None:
    key = next(key for key in tables()["profile"].keys["formula"] if key.name == "z")
    assert tool_keys.value_of(key, "  ") is None
    assert tool_keys.text_of(key, None) == ""


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"profile": {"kind": "ball", "diameter": -1}}, "profile.diameter"),
    ({"profile": {"kind": "ball"}}, "profile.diameter"),
    ({"profile": {"kind": "bull-nose", "diameter": 10, "corner_radius": 7}}, "profile.corner_radius"),
    ({"profile": {"kind": "points", "points": [[0, 0], [1, 1], [2, 1.1]]}}, "profile.points"),
    ({"profile": {"kind": "formula", "z": "r^", "diameter": 10}}, "profile.z"),
    ({"profile": {"kind": "ball", "diameter": 10}, "base": {"kind": "tangent", "height": -1}}, "base.height"),
    ({"profile": {"kind": "ball", "diameter": 10}, "base": {"kind": "tangent", "height": 1}}, "base.kind"),
    ({"profile": {"kind": "ball", "diameter": 10}, "length": 2}, "length"),
    ({"profile": {"kind": "clothoid"}}, ""),
]


@pytest.mark.parametrize(("document", "path"), WRONG)
def test_errors_of_the_engine_name_a_key(document: dict[str, Any], path: str) -> None:
    paths = [key.path for table in tables().values() for keys in table.keys.values() for key in keys]
    with pytest.raises(sc.ToolError) as caught:
        sc.Tool.from_dict(document)
    assert tool_keys.concerned(caught.value.where, str(caught.value), [*paths, "base.kind"]) == path
