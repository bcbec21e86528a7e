"""The oracles share no code with what they check."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ORACLES = Path(__file__).resolve().parents[1] / "oracles"
MODULES = {file.stem for file in ORACLES.glob("*.py")}


def imported(file: Path) -> set[str]:
    """First names of all modules that a file imports."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name.split(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add((node.module or "").split(".")[0])
    return found


@pytest.mark.parametrize("module", sorted(MODULES))
def test_an_oracle_imports_nothing_of_the_product(module: str) -> None:
    assert "styluscam" not in imported(ORACLES / f"{module}.py")
