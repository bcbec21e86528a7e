"""A twisted blade milled with the side of the tool: by a face and by two edges, tool axes, error map, what is refused."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import FreeCAD
import FreeCADGui
import milled_steps as steps
import picture_stage as drawn
import stage
from driver import QtCore, QtWidgets, until

BLADE = Path(__file__).resolve().parents[3] / "fixtures" / "blade.step"

FIVE_AXES, THREE_AXES = "styluscam_linuxcnc-trunnion", "styluscam_linuxcnc"


def job_on_blade(post: str = FIVE_AXES) -> Any:
    """Its CAM job, with an end mill of 8 mm."""
    import Part
    import Path.Main.Gui.Job as PathJobGui
    import Path.Main.Job as PathJob

    document = FreeCAD.newDocument("Blade")
    document.UndoMode = 1
    model = document.addObject("Part::Feature", "Blade")
    shape = Part.Shape()
    shape.read(str(BLADE))
    model.Shape = shape
    document.recompute()
    job = PathJob.Create("Job", [model])
    job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
    job.PostProcessor = post
    controller = job.Tools.Group[0]
    controller.ToolNumber = 1
    controller.Tool.Diameter, controller.Tool.CuttingEdgeHeight, controller.Tool.Length = "8 mm", "45 mm", "70 mm"
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "800 mm/min", "300 mm/min", 8000.0
    document.recompute()
    document.clearUndos()
    stage.show_all(isometric=True)
    return job


def selected(job: Any, *names: str) -> Any:
    """Selects elements of the model, then presses the operation's button."""
    yield from stage.workbench("StylusCamWorkbench")
    FreeCADGui.Selection.clearSelection()
    for name in names:
        FreeCADGui.Selection.addSelection(job.Model.Group[0], name)
    yield driver.settled()
    yield from stage.press("StylusCAM_Operation_Flank")
    return job.Operations.Group[-1]


def rails_of_face(job: Any) -> tuple[str, str]:
    """The lower and the upper edge of Face1."""
    shape = job.Model.Group[0].Shape
    level = [e for e in shape.Faces[0].Edges if e.BoundBox.ZLength < 1e-6]
    low, high = sorted(level, key=lambda edge: edge.BoundBox.ZMin)
    names = {f"Edge{n}": edge for n, edge in enumerate(shape.Edges, 1)}
    return tuple(next(name for name, edge in names.items() if edge.isSame(wanted)) for wanted in (low, high))


def applied(operation: Any) -> Any:
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Apply))
    yield until(lambda: steps.computed(operation) or "Invalid" in operation.State, "a result", 30)
    yield driver.settled()


def ticked(name: str) -> Any:
    """Clicks a check box of the panel."""
    box = driver.one(QtWidgets.QCheckBox, name=name)
    steps.scroll_to(box)
    yield driver.settled()
    driver.click(box, QtCore.QPoint(8, box.height() // 2))
    yield driver.settled()


def picture(name: str, key: str) -> dict[str, Any] | None:
    """Points and colours of a picture that is drawn, and its legend; None where there is none."""
    root = drawn.overlay(name)
    if root is None:
        return None
    points = [list(p.getValue()) for p in drawn.nodes(root, "Coordinate3")[0].point.getValues()]
    packed = drawn.nodes(root, "PackedColor")
    colours = [v >> 8 for v in packed[0].orderedRGBA.getValues()] if packed else []
    low, high = ([side(axis) for axis in zip(*points, strict=True)] for side in (min, max))
    return {
        "count": len(points),
        "colours": len(colours),
        "different": len(set(colours)),
        "low": low,
        "high": high,
        "legend": drawn.legend(key),
    }


def axes() -> Any:
    return picture("StylusCAM_Axes", "axes")


def error_map() -> Any:
    return picture("StylusCAM_Flank", "flank")


def words_of(operation: Any) -> list[int]:
    """How many moves state the tool's axis, and how many there are."""
    moves = [c for c in operation.Path.Commands if c.Name == "G1"]
    return [sum("K" in c.Parameters for c in moves), len(moves)]


def of_a_face() -> Any:
    """A face, the button, Apply, axes and map, OK; both off and on by their commands; verified and posted."""
    job = job_on_blade()
    operation = yield from selected(job, "Face1")
    result: dict[str, Any] = {"base": [list(names) for _, names in operation.Base], "rows": steps.rows()}
    result["panel"] = driver.shot("panel")
    yield from ticked("ToolAxes")
    yield from ticked("FlankMap")
    yield from applied(operation)
    yield until(lambda: axes() and error_map(), "both pictures", 40)
    stage.show_all(isometric=True)
    yield driver.settled(8)
    result |= {"state": list(operation.State), "notes": list(operation.Notes), "words": words_of(operation)}
    result |= {"axes": axes(), "map": error_map(), "preview": driver.shot("preview")}
    yield from stage.ok(operation)
    result["kept"] = [axes() is not None, error_map() is not None]
    for name, seen in (("ToolAxes", axes), ("FlankMap", error_map)):
        yield from steps.pressed(name)
        yield until(lambda seen=seen: seen() is None, "no picture")
        yield from steps.pressed(name)
        yield until(seen, "the picture", 30)
        yield driver.settled(6)
        result[f"{name} shot"] = driver.shot(name)
        yield from steps.pressed(name)
        yield until(lambda seen=seen: seen() is None, "no picture")
    return result | {"post": stage.posted(job), "report": driver.report_view()}


def of_two_edges() -> Any:
    """Two edges, the button; the side is asked for, then chosen."""
    job = job_on_blade()
    names = rails_of_face(job)
    operation = yield from selected(job, *names)
    text = driver.one(QtWidgets.QLineEdit, name="Rails_text")
    result: dict[str, Any] = {"names": list(names), "rails": operation.Rails, "shown": text.text()}
    result["base"] = [list(found) for _, found in operation.Base]
    yield from applied(operation)
    error = driver.one(QtWidgets.QLabel, name="Side_error")
    steps.scroll_to(error)
    yield driver.settled()
    result |= {"asked": error.text(), "without": list(operation.State), "asked shot": driver.shot("side")}
    driver.choose(driver.one(QtWidgets.QComboBox, name="Side"), "left")
    yield from applied(operation)
    yield driver.settled(6)
    result |= {"state": list(operation.State), "notes": list(operation.Notes), "chosen": driver.shot("edges")}
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(job.Model.Group[0], names[0])
    take = driver.one(QtWidgets.QPushButton, name="Rails_take")
    steps.scroll_to(take)
    driver.click(take)
    yield driver.settled()
    result["one edge"] = driver.one(QtWidgets.QLabel, name="Rails_note").text()
    result["one edge shot"] = driver.shot("one-edge")
    FreeCADGui.Selection.addSelection(job.Model.Group[0], names[1])
    driver.click(take)
    yield driver.settled()
    result["two edges"] = [text.text(), operation.Rails]
    yield from stage.ok(operation)
    return result | {"report": driver.report_view()}


def on_three_axes() -> Any:
    """The post's machine cannot turn the tool: the panel states it, and nothing is posted."""
    job = job_on_blade(THREE_AXES)
    operation = yield from selected(job, "Face1")
    yield from applied(operation)
    notes = driver.one(QtWidgets.QLabel, name="StylusCAM_Notes").text()
    shot = driver.shot("three-axes")
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Cancel))
    yield until(stage.panel_is_closed, "a closed panel")
    return {"notes": notes, "shot": shot}


driver.run({"of a face": of_a_face, "of two edges": of_two_edges, "on three axes": on_three_axes})
