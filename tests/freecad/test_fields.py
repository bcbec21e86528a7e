"""The operation's properties as the engine's schema makes them, without FreeCAD."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from freecad_host import addon_module

import styluscam as sc

schema = addon_module("schema")
fields = addon_module("fields")

PERMANENT = {
    "Strategy": "App::PropertyEnumeration",
    "Step": "App::PropertyLength",
    "Stepover": "App::PropertyLength",
    "Angle": "App::PropertyAngle",
    "Direction": "App::PropertyEnumeration",
    "Tolerance": "App::PropertyLength",
    "SmallestFeature": "App::PropertyLength",
    "Process": "App::PropertyEnumeration",
    "SheetThickness": "App::PropertyLength",
    "SheetLaw": "App::PropertyEnumeration",
    "ModelFace": "App::PropertyEnumeration",
    "ModelTolerance": "App::PropertyLength",
    "AllowUndercuts": "App::PropertyBool",
    "AcceptedRisks": "App::PropertyStringList",
}
"""Saved documents hold these names and types."""

NUMBER = {"type": "number", "x-unit": "mm", "minimum": 0.0}


def by_name(document: dict[str, Any]) -> dict[str, Any]:
    found = fields.fields_of(schema.JobSchema(document))
    assert len({field.name for field in found}) == len(found)
    return {field.name: field for field in found}


def by_kind() -> dict[str, Any]:
    """A job schema whose operations are alternatives by kind."""
    document = copy.deepcopy(sc.job_schema())
    step = {"oneOf": [table({"height": {**NUMBER, "exclusiveMinimum": 0, "maximum": 100}}), table({"scallop": NUMBER})]}
    own = {
        "levels": {
            "step": {"$ref": "#/$defs/Pitch", "description": "Between levels.", "x-example": "{ height = 0.5 }"}
        },
        "rows": {
            "stepover": {**NUMBER, "x-example": "0.7"},
            "angle_deg": {"type": "number", "default": 0.0, "x-unit": "deg"},
        },
        "wild": {
            "lift": {**NUMBER, "minimum": -5.0, "maximum": 5.0, "description": "Up or down."},
            "speed": {"type": ["number", "null"], "x-unit": "mm/min"},
            "count": {"type": "integer", "default": 3},
            "twice": {"type": "boolean", "default": True},
            "note": {"type": ["string", "null"]},
            "ring": {"anyOf": [{"$ref": "#/$defs/Opening"}, {"type": "null"}], "description": "A ring."},
            "side": {"enum": ["left", "right"], "default": "right"},
            "mode": {"anyOf": [{"$ref": "#/$defs/Coolant"}, {"type": "null"}]},
        },
    }
    common = {"tool": {"type": "string"}, "tolerance": {**NUMBER, "default": 0.005}}
    document["$defs"]["Pitch"] = step
    document["$defs"]["Operation"] = {
        "description": "One operation.",
        "oneOf": [
            {
                **table({"kind": {"const": kind, "type": "string"}, **keys, **common}),
                "required": ["kind", "tool", *(key for key, entry in keys.items() if "x-example" in entry)],
                "description": f"What {kind} are.",
            }
            for kind, keys in own.items()
        ],
    }
    document["properties"]["operations"]["items"] = {"$ref": "#/$defs/Operation"}
    return document


def table(properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties), "additionalProperties": False}


def test_names_and_types_of_saved_documents_stay() -> None:
    found = by_name(sc.job_schema())
    assert {name: found[name].type for name in PERMANENT} == PERMANENT


def test_what_freecad_fills_is_no_property() -> None:
    found = by_name(sc.job_schema())
    keys = {(field.section, field.key) for field in found.values()}
    for section, key in [
        ("operation", "tool"),
        ("operation", "z_top"),
        ("setup", "zero"),
        ("part", "file"),
        ("job", "tools"),
    ]:
        assert (section, key) not in keys


def test_keys_that_mean_nothing_to_a_kind_are_not_its() -> None:
    found = by_name(sc.job_schema())
    assert not found["Lead"].is_of("pocket") and found["Lead"].is_of("z-level") and found["Lead"].is_of("zig-zag")
    assert found["Tolerance"].is_of("pocket") and found["Tolerance"].kinds is None
    document = by_kind()
    operation = document["$defs"]["Operation"]
    for alternative in operation["oneOf"]:
        alternative["properties"]["tolerance"] = {**alternative["properties"]["tolerance"], "x-not-of": ["rows"]}
    assert by_name(document)["Tolerance"].kinds == ("levels", "wild")


def test_a_form_of_a_value_that_means_nothing_to_a_kind_is_not_its() -> None:
    found = by_name(sc.job_schema())
    assert found["Step"].is_of("pocket") and found["StepList"].is_of("pocket")
    assert not found["StepScallop"].is_of("pocket")
    assert found["StepScallop"].is_of("z-level") and not found["StepScallop"].is_of("zig-zag")


def test_a_risk_states_whether_it_is_for_sheets_alone() -> None:
    words = by_name(sc.job_schema())["AcceptedRisks"].words
    assert {choice.word for choice in words if not choice.stated.get(fields.TAKES_SHEET)} == {"bridged", "unreached"}


def test_a_kind_starts_with_its_own_example() -> None:
    found = schema.JobSchema(sc.job_schema())
    own = {field.name: field.default for field in fields.fields_of(found, "pocket")}
    assert own["Step"] == {"height": 2.0}
    assert by_name(sc.job_schema())["Step"].default == {"height": 0.5}
    assert own.keys() == by_name(sc.job_schema()).keys()


def test_defaults_and_choices_are_the_engines() -> None:
    found = by_name(sc.job_schema())
    assert found["Tolerance"].default == 0.005 and found["Process"].default == "spif"
    assert found["ModelFace"].choices == ("", "tool", "back", "mid")
    assert "z-level" in found["Strategy"].choices
    assert "z-level: Loops at constant heights" in found["Strategy"].text


def test_every_key_of_every_kind_is_a_property() -> None:
    found = by_name(by_kind())
    types = {
        name: found[name].type.removeprefix("App::Property")
        for name in ("Lift", "Speed", "Count", "Twice", "Note", "Ring")
    }
    assert types == {
        "Lift": "Distance",
        "Speed": "Speed",
        "Count": "Integer",
        "Twice": "Bool",
        "Note": "String",
        "Ring": "String",
    }
    assert found["Side"].choices == ("left", "right") and found["Side"].default == "right"
    assert found["Mode"].choices == ("", "off", "flood")
    assert found["Strategy"].choices == ("levels", "rows", "wild")
    assert "wild: What wild are." in found["Strategy"].text
    assert found["Lift"].text == "Up or down.\nRange: -5 to 5 mm"
    assert "Range: above 0 to 100 mm" in found["Step"].text


def test_a_key_belongs_to_its_kinds() -> None:
    found = by_name(by_kind())
    assert found["Step"].is_of("levels") and not found["Step"].is_of("rows")
    assert all(found["Tolerance"].is_of(kind) for kind in ("levels", "rows", "wild"))
    assert found["Stepover"].kinds == ("rows",) and found["Lift"].kinds == ("wild",)


def test_a_key_that_must_be_given_begins_with_the_example() -> None:
    found = by_name(by_kind())
    assert found["Step"].property_value(found["Step"].default) == 0.5
    assert found["Stepover"].default == 0.7
    assert found["StepScallop"].default is None


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("Step", 0.25, {"height": 0.25}),
        ("StepScallop", 0.01, {"scallop": 0.01}),
        ("Step", 0.0, None),
        ("Stepover", 0.0, 0.0),
        ("Speed", 2.0, 120.0),
        ("Speed", 0.0, None),
        ("Twice", False, False),
        ("Note", "", None),
        ("Ring", "[3, 4]", [3, 4]),
        ("Mode", "", None),
        ("AcceptedRisks", ["punch"], ["punch"]),
    ],
)
def test_values_go_to_the_document(name: str, value: Any, expected: Any) -> None:
    assert by_name(by_kind())[name].document_value(value) == expected


def test_a_value_that_is_no_json_is_named() -> None:
    with pytest.raises(fields.FieldError, match="Ring is not JSON"):
        by_name(by_kind())["Ring"].document_value("[3, ")


def test_keys_of_one_name_in_two_sections_are_kept_apart() -> None:
    document = by_kind()
    document["$defs"]["PartSection"]["properties"]["lift"] = NUMBER
    found = by_name(document)
    assert (found["Lift"].section, found["PartLift"].section) == ("operation", "part")


def test_a_process_states_whether_it_takes_a_sheet() -> None:
    kinds = schema.JobSchema(sc.job_schema()).table("process").kinds
    takes = {kind.word: bool(kind.stated.get("x-takes-sheet")) for kind in kinds}
    assert takes["spif"] and not takes["milling"]


def test_a_missing_table_is_an_error() -> None:
    with pytest.raises(schema.SchemaError, match=r"no setup\.shet"):
        schema.JobSchema(sc.job_schema()).table("setup", "shet")


def test_a_length_without_a_range_is_an_error() -> None:
    document = by_kind()
    document["$defs"]["Operation"]["oneOf"][1]["properties"]["stepover"].pop("minimum")
    with pytest.raises(fields.FieldError, match="without a minimum"):
        by_name(document)
