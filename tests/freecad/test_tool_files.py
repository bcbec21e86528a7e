"""Tool bit files: ours load in FreeCAD with exact numbers, and FreeCAD's are tools of ours."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path
from typing import Any

import pytest
from freecad_host import INSIDE, FreeCad

import styluscam as sc
from styluscam.tools import starters

pytestmark = [pytest.mark.world, pytest.mark.freecad]

ODD = 3.175 + 1e-11
"""A diameter that no rounding leaves as it is."""


def documents() -> dict[str, dict[str, Any]]:
    found = {kind: starters.starter(kind) for kind in starters.profiles()}
    found["odd"] = {"profile": {"kind": "ball", "diameter": ODD}, "shank_diameter": 4.0 / 3.0, "length": 100.0 / 3.0}
    found["tip-flat"] = {"profile": {"kind": "clothoid", "diameter": 10.0, "tip_flat": 1.0}}
    return found


@pytest.fixture(scope="module")
def loaded(freecad: FreeCad) -> dict[str, dict[str, Any]]:
    """What FreeCAD reads in the files, by name; `freecad` and `ours` hold the files that it and we wrote."""
    folder = freecad.folder / "bits"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, document in documents().items():
        sc.Tool.from_dict({**document, "title": f"Bit {name}"}).write(folder / f"{name}.fctb")
    done = freecad.run(INSIDE / "tool_files.py", "--", str(folder))
    lines = [line.removeprefix("RESULT ") for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    assert lines, done.stdout[-3000:] + done.stderr[-3000:]
    return {name: {**seen, "folder": folder} for name, seen in (json.loads(line) for line in lines)}


@pytest.mark.parametrize("name", sorted(documents()))
def test_our_file_loads_exactly(loaded: dict[str, dict[str, Any]], name: str) -> None:
    seen, tool = loaded[name], sc.Tool.from_dict(documents()[name])
    assert "broke" not in seen, seen["broke"]
    assert seen["kind"] == "stylus" and seen["label"] == f"Bit {name}"
    diameter, height, length, shank = seen["lengths"]
    assert diameter == pytest.approx(tool.diameter, abs=1e-9)
    assert height == pytest.approx(float(tool.height_at(tool.max_slope)), abs=1e-9)
    assert seen["document"]["profile"] == tool.to_dict()["profile"]
    assert seen["valid"]
    wide = max(diameter, shank)
    assert seen["box"] == pytest.approx([wide, wide, 0.0, length], abs=1e-6)
    assert 0.0 < seen["volume"] < 3.1416 * wide**2 / 4.0 * length


@pytest.mark.parametrize("name", sorted(documents()))
def test_the_solid_is_the_profile_revolved(loaded: dict[str, dict[str, Any]], name: str) -> None:
    seen = loaded[name]
    assert "broke" not in seen, seen["broke"]
    assert seen["distance"] <= 1e-5
    diameter, height, length, shank = seen["lengths"]
    cone = max(0.0, shank - diameter) / 2.0
    above = math.pi * cone / 3.0 * (shank**2 + shank * diameter + diameter**2) / 4.0
    shaft = math.pi * shank**2 / 4.0 * (length - height - cone)
    assert seen["volume"] == pytest.approx(seen["tip volume"] + above + shaft, rel=1e-7)


@pytest.mark.parametrize("name", sorted(documents()))
def test_numbers_survive_freecad_s_rounding(loaded: dict[str, dict[str, Any]], name: str) -> None:
    seen, tool = loaded[name], sc.Tool.from_dict(documents()[name])
    assert "broke" not in seen, seen["broke"]
    assert seen["again"]["document"]["profile"] == tool.to_dict()["profile"]
    for writer in ("freecad", "ours"):
        read = sc.Tool.read(Path(seen["folder"]) / f"{name}.{writer}.fctb")
        document = tool.to_dict()
        assert {key: read.to_dict()[key] for key in document} == document, writer
        assert read.title == f"Bit {name}"


def test_all_bits_were_tried(loaded: dict[str, dict[str, Any]]) -> None:
    assert set(loaded) == set(documents())
