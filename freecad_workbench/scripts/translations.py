# SPDX-License-Identifier: LGPL-2.1-or-later
"""`make translations`: every text of the addon that is translated, from its sources and the engine's schema, as a TS file.

`StylusCAM.ts` is the template. `StylusCAM_de.ts` beside it would be German: it is brought up to date, translations of texts
that remain are kept, and `StylusCAM_de.qm` is compiled from it. Needs the engine; FreeCAD and Qt are not needed.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from qt_files import Message, qm_bytes, read_ts, ts_text

ADDON = Path(__file__).resolve().parents[1]
PACKAGE = ADDON / "freecad" / "styluscam_wb"
TRANSLATIONS = PACKAGE / "resources" / "translations"
TEMPLATE = TRANSLATIONS / "StylusCAM.ts"

OURS = "StylusCAM"
"""The context of `texts.translated`."""

BARS = "Workbench"
"""The context in which FreeCAD looks for titles of bars and menus."""

PROPERTIES = "App::Property"
"""That of tool tips in the property editor."""

TRANSLATES = "translated"
"""The function that translates."""

ATTRIBUTES = ("menu_text", "tool_tip", "ToolTip")
"""Attributes of commands and workbenches that hold texts."""

PLAIN = re.compile(r"[^\W\d_]{2,}")
"""Two letters in a row: what has none is no text."""

NAMES_OF_CODE = (
    r"(StylusCAM_|CAM_|App::|Gui::|Part::).*",  # FreeCAD's classes, commands, names of widgets
    r"[A-Z][a-z]+[A-Z]\w*",
    r"Pixmap|Separator",  # what FreeCAD calls them
    r"#.*|.*;\s*",  # colours, style sheets
    r"[\w.]*_[\w.]*|[a-z]\w*|[a-z]+([-.][a-z]+)+",  # names in code and in jobs
    r"\*?[\w-]*\.\w{2,5}",  # files
)
CODE = re.compile("|".join(NAMES_OF_CODE), re.DOTALL)
"""Names, colours, style sheets, endings: no texts, though they are written as such."""


def sources() -> Iterator[tuple[Path, ast.Module]]:
    """The addon's modules."""
    for path in sorted(PACKAGE.rglob("*.py")):
        yield path, ast.parse(path.read_text(encoding="utf-8"))


def is_text(value: object) -> bool:
    """Whether a constant reads like a text for people."""
    return isinstance(value, str) and bool(PLAIN.search(value)) and not CODE.fullmatch(value)


def calls(tree: ast.AST) -> list[ast.Call]:
    """All calls of the function that translates."""
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and node.args]
    return [node for node in found if TRANSLATES in (getattr(node.func, "id", ""), getattr(node.func, "attr", ""))]


def constants(node: ast.AST) -> Iterator[str]:
    """Texts inside a node, but for documentation, f-strings and whatever is called with them by its name."""
    if isinstance(node, ast.Constant) and is_text(node.value):
        yield str(node.value)
    if isinstance(node, ast.JoinedStr | ast.FunctionDef | ast.Lambda):
        return
    for child in ast.iter_child_nodes(node):
        yield from constants(child)


def of_module(tree: ast.Module) -> Iterator[str]:
    """The texts of a module: what it writes into the function, and what the values of its names hold where it does not."""
    has_names = False
    for call in calls(tree):
        direct = [part.value for part in ast.walk(call.args[0]) if isinstance(part, ast.Constant)]
        yield from (text for text in direct if isinstance(text, str) and PLAIN.search(text))
        has_names = has_names or not isinstance(call.args[0], ast.Constant)
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield from of_class(node)
    if has_names:
        yield from of_values(tree)


def of_class(node: ast.ClassDef) -> Iterator[str]:
    """The words of a command."""
    for line in node.body:
        names = [getattr(target, "id", "") for target in getattr(line, "targets", ())]
        if set(names) & set(ATTRIBUTES):
            yield from constants(line)


def of_values(tree: ast.Module) -> Iterator[str]:
    """Texts in a module's own constants, and in collections of the functions that translate their items."""
    for line in tree.body:
        if isinstance(line, ast.Assign | ast.AnnAssign) and line.value is not None:
            yield from constants(line.value)
    for node in ast.walk(tree):
        if not isinstance(node, ast.FunctionDef) or all(isinstance(c.args[0], ast.Constant) for c in calls(node)):
            continue
        for part in ast.walk(node):
            if isinstance(part, ast.Dict | ast.List | ast.Tuple):
                yield from constants(part)


