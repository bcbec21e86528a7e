"""Reports (extra ``report``): what was judged, as one HTML page that needs no network."""

from __future__ import annotations

from styluscam.report.page import report_page
from styluscam.report.subject import Subject
from styluscam.report.templates import require_extra

__all__ = ["Subject", "report_page", "require_extra"]
