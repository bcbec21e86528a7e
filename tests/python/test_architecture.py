"""The diagram of ARCHITECTURE.md is the graph that Cargo builds and Python imports, edge for edge."""

from __future__ import annotations

import ast
import json
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

CHECKOUT = Path(__file__).resolve().parents[2]
PAGE = CHECKOUT / "ARCHITECTURE.md"
PREFIX = "styluscam-"

Edges = set[tuple[str, str]]


def drawn(arrow: str) -> Edges:
    """The edges of the page's only diagram with this arrow."""
    diagrams = re.findall(r"^```mermaid\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert len(diagrams) == 1
    lines = [line.strip() for line in diagrams[0].splitlines()[1:]]
    edges = [re.fullmatch(r"(\w+) (-->|-\.->) (\w+)", line) for line in lines if line]
    assert all(edges), f"not an edge: {[line for line, edge in zip(lines, edges, strict=True) if not edge]}"
    found = [(edge[1], edge[3]) for edge in edges if edge and edge[2] == arrow]
    assert len(found) == len(set(found)), "an edge is drawn twice"
    return set(found)


def packages() -> list[dict[str, Any]]:
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1", "--offline"]
    ran = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=True)
    found: list[dict[str, Any]] = json.loads(ran.stdout)["packages"]
    return found


def cargo_edges() -> Edges:
    """Dependencies between members of the workspace, of tests and of builds too."""
    names = {package["name"] for package in packages()}
    assert all(name.startswith(PREFIX) for name in names)
    return {
        (package["name"].removeprefix(PREFIX), needed["name"].removeprefix(PREFIX))
        for package in packages()
        for needed in package["dependencies"]
        if needed["name"] in names
    }


def imported(folder: Path) -> Iterator[str]:
    """The modules that the files of a package import, by their full names."""
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from (alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                yield node.module
                yield from (f"{node.module}.{alias.name}" for alias in node.names)


def python_edges() -> Edges:
    sources = {"styluscam": CHECKOUT / "python", "freecad_workbench": CHECKOUT / "freecad_workbench"}
    edges = set()
    for name, folder in sources.items():
        modules = set(imported(folder))
        if any(module.startswith("styluscam._engine") for module in modules):
            edges.add((name, "bindings"))
        if name != "styluscam" and any(re.match(r"styluscam(\.(?!_engine)|$)", module) for module in modules):
            edges.add((name, "styluscam"))
        if name != "freecad_workbench" and any(module.startswith("freecad.") for module in modules):
            edges.add((name, "freecad_workbench"))
    return edges


def test_solid_arrows_are_dependencies_of_cargo() -> None:
    page, cargo = drawn("-->"), cargo_edges()
    assert page - cargo == set(), "drawn, but no dependency"
    assert cargo - page == set(), "a dependency that is not drawn"


def test_dotted_arrows_are_imports_of_python() -> None:
    assert drawn("-.->") == python_edges()


def test_the_verifier_reaches_the_planner_over_no_path() -> None:
    reached, edges = {"verify"}, cargo_edges()
    while more := {to for source, to in edges if source in reached} - reached:
        reached |= more
    assert "toolpath" not in reached


def test_every_crate_has_a_row() -> None:
    rows = set(re.findall(r"^\| \[`rust/(\w+)`\]", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    assert rows == {package["name"].removeprefix(PREFIX) for package in packages()}
