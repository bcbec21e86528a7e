"""FreeCAD documents, computed, verified and posted by FreeCAD without a window."""

from __future__ import annotations

from styluscam.freecad.batch import run_documents
from styluscam.freecad.document import DocumentRun, Options

__all__ = ["DocumentRun", "Options", "run_documents"]
