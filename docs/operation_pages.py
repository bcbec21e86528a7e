"""Writes docs/operations.md: every kind of operation and process with its keys, from the job's schema.

python docs/operation_pages.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import styluscam as sc

PAGE = Path(__file__).with_name("operations.md")

HEAD = """# Operations and processes

Written by `make operations` from the schema of the job document (`styluscam schema`); a test holds the two together.
Lengths are mm, angles degrees, feeds mm/min. A key that a kind does not take is an error.
"""


def page(schema: dict[str, Any]) -> str:
    """The page's text."""
    definitions = schema["$defs"]
    operations, processes = definitions["OperationSection"], definitions["ProcessSection"]
    common = _common(operations)
    parts = [HEAD, "## Keys of every operation\n", _table(common, schema)]
    for kind in operations["oneOf"]:
        parts += _kind(kind, common, schema)
    common = _common(processes)
    parts += ["## Keys of every process\n", _table(common, schema)]
    for kind in processes["oneOf"]:
        parts += _kind(kind, common, schema)
    return "\n".join(parts)


def _common(family: dict[str, Any]) -> dict[str, Any]:
    """The keys that all kinds of a family take."""
    first, *others = (kind["properties"] for kind in family["oneOf"])
    shared = [key for key in first if key != "kind" and all(key in other for other in others)]
    return {key: first[key] for key in shared}


def _kind(kind: dict[str, Any], common: dict[str, Any], schema: dict[str, Any]) -> list[str]:
    own = {key: value for key, value in kind["properties"].items() if key != "kind" and key not in common}
    required = [key for key in own if key in kind["required"]]
    table = _table(own, schema, required) if own else "No keys of its own.\n"
    return [f"## `{kind['title']}`\n", f"{kind['description']}\n", table]


def _table(keys: dict[str, Any], schema: dict[str, Any], required: list[str] | None = None) -> str:
    rows = ["| key | what | allowed | default |", "|---|---|---|---|"]
    for key, value in keys.items():
        default = "required" if key in (required or []) else _default(value)
        rows.append(f"| `{key}` | {_plain(value.get('description', ''))} | {_allowed(value, schema)} | {default} |")
    return "\n".join(rows) + "\n"


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _default(value: dict[str, Any]) -> str:
    default = value.get("default")
    if default in (None, ""):
        return ""
    if isinstance(default, dict):
        return "`{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in default.items()) + " }`"
    return f"`{_toml(default)}`"


def _toml(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def _allowed(value: dict[str, Any], schema: dict[str, Any]) -> str:
    """Range or words of a key, as far as it has them, and an example."""
    low, open_low, high = (value.get(name) for name in ("minimum", "exclusiveMinimum", "maximum"))
    if high is not None and (low is not None or open_low is not None):
        return f"above {open_low:g} and up to {high:g}" if low is None else f"{low:g} to {high:g}"
    if "x-example" in value:
        return f"`{value['x-example']}`"
    reference = value.get("$ref") or next((one["$ref"] for one in value.get("anyOf", []) if "$ref" in one), None)
    if reference is None:
        return ""
    definition = schema["$defs"][reference.rsplit("/", 1)[1]]
    words = [str(choice["const"]) for choice in definition.get("oneOf", []) if "const" in choice]
    words += [str(word) for word in definition.get("enum", [])]
    return ", ".join(f'`"{word}"`' for word in words)


if __name__ == "__main__":
    PAGE.write_text(page(sc.job_schema()), encoding="utf-8")
