"""Pages and pictures that commands write beside their results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from styluscam.files import require_writable, write_whole
from styluscam.report.page import report_page
from styluscam.report.subject import Subject
from styluscam.report.templates import require_extra
from styluscam.types import Progress


def require(page: Path | None, picture: Path | None, inputs: Iterable[Path]) -> None:
    """Asks before long work whether the page and the picture can be made."""
    require_writable([path for path in (page, picture) if path is not None], inputs)
    if page is not None:
        require_extra()


def write(
    subject: Callable[[], Subject], page: Path | None, picture: Path | None, progress: Progress | None
) -> list[Path]:
    """Writes those that are asked for; the files written."""
    if page is None and picture is None:
        return []
    shown = subject()
    if page is not None:
        write_whole(page, report_page(shown, progress))
    if picture is not None:
        shown.draw(picture)
    return [path for path in (page, picture) if path is not None]
