"""Stock that an earlier program left: a job on it plans, and owes, what the same operation does as the second of one job."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_pocket_operation import kinds, text_of
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


def posted(job: sc.Job) -> str:
    """Its text, in the file that it is written to."""
    text = text_of(job)
    (job.folder / job.output).write_text(text)
    return text


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
def whole(folder: Path) -> tuple[sc.Job, str]:
    """Both operations in one job."""
    asked = written(folder, "whole", document(STOCK, ROUGH, REST))
    return asked, text_of(asked)


@pytest.fixture(scope="module")
def second(folder: Path) -> tuple[sc.Job, str]:
    """The second operation in a job of its own."""
    asked = written(folder, "side-2", document(LEFT, REST))
    return asked, text_of(asked)


def test_a_job_on_what_a_program_left_plans_what_the_second_operation_does(
    whole: tuple[sc.Job, str], second: tuple[sc.Job, str]
) -> None:
    assert moves(second[1], "rest") == moves(whole[1], "rest") and len(moves(second[1], "rest")) > 100
    of_whole, of_second = (sc.plan(asked).summary()[0].operations[-1].facts for asked, _ in (whole, second))
    assert of_whole == of_second


def test_it_is_sound_and_engages_the_same(whole: tuple[sc.Job, str], second: tuple[sc.Job, str]) -> None:
    reports = [sc.verify(text, asked) for asked, text in (whole, second)]
    assert [report.findings for report in reports] == [[], []]
    one, other = (report.engagement[-1] for report in reports)
    assert one.layers == other.layers and one.angle == other.angle
    same = sc.simulate(reports[0], spacing=0.25).heights
    found = sc.simulate(reports[1], spacing=0.25)
    assert np.array_equal(found.heights, same)
    assert found.touched.any() and found.touched.mean() < 0.5
