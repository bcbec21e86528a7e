"""A kind of operation or of process is one file and one line: those of docs/howto are found wherever kinds are named."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from .conftest import CHECKOUT
from .patching import TARGET
from .test_docs import NEW_OPERATION, NEW_PROCESS, change_of

LOOK = r"""
import json, sys
from pathlib import Path
import styluscam as sc
from styluscam import _engine

sys.path.insert(0, sys.argv[1])
from operation_pages import page

found = {"schema": sc.job_schema(), "page": page(sc.job_schema())}
job = sc.Job.read("job.toml")
result = sc.run(job, report="report.html")
operation = result.summary.operations[0]
found["summary"] = {"kind": operation.kind, "words": operation.words, "facts": [fact.fact for fact in operation.facts]}
found["findings"] = result.report.to_dict()["findings"]
found["text"] = next(iter(result.posted.files.values()))
found["report"] = Path("report.html").read_text(encoding="utf-8")
found["starter"] = sc.starter_job(job.part().arrays, "part.stl", "mm").text
found["estimates"] = json.loads(job.engine.estimates(job.part().engine))
document = job.to_dict()
document["operations"][0]["stepover"] = 1.0
try:
    sc.Job.from_dict(document, job.folder)
except sc.JobError as error:
    found["foreign"] = [error.code, error.where, str(error)]
print(json.dumps(found))
"""

JOB = """
schema = 1
part = { file = "part.stl", units = "mm", tolerance = 0.001 }
process = { kind = "milling" }
machine = { name = "linuxcnc" }
output = { file = "dish.ngc" }
setup = { zero = "model" }

[tools.ball]
profile = { kind = "ball", diameter = 4.0 }

[[operations]]
kind = "rings"
tool = "ball"
ring_distance = 1.0
tolerance = 0.01
spindle = { mode = "fixed", rpm = 8000 }
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package with an engine that has the pages' kinds."""
    change = change_of(NEW_OPERATION)
    assert sorted(change.files) == ["rust/job/src/operations/mod.rs", "rust/job/src/operations/rings.rs"]
    process = change_of(NEW_PROCESS)
    assert sorted(process.files) == ["rust/job/src/process/mod.rs", "rust/job/src/process/relay.rs"]
    change.files |= process.files
    change.name = "new-kind"  # the page's own test may run beside this one
    change.cargo("build", crate="bindings")
    package = tmp_path_factory.mktemp("new-kind")
    shutil.copytree(
        CHECKOUT / "python" / "styluscam", package / "styluscam", ignore=shutil.ignore_patterns("*.so", "__pycache__")
    )
    shutil.copy(TARGET / "quick" / "lib_engine.so", package / "styluscam" / "_engine.abi3.so")
    return package


