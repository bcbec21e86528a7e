# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document: opened, changed as asked, computed, checked, posted and verified. It is never saved in place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD

from .. import engine, verification
from . import changes, jobs, programs
from .failures import FailedOperationError, RunError, record
from .objects import one_line, open_document, version_note

PROTOCOL = 1
"""Of requests and reports; package and addon may be of different versions."""

Step = Callable[[], Any]


def run(request: dict[str, Any]) -> dict[str, Any]:
    """The report on a document.

    `request`: file, post (a machine, or ""), jobs (labels, none for all), set (texts LABEL.Property=value), copy (a file
    for the computed document, or ""). Programs have their texts in them.
    """
    report: dict[str, Any] = {
        "freecad": ".".join(FreeCAD.Version()[:3]),
        "styluscam": "",
        "notes": [],
        "set": [],
        "jobs": [],
        "policy": "replace",
        "error": None,
    }
    try:
        _require_protocol(request)
        _run(request, report)
    except BaseException as error:
        report["error"] = record(error)
    return report


def _require_protocol(request: dict[str, Any]) -> None:
    if request["protocol"] != PROTOCOL:
        raise RunError(
            "the addon in FreeCAD and the package styluscam are of different versions: install the same of both"
        )


def _run(request: dict[str, Any], report: dict[str, Any]) -> None:
    report["styluscam"] = engine.styluscam().__version__
    document = open_document(request["file"])
    report["notes"] += version_note(document)
    if request["copy"] and report["notes"]:
        raise RunError(f"--save: {report['notes'][0]}: leave --save out, or save it with that FreeCAD")
    chosen = jobs.choose(document, request["jobs"])
    jobs.require_known(document)
    for job in chosen:
        report["notes"] += jobs.choose_post(job, request["post"], request["file"])
    changed = changes.apply(document, request["set"])
    report["set"] = [change.record() for change in changed]
    _compute(document, chosen)
    changes.require_kept(changed)
    report["policy"] = programs.policy()
    for job in chosen:
        report["notes"] += jobs.unknown_properties(job)
        report["jobs"].append(_job(job))
    if request["copy"] and not any(job["error"] for job in report["jobs"]):
        _save(document, request["copy"])


def _compute(document: Any, chosen: list[Any]) -> None:
    """Recomputes; FreeCAD reports an operation's error in its state only."""
    for job in chosen:
        jobs.touch(job)
    try:
        document.recompute()
    except Exception as error:
        raise RunError(f"FreeCAD cannot compute the document: {one_line(error)}") from error


def _job(job: Any) -> dict[str, Any]:
    """A job's part of the report."""
    found: dict[str, Any] = {
        "label": job.Label,
        "name": job.Name,
        "post": job.PostProcessor,
        "arguments": job.PostProcessorArgs,
        "operations": [jobs.record(obj) for obj in job.Operations.Group],
        "programs": [],
        "notes": [],
        "error": None,
    }
    try:
        _require_ready(job)
        found["programs"], failed = programs.programs_of(job)
        found["notes"] = _unverified(found)
        if failed is not None:
            raise failed
    except BaseException as error:
        found["error"] = record(error, job.Label)
    return found


def _require_ready(job: Any) -> None:
    """Refuses a job with something in it that is not computed.

    Raises:
        RunError, or what an operation of ours has failed with.
    """
    wrong = jobs.job_error(job)
    if wrong is not None:
        raise wrong
    for obj in verification.active_operations(job):
        error = jobs.error_of(obj)
        if error is not None:
            raise FailedOperationError(obj.Label) from error


def _unverified(job: dict[str, Any]) -> list[str]:
    """Sentences about what nobody has verified."""
    active = [one for one in job["operations"] if one["active"]]
    foreign = [one["label"] for one in active if not one["styluscam"]]
    sentences = [f"{label}: an operation of FreeCAD's own: posted, not verified" for label in foreign]
    if len(foreign) == len(active):
        sentences = ["no operation is StylusCAM's: posted, not verified"]
    reasons = dict.fromkeys(one["unverified"] for one in job["programs"] if one["unverified"])
    return sentences or [f"not verified: {reason}" for reason in reasons]


def _save(document: Any, copy: str) -> None:
    try:
        document.saveCopy(copy)
    except Exception as error:
        raise RunError(f"FreeCAD cannot save the document: {one_line(error)}") from error
