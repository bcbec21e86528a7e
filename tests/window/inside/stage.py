"""Documents for the scenarios, and the steps that many of them take."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import driver
import FreeCAD
import FreeCADGui
from driver import QtWidgets, until

LOST = 8.0
"""Seconds after which nothing has come of a click."""

CUP = Path(__file__).resolve().parents[3] / "fixtures" / "cone_cup.step"


def job_of(document: Any, model: Any, profile: dict[str, Any]) -> Any:
    """A CAM job on a model with one stylus, as CAM's own dialog would make it."""
    import Path.Main.Gui.Job as PathJobGui
    import Path.Main.Job as PathJob

    from freecad.styluscam_wb import tools

    job = PathJob.Create("Job", [model])
    job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
    job.PostProcessor = "styluscam_linuxcnc"
    controller = job.Tools.Group[0]
    old = controller.Tool
    controller.Tool = tools.create_stylus(document, "Stylus", profile)
    if getattr(old, "BitBody", None):
        old.BitBody.removeObjectsFromDocument()
        document.removeObject(old.BitBody.Name)
    document.removeObject(old.Name)
    controller.Label = "TC: Stylus"
    controller.ToolNumber = 1
    controller.HorizFeed = controller.VertFeed = "1000 mm/min"
    document.recompute()
    document.clearUndos()
    show_all(isometric=True)
    return job


def job_with_stylus(diameter: float = 10.0) -> Any:
    """The cup, to be formed with a clothoid."""
    import Part

    document = FreeCAD.newDocument("Cup")
    document.UndoMode = 1
    model = document.addObject("Part::Feature", "Model")
    shape = Part.Shape()
    shape.read(str(CUP))
    model.Shape = shape
    document.recompute()
    return job_of(document, model, {"kind": "clothoid", "diameter": diameter})


def computed() -> tuple[Any, Any]:
    """The cup's job with one computed operation, coarse."""
    from freecad.styluscam_wb import defaults, ops

    job = job_with_stylus()
    operation = ops.Create("Levels", parentJob=job)
    defaults.fill(operation, "z-level")
    operation.WholeModel = True
    operation.Step = 5.0
    FreeCAD.ActiveDocument.recompute()
    FreeCAD.ActiveDocument.clearUndos()
    return job, operation


def dented_block(depth: float) -> tuple[Any, Any, Any, Any]:
    """A block with a round dent whose depth is a property: document, job, a computed operation on its faces, the dent."""
    import Part  # noqa: F401

    from freecad.styluscam_wb import defaults, ops

    document = FreeCAD.newDocument("Block")
    block = document.addObject("Part::Box", "Block")
    block.Length, block.Width, block.Height = 60.0, 60.0, 10.0
    dent = document.addObject("Part::Cone", "Dent")
    dent.Radius1, dent.Radius2, dent.Height = 20.0, 8.0, depth
    dent.Placement = FreeCAD.Placement(FreeCAD.Vector(30, 30, 10), FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 180))
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = block, dent
    document.recompute()
    job = job_of(document, cut, {"kind": "ball", "diameter": 6.0})
    operation = ops.Create("Rows", parentJob=job)
    defaults.fill(operation, "zig-zag")
    operation.Process = "milling"
    operation.Stepover = 5.0
    operation.WholeModel = True
    document.recompute()
    return document, job, operation, dent


def lowest(operation: Any) -> float:
    """The lowest height of a path, mm."""
    return float(min(c.Parameters["Z"] for c in operation.Path.Commands if c.Name == "G1"))


def motions(operation: Any) -> int:
    return sum(command.Name in ("G0", "G1", "G2", "G3") for command in operation.Path.Commands)


def show_all(*, isometric: bool = False) -> None:
    """All of the document in the view in front, at once."""
    from freecad.styluscam_wb.gui import camera

    camera.show_all(isometric=isometric)


def seen(operation: Any) -> dict[str, Any]:
    """State, path and view."""
    commands = operation.Path.Commands
    return {
        "motions": motions(operation),
        "state": list(operation.State),
        "first": commands[0].Name if commands else "",
        "notes": list(operation.Notes),
        "visible": operation.ViewObject.Visibility,
        "view": type(operation.ViewObject.Proxy).__name__,
    }


def posted(job: Any) -> dict[str, str]:
    """What FreeCAD's post mechanism returns."""
    from Path.Post.Processor import PostProcessorFactory

    try:
        processor = PostProcessorFactory.get_post_processor(job, job.PostProcessor)
        return {"text": "\n".join(text for _, text in processor.export())}
    except Exception as error:
        return {"refused": str(error), "type": type(error).__name__}


# --- steps ---------------------------------------------------------------------------------------------------------


def workbench(name: str) -> Any:
    """Brings a workbench to the front."""
    FreeCADGui.activateWorkbench(name)
    yield driver.settled()


def panel_is_open() -> bool:
    return bool(driver.visible(QtWidgets.QWidget, name="StylusCAM_Operation"))


def panel_is_closed() -> bool:
    return not FreeCADGui.Control.activeDialog()


def clicked(command: str) -> Any:
    """Clicks the button of a command, once it can be used."""
    yield until(lambda: driver.tool_button(command).isEnabled(), f"{command} enabled")
    driver.click(driver.tool_button(command))


def press(command: str) -> Any:
    """Presses an operation's button; its panel is open then.

    A posted click can be lost while FreeCAD sets up its bars: it is repeated once where nothing came of it.
    """
    for _ in range(2):
        yield from clicked(command)
        deadline = time.monotonic() + LOST
        yield until(
            lambda deadline=deadline: panel_is_open() or time.monotonic() > deadline, "the panel, or a lost click"
        )
        if panel_is_open():
            break
    yield until(panel_is_open, "the panel")
    yield driver.settled()


def ok(operation: Any) -> Any:
    """Presses OK; the panel is closed then and the operation computed."""
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Ok))
    yield until(panel_is_closed, "a closed panel", 60)
    yield until(lambda: "Touched" not in operation.State, "a computed operation", 60)
    yield driver.settled()


def typed(operation: Any, name: str, text: str, value: float) -> Any:
    """Types into the field of a property; it has this value then."""
    widget = driver.one(QtWidgets.QWidget, name=name)
    yield driver.focused(widget)
    driver.write(widget, text)
    yield until(lambda: abs(float(getattr(operation, name)) - value) < 1e-9, f"{name} of {text}")
