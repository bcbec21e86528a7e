"""No circles between the module files of a Rust crate.

Rule. A file depends on another one of its crate when it names something that is defined there: in a `use`, or by a path in
its code. A name that a module only passes on (`use` in a parent, followed by a child or a stranger) counts for the file that
defines it. A parent that declares a child (`mod`), or that re-exports from it and does not use the name itself, does not
depend on it. So these are circles: siblings that name one another; a child that names what its parent's file defines, while
that file names the child. Methods are not followed: an `impl` of one type may be spread over the files below it. Test code
(`#[cfg(test)]`, files named tests) is left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import pytest

ROOT = Path(__file__).parents[2] / "rust"
CRATES = sorted(path.parent.name for path in ROOT.glob("*/Cargo.toml"))

Module: TypeAlias = tuple[str, ...]

_NOT_CODE = re.compile(
    r"""//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?'(?:\\.[^']*|[^'\\])'""",
    re.DOTALL,
)
_USE = re.compile(r"(\bpub(?:\([^)]*\))?\s+)?\buse\s+([^;]+);")
_PATH = re.compile(r"(?<![\w:])(?:\w+)(?:::\w+)+")
_DEFINED = re.compile(r"\b(?:struct|enum|union|trait|type|fn|const|static|macro_rules!)\s+(\w+)")
_CHILD = re.compile(r"\bmod\s+(\w+)\s*;")
_TEST_CODE = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*(?:pub(?:\([^)]*\))?\s+)?")


@dataclass
class Source:
    """A module's file as far as it matters."""

    module: Module
    code: str
    """Without uses, comments, texts and test code."""

    children: set[str]
    defined: set[str]
    uses: list[tuple[bool, list[str], str]] = field(default_factory=list)
    """Whether it is re-exported; the path; the name that it gets here (`*` for all)."""


def code_of(text: str) -> str:
    """A file's text without comments, texts and test code."""
    text = _NOT_CODE.sub(lambda found: '""' if found[0][0] not in "/'b" else " ", text)
    while found := _TEST_CODE.search(text):
        text = text[: found.start()] + text[_end_of_item(text, found.end()) :]
    return text


def _end_of_item(text: str, start: int) -> int:
    """Where an item ends: at its semicolon, or with its braces."""
    depth = 0
    for at in range(start, len(text)):
        if text[at] == "{":
            depth += 1
        elif text[at] == "}":
            depth -= 1
            if depth == 0:
                return at + 1
        elif text[at] == ";" and depth == 0:
            return at + 1
    return len(text)


def leaves(tree: str, prefix: list[str]) -> Iterator[tuple[list[str], str]]:
    """The paths of a use tree, each with the name that it gets."""
    tree = tree.strip()
    head, brace, rest = tree.partition("{")
    if brace:
        before = [part for part in head.strip().split("::") if part]
        for part in _split(rest.rstrip().removesuffix("}")):
            yield from leaves(part, prefix + before)
        return
    path, _, alias = tree.partition(" as ")
    parts = prefix + [part.strip() for part in path.split("::") if part.strip()]
    if parts and parts[-1] == "self" and len(parts) > 1:
        parts.pop()
    if parts:
        yield parts, alias.strip() or parts[-1]


