"""`styluscam verify`: sound programs pass, seeded faults are found at their line, or stand plainly in the summary."""

from __future__ import annotations

import re

import pytest

from blocks import write_stl

from .conftest import COARSE_CUP, changed

MOVED = 0.05


@pytest.fixture(scope="module")
def sound(coarse):
    """A run whose program is sound."""
    run = coarse()
    assert run.ran.code == 0, run.ran.out
    return run


def verified(cli, run, text, job=None):
    """What `verify` reports of a text: (exit code, document)."""
    spoilt = run.folder / "spoilt.ngc"
    spoilt.write_text(text)
    ran = cli("verify", spoilt, "--job", job or run.job, "--json")
    assert ran.err == ""
    return ran.code, ran.json


def test_sound_program_passes(sound, cli):
    ran = cli("verify", sound.gcode, "--job", sound.job)
    assert ran.code == 0 and ran.err == ""
    assert "nothing was found" in ran.out.splitlines()[0]
    assert "worst gouge" in ran.out and "worst excess" in ran.out
    code, document = verified(cli, sound, sound.gcode.read_text())
    assert code == 0 and document["coverage"] and document["engagement"] == []
    for face in document["coverage"]:
        assert f"Face{face['face']}: {100 * face['covered']:.1f} % of" in ran.out
        assert 0.0 <= face["mean"] <= face["scallop"] <= face["left"]
    assert "% of the " in ran.out and "that the tool must touch" in ran.out
    assert cli("verify", sound.gcode, "--job", sound.job, "--quiet").out == ""


def test_the_material_is_written(sound, cli):
    trimesh = pytest.importorskip("trimesh", reason="needs the mesh extra")
    after = sound.folder / "after.stl"
    ran = cli("verify", sound.gcode, "--job", sound.job, "--simulation", after)
    assert ran.code == 0 and str(after.name) in ran.out
    surface = trimesh.load_mesh(after)
    assert surface.bounds[1, 2] - surface.bounds[0, 2] > 10.0
    ran = cli("verify", sound.gcode, "--job", sound.job, "--simulation", sound.folder / "after.obj")
    assert ran.code == 2 and ".stl or .ply" in ran.err


POCKET = """
schema = 1
[part]
file = "block.stl"
units = "mm"
[process]
kind = "milling"
[setup]
zero = "model"
[tools.mill]
profile = { kind = "flat", diameter = 4.0 }
[[operations]]
id = "clear"
kind = "pocket"
tool = "mill"
step = { height = 2.0 }
engagement_deg = 80.0
fit = "arcs"
spindle = { mode = "fixed", rpm = 8000.0 }
[machine]
name = "linuxcnc"
[output]
file = "block.ngc"
"""


def test_what_a_pocket_engages_is_printed_and_in_the_document(cli, tmp_path):
    write_stl(tmp_path / "block.stl")
    job = tmp_path / "block.toml"
    job.write_text(POCKET)
    assert cli("run", job).code == 0
    ran = cli("verify", tmp_path / "block.ngc", "--job", job)
    (engaged,) = cli("verify", tmp_path / "block.ngc", "--job", job, "--json").json["engagement"]
    angle, rate = engaged["angle"], engaged["rate"]
    assert engaged["operation"] == "clear" and engaged["bound_deg"] == pytest.approx(80.0)
    assert 70.0 < angle["value"] < 80.5 and angle["share"] == pytest.approx(angle["value"] / 80.0)
    lines = (tmp_path / "block.ngc").read_text().splitlines()
    for largest in (angle, rate):
        assert re.search(r"[XY]-?\d", lines[largest["line"] - 1]) and 0.0 < largest["distance"] < engaged["length"]
    assert [layer["floor"] for layer in engaged["layers"]] == pytest.approx([4.0, 2.0], abs=0.005)
    assert engaged["exempt"][0]["length"] > 30.0
    words = f"clear: {angle['value']:.2f} of 80 degrees (line {angle['line']}), {100 * rate['share']:.1f} % of the reference"
    assert words in ran.out


def feed_lines(text, axis):
    """Numbers (from 1) of the lines of pure motion that name an axis, and the words there."""
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        word = re.search(rf"{axis}(-?\d+(?:\.\d+)?)", line)
        if word and re.fullmatch(r"(G1 )?(X\S+ ?)?(Y\S+ ?)?(Z\S+ ?)?(F\S+)?", line):
            found.append((number, word))
    return found


