"""Libraries of tools: the shipped ones, and those that people keep in files.

A library is a JSON file, ``{"schema": 1, "name": .., "title": .., "tools": [..]}``. An entry is the document of a tool with
a ``name``; instead of one ``profile`` it may have ``sizes``: by name, a profile each, or ``{"profile": .., "length": ..}`` with
what differs from size to size. The tool ``clothoid`` in its size ``medium`` is called ``clothoid:medium``.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib import resources
from pathlib import Path

from styluscam.errors import ToolError
from styluscam.tools import pointsfile, toolfile
from styluscam.types import Document

SHIPPED = ("forming", "milling")

KEYS = ("schema", "name", "title", "tools")
"""Keys of a library."""

ENTRY = ("name", "title", "sizes", *toolfile.TOOL)
"""Keys of an entry."""

SEPARATOR = ":"
"""Between the name of a tool and its size."""


@dataclass(frozen=True)
class Library:
    """Tools under their full names, sizes spelled out, in the order of the file."""

    name: str
    title: str
    tools: dict[str, Document]
    file: str = ""
    """That it was read from; none for a shipped one."""

    def find(self, name: str, size: str | None = None) -> Document:
        """As :func:`find`, in this library."""
        try:
            return find(name, size, [self])
        except ToolError as error:
            message = f"{self.file or self.name}: {error}"
            raise ToolError(message, code=error.code, where=error.where, hint=error.hint) from error


def names() -> list[str]:
    """Full names of the shipped tools."""
    return [name for library in shipped() for name in library.tools]


def find(name: str, size: str | None = None, libraries: Sequence[Library] | None = None) -> Document:
    """The document of a tool, of the shipped ones unless libraries are given.

    Raises:
        ToolError: there is no such tool, or it has sizes and none, or an unknown one, is asked for.
    """
    known = dict(_all(shipped() if libraries is None else libraries))
    full = f"{name}{SEPARATOR}{size}" if size is not None else name
    if full in known:
        return json.loads(json.dumps(known[full]))  # type: ignore[no-any-return]
    tool = full.partition(SEPARATOR)[0]
    sizes = [known_name.partition(SEPARATOR)[2] for known_name in known if known_name.startswith(tool + SEPARATOR)]
    if sizes:
        asked = full.partition(SEPARATOR)[2]
        message = f"{tool}: no size {asked!r}" if asked else f"{tool}: comes in sizes, and none is named"
        hint = f"choose {' or '.join(tool + SEPARATOR + each for each in sizes)}"
        raise ToolError(message, code="no-such-size", where=full, hint=hint)
    if tool in known:
        raise ToolError(f"{tool}: has no sizes", code="no-such-size", where=full, hint=f"leave {full!r} at {tool!r}")
    near = difflib.get_close_matches(full, [*known, *{each.partition(SEPARATOR)[0] for each in known}], n=1)
    own = next((shelf.file for shelf in libraries or () if shelf.file), "")
    see = f"styluscam tool list --library {own}" if own else "styluscam tool list"
    hint = f"did you mean {near[0]!r}?" if near else f"see {see}"
    raise ToolError(f"{full}: no such tool", code="no-such-tool", where=full, hint=hint)


@lru_cache(maxsize=1)
def shipped() -> tuple[Library, ...]:
    """The libraries that come with the package."""
    folder = resources.files(__name__)
    texts = [(name, (folder / f"{name}.json").read_text(encoding="utf-8")) for name in SHIPPED]
    return tuple(_library(json.loads(text), f"{name}.json", name) for name, text in texts)


def read_library(path: str | Path) -> Library:
    """A library from a file.

    Raises:
        ToolError: it cannot be read, is of a newer schema, or an entry is not one; the entry is named.
    """
    document = toolfile.read_json(path, "a library of tools")
    if "profile" in document and "tools" not in document:
        hint = f"name the file alone: {path}"
        raise ToolError(f"{path}: one tool, not a library of tools", code="document", where=str(path), hint=hint)
    found = _library(document, str(path), Path(path).stem)
    tools = {name: pointsfile.with_folder(tool, Path(path).parent) for name, tool in found.tools.items()}
    return replace(found, tools=tools, file=str(path))


def _all(libraries: Sequence[Library]) -> Iterator[tuple[str, Document]]:
    for library in libraries:
        yield from library.tools.items()


def _library(document: Document, where: str, stem: str) -> Library:
    toolfile.check_schema(document, where)
    toolfile.check_keys(document, KEYS, where)
    toolfile.check_text(document, ("name", "title"), where)
    entries = document.get("tools")
    if not isinstance(entries, list) or not entries:
        hint = 'write "tools": [{"name": "ball-d10", "profile": {"kind": "ball", "diameter": 10.0}}]'
        raise ToolError(f"{where}: no list of tools", code="document", where=where, hint=hint)
    tools: dict[str, Document] = {}
    for number, entry in enumerate(entries, start=1):
        for tool in _tools(entry, where, number):
            if tool["name"] in tools:
                message = f"{where}: two tools are called {tool['name']!r}"
                raise ToolError(message, code="duplicate", where=where, hint="names are unique in a library")
            tools[tool["name"]] = tool
    return Library(document.get("name", stem), document.get("title", ""), tools)


def _tools(entry: object, where: str, number: int) -> Iterator[Document]:
    """The tools of an entry: one, or one for each of its sizes."""
    where_in = f"{where}: tool {number}"
    if not isinstance(entry, dict):
        raise ToolError(f"{where_in}: not an object with name and profile", code="document", where=where)
    toolfile.check_text(entry, ("name", "title"), where_in)
    name = entry.get("name", "")
    if not name or name != name.strip() or SEPARATOR in name:
        hint = f"no {SEPARATOR!r} in it, and no blanks around it"
        raise ToolError(f"{where_in}: needs a name, not {name!r}", code="document", where=where, hint=hint)
    where_in = f"{where}: {name}"
    toolfile.check_keys(entry, ENTRY, where_in)
    if "sizes" not in entry:
        toolfile.check_tool(entry, where_in)
        yield entry
        return
    if "profile" in entry:
        raise ToolError(f"{where_in}: has both a profile and sizes", code="document", where=where_in, hint="keep one")
    for size, own in _sizes(entry["sizes"], where_in):
        if isinstance(own, dict) and "profile" in own:
            toolfile.check_keys(own, toolfile.TOOL, f"{where_in}: size {size}")
        tool = own if isinstance(own, dict) and "profile" in own else {"profile": own}
        toolfile.check_profile(tool["profile"], f"{where_in}: size {size}")
        rest = {key: value for key, value in entry.items() if key != "sizes"}
        title = f"{rest['title']}, {size}" if rest.get("title") else ""
        yield rest | tool | {"name": f"{name}{SEPARATOR}{size}"} | ({"title": title} if title else {})


def _sizes(sizes: object, where_in: str) -> list[tuple[str, object]]:
    if not isinstance(sizes, dict) or not sizes or any(not size.strip() for size in sizes):
        hint = 'write "sizes": {"small": {"kind": "ball", "diameter": 6.0}, ...}'
        raise ToolError(f"{where_in}: sizes are profiles by name", code="document", where=where_in, hint=hint)
    return list(sizes.items())
