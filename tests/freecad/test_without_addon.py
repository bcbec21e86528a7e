"""A document with a stylus where the addon is missing: nothing of it is lost."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from freecad_host import ADDON, INSIDE, FreeCad

import roots

pytestmark = [pytest.mark.world, pytest.mark.freecad]

DIAMETER = 7.12345678912


@pytest.fixture(scope="module")
def seen(freecad: FreeCad) -> dict[str, dict[str, Any]]:
    """The bit in three sessions: made with the addon, opened and saved without it, opened with it again."""
    folder = freecad.folder / "without-addon"
    folder.mkdir(exist_ok=True)
    found = {}
    for step in ("made", "without", "again"):
        has_addon = step != "without"
        done = roots.run_freecad(
            freecad.version,
            INSIDE / "without_addon.py",
            "--",
            step,
            str(folder),
            python_path=[freecad.engine] if has_addon else [],
            mod_path=[ADDON] if has_addon else [],
            binds=[roots.Bind.same(freecad.folder, writable=True)],
            timeout=400.0,
        )
        lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
        assert lines, done.stdout[-3000:] + done.stderr[-3000:]
        found[step] = json.loads(lines[0].removeprefix("RESULT "))
        assert "broke" not in found[step], found[step]["broke"]
    return found


def test_its_data_are_kept_without_the_addon(seen: dict[str, dict[str, Any]]) -> None:
    made, without = seen["made"], seen["without"]
    assert made["class"] != without["class"]  # FreeCAD cannot have ours
    assert json.loads(made["profile"]) == {"kind": "ball", "diameter": DIAMETER}
    for name in ("profile", "lengths", "volume"):
        assert without[name] == made[name]


def test_it_is_ours_again_with_the_addon(seen: dict[str, dict[str, Any]]) -> None:
    made, again = seen["made"], seen["again"]
    edited = again.pop("edited")
    assert again == made
    radius, length = 2.5, made["lengths"][2]
    shank = made["lengths"][3]
    assert edited["lengths"] == pytest.approx([5.0, 2.5, length, shank])
    cone = (shank - 5.0) / 2.0
    above = math.pi * cone / 12.0 * (shank**2 + shank * 5.0 + 25.0)
    shaft = math.pi * shank**2 / 4.0 * (length - radius - cone)
    assert edited["volume"] == pytest.approx(2.0 / 3.0 * math.pi * radius**3 + above + shaft, rel=1e-8)
