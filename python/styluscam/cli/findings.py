"""What the judge found, in words and as data."""

from __future__ import annotations

from styluscam.judging import Report
from styluscam.report.findings import unlisted
from styluscam.types import Document


def lines(report: Report) -> list[str]:
    """One line per finding, and one where more were counted than are listed."""
    said = [f"{finding['severity']}: {finding['message']}" for finding in report.findings]
    more = unlisted(report)
    return said + ([f"and {more} more of these kinds"] if more else [])


def document(report: Report) -> Document:
    """The report without its contacts: there are thousands, and they are of use to the judge only."""
    return {key: value for key, value in report.to_dict().items() if key != "contacts"}
