"""The engine's texts in the words of the panel, without FreeCAD."""

from __future__ import annotations

import pytest
from freecad_host import addon_module

import styluscam as sc

schema = addon_module("schema")
fields = addon_module("fields")
key_labels = addon_module("key_labels")

FIELDS = fields.fields_of(schema.JobSchema(sc.job_schema()))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "check the faces, z_top, z_bottom and the tool's size",
            "check the faces, Start Depth, Final Depth and the tool's size",
        ),
        ('set entry = "auto", or drill an entry_hole there', 'set Entry = "auto", or drill an Entry hole there'),
        ("a hole: operations[0].entry_hole.diameter", "a hole: operations[0].entry_hole.diameter"),
        ("raise max_feed, or lower feeds.cut", "raise Max feed, or lower the horizontal feed of the tool controller"),
        (
            "the direction of a step, e.g. of 2.0 mm; the tolerance",
            "the direction of a step, e.g. of 2.0 mm; the tolerance",
        ),
        ('the face "max_feed", file part_one.step', 'the face "max_feed", file part_one.step'),
    ],
)
def test_keys_become_labels_and_sentences_stay(text: str, expected: str) -> None:
    assert key_labels.in_labels(text, "operations[0]", FIELDS) == expected


def test_of_keys_of_one_name_that_of_the_place_is_meant() -> None:
    text = "set tolerance = 0.01"
    assert key_labels.in_labels(text, "part.tolerance", FIELDS) == "set Model tolerance = 0.01"
    assert key_labels.in_labels(text, "operations[0].tolerance", FIELDS) == "set Tolerance = 0.01"


def test_labels_are_those_of_the_users_language() -> None:
    assert key_labels.in_labels("lower max_feed", "", FIELDS, str.upper) == "lower MAX FEED"
