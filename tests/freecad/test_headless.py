"""`styluscam freecad run`: documents computed, verified, posted and written without a window."""

from __future__ import annotations

import dataclasses
import json
import os
import shlex
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from freecad_host import ADDON, INSIDE, FreeCad, Session

import roots
import styluscam as sc
from styluscam.freecad import Options, run_documents

pytestmark = [pytest.mark.world, pytest.mark.freecad]

CONE = "cöne 1.FCStd"

FORMED = ["Cone.Process=spif", "Cone.SheetThickness=1 mm", "Cone.ModelFace=back"]
"""The frustum is a solid and no sheet: verification finds that."""

SETTINGS = [
    "Cone.Step=0.1 in",
    "Levels.Tolerance=0.06",
    "TC: Ball 1.HorizFeed=600 mm/min",
    "Jöb.Fixtures=G55",
    "Cone.SafeHeight=12",
    "Cone.AllowUndercuts=yes",
    "Cone.ToolController=TC: Ball 1",
]

REFUSED = {
    "nonsense": "write LABEL.Property=value",
    "Cone=3": "write LABEL.Property=value",
    "Con.Step=3": "no object 'Con': did you mean 'Cone'?",
    "Cone.step=3": "no property 'step': did you mean 'Step'?",
    "Cone.Stepover=2": "no effect: z-level in milling has no Stepover",
    "Cone.Step=abc": "'abc' is no quantity",
    "Cone.Step=": "'' is no quantity",
    "Cone.Step=1e999": "is no quantity",
    "Cone.Step=3 kg": "of another kind than the property: it takes mm",
    "Cone.Step=-3": "FreeCAD makes 0.0 mm of it",
    "TC: Ball 1.HorizFeed=600": "600 has no unit: write 600 mm/min",
    "TC: Ball 1.ToolNumber=2.5": "no whole number",
    "Cone.MaxUnreached=few": "'few' is no number",
    "Cone.Strategy=zigzag": "did you mean 'zig-zag'?",
    "Cone.Active=maybe": "neither true nor false",
    "Cone.ToolController=Model": "Model is no tool controller",
    "Cone.CycleTime=3": "computed by FreeCAD and cannot be set",
    "Cone.Base=Face1": "cannot be set from a text",
    "Jöb.Fixtures=[1": "no JSON list",
}
"""Settings that are refused, and what the refusal states."""


def request(file: Path, **asked: Any) -> dict[str, Any]:
    """What the package asks of the addon."""
    return {"protocol": 1, "post": "", "jobs": [], "set": [], "copy": "", **asked, "file": str(file)}


def requests(folder: Path) -> dict[str, dict[str, Any]]:
    cone = folder / CONE
    return {
        "cone": request(cone),
        "settings": request(cone, set=SETTINGS),
        "higher": request(cone, set=["Model.Height=7.5 mm"]),
        "no model": request(cone, set=["Model.Height=0"]),
        "haas": request(cone, post="haas"),
        "formed": request(cone, set=FORMED),
        "failed": request(cone, set=["Cone.Step=0"]),
        "not verified": request(cone, set=["Jöb.PostProcessorArgs=--no-verify"]),
        "not stated": request(cone, set=["Jöb.PostProcessorArgs=--no-verify --no-header"]),
        "mixed": request(folder / "mixed.FCStd"),
        "native": request(folder / "native.FCStd"),
        "native arguments": request(folder / "native.FCStd", set=["Job.PostProcessorArgs=--bad"]),
        "native by ours": request(folder / "native.FCStd", post="styluscam_linuxcnc"),
        "two tools": request(folder / "two tools.FCStd"),
        "no cut": request(folder / "nothing to cut.FCStd"),
        "switched off": request(folder / "nothing to cut.FCStd", set=["Helix.Active=no"]),
        "empty": request(folder / "empty.FCStd"),
        "no job": request(folder / "no job.FCStd"),
        "no such job": request(cone, jobs=["Jub"]),
        "no such post": request(cone, post="linuxnc"),
        "later kind": request(folder / "later kind.FCStd"),
        "later addon": request(folder / "later addon.FCStd"),
        "later property": request(folder / "later property.FCStd"),
        "later FreeCAD": request(folder / "later FreeCAD.FCStd"),
        "later FreeCAD saved": request(folder / "later FreeCAD.FCStd", copy=str(folder / "copy.FCStd")),
        "other post": request(folder / "other post.FCStd"),
        "other protocol": request(cone) | {"protocol": 2},
        **{text: request(cone, set=[text]) for text in REFUSED},
    }


