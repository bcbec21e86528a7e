# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which files CAM's posting wrote: it names them in the report view only, which most people have closed."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import Any

from ..verification import PostError
from .messages import translated

CLOCK_NS = 10_000_000
"""By how much a file system's clock may be behind the program's, ns."""

SHOWN_MS = 20_000
"""How long the status bar names them, ms."""


def check_target(job: Any) -> None:
    """Refuses a job that FreeCAD cannot post for reasons of its own, which it would state in a trace.

    Raises:
        PostError: an unknown post, or a folder that cannot be written to.
    """
    from Path import Preferences

    post = job.PostProcessor or Preferences.defaultPostProcessor()
    if post and post not in Preferences.allAvailablePostProcessors():
        raise PostError(f"{job.Label}: there is no post {post!r}: choose another in the job's output")
    file = _first_file(job)
    if "dialog" in Preferences.defaultOutputPolicy().casefold():
        return  # FreeCAD asks where it is to go
    if file.is_dir() or not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        raise PostError(f"{file}: no file can be written there: change the output file of {job.Label}")


def _first_file(job: Any) -> FilePath:
    from Path.Post.Utils import FilenameGenerator

    return FilePath(next(FilenameGenerator(job=job).generate_filenames()))


@contextmanager
def named_in_status_bar(job: Any) -> Iterator[None]:
    """Names in the status bar what is written, while inside, where the job's files go."""
    begun = time.time_ns() - CLOCK_NS
    yield
    import FreeCADGui

    written = _written_since(job, begun)
    if written:
        text = f"{translated('Program written:')} {', '.join(str(file) for file in written)}"
        FreeCADGui.getMainWindow().statusBar().showMessage(text, SHOWN_MS)


def _written_since(job: Any, begun_ns: int) -> list[FilePath]:
    """Files with the job's ending in the job's folder that are not older, by name."""
    first = _first_file(job)
    beside = first.parent.glob(f"*{first.suffix}") if first.parent.is_dir() else ()
    return sorted(file for file in beside if file.is_file() and file.stat().st_mtime_ns >= begun_ns)
