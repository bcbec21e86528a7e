# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our posts among those that FreeCAD lists, and the one that a new job begins with."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from . import machines


def register() -> None:
    """Makes FreeCAD look for posts in our directory too."""
    from Path import Preferences

    theirs = Preferences.searchPathsPost
    if getattr(theirs, "styluscam", False):
        return

    machines.write_user_posts()

    def search_paths() -> list[str]:
        return [str(machines.SHIPPED_POSTS), str(machines.user_posts()), *theirs()]

    search_paths.styluscam = True  # type: ignore[attr-defined]
    Preferences.searchPathsPost = search_paths


@contextmanager
def beginning_with(machine: str) -> Iterator[None]:
    """Jobs that are made meanwhile begin with the machine's post; with CAM's own default where none is named."""
    from Path import Preferences

    theirs = Preferences.defaultPostProcessor
    if machine:
        Preferences.defaultPostProcessor = lambda: machines.POST_PREFIX + machine
    try:
        yield
    finally:
        Preferences.defaultPostProcessor = theirs
