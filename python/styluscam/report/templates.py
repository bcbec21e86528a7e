"""The templates of pages, and the extra that fills them in."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from styluscam.extras import require

if TYPE_CHECKING:
    from jinja2 import Template

PAGE = Path(__file__).parent / "page"


def require_extra() -> None:
    """Asks before long work whether a page can be made.

    Raises:
        StylusError: jinja2 or matplotlib are missing.
    """
    require("report", "a report")


def template(name: str) -> Template:
    """One of them; what is put in is text, never markup, unless it is marked as such."""
    require_extra()
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(PAGE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)
