"""Progress on stderr, where a person is looking."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator

from styluscam.types import Progress


@contextlib.contextmanager
def shown(wanted: bool) -> Iterator[Progress | None]:
    """A progress callback that draws a bar; None where nobody looks."""
    if not wanted or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<12}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Bar(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=1.0)

        def report(phase: str, fraction: float) -> None:
            bar.update(task, description=phase, completed=fraction)

        yield report
