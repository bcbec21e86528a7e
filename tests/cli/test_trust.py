"""Small things that cost trust: files that are replaced, files taken for others, one way to write a time, lengths in inches."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import styluscam as sc
from styluscam.words import clock

from .conftest import CHECKOUT

PLATE = (
    [[x, y, z] for z in (-5.0, 0.0) for y in (0.0, 8.0) for x in (0.0, 10.0)],
    [[0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6],
     [4, 5, 7], [4, 7, 6], [0, 3, 1], [0, 2, 3]],
)  # fmt: skip
JOB = """
schema = 1
title = "Plate ä"
part = { file = "plate.stl", units = "mm" }
process = { kind = "milling" }
machine = { name = "linuxcnc" }
output = { file = "plate.ngc" }
setup = { zero = "model" }

[tools.ball]
profile = { kind = "ball", diameter = 6.0 }

[[operations]]
kind = "zig-zag"
tool = "ball"
stepover = 2.0
tolerance = 0.01
spindle = { mode = "fixed", rpm = 8000 }
"""


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder with a plate and a job for it, as the current one."""
    trimesh = pytest.importorskip("trimesh")
    trimesh.Trimesh(*PLATE, process=False).export(tmp_path / "plate.stl")
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("machine", ["linuxcnc", "heidenhain", "fanuc", "siemens", "marlin"])
def test_a_job_replaces_what_it_wrote(desk, cli, machine):
    Path("job.toml").write_text(JOB.replace("linuxcnc", machine), encoding="utf-8")
    for stepover in ("2.0", "1.5"):
        Path("job.toml").write_text(JOB.replace("linuxcnc", machine).replace("2.0", stepover), encoding="utf-8")
        assert cli("run", "job.toml", "--quiet").code == 0
    Path("plate.program.json").unlink()
    Path("plate.ngc").write_text(
        Path("plate.ngc").read_text().replace("PLATE AE", "PLATE A").replace("Plate ae", "Plate a")
    )
    assert cli("run", "job.toml", "--quiet").code == 0, "the header alone states whose it is"


FOREIGN = {
    "another program": ("plate.ngc", "G21 G90\nG0 Z10\nM2\n"),
    "notes": ("plate.ngc", "my notes on the plate\n"),
    "an empty file": ("plate.ngc", ""),
    "bytes": ("plate.ngc", "\x00\x01"),
    "a document": ("plate.program.json", '{"mine": true}\n'),
}


@pytest.mark.parametrize("foreign", FOREIGN)
def test_what_another_wrote_is_replaced_only_with_force(desk, cli, foreign):
    name, text = FOREIGN[foreign]
    Path(name).write_text(text)
    ran = cli("run", "job.toml")
    assert ran.code == 2 and f"{name}: the file exists, and this job (Plate ä) did not write it" in ran.err
    assert "--force" in ran.err and ran.err.count("\n") == 1
    assert Path(name).read_text() == text
    printed = cli("run", "job.toml", "--json")
    assert (
        printed.code == 2
        and printed.json["error"]["code"] == "exists"
        and printed.json["error"]["where"].endswith(name)
    )
    with pytest.raises(sc.JobError, match="did not write it"):
        sc.run("job.toml")
    assert cli("run", "job.toml", "--force", "--json").json["ok"]
    assert Path(name).read_text() != text
    assert sc.run("job.toml").report.ok


def test_another_job_does_not_replace_it(desk, cli):
    assert cli("run", "job.toml", "--quiet").code == 0
    Path("other.toml").write_text(JOB.replace("Plate ä", "Another"), encoding="utf-8")
    ran = cli("run", "other.toml")
    assert ran.code == 2 and "this job (Another) did not write it" in ran.err


def test_a_part_or_a_program_is_no_job(desk, cli):
    for command in (["run"], ["plan"], ["tool", "suggest"]):
        ran = cli(*command, "plate.stl")
        assert ran.code == 2 and "this is a part, not a job; styluscam new plate.stl writes a job for it" in ran.err
    assert "this is a part" in cli("run", "nowhere/a part.STEP").err
    assert "styluscam new 'nowhere/a part.STEP'" in cli("run", "nowhere/a part.STEP").err
    ran = cli("run", "plate.ngc")
    assert ran.code == 2 and "this is G-code, not a job; styluscam verify plate.ngc --job JOB.toml" in ran.err
    assert cli("run", "plate.stl", "--json").json["error"]["code"] == "not-a-job"


def test_a_job_is_no_part(desk, cli):
    for command in (["new"], ["part", "show"]):
        ran = cli(*command, "job.toml")
        assert ran.code == 2 and "job.toml: this is a job, not a part: styluscam run job.toml" in ran.err
    assert cli("new", "job.toml", "--json").json["error"]["code"] == "part-is-job"


def test_every_machine_in_the_list_has_its_evidence(cli):
    rows = [re.split(r"\s{2,}", line.strip()) for line in cli("machine", "list").out.splitlines()[2:] if line.strip()]
    assert [row[0] for row in rows] == sc.Machine.names()
    assert all(len(row) == 3 for row in rows), rows
    words = {row[0]: row[2] for row in rows}
    assert words["grbl"] == "all read at the source" and words["mazak"] == "UNVERIFIED"


