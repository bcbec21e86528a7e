"""OpenCAMLib's tips over single triangles; runs in its own environment, reads and prints one JSON document.

In: {"cutters": [[class, *numbers], ..], "cutter": [i, ..], "triangles": [[[x, y, z] * 3], ..], "positions": [[x, y], ..],
"floor": z}
"""

from __future__ import annotations

import json
import sys

import opencamlib as ocl


def main() -> None:
    asked = json.load(sys.stdin)
    cutters = [getattr(ocl, name)(*map(float, numbers)) for name, *numbers in asked["cutters"]]
    tips = []
    for number, corners, (x, y) in zip(asked["cutter"], asked["triangles"], asked["positions"], strict=True):
        point = ocl.CLPoint(x, y, asked["floor"])
        cutters[number].dropCutter(point, ocl.Triangle(*(ocl.Point(*corner) for corner in corners)))
        tips.append(point.z)
    print(json.dumps({"version": str(ocl.version()), "tips": tips}))


main()