def _split(text: str) -> Iterator[str]:
    """The parts between commas, those in braces left whole."""
    depth, start = 0, 0
    for at, character in enumerate(text):
        depth += {"{": 1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            yield text[start:at]
            start = at + 1
    if text[start:].strip():
        yield text[start:]


def read_source(module: Module, text: str) -> Source:
    """A file, read."""
    code = code_of(text)
    uses = [(bool(found[1]), path, name) for found in _USE.finditer(code) for path, name in leaves(found[2], [])]
    children = set(_CHILD.findall(code))
    bare = _USE.sub(" ", code)
    return Source(module, bare, children, set(_DEFINED.findall(bare)), uses)


class Crate:
    """The modules of a crate and what they name of one another."""

    def __init__(self, texts: dict[str, str]) -> None:
        """From the texts of its files, by their paths below `src`."""
        self.files: dict[Module, str] = {}
        self.sources: dict[Module, Source] = {}
        for name, text in texts.items():
            parts = Path(name).with_suffix("").parts
            if "tests" in parts:
                continue
            module = parts[:-1] if parts[-1] in {"mod", "lib"} else parts
            self.files[module] = name
            self.sources[module] = read_source(module, text)

    def home(self, base: Module, path: list[str], seen: frozenset[tuple[Module, str]] = frozenset()) -> Module | None:
        """The module that defines what a path names; nothing for other crates."""
        at: Module | None = base
        rest = list(path)
        if rest[0] == "crate":
            at, rest = (), rest[1:]
        elif rest[0] in {"self", "super"}:
            while rest and at is not None and rest[0] in {"self", "super"}:
                at = at[:-1] if rest[0] == "super" else at
                rest = rest[1:]
        elif rest[0] not in self.sources[base].children:
            return None
        while rest and at is not None and (*at, rest[0]) in self.sources:
            at, rest = (*at, rest[0]), rest[1:]
        if at is None or at not in self.sources or not rest or rest[0] == "*":
            return at if at in self.sources else None
        return self._passed_on(at, rest[0], seen) or at

    def _passed_on(self, at: Module, name: str, seen: frozenset[tuple[Module, str]]) -> Module | None:
        """Where a name comes from that a module has by a use."""
        if name in self.sources[at].defined or (at, name) in seen:
            return at if name in self.sources[at].defined else None
        seen = seen | {(at, name)}
        for _, path, known in self.sources[at].uses:
            if known == name:
                return self.home(at, path, seen)
        for _, path, known in self.sources[at].uses:
            target = self.home(at, path, seen) if known == "*" else None
            if target is not None and target != at and (found := self._passed_on(target, name, seen)):
                return found
        return None

    def edges(self) -> dict[str, set[str]]:
        """Which files each file names."""
        return {self.files[module]: self._named_by(source) for module, source in self.sources.items()}

    def _named_by(self, source: Source) -> set[str]:
        named: set[Module | None] = set()
        for public, path, name in source.uses:
            target = self.home(source.module, path)
            below = target is not None and target[: len(source.module)] == source.module
            if public and below and not re.search(rf"\b{re.escape(name)}\b", source.code):
                continue
            named.add(target)
        for found in _PATH.finditer(source.code):
            named.add(self.home(source.module, found[0].split("::")))
        return {self.files[module] for module in named if module is not None and module != source.module}


def circles(edges: dict[str, set[str]]) -> list[set[str]]:
    """The largest sets of files that all lead to one another."""
    reached = {name: _reached(edges, name) for name in edges}
    found: list[set[str]] = []
    for name in sorted(edges):
        circle = {other for other in reached[name] if name in reached[other]}
        if circle and circle not in found:
            found.append(circle)
    return found


def _reached(edges: dict[str, set[str]], start: str) -> set[str]:
    reached: set[str] = set()
    todo = list(edges[start])
    while todo:
        name = todo.pop()
        if name not in reached:
            reached.add(name)
            todo += edges[name]
    return reached


def crate_at(folder: Path) -> Crate:
    """A crate's modules."""
    source = folder / "src"
    return Crate({str(path.relative_to(source)): path.read_text("utf-8") for path in sorted(source.rglob("*.rs"))})


@pytest.mark.parametrize("name", CRATES)
def test_no_circle_between_modules(name: str) -> None:
    """In no crate."""
    edges = crate_at(ROOT / name).edges()
    found = [sorted((file, *sorted(edges[file] & circle)) for file in circle) for circle in circles(edges)]
    assert not found, f"files that depend on one another (each with those of its circle that it names): {found}"


def found_in(**texts: str) -> list[set[str]]:
    """The circles of a crate of these files; `__` stands for a folder."""
    return circles(Crate({name.replace("__", "/") + ".rs": text for name, text in texts.items()}).edges())


def test_siblings_that_name_one_another_are_a_circle() -> None:
    """By uses and by paths, through re-exports too."""
    lib = "mod a; mod b; pub use a::{A, go};"
    assert found_in(lib=lib, a="use crate::b::B; struct A; fn go() {}", b="struct B; fn f() { crate::go() }") == [
        {"a.rs", "b.rs"}
    ]
    assert found_in(lib=lib, a="use crate::{b::{B as C}}; struct A;", b="use super::A; struct B;") == [{"a.rs", "b.rs"}]
    assert found_in(lib=lib, a="use super::b; struct A;", b='// use super::A;\nconst B: &str = "crate::A";') == []


def test_a_child_and_its_parent_are_a_circle_when_each_names_the_other() -> None:
    """A declaration or a re-export names nothing; an inline test does not count."""
    child = "use super::Parent; pub struct Child; pub fn go(_: Parent) {}"
    assert found_in(lib="mod p;", p="mod c; pub use c::Child; struct Parent;", p__c=child) == []
    assert found_in(lib="mod p;", p="mod c; struct Parent; fn f() { c::go(Parent) }", p__c=child) == [
        {"p.rs", "p/c.rs"}
    ]
    assert found_in(lib="mod p;", p="mod c; use c::Child; struct Parent { child: Child }", p__c=child) == [
        {"p.rs", "p/c.rs"}
    ]
    assert found_in(lib="mod p;", p="mod c; pub use c::Child; struct Parent { child: Child }", p__c=child) == [
        {"p.rs", "p/c.rs"}
    ]
    tested = "mod c; struct Parent; #[cfg(test)] mod tests { fn f() { super::c::go(super::Parent) } }"
    assert found_in(lib="mod p;", p=tested, p__c=child) == []


def test_a_name_that_is_passed_on_counts_for_its_home() -> None:
    """A child that takes a sibling's name through its parent does not depend on the parent."""
    files = {"lib": "mod p;", "p": "mod a; mod b; use a::A; fn f(_: A) { b::go() }", "p__a": "pub struct A;"}
    assert found_in(**files, p__b="use super::A; pub fn go(_: A) {}") == []
    assert found_in(
        lib="mod a; mod b; pub use a::*;", a="pub struct A; use crate::b::B;", b="use crate::A; pub struct B;"
    ) == [{"a.rs", "b.rs"}]