def test_times_are_written_one_way():
    assert clock(306.0) == "0:05:06"
    sources = [*(CHECKOUT / "python").rglob("*.py"), *(CHECKOUT / "python").rglob("*.js")]
    other = re.compile(r"\bmin \{[^}]*\} s\b|\bmin \$\{")
    assert [path.name for path in sources if "vendor" not in path.parts and other.search(path.read_text("utf-8"))] == []


def test_help_and_readme_say_both_codes_of_a_cancelled_run(cli):
    for text in (cli("--help").out, (CHECKOUT / "README.md").read_text(encoding="utf-8")):
        assert "3 cancelled (130 by Ctrl-C)" in " ".join(text.split())


INCHES = (
    JOB.replace('title = "Plate ä"', 'title = "Plate"\nunits = "inch"')
    .replace("diameter = 6.0", "diameter = 0.25, tip_flat = 0.02")
    .replace("stepover = 2.0", "stepover = 0.08\nfeeds = { cut = 60.0 }")
    .replace("tolerance = 0.01", "tolerance = 0.0004")
)


def test_lengths_in_inches(desk, cli):
    Path("job.toml").write_text(INCHES, encoding="utf-8")
    job = sc.Job("job.toml")
    assert job.to_dict()["tools"]["ball"]["profile"]["diameter"] == 6.35
    assert (job.operations[0]["stepover"], job.operations[0]["feeds"]["cut"]) == (2.032, 1524.0)
    assert job.to_dict()["operations"][0]["feeds"]["plunge"] == 300.0, "what is left out is as in mm"
    again = sc.Job.from_dict(job.to_dict(), desk)
    assert again == job
    Path("job.json").write_text(json.dumps({**json.loads(json.dumps(sc.Job("job.toml").to_dict()))}))
    assert sc.plan("job.toml").programs["main"] == sc.plan(again).programs["main"]
    ran = cli("run", "job.toml", "--json")
    assert ran.code == 0 and ran.json["ok"] and ran.json["summary"]["part_max"] == [10.0, 8.0, 0.0]


def test_a_points_file_of_a_job_in_inches_is_in_inches(desk):
    Path("scan.csv").write_text("0, 0\n0.1, 0.005\n0.2, 0.05\n0.3, 0.2\n")
    Path("job.toml").write_text(
        INCHES.replace('kind = "ball", diameter = 0.25, tip_flat = 0.02', 'kind = "points", points = "scan.csv"')
    )
    assert sc.Job("job.toml").tools()["ball"].diameter == pytest.approx(0.6 * 25.4)
    sc.Tool({"profile": {"kind": "ball", "diameter": 6.0}}).write("ball.json")
    Path("job.toml").write_text(
        INCHES.replace('profile = { kind = "ball", diameter = 0.25, tip_flat = 0.02 }', 'library = "ball.json"')
    )
    assert sc.Job("job.toml").tools()["ball"].diameter == 6.0, "tool files are mm"


def test_errors_are_in_inches_too(desk, cli):
    Path("job.toml").write_text(INCHES.replace("stepover = 0.08", "stepover = 8.0"))
    ran = cli("plan", "job.toml")
    assert ran.code == 2 and "stepover = 8: allowed is above 0 and up to 3.93701 inch" in ran.err
    Path("job.toml").write_text(INCHES.replace('units = "inch"\n', 'units = "inches"\n'))
    assert 'units: unknown value "inches"; did you mean "inch"?' in cli("plan", "job.toml").err


def test_posting_inches_states_which_decimals_are_enough(desk, cli):
    fine = JOB.replace("tolerance = 0.01", "tolerance = 0.005")
    inches = fine.replace('name = "linuxcnc"', 'name = "linuxcnc", options = { units = "inch" }')
    Path("job.toml").write_text(inches, encoding="utf-8")
    ran = cli("run", "job.toml")
    if ran.code == 0:  # the machine's own decimals are enough
        inches = inches.replace('units = "inch"', 'units = "inch", decimals = 3')
        Path("job.toml").write_text(inches, encoding="utf-8")
        ran = cli("run", "job.toml")
    assert ran.code == 2
    found = re.search(r"add options = \{ decimals = (\d) \} to \[machine\]", ran.err)
    assert found, ran.err
    options = f'units = "inch", decimals = {found[1]} }}'
    Path("job.toml").write_text(re.sub(r'units = "inch"[^}]*\}', options, inches), encoding="utf-8")
    assert cli("run", "job.toml", "--quiet").code == 0, "what the error proposes works"
    fewer = f'units = "inch", decimals = {int(found[1]) - 1} }}'
    Path("job.toml").write_text(re.sub(r'units = "inch"[^}]*\}', fewer, inches), encoding="utf-8")
    assert cli("run", "job.toml", "--quiet").code == 2, "and is the fewest"