def shifted(text, number, word, by):
    """The text with one coordinate moved."""
    lines = text.splitlines(keepends=True)
    line = lines[number - 1]
    lines[number - 1] = f"{line[: word.start(1)]}{float(word.group(1)) + by:.3f}{line[word.end(1) :]}"
    return "".join(lines)


@pytest.mark.parametrize("share", [0.1, 0.35, 0.6, 0.85])
def test_one_coordinate_moved_into_the_part_is_named(sound, cli, share):
    text = sound.gcode.read_text()
    lines = feed_lines(text, "X")
    number, word = next((n, w) for n, w in lines[int(share * len(lines)) :] if abs(float(w.group(1))) > 10.0)
    outwards = MOVED if float(word.group(1)) > 0.0 else -MOVED  # the wall is outside the loop
    code, document = verified(cli, sound, shifted(text, number, word, outwards))
    assert code == 1 and not document["ok"]
    gouges = [finding for finding in document["findings"] if finding["kind"] == "gouge"]
    assert len(gouges) == 1
    assert gouges[0]["first_line"] <= number <= gouges[0]["last_line"] <= gouges[0]["first_line"] + 1
    assert document["gouge_max"] == pytest.approx(gouges[0]["value_mm"])
    ran = cli("verify", sound.folder / "spoilt.ngc", "--job", sound.job)
    assert ran.code == 1 and "must not run" in ran.out.splitlines()[0]
    assert re.search(rf"lines? ({number}|{number + 1})\b", ran.out) and "limit 0.0010 mm" in ran.out


def test_one_coordinate_moved_out_of_the_part_is_named(sound, cli):
    text = sound.gcode.read_text()
    number, word = next((n, w) for n, w in feed_lines(text, "X")[200:] if float(w.group(1)) > 15.0)
    code, document = verified(cli, sound, shifted(text, number, word, -MOVED))
    assert code == 1
    assert any(
        finding["kind"] == "excess" and finding["first_line"] <= number <= finding["last_line"]
        for finding in document["findings"]
    )


def test_one_depth_moved_is_named(sound, cli):
    text = sound.gcode.read_text()
    number, word = next((n, w) for n, w in feed_lines(text, "Z") if float(w.group(1)) < -10.0)
    code, document = verified(cli, sound, shifted(text, number, word, -MOVED))
    assert code == 1
    assert any(f["kind"] == "gouge" and number in (f["line"], f["first_line"]) for f in document["findings"])


def test_rapid_through_the_part_is_named(sound, cli):
    text = changed(sound.gcode.read_text(), ("M2\n", "G0 X40 Y40 Z-5\nM2\n"))
    number = text.splitlines().index("G0 X40 Y40 Z-5") + 1
    code, document = verified(cli, sound, text)
    assert code == 1
    assert any(finding["line"] == number and "rapid" in finding["kind"] for finding in document["findings"])


def test_inch_for_mm_is_found(sound, cli):
    code, document = verified(
        cli, sound, changed(sound.gcode.read_text(), ("G21", "G20"), ("G64 P0.001", "G64 P0.00003"))
    )
    assert code == 1 and document["findings"]


def test_mm_for_inch_is_found(sound, cli):
    text = sound.gcode.read_text()
    small = re.sub(r"([XYZ])(-?\d+\.?\d*)", lambda word: f"{word[1]}{float(word[2]) / 25.4:.4f}", text)
    code, _ = verified(cli, sound, small)
    assert code == 1


def test_tip_taken_for_centre_is_found(coarse, cli):
    """A program for the ball's centre, run with the tip set to zero: 5 mm too high; and the reverse."""
    ball = ('kind = "clothoid"', 'kind = "ball"')
    centre = ('reference = "tip"', 'reference = "center"')
    by_tip, by_centre = coarse(ball), coarse(ball, centre)
    assert by_tip.ran.code == 0 and by_centre.ran.code == 0
    assert verified(cli, by_tip, by_centre.gcode.read_text())[0] == 1
    assert verified(cli, by_centre, by_tip.gcode.read_text())[0] == 1
    printed = cli("run", by_centre.job).out
    assert "programmed at its center, 5 above the tip" in printed
    depths = [run.ran.json["summary"]["deepest_z"] for run in (by_tip, by_centre)]
    assert depths[1] - depths[0] == pytest.approx(5.0, abs=0.002)