def test_a_new_kind_is_one_file_and_one_line_and_is_found_everywhere(package: Path, tmp_path: Path) -> None:
    import trimesh

    trimesh.creation.icosphere(subdivisions=3, radius=6.0).export(tmp_path / "part.stl")
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(package)}
    run = subprocess.run(
        [sys.executable, "-c", LOOK, str(CHECKOUT / "docs")],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    kinds = {kind["title"]: kind for kind in found["schema"]["$defs"]["OperationSection"]["oneOf"]}
    assert kinds["rings"]["properties"]["ring_distance"]["maximum"] == 100.0
    assert "ring_distance" not in kinds["z-level"]["properties"]
    assert "## `rings`" in found["page"] and "`ring_distance`" in found["page"]
    assert found["summary"]["kind"] == "rings" and " rings" in found["summary"]["words"]
    assert set(found["summary"]["facts"]) == {"rings", "passes"}
    (note,) = [finding for finding in found["findings"] if finding["kind"] == "not-checked"]
    assert note["severity"] == "note" and "its passes are not checked" in note["message"]
    assert "rings-1" in found["text"] and "rings" in found["report"]
    assert '"rings" for dishes' in found["starter"]
    assert found["estimates"][0]["key"] == "ring_distance"
    code, where, message = found["foreign"]
    assert (code, where) == ("foreign-key", "operations[0].stepover")
    assert "stepover is a key of zig-zag" in message and "rings" in message

    shown = subprocess.run(
        [sys.executable, "-m", "styluscam", "run", "job.toml", "--force"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert shown.returncode == 0, shown.stderr
    assert "rings-1: rings, " in shown.stdout
    assert "passes are not checked" in shown.stderr and "with these notes" in shown.stderr


RELAY = """
schema = 1
part = { file = "part.stl", units = "mm", tolerance = 0.001 }
process = { kind = "relay" }
machine = { name = "linuxcnc" }
machines.finish = { name = "grbl" }
output = { file = "ball.ngc", report = "ball.html" }
setup = { zero = "model" }

[tools.wide]
profile = { kind = "ball", diameter = 4.0 }
[tools.narrow]
number = 2
profile = { kind = "ball", diameter = 3.0 }

[[operations]]
kind = "z-level"
tool = "wide"
step = { height = 1.0 }
z_bottom = 0.0
tolerance = 0.01
spindle = { mode = "fixed", rpm = 8000 }

[[operations]]
kind = "zig-zag"
tool = "narrow"
stepover = 1.0
z_bottom = 0.0
tolerance = 0.01
spindle = { mode = "fixed", rpm = 8000 }
channel = "finish"
"""


@pytest.fixture
def relay(package: Path, tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the command line on a ball, in a folder with a job of two channels."""
    import trimesh

    trimesh.creation.icosphere(subdivisions=3, radius=6.0).export(tmp_path / "part.stl")
    (tmp_path / "job.toml").write_text(RELAY, encoding="utf-8")

    def run(*words: str, job: str = RELAY) -> subprocess.CompletedProcess[str]:
        (tmp_path / "job.toml").write_text(job, encoding="utf-8")
        command = [sys.executable, "-m", "styluscam", *words]
        environment = os.environ | {"PYTHONPATH": str(package)}
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    return run


def test_every_channel_has_its_program_report_and_verification(
    relay: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    ran = relay("run", "job.toml", "--json", "--picture", "ball.png")
    assert ran.returncode == 0, ran.stderr + ran.stdout
    document = json.loads(ran.stdout)
    names = {"ball.ngc", "ball.program.json", "ball.html", "ball.png"}
    assert {Path(name).name for name in document["written"]} == names | {
        name.replace("ball", "ball.finish", 1) for name in names
    }
    assert all((tmp_path / name).stat().st_size > 1000 for name in document["written"])
    finish = document["channels"]["finish"]
    assert [each["id"] for each in document["summary"]["operations"]] == ["z-level-1"]
    assert [each["id"] for each in finish["summary"]["operations"]] == ["zig-zag-2"]
    assert [tool["number"] for tool in finish["summary"]["tools"]] == [2]
    assert document["report"]["ok"] and finish["report"]["ok"]
    assert [document["summary"]["machine"], finish["summary"]["machine"]] == ["linuxcnc", "grbl"]
    again = relay("run", "job.toml")
    assert again.returncode == 0, again.stderr
    assert [line.split() for line in again.stdout.splitlines() if line.startswith("channel")] == [
        ["channel", "main"],
        ["channel", "finish"],
    ]
    checked = relay("verify", "ball.finish.ngc", "--job", "job.toml", "--channel", "finish")
    assert checked.returncode == 0, checked.stderr + checked.stdout
    mixed_up = relay("verify", "ball.finish.ngc", "--job", "job.toml")
    assert mixed_up.returncode != 0, mixed_up.stdout


@pytest.mark.parametrize(
    ("before", "after", "code", "where"),
    [
        ('channel = "finish"', 'channel = "finnish"', "unknown", "operations[1].channel"),
        ('channel = "finish"', "", "empty", "operations"),
        ("machines.finish", "machines.rest", "unknown", "machines.rest"),
        ('machines.finish = { name = "grbl" }', "", "missing", "machines.finish"),
        ("machines.finish = {", 'machines.main = { name = "grbl" }\nmachines.finish = {', "conflict", "machines.main"),
        ('machines.finish = { name = "grbl" }', "machines.finish = {}", "conflict", "machines.finish"),
        ('kind = "relay"', 'kind = "milling"', "unknown", "operations[1].channel"),
        ('name = "grbl"', 'name = "grbll"', "machine-unknown", "machines.finish.name"),
        ('name = "grbl"', 'name = "grbl", options.foo = 1', "machine-unknown-option", "machines.finish.options.foo"),
    ],
)
def test_channels_and_machines_that_there_are_not_are_refused(
    relay: Callable[..., subprocess.CompletedProcess[str]], before: str, after: str, code: str, where: str
) -> None:
    assert before in RELAY
    ran = relay("plan", "job.toml", "--json", job=RELAY.replace(before, after))
    assert ran.returncode == 2, ran.stdout
    error = json.loads(ran.stdout)["error"]
    assert (error["code"], error["where"]) == (code, where)
    assert error["hint"]


def test_the_page_of_operations_is_the_schema() -> None:
    import importlib.util

    import styluscam as sc

    file = CHECKOUT / "docs" / "operation_pages.py"
    specification = importlib.util.spec_from_file_location("operation_pages", file)
    assert specification is not None and specification.loader is not None
    pages = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(pages)
    assert (CHECKOUT / "docs" / "operations.md").read_text(encoding="utf-8") == pages.page(sc.job_schema())
