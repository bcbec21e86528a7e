"""The committed parts of the corpus, each through `new` and `run` in processes of their own; those in OPEN.md are left out."""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path

import pytest
from outcomes import run_part

HERE = Path(__file__).resolve().parent
SLICE = HERE.parents[1] / "fixtures" / "corpus" / "slice"
PARTS = {part["name"]: part for part in json.loads((SLICE / "parts.json").read_text(encoding="utf-8"))}
NOTES = HERE / "OPEN.md"
OPEN = set(re.findall(r"^- `([^`]+)`", NOTES.read_text(encoding="utf-8"), re.MULTILINE)) if NOTES.exists() else set()
OPTIONS = argparse.Namespace(limit=60.0, patience=3.0, keep=None, variant=[], base=True, all=False)


@pytest.mark.parametrize("name", [name for name in PARTS if name not in OPEN])
def test_a_part_becomes_a_program_or_one_true_sentence(name, tmp_path):
    (row,) = run_part(PARTS[name], SLICE, tmp_path, OPTIONS)
    assert row.wrong == "", f"{row.outcome}: {row.detail} {row.kinds}"
    assert row.peak_mb < 1000


def test_open_parts_are_parts():
    assert set(PARTS) >= OPEN