@dataclasses.dataclass(frozen=True)
class Documents:
    """The folder of the documents, and what the addon made of each request."""

    folder: Path
    session: Session

    def __getitem__(self, name: str) -> Any:
        """The report."""
        return self.session[name]

    def job(self, name: str) -> Any:
        """The only job's part of it."""
        report = self[name]
        assert report["error"] is None, report["error"]
        (job,) = report["jobs"]
        return job

    def refused(self, name: str) -> str:
        """Why nothing was posted: the user's to correct."""
        report = self[name]
        (error,) = [each for each in (report["error"], *(job["error"] for job in report["jobs"])) if each]
        assert error["exit_code"] == 2, error
        return str(error["message"])


@pytest.fixture(scope="module")
def documents(freecad: FreeCad) -> Documents:
    """All requests, in one FreeCAD that makes the documents first."""
    folder = freecad.folder / "döcuments"
    folder.mkdir()
    (folder / "requests.json").write_text(json.dumps(list(requests(folder).items())), encoding="utf-8")
    done = freecad.run(INSIDE / "headless.py", "--", str(folder))
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    results = dict(json.loads(line.removeprefix("RESULT ")) for line in lines)
    return Documents(folder, Session(done, results, folder / CONE))


@pytest.fixture(scope="module")
def words(freecad: FreeCad) -> list[str]:
    """FreeCAD's program, where it sees this package and the folder of the documents."""
    binds = [roots.Bind.same(freecad.folder, writable=True)]
    return roots.freecad_words(freecad.version, [Path(sc.__file__).parent], binds)


START = """\
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell starts in the background ignores it
from styluscam.cli import main
main()
"""
"""The command line, which heeds Ctrl-C wherever it is started."""

Cli = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture(scope="module")
def cli(freecad: FreeCad, words: list[str]) -> Cli:
    """Starts the command line as a process of its own."""
    temporary = freecad.folder / "tmp"
    temporary.mkdir()
    environment = {**os.environ, "STYLUSCAM_FREECADCMD": shlex.join(words), "TMPDIR": str(temporary)}
    environment["PYTHONPATH"] = str(Path(sc.__file__).parents[1])

    def start(*arguments: str, cwd: Path) -> subprocess.Popen[str]:
        command = [sys.executable, "-c", START, "freecad", "run", *arguments]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        return subprocess.Popen(command, cwd=cwd, env=environment, text=True, encoding="utf-8", **pipes)

    return start


# --- what the addon reports ---------------------------------------------------------------------------------------


def test_an_operation_is_computed_posted_and_verified(documents: Documents, linuxcnc: Any) -> None:
    job = documents.job("cone")
    assert (job["error"], job["notes"], job["post"]) == (None, [], "styluscam_linuxcnc")
    (operation,) = job["operations"]
    assert operation["kind"] == "milling z-level" and operation["styluscam"] and operation["active"]
    assert operation["state"] == ["Up-to-date"] and operation["error"] is None
    assert 150.0 < operation["length_mm"] < 300.0 and 5.0 < operation["duration_s"] < 60.0
    (program,) = job["programs"]
    assert program["file"] == str(documents.folder / "cöne 1.nc")
    assert program["verified"] and program["report"]["ok"] and program["report"]["gouge_max"] == 0.0
    assert 0.0 < program["report"]["excess_max"] <= 0.05 and program["report"]["samples"] > 200
    assert "judged from this text" in program["text"]
    linuxcnc(program["text"])


def test_settings_are_in_the_program(documents: Documents) -> None:
    report = documents["settings"]
    changes = {change["property"]: change for change in report["set"]}
    assert changes["Step"]["value"] == "2.54 mm" and changes["Step"]["before"] == "3.0 mm"
    assert changes["SafeHeight"]["expression"], "an expression would have put the old height back"
    (program,) = documents.job("settings")["programs"]
    read = sc.read_gcode(program["text"], "linuxcnc")
    levels = {round(z, 2) for z in read.moves["end"][:, 2] if z < 6.0}
    assert {round(6.0 - 2.54, 2), round(6.0 - 2 * 2.54, 2)} <= levels
    assert "G55" in program["text"].splitlines() and "F600" in program["text"] and "Z12" in program["text"]


def test_a_program_follows_the_model(documents: Documents) -> None:
    tops = [max(z for z in heights(documents, name) if z < 9.0) for name in ("cone", "higher")]
    assert tops[1] - tops[0] == pytest.approx(1.5, abs=0.02)


