"""What a document's window looked like, kept when FreeCAD saves it without one.

FreeCAD without a window leaves `GuiDocument.xml` out: every object would lose its colour and be hidden.
"""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

from styluscam.errors import StylusError

VIEWS = "GuiDocument.xml"
PICTURE = "thumbnails/Thumbnail.png"


def with_views(original: Path, computed: bytes) -> bytes:
    """A computed document with the views of the one that it was made from.

    Raises:
        StylusError: the views name a file that the computed document has too, with another meaning.
    """
    with zipfile.ZipFile(original) as old, zipfile.ZipFile(io.BytesIO(computed)) as new:
        there, taken = set(old.namelist()), set(new.namelist())
        if VIEWS not in there or VIEWS in taken:
            return computed
        named = {element.get("file", "") for element in ElementTree.fromstring(old.read(VIEWS)).iter()}
        kept = [name for name in old.namelist() if name in {VIEWS, PICTURE, *named}]
        both = sorted(taken.intersection(kept))
        if both:
            raise StylusError(
                f"{original}: its views cannot be kept: they name {both[0]}, which the computed document has too",
                code="views",
                where=str(original),
                hint="save it in FreeCAD's window",
            )
        made = io.BytesIO(computed)
        with zipfile.ZipFile(made, "a", zipfile.ZIP_DEFLATED) as out:
            for name in kept:
                out.writestr(old.getinfo(name), old.read(name), zipfile.ZIP_DEFLATED)
        return made.getvalue()
