"""From FreeCAD's shapes to the engine's part."""

from __future__ import annotations

from typing import Any

import pytest
from freecad_host import STEP

from styluscam.parts.reading import read_part

pytestmark = [pytest.mark.world, pytest.mark.freecad]

SHAPES = (
    "cup",
    "cylinder",
    "cone, moved",
    "sphere",
    "torus",
    "sphere as nurbs",
    "loft",
    "extrusion",
    "revolution",
)


@pytest.mark.parametrize("name", SHAPES)
def test_the_mesh_is_the_shape(session: Any, name: str) -> None:
    seen = session["shapes"][name]
    assert seen["closed"]
    assert seen["faces"][0] == seen["faces"][1]
    inward, outward = seen["deviation"]
    assert max(inward, outward) <= 0.01
    ours, theirs = seen["volume"]
    rounding = 1e-3 * theirs  # FreeCAD integrates freeform volumes approximately
    assert theirs - inward * seen["area"] - rounding <= ours <= theirs + outward * seen["area"] + rounding
    assert seen["apart"] < 1e-6


def test_faces_are_numbered_as_in_the_file(session: Any) -> None:
    expected = [[face.kind, face.area_mm2, *face.centre] for face in read_part(STEP).faces]
    seen = session["faces"]["faces"]
    assert [face[0] for face in seen] == [face[0] for face in expected]
    for ours, theirs in zip(seen, expected, strict=True):
        assert ours[1:] == pytest.approx(theirs[1:], rel=1e-6, abs=1e-6)


def test_it_is_fine_and_fast(session: Any) -> None:
    seen = session["faces"]
    assert max(seen["deviation"]) <= 0.001
    assert seen["seconds"] < 10.0  # 1 to 2 s where nothing else runs
