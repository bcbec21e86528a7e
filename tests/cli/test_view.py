"""`styluscam view`, and the pages and pictures that `run` and `verify` write beside their results."""

from __future__ import annotations

import re

import pytest

from styluscam.report import heatmaps

from .conftest import COARSE_CUP, changed

PNG = b"\x89PNG\r\n\x1a\n"
INCHES = "%\n(somebody else's)\nG20 G90\nT3 M6\nS5000 M3\nG0 X0 Y0 Z1\nG1 Z-0.1 F7\nX1.5\nY2\nG0 Z1\nM30\n%\n"
LOOP = """\
(holes on a row, slots between them)
G20 G90 G94 F10
#<pitch>=0.5
o10 while [#<n> LT 3]
G81 X[#<n>*#<pitch>] Y0 Z-0.25 R0.1
o<Slot> call [#<n>*#<pitch>] [0.2]
#<n>=[#<n>+1]
o10 endwhile
G41 D1 G0 Z1
M2
"""
SLOT = "o<slot> sub\nG0 X#1 Y0.1\nG1 Z-0.1\nG3 X#1 Y[0.1+2*#2] R#2\nG0 Z0.1\no<slot> endsub\nM2\n"


@pytest.fixture(autouse=True)
def small_pages(monkeypatch):
    """Pages with few points: made in no time."""
    monkeypatch.setattr(heatmaps, "LIMIT", 3_000)


@pytest.fixture
def foreign(tmp_path):
    path = tmp_path / "foreign.ngc"
    path.write_text(INCHES)
    return path


def test_a_foreign_program_is_shown_beside_its_file(cli, foreign):
    ran = cli("view", foreign)
    assert ran.code == 0 and ran.err == ""
    assert "as linuxcnc reads it; not verified" in ran.out and re.search(r"lowest Z +-2\.540 mm", ran.out)
    page = foreign.with_suffix(".html").read_text()
    assert "Not verified" in page and "foreign.ngc" in page


def test_a_page_of_somebody_elses_is_left_alone(cli, foreign):
    page = foreign.with_suffix(".html")
    page.write_text("<html><title>set-up sheet</title></html>")
    ran = cli("view", foreign)
    assert ran.code == 2 and "name the page with --out" in ran.err and "set-up sheet" in page.read_text()
    page.unlink()
    assert cli("view", foreign).code == 0 == cli("view", foreign).code, "its own is replaced"


def test_what_no_machine_reads_is_traced(cli, tmp_path):
    program = tmp_path / "loop.ngc"
    program.write_text(LOOP)
    (tmp_path / "Slot.NGC").write_text(SLOT)
    ran = cli("view", program)
    assert ran.code == 0 and ran.err == ""
    assert "read as RS-274NGC, traced; not verified" in ran.out and re.search(r"lowest Z +-6\.350 mm", ran.out)
    assert "note: line 9: cutter compensation is not applied" in ran.out
    page = program.with_suffix(".html").read_text()
    assert "read as RS-274NGC, traced" in page and "#&lt;n&gt; has no value here: 0 is taken" in page
    assert cli("view", program, "--machine", "linuxcnc").code == 2


def test_subroutines_come_from_the_folders_that_are_named(cli, tmp_path):
    program, folder = tmp_path / "loop.ngc", tmp_path / "shared"
    program.write_text(LOOP)
    alone = cli("view", program, "--json")
    assert "line 6: there is no subroutine o<slot> here: its call is left out (3 times)" in alone.json["gaps"]
    folder.mkdir()
    (folder / "slot.ngc").write_text(SLOT)
    together = cli("view", program, "--subroutines", folder, "--json")
    assert together.json["machine"] == "RS-274NGC, traced" and not any(
        "o<slot>" in gap for gap in together.json["gaps"]
    )
    assert together.json["figures"]["moves"] == alone.json["figures"]["moves"] + 12
    (folder / "slot.ngc").write_text("o<slot> sub\nG1 X[1/0]\no<slot> endsub\n")
    faulty = cli("view", program, "--subroutines", folder)
    assert faulty.code == 2 and "line 2 of slot: a division by zero" in faulty.err


def test_json_states_figures_and_files(cli, foreign, tmp_path):
    out, picture = tmp_path / "deep" / "page.html", tmp_path / "picture.png"
    ran = cli("view", foreign, "--out", out, "--picture", picture, "--json")
    assert ran.code == 0 and ran.err == ""
    assert ran.json["machine"] == "linuxcnc" and ran.json["written"] == [str(out), str(picture)]
    assert ran.json["figures"]["lowest_z_mm"] == pytest.approx(-2.54)
    assert ran.json["figures"]["gouge_mm"] is None
    assert picture.read_bytes().startswith(PNG) and out.stat().st_size > 500_000