def of_arguments(tree: ast.Module) -> Iterator[str]:
    """Texts given to classes: titles and tool tips of records, which other modules translate, and words by their place."""
    for node in ast.walk(tree):
        name = getattr(node.func, "id", "") if isinstance(node, ast.Call) else ""
        if not name[:1].isupper() or name.endswith("Error"):
            continue
        named = [keyword.value for keyword in node.keywords if keyword.arg in ("title", "tool_tip")]
        for value in (*node.args, *named):
            if isinstance(value, ast.Constant):
                yield from constants(value)


def of_schema() -> Iterator[Message]:
    """Names, tool tips and words of the engine's fields and of tools, as the window shows them."""
    sys.path.insert(0, str(ADDON))
    import styluscam
    from freecad.styluscam_wb.fields import OPERATION, PATHS, PROCESS, fields_of
    from freecad.styluscam_wb.schema import JobSchema
    from freecad.styluscam_wb.tool_keys import tables_of

    schema = JobSchema(styluscam.job_schema())
    for field in fields_of(schema):
        yield PROPERTIES, field.text
        for text in (field.title, field.text, *field.choices):
            yield OURS, text
        for choice in field.words:
            yield from ((OURS, choice.word), (OURS, choice.text))
    for section in (OPERATION, PROCESS):
        for kind in schema.table(*PATHS[section]).kinds:
            yield from ((OURS, kind.word.replace("-", " ").capitalize()), (OURS, kind.text))
    for table in tables_of(schema):
        texts = [table.label, table.text]
        for kind in table.kinds:
            texts += [kind.word.replace("-", " ").capitalize(), kind.text]
        for key in (key for keys in table.keys.values() for key in keys):
            texts += [key.label, key.text]
        yield from ((OURS, text) for text in texts)


def phases() -> Iterator[str]:
    """What long work reports as it goes on: the engine's phases, and those of the addon's own reader."""
    places = [(path, r'\.begin\(\s*"([^"]+)"') for path in sorted((ADDON.parent / "rust").glob("*/src/**/*.rs"))]
    places += [(path, r'report\(progress, "([^"]+)"') for path, _ in sources()]
    for path, pattern in places:
        yield from re.findall(pattern, path.read_text(encoding="utf-8"))


def of_other_modules() -> Iterator[str]:
    """Constants of other modules that are translated by their names: `translated(ops.WHOLE_MODEL)`."""
    trees = [tree for _, tree in sources()]
    named = {getattr(call.args[0], "attr", "") for tree in trees for call in calls(tree)}
    for tree in trees:
        for line in tree.body:
            if isinstance(line, ast.Assign) and getattr(line.targets[0], "id", None) in named:
                yield from constants(line.value)


def bars() -> Iterator[str]:
    """Titles of our bars and menus."""
    tree = ast.parse((PACKAGE / "gui" / "workbench.py").read_text(encoding="utf-8"))
    for line in tree.body:
        if isinstance(line, ast.Assign) and getattr(line.targets[0], "id", "") in ("BARS", "PATH_BAR"):
            yield from constants(line.value)


def messages() -> set[Message]:
    """All of them."""
    found = {(BARS, text) for text in bars()} | set(of_schema()) | {(OURS, text) for text in phases()}
    found |= {(OURS, text) for text in of_other_modules()}
    for _, tree in sources():
        found |= {(OURS, text) for text in (*of_module(tree), *of_arguments(tree))}
    return {(context, text) for context, text in found if PLAIN.search(text)}


def write() -> list[Path]:
    """Writes the template and brings the languages up to date; returns what is there then."""
    found = messages()
    TRANSLATIONS.mkdir(parents=True, exist_ok=True)
    TEMPLATE.write_text(ts_text(found, {}), encoding="utf-8")
    written = [TEMPLATE]
    for path in sorted(TRANSLATIONS.glob("StylusCAM_*.ts")):
        done = {message: text for message, text in read_ts(path).items() if message in found}
        path.write_text(ts_text(found, done, path.stem.partition("_")[2]), encoding="utf-8")
        path.with_suffix(".qm").write_bytes(qm_bytes(done))
        written += [path, path.with_suffix(".qm")]
    return written


if __name__ == "__main__":
    for file in write():
        print(file.relative_to(ADDON))
