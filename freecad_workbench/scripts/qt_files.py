# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt's files of translations: TS (XML, for translators) written and read, QM (for programs) compiled from them.

Formats: "TS file format" of Qt's Linguist manual; QM as QTranslator reads it: sections of a tag, a length and data, of
which hashes of the source texts and the messages they lead to are needed.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import escape

Message = tuple[str, str]
"""Context and source text."""

MAGIC = bytes.fromhex("3cb86418caef9c95cd211cbf60a1bddd")
"""How QM files begin."""

HASHES, MESSAGES = 0x42, 0x69
"""Tags of the sections."""

END, TRANSLATION, SOURCE, CONTEXT = 1, 3, 6, 7
"""Tags inside a message."""


def ts_text(messages: Iterable[Message], translations: Mapping[Message, str], language: str = "") -> str:
    """A TS file: contexts and messages in order, those without a translation unfinished."""
    attribute = f' language="{escape(language)}"' if language else ""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!DOCTYPE TS>"]
    lines.append(f'<TS version="2.1"{attribute} sourcelanguage="en">')
    contexts: dict[str, list[str]] = {}
    for context, source in sorted(set(messages)):
        contexts.setdefault(context, []).append(source)
    for context, sources in contexts.items():
        lines += ["<context>", f"    <name>{escape(context)}</name>"]
        for source in sources:
            done = translations.get((context, source), "")
            state = "" if done else ' type="unfinished"'
            lines += ["    <message>", f"        <source>{escape(source)}</source>"]
            lines += [f"        <translation{state}>{escape(done)}</translation>", "    </message>"]
        lines.append("</context>")
    return "\n".join([*lines, "</TS>", ""])


def read_ts(path: Path) -> dict[Message, str]:
    """Every message of a TS file with its translation, empty where there is none.

    Raises:
        xml.etree.ElementTree.ParseError: the file is not XML.
    """
    found = {}
    for context in ElementTree.parse(path).getroot().iter("context"):
        for message in context.iter("message"):
            key = (context.findtext("name") or "", message.findtext("source") or "")
            found[key] = message.findtext("translation") or ""
    return found


def qm_bytes(translations: Mapping[Message, str]) -> bytes:
    """A QM file of those that are translated."""
    messages, hashes = bytearray(), []
    for (context, source), done in sorted(translations.items()):
        if not done:
            continue
        hashes.append((elf_hash(source.encode()), len(messages)))
        for tag, data in (
            (TRANSLATION, done.encode("utf-16-be")),
            (SOURCE, source.encode()),
            (CONTEXT, context.encode()),
        ):
            messages += struct.pack(">BI", tag, len(data)) + data
        messages.append(END)
    table = b"".join(struct.pack(">II", *pair) for pair in sorted(hashes))
    sections = ((HASHES, table), (MESSAGES, bytes(messages)))
    return MAGIC + b"".join(struct.pack(">BI", tag, len(data)) + data for tag, data in sections)


def elf_hash(data: bytes) -> int:
    """The hash of System V's object files (System V ABI, chapter 5), by which QM files are searched; never 0."""
    value = 0
    for byte in data:
        value = (value << 4) + byte
        high = value & 0xF0000000
        value = (value ^ (high >> 24)) & ~high & 0xFFFFFFFF
    return value or 1
