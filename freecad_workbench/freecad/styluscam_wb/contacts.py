# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a tool meets the part: the contacts that the verifier measured as a track, and the face under a position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .verification import Verified

if TYPE_CHECKING:
    from styluscam import Tool
    from styluscam.report import Subject
    from styluscam.types import FloatArray, IntArray

FINE = 20.0
"""Points on the part that are looked at for a face: this many to the tool's radius."""

FEW = 50_000
"""At most so many of them."""

APART = 3.0
"""Neighbouring contacts that are farther apart than this many usual gaps are not joined: between them nothing touches."""


@dataclass(frozen=True)
class ContactTrack:
    """Points of the part that the tool touches, in document coordinates, mm."""

    points: FloatArray
    """(N, 3)."""
    runs: list[IntArray]
    """Indices of points that follow each other without a gap."""
    measured: FloatArray
    """Those that the verifier measured, (M, 3); the others follow the path between them."""


def track_of(verified: Verified) -> ContactTrack:
    """The contact track of a verified program.

    The verifier keeps contacts spread evenly over the program. Between two of them the path is known, and the vector
    from the tip to the contact is interpolated along its length.
    """
    subject, records = verified.subject, verified.report.to_dict()["contacts"]
    if not records:
        return ContactTrack(np.zeros((0, 3)), [], np.zeros((0, 3)))
    tips, measured = (np.array([record[key] for record in records]) for key in ("tip", "point"))
    lengths = _lengths(subject)
    at, segment = _places(subject, lengths, tips, np.array([record["line"] for record in records]))
    order = np.argsort(at, kind="stable")
    at, segment, tips, measured = at[order], segment[order], tips[order], measured[order]
    groups = np.split(np.arange(len(at)), np.flatnonzero(_ends(subject, segment)) + 1)
    points: list[FloatArray] = []
    runs: list[IntArray] = []
    for group in groups:
        run = _between(subject.positions, lengths, at[group], tips[group], measured[group])
        start = sum(len(one) for one in points)
        points.append(run)
        if len(run) > 1:
            runs.append(np.arange(start, start + len(run)))
    return ContactTrack(np.concatenate(points), runs, measured)


def _lengths(subject: Subject) -> FloatArray:
    """Along the path to each of its points, (N,), mm."""
    steps = np.diff(subject.positions, axis=0, prepend=subject.positions[:1])
    return np.asarray(np.cumsum(np.linalg.norm(steps, axis=1)))


def _places(subject: Subject, lengths: FloatArray, tips: FloatArray, lines: IntArray) -> tuple[FloatArray, IntArray]:
    """Where on the path each tip is: its length, and the segment by the point that it leads to."""
    positions, of_line = subject.positions, np.asarray(subject.moves["line"], dtype=np.int64)
    order = np.argsort(of_line, kind="stable")
    first, last = (np.searchsorted(of_line[order], lines, side) for side in ("left", "right"))
    at, segment = np.zeros(len(tips)), np.zeros(len(tips), dtype=np.int64)
    for i, tip in enumerate(tips):
        ends = order[first[i] : last[i]]
        starts = np.maximum(ends - 1, 0)
        chord = positions[ends] - positions[starts]
        square = np.einsum("ij,ij->i", chord, chord)
        along = np.einsum("ij,ij->i", tip - positions[starts], chord)
        share = np.clip(np.divide(along, square, out=np.ones(len(ends)), where=square > 0.0), 0.0, 1.0)
        best = int(np.argmin(np.linalg.norm(positions[starts] + share[:, None] * chord - tip, axis=1)))
        segment[i] = ends[best]
        at[i] = lengths[starts[best]] + share[best] * (lengths[ends[best]] - lengths[starts[best]])
    return at, segment


def _ends(subject: Subject, segment: IntArray) -> IntArray:
    """Whether the track ends at each contact but the last: a move that need not touch, or a gap, comes before the next."""
    from styluscam.report.subject import CUT

    others = np.cumsum(subject.kinds != CUT)
    moves = subject.owners[segment]
    gap = np.diff(moves)
    usual = max(float(np.percentile(gap, 75.0)) if len(gap) else 1.0, 1.0)
    return np.asarray((np.diff(others[segment]) > 0) | (gap > APART * usual))


def _between(
    positions: FloatArray, lengths: FloatArray, at: FloatArray, tips: FloatArray, measured: FloatArray
) -> FloatArray:
    """The measured contacts of one run, and points for those of the path between them."""
    inner = np.flatnonzero((lengths > at[0]) & (lengths < at[-1]))
    inner = inner[~np.isin(lengths[inner], at)]
    off = measured - tips
    between = positions[inner] + np.stack([np.interp(lengths[inner], at, off[:, k]) for k in range(3)], axis=1)
    order = np.argsort(np.concatenate([at, lengths[inner]]), kind="stable")
    return np.asarray(np.concatenate([measured, between])[order])


# --- faces -------------------------------------------------------------------------------------------------------


def face_under(verified: Verified, tip: list[float], line: int) -> int | None:
    """The number of the face that the tool with its tip there is nearest to, or deepest in; None where none is under it."""
    from styluscam.tools.outline import polyline

    tool = _tool_at(verified, line)
    surface = verified.subject.surface
    if tool is None or surface is None:
        return None
    meridian = polyline(tool)
    radius = float(meridian[:, 0].max())
    corners = surface.points[surface.triangles][:, :, :2] - np.array(tip[:2])
    near = ((corners.min(axis=1) <= radius) & (corners.max(axis=1) >= -radius)).all(axis=1)
    part = type(surface)(
        surface.points, surface.triangles[near], surface.normals[near], surface.faces[near], surface.smooth
    )
    fine, _ = part.refined(np.ones(len(part.triangles), dtype=bool), radius / FINE, len(part.points) + FEW)
    middles = fine.points[fine.triangles].mean(axis=1)
    away = np.linalg.norm(middles[:, :2] - np.array(tip[:2]), axis=1)
    under = away <= radius
    if not under.any():
        return None
    height = np.interp(away[under], meridian[:, 0], meridian[:, 1])
    wide, high = np.diff(meridian, axis=0).T
    piece = np.clip(np.searchsorted(meridian[:, 0], away[under]) - 1, 0, len(wide) - 1)
    cosine = wide[piece] / np.hypot(wide[piece], high[piece])
    inside = (middles[under, 2] - tip[2] - height) * cosine  # along the tool's normal, to first order
    return int(fine.faces[under][np.argmax(inside)])


def _tool_at(verified: Verified, line: int) -> Tool | None:
    moves = verified.subject.moves
    at = np.flatnonzero(moves["line"] == line)
    number = int(moves["tool"][at[0]]) if len(at) else 0
    return verified.subject.tools[number][1]
