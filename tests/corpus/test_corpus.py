"""The committed parts of the corpus, each through `new` and `run` in processes of their own."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import pytest
from outcomes import run_part

HERE = Path(__file__).resolve().parent
SLICE = HERE.parents[1] / "fixtures" / "corpus" / "slice"
PARTS = {part["name"]: part for part in json.loads((SLICE / "parts.json").read_text(encoding="utf-8"))}
OPTIONS = argparse.Namespace(limit=60.0, patience=3.0, keep=None, variant=[], base=True, all=False)


@pytest.mark.parametrize("name", PARTS)
def test_a_part_becomes_a_program_or_one_true_sentence(name, tmp_path):
    (row,) = run_part(PARTS[name], SLICE, tmp_path, OPTIONS)
    assert row.wrong == "", f"{row.outcome}: {row.detail} {row.kinds}"
    assert row.peak_mb < 1000