def test_our_program_with_its_job_or_a_part(cli, coarse, tmp_path, box_step):
    run = coarse()
    with_job = cli("view", run.gcode, "--job", run.job, "--out", tmp_path / "a.html")
    assert with_job.code == 0 and "Coarse cup" in (tmp_path / "a.html").read_text()
    with_part = cli("view", run.gcode, "--part", box_step, "--out", tmp_path / "b.html")
    assert with_part.code == 0
    assert 'value="wall"' in (tmp_path / "b.html").read_text()
    on_file = cli("view", run.gcode, "--machine", "grbl", "--out", tmp_path / "c.html")
    assert on_file.code == 2 and "line" in on_file.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["{missing}"], ["missing.ngc", "cannot be read"]),
        (["{text}"], ["text.ngc", "line 1", "name its machine"]),
        (["{empty}"], ["empty.ngc", "no move"]),
        (["{library}"], ["library.ngc", "only defines subroutines (o<slot>)", "a program that calls them"]),
        (["{endless}"], ["endless.ngc", "line 3", "endless loop"]),
        (["{foreign}", "--subroutines", "{missing}"], ["missing.ngc", "not a folder"]),
        (["{foreign}", "--machine", "linuxnc"], ["linuxnc", "linuxcnc"]),
        (["{foreign}", "--machine", "{missing}.toml"], ["missing.ngc.toml", "cannot be read"]),
        (["{foreign}", "--part", "{missing}"], ["missing.ngc"]),
        (["{foreign}", "--part", "{foreign}", "--job", "{foreign}"], ["--part cannot be given with --job"]),
        (["{foreign}", "--out", "{foreign}"], ["is read by this very job"]),
        (["{foreign}", "--out", "{here}"], ["a folder has this name"]),
    ],
)
def test_what_cannot_be_shown_is_stated_in_one_line(cli, foreign, tmp_path, arguments, words):
    (tmp_path / "text.ngc").write_text("Dear machine,\n")
    (tmp_path / "empty.ngc").write_text("G21\nM2\n")
    (tmp_path / "library.ngc").write_text(SLOT)
    (tmp_path / "endless.ngc").write_text("o1 while [1]\n" + "#1=2\n" + "o1 endwhile\n")
    names = {name: tmp_path / f"{name}.ngc" for name in ("missing", "text", "empty", "library", "endless")}
    there = set(tmp_path.iterdir())
    ran = cli("view", *(word.format(foreign=foreign, here=tmp_path, **names) for word in arguments))
    assert ran.code == 2 and ran.out == "" and ran.err.count("\n") == 1, ran.err
    for word in words:
        assert word in ran.err, ran.err
    assert set(tmp_path.iterdir()) == there


def test_verify_writes_a_report_and_a_picture(cli, coarse, tmp_path):
    run = coarse()
    report, picture = tmp_path / "r.html", tmp_path / "p.png"
    ran = cli("verify", run.gcode, "--job", run.job, "--report", report, "--picture", picture)
    assert ran.code == 0 and "r.html" in ran.out and "p.png" in ran.out
    assert "Nothing was found" in report.read_text() and picture.read_bytes().startswith(PNG)
    quiet = cli("verify", run.gcode, "--job", run.job, "--report", report, "--json")
    assert quiet.code == 0 and quiet.json["written"] == [str(report)]
    clash = cli("verify", run.gcode, "--job", run.job, "--report", run.job)
    assert clash.code == 2 and "is read by this very job" in clash.err


def test_a_program_without_moves_has_a_report_too(cli, coarse, tmp_path):
    still = tmp_path / "still.ngc"
    still.write_text("G21 G90 G54\nM2\n")
    ran = cli("verify", still, "--job", coarse().job, "--report", tmp_path / "r.html", "--json")
    assert ran.code == 1 and ran.err == ""
    assert "no feed moves" in (tmp_path / "r.html").read_text()


def test_run_writes_the_report_that_the_job_or_the_caller_names(cli, tmp_path):
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, ('file = "cup.ngc"', 'file = "cup.ngc"\nreport = "out/cup.html"')))
    ran = cli("run", job, "--json")
    assert ran.code == 0 and str(tmp_path / "out" / "cup.html") in ran.json["written"]
    page = (tmp_path / "out" / "cup.html").read_text()
    assert "Nothing was found" in page and "cup.ngc" in page
    named = cli("run", job, "--report", tmp_path / "named.html")
    assert named.code == 0 and (tmp_path / "named.html").read_text() == page
    assert "named.html" in named.out


def test_run_writes_the_report_of_a_faulty_program_but_not_the_program(cli, tmp_path, monkeypatch):
    from styluscam.programs import running

    job = tmp_path / "job.toml"
    job.write_text(COARSE_CUP)
    honest = running.judge_plan

    def verified(plan, text, *rest, **named):
        return honest(plan, text.replace("M2\n", "G1 X5 Y5 Z-30\nM2\n"), *rest, **named)

    monkeypatch.setattr(running, "judge_plan", verified)
    monkeypatch.setattr(running, "_require_same_moves", lambda *_: None)
    ran = cli("run", job, "--report", tmp_path / "r.html")
    assert ran.code == 1 and ran.err.splitlines()[-1].startswith("no program was written")
    assert "Must not run" in (tmp_path / "r.html").read_text()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["job.toml", "r.html"]


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8-sig"])
def test_texts_of_other_editors_are_read(encoding, tmp_path, cli):
    file = tmp_path / "other.ngc"
    file.write_bytes("(Größe Ø 3)\nG21 G90 G54\nG0 Z5\nX1 Y1\nG1 Z-1 F100\nG0 Z5\nM2\n".encode(encoding))
    assert cli("view", file, "--machine", "linuxcnc", "--out", tmp_path / "other.html").code == 0
