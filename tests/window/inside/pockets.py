"""A milled part with pockets: the operation made with the button on selected faces, its panel, the engagement map, the text."""

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

BOUND = 70.0
"""deg"""


def bracket() -> Any:
    """A block with a pocket that is open on one side and has an island in it, and a deeper pocket in its floor."""
    import Part

    vector = FreeCAD.Vector

    def rounded(x: float, y: float, z: float, at: Any) -> Any:
        box = Part.makeBox(x, y, z, at)
        return box.makeFillet(4.0, [edge for edge in box.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.9])

    upper = rounded(34.0, 24.0, 4.0, vector(5.0, 4.0, 6.0)).fuse(Part.makeBox(12.0, 12.0, 4.0, vector(34.0, 10.0, 6.0)))
    island = Part.makeCylinder(2.5, 4.0, vector(30.0, 16.0, 6.0))
    lower = rounded(14.0, 14.0, 3.0, vector(8.0, 9.0, 3.0))
    return Part.makeBox(44.0, 32.0, 10.0).cut(upper.cut(island)).cut(lower).removeSplitter()


def job_on_bracket() -> Any:
    """Its CAM job, with the end mill of 5 mm that FreeCAD gives a new one."""
    import Path.Main.Gui.Job as PathJobGui
    import Path.Main.Job as PathJob

    document = FreeCAD.newDocument("Bracket")
    document.UndoMode = 1
    model = document.addObject("Part::Feature", "Bracket")
    model.Shape = bracket()
    document.recompute()
    job = PathJob.Create("Job", [model])
    job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
    job.PostProcessor = "styluscam_linuxcnc"
    controller = job.Tools.Group[0]
    controller.ToolNumber = 1
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "1500 mm/min", "500 mm/min", 10000.0
    document.recompute()
    document.clearUndos()
    stage.show_all(isometric=True)
    return job


def floors(job: Any) -> list[str]:
    """The level faces between the block's foot and its top."""
    faces = job.Model.Group[0].Shape.Faces
    return [
        f"Face{number}"
        for number, face in enumerate(faces, 1)
        if face.BoundBox.ZLength < 1e-6 and 1.0 < face.BoundBox.ZMin < 9.0
    ]


def risks() -> list[str]:
    """The risks whose boxes are seen."""
    boxes = [box.objectName() for box in driver.visible(QtWidgets.QCheckBox)]
    return [name.removeprefix("AcceptedRisks_") for name in boxes if name.startswith("AcceptedRisks_")]


def map_seen() -> dict[str, Any] | None:
    """Points and colours of the map that is drawn, and its legend; None where there is none."""
    root = drawn.overlay("StylusCAM_Engagement")
    if root is None:
        return None
    points = [list(point.getValue()) for point in drawn.nodes(root, "Coordinate3")[0].point.getValues()]
    values = drawn.nodes(root, "PackedColor")[0].orderedRGBA.getValues()
    colours = [[value >> shift & 255 for shift in (24, 16, 8)] for value in values]
    different = [list(one) for one in sorted({tuple(one) for one in colours})]
    low, high = ([side(axis) for axis in zip(*points, strict=True)] for side in (min, max))
    return {
        "count": [len(points), len(colours)],
        "different": different,
        "low": low,
        "high": high,
        "legend": drawn.legend("engagement"),
        "path legend": drawn.legend("path"),
    }