def heights(documents: Documents, name: str) -> list[float]:
    """Z of the ends of a program's feed moves in the part."""
    (program,) = documents.job(name)["programs"]
    moves = sc.read_gcode(program["text"], "linuxcnc").moves
    return [float(z) for z in moves["end"][moves["kind"] != 0][:, 2]]


@pytest.mark.parametrize("text", REFUSED)
def test_a_setting_that_means_nothing_is_refused(documents: Documents, text: str) -> None:
    message = documents.refused(text)
    assert message.startswith(f"--set {text!r}: ") and REFUSED[text] in message
    assert documents[text]["jobs"] == []


def test_another_machine(documents: Documents) -> None:
    job = documents.job("haas")
    assert job["post"] == "styluscam_haas" and job["programs"][0]["text"].startswith("%\nO00001")


def test_what_verification_finds_is_exit_code_1(documents: Documents) -> None:
    job = documents.job("formed")
    assert job["error"]["exit_code"] == 1 and job["error"]["class"] == "VerificationError"
    (program,) = job["programs"]
    assert not program["report"]["ok"]
    assert "solid-formed" in {group["kind"] for group in program["report"]["groups"]}


def test_a_failed_operation_is_named_with_what_to_do(documents: Documents) -> None:
    job = documents.job("failed")
    assert job["error"]["message"] == "Cone: step is missing"
    assert job["error"]["class"] == "JobError"
    assert job["error"]["hint"] == "add step = { height = 0.5 }" and job["error"]["exit_code"] == 2
    assert job["programs"] == [] and "Invalid" in job["operations"][0]["state"]


def test_without_verification_the_program_states_so(documents: Documents) -> None:
    job = documents.job("not verified")
    (program,) = job["programs"]
    assert job["error"] is None and not program["verified"] and program["report"] is None
    assert job["notes"] == ["not verified: --no-verify is among the job's arguments"]
    remarks = [line for line in program["text"].splitlines() if line.startswith("(")]
    assert any("not verified: --no-verify" in line for line in remarks)
    assert "judged from this text" not in program["text"]
    assert "its header is switched off" in documents.refused("not stated")


def test_operations_of_freecads_own_are_posted_and_stated(documents: Documents) -> None:
    job = documents.job("mixed")
    assert job["notes"] == ["Own lines: an operation of FreeCAD's own: posted, not verified"]
    (program,) = job["programs"]
    assert program["file"] == str(documents.folder / "out of mixed" / "Job-0.tap")
    assert not program["verified"] and "not judged" in program["text"]


def test_a_job_of_freecads_own(documents: Documents) -> None:
    job = documents.job("native")
    assert job["notes"] == ["no operation is StylusCAM's: posted, not verified"]
    (program,) = job["programs"]
    assert "linuxcnc is not StylusCAM's post" in program["unverified"] and "G1" in program["text"]
    assert "does not take the arguments '--bad'" in documents.refused("native arguments")
    report = documents["native by ours"]
    assert report["notes"] == [
        "Job: the arguments '--no-show-editor' are for linuxcnc: not used for styluscam_linuxcnc"
    ]
    assert report["jobs"][0]["error"] is None


def test_each_tool_has_its_file(documents: Documents) -> None:
    programs = documents.job("two tools")["programs"]
    assert [Path(program["file"]).name for program in programs] == [
        "two tools-TC__Ball_1.nc",
        "two tools-TC__Ball_2-1.nc",
    ]
    assert all(program["report"]["ok"] for program in programs)
    assert ["T1 M6" in programs[0]["text"], "T2 M6" in programs[1]["text"]] == [True, True]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("no cut", "Helix: it has no path, FreeCAD found nothing to cut"),
        ("switched off", "Job has no active operation"),
        ("empty", "Job has no operation"),
        ("no model", "Model has failed: "),
        ("no job", "the document has no CAM job"),
        ("no such job", "--job 'Jub': did you mean 'Jöb'?"),
        ("no such post", "'linuxnc' is no machine: did you mean 'linuxcnc'?"),
        ("later kind", 'Cone: unknown value "ultra"'),
        ("later addon", "Cone: made by an addon, or a later version of one"),
        ("later FreeCAD saved", "leave --save out"),
        ("other post", "its post styluscam_shop is not here"),
        ("other protocol", "different versions: install the same of both"),
    ],
)
def test_what_cannot_be_run_is_a_sentence(documents: Documents, name: str, message: str) -> None:
    assert message in documents.refused(name)