@pytest.mark.parametrize(("face", "meaning"), [("tool", "facing the tool"), ("mid", "its middle")])
def test_flipped_sheet_is_found_and_stands_in_the_summary(coarse, sound, cli, face, meaning):
    other = coarse(('model_face = "back"', f'model_face = "{face}"'))
    code, document = verified(cli, sound, other.gcode.read_text())
    assert code == 1 and document["findings"]
    assert meaning in cli("run", other.job).out
    assert "away from the tool" in cli("run", sound.job).out


def test_another_zero_is_found_and_stands_in_the_summary(coarse, sound, cli):
    other = coarse(('zero = "sheet-top"', "zero = [0.0, 0.0, 2.0]"))
    assert verified(cli, sound, other.gcode.read_text())[0] == 1
    assert other.ran.json["summary"]["zero"] != sound.ran.json["summary"]["zero"]


def test_program_of_another_part_is_found(sound, cli, tmp_path):
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, ("cone_cup.step", "vwaf.step")))
    assert verified(cli, sound, sound.gcode.read_text(), job)[0] == 1


def without_line(text, start):
    lines = text.splitlines(keepends=True)
    kept = [line for line in lines if not line.startswith(start)]
    assert len(kept) == len(lines) - 1
    return "".join(kept)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda text: without_line(text, "G43"), "length offset"),
        (lambda text: changed(text, ("G43 H1", "G43 H1\nG49")), "length offset"),
        (lambda text: changed(text, ("G43 H1", "G43 H2")), "length offset 2"),
        (lambda text: without_line(text, "G64"), "path tolerance"),
        (lambda text: changed(text, ("G64 P0.001 Q0", "G64")), "path tolerance"),
        (lambda text: changed(text, ("G64 P0.001 Q0", "G64 P5")), "path tolerance"),
    ],
)
def test_modes_that_move_the_tip_elsewhere_are_named(sound, cli, spoil, words):
    spoilt = sound.folder / "modes.ngc"
    spoilt.write_text(spoil(sound.gcode.read_text()))
    ran = cli("verify", spoilt, "--job", sound.job)
    assert ran.code == 2 and ran.err.count("\n") == 1
    assert "modes.ngc: line" in ran.err and words in ran.err


def test_an_exact_path_needs_no_tolerance(sound, cli):
    code, _ = verified(cli, sound, changed(sound.gcode.read_text(), ("G64 P0.001 Q0", "G61")))
    assert code == 0


def test_another_work_offset_is_found(sound, cli):
    code, report = verified(cli, sound, changed(sound.gcode.read_text(), ("\nG54\n", "\nG55\n")))
    assert code == 1 and [f["kind"] for f in report["findings"]] == ["work-offset"]
    assert "G55" in report["findings"][0]["message"]


def test_a_bad_program_is_reported_on_one_screen_errors_first(sound, cli):
    """Every third point moved into the part or off it, other feeds: hundreds of moves with something wrong."""
    text = sound.gcode.read_text()
    for number, word in feed_lines(text, "X")[::3]:
        text = shifted(text, number, word, MOVED if number % 2 else -MOVED)
    text = re.sub(r"F\d+", "F77", text)
    code, document = verified(cli, sound, text)
    assert code == 1 and sum(document["counts"].values()) > 500
    groups, findings = document["groups"], document["findings"]
    for listed in (groups, findings):
        severities = [one["severity"] for one in listed]
        assert severities == sorted(severities), severities  # "error" before "warning"
    assert sorted(index for group in groups for index in group["findings"]) == list(range(len(findings)))
    for group in groups:
        own = [findings[index] for index in group["findings"]]
        assert {(one["kind"], one["severity"]) for one in own} == {(group["kind"], group["severity"])}
        assert len(own) == min(group["count"], 20)
        assert any(one["value"] == group["value"] and one["line"] == group["line"] for one in own)
    counted = {kind: sum(group["count"] for group in groups if group["kind"] == kind) for kind in document["counts"]}
    assert counted == document["counts"]
    ran = cli("verify", sound.folder / "spoilt.ngc", "--job", sound.job)
    lines = ran.out.splitlines()
    assert "must not run" in lines[0] and lines[1].startswith("error: ")
    assert sum(1 + len(line) // 120 for line in lines) <= 40, ran.out
