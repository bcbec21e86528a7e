"""What verification found, in words and with its moment on the time axis."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from styluscam import _engine
from styluscam.judging.results import Finding, Group
from styluscam.judging.verification import Report
from styluscam.types import Document, FloatArray, IntArray

_WORDS: dict[str, str] = json.loads(_engine.finding_kinds())
"""Words for the kinds of findings, by their codes."""


@dataclass(frozen=True)
class Verdict:
    """The whole report in a few words; ``state`` is "sound", "warned", "faulty" or "unjudged"."""

    state: str
    headline: str
    explained: str


def verdict_of(report: Report | None, traced: bool = False) -> Verdict:
    """What a person wants to know first; ``traced``: no machine has read the program."""
    if report is None:
        shown = (
            "as the language RS-274NGC defines it, not as one machine would run it"
            if traced
            else "as the machine reads it"
        )
        explained = f"The program is shown {shown}. It was not compared with a part."
        return Verdict("unjudged", "Not verified", explained)
    document = report.to_dict()
    exact = f", {document['brep_checked']} contacts against the exact model" if document["brep_checked"] else ""
    checked = (
        "The text was read back as the machine reads it; every move was compared with the whole part, "
        f"{document['samples']} points measured{exact}."
    )
    kinds = dict.fromkeys(group.kind for group in report.groups)
    found = f"Found: {', '.join(f'{spoken(kind)} ({_extent(document, kind)})' for kind in kinds)}. {checked}"
    if not report.ok:
        return Verdict("faulty", "Must not run", found)
    if report.findings:
        return Verdict("warned", "May run, with warnings", found)
    return Verdict("sound", "Nothing was found", checked)


def grouped(report: Report | None) -> list[Document]:
    """The groups of findings, each with ``worst``: the index of its worst finding."""
    if report is None:
        return []
    return [{**group, "worst": _worst(group, report.findings)} for group in report.groups]


def _worst(group: Group, findings: Sequence[Finding]) -> int:
    listed = group.findings
    same = ("line", "position", "value")
    return next((index for index in listed if all(findings[index][key] == group[key] for key in same)), listed[0])


def _extent(document: Document, kind: str) -> str:
    """How often, and along how much of the path."""
    count, length = document["counts"].get(kind, 1), document["lengths"].get(kind, 0.0)
    return f"{count}, along {length:.1f} mm of path" if length else str(count)


def spoken(kind: str) -> str:
    """The words for a finding's kind; those of a kind that this engine does not know are its code's."""
    return _WORDS.get(kind, kind.replace("-", " "))


def measured(value: float, unit: str) -> str:
    """A number with its unit: lengths to a ten-thousandth."""
    return f"{value:.4f} mm" if unit == "mm" else f"{value:.6g} {unit}"


def placed(findings: Sequence[Finding], lines: IntArray, positions: FloatArray, times: FloatArray) -> list[Document]:
    """The findings, each with its ``time`` in seconds (none where it has no moment).

    ``lines`` (N,), ``positions`` (N, 3) and ``times`` (N,) are those along the path.
    """
    return [{**finding, "time": _moment(finding, lines, positions, times)} for finding in findings]


def _moment(finding: Finding, lines: IntArray, positions: FloatArray, times: FloatArray) -> float | None:
    """When the tool is nearest to the finding's position on the finding's line."""
    moves = np.flatnonzero(lines == finding.line) if finding.line else np.zeros(0, dtype=np.int64)
    if not len(moves):
        return None
    if finding.position is None:
        return float(times[moves[0]])
    before = np.maximum(moves - 1, 0)
    start, segment = positions[before], positions[moves] - positions[before]
    square = np.einsum("ij,ij->i", segment, segment)
    along = np.einsum("ij,ij->i", np.asarray(finding.position) - start, segment)
    share = np.clip(np.divide(along, square, out=np.ones(len(moves)), where=square > 0.0), 0.0, 1.0)
    off = np.linalg.norm(start + share[:, None] * segment - np.asarray(finding.position), axis=1)
    best = int(np.nanargmin(off)) if np.isfinite(off).any() else 0
    begins, ends = times[before[best]] if moves[best] > 0 else 0.0, times[moves[best]]
    return float(ends if share[best] >= 1.0 else begins + share[best] * (ends - begins))
