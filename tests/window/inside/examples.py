"""The examples, opened by their commands."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import stage
from driver import until


def new_job(before: set[str]) -> Any:
    """The job of a document that was not there before, once its operation is computed."""
    import FreeCAD

    for name in set(FreeCAD.listDocuments()) - before:
        document = FreeCAD.getDocument(name)
        job = None if document.Recomputing else document.getObject("Job")
        operations = job.Operations.Group if job else []
        if operations and operations[0].State == ["Up-to-date"] and stage.motions(operations[0]):
            return job
    return None


def opened() -> Any:
    """Each example: its path, its state, what its job posts."""
    import FreeCAD
    import FreeCADGui

    from freecad.styluscam_wb.gui import commands

    yield from stage.workbench("StylusCamWorkbench")
    result = {}
    for name in commands.groups()["help"]:
        if "Example" not in name:
            continue
        before = set(FreeCAD.listDocuments())
        driver.later(lambda name=name: FreeCADGui.runCommand(name))
        yield until(lambda before=before: new_job(before), "a computed job", 60)
        job = new_job(before)
        yield driver.settled(10)
        job.PostProcessor = "styluscam_linuxcnc"
        picture = driver.shot(name)
        result[name] = {**stage.seen(job.Operations.Group[0]), "post": stage.posted(job), "shot": picture}
        driver.close_all()
    return result


driver.run({"opened": opened})
