"""Sheets over a male die and into a female one, the whole way: the clamp frame goes down, and what is wrong is found."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from conftest import FACES

import styluscam as sc
from meridian import FIXTURES

BALL = {"kind": "ball", "diameter": 10.0}
REMARK = re.compile(r"^\(clamp frame to Z(-?[\d.]+) mm\)$")
CUPS = ("cone_cup", "vwaf", "pyramid")
MALE = {"kind": "tpif", "die": "male"}
STEP = 1.0


@lru_cache(maxsize=8)
def die(name: str) -> sc.Part:
    """A fixture part as it is, a cup turned over into a hill: its upper faces mirrored, the material still below them."""
    part = sc.Part.read(FIXTURES / f"{name}.step")
    if name not in CUPS:
        return part
    arrays = part.arrays
    assert arrays is not None
    up = arrays.normals[:, :, 2].min(axis=1) > 1e-6
    normals = arrays.normals[up] * [-1.0, -1.0, 1.0]
    return sc.Part.from_mesh(arrays.vertices * [1.0, 1.0, -1.0], arrays.triangles[up], normals, arrays.face_ids[up])


def document(faces: Any = "all", kind: str = "z-level", **sections: Any) -> dict[str, Any]:
    """A job on a sheet of 1 mm over a male die; `sections` are merged into it."""
    base: dict[str, Any] = {
        "schema": 1,
        "part": {"file": "made.stl", "units": "mm", "model_face": "back", "faces": faces},
        "setup": {"zero": "sheet-top", "sheet": {"thickness": 1.0}},
        "process": MALE,
        "tools": {"ball": {"profile": BALL}},
        "machine": {"name": "linuxcnc"},
    }
    operation = {
        "kind": kind,
        "tool": "ball",
        **({"step": {"height": STEP}} if kind != "zig-zag" else {"stepover": 2.0}),
    }
    base["operations"] = [operation | sections.pop("operation", {})]
    for name, section in sections.items():
        base[name] = base[name] | section if name in ("part", "setup") else section
    return base


def job(name: str, *, turned: bool = True, **sections: Any) -> sc.Job:
    """A job for a fixture part, turned over into a die or as it is."""
    part = die(name) if turned else sc.Part.read(FIXTURES / f"{name}.step")
    faces = "all" if turned and name in CUPS else FACES.get(name, "all")
    return sc.Job.from_dict(document(faces, **sections), part=part)


def posted(job: sc.Job) -> str:
    return sc.post(sc.plan(job)).text


def kinds(report: sc.Report, severity: str = "error") -> set[str]:
    return {finding["kind"] for finding in report.findings if finding["severity"] == severity}


@lru_cache(maxsize=1)
def cap() -> tuple[sc.Job, list[str]]:
    """The cap's job and its lines."""
    made = job("cap_r60")
    return made, posted(made).splitlines()


def remarks(lines: list[str]) -> list[tuple[int, float]]:
    found = [(number, REMARK.match(line)) for number, line in enumerate(lines)]
    return [(number, float(match[1])) for number, match in found if match]


