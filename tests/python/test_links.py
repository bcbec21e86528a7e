"""Every relative link, anchor and picture of the repository's pages leads somewhere, and every picture is shown somewhere."""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

import pytest

CHECKOUT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
FENCE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`[^`\n]*`")
HEADING = re.compile(r"^#{1,6} +(.+?) *$", re.MULTILINE)
FOREIGN = re.compile(r"[a-z]+:")


def pages() -> list[Path]:
    """The pages that belong to the repository, and those about to."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    listed = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=True).stdout.splitlines()
    return [CHECKOUT / name for name in listed if (CHECKOUT / name).is_file()]


def links(page: Path) -> Iterator[str]:
    """Where its links lead, foreign ones left out."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    # a link's own text may be code; a link in code is none
    bare = CODE.sub(lambda code: "" if "](" in code[0] else code[0], text)
    yield from (found for found in LINK.findall(bare) if not FOREIGN.match(found))


def anchors(page: Path) -> set[str]:
    """The names that GitHub gives the headings of a page."""
    seen: Counter[str] = Counter()
    names = set()
    for heading in HEADING.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
        shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")
        names.add(name if seen[name] == 0 else f"{name}-{seen[name]}")
        seen[name] += 1
    return names


def defects(page: Path) -> list[str]:
    found = []
    for link in links(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / unquote(path)).resolve() if path else page
        if not target.exists():
            found.append(f"{link}: no such file")
        elif CHECKOUT not in (target, *target.parents):
            found.append(f"{link}: outside the repository")
        elif anchor and (target.suffix != ".md" or anchor not in anchors(target)):
            found.append(f"{link}: no such heading")
    return found


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.relative_to(CHECKOUT).as_posix())
def test_links_lead_somewhere(page: Path) -> None:
    assert defects(page) == []


CONCEPTS = sorted(page for page in (CHECKOUT / "docs" / "concepts").glob("*.md") if page.name != "README.md")


@pytest.mark.parametrize("page", CONCEPTS, ids=lambda page: page.stem)
def test_a_module_that_a_concept_explains_names_the_page(page: Path) -> None:
    linked = [(page.parent / link).resolve() for link in links(page)]
    folders = {path if path.is_dir() else path.parent for path in linked if "rust" in path.parts}
    code = [path for path in (*linked, *(folder / "mod.rs" for folder in folders)) if path.suffix == ".rs"]
    heads = [
        line
        for file in code
        if file.is_file()
        for line in file.read_text(encoding="utf-8").splitlines()
        if line.startswith("//!")
    ]
    assert any(f"docs/concepts/{page.name}" in line for line in heads)


def test_every_picture_is_shown() -> None:
    shown = {(page.parent / link).resolve() for page in pages() for link in links(page)}
    drawn = [path for ending in ("png", "svg") for path in (CHECKOUT / "docs").rglob(f"*.{ending}")]
    assert [path.name for path in drawn if path.resolve() not in shown] == []


def test_a_broken_link_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}.CHECKOUT", tmp_path)
    (tmp_path / "other.md").write_text("# One `word` more\n\n## Twice\n\n## Twice\n")
    page = tmp_path / "page.md"
    page.write_text(
        "[a](other.md#one-word-more) [`b`](other.md#twice-1) [c](https://no.where) `[d](none.md)` ![e](none.png)\n"
        "[f](other.md#twice-2) [g](/none.md) [h](#here)\n\n```\n[i](none.md)\n```\n# Here\n"
    )
    expected = ["none.png: no such file", "other.md#twice-2: no such heading", "/none.md: no such file"]
    assert defects(page) == expected
