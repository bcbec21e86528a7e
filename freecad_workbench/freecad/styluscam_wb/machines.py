# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines as FreeCAD's posts name them: the engine's own, and the files in the user's folder."""

from __future__ import annotations

import os
import shlex
from pathlib import Path as FilePath
from typing import Any

import FreeCAD

from . import settings

POST_PREFIX = "styluscam_"
"""FreeCAD's name of a post is this and the machine's."""

SHIPPED_POSTS = FilePath(__file__).parent / "posts"
"""The posts of the machines that are shipped."""

POST_FILE = """\
# Written by StylusCAM for {path}; it is written again when that file is there, and removed when it is not.
from freecad.styluscam_wb.posts.processor import post_for

globals()["{name}".title()] = post_for("{machine}")
"""

ARGUMENTS = {
    "--inches": ("units", "inch"),
    "--metric": ("units", "mm"),
    "--no-header": ("header", False),
    "--header": ("header", True),
    "--no-comments": ("comments", False),
    "--comments": ("comments", True),
    "--line-numbers": ("block_numbers", True),
    "--no-line-numbers": ("block_numbers", False),
    "--no-split-rapids": ("split_rapids", False),
}
"""What a job's arguments for its post may say, and the machine's option that each sets."""

VALUES = {"--precision": "decimals", "--feed-mode": "feed_mode", "--program-number": "program_number"}
"""Those with a value."""

VERIFY = {"--no-verify": False, "--verify": True}
"""Whether what is posted is verified, whatever the preferences state."""

FOR_OTHERS = ("--show-editor", "--no-show-editor")
"""Arguments of FreeCAD's own posts that say nothing about the text."""


class ArgumentError(ValueError):
    """Arguments of a post that it does not understand; the message names them."""


def user_folder() -> FilePath:
    """Where a user's machine files are looked for."""
    return settings.machine_folder()


def user_posts() -> FilePath:
    """Where the posts of a user's machine files are written for FreeCAD to find."""
    return FilePath(FreeCAD.getUserAppDataDir()) / "StylusCAM" / "posts"


def write_user_posts() -> None:
    """One post for every machine file in the user's folder, and none for files that are gone.

    A folder that was chosen and is gone is reported in FreeCAD's report view.
    """
    if problem := settings.machine_folder_problem(settings.chosen_machine_folder()):
        FreeCAD.Console.PrintWarning(f"StylusCAM: {problem}\n")
    files = {path.stem: path for path in user_folder().glob("*.toml")} if user_folder().is_dir() else {}
    expected = {f"{POST_PREFIX}{stem}_post.py": (stem, path) for stem, path in files.items()}
    if not expected and not user_posts().is_dir():
        return
    user_posts().mkdir(parents=True, exist_ok=True)
    for old in user_posts().glob(f"{POST_PREFIX}*_post.py"):
        if old.name not in expected:
            old.unlink(missing_ok=True)  # another FreeCAD may start at the same time
    for name, (stem, path) in expected.items():
        text = POST_FILE.format(path=path.name, name=f"{POST_PREFIX}{stem}", machine=stem)
        target = user_posts() / name
        if not target.is_file() or target.read_text(encoding="utf-8") != text:
            unfinished = target.with_suffix(f".{os.getpid()}")  # no other FreeCAD reads half a post
            unfinished.write_text(text, encoding="utf-8")
            unfinished.replace(target)


def names() -> list[str]:
    """The machines of the posts that FreeCAD lists: shipped ones and those of the user's files, in order."""
    files = [*SHIPPED_POSTS.glob(f"{POST_PREFIX}*_post.py"), *user_posts().glob(f"{POST_PREFIX}*_post.py")]
    return sorted({file.name.removeprefix(POST_PREFIX).removesuffix("_post.py") for file in files})


def section(machine: str) -> dict[str, str]:
    """How a job document names a machine: the user's file of this name, else a shipped one."""
    path = user_folder() / f"{machine}.toml"
    return {"file": str(path)} if path.is_file() else {"name": machine}


def options(arguments: str) -> dict[str, Any]:
    """The machine's options that a job's arguments for its post ask for.

    Raises:
        ArgumentError: an argument that is not known.
    """
    chosen: dict[str, Any] = {}
    for word in _words(arguments):
        name, equals, value = word.partition("=")
        if word in ARGUMENTS:
            key, setting = ARGUMENTS[word]
            chosen[key] = setting
        elif name in VALUES and equals:
            chosen[VALUES[name]] = _value(value)
        elif word not in (*VERIFY, *FOR_OTHERS):
            raise ArgumentError(f"the post does not know the argument {word}; it knows {', '.join(known_arguments())}")
    return chosen


def verifies(arguments: str) -> bool | None:
    """Whether what is posted with these arguments is to be verified: the last that states it counts; None where none does.

    Raises:
        ArgumentError: arguments that are no words.
    """
    stated = [VERIFY[word] for word in _words(arguments) if word in VERIFY]
    return stated[-1] if stated else None


def known_arguments() -> list[str]:
    """What a job's arguments for its post may be."""
    return [*ARGUMENTS, *VERIFY, *(f"{name}=..." for name in VALUES)]


def _words(arguments: str) -> list[str]:
    try:
        return shlex.split(arguments)
    except ValueError as error:
        raise ArgumentError(f"the post's arguments cannot be read: {error}") from error


def _value(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
