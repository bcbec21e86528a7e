"""Run by FreeCAD: what the addon itself costs, beside reading the model, planning, posting and verifying.

freecad_addon.py -- STEPOVER_MM
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from typing import Any

import freecad_cap as cap
import Path

import styluscam
from freecad.styluscam_wb import motion, ops
from freecad.styluscam_wb.posts import processor

REPEATS = 3


def watched() -> cap.Stopwatch:
    watch = cap.Stopwatch()
    watch.watch(ops, "part_of", "tessellation")
    watch.watch(styluscam, "plan", "planning")
    watch.watch(motion, "path_of", "path")
    watch.watch(processor, "refuse_unfinished", "checks")
    watch.watch(motion.Builder, "add_operation", "text of the path")
    watch.watch(motion.Builder, "program", "program")
    watch.watch(processor.engine, "text_of", "posting")
    watch.watch(styluscam, "verify", "verification")
    return watch


def cost(stepover: float) -> dict[str, Any]:
    """Commands, and wall and processor seconds by what they go into: of the first computation, and the least of some more."""
    document = cap.new_document("Cost")
    job = cap.job_of(document)
    operation = cap.ours(job, "zig-zag", Stepover=stepover)
    watch = watched()

    def run(title: str, work: Callable[[], Any]) -> dict[str, list[float]]:
        watch.timed(title, work)
        return watch.taken()

    computed = [run("all", lambda: cap.recompute(operation)) for _ in range(1 + REPEATS)]
    read = [run("all", lambda: post(job)) for _ in range(REPEATS)]
    path = operation.Path
    words = [(command.Name, command.Parameters) for command in path.Commands]
    tried = [
        {
            **run("assignment", lambda: setattr(operation, "Path", path)),
            **run("as commands", lambda: Path.Path([Path.Command(name, parameters) for name, parameters in words])),
        }
        for _ in range(REPEATS)
    ]
    return {
        "commands": path.Size,
        "first": computed[0],
        "again": least(computed[1:]),
        "read": least(read),
        "tried": least(tried),
        "same": Path.Path(path.toGCode()).toGCode() == path.toGCode(),
    }


def post(job: Any) -> None:
    from Path.Post.Processor import PostProcessorFactory

    PostProcessorFactory.get_post_processor(job, job.PostProcessor).export()


def least(runs: list[dict[str, list[float]]]) -> dict[str, list[float]]:
    return {name: [min(run[name][clock] for run in runs) for clock in (0, 1)] for name in runs[0]}


try:
    cap.result(cost(float(sys.argv[sys.argv.index("--") + 1])))
except BaseException:
    traceback.print_exc(file=sys.stdout)
finally:
    sys.stdout.flush()
    os._exit(0)
