"""The chuck above or below the sheet: the same part, hung upside down, gets the same program from below."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from test_tpif import die, document, kinds, posted

import styluscam as sc
from meridian import FIXTURES

CUP = ["Face1", "Face2", "Face3", "Face4"]
HALF = np.array([1.0, -1.0, -1.0])
"""Half a turn about X."""
FIXTURE = {"clamp": {"opening": [96.0, 94.0], "height": 6.0}, "backing": {"opening": 90.0}, "center": [0.5, 1.5]}
BOTH = {"tools": {"ball": {"profile": {"kind": "ball", "diameter": 10.0}}}}
PAIR = {
    "process": {"kind": "dsif", "support_tool": "under"},
    "tools": {**BOTH["tools"], "under": {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}}},
    "machines": {"support": {"name": "grbl"}},
    "operation": {"step": {"height": 5.0}},
}


@lru_cache(maxsize=4)
def part(name: str, *, hung: bool) -> sc.Part:
    """A cup as it is, or turned half about X: the formed faces face down."""
    found = die(name) if name == "cap_r60" else sc.Part.read(FIXTURES / f"{name}.step")
    arrays = found.arrays
    assert arrays is not None
    turn = HALF if hung else np.ones(3)
    return sc.Part.from_mesh(arrays.vertices * turn, arrays.triangles, arrays.normals * turn, arrays.face_ids)


def job(name: str, chuck: str | None, *, hung: bool, **sections: Any) -> sc.Job:
    setup = {"chuck": chuck} if chuck else {}
    faces = CUP if name == "cone_cup" else ["Face1"]
    base: dict[str, Any] = {"process": {"kind": "spif"}, **sections, "setup": {**sections.get("setup", {}), **setup}}
    if base["process"]["kind"] == "milling":
        base["operation"] = {"step": {"height": 4.0}, "spindle": {"mode": "fixed", "rpm": 8000.0}}
    made = document(faces, **{key: value for key, value in base.items() if key != "machines"})
    if base["process"]["kind"] == "milling":
        del made["setup"]["sheet"], made["part"]["model_face"]
        made["setup"]["zero"] = "model"
    if "machines" in base:
        made["machines"] = base["machines"]
    return sc.Job.from_dict(made, part=part(name, hung=hung))


def blocks(text: str) -> list[str]:
    """Without the header, which states where zero is."""
    return [line for line in text.splitlines() if not line.startswith("(")]


def is_spif(sections: dict[str, Any]) -> bool:
    return "process" not in sections


CASES: list[tuple[str, dict[str, Any]]] = [
    ("cone_cup", {"setup": {"fixture": FIXTURE}, "operation": {"step": {"height": 2.0}}}),
    ("cap_r60", {"process": {"kind": "tpif", "die": "male"}, "operation": {"step": {"height": 4.0}}}),
    ("cap_r60", {"process": {"kind": "milling"}}),
    ("cone_cup", PAIR),
]


@pytest.mark.parametrize(("name", "sections"), CASES, ids=["spif", "tpif", "milling", "dsif"])
def test_from_below_it_is_the_same_program(name: str, sections: dict[str, Any]) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    above, below = job(name, None, hung=False, **sections), job(name, "below", hung=True, **sections)
    texts = [sc.post(sc.plan(made)).files for made in (above, below)]
    assert [blocks(text) for text in texts[0].values()] == [blocks(text) for text in texts[1].values()]
    [text, *beside] = texts[1].values()
    assert "the tool comes from below" in text and "the tool comes from below" not in next(iter(texts[0].values()))
    # of a pair the other one is above then
    assert all("the tool comes from below" not in other for other in beside)
    if is_spif(sections):
        first, second = (sc.verify(text, made) for made in (above, below))
        assert first.ok and second.ok and first.findings == second.findings
        assert (first.gouge_max, first.excess_max) == (second.gouge_max, second.excess_max)


def test_z_points_down_to_the_spindle_and_y_the_other_way() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    setup = {"rotation": 90.0, "zero": [10.0, 20.0, 30.0]}
    made = job("cone_cup", "below", hung=True, setup=setup, operation={"step": {"height": 5.0}})
    box = sc.plan(made).programs["main"].setup
    # the turned part is 100 x 100 x 30 mm over Z0, its zero is at X10 Y20 Z30 there
    assert [*box.part_min, *box.part_max] == [-60.0, -30.0, 0.0, 40.0, 70.0, 30.0]


def test_a_text_for_the_other_side_is_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    below = job("cone_cup", "below", hung=True, operation={"step": {"height": 8.0}})
    text = posted(below)
    # heights of a machine whose Z points up
    swapped = [
        "".join(f"Z{-float(word[1:]):g} " if word.startswith("Z") else f"{word} " for word in line.split(" ")).strip()
        if line[:1] in "GXYZ"
        else line
        for line in text.splitlines()
    ]
    assert kinds(sc.verify("\n".join(swapped) + "\n", below))
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job("cone_cup", None, hung=True))
    assert "Face" in str(caught.value)


def test_clamp_and_backing_are_mirrored() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    low = {"clamp": {"opening": [86.0, 86.0], "height": 6.0, "follows": False}, "center": [0.0, 6.0]}
    found = {}
    for chuck, hung in ((None, False), ("below", True)):
        made = job("cone_cup", chuck, hung=hung, setup={"fixture": low}, operation={"step": {"height": 2.0}})
        found[hung] = [finding["message"] for finding in sc.verify(posted(made), made).findings]
    assert any("clamp" in message for message in found[True]) and found[True] == found[False]
