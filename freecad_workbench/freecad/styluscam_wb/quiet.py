# SPDX-License-Identifier: LGPL-2.1-or-later
"""A user's mistake without a traceback: FreeCAD prints the trace of whatever a feature raises, as far as Python lets it.

`sys.tracebacklimit` 0 leaves the error's sentence alone; it holds until FreeCAD has recomputed the document.
"""

from __future__ import annotations

import sys
from typing import Any

import FreeCAD


class _Restorer:
    """Lets tracebacks be printed again; FreeCAD calls it when a document is recomputed."""

    def slotRecomputedDocument(self, document: Any) -> None:
        restore()


_restorer = _Restorer()
_is_observing = False


def without_traceback() -> None:
    """To be called right before an error is raised out of a feature."""
    global _is_observing  # noqa: PLW0603  (one observer a session)
    if not _is_observing:
        FreeCAD.addDocumentObserver(_restorer)
        _is_observing = True
    sys.tracebacklimit = 0


def restore() -> None:
    """Undoes it."""
    if getattr(sys, "tracebacklimit", None) == 0:
        del sys.tracebacklimit
