# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start-up, with and without a window: posts and tool bits become known when FreeCAD first needs any, not before."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from typing import Any

from . import compat, post_list, restored

NEED_POSTS = ("Path.Main.Job", "Path.Post.Processor")
"""FreeCAD's modules that look for posts, and before which no job and no tool is read.

Importing CAM at every start would cost a quarter of a second.
"""


class _InTime(MetaPathFinder):
    """Is asked about imports; finds nothing itself, and removes itself once it has registered ours."""

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: Any = None) -> None:
        if fullname in NEED_POSTS:
            sys.meta_path.remove(self)
            post_list.register()
            compat.register_toolbits()


sys.meta_path.insert(0, _InTime())
restored.watch()
