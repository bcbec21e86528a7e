"""What the public calls take: tools, parts, machines, jobs and texts by every name that people have for them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import milling_document

import styluscam as sc

BALL = {"profile": {"kind": "ball", "diameter": 6.0}}
ROOF = ([[-20, -20, -5], [20, -20, -5], [20, 20, -5], [-20, 20, -5], [0, -20, 0], [0, 20, 0]],
        [[0, 4, 5], [0, 5, 3], [4, 1, 2], [4, 2, 5]])  # fmt: skip
"""Two slopes that meet over Y."""
WRONG = [None, 5, 1.5, True, b"ball", [], ["ball"], (1, 2), object(), {1, 2}, Ellipsis]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A part, a tool, a machine and a job in files, in a folder with a blank and an umlaut in its name."""
    trimesh = pytest.importorskip("trimesh", reason="needs the mesh extra")
    made = tmp_path_factory.mktemp("a shöp")
    trimesh.Trimesh(*ROOF, process=False).export(made / "roof.stl")
    sc.Tool.from_dict(BALL).write(made / "ball.json")
    (made / "mine.toml").write_text('schema = 1\nextends = "grbl"\nname = "mine"\n', encoding="utf-8")
    document = milling_document("zig-zag", BALL["profile"], tolerance=0.01)
    document["part"] = {"file": "roof.stl", "units": "mm", "faces": "all"}
    document["setup"] = {"zero": "model"}
    (made / "job.json").write_text(json.dumps(document), encoding="utf-8")
    return made


@pytest.fixture
def here(folder, monkeypatch):
    """That folder, as the current one."""
    monkeypatch.chdir(folder)
    return folder


def test_a_tool_by_dict_name_path_and_object(here):
    roof = sc.Part.from_mesh(*ROOF)
    clothoid = sc.Tool.library("clothoid:small")
    for tool in ("clothoid:small", clothoid, clothoid.to_dict(), clothoid.to_file()):
        heights = sc.drop_cutter(roof, tool, [[0.0, 0.0], [5.0, 3.0]])
        assert np.array_equal(heights, sc.drop_cutter(roof, clothoid, [[0.0, 0.0], [5.0, 3.0]]))
    for tool in ("ball.json", here / "ball.json", BALL):
        assert sc.drop_cutter(roof, tool, [[0.0, 0.0]])[0] == pytest.approx(0.0, abs=1e-12)
        assert sc.slope_matched_offset(tool, [[0, 0, 0]], [[0, 0, 1]])[0] == pytest.approx([0, 0, 0])
        assert len(sc.waterline(roof, tool, -3.0)) == 1
        assert len(sc.waterlines(roof, tool, [-3.0, -2.0])) == 2
        assert sc.push_cutter(roof, tool, [[30.0, 0.0]], [[-1.0, 0.0]], -4.0).shape == (1,)
        assert len(sc.offset_surface(roof, tool, tolerance=0.01).points) > 0


def test_a_part_by_path_and_object(here):
    for suffix in ("roof.step", Path("nowhere/roof.step")):
        with pytest.raises(sc.GeometryError, match=r"roof\.step"):
            sc.drop_cutter(suffix, BALL, [[0.0, 0.0]])
    with pytest.raises(sc.GeometryError, match="units"):
        sc.drop_cutter("roof.stl", BALL, [[0.0, 0.0]])
    assert sc.Part("roof.stl", units="mm").triangle_count == 4


def test_constructors_take_what_the_calls_take(here):
    assert sc.Tool("clothoid:small").to_dict() == sc.Tool.library("clothoid:small").to_dict()
    assert sc.Tool(BALL).diameter == sc.Tool(sc.Tool(BALL)).diameter == sc.Tool("ball.json").diameter == 6.0
    assert sc.Tool("ball.json").files == (Path("ball.json"),)
    assert sc.Machine("grbl").name == sc.Machine(sc.Machine("grbl")).name == "grbl"
    assert sc.Machine("mine.toml").name == sc.Machine(here / "mine.toml").name == "mine"
    assert sc.Job("job.json").name == sc.Job(sc.Job("job.json")).name == "job"
    with pytest.raises(sc.ToolError, match="no such tool"):
        sc.Tool("bal")
    with pytest.raises(sc.ToolError, match="comes in sizes, and none is named"):
        sc.Tool("clothoid")


