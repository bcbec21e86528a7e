"""OpenCAMLib's side of the bench; runs in its own environment and prints one JSON document.

opencamlib_worker.py TRIANGLES ORDER POINTS THREADS REPEATS
"""

from __future__ import annotations

import json
import sys
import time

import opencamlib as ocl
from meshes import positions, wavy


def main() -> None:
    triangles, order, count, threads, repeats = (word if word.isalpha() else int(word) for word in sys.argv[1:])
    vertices, faces = wavy(triangles)
    surface = ocl.STLSurf()
    for a, b, c in vertices[faces].tolist():
        surface.addTriangle(ocl.Triangle(ocl.Point(*a), ocl.Point(*b), ocl.Point(*c)))
    cutter = ocl.BallCutter(6.0, 30.0)
    # a few from all over the raster: its order makes no difference to OpenCAMLib
    chosen = positions(order, 100_000)
    chosen = chosen[:: max(len(chosen) // count, 1)][:count]

    def run(points: list[list[float]]) -> tuple[float, float, list[float]]:
        wall, cpu = time.perf_counter(), time.process_time()
        batch = ocl.BatchDropCutter()
        batch.setSTL(surface)
        batch.setCutter(cutter)
        batch.setThreads(threads)
        for x, y in points:
            batch.appendPoint(ocl.CLPoint(x, y, -100.0))
        batch.run()
        took = time.perf_counter() - wall, time.process_time() - cpu
        return *took, [point.z for point in batch.getCLPoints()]

    setups = [run(chosen[:1].tolist()) for _ in range(repeats)]
    runs = [run(chosen.tolist()) for _ in range(repeats)]
    print(
        json.dumps(
            {
                "points": len(chosen),
                "setup": min(r[0] for r in setups),
                "wall": min(r[0] for r in runs),
                "cpu": min(r[1] for r in runs),
                "setup_cpu": min(r[1] for r in setups),
                "positions": chosen.tolist(),
                "tips": runs[0][2],
                "version": str(ocl.version()),
            }
        )
    )


main()
