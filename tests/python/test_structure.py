"""The source's structure: no import circles between files, no file and no function that is too long."""

from __future__ import annotations

import ast
import subprocess
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[2]
ROOTS = {"styluscam": "python/styluscam", "freecad.styluscam_wb": "freecad_workbench/freecad/styluscam_wb"}
"""Packages and their folders."""

MOST_LINES, MOST_LINES_OF_FUNCTION = 600, 60


def modules_of(package: str, folder: Path) -> dict[str, Path]:
    """The package's files by the names under which they are imported."""
    found = {}
    for file in folder.rglob("*.py"):
        parts = (package, *file.relative_to(folder).with_suffix("").parts)
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = file
    return found


def imported(name: str, file: Path, modules: dict[str, Path]) -> Iterator[str]:
    """Modules of the package that a file imports, wherever in it: at its top, in a function, for types only."""
    package = name if file.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                # a name of a module is one of its submodules or stands in it
                full = f"{source}.{alias.name}"
                if full in modules or source in modules:
                    yield full if full in modules else source


def imports_of(package: str, folder: Path) -> dict[str, set[str]]:
    """What each file of a package imports of it."""
    modules = modules_of(package, folder)
    return {name: set(imported(name, file, modules)) - {name} for name, file in modules.items()}


def circle_in(graph: dict[str, set[str]]) -> list[str]:
    """Modules that import each other in a circle; empty where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
        return circle
    return []


@pytest.mark.parametrize("package", ROOTS)
def test_no_files_import_each_other_in_a_circle(package):
    graph = imports_of(package, CHECKOUT / ROOTS[package])
    assert len(graph) > 20 and sum(map(len, graph.values())) > 50
    assert not (circle := circle_in(graph)), " -> ".join(circle)


def test_circles_are_found_wherever_the_import_stands(tmp_path):
    (tmp_path / "one").mkdir()
    files = {
        "__init__.py": "",
        "top.py": "from pack.one import low\n",
        "one/__init__.py": "",
        "one/low.py": "from . import other\n",
        "one/other.py": "def late():\n    from ..top import low\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    assert set(circle_in(imports_of("pack", tmp_path))) == {"pack.top", "pack.one.low", "pack.one.other"}
    (tmp_path / "one/other.py").write_text("import os\n")
    assert circle_in(imports_of("pack", tmp_path)) == []


def tracked(*patterns: str) -> list[Path]:
    """Files of ours that git knows; what is bundled from outside is not ours."""
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=CHECKOUT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("no checkout: git lists no files")
    names = [Path(name) for name in listed.stdout.splitlines()]
    return [CHECKOUT / name for name in names if "vendor" not in name.parts and (CHECKOUT / name).is_file()]


def test_no_file_is_too_long():
    files = tracked("*.py", "*.pyi", "*.js", "*.rs")
    assert len(files) > 600
    lengths = {str(file.relative_to(CHECKOUT)): len(file.read_text().splitlines()) for file in files}
    assert {name: length for name, length in lengths.items() if length > MOST_LINES} == {}


def test_no_function_is_too_long():
    long = {}
    for file in tracked("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                length = (node.end_lineno or node.lineno) - node.lineno + 1
                if length > MOST_LINES_OF_FUNCTION:
                    long[f"{file.relative_to(CHECKOUT)}:{node.lineno} {node.name}"] = length
    assert long == {}
