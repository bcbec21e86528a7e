"""Inside FreeCAD: a CAM job on the cap R60 with a ball end mill D6, and an operation of ours or of FreeCAD's on it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD
import Part
import Path.Main.Job as PathJob

STEP = Path(__file__).resolve().parent.parent / "fixtures" / "cap_r60.step"
FEED = "1000 mm/min"


def job_of(document: Any) -> Any:
    """The job, with one tool controller that holds FreeCAD's own ball end mill."""
    model = document.addObject("Part::Feature", "Cap")
    shape = Part.Shape()
    shape.read(str(STEP))
    model.Shape = shape
    document.recompute()
    job = PathJob.Create("Job", [model])
    job.PostProcessor, job.PostProcessorArgs = "styluscam_linuxcnc", ""
    controller = job.Tools.Group[0]
    controller.Tool = ball(document)
    controller.HorizFeed = controller.VertFeed = FEED
    controller.SpindleSpeed, controller.SpindleDir = 5000.0, "Forward"
    document.recompute()
    return job


def ball(document: Any) -> Any:
    try:
        from Path.Tool.toolbit import ToolBit

        bit = ToolBit.from_shape_id("ballend.fcstd").attach_to_doc(document)
    except ImportError:  # 1.0
        from Path.Tool.Bit import Factory

        bit = Factory.Create("Ball", "ballend.fcstd")
    bit.Diameter = "6 mm"
    return bit


def ours(job: Any, kind: str, **settings: float) -> Any:
    """An operation of ours on the whole model, not computed yet."""
    from freecad.styluscam_wb import ops

    operation = ops.Create("Ours", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    operation.Process, operation.Strategy, operation.WholeModel = "milling", kind, True
    for name, value in settings.items():
        setattr(operation, name, value)
    return operation


def recompute(operation: Any) -> None:
    """Has FreeCAD compute an operation and all that follows from it.

    Raises:
        RuntimeError: it fails.
    """
    operation.touch()
    operation.Document.recompute()
    if "Invalid" in operation.State or operation.Path.Size < 10:
        raise RuntimeError(f"{operation.Label}: {operation.Path.toGCode()[:300]}")


class Stopwatch:
    """Seconds in functions, by name: of the wall's clock and of the processor, all threads; what they call is counted in them."""

    def __init__(self) -> None:
        self.wall: dict[str, float] = {}
        self.processor: dict[str, float] = {}

    def watch(self, owner: Any, name: str, title: str) -> None:
        """Measures a function from now on."""
        real = getattr(owner, name)

        def measured(*args: Any, **kwargs: Any) -> Any:
            return self.timed(title, lambda: real(*args, **kwargs))

        setattr(owner, name, measured)

    def timed(self, title: str, work: Callable[[], Any]) -> Any:
        """Measures a call."""
        wall, processor = time.perf_counter(), time.process_time()
        try:
            return work()
        finally:
            self.wall[title] = self.wall.get(title, 0.0) + time.perf_counter() - wall
            self.processor[title] = self.processor.get(title, 0.0) + time.process_time() - processor

    def taken(self) -> dict[str, list[float]]:
        """Wall and processor seconds since the last call."""
        taken = {title: [self.wall[title], self.processor[title]] for title in self.wall}
        self.wall, self.processor = {}, {}
        return taken


def new_document(name: str) -> Any:
    return FreeCAD.newDocument(name)


def result(document: Any) -> None:
    """Prints what the bench reads."""
    print("\nRESULT " + json.dumps(document), flush=True)
