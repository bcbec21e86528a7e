"""Pages, texts and names use the field's words: none of those that CONTRIBUTING.md replaces."""

from __future__ import annotations

import ast
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
    "looks down, looks up": r"(?:looks?|looking) (?:down|up)|looks neither",
    "blind, unplaced moves": r"blind(?! holes?)|unplaced",
    "wanted faces": r"wanted faces?",
    "lead, way down": r"way down",
    "for its own sake": r"own sake",
    "X came, Y is wanted": r"(?:is|are) wanted|came, ",
    "held against": r"held against",
    "goes nowhere, nobody looked": r"goes nowhere|nobody looked",
    "not a point of this world": r"of this world",
}
"""Patterns of those words of the list that have no other meaning in a page, by how the list begins with them."""


def found(text: str, *more: str) -> list[str]:
    """The words of the list and of `more` patterns in a text, code and addresses left out."""
    bare, patterns = CODE.sub("", text), [*REPLACED.values(), *more]
    return [word for pattern in patterns for word in re.findall(rf"\b(?:{pattern})(?!\w)", bare, re.IGNORECASE)]


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
    r"|not judged: operations|^\W*not judged\W*$|unsaid-mode|^\"unsaid\"$|read-stray-word|judgement: the verification"
)
"""Names, and remarks that programs carry."""
TEXTS = (tokenize.COMMENT, tokenize.STRING, getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING))
"""Tokens that are text; from Python 3.12 on the text of an f-string is a token of its own."""
SPOKEN = r"says|said"
"""In code no person speaks: a text states, a program prints, a check reports."""
PARTS_OF_NAMES = frozenset(
    {"said", "says", "unsaid", "told", "tells", "judge", "judges", "judged", "judging", "judgement"}
    | {"stray", "strays", "strayed", "straying", "legs", "flown", "ridden", "bears"}
)
"""Words of the list that no name needs."""
WHOLE_NAMES = frozenset({"place", "places", "way", "ways"})
"""Words that mean something else within a name (`both_ways`), but not as the whole of one."""
SEEDS = frozenset({"line_strayed"})
"""Defects whose names seed the draw of their programs: under another name other programs would be tested."""


def texts(file: Path) -> Iterator[tuple[int, str]]:
    """Comments and strings of a file with their lines: messages, help texts, docstrings."""
    with file.open("rb") as stream:
        for token in tokenize.tokenize(stream.readline):
            if token.type in TEXTS:
                yield token.start[0], KEPT.sub("", token.string)


RUST = CHECKOUT / "rust"
PAGES_OF_REPORTS = PACKAGE / "report" / "page"
QUOTED = r'"(?:\\(?s:.)|[^"\\])*"'
RUST_TOKEN = re.compile(
    rf"""(?P<text>//[/!][^\n]*|\bb?r(?P<hashes>\#*)"(?s:.*?)"(?P=hashes)|{QUOTED})|//[^\n]*|'(?:\\.|[^'\\\n])'"""
)
"""Doc comments and strings; other comments and characters are passed over, for the quotation marks in them."""
SCRIPT_TOKEN = re.compile(rf"""(?P<text>//[^\n]*|/\*(?s:.*?)\*/|`(?:\\.|[^`\\])*`|'(?:\\.|[^'\\\n])*'|{QUOTED})""")
TEMPLATE_TOKEN = re.compile(r"\{[{%#](?s:.*?)[}%#]\}|(?P<text>[^{]+|\{)")
TABLE_TOKEN = re.compile(rf"(?P<text>\#[^\n]*|{QUOTED})")
TOKENS = {".rs": RUST_TOKEN, ".js": SCRIPT_TOKEN, ".jinja": TEMPLATE_TOKEN, ".toml": TABLE_TOKEN}
"""What is text in a file that is not Python's, by the ending of its name."""
TESTS_OF_RUST = re.compile(r"^#\[cfg\(test\)\]\nmod \w+ \{.*", re.DOTALL | re.MULTILINE)
PLACEHOLDER = re.compile(r"\{[^{}]*\}|\\\n\s*")
"""Values within a text, and the ends of lines that continue."""


def texts_by_tokens(file: Path) -> Iterator[tuple[int, str]]:
    """Texts of a file that is not Python's, with their lines; a Rust file's own tests are left out."""
    source = TESTS_OF_RUST.sub("", file.read_text(encoding="utf-8"))
    for token in TOKENS[file.suffix].finditer(source):
        if text := token["text"]:
            line = source.count("\n", 0, token.start()) + 1
            yield line, KEPT.sub("", PLACEHOLDER.sub("", text.strip("`")))