def test_what_a_later_version_knows_is_noted(documents: Documents) -> None:
    assert "StepOfLater" in documents["later property"]["notes"][0]
    assert "saved by FreeCAD 9.2, which is later" in documents["later FreeCAD"]["notes"][0]
    assert documents.job("later FreeCAD")["error"] is None


# --- the command line ---------------------------------------------------------------------------------------------


def test_many_documents_and_one_json(documents: Documents, cli: Cli) -> None:
    names = [CONE, "missing.FCStd", "mixed.FCStd"]
    process = cli("--addon", str(ADDON), *names, "--jobs", "2", "--json", cwd=documents.folder)
    out, err = process.communicate(timeout=400)
    assert (process.returncode, err) == (2, "")
    report = json.loads(out)
    assert [each["file"] for each in report["files"]] == names and not report["ok"]
    assert [each["exit_code"] for each in report["files"]] == [0, 2, 0]
    folder = documents.folder
    written = {name: each["written"] for name, each in zip(names, report["files"], strict=True)}
    assert written == {
        CONE: [str(folder / "cöne 1.nc")],
        "missing.FCStd": [],
        "mixed.FCStd": [str(folder / "out of mixed" / "Job-0.tap")],
    }
    text = (folder / "cöne 1.nc").read_text(encoding="utf-8")
    assert text == documents.job("cone")["programs"][0]["text"], "the same document gives the same bytes"
    assert "text" not in report["files"][0]["jobs"][0]["programs"][0]


def test_any_executor_runs_documents_and_saves_them(
    documents: Documents, words: list[str], monkeypatch: pytest.MonkeyPatch, freecad: FreeCad
) -> None:
    monkeypatch.setenv("TMPDIR", str(freecad.folder))
    monkeypatch.setattr("tempfile.tempdir", None)
    file = documents.folder / "viewed.FCStd"
    options = Options(addon=ADDON, command=words, save=True, settings=["Cone.Step=2"])
    with ProcessPoolExecutor(max_workers=1) as executor:
        (run,) = run_documents([file], options, executor=executor)
    assert run.exit_code == 0, run.errors
    assert run.written == [documents.folder / "viewed.nc", file]
    with zipfile.ZipFile(file) as saved:
        assert saved.testzip() is None
        assert saved.read("Levels.ShapeAppearance") == b"colours", "FreeCAD without a window drops the views"
        assert b"ViewProvider" in saved.read("GuiDocument.xml") and saved.read("thumbnails/Thumbnail.png") == b"picture"
        assert b'value="2.0000000000000000"' in saved.read("Document.xml")


def test_findings_and_no_addon_write_nothing(documents: Documents, cli: Cli) -> None:
    out = documents.folder / "never.nc"
    sets = [word for text in FORMED for word in ("--set", text)]
    found = cli("--addon", str(ADDON), CONE, *sets, "-o", str(out), cwd=documents.folder)
    bare = cli(CONE, "-o", str(out), cwd=documents.folder)
    for process, code, message in (
        (found, 1, "error: cöne 1.FCStd: Jöb: the posted text fails verification: "),
        (bare, 2, "error: cöne 1.FCStd: FreeCAD has no addon StylusCAM: install it"),
    ):
        with process:
            _, err = process.communicate(timeout=400)
        assert process.returncode == code and message in err and "Traceback" not in err
    assert not out.exists()


def freecads(folder: Path) -> list[str]:
    """The FreeCADs that run requests of a folder."""
    listed = subprocess.run(["ps", "-ww", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    running = [line for line in listed.splitlines() if str(folder) in line and " enter " not in line]
    return [line for line in running if Path(line.split()[0]).name.lower() == "freecadcmd"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_freecad_ends_with_the_command(documents: Documents, cli: Cli, freecad: FreeCad, number: int) -> None:
    temporary = freecad.folder / "tmp"
    with cli("--addon", str(ADDON), "two tools.FCStd", "--set", "First.Step=0.001", cwd=documents.folder) as process:
        try:
            await_that(lambda: freecads(temporary) != [])
            process.send_signal(number)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == {signal.SIGINT: 130, signal.SIGKILL: -signal.SIGKILL}[number]
    assert (out, err) == ("", "error: interrupted\n" if number == signal.SIGINT else "")
    await_that(lambda: freecads(temporary) == [])
    assert number == signal.SIGKILL or list(temporary.glob("styluscam-*")) == []
    assert not list(documents.folder.glob("two tools-*")), "nothing is written"


def await_that(is_so: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 60.0
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.1)
