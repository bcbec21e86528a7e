"""Measured points in files, as spreadsheets and measuring machines write them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from styluscam.tools.pointsfile import read_points

WANTED = [[0.0, 0.0], [1.5, 0.125], [3.0, 0.5], [4.5, 1.25]]
LINES = ["0,0", "1.5,0.125", "3.0,0.5", "4.5,1.25"]


@pytest.mark.parametrize(
    "data",
    [
        "\n".join(LINES),
        "\r\n".join(LINES) + "\r\n",
        "\ufeffr,z\n" + "\n".join(LINES),
        "# from the comparator\nradius (mm), height (mm)\n\n"
        + "\n".join(LINES[:2])
        + "\n # again\n"
        + "\n".join(LINES[2:]),
        "r;z\n0;0\n1,5;0,125\n3;0,5\n4,5;1,25\n",
        "0;0;\n1.5;0.125;\n3.0;0.5;\n4.5;1.25;\n",
        "0\t0\n1,5\t,125\n3\t5e-1\n+4.5\t1.25",
        "  0   0\n1.5 0.125\n3   0.5  # the middle\n4.5 1.25",
        "z,r\n0,0\n0.125,1.5\n0.5,3\n1.25,4.5",
        '"0","0"\n"1,5","0,125"\n"3","0,5"\n"4,5","1,25"',
        "Radius;Höhe\n0;0\n1,5;0,125\n3;0,5\n4,5;1,25".encode("latin-1"),
        "r\tz\n0\t0\n1.5\t0.125\n3\t0.5\n4.5\t1.25".encode("utf-16"),
    ],
)
def test_points_are_read(tmp_path: Path, data: Any) -> None:
    path = tmp_path / "p.csv"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    assert read_points(path) == WANTED


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("0,0\n1,1,1\n", "line 2: '1,1,1'"),
        ("r,z\n0,0\n\n1,x\n", "line 4: '1,x'"),
        ("0,0\n1\n", "line 2: '1'"),
        ("0,0\n1,nan\n", "line 2"),
        ("0,0\n1,1e999\n", "line 2"),
        ("0,0\n1_0,2\n", "line 2"),
        ("0;0\n1.000,5;2\n", "line 2"),
        ("0 0\n1,5 2,5\n", "line 1"),
        ("0,0\nr,z\n", "line 2"),
        ("", "no points"),
        ("# nothing\nr,z\n", "no points"),
    ],
)
def test_slips_are_named_with_their_line(tmp_path: Path, text: str, stated: str) -> None:
    path = tmp_path / "p.csv"
    path.write_text(text)
    with pytest.raises(sc.ToolError) as caught:
        read_points(path)
    assert stated in str(caught.value) and "p.csv" in str(caught.value) and caught.value.hint


def test_a_file_that_is_not_there_or_too_long(tmp_path: Path) -> None:
    with pytest.raises(sc.ToolError, match=r"none.csv: cannot be read: No such file"):
        read_points(tmp_path / "none.csv")
    with (tmp_path / "long.csv").open("wb") as file:
        file.truncate(30_000_000)
    with pytest.raises(sc.ToolError, match="longer than"):
        read_points(tmp_path / "long.csv")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "p.csv").write_text("\n".join(LINES))
    tool = {"name": "scan", "profile": {"kind": "points", "points": "p.csv", "fit_tolerance": 0.05}}
    (tmp_path / "scan.json").write_text(json.dumps({"schema": 1, **tool}))
    (tmp_path / "shop.json").write_text(json.dumps({"tools": [tool, {**tool, "name": "b"}]}))
    return tmp_path


def test_tool_files_and_libraries_name_files_beside_them(folder: Path) -> None:
    for name in ("scan.json", "shop.json:scan", "shop.json:b"):
        tool = sc.Tool.find(name, folder)
        assert tool.to_dict()["profile"]["points"] == WANTED
        assert tool.files == (folder / name.partition(":")[0], folder / "p.csv")
    document = {"profile": {"kind": "points", "points": "p.csv", "fit_tolerance": 0.05}}
    assert sc.Tool.from_dict(document, folder).to_dict()["profile"]["points"] == WANTED
    sc.Tool.read(folder / "scan.json").write(folder / "whole.json")
    (folder / "p.csv").unlink()
    assert sc.Tool.read(folder / "whole.json").to_dict()["profile"]["points"] == WANTED
    with pytest.raises(sc.ToolError, match=r"p.csv: cannot be read"):
        sc.Tool.read(folder / "scan.json")


JOB = """
schema = 1
title = "points = 'none.csv'" # points = "none.csv"
[part]
file = "part.step"
[process]
kind = "milling"
[tools.a]
profile = { kind = "points", points = "p.csv", fit_tolerance = 0.05 }
[tools.b]
number = 2
[tools.b.profile]
kind = "points"
"points" = 'p.csv'
fit_tolerance = 0.05
[tools.c]
number = 3
library = "shop.json:b"
[[operations]]
kind = "zig-zag"
tool = "a"
stepover = 1.0
spindle = { mode = "fixed", rpm = 8000 }
[machine]
name = "linuxcnc"
"""


def test_jobs_name_files_too(folder: Path) -> None:
    (folder / "job.toml").write_text(JOB)
    job = sc.Job.read(folder / "job.toml")
    assert [job.to_dict()["tools"][name]["profile"]["points"] for name in "abc"] == [WANTED] * 3
    assert {path.name for path in job.inputs()} == {"job.toml", "part.step", "p.csv", "shop.json"}
    document = json.loads(json.dumps(job.to_dict()))
    for name in "ab":
        document["tools"][name]["profile"]["points"] = "p.csv"
    assert sc.Job.from_dict(document, folder).to_dict() == job.to_dict()
    (folder / "job.json").write_text(json.dumps(document))
    again = sc.Job.read(folder / "job.json")
    assert again.to_dict() == job.to_dict() and folder / "p.csv" in again.inputs()
    (folder / "job.toml").write_text(JOB.replace('"p.csv"', '"q.csv"'))
    with pytest.raises(sc.ToolError, match=r"q.csv: cannot be read"):
        sc.Job.read(folder / "job.toml")


def test_only_the_points_of_a_tool_s_profile_name_a_file(folder: Path) -> None:
    line = JOB.splitlines()[2]
    assert sc.Job.from_toml(JOB, folder).title == "points = 'none.csv'"
    read = sc.Job.from_toml(JOB.replace(line, 'title = """\npoints = \'x.csv\'\n"""'), folder)
    assert read.title == "points = 'x.csv'\n"
    assert {path.name for path in read.inputs() if path.suffix == ".csv"} == {"p.csv"}


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("[machine]", "[machine", f"line {JOB.count(chr(10), 0, JOB.index('[machine]')) + 1}"),
        ("stepover = 1.0", "stepover = nan", "operations[0].stepover"),
        ("stepover = 1.0", "stepover = 1979-05-27", "operations[0].stepover"),
        ("stepover = 1.0", "stepovr = 1.0", "operations[0].stepovr"),
    ],
)
def test_errors_of_a_job_that_names_files_name_its_lines_and_keys(folder: Path, old: str, new: str, where: str) -> None:
    with pytest.raises(sc.JobError) as caught:
        sc.Job.from_toml(JOB.replace(old, new), folder)
    assert caught.value.where == where


def test_the_schema_knows_both() -> None:
    (points,) = (
        v for v in sc.job_schema()["$defs"]["ProfileDocument"]["oneOf"] if v["properties"]["kind"]["const"] == "points"
    )
    assert {each["type"] for each in points["properties"]["points"]["anyOf"]} == {"array", "string"}
