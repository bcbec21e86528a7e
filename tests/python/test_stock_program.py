"""Stock that an earlier program left: a job on it plans, and owes, what the same operation does as the second of one job."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import kinds, text_of, whole_lines
from test_stock_body import box, stl

import styluscam as sc
from blocks import mesh

MACHINE: dict[str, Any] = {"name": "linuxcnc", "options": {"decimals": 8}}
"""So many that what is read back is what was planned."""
STOCK: dict[str, Any] = {"kind": "box", "sides": 3.0, "top": 1.0}
LEFT: dict[str, Any] = {"kind": "program", "job": "side-1.json"}
ROUGH: dict[str, Any] = {
    "id": "rough",
    "kind": "pocket",
    "tool": "mill",
    "clears": "stock",
    "step": {"height": 2.5},
    "engagement_deg": 80.0,
    "radial_stock_to_leave": 0.3,
    "axial_stock_to_leave": 0.2,
    "fit": "arcs",
    "z_bottom": 4.5,
    "spindle": {"mode": "fixed", "rpm": 8000.0},
}
REST: dict[str, Any] = ROUGH | {"id": "rest", "tool": "small", "rest_machining": True}


def document(stock: dict[str, Any], *operations: dict[str, Any], **setup: Any) -> dict[str, Any]:
    diameters = {"mill": 4.0, "small": 2.0}
    return {
        "schema": 1,
        "part": {"file": "block.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model", "stock": stock} | setup,
        "tools": {
            name: {"number": number, "profile": {"kind": "flat", "diameter": diameters[name]}}
            for number, name in enumerate(diameters, start=1)
            if any(operation["tool"] == name for operation in operations)
        },
        "operations": list(operations),
        "machine": MACHINE,
    }


def written(folder: Path, name: str, content: dict[str, Any]) -> sc.Job:
    """A job in a file."""
    (folder / f"{name}.json").write_text(json.dumps(content))
    return sc.Job.read(folder / f"{name}.json")


def posted(job: sc.Job) -> tuple[sc.Plan, str]:
    """Its plan, and its text, in the file that it is written to."""
    plan = sc.plan(job)
    (text,) = sc.post(plan).files.values()
    (job.folder / job.output).write_text(text)
    return plan, text


def moves(text: str, operation: str) -> list[str]:
    """The lines of an operation."""
    lines = text.splitlines()
    first = lines.index(f"(operation {operation}: pocket)")
    behind = lines[first + 1 :]
    return behind[: next(i for i, line in enumerate(behind) if line.startswith(("(operation", "M5", "(role none")))]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With a part, the first job and its program."""
    made = tmp_path_factory.mktemp("sides")
    vertices, triangles, _ = mesh()
    (made / "block.stl").write_text(stl(np.asarray(vertices)[np.asarray(triangles)]))
    posted(written(made, "side-1", document(STOCK, ROUGH)))
    return made


@pytest.fixture(scope="module")
def whole(folder: Path) -> tuple[sc.Plan, str]:
    """Both operations in one job."""
    return posted(written(folder, "whole", document(STOCK, ROUGH, REST)))


@pytest.fixture(scope="module")
def second(folder: Path) -> tuple[sc.Plan, str]:
    """The second operation in a job of its own."""
    return posted(written(folder, "side-2", document(LEFT, REST)))


def test_a_job_on_what_a_program_left_plans_what_the_second_operation_does(
    whole: tuple[sc.Plan, str], second: tuple[sc.Plan, str]
) -> None:
    assert moves(second[1], "rest") == moves(whole[1], "rest") and len(moves(second[1], "rest")) > 100
    of_whole, of_second = (
        [fact.value for fact in plan.summary()[0].operations[-1].facts] for plan, _ in (whole, second)
    )
    assert of_second == pytest.approx(of_whole, rel=1e-6)


def test_it_is_sound_and_engages_the_same(whole: tuple[sc.Plan, str], second: tuple[sc.Plan, str]) -> None:
    reports = [sc.verify(text, plan.job) for plan, text in (whole, second)]
    assert [report.findings for report in reports] == [[], []]
    one, other = (report.engagement[-1] for report in reports)
    assert one.figures.layers == other.figures.layers
    assert np.array_equal(one.angles_deg, other.angles_deg) and len(one.angles_deg) > 100
    same = sc.simulate(reports[0], spacing=0.25).heights
    found = sc.simulate(reports[1], spacing=0.25)
    assert np.array_equal(found.heights, same)
    assert found.touched.any() and found.touched.mean() < 0.5


def test_all_that_is_cleared_is_gone_without_asking_for_rest_machining(
    folder: Path, second: tuple[sc.Plan, str]
) -> None:
    asked = written(folder, "side-2-plain", document(LEFT, REST | {"rest_machining": False}))
    text = text_of(asked)
    assert moves(text, "rest") == moves(second[1], "rest") and kinds(asked, text.splitlines()) == set()


