# SPDX-License-Identifier: LGPL-2.1-or-later
"""The addon as a zip whose root is an addon repository's root: `make addon`, and what the tests install.

The same files give the same bytes: entries are in the order of their names, without times, not compressed (what
deflate writes depends on zlib's version). Nothing of FreeCAD and nothing outside Python's own library is needed.
"""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

ADDON = Path(__file__).resolve().parents[1]
"""The folder with package.xml."""

ROOT_FILES = ("LICENSE", "README.md", "package.xml")
"""What stands beside the package at the root."""

PACKAGE = "freecad"
"""The folder of the namespace package."""

KINDS = (".fcstd", ".py", ".qm", ".svg", ".ts", ".ui")
"""Endings of the package's files."""

LEFT_OUT = ("__pycache__",)
"""Folders that are no part of the addon."""

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The earliest time that a zip can state."""

MODE = 0o644 << 16
"""Permissions of an entry, where zip files have them."""


class AddonError(Exception):
    """The zip cannot be made; the message states what is wrong with which file."""


def version(folder: Path = ADDON) -> str:
    """The addon's version, as its package.xml states it.

    Raises:
        AddonError: package.xml is not there, is no XML, or states none.
    """
    try:
        root = ElementTree.parse(folder / "package.xml").getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise AddonError(f"package.xml cannot be read: {error}") from error
    text = root.findtext("{*}version")
    if not text:
        raise AddonError("package.xml states no version: add <version> below <package>")
    return text


def files(folder: Path = ADDON) -> list[str]:
    """What goes into the zip, by its path there, in order.

    Raises:
        AddonError: a file of the root is missing, or the package holds one of an unknown ending.
    """
    missing = [name for name in ROOT_FILES if not (folder / name).is_file()]
    if missing:
        raise AddonError(f"{folder} has no {', '.join(missing)}")
    found = []
    for path in (folder / PACKAGE).rglob("*"):
        name = path.relative_to(folder)
        if path.is_dir() or set(name.parts) & set(LEFT_OUT):
            continue
        if path.suffix not in KINDS:
            raise AddonError(
                f"{name}: only {', '.join(KINDS)} go into the addon; remove the file or add its ending to KINDS"
            )
        found.append(name.as_posix())
    if not found:
        raise AddonError(f"{folder / PACKAGE} holds no package")
    return sorted([*ROOT_FILES, *found])


def build(target: Path, folder: Path = ADDON) -> Path:
    """Writes `StylusCAM-VERSION.zip` into a folder, which is made where it is not there, and returns its path.

    Raises:
        AddonError: what `version` and `files` raise.
    """
    names = files(folder)
    target.mkdir(parents=True, exist_ok=True)
    path = target / f"StylusCAM-{version(folder)}.zip"
    partial = path.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_STORED) as archive:
        for name in names:
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.create_system, entry.external_attr = 3, MODE
            archive.writestr(entry, (folder / name).read_bytes())
    partial.replace(path)
    return path


def unpacked(target: Path, folder: Path = ADDON) -> Path:
    """Builds the zip and unpacks it in `target`, as FreeCAD's Addon Manager does; returns the addon's folder there."""
    addon = target / "StylusCAM"
    with zipfile.ZipFile(build(target, folder)) as archive:
        archive.extractall(addon)
    return addon


def main(arguments: list[str]) -> int:
    """`addon_zip.py FOLDER`: writes the zip there and prints its path."""
    if len(arguments) != 1:
        print("usage: addon_zip.py FOLDER", file=sys.stderr)
        return 2
    try:
        print(build(Path(arguments[0])))
    except (AddonError, OSError) as error:
        print(f"addon_zip: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
