"""Stock that is a body in a file: the same as stock of a kind where it has its shape, and cleared only where there is some."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
from test_pocket_operation import block, kinds, text_of, whole_lines

import styluscam as sc
from blocks import SIZE, TOP

Floats: TypeAlias = npt.NDArray[np.float64]

TOOL = 4.0
LOW, HIGH = (-1.0, -1.0, 0.0), (SIZE[0] + 1.0, SIZE[1] + 1.0, TOP + 2.0)
BOX: dict[str, Any] = {"kind": "box", "low": LOW, "high": HIGH}
BOSS = ((LOW[0], LOW[1], HIGH[2]), (8.0, HIGH[1], HIGH[2] + 4.0))
"""What a casting has over the box of the stock, at one of its ends."""


def box(low: tuple[float, ...], high: tuple[float, ...]) -> Floats:
    """The triangles of a box, (12, 3, 3)."""
    ends = np.array([low, high])
    corners = np.array([[ends[n >> k & 1, k] for k in range(3)] for n in range(8)])
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners[[corner for a, b, c, d in faces for corner in ([a, b, c], [a, c, d])]]


def cylinder(axis: tuple[float, float], radius: float, heights: tuple[float, float], sides: int) -> Floats:
    """The triangles of an upright cylinder, (4 sides, 3, 3)."""
    angles = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rim = np.array(axis) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    low, high = (np.column_stack([rim, np.full(sides, z)]) for z in heights)
    foot, head = (np.broadcast_to([*axis, z], low.shape) for z in heights)
    after = [np.roll(ring, -1, axis=0) for ring in (low, high)]
    corners = [(low, after[0], after[1]), (low, after[1], high), (head, high, after[1]), (foot, after[0], low)]
    return np.concatenate([np.stack(triangle, axis=1) for triangle in corners])


def stl(triangles: Floats) -> str:
    facets = ["".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in corners.tolist()) for corners in triangles]
    return "solid\n" + "".join(f"facet normal 0 0 0\nouter loop\n{f}endloop\nendfacet\n" for f in facets) + "endsolid\n"


def job(stock: dict[str, Any] | Floats, folder: Path, **keys: Any) -> sc.Job:
    """Roughing of the block in stock of a kind, or in a body."""
    if not isinstance(stock, dict):
        (folder / "body.stl").write_text(stl(stock))
        stock = {"kind": "mesh", "file": "body.stl"}
    operation = {"kind": "pocket", "tool": "mill", "clears": "stock", "step": {"height": 2.0}, "engagement_deg": 80.0}
    operation |= {"fit": "arcs", "spindle": {"mode": "fixed", "rpm": 8000.0}, "z_bottom": TOP - 2.0}
    document = {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model", "stock": stock},
        "tools": {"mill": {"profile": {"kind": "flat", "diameter": TOOL}}},
        "operations": [operation | keys],
        "machine": {"name": "linuxcnc"},
    }
    return sc.Job.from_dict(document, folder, part=block())


def moves(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.startswith("(stock")]


def facts(asked: sc.Job) -> dict[str, float]:
    (operation,) = sc.plan(asked).summary()[0].operations
    return {fact.fact: fact.value for fact in operation.facts}


VOID = box((1.0, 1.0, 1.0), (1.5, 1.5, 1.5))[:, ::-1]
"""A hollow within a body, where the part is solid."""


def casting() -> Floats:
    return np.concatenate([box(LOW, HIGH), box(*BOSS)])


@pytest.fixture(scope="module")
def cast(tmp_path_factory: pytest.TempPathFactory) -> tuple[sc.Job, str]:
    asked = job(casting(), tmp_path_factory.mktemp("cast"))
    return asked, text_of(asked)


@pytest.mark.parametrize("keys", [{}, {"clears": "faces"}, {"radial_stock_to_leave": 0.3, "axial_stock_to_leave": 0.2}])
def test_the_mesh_of_a_box_is_the_box(keys: dict[str, Any], tmp_path: Path) -> None:
    asked = [job(stock, tmp_path, **keys) for stock in (box(LOW, HIGH), BOX)]
    texts = [text_of(one) for one in asked]
    assert moves(texts[0]) == moves(texts[1]) and len(moves(texts[0])) > 100
    found = [sc.verify(text, one) for text, one in zip(texts, asked, strict=True)]
    assert found[0].to_dict()["findings"] == found[1].to_dict()["findings"] == []
    simulated = [sc.simulate(report, spacing=0.25).heights for report in found]
    assert np.array_equal(*simulated)


def test_the_mesh_of_a_cylinder_is_as_good_as_its_facets(tmp_path: Path) -> None:
    radius, sides = 20.0, 240
    middle, heights = (0.5 * SIZE[0], 0.5 * SIZE[1]), (0.0, TOP + 3.0)
    body = job(cylinder(middle, radius, heights, sides), tmp_path, z_bottom=TOP)
    kind = job({"kind": "cylinder", "diameter": 2.0 * radius, "top": 3.0}, tmp_path, z_bottom=TOP)
    of_facets = sides / (2.0 * np.pi) * np.sin(2.0 * np.pi / sides)
    assert facts(body)["to_be_cleared"] == pytest.approx(of_facets * facts(kind)["to_be_cleared"], rel=1e-4)
    assert kinds(body, text_of(body).splitlines()) == set()


def test_over_a_casting_only_its_boss_is_cleared(cast: tuple[sc.Job, str], tmp_path: Path) -> None:
    asked, text = cast
    assert kinds(asked, text.splitlines()) == set()
    ends = sc.read_gcode(text, "linuxcnc").moves["end"]
    above = ends[(ends[:, 2] > HIGH[2] - 1e-6) & (ends[:, 2] < BOSS[1][2] - 1e-6)]
    assert len(above) > 20 and above[:, 0].max() < BOSS[1][0] + 2.5 * TOOL
    # in a box as high it is all of that
    whole = job({"kind": "box", "low": LOW, "high": (HIGH[0], HIGH[1], BOSS[1][2])}, tmp_path)
    (over,) = [(BOSS[1][0] - LOW[0]) * (HIGH[1] - LOW[1]) / (HIGH[0] - LOW[0]) / (HIGH[1] - LOW[1])]
    of_top = facts(job(BOX, tmp_path))["to_be_cleared"]
    saved = facts(whole)["to_be_cleared"] - facts(asked)["to_be_cleared"]
    assert saved == pytest.approx((1.0 - over) * (facts(whole)["to_be_cleared"] - of_top), rel=1e-3)


def test_clearance_and_retract_count_from_the_top_of_a_body(cast: tuple[sc.Job, str]) -> None:
    ends = sc.read_gcode(cast[1], "linuxcnc").moves["end"]
    assert ends[:, 2].max() == pytest.approx(BOSS[1][2] + 10.0)
    words = f"the body in body.stl, X-1 to 21, Y-1 to 17, Z0 to {BOSS[1][2]:g}"
    assert sc.plan(cast[0]).summary()[0].stock == words and f"(stock: {words})" in cast[1]


def test_a_text_for_a_box_goes_through_the_boss_of_a_casting(cast: tuple[sc.Job, str], tmp_path: Path) -> None:
    assert {"missing-level", "low-rapid"} <= kinds(cast[0], text_of(job(BOX, tmp_path)).splitlines())
    # rapids and entries over the pocket, which lies under the boss
    folder = tmp_path / "wide"
    folder.mkdir()
    wide = np.concatenate([box(LOW, HIGH), box(BOSS[0], (HIGH[0], HIGH[1], BOSS[1][2]))])
    text = text_of(job({"kind": "box"}, tmp_path, clears="faces"))
    assert {"missing-level", "rapid-into-stock"} <= kinds(job(wide, folder, clears="faces"), text.splitlines())


def test_a_text_for_a_narrower_boss_engages_too_much_and_leaves_the_rest(
    cast: tuple[sc.Job, str], tmp_path: Path
) -> None:
    low, (right, back, top) = BOSS
    narrow = np.concatenate([box(LOW, HIGH), box(low, (right - 5.0, back, top))])
    text = text_of(job(narrow, tmp_path))
    # the body is read once: the file is another one's now
    assert {"engagement", "uncleared"} <= kinds(cast[0], text.splitlines())


def test_a_level_over_the_boss_that_is_left_out_is_found(cast: tuple[sc.Job, str]) -> None:
    level = f" Z{HIGH[2] + 2.0:.0f}"
    lines = whole_lines(cast[1])
    left = [line for line in lines if not (line.startswith(("G1", "G2", "G3")) and f"{level} " in f"{line} ")]
    assert len(left) < len(lines) - 20
    assert "missing-level" in kinds(cast[0], left)


def test_the_simulation_begins_with_the_body(cast: tuple[sc.Job, str]) -> None:
    asked, text = cast
    found = sc.simulate(sc.verify(text, asked), spacing=0.25)
    x, _ = np.meshgrid(found.x, found.y)
    expected = np.where(x < BOSS[1][0], BOSS[1][2], HIGH[2])
    beside = np.abs(x - BOSS[1][0]) > 1e-9
    assert np.array_equal(found.before[beside], expected[beside])
    assert found.touched.all() and found.heights.max() <= TOP + 0.005


def test_what_leans_is_cleared_as_wide_as_it_is_anywhere_on_a_level(tmp_path: Path) -> None:
    """A casting with drafted walls and a top that slopes: the bound holds, nothing is left."""
    corners = box(LOW, HIGH)
    upper = corners[..., 2] > HIGH[2] - 1.0
    middle = 0.5 * (np.array(LOW) + HIGH)[:2]
    corners[..., :2] = middle + np.where(upper[..., None], 1.0, 1.15) * (corners[..., :2] - middle)
    corners[..., 2] += np.where(upper, 0.05 * (corners[..., 0] + 1.3 * corners[..., 1]), 0.0)
    asked = job(corners, tmp_path)
    assert kinds(asked, text_of(asked).splitlines()) == set()


def test_the_body_moves_with_the_part(tmp_path: Path) -> None:
    turned = {"zero": [5.0, 4.0, 2.0], "rotation": 90.0}
    asked = [job(stock, tmp_path) for stock in (box(LOW, HIGH), BOX)]
    documents = [one.to_dict() for one in asked]
    documents[0]["setup"] |= turned
    # the same corners, turned and moved
    documents[1]["setup"] |= turned | {
        "stock": {"kind": "box", "low": [-22.0, -5.0, -2.0], "high": [-4.0, 17.0, HIGH[2] - 2.0]}
    }
    for document in documents:
        document["operations"][0]["z_bottom"] = TOP - 4.0
    texts = [text_of(sc.Job.from_dict(document, tmp_path, part=block())) for document in documents]
    assert moves(texts[0]) == moves(texts[1])


@pytest.mark.parametrize(
    ("body", "where", "code", "words"),
    [
        (box(LOW, HIGH)[:-2], "setup.stock.file", "not-closed", "not closed near"),
        (box((1.0, -1.0, 0.0), HIGH), "setup.stock", "conflict", "sticks out"),
        (box(LOW, (21.0, 17.0, TOP - 0.1)), "setup.stock", "conflict", "sticks out"),
        (np.concatenate([box(LOW, HIGH), VOID]), "setup.stock", "conflict", "sticks out"),
    ],
)
def test_a_body_that_is_open_or_too_small_is_refused(
    body: Floats, where: str, code: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(sc.JobError, match=words) as refused:
        sc.plan(job(body, tmp_path))
    assert (refused.value.where, refused.value.code) == (where, code) and refused.value.hint


@pytest.mark.parametrize(
    ("stock", "code"),
    [
        ({"kind": "mesh", "file": " "}, "missing"),
        ({"kind": "mesh"}, "missing"),
        ({"kind": "mesh", "file": "none.stl"}, "part-not-found"),
        ({"kind": "mesh", "file": "a.step", "units": "mm"}, "part-not-found"),
        ({"kind": "mesh", "file": "a.stl", "units": "ell"}, "unknown"),
        ({"kind": "mesh", "file": "a.stl", "top": 2.0}, "unknown"),
    ],
)
def test_a_body_that_is_not_there_is_refused(stock: dict[str, Any], code: str, tmp_path: Path) -> None:
    with pytest.raises(sc.StylusError) as refused:
        sc.plan(job(stock, tmp_path))
    assert refused.value.code == code


def test_the_body_s_file_is_an_input_of_the_job(cast: tuple[sc.Job, str]) -> None:
    assert cast[0].folder / "body.stl" in cast[0].inputs()
