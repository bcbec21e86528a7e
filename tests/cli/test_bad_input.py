"""Bad input: one line that states what, where and what to do; exit code 2; nothing written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .conftest import FIXTURES, changed, write_step

JOB = """
schema = 1

[part]
file = "box.step"
faces = ["Face6"]
model_face = "tool"

[setup]
zero = "sheet-top"

[setup.sheet]
thickness = 1.0

[tools.stylus]
number = 1
profile = { kind = "ball", diameter = 6.0 }

[[operations]]
kind = "zig-zag"
tool = "stylus"
stepover = 5.0

[machine]
name = "linuxcnc"

[output]
file = "out.ngc"
"""
STEP = "step = { height = 5.0 }"
ROW = "stepover = 5.0"
LEVELS = (('"zig-zag"', '"z-level"'), (ROW, STEP))
TOOL = '[tools.stylus]\nnumber = 1\nprofile = { kind = "ball", diameter = 6.0 }'

IN_THE_DOCUMENT = {
    "step 0": (
        [*LEVELS, ("height = 5.0", "height = 0")],
        ["operations[0].step.height", "height = 0", "above 0 and up to 100 mm"],
    ),
    "step -1": ([*LEVELS, ("height = 5.0", "height = -1")], ["operations[0].step.height", "height = -1", "above 0"]),
    "step abc": (
        [*LEVELS, ("height = 5.0", 'height = "abc"')],
        ["operations[0].step.height", "abc", "above 0 and up to 100 mm"],
    ),
    "step nan": ([*LEVELS, ("height = 5.0", "height = nan")], ["operations[0].step.height", "NaN is not a number"]),
    "step inf": ([*LEVELS, ("height = 5.0", "height = inf")], ["operations[0].step.height", "inf is not a number"]),
    "step of another kind": (
        [*LEVELS, ("height = 5.0", "heihgt = 5.0")],
        ["operations[0].step", "heihgt", 'did you mean "height"'],
    ),
    "key of another kind": (
        [("stepover = 5.0", f"stepover = 5.0\n{STEP}")],
        ["operations[0].step", "step is a key of z-level, spiral", "this operation is zig-zag", "remove step"],
    ),
    "no step": ([*LEVELS, (STEP, "")], ["operations[0].step", "add step = { height = 0.5 }"]),
    "no stepover": ([("stepover = 5.0", "")], ["operations[0].stepover", "add stepover"]),
    "unknown key": ([("stepover", "stepovr")], ["operations[0]", "stepovr", 'did you mean "stepover"']),
    "unknown section": ([("[setup]", "[stup]")], ["stup", 'did you mean "setup"']),
    "unknown strategy": ([("zig-zag", "zigzag")], ["operations[0].kind", "zigzag", 'did you mean "zig-zag"']),
    "sheet without model_face": ([('model_face = "tool"', "")], ["part.model_face", '"tool", "back" or "mid"']),
    "model_face misspelt": (
        [('model_face = "tool"', 'model_face = "bak"')],
        ["part.model_face", 'did you mean "back"'],
    ),
    "sheet thicker than the tool": (
        [("thickness = 1.0", "thickness = 8")],
        ["setup.sheet.thickness", "stylus", "longer"],
    ),
    "negative thickness": ([("thickness = 1.0", "thickness = -1")], ["setup.sheet.thickness", "-1", "above 0"]),
    "no thickness": ([("thickness = 1.0", "")], ["setup.sheet", "thickness is missing"]),
    "diameter 0": ([("diameter = 6.0", "diameter = 0")], ["tools.stylus", "diameter", "0"]),
    "diameter -6": ([("diameter = 6.0", "diameter = -6")], ["tools.stylus", "diameter", "-6"]),
    "diameter nan": ([("diameter = 6.0", "diameter = nan")], ["tools.stylus", "diameter", "NaN"]),
    "no diameter": ([(", diameter = 6.0", "")], ["tools.stylus.profile", "diameter"]),
    "unknown profile": ([('kind = "ball"', 'kind = "bal"')], ["tools.stylus.profile", "bal", "ball"]),
    "two tools of one number": (
        [(TOOL, TOOL + "\n" + TOOL.replace("stylus", "other"))],
        ["tools.stylus.number", "other and stylus", "the same number 1"],
    ),
    "tool name unknown": ([('tool = "stylus"', 'tool = "stilus"')], ["operations[0].tool", "stilus", "stylus"]),
    "machine unknown": ([('name = "linuxcnc"', 'name = "linux"')], ["linux", "grblhal"]),
    "machine neither named nor filed": ([('name = "linuxcnc"', "")], ["machine", "grblhal"]),
    "no machine": ([('[machine]\nname = "linuxcnc"', "")], ["machine is missing"]),
    "machine file missing": ([('name = "linuxcnc"', 'file = "mine.toml"')], ["mine.toml"]),
    "bad TOML": ([("[setup.sheet]", "[setup.sheet")], ["line 12"]),
    "key twice": ([("number = 1", "number = 1\nnumber = 2")], ["line 1", "duplicate"]),
    "z_bottom above z_top": (
        [(ROW, ROW + "\nz_top = -5.0\nz_bottom = -2.0")],
        ["operations[0].z_bottom", "-2", "-5"],
    ),
    "no operation": ([("[[operations]]", "[[operation]]")], ["operation", 'did you mean "operations"']),
    "schema of the future": ([("schema = 1", "schema = 2")], ["schema = 2", "update"]),
    "no schema": ([("schema = 1", "")], ["schema is missing"]),
    "feed 0": (
        [("stepover = 5.0", "stepover = 5.0\nfeeds = { cut = 0 }")],
        ["operations[0].feeds.cut", "0.1 to 100000 mm/min"],
    ),
    "retract above clearance": ([('zero = "sheet-top"', "clearance = 1\nretract = 2")], ["setup.retract", "clearance"]),
    "zero misspelt": ([('"sheet-top"', '"sheettop"')], ["setup.zero", "sheet-top"]),
    "milling with a sheet": (
        [("[tools.stylus]", '[process]\nkind = "milling"\n[tools.stylus]')],
        ["setup.sheet", "milling"],
    ),
    "unknown wcs": ([("[setup]", '[setup]\nwcs = "G74"')], ["G74", "G54"]),
    "center of what has none": (
        [('"ball"', '"clothoid"'), ("number = 1", 'number = 1\nreference = "center"')],
        ["tools.stylus.reference", "center", "tip"],
    ),
    "step as a number": ([*LEVELS, (STEP, "step = 0.5")], ["operations[0].step", "height"]),
    "empty faces list": ([('["Face6"]', "[]")], ["part.faces", "no face is named"]),
    "empty faces list of an operation": ([(ROW, ROW + "\nfaces = []")], ["operations[0].faces", "no face is named"]),
    "face that does not exist": ([("Face6", "Face99")], ["part.faces[0]", "Face99", "Face1 to Face6"]),
    "face that faces down": ([("Face6", "Face5")], ["part.faces[0]", "Face5", "down", "setup.up"]),
    "no such part": ([("box.step", "bx.step")], ["bx.step", "no such file"]),
    "part is a folder": ([("box.step", "folder")], ["folder", "not a file"]),
    "part is not STEP": ([("box.step", "text.step")], ["text.step", "STEP"]),
    "part of unknown format": ([("box.step", "text.doc")], ["text.doc", ".step"]),
    "STEP without a solid": ([("box.step", "edge.step")], ["edge.step"]),
    "STL without units": ([("box.step", "cube.stl")], ["cube.stl", "units", "mm"]),
    "a part smaller than nothing": (
        [("box.step", "cube.stl"), ("[part]", '[part]\nunits = "um"')],
        ["cube.stl", "units"],
    ),
    "STEP with units": ([("[part]", '[part]\nunits = "mm"')], ["box.step", "units"]),
    "part tolerance 0": ([("[part]", "[part]\ntolerance = 0")], ["part.tolerance", "0.0001 to 1 mm"]),
    "outputs of one name": ([('"out.ngc"', '"out.ngc"\nprogram = "out.ngc"')], ["out.ngc", "another output"]),
    "output over the part": ([("out.ngc", "box.step")], ["box.step", "read by this very job"]),
    "output over the part by another path": ([("out.ngc", "folder/../box.step")], ["read by this very job"]),
    "output over the job": ([("out.ngc", "job.toml")], ["job.toml", "read by this very job"]),
    "output of no file name": ([("out.ngc", "\\u0000")], ["no file name"]),
    "array for a table": ([(ROW, ROW + "\nfeeds = [1500.0, 300.0]")], ["operations[0].feeds", "table"]),
    "number for a word": ([("[setup]", "[setup]\nup = 1")], ["setup.up", "word in quotes", '"+z"']),
    "date for a word": ([("[part]", "title = 1979-05-27\n[part]")], ["title", "string"]),
    "absurd number": ([*LEVELS, ("height = 5.0", "height = 1e308")], ["operations[0].step.height", "1e308", "100 mm"]),
    "no length offset": (
        [("number = 1", "number = 1\nlength_offset = 0")],
        ["tools.stylus.length_offset", "leave it out"],
    ),
    "retract that the verifier refuses": (
        [('zero = "sheet-top"', "retract = 0.04")],
        ["setup.retract", "0.1 to 1000 mm"],
    ),
    "two operations of one name": (
        [
            (ROW, ROW + '\nid = "a"'),
            ("[machine]", '[[operations]]\nkind = "zig-zag"\nid = "a"\ntool = "stylus"\nstepover = 5.0\n[machine]'),
        ],
        ["operations[1].id", "operations[0]"],
    ),
    "output below a file": ([("out.ngc", "text.doc/out.ngc")], ["out.ngc", "cannot be written", "text.doc"]),
    "output is a folder": ([("out.ngc", "folder")], ["folder", "cannot be written"]),
    "all but nothing faces up": ([('["Face6"]', '"al"')], ["part.faces", "al", "all"]),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory, box_step):
    """Parts of many kinds of badness."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Pnt

    folder = tmp_path_factory.mktemp("bad")
    (folder / "box.step").write_bytes(box_step.read_bytes())
    (folder / "text.step").write_text("not a STEP file at all\n")
    (folder / "text.doc").write_text("words\n")
    (folder / "folder").mkdir()
    write_step(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Edge(), folder / "edge.step")
    tetrahedron = [(0, 0, 0), (0.4, 0, 0), (0, 0.4, 0), (0, 0, 0.4)]
    facets = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    text = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*tetrahedron[i]) for i in facet)
        + "endloop\nendfacet\n"
        for facet in facets
    )
    (folder / "cube.stl").write_text(f"solid t\n{text}endsolid t\n")
    return folder