def test_a_machine_by_name_path_dict_and_object(here):
    plan = sc.plan("job.json")
    mine = {"schema": 1, "extends": "grbl", "name": "mine", "number": {"mm": {"linear": 2, "feed": 0}}}
    expected = sc.post(plan, sc.Machine.shipped("grbl")).text
    assert "G90" in expected
    for machine in ("grbl", {"name": "grbl"}, sc.Machine("grbl"), sc.Machine("grbl").document):
        assert sc.post(plan, machine).text == expected
    for machine in ("mine.toml", here / "mine.toml", mine, {"file": "mine.toml"}):
        assert sc.post(plan, machine).text != ""
    assert sc.post(plan, {"name": "grbl", "options": {"units": "inch", "decimals": 5}}).text != expected
    assert sc.read_gcode(expected, "grbl").length == pytest.approx(sc.read_gcode(expected, mine).length)
    assert len(plan.programs["main"].times("grbl")) == len(plan.programs["main"].moves)
    with pytest.raises(sc.MachineError, match="grb"):
        sc.post(plan, "grb")
    with pytest.raises(sc.MachineError, match="extend"):
        sc.Machine.from_dict({"schema": 1, "extend": "grbl", "name": "mine"})
    with pytest.raises(sc.MachineError, match="machine"):
        sc.post(plan.programs["main"])


def test_a_job_by_dict_path_text_and_object(here):
    document = json.loads(Path("job.json").read_text())
    moves = len(sc.plan("job.json").programs["main"].moves)
    for job in (here / "job.json", document, sc.Job.read("job.json")):
        assert len(sc.plan(job).programs["main"].moves) == moves
    toml = 'schema = 1\n[part]\nfile = "roof.stl"\n'
    with pytest.raises(sc.JobError, match="a text of 3 lines"):
        sc.plan(toml)
    with pytest.raises(sc.JobError, match="tools"):
        sc.Job.from_toml(toml)


def test_texts_and_paths_are_kept_apart(here):
    job = sc.Job.read("job.json")
    posted = sc.post(sc.plan(job))
    Path("out").mkdir(exist_ok=True)
    Path("out/x.ngc").write_text(posted.text)
    Path("O1234").write_text(posted.text)  # as controllers name programs
    for text in (posted, posted.text, "out/x.ngc", Path("out/x.ngc"), here / "out/x.ngc", "O1234"):
        assert sc.verify(text, job).ok
        assert sc.verify(text, "job.json", "linuxcnc").ok
        assert len(sc.read_gcode(text, "linuxcnc").moves) > 10
    assert sc.verify_file("out/x.ngc", "job.json").ok
    assert sc.verify_file(Path("out/x.ngc"), job, "linuxcnc").ok
    with pytest.raises(sc.VerifyError, match="the program has no end"):
        sc.read_gcode("G21 G90 G1 X1. Y2. Z3.F500", "linuxcnc")
    for missing in ("out/y.ngc", "y.NC", Path("out/y")):
        with pytest.raises(sc.VerifyError, match="cannot be read: No such file") as caught:
            sc.verify(missing, job)
        assert caught.value.code == "unreadable"
    with pytest.raises(sc.VerifyError, match="a text of"):
        sc.verify_file(posted.text, job)


def test_a_program_is_checked_for_a_job(here):
    plan = sc.plan("job.json")
    assert sc.check_program(plan).ok
    assert sc.check_program(plan.programs["main"], "job.json").ok
    with pytest.raises(sc.JobError, match="job"):
        sc.check_program(plan.programs["main"])


def test_a_run_takes_a_dict_and_paths_as_text(here):
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    document = json.loads(Path("job.json").read_text())
    done = sc.run(document, report="page.html")
    assert {path.name for path in done.written} == {"job.ngc", "job.program.json", "page.html"}


