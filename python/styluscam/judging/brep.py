"""Contacts compared with the exact model: what triangles, planning and verification share could be wrong for all three."""

from __future__ import annotations

import numpy as np

from styluscam import _engine
from styluscam.programs.job import Job
from styluscam.types import Document
from styluscam.words import position

ROUNDING = 1e-6
"""What arithmetic may cost, mm."""


def recheck(report: Document, job: Job, scene: _engine.Scene) -> None:
    """Adds ``brep_checked`` and ``brep_max`` (mm) to the report, and a finding where contacts miss the model.

    The contacts come in work coordinates; they are taken back to the file's frame here, by the inverse of the
    set-up, and there from the part as it is formed to the target, and measured against the model's own
    surfaces. Parts that are nothing but triangles have none.
    """
    arrays, formed = job.target().arrays, job.part().engine
    contacts = report["contacts"]
    if arrays is None or arrays.is_mesh or not contacts:
        report["brep_checked"] = 0
        return
    rows = np.array(scene.frame)
    points = (np.array([c["point"] for c in contacts]) - rows[:, 3]) @ rows[:, :3]
    points = formed.target_points(points)
    # on the edge between them a contact may be the addendum's, which no surface of the model is
    of_model = np.array([c["face"] for c in contacts]) <= len(arrays.surfaces)
    known = np.flatnonzero(np.isfinite(points).all(axis=1) & of_model)
    report["brep_checked"] = len(known)
    if not len(known):
        return
    contacts = [contacts[index] for index in known]
    distances = arrays.surface_distance(points[known], np.array([c["face"] for c in contacts]))
    worst = int(np.argmax(np.abs(distances)))
    limit = max(arrays.tolerance, arrays.deviation_inward, arrays.deviation_outward, *formed.deviation)
    limit += formed.target_accuracy + ROUNDING
    report["brep_max"] = float(abs(distances[worst]))
    if report["brep_max"] > limit:
        report["ok"] = False
        _put_first(report, _finding(contacts[worst], report["brep_max"], limit))


def _put_first(report: Document, finding: Document) -> None:
    """It leads the findings, and the groups: where triangles and model disagree, nothing else can be trusted."""
    groups = [{**group, "findings": [index + 1 for index in group["findings"]]} for group in report["groups"]]
    keys = (key for key in finding if key != "value_mm")
    alone = {"count": 1, "regions": 1, "box": [finding["position"]] * 2, "findings": [0]}
    report["groups"] = [{**{key: finding[key] for key in keys}, **alone}, *groups]
    report["findings"] = [finding, *report["findings"]]
    report["counts"] = {finding["kind"]: 1, **report["counts"]}


def _finding(contact: Document, value: float, limit: float) -> Document:
    line, face = contact["line"], contact["face"]
    return {
        "kind": "model",
        "severity": "error",
        "line": line,
        "first_line": line,
        "last_line": line,
        "moves": 1,
        "length_mm": 0.0,
        "position": contact["tip"],
        "value_mm": value,
        "value": value,
        "limit": limit,
        "unit": "mm",
        "message": f"line {line}, {position(contact['tip'])}: the contact on Face{face} misses the model's surface by "
        f"{value:.4f} mm: the part's triangles or its set-up are wrong",
    }