@pytest.mark.parametrize("kind", ["z-level", "spiral"])
@pytest.mark.parametrize("name", ["cap_r60", *CUPS])
def test_over_a_male_die(name: str, kind: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made = job(name, kind=kind)
    text = posted(made)
    report = sc.verify(text, made)
    assert report.ok, report.findings
    assert not kinds(report, "warning") & {"forming-order", "punch", "missing-level"}
    heights = [z for _, z in remarks(text.splitlines())]
    assert len(heights) > 5
    assert heights == sorted(heights, reverse=True)
    assert max(a - b for a, b in zip([0.0, *heights], heights, strict=False)) < 1.3 * STEP + 0.01
    # outwards: each loop is longer than the one above it
    moves = report.program.moves
    low, high = (
        np.hypot(*moves["end"][np.abs(moves["end"][:, 2] - z) < 1e-3][:, :2].T).max() for z in (heights[-1], heights[0])
    )
    assert low > high + 5.0


@pytest.mark.parametrize("kind", ["z-level", "spiral"])
@pytest.mark.parametrize("step", [{"list": [1.0, 2.0]}, {"scallop": 0.05}])
def test_the_frame_goes_down_with_steps_of_any_kind(step: dict[str, Any], kind: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made = job("cap_r60", kind=kind, operation={"step": step})
    text = posted(made)
    heights = [z for _, z in remarks(text.splitlines())]
    assert len(heights) > 5 and heights == sorted(heights, reverse=True)
    assert not kinds(sc.verify(text, made))


@pytest.mark.parametrize("name", CUPS)
def test_into_a_female_die(name: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    made = job(name, turned=False, process={"kind": "tpif", "die": "female"})
    text = posted(made)
    assert sc.verify(text, made).ok
    assert not remarks(text.splitlines())
    spif = job(name, turned=False, process={"kind": "spif"})
    assert posted(spif) == text


def refused(**sections: Any) -> sc.StylusError:
    name, turned = sections.pop("name", "cap_r60"), sections.pop("turned", True)
    with pytest.raises(sc.StylusError) as caught:
        sc.plan(job(name, turned=turned, **sections))
    return caught.value


CLAMP = {"opening": 180.0, "height": 6.0}


@pytest.mark.parametrize(
    ("sections", "where", "hint"),
    [
        ({"process": {"kind": "spif", "die": "male"}}, "process.die", "tpif"),
        ({"process": {"kind": "tpif"}}, "process.die", ""),
        ({"process": {"kind": "tpif", "die": "split"}}, "process.die", "male"),
        (
            {"process": {"kind": "spif"}, "setup": {"fixture": {"clamp": CLAMP | {"follows": True}}}},
            "setup.fixture.clamp.follows",
            "tpif",
        ),
        ({"setup": {"fixture": {"clamp": CLAMP}}}, "setup.fixture.clamp.follows", "follows = true"),
        ({"setup": {"fixture": {"backing": {"opening": 150.0}}}}, "setup.fixture.backing", "remove"),
        ({"name": "cone_cup", "turned": False}, "operations[0].faces", "female"),
    ],
)
def test_what_no_die_can_do_is_refused(sections: dict[str, Any], where: str, hint: str) -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    error = refused(**sections)
    assert error.where == where
    assert hint in f"{error} {error.hint}"


def test_how_hollow_the_faces_are_is_measured() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    # the cup is 25 mm deep
    assert re.search(r"Z-26\.000 25\.000 mm deep", str(refused(name="cone_cup", turned=False)))


def found(lines: list[str]) -> set[str]:
    made, _ = cap()
    return kinds(sc.verify("\n".join(lines) + "\n", made))


def without(lines: list[str], first: int, last: int) -> list[str]:
    """Without the levels of these numbers, and without their remarks."""
    at = [number for number, _ in remarks(lines)]
    return lines[: at[first]] + lines[at[last] :]


def moved(lines: list[str], by: float) -> list[str]:
    at = dict(remarks(lines))
    return [f"(clamp frame to Z{at[n] + by:.3f} mm)" if n in at else line for n, line in enumerate(lines)]


def test_defects_of_the_levels_and_of_the_frame_are_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    _, lines = cap()
    plain = [line for line in lines if not REMARK.match(line)]
    assert found(lines) == set() == found(plain)
    assert "punch" in found(without(lines, 10, 13))
    assert "clamp-level" in found(moved(lines, -0.5))
    assert "clamp-level" in found(moved(lines, 1.5))


def test_levels_from_the_bottom_up_are_found() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    base = document(FACES["cap_r60"])
    base["operations"] = [base["operations"][0] | {"z_top": top, "z_bottom": top - 3.0} for top in (-9.0, -3.0)]
    made = sc.Job.from_dict(base, part=die("cap_r60"))
    report = sc.verify(posted(made), made)
    assert {"punch", "clamp-level"} <= kinds(report)


def test_the_frame_is_met_at_the_height_of_the_loop() -> None:
    pytest.importorskip("OCP", reason="needs the step extra")
    wide = {"fixture": {"clamp": {"opening": 150.0, "height": 6.0, "follows": True}}}
    made = job("cap_r60", setup=wide)
    text = posted(made)
    assert not sc.verify(text, made).findings
    reach = np.hypot(*sc.verify(text, made).program.moves["end"][:, :2].T).max() + 5.0
    narrow = {"fixture": {"clamp": {"opening": 2 * reach + 1.0, "height": 6.0, "follows": True}}}
    report = sc.verify(text, job("cap_r60", setup=narrow))
    near = [finding for finding in report.findings if finding["kind"] == "clamp-collision"]
    assert min(finding["value_mm"] for finding in near) == pytest.approx(0.5, abs=5e-3)
    assert all(finding["position"][2] < -25.0 for finding in near)
    assert "clamp-opening" in kinds(report, "warning")
