# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job document's JSON schema, read: tables, their keys, and which kind of a table owns which of them.

A table with a `kind` is either one object whose kind is a choice, and every kind takes all its keys; or one alternative
a kind, each with its own keys. Both read the same here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

Schema = dict[str, Any]

KIND = "kind"
"""The key that names a table's kind."""


NOT_OF = "x-not-of"
"""What the schema states of a key, or of one form of its value: the kinds to which it means nothing."""


class SchemaError(ValueError):
    """A schema in which something expected is missing: addon and engine do not belong together."""


@dataclass(frozen=True)
class Choice:
    """A word that a key allows."""

    word: str
    text: str
    """What it means."""
    stated: Schema
    """All that the schema states of it."""


@dataclass(frozen=True)
class Key:
    """A key of a table."""

    name: str
    entry: Schema
    """Its schema, references followed; of a key that may be null, what it is otherwise."""
    nullable: bool
    required: bool
    kinds: tuple[str, ...] | None
    """The kinds that own it; None: every kind, or a table without kinds."""
    item_choices: tuple[Choice, ...] = ()
    """The words that the items of a list may be; none where it is no list of words."""

    @property
    def has_default(self) -> bool:
        """Whether the schema states what holds when it is left out."""
        return "default" in self.entry

    @property
    def choices(self) -> tuple[Choice, ...]:
        """The words that it allows; none where it is no choice."""
        return choices_of(self.entry)


@dataclass(frozen=True)
class Table:
    """A table of the document."""

    keys: dict[str, Key]
    kinds: tuple[Choice, ...]
    """Its kinds; none where it has no kind."""


class JobSchema:
    """The schema of the whole document."""

    def __init__(self, document: Schema) -> None:
        """`document` is what `styluscam.job_schema()` returns."""
        self._document = document

    def table(self, *path: str) -> Table:
        """The table at a path of the document: `table("setup", "sheet")`; of a list, or of tables by name, that of each.

        Raises:
            SchemaError: there is none.
        """
        return self._table(self._entry(path))

    def tables(self, *path: str) -> dict[str, Table]:
        """The table at a path for each of its kinds, with that kind's own texts; one without kinds under an empty word.

        Raises:
            SchemaError: there is none.
        """
        entry = self._entry(path)
        alternatives = [self._resolved(one)[0] for one in entry.get("oneOf", ())]
        if not alternatives:
            return {"": self._table(entry)}
        kinds = [_kind_of(one) for one in alternatives]
        return {
            kind.word: Table(self._keys(one, kind.word), (kind,)) for one, kind in zip(alternatives, kinds, strict=True)
        }

    def _entry(self, path: tuple[str, ...]) -> Schema:
        entry = self._document
        for name in path:
            found = self._table(entry).keys.get(name)
            if found is None:
                raise SchemaError(
                    f"the engine's job schema has no {'.'.join(path)}: update addon and engine to the same version"
                )
            entry = found.entry
            if entry.get("type") == "array":
                entry = self._resolved(entry["items"])[0]
            elif isinstance(entry.get("additionalProperties"), dict):
                entry = self._resolved(entry["additionalProperties"])[0]
        return entry

    def _table(self, entry: Schema) -> Table:
        """The table of an object, or of alternatives that a `kind` distinguishes."""
        alternatives = [self._resolved(one)[0] for one in entry.get("oneOf", ())]
        if not alternatives:
            keys = self._keys(entry, None)
            return Table(keys, keys[KIND].choices if KIND in keys else ())
        common = self._keys(entry, None)
        kinds = tuple(_kind_of(one) for one in alternatives)
        parts = [self._keys(one, kind.word) for one, kind in zip(alternatives, kinds, strict=True)]
        keys = dict(common)
        for name in dict.fromkeys(name for part in parts for name in part if name != KIND):
            owners = [part[name] for part in parts if name in part]
            every = len(owners) == len(parts)
            names = None if every else tuple(owner.kinds[0] for owner in owners if owner.kinds)
            keys[name] = replace(owners[0], kinds=names)
        keys = {name: _narrowed(key, kinds) for name, key in keys.items()}
        defaults = [one["properties"][KIND]["default"] for one in alternatives if "default" in one["properties"][KIND]]
        entry = {"description": entry.get("description", ""), "oneOf": [kind.stated for kind in kinds]}
        entry |= {"default": defaults[0]} if defaults else {}
        return Table({KIND: Key(KIND, entry, False, not defaults, None), **keys}, kinds)

    def _keys(self, entry: Schema, kind: str | None) -> dict[str, Key]:
        required = entry.get("required", ())
        keys = {}
        for name, stated in entry.get("properties", {}).items():
            found, nullable = self._resolved(stated)
            items = choices_of(self._resolved(found["items"])[0]) if found.get("type") == "array" else ()
            keys[name] = Key(name, found, nullable, name in required, None if kind is None else (kind,), items)
        return keys

    def _resolved(self, stated: Schema) -> tuple[Schema, bool]:
        """What an entry states with what it refers to, and whether it may be null as well."""
        entry, nullable = dict(stated), False
        while True:
            others = [one for one in entry.get("anyOf", ()) if one.get("type") != "null"]
            if len(others) == 1:
                nullable = nullable or len(entry["anyOf"]) > 1
                entry.pop("anyOf")
                entry = {**others[0], **entry}
            elif len(entry.get("allOf", ())) == 1:
                entry = {**entry.pop("allOf")[0], **entry}
            elif "$ref" in entry:
                entry = {**self._document["$defs"][entry.pop("$ref").rpartition("/")[2]], **entry}
            else:
                break
        types = entry.get("type")
        if isinstance(types, list):
            kept = [name for name in types if name != "null"]
            nullable = nullable or len(kept) < len(types)
            entry["type"] = kept[0] if len(kept) == 1 else kept
        return entry, nullable


def choices_of(entry: Schema) -> tuple[Choice, ...]:
    """The words that an entry allows, if nothing else."""
    if "enum" in entry:
        return tuple(Choice(str(word), "", {"const": word}) for word in entry["enum"])
    words = entry.get("oneOf", ())
    if not words or not all("const" in word for word in words):
        return ()
    return tuple(Choice(str(word["const"]), word.get("description", ""), word) for word in words)


def without(others: Iterable[str], owners: tuple[str, ...] | None, kinds: tuple[Choice, ...]) -> tuple[str, ...] | None:
    """The owners of a key without some of the kinds of its table; None for all of them stays None where none is taken out."""
    if not others:
        return owners
    names = tuple(kind.word for kind in kinds) if owners is None else owners
    return tuple(name for name in names if name not in others)


def _narrowed(key: Key, kinds: tuple[Choice, ...]) -> Key:
    """A key without the kinds to which it means nothing."""
    return replace(key, kinds=without(key.entry.get(NOT_OF, ()), key.kinds, kinds))


def _kind_of(alternative: Schema) -> Choice:
    try:
        word = str(alternative["properties"][KIND]["const"])
    except KeyError:
        raise SchemaError(
            "an alternative of the engine's job schema names no kind: update addon and engine to the same version"
        ) from None
    text = alternative.get("description", "")
    own = {name: value for name, value in alternative.items() if name.startswith("x-")}
    return Choice(word, text, {"const": word, "description": text, **own})