def files_in(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def is_one_helpful_line(ran, words: list[str]) -> None:
    assert ran.code == 2, ran
    assert ran.out == ""
    assert ran.err.startswith("error: ") and ran.err.count("\n") == 1 and ran.err.endswith("\n"), ran.err
    assert "Traceback" not in ran.err and len(ran.err) < 400
    for word in words:
        assert word in ran.err, (word, ran.err)


@pytest.mark.parametrize(("changes", "words"), IN_THE_DOCUMENT.values(), ids=IN_THE_DOCUMENT)
def test_wrong_job(folder, cli, changes, words):
    job = folder / "job.toml"
    job.write_text(changed(JOB, *changes))
    before = files_in(folder)
    is_one_helpful_line(cli("run", job), words)
    assert files_in(folder) == before
    as_json = cli("run", job, "--json")
    assert as_json.code == 2 and as_json.err == ""
    error = as_json.json["error"]
    assert list(error) == ["class", "code", "where", "message", "hint"]
    assert error["class"].endswith("Error") and error["code"] and error["message"]


def test_the_unspoilt_job_runs(folder, cli):
    job = folder / "good.toml"
    job.write_text(JOB)
    ran = cli("run", job)
    assert ran.code == 0, ran.err
    (folder / "out.ngc").unlink()
    (folder / "out.program.json").unlink()


def test_no_such_job(tmp_path, cli):
    is_one_helpful_line(cli("run", tmp_path / "none.toml"), ["none.toml", "no such file"])


def test_job_is_a_folder(tmp_path, cli):
    is_one_helpful_line(cli("run", tmp_path), [str(tmp_path), "directory"])


def test_job_is_binary_junk(tmp_path, cli):
    (tmp_path / "job.toml").write_bytes(bytes(range(256)) * 8)
    is_one_helpful_line(cli("run", tmp_path / "job.toml"), ["job.toml", "not text"])


def test_job_is_a_step_file(cli):
    is_one_helpful_line(
        cli("run", FIXTURES / "cone_cup.step"), ["cone_cup.step", "this is a part, not a job", "styluscam new"]
    )


def test_job_is_empty(tmp_path, cli):
    (tmp_path / "job.toml").touch()
    is_one_helpful_line(cli("run", tmp_path / "job.toml"), ["job.toml", "missing"])


@pytest.mark.parametrize("command", ["run", "plan"])
def test_picture_that_cannot_be_written_stops_before_the_work(folder, cli, command):
    job = folder / "good.toml"
    job.write_text(JOB)
    before = files_in(folder)
    ran = cli(command, job, "--picture", folder / "text.doc" / "p.png")
    is_one_helpful_line(ran, ["p.png", "cannot be written"])
    assert files_in(folder) == before


def test_output_that_cannot_be_written_stops_before_the_work(folder, cli, monkeypatch):
    from styluscam.programs import running

    def planned(*args, **kwargs):
        raise AssertionError("planned in vain")

    monkeypatch.setattr(running, "plan", planned)
    job = folder / "job.toml"
    job.write_text(changed(JOB, ("out.ngc", "text.doc/out.ngc")))
    is_one_helpful_line(cli("run", job), ["out.ngc", "cannot be written"])


USAGE = {
    "no such command": (["rnu"], ["rnu", "run"]),
    "no job": (["run"], ["JOB.toml"]),
    "no such option": (["run", "job.toml", "--qiet"], ["--qiet"]),
    "too many": (["doctor", "now"], ["now"]),
    "verify without a job": (["verify", "a.ngc"], ["--job"]),
    "no such machine": (["machine", "show", "linux"], ["linux", "grblhal"]),
    "no such machine file": (["machine", "show", "none.toml"], ["none.toml"]),
    "no such part": (["part", "show", "none.step"], ["none.step", "no such file"]),
    "new for no such part": (["new", "none.step"], ["none.step", "no such file"]),
    "unknown units": (["part", "show", "none.stl", "--units", "miles"], ["miles", "mm, cm, m, um, in"]),
}


@pytest.mark.parametrize(("arguments", "words"), USAGE.values(), ids=USAGE)
def test_wrong_command_line(cli, arguments, words):
    is_one_helpful_line(cli(*arguments), words)
    as_json = cli(*arguments, "--json")
    assert as_json.code == 2 and as_json.err == "" and as_json.json["error"]["message"]


GCODE = {
    "unknown word": ("G21 G90\nF100\nG1 A5\nM2\n", ["line 3", "A5"]),
    "unknown code": ("G21 G90\nF100\nG77\nM2\n", ["line 3", "G77"]),
    "junk": ("G21\n\x01\x02\nM2\n", ["line 2"]),
    "no unit": ("G0 X1\nM2\n", ["line 1"]),
    "wrong length offset": ("G21 G90 G54\nT1 M6\nG43 H9\nM2\n", ["line 3", "9"]),
    "another tool": ("G21 G90 G54\nT7 M6\nM2\n", ["line 2", "7"]),
    "no end": ("G21 G90\nF100\n", ["end"]),
}


@pytest.mark.parametrize(("text", "words"), GCODE.values(), ids=GCODE)
def test_gcode_that_the_machine_does_not_take(folder, cli, text, words):
    (folder / "good.toml").write_text(JOB)
    (folder / "bad.ngc").write_text(text)
    is_one_helpful_line(cli("verify", folder / "bad.ngc", "--job", folder / "good.toml"), words)


def test_gcode_that_is_not_there_or_not_text(folder, cli):
    (folder / "good.toml").write_text(JOB)
    is_one_helpful_line(cli("verify", folder / "none.ngc", "--job", folder / "good.toml"), ["none.ngc"])
    (folder / "junk.ngc").write_bytes(b"\xff\xfe\x00")
    is_one_helpful_line(cli("verify", folder / "junk.ngc", "--job", folder / "good.toml"), ["junk.ngc"])


def test_fault_of_ours_is_one_line_and_a_traceback_only_on_request(folder, cli, monkeypatch):
    from styluscam.cli import run

    def broken(*args, **kwargs):
        raise RuntimeError("broken\nin two lines")

    monkeypatch.setattr(run.running, "run", broken)
    (folder / "good.toml").write_text(JOB)
    ran = cli("run", folder / "good.toml")
    assert ran.code == 4 and ran.err.count("\n") == 1 and "report" in ran.err and "Traceback" not in ran.err
    assert "Traceback" in cli("run", folder / "good.toml", "--debug").err
    as_json = cli("run", folder / "good.toml", "--json")
    assert as_json.code == 4 and as_json.json["error"]["class"] == "RuntimeError"
    json.dumps(as_json.json)


def test_pictures_do_not_replace_the_part(folder, cli, box_step):
    before = box_step.read_bytes()
    ran = cli("part", "show", box_step, "--picture", box_step)
    assert ran.code == 2 and "read by this very job" in ran.err
    assert box_step.read_bytes() == before


def test_coordinates_that_are_no_numbers(tmp_path, cli, box_step):
    spoilt = tmp_path / "nan.step"
    text = box_step.read_text()
    at = text.index("CARTESIAN_POINT('',(") + len("CARTESIAN_POINT('',(")
    spoilt.write_text(text[:at] + "nan" + text[text.index(",", at) :])
    ran = cli("part", "show", spoilt)
    assert ran.code == 2 and "not a number" in ran.err and ran.err.count("\n") == 1
