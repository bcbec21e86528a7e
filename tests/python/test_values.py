"""What the public classes are as values: what they say of themselves, when two are equal, and that they travel to workers."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
import pydoc
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import in_workers
import numpy as np
import pytest
from conftest import milling_document

import styluscam as sc
from styluscam.programs.running import ChannelResult

BALL = {"kind": "ball", "diameter": 6.0}
CUBE = ([[x, y, z] for z in (-5.0, 0.0) for y in (0.0, 8.0) for x in (0.0, 10.0)],
        [[0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6],
         [4, 5, 7], [4, 7, 6], [0, 3, 1], [0, 2, 3]])  # fmt: skip
LONGEST = 160
"""Characters of a value's text."""


def _job(stepover: float = 2.0) -> sc.Job:
    document = milling_document("zig-zag", BALL, stepover=stepover, tolerance=0.01)
    document["title"] = "A cube's top"
    document["setup"] = {"zero": "model"}
    return sc.Job.from_dict(document, part=sc.Part.from_mesh(*CUBE))


@pytest.fixture(scope="module")
def made() -> dict[str, Any]:
    """One of each, and how to make its equal is to make it again."""
    return _values()


def _values(stepover: float = 2.0) -> dict[str, Any]:
    job = _job(stepover)
    plan = sc.plan(job)
    posted = sc.post(plan)
    report = sc.verify(posted, job)
    return {
        "tool": sc.Tool.library("clothoid:small"),
        "points": sc.Tool({"profile": {"kind": "points", "points": [[0, 0], [1, 0.05], [2, 0.21], [3, 0.5], [4, 1]]}}),
        "part": sc.Part.from_mesh(*CUBE),
        "job": job,
        "machine": sc.Machine({"name": "linuxcnc", "options": {"units": "inch", "decimals": 5}}),
        "plan": plan,
        "program": plan.programs["main"],
        "posted": posted,
        "report": report,
        "run": sc.RunResult(plan, posted, {"main": ChannelResult(report, plan.summary(report.judgement)[0])}, ()),
        "simulation": sc.simulate(report, 0.25 * stepover),
        "comparison": sc.simulate(report, 0.25 * stepover).compare(),
        "offset": sc.offset_surface(sc.Part.from_mesh(*CUBE), {"profile": BALL}, tolerance=0.01),
        "offsets": sc.slope_matched_offset({"profile": BALL}, [[0, 0, 0]], [[0, 0.6, 0.8]]),
    }


NAMES = [
    "tool", "points", "part", "job", "machine", "plan", "program", "posted", "report", "run", "simulation", "comparison",
    "offset",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_value_states_in_a_line_what_it_is(made, name):
    shown = repr(made[name])
    assert "\n" not in shown and len(shown) <= LONGEST, shown
    assert "0x" not in shown and type(made[name]).__name__ in shown


def test_what_values_say(made):
    shown = {name: repr(value) for name, value in made.items()}
    assert shown["tool"] == "<Tool 'clothoid:small': clothoid D6>"
    assert shown["part"] == "<Part: 12 triangles, 10 x 8 x 5 mm>"
    assert shown["job"] == '<Job "A cube\'s top": made.stl, 1 operation (zig-zag), for linuxcnc>'
    assert shown["machine"].startswith("<Machine 'linuxcnc': LinuxCNC")
    assert "1 operation" in shown["plan"] and " moves" in shown["plan"] and "mm at feed" in shown["program"]
    assert "job.ngc" in shown["posted"] and " lines" in shown["posted"]
    assert shown["report"].startswith("<Report: ok, nothing found, worst gouge 0.0")
    assert "nothing written" in shown["run"]
    assert "nodes" in shown["simulation"] and "contact" in shown["offset"]


@pytest.mark.parametrize("name", NAMES)
def test_values_made_alike_are_equal(made, name):
    again, other = _values()[name], _values(3.0)[name]
    assert made[name] == again
    assert made[name] != "something else" and made[name] is not None
    if name not in ("tool", "points", "part", "machine", "offset"):
        assert made[name] != other
    if getattr(type(made[name]), "__hash__", None):
        assert hash(made[name]) == hash(again)


def test_values_that_differ_are_not_equal():
    assert sc.Tool("clothoid:small") != sc.Tool("clothoid:medium")
    assert sc.Machine("grbl") != sc.Machine("linuxcnc") != sc.Machine({"name": "linuxcnc", "options": {"decimals": 2}})
    vertices, triangles = CUBE
    assert sc.Part.from_mesh(*CUBE) != sc.Part.from_mesh(np.array(vertices) * 1.001, triangles)
    assert sc.Tool("clothoid:small") == sc.Tool(sc.Tool("clothoid:small").to_dict())


COPIES: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda value: pickle.loads(pickle.dumps(value)),
}


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("name", NAMES)
def test_values_are_copied(made, name, how):
    again = COPIES[how](made[name])
    assert again == made[name] and repr(again) == repr(made[name]) and type(again) is type(made[name])


