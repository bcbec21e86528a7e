"""Run by FreeCAD: how long posts take for a job of 50,000 commands."""

from __future__ import annotations

import json
import math
import time
from typing import Any

import FreeCAD
import Path.Main.Job as PathJob
from Path.Op import Custom
from Path.Post.Processor import PostProcessorFactory

COMMANDS = 50_000
POSTS = ("linuxcnc", "styluscam_linuxcnc", "styluscam_fanuc", "styluscam_heidenhain")


def job() -> Any:
    document = FreeCAD.newDocument("speed")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    made = PathJob.Create("Job", [box])
    controller = made.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = 10
    own = Custom.Create("Own", parentJob=made)
    own.ToolController = controller
    own.Gcode = ["G0 X0 Y0 Z30", *(command(index) for index in range(COMMANDS)), "G0 Z30"]
    document.recompute()
    return made


def command(index: int) -> str:
    x, y = 100 + 80 * math.cos(index * 0.01), 100 + 80 * math.sin(index * 0.01)
    return f"G1 X{x:.4f} Y{y:.4f} Z{-index * 0.0001:.4f} F10"


def row(made: Any, post: str) -> list[Any]:
    made.PostProcessor = post
    made.PostProcessorArgs = "--no-show-editor"
    processor = PostProcessorFactory.get_post_processor(made, post)
    times, sections = [], []
    for _ in range(3):
        start = time.perf_counter()
        sections = processor.export()
        times.append(time.perf_counter() - start)
    return [post, min(times), len(sections[0][1].splitlines())]


made = job()
print("RESULT " + json.dumps([row(made, post) for post in POSTS]))
