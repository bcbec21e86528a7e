"""The gallery shows every kind of operation and process."""

from __future__ import annotations

from pathlib import Path

import pytest

import styluscam as sc

GALLERY = Path(__file__).resolve().parents[2] / "docs" / "gallery.py"


@pytest.mark.parametrize("section", ["OperationSection", "ProcessSection"])
def test_every_kind_has_a_picture(section: str) -> None:
    kinds = [one["properties"]["kind"]["const"] for one in sc.job_schema()["$defs"][section]["oneOf"]]
    text = GALLERY.read_text(encoding="utf-8")
    assert [kind for kind in kinds if f'"kind": "{kind}"' not in text] == []
