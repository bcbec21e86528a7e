"""What is no array of the right kind is answered by one line that names it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import styluscam as sc

CORNERS = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0]]
PART = sc.Part.from_mesh(CORNERS, [[0, 1, 2]])
TOOL = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 6.0}})

BAD: dict[str, tuple[str, Callable[[], object]]] = {
    "no vertices": ("no triangle", lambda: sc.Part.from_mesh([], [])),
    "flat vertices": ("vertices", lambda: sc.Part.from_mesh(np.ravel(CORNERS), [[0, 1, 2]])),
    "plan only": ("vertices", lambda: sc.Part.from_mesh([[0.0, 0.0]], [[0, 0, 0]])),
    "text": ("vertices", lambda: sc.Part.from_mesh("abc", [[0, 1, 2]])),
    "ragged": ("vertices", lambda: sc.Part.from_mesh([[0, 0], [1]], [[0, 1, 2]])),
    "complex": ("vertices", lambda: sc.Part.from_mesh(np.array(CORNERS) + 1j, [[0, 1, 2]])),
    "nothing": ("vertices", lambda: sc.Part.from_mesh(None, [[0, 1, 2]])),
    "one triangle": ("triangles", lambda: sc.Part.from_mesh(CORNERS, [0, 1, 2])),
    "broken indices": ("triangles", lambda: sc.Part.from_mesh(CORNERS, [[0.7, 1.2, 2.0]])),
    "no index": ("triangles", lambda: sc.Part.from_mesh(CORNERS, [[0, 1, np.nan]])),
    "huge index": ("triangles", lambda: sc.Part.from_mesh(CORNERS, [[0, 1, 2**70]])),
    "index beyond": ("vertex 3", lambda: sc.Part.from_mesh(CORNERS, [[0, 1, 3]])),
    "normals": ("normals", lambda: sc.Part.from_mesh(CORNERS, [[0, 1, 2]], normals=np.zeros((3, 3)))),
    "ids": ("face_ids", lambda: sc.Part.from_mesh(CORNERS, [[0, 1, 2]], face_ids=[[1]])),
    "positions in space": ("xy", lambda: sc.drop_cutter(PART, TOOL, [[1.0, 2.0, 3.0]])),
    "no position": ("xy", lambda: sc.drop_cutter(PART, TOOL, [[np.nan, 2.0]])),
    "a position beyond everything": ("xy", lambda: sc.drop_cutter(PART, TOOL, [[1e39, 2.0]])),
    "directions": ("directions", lambda: sc.push_cutter(PART, TOOL, [[1.0, 2.0]], [[1.0]], 0.0)),
    "a height beyond everything": ("z", lambda: sc.push_cutter(PART, TOOL, [[1.0, 2.0]], [[1.0, 0.0]], 1e300)),
    "table of heights": ("heights", lambda: sc.waterlines(PART, TOOL, [[1.0, 2.0]])),
    "complex heights": ("heights", lambda: sc.waterlines(PART, TOOL, [1j])),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arrays_are_named(name: str) -> None:
    word, call = BAD[name]
    with pytest.raises(sc.GeometryError, match=word) as caught:
        call()
    assert "\n" not in str(caught.value)
    assert caught.value.code


def test_no_positions_have_no_tips() -> None:
    assert sc.drop_cutter(PART, TOOL, []).shape == (0,)


def test_a_sheet_may_come_from_numpy() -> None:
    sheet = {"thickness": np.float32(1.0), "law": "constant", "model_face": "back"}
    assert sc.drop_cutter(PART, TOOL, [[3.0, 3.0]], sheet)[0] == pytest.approx(1.0)
