"""Rest roughing: how much of its length at cutting feeds is through air, and the largest engagement angle.

Run: ``python bench/rest_roughing.py [--bound 60] [NAME ...]``. Parts of ``fixtures/corpus/slice`` are roughed out of a box with
a flat tool, and what that leaves with one of half its diameter. Both are measured by the verifier on the posted text
(``Report.engagement``): air are moves at cutting feeds on which nothing is engaged, and what lies above the layers; links have
the machine's rapid rate and are listed beside. The bound holds but on entries.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import styluscam as sc
from styluscam.errors import StylusError
from styluscam.judging.clearing import OperationEngagement

SLICE = Path(__file__).resolve().parents[1] / "fixtures" / "corpus" / "slice"

DIAMETERS = {"pocket-09": 12.0, "boss-04": 16.0, "step-02": 4.0, "holes-07": 12.0, "angle-08": 8.0}
"""Parts that are measured where none are named, with the diameter of the larger tool, mm."""

LEFT, SIDES = 0.3, 2.0
"""Stock to leave, and by how much the stock is larger than the part, mm."""

NOTHING = "nothing-reached"
"""Code of the refusal where the larger tool leaves nothing that is worth a second one."""

LINKS = 3000.0
"""Feed of links, mm/min: the machine's rapid rate."""

MOST_AIR = 0.1
"""Share of its length at cutting feeds that rest roughing may spend in air."""


@dataclass(frozen=True)
class Measured:
    """An operation: length at cutting feeds and the share of it through air; length of links, at a feed of their own; all in mm.

    `angle` is the largest but on entries, deg.
    """

    length: float
    air: float
    links: float
    angle: float


def measured(found: OperationEngagement) -> Measured:
    """Lengths between positions count by the larger angle at their ends; what is not measured (over the stock) is air.

    Ways down into stock are measured in the plane under the layer's top, in which they cut at their beginning only: one that cuts
    there counts whole.
    """
    moves = found.moves
    after, before = found.of_move[1:], found.of_move[:-1]
    goes_on = (after == before) | (np.abs(moves.starts[after] - moves.ends[before]) < 1e-9)
    engaged = np.maximum(found.angles_deg[1:], found.angles_deg[:-1]) > 0.0
    enters = (moves.kinds == "entry")[after] & (np.hypot(*np.diff(found.points[:, :2], axis=0).T) > 0.0)
    number = np.cumsum(np.diff(np.concatenate(([False], enters)).astype(int)) == 1)
    engaged |= enters & np.isin(number, number[enters & engaged])
    is_link = (moves.kinds == "link") & (moves.feeds > moves.feeds[moves.kinds == "cut"].max(initial=0.0))
    cutting = float(np.diff(found.distances)[goes_on & engaged & ~is_link[after]].sum())
    links = float((moves.ends - moves.starts)[is_link].sum())
    length = found.length - links
    bounded = found.bounded_deg
    angle = float(np.nanmax(bounded)) if np.isfinite(bounded).any() else 0.0
    return Measured(length, 1.0 - cutting / length, links, angle)


def job(path: Path, units: str | None, diameter: float, bound: float) -> sc.Job:
    """Roughing, and rest roughing by a tool of half the diameter."""
    common: dict[str, Any] = {
        "kind": "pocket",
        "clears": "stock",
        "engagement_deg": bound,
        "radial_stock_to_leave": LEFT,
        "axial_stock_to_leave": LEFT,
        "tolerance": 0.05,
        "link_feed": LINKS,
        "spindle": {"mode": "fixed", "rpm": 8000.0},
    }
    tools = {
        name: {"number": number, "profile": {"kind": "flat", "diameter": share * diameter}}
        for number, (name, share) in enumerate((("rough", 1.0), ("rest", 0.5)), start=1)
    }
    height = {"step": {"height": round(0.5 * diameter, 3)}}
    operations = [
        {"id": "rough", "tool": "rough", **height, **common},
        {"id": "rest", "tool": "rest", **height, **common, "rest_machining": True},
    ]
    part = {"file": str(path), "faces": "all"} | ({"units": units} if units else {})
    return sc.Job.from_dict(
        {
            "schema": 1,
            "part": part,
            "process": {"kind": "milling"},
            "setup": {"zero": "model", "stock": {"kind": "box", "sides": SIDES, "top": 1.0}},
            "tools": tools,
            "operations": operations,
            "machine": {"name": "linuxcnc"},
        }
    )


def main() -> int:
    """Prints a line a part; 1 where rest roughing cuts more air than it may, or exceeds its bound."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bound", type=float, default=60.0)
    parser.add_argument("names", nargs="*", default=list(DIAMETERS), metavar="NAME")
    given = parser.parse_args()
    parts = {one["name"]: one for one in json.loads((SLICE / "parts.json").read_text())}
    failed = False
    for name in given.names:
        part, begun = parts[name], time.perf_counter()
        asked = job(SLICE / part["file"], part["units"], DIAMETERS[name], given.bound)
        try:
            program = sc.post(sc.plan(asked))
        except StylusError as error:
            print(f"{name:12} {error}")
            failed |= getattr(error, "code", "") != NOTHING
            continue
        report = sc.verify(program, asked)
        for found in report.engagement:
            of = measured(found)
            print(
                f"{name:12} {found.operation:6} {of.length:9.0f} mm at cutting feeds, air {of.air:6.1%}; "
                f"links {of.links:5.0f} mm, largest {of.angle:5.2f} of {found.bound_deg:.0f} deg"
            )
            if found.operation == "rest":
                failed |= of.air > MOST_AIR or of.angle > given.bound + 0.5
        errors = {finding["kind"] for finding in report.to_dict()["findings"] if finding["severity"] == "error"}
        print(
            f"{name:12} {'verified' if not errors else sorted(errors)}, {time.perf_counter() - begun:.0f} s", flush=True
        )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
