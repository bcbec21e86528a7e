"""Tables of a page: the program in figures, what is left on each face, the job, the versions."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from styluscam._engine import __version__
from styluscam.judging.coverage import LEAST_AREA, Totals, unformed
from styluscam.judging.results import FaceCoverage
from styluscam.records import Record
from styluscam.report.subject import RAPIDS, Subject
from styluscam.report.vendored import THREE_VERSION
from styluscam.types import Document
from styluscam.words import clock, position

LONGEST = 120
"""Characters of a value in the job's table."""

Rows = list[tuple[str, str]]


@dataclass(frozen=True, slots=True, eq=False)
class Figures(Record):
    """A program in numbers, as ``compare`` puts them side by side. None where there is no such number.

    Attributes:
        covered: share of what must be touched.
        unformed_mm2: area that needs no forming.
    """

    time_s: float
    length_mm: float
    moves: int
    blocks: int
    lowest_z_mm: float | None
    findings: int | None
    gouge_mm: float | None
    excess_mm: float | None
    scallop_mm: float | None
    covered: float | None
    unformed_mm2: float | None


def figures(subject: Subject) -> Figures:
    """A program's numbers."""
    program, positions = subject.program, subject.positions
    at_feed = subject.kinds != RAPIDS
    report = subject.report
    faces = report.coverage() if report is not None else []
    done = Totals.of(faces)
    return Figures(
        time_s=float(subject.times[-1]) if len(subject.times) else 0.0,
        length_mm=program.length,
        moves=len(program.moves),
        blocks=len(np.unique(program.moves["line"])),
        lowest_z_mm=float(positions[at_feed, 2].min()) if at_feed.any() else None,
        findings=sum(report.to_dict()["counts"].values()) if report is not None else None,
        gouge_mm=report.gouge_max if report is not None else None,
        excess_mm=report.excess_max if report is not None else None,
        scallop_mm=max((face.scallop for face in faces), default=0.0) if report is not None else None,
        covered=done.share,
        unformed_mm2=sum(area for area, _ in unformed(done)) or None,
    )


SHOWN: dict[str, tuple[str, Callable[[Any], str]]] = {
    "time_s": ("time", clock),
    "length_mm": ("length at feed", lambda value: f"{value:.0f} mm"),
    "moves": ("moves", str),
    "blocks": ("blocks that move", str),
    "lowest_z_mm": ("lowest Z", lambda value: f"{value:.3f} mm"),
    "findings": ("findings", str),
    "gouge_mm": ("worst gouge", lambda value: f"{value:.4f} mm"),
    "excess_mm": ("worst excess", lambda value: f"{value:.4f} mm"),
    "scallop_mm": ("scallop", lambda value: f"{value:.4f} mm"),
    "covered": ("covered", lambda value: f"{100.0 * value:.1f} %"),
    "unformed_mm2": ("needs no forming", lambda value: f"{value:.1f} mm²"),
}
"""How people get to see :func:`figures`."""


def in_words(numbers: Figures) -> Rows:
    """:func:`figures` in words, without those that are not known."""
    return [(name, words(numbers[key])) for key, (name, words) in SHOWN.items() if numbers[key] is not None]


def faces(subject: Subject) -> list[tuple[str, ...]]:
    """What is left on each face: name, area, what needs no forming, covered, scallop, mean, most, where."""
    if subject.report is None:
        return []
    return [_face(face) for face in subject.report.coverage()]


def _face(face: FaceCoverage) -> tuple[str, ...]:
    touched = face.to_form >= LEAST_AREA
    covered = touched and face.covered > 0.0
    left = "nothing touches it" if face.left is None else f"{face.left:.4f}"
    return (
        f"Face{face.face}",
        f"{face.area:.1f}",
        f"{100.0 * (face.flat + face.carried):.1f}",
        f"{100.0 * face.covered:.1f}" if touched else "",
        f"{face.scallop:.4f}" if covered else "",
        f"{face.mean:.4f}" if covered else "",
        left if touched else "stays flat",
        "" if face.at is None or not touched else position(face.at),
    )


def job_rows(document: Document) -> dict[str, Rows]:
    """A job document by section: its keys and values."""
    sections: dict[str, Rows] = {}
    for key, value in document.items():
        name = key if isinstance(value, dict | list) else "job"
        sections.setdefault(name, []).extend(_flat(value, "" if name == key else key))
    return {name: rows for name, rows in sections.items() if rows}


def _flat(value: object, path: str) -> Iterator[tuple[str, str]]:
    """Keys with dots between them, and values as the document writes them."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for number, inner in enumerate(value, start=1):
            yield from _flat(inner, f"{path}[{number}]" if path or len(value) > 1 else "")
    elif value not in (None, "", []):
        yield path, _value(value)


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list):
        text = ", ".join(_value(item) for item in value)
        return text if len(text) <= LONGEST else f"{len(value)} entries"
    return str(value)


def versions(subject: Subject) -> Rows:
    """What made the page, and for which machine."""
    return [
        ("StylusCAM", __version__),
        ("three.js", THREE_VERSION),
        *([("read as", subject.reader)] if subject.gaps is not None else []),
        ("machine" if subject.gaps is None else "times of", f"{subject.machine.name}: {subject.machine.description}"),
        *([("machine file", _machine_file(subject))] if _machine_file(subject) else []),
    ]


def _machine_file(subject: Subject) -> str:
    named = subject.job.document["machine"].get("file") if subject.job is not None else None
    return re.split(r"[\\/]", named)[-1] if named else ""


def side_by_side(subjects: Sequence[Subject]) -> list[tuple[str, ...]]:
    """:func:`figures` of several programs: what it is, and each one's; what none knows is left out."""
    numbers = [figures(subject) for subject in subjects]
    known = [key for key in SHOWN if any(each[key] is not None for each in numbers)]
    rows = [[SHOWN[key][1](each[key]) if each[key] is not None else "" for each in numbers] for key in known]
    return [(SHOWN[key][0], *row) for key, row in zip(known, rows, strict=True)]