def test_copies_work_as_what_they_were_made_of(made):
    again = pickle.loads(pickle.dumps(made))
    assert sc.post(again["plan"]) == made["posted"]
    assert sc.verify(again["posted"], again["job"]).to_dict() == made["report"].to_dict()
    assert again["report"].coverage() == made["report"].coverage()
    assert np.array_equal(again["report"].left([[5.0, 4.0, 0.0]]), made["report"].left([[5.0, 4.0, 0.0]]))
    assert again["plan"].summary(again["report"].judgement) == made["plan"].summary(made["report"].judgement)
    assert np.array_equal(sc.simulate(again["report"], 0.5).heights, made["simulation"].heights)
    assert again["simulation"].compare() == made["comparison"]
    tips = [[5.0, 4.0], [30.0, 4.0]]
    assert np.array_equal(
        sc.drop_cutter(again["part"], again["tool"], tips), sc.drop_cutter(made["part"], made["tool"], tips), True
    )
    assert np.array_equal(again["offsets"], made["offsets"]) and again["offsets"].flags == made["offsets"].flags
    mine = copy.deepcopy(made["job"])
    mine.document["title"] = "another"
    assert made["job"].title == "A cube's top"


def test_values_and_errors_travel_to_workers(made):
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        done = pool.submit(in_workers.tall, made["job"], made["part"], made["tool"], made["machine"]).result(
            timeout=120
        )
        failed = pool.submit(in_workers.fails).exception(timeout=120)
    report, height, text = done
    assert report == made["report"] and report.program == made["report"].program
    assert height == pytest.approx(0.0, abs=1e-12) and text == sc.post(made["plan"], made["machine"]).text
    assert isinstance(failed, sc.ToolError) and failed.code == "no-such-size" and "clothoid:small" in failed.hint


@pytest.mark.parametrize("kind", [sc.StylusError, sc.JobError, sc.Cancelled])
def test_errors_are_copied(kind):
    error = kind("what, where", code="a-code", where="here", hint="do that")
    for how in COPIES.values():
        again = how(error)
        assert type(again) is kind and str(again) == "what, where"
        assert (again.code, again.where, again.hint) == ("a-code", "here", "do that")


def test_a_part_from_a_file_keeps_its_surfaces(part_of):
    part = part_of("cone_cup")
    again = pickle.loads(pickle.dumps(part))
    assert again == part and again.arrays.faces == part.arrays.faces
    assert repr(part).startswith("<Part cone_cup.step: 10 faces, ")
    points, faces = part.arrays.vertices[:50] + 0.1, np.full(50, 2)
    assert np.array_equal(again.arrays.surface_distance(points, faces), part.arrays.surface_distance(points, faces))


def test_a_surface_that_only_the_kernel_knows_travels():
    pytest.importorskip("OCP")
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.Geom import Geom_OffsetSurface, Geom_SphericalSurface
    from OCP.gp import gp_Ax3

    from styluscam.parts.exact import surface_of

    sphere = Geom_OffsetSurface(Geom_SphericalSurface(gp_Ax3(), 10.0), 2.0)
    surface = surface_of(BRepBuilderAPI_MakeFace(sphere, 0.1, 1.0, 0.1, 1.0, 1e-6).Face())
    again = pickle.loads(pickle.dumps(surface))
    uv = np.array([[0.3, 0.4], [0.7, 0.9]])
    for one, other in zip(surface.evaluate(uv), again.evaluate(uv), strict=True):
        assert np.array_equal(one, other)


def test_a_job_states_title_and_operations(made):
    job = made["job"]
    assert job.title == "A cube's top"
    assert [(one["id"], one["kind"], one["stepover"]) for one in job.operations] == [("zig-zag-1", "zig-zag", 2.0)]
    document = job.to_dict() | {"title": ""}
    assert sc.Job.from_dict(document).title == "made.stl"
    assert [record["id"] for record in made["program"].operations] == [one["id"] for one in job.operations]


def test_only_public_names_are_listed():
    assert dir(sc) == sorted(sc.__all__)
    for name in ("np", "json", "annotations", "planning", "arguments"):
        assert name not in dir(sc)
    listed = [name for name in sc.__all__ if not name.startswith("__")]
    assert all(hasattr(sc, name) for name in listed)
    shown = pydoc.render_doc(sc, renderer=pydoc.plaintext)
    assert "drop_cutter" in shown
    code = """
import styluscam.advice.suggest, styluscam.report
from styluscam.programs import planning
from styluscam.tools import library
print(styluscam.programs.machine)
"""
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).returncode == 0