def designed() -> Any:
    """As a designer goes: faces, button, angle, map, Apply, OK; the map off and on by its command; verified and posted."""
    job = job_on_bracket()
    yield from stage.workbench("StylusCamWorkbench")
    model = job.Model.Group[0]
    FreeCADGui.Selection.clearSelection()
    for name in floors(job):
        FreeCADGui.Selection.addSelection(model, name)
    yield driver.settled()
    yield from stage.press("StylusCAM_Operation_Pocket")
    operation = job.Operations.Group[-1]
    result: dict[str, Any] = {"step": operation.Step.Value, "base": [list(names) for _, names in operation.Base]}
    yield from stage.typed(operation, "Engagement", f"{BOUND:g}", BOUND)
    yield from stage.typed(operation, "Step", "4 mm", 4.0)  # one level in each pocket: quick
    driver.click(driver.one(QtWidgets.QToolButton, name="Advanced"))
    yield driver.settled()
    result |= {"rows": steps.rows(), "risks": risks(), "panel": driver.shot("panel")}
    box = driver.one(QtWidgets.QCheckBox, name="EngagementMap")
    steps.scroll_to(box)
    driver.click(box, QtCore.QPoint(8, box.height() // 2))
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Apply))
    yield until(lambda: steps.computed(operation), "a path", 120)
    yield until(map_seen, "the map", 120)
    yield driver.settled(6)
    result |= {"preview": map_seen(), "preview shot": driver.shot("preview")}
    driver.click(box, QtCore.QPoint(8, box.height() // 2))
    yield until(lambda: map_seen() is None, "no map")
    result["off"] = [drawn.legend("engagement"), drawn.legend("path")]
    yield from stage.ok(operation)
    stage.show_all()
    yield driver.settled(10)
    result |= {"path": stage.seen(operation), "path shot": driver.shot("path")}
    yield from steps.pressed("EngagementMap")
    yield until(map_seen, "the map", 120)
    yield driver.settled(6)
    result |= {"map": map_seen(), "map shot": driver.shot("map")}
    yield from steps.pressed("EngagementMap")
    yield until(lambda: map_seen() is None, "no map")
    yield from steps.pressed("Verify")
    yield until(lambda: driver.visible(QtWidgets.QWidget, name="StylusCAM_Findings"), "findings", 120)
    panel = driver.one(QtWidgets.QWidget, name="StylusCAM_Findings")
    result["findings"] = [label.text() for label in panel.findChildren(QtWidgets.QLabel)]
    result["findings shot"] = driver.shot("findings")
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Close))
    yield until(stage.panel_is_closed, "a closed panel")
    return result | {"post": stage.posted(job), "report": driver.report_view()}


def refused(change: Any) -> Any:
    """A pocket that cannot be computed as it is changed: what the panel states after Apply."""
    job = job_on_bracket()
    yield from stage.workbench("StylusCamWorkbench")
    FreeCADGui.Selection.clearSelection()
    for name in floors(job):
        FreeCADGui.Selection.addSelection(job.Model.Group[0], name)
    yield from stage.press("StylusCAM_Operation_Pocket")
    operation = job.Operations.Group[-1]
    yield driver.settled()
    change(job, operation)
    yield driver.settled()
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Apply))
    yield until(lambda: "Invalid" in operation.State, "a failure", 60)
    yield driver.settled()
    shot = driver.shot(f"refused-{change.__name__}")
    notes = driver.one(QtWidgets.QLabel, name="StylusCAM_Notes").text()
    driver.click(driver.panel_button(QtWidgets.QDialogButtonBox.Cancel))
    yield until(stage.panel_is_closed, "a closed panel")
    return {"notes": notes, "shot": shot}


def no_face(job: Any, operation: Any) -> None:
    operation.Base = []
    operation.WholeModel = False


def large_tool(job: Any, operation: Any) -> None:
    job.Tools.Group[0].Tool.Diameter = 40.0


def no_room_for_the_hole(job: Any, operation: Any) -> None:
    operation.EntryHole = '{"x": 30.0, "y": 16.0, "diameter": 5.4}'


def refusals() -> Any:
    """All of them."""
    found = {}
    for change in (no_face, large_tool, no_room_for_the_hole):
        found[change.__name__] = yield from refused(change)
    return found


def not_a_pocket() -> Any:
    """The command without a pocket states what to select."""
    stage.computed()
    yield from stage.workbench("StylusCamWorkbench")
    yield from steps.pressed("EngagementMap")
    yield until(lambda: driver.visible(QtWidgets.QMessageBox), "a message")
    box = driver.one(QtWidgets.QMessageBox)
    text = box.text()
    driver.click(driver.one(QtWidgets.QPushButton, inside=box))
    yield until(lambda: not driver.visible(QtWidgets.QMessageBox), "no message")
    return text


driver.run({"designed": designed, "refusals": refusals, "not a pocket": not_a_pocket})