def left_in(folder: Path, *more: str, names: str = "*.py") -> dict[str, list[str]]:
    """The words of the list and of `more` patterns in the texts of a folder's files, by file and line."""
    lines: dict[str, list[str]] = {}
    for file in sorted(folder.rglob(names)):
        if file == Path(__file__) or (file.suffix == ".rs" and "tests" in file.relative_to(folder).parts):
            continue
        for line, text in texts(file) if file.suffix == ".py" else texts_by_tokens(file):
            if words := found(text, *more):
                lines.setdefault(f"{file.relative_to(folder)}:{line}", []).extend(words)
    return lines


def test_the_package_uses_the_fields_words() -> None:
    assert len(list(PACKAGE.rglob("*.py"))) > 80 and left_in(PACKAGE, SPOKEN) == {}


@pytest.mark.parametrize(
    ("folder", "names", "files"),
    [
        (RUST, "*.rs", 250),
        (RUST / "post" / "machines", "*.toml", 20),
        (PAGES_OF_REPORTS, "*.jinja", 3),
        (PAGES_OF_REPORTS, "*.js", 8),
    ],
)
def test_the_engine_its_machines_and_the_report_use_the_fields_words(folder: Path, names: str, files: int) -> None:
    assert len(list(folder.rglob(names))) > files and left_in(folder, SPOKEN, names=names) == {}


def test_the_addon_uses_the_fields_words() -> None:
    assert left_in(CHECKOUT / "freecad_workbench") == {}


FOLDERS = ("tests", "fixtures", "bench")


@pytest.mark.parametrize("folder", FOLDERS)
def test_tests_fixtures_and_measurements_use_the_fields_words(folder: str) -> None:
    assert left_in(CHECKOUT / folder, SPOKEN) == {}


@pytest.mark.parametrize("folder", FOLDERS)
def test_names_use_the_fields_words(folder: str) -> None:
    assert {
        f"{file.relative_to(CHECKOUT)}:{line}": name
        for file in sorted((CHECKOUT / folder).rglob("*.py"))
        for line, name in names(file.read_text(encoding="utf-8"))
        if is_replaced(name) and name not in SEEDS
    } == {}


def names(source: str) -> Iterator[tuple[int, str]]:
    """Names that a source gives to something, with their lines: functions, classes, arguments, variables, attributes."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.lineno, node.name
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.attr


def is_replaced(name: str) -> bool:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower().split("_")
    return bool(PARTS_OF_NAMES & set(words)) or name.strip("_").lower() in WHOLE_NAMES


def test_words_are_found_in_names() -> None:
    source = "def is_told(way, both_ways):\n    for place in way:\n        way.said = other.legs\nclass TheJudge: ...\n"
    assert [name for _, name in sorted(names(source)) if is_replaced(name)] == [
        "is_told",
        "way",
        "place",
        "said",
        "TheJudge",
    ]


def test_words_are_found_in_every_kind_of_file(tmp_path: Path) -> None:
    texts_by_name = {
        "a.rs": """/// The legs.\n// the legs\nlet c = '"'; say("told \\\n {legs}");\n\n#[cfg(test)]\nmod t {\n"legs" """,
        "a.js": "let legs = `a ${1}\n bears`; // the legs\n",
        "a.html.jinja": "{{ legs }}{# legs #}<p>A judge\n{% if legs %}tells</p>",
        "a.toml": 'legs = "legs"\n# flown\n',
    }
    for name, text in texts_by_name.items():
        (tmp_path / name).write_text(text)
    assert left_in(tmp_path, names="a.*") == {
        "a.rs:1": ["legs"],
        "a.rs:3": ["told"],
        "a.js:1": ["bears"],
        "a.js:2": ["legs"],
        "a.html.jinja:1": ["judge"],
        "a.html.jinja:2": ["tells"],
        "a.toml:1": ["legs"],
        "a.toml:2": ["flown"],
    }


CONSTANT = re.compile(r"`([A-Z][A-Z0-9]*(?:_[A-Z0-9]+)+)`")


def test_constants_that_the_concepts_name_exist() -> None:
    code = "\n".join(file.read_text(encoding="utf-8") for file in RUST.rglob("*.rs"))
    pages = sorted((CHECKOUT / "docs" / "concepts").glob("*.md"))
    named = {name: page.name for page in pages for name in CONSTANT.findall(page.read_text(encoding="utf-8"))}
    assert named and {name: page for name, page in named.items() if not re.search(rf"\b{name}\b", code)} == {}


def test_words_are_found_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("told = 1  # the legs\nprint(f'{1} tells')  # what it says\n")
    assert left_in(tmp_path) == {"a.py:1": ["legs"], "a.py:2": ["tells"]}
    assert left_in(tmp_path, SPOKEN) == {"a.py:1": ["legs"], "a.py:2": ["tells", "says"]}
