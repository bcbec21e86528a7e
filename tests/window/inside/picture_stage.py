"""What scenarios of pictures share: the cup, formed on a few levels, and what is drawn over it."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
import stage
from PySide import QtWidgets

STEP = 5.0
"""mm: few levels are quick."""


def formed_cup() -> tuple[Any, Any]:
    """The cup's job with one computed operation on its faces; the view shows all of it."""
    from freecad.styluscam_wb import defaults, ops

    job = stage.job_with_stylus()
    controller = job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed = "1500 mm/min", "300 mm/min"
    operation = ops.Create("Cup", parentJob=job)
    defaults.fill(operation, "z-level")
    operation.SheetThickness, operation.ModelFace = 1.0, "back"
    operation.Base = [(job.Model.Group[0], ("Face1", "Face2", "Face3", "Face4"))]
    operation.WholeModel = False
    operation.Step = STEP
    operation.ViewObject.Visibility = True
    FreeCAD.ActiveDocument.recompute()
    stage.show_all()
    return job, operation


def pushed_down(operation: Any, depth: float) -> list[float]:
    """Moves the middle position of an operation's path down into the part, mm; where it is then."""
    import Path

    commands = operation.Path.Commands
    middle = commands[len(commands) // 2]
    middle.Parameters = {**middle.Parameters, "Z": middle.Parameters["Z"] - depth}
    operation.Path = Path.Path(commands)
    operation.purgeTouched()
    return [middle.Parameters[axis] for axis in "XYZ"]


def legend(key: str) -> list[str] | None:
    """The texts of a legend over the view; None where it is not seen."""
    view = FreeCADGui.activeDocument().activeView().graphicsView()
    card = view.findChild(QtWidgets.QFrame, f"StylusCAM_Legend_{key}")
    return card.texts if card is not None and card.isVisible() else None


def overlay(name: str) -> Any:
    """The node of a picture in the 3-D view in front; None where it is not."""
    graph = FreeCADGui.activeDocument().activeView().getSceneGraph()
    found = [graph.getChild(index) for index in range(graph.getNumChildren())]
    return next((node for node in found if str(node.getName()) == name), None)


def nodes(root: Any, kind: str) -> list[Any]:
    """All nodes of a type below one, in the order in which they are drawn."""
    from freecad.styluscam_wb.gui import scene

    found = []
    for child in scene.children(root):
        if scene.type_name(child) == kind:
            found.append(child)
        found += nodes(child, kind)
    return found


def marked() -> list[float]:
    """Where the marker of a finding is."""
    return list(nodes(overlay("StylusCAM_Finding"), "Coordinate3")[0].point[0].getValue())


def selected_faces() -> list[str]:
    return [name for found in FreeCADGui.Selection.getSelectionEx() for name in found.SubElementNames]


def centre_of_view() -> list[float]:
    """The point at which the camera looks."""
    view = FreeCADGui.activeDocument().activeView()
    camera = view.getCameraNode()
    position = camera.position.getValue().getValue()
    direction, distance = view.getViewDirection(), camera.focalDistance.getValue()
    return [position[k] + direction[k] * distance for k in range(3)]


# --- heat maps, tracks, tools ------------------------------------------------------------------------------------


def is_drawn(job: Any) -> bool:
    """Whether anything of the job's model is drawn."""
    from freecad.styluscam_wb.gui import pictures, scene

    switches = [scene.mode_switch(obj.ViewObject) for obj in pictures.stands_for(job)]
    return any(switch.whichChild.getValue() != -1 for switch in switches)


def map_seen(count: int = 60) -> dict[str, Any]:
    """Positions and colours (red, green, blue) of some vertices of the heat map that is drawn, and its markers."""
    root = overlay("StylusCAM_HeatMap")
    colours = nodes(root, "PackedColor")[0].orderedRGBA.getValues()
    at, _, *markers = nodes(root, "Coordinate3")
    points = at.point.getValues()
    chosen = np.linspace(0, len(points) - 1, count).round().astype(int).tolist()
    return {
        "points": [list(points[i].getValue()) for i in chosen],
        "colours": [[colours[i] >> shift & 255 for shift in (24, 16, 8)] for i in chosen],
        "markers": [list(node.point[0].getValue()) for node in markers],
        "count": [len(points), len(colours)],
    }


def left_at(job: Any, points: list[list[float]]) -> list[float]:
    """What the engine finds left at points, mm: asked anew."""
    from freecad.styluscam_wb import verification

    found = verification.verify_job(job, lambda work: work(None)).report.left(np.array(points))
    return [float(value) for value in found]


def track_seen(job: Any) -> dict[str, Any]:
    """The contact track: how many points, the farthest from the model of every 25th, the lengths of its runs."""
    import Part

    root = overlay("StylusCAM_ContactTrack")
    points = [point.getValue() for point in nodes(root, "Coordinate3")[0].point.getValues()]
    shape = job.Model.Group[0].Shape
    far = [shape.distToShape(Part.Vertex(FreeCAD.Vector(*point)))[0] for point in points[::25]]
    index = np.array(nodes(root, "IndexedLineSet")[0].coordIndex.getValues())
    runs = np.diff(np.flatnonzero(index < 0), prepend=-1) - 1
    steps = np.linalg.norm(np.diff(np.array(points), axis=0), axis=1)
    return {"count": len(points), "far": max(far), "runs": runs.tolist(), "longest step": float(steps.max())}


def is_object_drawn(obj: Any) -> bool:
    """Whether an object itself is drawn."""
    from freecad.styluscam_wb.gui import scene

    return bool(scene.mode_switch(obj.ViewObject).whichChild.getValue() != -1)


def sheet_seen() -> dict[str, list[list[float]]]:
    """The boxes of the shapes of the sheet that are drawn, by their keys: lower and upper corner."""
    from freecad.styluscam_wb.gui import scene

    boxes = {}
    for part in scene.children(overlay("StylusCAM_Sheet")):
        name = str(part.getName())
        if name:
            points = np.array([p.getValue() for p in nodes(part, "Coordinate3")[0].point.getValues()])
            boxes[name.removeprefix("StylusCAM_Sheet_")] = [points.min(axis=0).tolist(), points.max(axis=0).tolist()]
    return boxes


def positions(operation: Any) -> list[list[float]]:
    """The ends of the moves of a path."""
    at: dict[str, float] = {}
    found = []
    for command in operation.Path.Commands:
        if command.Name in ("G0", "G1", "G2", "G3"):
            at |= {axis: value for axis, value in command.Parameters.items() if axis in "XYZ"}
            found += [[at[axis] for axis in "XYZ"]] if len(at) == 3 else []  # where all of it is known
    return found


def tip() -> list[float]:
    """Where the tip of the moving tool is."""
    return list(nodes(overlay("StylusCAM_Tool"), "Translation")[0].translation.getValue().getValue())


def tool_box() -> list[float]:
    """The box of the moving tool around its own tip: lower and upper corner."""
    points = [point.getValue() for point in nodes(overlay("StylusCAM_Tool"), "Coordinate3")[0].point.getValues()]
    return [*(min(p[k] for p in points) for k in range(3)), *(max(p[k] for p in points) for k in range(3))]


# --- FreeCAD's simulators ----------------------------------------------------------------------------------------


def simulated_profile(operation: Any) -> dict[str, list[float]]:
    """The tool's radii at heights above its tip, as FreeCAD's simulator has them and as the engine has them."""
    from Path.Main.Gui.SimulatorGL import CAMSimulation

    from freecad.styluscam_wb import tools

    bit = operation.ToolController.Tool
    points = np.array(CAMSimulation().GetToolProfile(bit, 0.5)).reshape(-1, 2)[::-1]
    import styluscam as sc

    tool = sc.Tool.from_dict(tools.tool_document(bit))
    slopes = np.linspace(0.2, tool.max_slope, 40)
    heights = tool.height_at(slopes)
    theirs = np.interp(heights, points[:, 1], points[:, 0])
    return {"theirs": theirs.tolist(), "ours": tool.radius_at(slopes).tolist()}


def cut_by_voxels(job: Any, operation: Any, voxel: float = 0.5) -> float:
    """How deep FreeCAD's older simulator cuts the job's stock with the tool along the path, mm."""
    import PathSimulator

    simulation = PathSimulator.PathSim()
    simulation.BeginSimulation(job.Stock.Shape, voxel)
    simulation.SetToolShape(operation.ToolController.Tool.Shape, voxel / 4.0)
    at = FreeCAD.Placement(FreeCAD.Vector(0, 0, job.Stock.Shape.BoundBox.ZMax), FreeCAD.Rotation())
    for command in operation.Path.Commands:
        if command.Name in ("G0", "G1"):
            at = simulation.ApplyCommand(at, command)
    _, inner = simulation.GetResultMesh()
    return float(inner.BoundBox.ZMin)