def test_a_text_for_what_is_left_is_found_out_on_whole_stock(folder: Path, second: tuple[sc.Plan, str]) -> None:
    """It goes down in what the first program cleared, which stands here."""
    solid = written(folder, "solid", document(STOCK, REST | {"rest_machining": False}))
    assert {"engagement", "uncleared", "steep-entry"} <= kinds(solid, second[1].splitlines())


def test_rapids_are_held_against_what_stands(folder: Path, second: tuple[sc.Plan, str]) -> None:
    """A rapid at depth through the pocket: its middle is cleared, its corners are not."""
    lines = whole_lines(second[1])
    first = next(number for number, line in enumerate(lines) if line.startswith("G1") and "Z4.5" in line)
    back = " ".join(["G0", *lines[first].split()[1:4]])
    through = [[*lines[: first + 1], f"G0 X{x} Y{y}", back, *lines[first + 1 :]] for x, y in ((10, 8), (4, 4))]
    middle, corner = (kinds(second[0].job, text) for text in through)
    assert middle == {"low-rapid"} and {"low-rapid", "rapid-into-stock"} <= corner
    solid = written(folder, "solid", document(STOCK, REST | {"rest_machining": False}))
    assert "rapid-into-stock" in kinds(solid, through[0])


def test_rounded_coordinates_are_no_material(folder: Path) -> None:
    coarse = {"machine": {"name": "grbl"}}
    posted(written(folder, "side-1-coarse", document(STOCK, ROUGH) | coarse))
    left = LEFT | {"job": "side-1-coarse.json"}
    asked = written(folder, "side-2-coarse", document(left, REST) | coarse)
    assert kinds(asked, text_of(asked).splitlines()) == set()


def test_after_both_nothing_is_left(folder: Path, second: tuple[sc.Plan, str]) -> None:
    asked = written(folder, "side-3", document(LEFT | {"job": "side-2.json"}, REST))
    with pytest.raises(sc.PlanError) as refused:
        sc.plan(asked)
    assert refused.value.code == "nothing-reached"
    assert second[0].summary()[0].stock == "what side-1.json leaves of a box, X-3 to 23, Y-3 to 19, Z0 to 7"


def test_the_earlier_job_and_its_program_are_inputs(folder: Path, second: tuple[sc.Plan, str]) -> None:
    inputs = {path.resolve() for path in second[0].job.inputs()}
    assert {(folder / name).resolve() for name in ("side-1.json", "side-1.ngc", "block.stl")} <= inputs


@pytest.mark.parametrize(
    ("stock", "setup", "where", "code"),
    [
        ({}, {"zero": [1.0, 0.0, 0.0]}, "setup.stock.job", "another-zero"),
        ({}, {"rotation": 90.0}, "setup.stock.job", "another-zero"),
        ({"job": "none.json"}, {}, None, "no-such-file"),
        ({"file": "none.ngc"}, {}, "setup.stock.file", "no-such-file"),
        ({"file": "other.ngc"}, {}, "setup.stock.job", "another-program"),
        ({"file": "unknown.ngc"}, {}, None, "read-feed-from-unknown"),
        ({"job": "itself.json"}, {}, "setup.stock.job", "conflict"),
        ({"job": "other-part.json"}, {}, "setup.stock.job", "another-part"),
        ({"job": " "}, {}, "setup.stock.job", "missing"),
        ({"file": ""}, {}, "setup.stock.file", "missing"),
    ],
)
def test_a_program_that_does_not_fit_is_refused(
    stock: dict[str, Any], setup: dict[str, Any], where: str | None, code: str, folder: Path
) -> None:
    text = (folder / "side-1.ngc").read_text()
    (folder / "other.ngc").write_text(text.replace("(operation rough:", "(operation fine:"))
    (folder / "unknown.ngc").write_text(
        text.replace("(operation rough: pocket)", "(operation rough: pocket)\nG1 X5 F100")
    )
    (folder / "smaller.stl").write_text(stl(box((0.0, 0.0, 0.0), (19.0, 16.0, 6.0))))
    other = document(STOCK, ROUGH)
    other["part"] = {"file": "smaller.stl", "units": "mm"}
    written(folder, "other-part", other)
    (folder / "other-part.ngc").write_text(text)
    with pytest.raises(sc.StylusError) as refused:
        sc.plan(written(folder, "itself", document(LEFT | stock, REST, **setup)))
    assert refused.value.code == code and refused.value.hint
    assert where is None or refused.value.where == where


@pytest.mark.parametrize(("begins", "found"), [(4.5, set()), (3.5, {"stock-above"})])
def test_what_it_took_does_not_stand_above_what_begins_there(folder: Path, begins: float, found: set[str]) -> None:
    deeper = ROUGH | {"id": "deeper", "z_top": begins, "z_bottom": 2.5}
    asked = written(folder, f"deeper-{begins}", document(LEFT, deeper))
    assert kinds(asked, text_of(asked).splitlines()) == found
