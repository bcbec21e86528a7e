# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents to learn from: a model, a job with a tool, an operation, ready to be computed. Made here, so that they never age."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import FreeCAD

from . import compat, defaults, ops, tools


@dataclass(frozen=True)
class Example:
    """One of them."""

    name: str
    title: str
    tool_tip: str
    shape: Callable[[], Any]
    bit: Callable[[Any], Any]
    kind: str
    values: dict[str, Any]
    feed: str
    spindle: float
    """rev/min; 0 leaves the spindle off."""

    def make(self) -> Any:
        """A new document with the example, its operation not yet computed; returns the job.

        Raises:
            EngineMissingError: there is no engine.
        """
        ops.engine.styluscam()
        document = FreeCAD.newDocument(self.name)
        document.Label = self.title
        model = document.addObject("Part::Feature", "Model")
        model.Shape = self.shape()
        document.recompute()
        job = compat.make_job(model)
        _use(self.bit(document), job, self.feed, self.spindle)
        operation = ops.Create("Path", parentJob=job)
        defaults.fill(operation, self.kind)
        operation.Label = self.title
        operation.WholeModel = True
        for name, value in self.values.items():
            setattr(operation, name, value)
        return job


def _use(bit: Any, job: Any, feed: str, spindle: float) -> None:
    """Puts a bit into the job's first tool controller, in place of CAM's own."""
    controller = job.Tools.Group[0]
    old = controller.Tool
    controller.Tool = bit
    compat.hide(bit)
    compat.remove_toolbit(old)
    controller.Label = f"TC: {bit.Label}"
    controller.ToolNumber = 1
    controller.HorizFeed = controller.VertFeed = feed
    controller.SpindleSpeed = spindle
    controller.SpindleDir = "Forward" if spindle else "None"


def _cup() -> Any:
    """A block with a round cup of 45 degrees, its edges rounded; Z 0 is its top."""
    import Part
    from FreeCAD import Vector

    block = Part.makeBox(90.0, 90.0, 26.0, Vector(-45.0, -45.0, -26.0))
    cup = Part.makeCone(12.0, 32.0, 20.0, Vector(0.0, 0.0, -20.0))
    shape = block.cut(cup)
    rims = [edge for edge in shape.Edges if isinstance(edge.Curve, Part.Circle)]
    return shape.makeFillet(7.0, rims)


def _dome() -> Any:
    """A plate with a flat dome; Z 0 is the dome's top."""
    import Part
    from FreeCAD import Vector

    plate = Part.makeBox(60.0, 60.0, 10.0, Vector(-30.0, -30.0, -18.0))
    ball = Part.makeSphere(30.0, Vector(0.0, 0.0, -30.0))
    inside = Part.makeBox(60.0, 60.0, 18.0, Vector(-30.0, -30.0, -18.0))
    return plate.fuse(ball.common(inside)).removeSplitter()


EXAMPLES = (
    Example(
        name="FormedCup",
        title="Formed cup",
        tool_tip="A sheet formed with a clothoid stylus, level by level",
        shape=_cup,
        bit=lambda document: tools.create_stylus(document, "Clothoid", {"kind": "clothoid", "diameter": 10.0}),
        kind="z-level",
        values={"Step": 1.0},
        feed="2000 mm/min",
        spindle=0.0,
    ),
    Example(
        name="MilledDome",
        title="Milled dome",
        tool_tip="A dome milled with FreeCAD's own ball end mill, row by row",
        shape=_dome,
        bit=lambda document: compat.native_toolbit(document, "ballend"),
        kind="zig-zag",
        values={"Stepover": 1.0},
        feed="800 mm/min",
        spindle=8000.0,
    ),
)
"""All of them."""
