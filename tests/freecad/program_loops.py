"""Loops and runs of a program, and how far two of them are apart."""

from __future__ import annotations

import numpy as np

import styluscam as sc

Points = np.ndarray


def runs(program: sc.Program) -> list[Points]:
    """What is cut between rapids, each (N,3), from where the feed begins."""
    found: list[list[Points]] = []
    last, cutting = None, False
    for move in program.moves:
        if move["kind"] == 1:
            if not cutting:
                found.append([] if last is None else [last])
            found[-1].append(move["end"])
        last, cutting = move["end"], move["kind"] == 1
    return [np.array(run) for run in found]


def levels(program: sc.Program) -> list[Points]:
    """Closed loops at one height, in order."""
    found = []
    for run in runs(program):
        breaks = np.flatnonzero(np.diff(run[:, 2]) != 0.0) + 1
        found += [level for level in np.split(run, breaks) if len(level) > 3 and np.allclose(level[0], level[-1])]
    return found


def turns(loop: Points) -> float:
    """The loop's area seen from above, positive when it runs counter-clockwise."""
    x, y = loop[:, 0], loop[:, 1]
    return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) / 2.0)


def hausdorff(a: Points, b: Points) -> float:
    """The largest distance of a point of either polyline to the other, mm."""
    return max(_farthest(a, b), _farthest(b, a))


def _farthest(a: Points, b: Points, pieces: int = 8) -> float:
    share = np.linspace(0.0, 1.0, pieces, endpoint=False)[:, None, None]
    points = np.concatenate([(a[:-1] + share * (a[1:] - a[:-1])).reshape(-1, 3), a[-1:]])
    return max(float(_distance(chunk, b).max()) for chunk in np.array_split(points, len(points) // 500 + 1))


def _distance(points: Points, line: Points) -> Points:
    start, along_line = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.einsum("ij,ij->i", along_line, along_line), 1e-30)
    away = points[:, None] - start
    along = np.clip(np.einsum("pij,ij->pi", away, along_line) / square, 0.0, 1.0)
    return np.linalg.norm(away - along[..., None] * along_line, axis=2).min(axis=1)
