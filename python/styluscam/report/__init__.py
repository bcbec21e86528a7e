"""Reports (extra ``report``): what was verified, as one HTML page that needs no network."""

from __future__ import annotations

from styluscam.report.comparison import comparison_page
from styluscam.report.page import report_page
from styluscam.report.subject import Subject
from styluscam.report.tables import figures, in_words, side_by_side
from styluscam.report.templates import require_extra

__all__ = ["Subject", "comparison_page", "figures", "in_words", "report_page", "require_extra", "side_by_side"]
