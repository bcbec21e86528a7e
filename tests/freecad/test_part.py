"""From FreeCAD's shapes to the engine's part."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from freecad_host import STEP

from styluscam.flank.rails import Rail
from styluscam.parts.reading import read_part
from styluscam.parts.ruled import ruled_faces

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


def _same(seen: Any, expected: Rail) -> None:
    degree, *columns = seen
    own = expected.columns
    assert degree == own[0]
    for ours, theirs in zip(columns, own[1:], strict=True):
        np.testing.assert_allclose(np.array(ours), theirs, rtol=0.0, atol=1e-9)


def test_edges_and_ruled_faces_are_those_of_the_file(session: Any) -> None:
    expected, seen = read_part(STEP.with_name("blade.step")), session["rails"]
    assert seen["count"] == [len(expected.edges)] * 2 == [6, 6]
    for ours, theirs, ends in zip(seen["edges"], expected.edges, seen["ends"], strict=True):
        assert theirs is not None
        _same(ours, theirs)
        at = theirs.at(np.array([0.0, 1.0]))
        assert min(np.abs(at - ends).max(), np.abs(at - ends[::-1]).max()) < 1e-9  # FreeCAD's edge of this number
    ruled = ruled_faces(expected)
    assert len(ruled) == 2 and seen["ruled"].keys() == {str(face) for face in ruled}
    for face, rails in ruled.items():
        for ours, theirs in zip(seen["ruled"][str(face)], rails, strict=True):
            _same(ours, theirs)


def test_it_is_fine_and_fast(session: Any) -> None:
    seen = session["faces"]
    assert max(seen["deviation"]) <= 0.001
    assert seen["seconds"] < 10.0  # 1 to 2 s where nothing else runs
