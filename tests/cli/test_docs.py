"""Every block of code in the pages that users begin with does what the page states: none is there for looks."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from long_cases import some_long

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from .conftest import CHECKOUT, FIXTURES, run_cli
from .patching import Change, patched, run_cargo

HOWTO = tuple(f"docs/howto/{page.name}" for page in sorted((CHECKOUT / "docs" / "howto").glob("add-*.md")))
PAGES = ("README.md", "docs/guide.md", "docs/posts.md", "docs/profiles.md", *HOWTO)
BLOCK = re.compile(r"^```(\w*)(?: (\S+))?\n(.*?)^```$", re.DOTALL | re.MULTILINE)
LEFT_OUT = "…"
FORMULAS = {"math", "mermaid"}


JOB = """
schema = 1
part = { file = "part.stl", units = "mm" }
process = { kind = "milling" }
machine = { name = "linuxcnc" }
output = { file = "out/cone_cup.ngc" }
setup = { zero = "model" }

[tools.stylus]
profile = { kind = "clothoid", diameter = 10.0 }

[[operations]]
kind = "zig-zag"
tool = "stylus"
stepover = 2.0
tolerance = 0.02
spindle = { mode = "fixed", rpm = 8000 }
"""
"""A job that is done in no time."""


def blocks(page: str) -> Iterator[tuple[int, str, str | None, str]]:
    """Line, language, file that it is in (if one is named) and text of every block of a page."""
    text = (CHECKOUT / page).read_text(encoding="utf-8")
    for found in BLOCK.finditer(text):
        yield text[: found.start()].count("\n") + 1, found[1], found[2], found[3]


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with what the pages speak of: the checkout's parts and job, a job, a mesh, measured points."""
    trimesh = pytest.importorskip("trimesh")
    (tmp_path / "fixtures").mkdir()
    shutil.copy(FIXTURES / "cone_cup.step", tmp_path / "fixtures")
    shutil.copytree(CHECKOUT / "examples", tmp_path / "examples")
    (tmp_path / "job.toml").write_text(JOB)
    trimesh.creation.cone(radius=12.0, height=9.0, sections=32).export(tmp_path / "part.stl")
    (tmp_path / "scan.csv").write_text("radius, height\n0, 0\n1, 0.05\n2, 0.21\n3, 0.5\n4, 1\n5, 2\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def as_console(text: str, line: int, page: str) -> None:
    """Commands of ours, as a shell would read them; a job that `new` wrote keeps its program, as the page states."""
    for number, command in enumerate(text.splitlines(), start=line + 1):
        words = shlex.split(command, comments=True)
        if words[:1] != ["styluscam"]:
            continue
        for file in re.findall(r"--out (\S+\.toml)", command):
            Path(file).unlink(missing_ok=True)
        ran = run_cli(*words[1:])
        assert ran.code == 0, f"{page}:{number}: {command}: {ran.err}{ran.out}"
        if "program = " in command:
            Path("program.json").write_bytes(next(Path().glob("*.program.json")).read_bytes())


def as_toml(text: str) -> None:
    """A machine file's end, keys of a job, or its tools."""
    if "[templates]" in text or "[rotary]" in text:
        Path("shop.toml").write_text(Path("shop.toml").read_text() + text)
        assert sc.Machine.read("shop.toml").check()
        return
    if "[[operations]]" in text:
        stated, job = tomllib.loads(text), tomllib.loads(JOB)
        job["operations"][0] |= stated["operations"][0]
        job |= {section: job[section] | keys for section, keys in stated.items() if section != "operations"}
        assert sc.Job.from_dict(job)
        return
    profiles = re.findall(r"^profile = .*$", text, re.MULTILINE)
    assert profiles
    for profile in profiles:
        tools = sc.Job.from_toml(JOB.replace('profile = { kind = "clothoid", diameter = 10.0 }', profile)).tools()
        assert tools["stylus"].diameter > 0.0


def as_quotation(text: str, line: int, page: str, file: str) -> None:
    """What a file of the repository holds, piece by piece and in its order, where something is left out."""
    rest = (CHECKOUT / file).read_text(encoding="utf-8")
    for piece in filter(None, (piece.strip("\n") for piece in text.split(LEFT_OUT))):
        _, found, rest = rest.partition(piece)
        assert found, f"{page}:{line}: {file} does not hold, after what is quoted before:\n{piece}"


def as_commands(text: str, line: int, page: str) -> None:
    """Commands of ours are run; of make there must be the targets."""
    if "styluscam " in text:
        as_console(text, line, page)
        return
    assert text.startswith("make "), f"{page}:{line}: a block of what?"
    targets = (CHECKOUT / "Makefile").read_text()
    assert all(f"\n{target}:" in targets for target in re.findall(r"^make (\w+)", text, re.MULTILINE))


def as_file(text: str, line: int, page: str, file: str, language: str) -> None:
    """A file that the reader writes, a quotation, or part of a change (see `change_of`)."""
    if "/" not in file:
        Path(file).write_text(text)
    elif language != "diff" and (CHECKOUT / file).is_file():
        as_quotation(text, line, page, file)


@pytest.mark.parametrize("page", PAGES)
def test_every_block_of_a_page_runs(page: str, desk: Path) -> None:
    names: dict[str, Any] = {}
    run: dict[str, Callable[[str, int], object]] = {
        "python": lambda text, line: exec(compile("\n" * line + text, page, "exec"), names),
        "toml": lambda text, _: as_toml(text),
        "json": lambda text, _: sc.Tool.from_dict(json.loads(text)),
        "": lambda text, line: as_commands(text, line, page),
    }
    if page.endswith("guide.md"):  # the page begins where a job was run
        assert run_cli("run", "job.toml", "--quiet").code == 0
    shown = [block for block in blocks(page) if block[1] not in FORMULAS]
    for line, language, file, text in shown:
        assert file is not None or language in run, f"{page}:{line}: nobody runs blocks of {language}"
        if file is not None:
            as_file(text, line, page, file, language)
        else:
            run[language](text, line)
    assert len(shown) >= 3


def change_of(page: str) -> Change:
    """The files that a page adds and changes."""
    change = Change(page)
    for _, language, file, text in blocks(page):
        if file is not None and language == "diff":
            change.patch(file, text)
        elif file is not None and "/" in file and not (CHECKOUT / file).exists():
            change.add(file, text)
    return change


NEW_OPERATION, NEW_PROCESS = "docs/howto/add-an-operation.md", "docs/howto/add-a-process.md"
"""Pages whose changes test_new_kind.py builds together: they are compiled alone by `make test-long`."""


@pytest.mark.parametrize("page", some_long(HOWTO, {NEW_OPERATION, NEW_PROCESS}))
def test_what_a_page_adds_compiles(page: str) -> None:
    if (change := change_of(page)).files:
        change.cargo("check")


@pytest.mark.long
@pytest.mark.parametrize("page", HOWTO)
def test_what_a_page_adds_passes_the_tests_of_its_crate(page: str) -> None:
    if (change := change_of(page)).files:
        change.cargo("test", "--lib")


def test_copies_are_not_taken_for_one_another() -> None:
    """They share the folder that cargo builds in, and both are older than what it builds of the first."""
    sound, broken = Change("sound.md"), Change("broken.md")
    file = "rust/motion/src/lib.rs"
    text = (CHECKOUT / file).read_text(encoding="utf-8")
    sound.files, broken.files = {file: text}, {file: text + "fn broken( {\n"}
    folders = [change.copy() for change in (sound, broken)]
    run_cargo(folders[0], "check", "--package", "styluscam-motion")
    with pytest.raises(AssertionError, match="fn broken"):
        run_cargo(folders[1], "check", "--package", "styluscam-motion")


def test_a_change_that_fits_nowhere_is_found() -> None:
    assert patched("a\nb\nc\n", " a\n-b\n+d\n c\n") == "a\nd\nc\n"
    for text, diff in (("a\nc\n", " b\n+d\n"), ("b\nb\n", " b\n+d\n"), ("b\n", "+d\n")):
        with pytest.raises(AssertionError, match=r"not there|nothing states"):
            patched(text, diff)


def test_a_quotation_that_is_not_in_its_file_is_found() -> None:
    text = (CHECKOUT / "Makefile").read_text()
    first, second, third, *_ = text.splitlines(keepends=True)
    as_quotation(f"{first}{LEFT_OUT}\n{third}", 1, "page", "Makefile")
    as_quotation(f"{first[:9]}{LEFT_OUT}{second[20:]}", 1, "page", "Makefile")
    for wrong in (first + third, second + LEFT_OUT + first, first + "nothing\n"):
        with pytest.raises(AssertionError, match="page:1: Makefile does not hold"):
            as_quotation(wrong, 1, "page", "Makefile")
