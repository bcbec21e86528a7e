"""The pages use the field's words: none of those that CONTRIBUTING.md replaces."""

from __future__ import annotations

import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[2]
CODE = re.compile(r"^```.*?^```$|`[^`]*`|\]\([^)]*\)", re.DOTALL | re.MULTILINE)
HISTORY = {"performance.md"}
"""Pages of measurements, in the words of their day."""
PAGES = [
    *(CHECKOUT / name for name in ("README.md", "ARCHITECTURE.md")),
    *(page for page in sorted((CHECKOUT / "docs").rglob("*.md")) if page.name not in HISTORY),
]
REPLACED = {
    "judge, judged, judgement": r"judg(?:e|es|ed|ing|ement)",
    "strays, strays by": r"stray(?:s|ed|ing)?",
    "said, unsaid, says": r"unsaid",
    "legs": r"legs",
    "flown, ridden": r"flown|ridden",
    "told, tells": r"told|tells",
    "bears": r"bears",
    "looks down, looks up": r"looks? (?:down|up)",
    "blind, unplaced moves": r"(?:blind|unplaced) moves?",
    "wanted faces": r"wanted faces?",
    "lead, way down": r"way down",
    "for its own sake": r"own sake",
    "not a point of this world": r"of this world",
}
"""Patterns of those words of the list that have no other meaning in a page, by how the list begins with them."""


def found(text: str) -> list[str]:
    """The words of the list in a text, code and addresses left out."""
    bare = CODE.sub("", text)
    return [word for pattern in REPLACED.values() for word in re.findall(rf"\b(?:{pattern})\b", bare, re.IGNORECASE)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(CHECKOUT).as_posix())
def test_a_page_uses_the_fields_words(page: Path) -> None:
    assert found(page.read_text(encoding="utf-8")) == []


def test_the_list_is_that_of_contributing() -> None:
    rows = re.findall(r"^\| (.+?) \| .+ \|$", (CHECKOUT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE)
    plain = [row.replace('"', "") for row in rows]
    assert [word for word in REPLACED if not any(row.startswith(word) for row in plain)] == []


def test_words_are_found() -> None:
    assert found("The Judge's `judge` is [told](judge.md).") == ["Judge", "told"]


PACKAGE = CHECKOUT / "python" / "styluscam"
KEPT = re.compile(
    r"judging\.\w+|^\W*judgement\W*$|judged from this text|judged, not this text|what was judged is|was not judged"
    r"|not judged: operations|unsaid-mode"
)
"""Names, and remarks that programs carry."""


def texts(file: Path) -> Iterator[tuple[int, str]]:
    """Comments and strings of a file with their lines: messages, help texts, docstrings."""
    with file.open("rb") as stream:
        for token in tokenize.tokenize(stream.readline):
            if token.type in (tokenize.COMMENT, tokenize.STRING):
                yield token.start[0], KEPT.sub("", token.string)


def left_in(folder: Path, allowed: frozenset[str] = frozenset()) -> dict[str, list[str]]:
    """The words of the list in the texts of a folder's files, but for those allowed."""
    return {
        f"{file.relative_to(folder)}:{line}": words
        for file in sorted(folder.rglob("*.py"))
        if file != Path(__file__)
        for line, text in texts(file)
        if (words := [word for word in found(text) if word.lower() not in allowed])
    }


def test_the_package_uses_the_fields_words() -> None:
    assert len(list(PACKAGE.rglob("*.py"))) > 80 and left_in(PACKAGE) == {}


def test_the_addon_uses_the_fields_words() -> None:
    assert left_in(CHECKOUT / "freecad_workbench") == {}


@pytest.mark.parametrize("folder", ("tests", "bench"))
def test_tests_and_measurements_use_the_fields_words(folder: str) -> None:
    judged = frozenset({"judge", "judges", "judged", "judging", "judgement"})
    assert left_in(CHECKOUT / folder, judged) == {}


def test_words_are_found_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("told = 1  # the legs\n")
    assert left_in(tmp_path) == {"a.py:1": ["legs"]} and left_in(tmp_path, frozenset({"legs"})) == {}
