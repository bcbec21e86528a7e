"""What verification found, in words and as data."""

from __future__ import annotations

from styluscam.judging.verification import Report
from styluscam.report.findings import spoken
from styluscam.types import Document

SHOWN = 6
"""Groups that are printed in whole sentences: with them and the summary a screen is full."""


def lines(report: Report) -> list[str]:
    """One line for each group of findings, errors first; those that would fill more than a screen by their names only."""
    listed, named = report.groups[:SHOWN], report.groups[SHOWN:]
    sentences = [f"{group.severity}: {group.message}" for group in listed]
    if not named:
        return sentences
    rest = ", ".join(f"{spoken(group.kind)} ({group.severity}, {group.count})" for group in named)
    return [*sentences, f"and of other kinds or regions: {rest}; --report or --json lists them all"]


def document(report: Report) -> Document:
    """The report without its contacts: there are thousands, and only the verifier uses them."""
    return {key: value for key, value in report.to_dict().items() if key != "contacts"}
