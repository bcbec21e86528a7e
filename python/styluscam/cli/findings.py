"""What the judge found, in words and as data."""

from __future__ import annotations

from styluscam.judging.verification import Report
from styluscam.report.findings import spoken
from styluscam.types import Document

SHOWN = 6
"""Groups that are told in whole sentences: with them and the summary a screen is full."""


def lines(report: Report) -> list[str]:
    """One line for each group of findings, errors first; those that would fill more than a screen by their names only."""
    told, named = report.groups[:SHOWN], report.groups[SHOWN:]
    said = [f"{group.severity}: {group.message}" for group in told]
    if not named:
        return said
    rest = ", ".join(f"{spoken(group.kind)} ({group.severity}, {group.count})" for group in named)
    return [*said, f"and of other kinds or places: {rest}; --report or --json tells of them all"]


def document(report: Report) -> Document:
    """The report without its contacts: there are thousands, and they are of use to the judge only."""
    return {key: value for key, value in report.to_dict().items() if key != "contacts"}
