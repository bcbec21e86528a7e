# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our posts among those that FreeCAD lists."""

from __future__ import annotations

from pathlib import Path as FilePath

from . import machines

POSTS = FilePath(__file__).parent / "posts"


def register() -> None:
    """Makes FreeCAD look for posts in our directory too."""
    from Path import Preferences

    theirs = Preferences.searchPathsPost
    if getattr(theirs, "styluscam", False):
        return

    machines.write_user_posts()

    def search_paths() -> list[str]:
        return [str(POSTS), str(machines.user_posts()), *theirs()]

    search_paths.styluscam = True  # type: ignore[attr-defined]
    Preferences.searchPathsPost = search_paths
