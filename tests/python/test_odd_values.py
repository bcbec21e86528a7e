"""Odd values in Python calls: a StylusError that names the argument, or a plain answer; never a panic or a foreign error."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import milling_document

import styluscam as sc

BALL = {"profile": {"kind": "ball", "diameter": 6.0}}
ROOF = ([[-20, -20, -5], [20, -20, -5], [20, 20, -5], [-20, 20, -5], [0, -20, 0], [0, 20, 0]],
        [[0, 4, 5], [0, 5, 3], [4, 1, 2], [4, 2, 5]])  # fmt: skip
ODD = [math.nan, math.inf, -math.inf, -1.0, 0.0, 1e300, 1e-300]
LONGEST = 400
"""Characters of a message about a number."""


@pytest.fixture(scope="module")
def part() -> sc.Part:
    return sc.Part.from_mesh(*ROOF)


@pytest.fixture(scope="module")
def job(part: sc.Part) -> sc.Job:
    document = milling_document("zig-zag", BALL["profile"], stepover=8.0, tolerance=0.02)
    document["setup"] = {"zero": "model"}
    return sc.Job.from_dict(document, part=part)


@pytest.fixture(scope="module")
def report(job: sc.Job) -> sc.Report:
    return sc.verify(sc.post(sc.plan(job)), job)


NUMBERS: dict[str, Callable[[sc.Part, sc.Report, float], Any]] = {
    "tolerance of a waterline": lambda part, _, x: sc.waterline(
        part, BALL, -3.0, tolerance=max(x, 1e-4) if x > 0 else x
    ),
    "height of a waterline": lambda part, _, x: sc.waterline(part, BALL, x),
    "position": lambda part, _, x: sc.drop_cutter(part, BALL, [[x, 0.0]]),
    "floor": lambda part, _, x: sc.drop_cutter(part, BALL, [[99.0, 0.0]], floor=x),
    "height of a push": lambda part, _, x: sc.push_cutter(part, BALL, [[0.0, 0.0]], [[1.0, 0.0]], x),
    "direction of a push": lambda part, _, x: sc.push_cutter(part, BALL, [[0.0, 0.0]], [[x, 0.0]], -3.0),
    "tolerance of a surface": lambda part, _, x: sc.offset_surface(part, BALL, tolerance=max(x, 1e-3) if x > 0 else x),
    "thickness": lambda part, _, x: sc.drop_cutter(part, BALL, [[0.0, 0.0]], {"thickness": x, "model_face": "back"}),
    "diameter": lambda part, _, x: sc.Tool({"profile": {"kind": "ball", "diameter": x}}),
    "slope": lambda part, _, x: sc.Tool(BALL).radius_at(x),
    "point": lambda part, report, x: report.left([[x, 0.0, 0.0]]),
    "spacing": lambda part, report, x: sc.simulate(report, x),
    "decimals": lambda part, _, x: sc.Machine("grbl").with_options({"decimals": x}),
}


@pytest.mark.parametrize("value", ODD, ids=repr)
@pytest.mark.parametrize("what", NUMBERS)
def test_odd_numbers(what, value, part, report):
    try:
        NUMBERS[what](part, report, value)
    except sc.StylusError as error:
        assert str(error) and len(str(error)) < LONGEST, error


def test_what_is_no_slope_has_no_radius():
    assert np.isnan(sc.Tool(BALL).radius_at([math.nan, 0.5])).tolist() == [True, False]
    with pytest.raises(sc.GeometryError, match="an array of numbers expected"):
        sc.Tool(BALL).height_at("a")


def test_numpy_and_pathlib_in_documents(job, tmp_path):
    diameters = (np.float64(6), np.float32(6), np.int64(6), 6)
    assert len({sc.Tool({"profile": {"kind": "ball", "diameter": each}}) for each in diameters}) == 1
    points = np.array([[0, 0], [1, 0.05], [2, 0.21], [3, 0.5]])
    assert sc.Tool({"profile": {"kind": "points", "points": points}}).diameter == pytest.approx(6.0)
    document = job.to_dict()
    document = {**document, "schema": np.int64(1), "part": {"file": tmp_path / "made.stl", "units": "mm"}}
    assert sc.Job.from_dict(document).document["part"]["file"] == str(tmp_path / "made.stl")


DOCUMENTS: dict[str, tuple[type[sc.StylusError], str, Callable[[sc.Job], Any]]] = {
    "nan in a job": (
        sc.JobError,
        "operations[0].stepover: expected a text, a finite number, a list or a dict, got float nan",
        lambda job: sc.Job.from_dict({**job.to_dict(), "operations": [{**job.operations[0], "stepover": math.nan}]}),
    ),
    "an object in a job": (
        sc.JobError,
        "title: expected a text, a finite number, a list or a dict, got a value of type object",
        lambda job: sc.plan({**job.to_dict(), "title": object()}),
    ),
    "nan in a tool": (
        sc.ToolError,
        "profile.diameter: expected a text, a finite number, a list or a dict, got float nan",
        lambda _: sc.Tool({"profile": {"kind": "ball", "diameter": math.nan}}),
    ),
    "an object in a machine": (
        sc.MachineError,
        "name: expected a text, a finite number, a list or a dict, got a value of type object",
        lambda _: sc.Machine({"schema": 1, "name": object()}),
    ),
    "an unknown key of a sheet": (
        sc.GeometryError,
        "unknown key 'widness'",
        lambda _: sc.slope_matched_offset(BALL, [[0, 0, 0]], [[0, 0, 1]], {"widness": 1}),
    ),
    "an empty sheet": (
        sc.GeometryError,
        "thickness is missing",
        lambda _: sc.slope_matched_offset(BALL, [[0, 0, 0]], [[0, 0, 1]], {}),
    ),
    "no texts": (
        sc.StylusError,
        "files: expected a dict of texts by their names, got None",
        lambda job: sc.verify(sc.Posted(None), job),
    ),
    "no text": (sc.StylusError, "files['a']: expected a text, got int 1", lambda _: sc.Posted({"a": 1})),
    "two texts for one": (
        sc.StylusError,
        "text: expected one file, got 2",
        lambda _: sc.Posted({"a": "", "b": ""}).text,
    ),
    "a line for lines": (sc.JobError, "a list of lines", lambda job: sc.post(sc.plan(job), notes="abc")),
    "a huge face": (
        sc.GeometryError,
        "no face",
        lambda _: sc.offset_surface(sc.Part.from_mesh(*ROOF), BALL, faces=[10**30]),
    ),
    "progress": (
        sc.StylusError,
        "progress: expected a function of phase and fraction, got a value of type int",
        lambda job: sc.plan(job, progress=5),
    ),
}


@pytest.mark.parametrize("what", DOCUMENTS)
def test_odd_documents(what, job):
    failure, stated, call = DOCUMENTS[what]
    with pytest.raises(failure) as caught:
        call(job)
    assert stated in str(caught.value), caught.value


def test_names_of_files_keep_their_digits():
    name = "scan_20231122123456789012.json"
    with pytest.raises(sc.ToolError, match=name):
        sc.Tool(Path(name))
    error = sc.ToolError(f"{name}: diameter = {'1' + '0' * 300}: too much", code="x")
    assert str(error) == f"{name}: diameter = 1e+300: too much"