CALLS = {
    "tool": (sc.ToolError, lambda x: sc.drop_cutter(sc.Part.from_mesh(*ROOF), x, [[0, 0]])),
    "tool of waterlines": (sc.ToolError, lambda x: sc.waterlines(sc.Part.from_mesh(*ROOF), x, [0.0])),
    "tool of waterline": (sc.ToolError, lambda x: sc.waterline(sc.Part.from_mesh(*ROOF), x, 0.0)),
    "tool of push_cutter": (sc.ToolError, lambda x: sc.push_cutter(sc.Part.from_mesh(*ROOF), x, [[0, 0]], [[1, 0]], 0)),
    "tool of offset": (sc.ToolError, lambda x: sc.slope_matched_offset(x, [[0, 0, 0]], [[0, 0, 1]])),
    "tool of offset_surface": (sc.ToolError, lambda x: sc.offset_surface(sc.Part.from_mesh(*ROOF), x)),
    "part": (sc.GeometryError, lambda x: sc.drop_cutter(x, BALL, [[0, 0]])),
    "part of waterlines": (sc.GeometryError, lambda x: sc.waterlines(x, BALL, [0.0])),
    "part of push_cutter": (sc.GeometryError, lambda x: sc.push_cutter(x, BALL, [[0, 0]], [[1, 0]], 0)),
    "part of offset_surface": (sc.GeometryError, lambda x: sc.offset_surface(x, BALL)),
    "job": (sc.JobError, sc.plan),
    "job of run": (sc.JobError, sc.run),
    "job of verify": (sc.JobError, lambda x: sc.verify("G90\nM2\n", x)),
    "job of verify_file": (sc.JobError, lambda x: sc.verify_file("x.ngc", x)),
    "machine": (sc.MachineError, lambda x: sc.read_gcode("G90\nM2\n", x)),
    "text": (sc.VerifyError, lambda x: sc.read_gcode(x, "grbl")),
    "plan": (sc.PlanError, lambda x: sc.post(x, "grbl")),
    "plan of check_program": (sc.PlanError, sc.check_program),
    "report": (sc.VerifyError, sc.simulate),
    "Tool": (sc.ToolError, sc.Tool),
    "Part": (sc.GeometryError, sc.Part),
    "Job": (sc.JobError, sc.Job),
    "Machine": (sc.MachineError, sc.Machine),
    "Program": (sc.JobError, sc.Program),
    "Tool.read": (sc.ToolError, sc.Tool.read),
    "Tool.find": (sc.ToolError, sc.Tool.find),
    "Tool.library": (sc.ToolError, sc.Tool.library),
    "Tool.from_dict": (sc.ToolError, sc.Tool.from_dict),
    "Part.read": (sc.GeometryError, sc.Part.read),
    "Job.read": (sc.JobError, sc.Job.read),
    "Job.from_dict": (sc.JobError, sc.Job.from_dict),
    "Job.from_toml": (sc.JobError, sc.Job.from_toml),
    "Machine.shipped": (sc.MachineError, sc.Machine.shipped),
    "Machine.read": (sc.MachineError, sc.Machine.read),
    "Machine.find": (sc.MachineError, sc.Machine.find),
    "Machine.from_dict": (sc.MachineError, sc.Machine.from_dict),
    "Program.load": (sc.JobError, sc.Program.load),
    "Program.from_json": (sc.JobError, sc.Program.from_json),
    "sheet": (sc.GeometryError, lambda x: x is None or sc.drop_cutter(sc.Part.from_mesh(*ROOF), BALL, [[0, 0]], x)),
}
"""By argument: the error's class, and a call with nothing else wrong."""


@pytest.mark.parametrize("value", WRONG, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("call", CALLS)
def test_a_wrong_type_is_named_with_what_is_expected(call, value):
    failure, function = CALLS[call]
    if call == "sheet" and value is None:
        return
    with pytest.raises(failure) as caught:
        function(value)
    error = caught.value
    argument = call.partition(" ")[0]
    named = {"Tool": "tool", "Part": "part", "Job": "job", "Machine": "machine", "Program": "program"}
    wanted = named.get(argument, argument.rpartition(".")[2])
    if "." not in argument:
        assert error.where == wanted and str(error).startswith(f"{wanted}: ")
    given = "None" if value is None else type(value).__name__
    assert "expected " in str(error) and ", got " in str(error) and given in str(error), str(error)


@pytest.mark.parametrize("value", ["a", [], [[1.0]], object(), b"1"], ids=lambda value: type(value).__name__)
def test_a_wrong_number_is_named(value):
    roof = sc.Part.from_mesh(*ROOF)
    for argument, call in {
        "z": lambda: sc.waterline(roof, BALL, value),
        "tolerance": lambda: sc.waterline(roof, BALL, 0.0, tolerance=value),
        "floor": lambda: sc.drop_cutter(roof, BALL, [[0, 0]], floor=value),
        "heights": lambda: sc.waterlines(roof, BALL, value) if value != [] else sc.waterline(roof, BALL, value),
    }.items():
        with pytest.raises(sc.StylusError) as caught:
            call()
        assert caught.value.where in (argument, "z"), argument
