"""Run by FreeCAD: its own Adaptive, 3D Surface or Waterline on a part in a box of stock, as G-code.

freecad_machining.py -- IN [FOLDER]: a JSON document (``Part.native`` of ``machining_time``); libraries that OpenCAMLib is linked
to may be in the folder. Settings that the document does not state are as FreeCAD makes them. The moves of each case are written
to a file in the document's ``output``.
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import sys
import traceback
from pathlib import Path as FilePath
from typing import Any

import FreeCAD
import freecad_cap as cap
import Part
import Path.Main.Job as PathJob
from Path.Main import Stock

MM_PER_MIN = 60.0
"""FreeCAD's feeds are in mm/s."""

MOVES = {"G0": "G0", "G00": "G0", "G1": "G1", "G01": "G1", "G2": "G2", "G02": "G2", "G3": "G3", "G03": "G3"}


def job_of(asked: dict[str, Any]) -> Any:
    """A job with the part, its stock and one tool."""
    document = cap.new_document("Beside")
    model = document.addObject("Part::Feature", "Part")
    shape = Part.Shape()
    shape.read(asked["part"])
    model.Shape = shape
    document.recompute()
    job = PathJob.Create("Job", [model])
    replaced = job.Stock
    sides, top = asked["sides"], asked["top"]
    low, high = FreeCAD.Vector(sides, sides, 0.0), FreeCAD.Vector(sides, sides, top)
    job.Stock = Stock.CreateFromBase(job, low, high)
    document.removeObject(replaced.Name)
    controller = job.Tools.Group[0]
    controller.Tool = bit(asked["shape"], asked["diameter"])
    controller.HorizFeed = f"{asked['feed']} mm/min"
    controller.VertFeed = f"{asked['plunge']} mm/min"
    controller.HorizRapid = controller.VertRapid = f"{asked['rapid']} mm/min"
    controller.SpindleSpeed, controller.SpindleDir = asked["spindle"], "Forward"
    document.recompute()
    return job


def bit(shape: str, diameter: float) -> Any:
    """FreeCAD's own tool of a shape, long enough for the part."""
    from Path.Tool.toolbit import ToolBit

    made = ToolBit.from_shape_id(f"{shape}.fcstd").attach_to_doc(FreeCAD.ActiveDocument)
    made.Diameter = f"{diameter} mm"
    return made


def operation_of(job: Any, module: Any, settings: dict[str, Any]) -> Any:
    """An operation, not computed yet."""
    operation = module.Create("Native", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    for name, value in settings.items():
        operation.setExpression(name, None)
        setattr(operation, name, value)
    return operation


def text(commands: list[Any]) -> str:
    """The moves as G-code, each with all its words."""
    lines = []
    for command in commands:
        move = MOVES.get(command.Name)
        if move is None:
            if not command.Name.startswith("("):
                raise RuntimeError(f"{command.Name} in the path")
            continue
        words = dict(command.Parameters)
        words.pop("K", None)
        if "F" in words:
            words["F"] *= MM_PER_MIN
        if move == "G0":
            words.pop("F", None)
        lines.append(" ".join([move, *(f"{name}{value:.4f}" for name, value in words.items())]))
    return "\n".join([*lines, ""])


def computed(asked: dict[str, Any], case: list[dict[str, Any]]) -> str:
    """The moves of operations one after the other."""
    job = job_of(asked)
    module = importlib.import_module(f"Path.Op.{asked['operation']}")
    commands: list[Any] = []
    for settings in case:
        operation = operation_of(job, module, settings)
        cap.recompute(operation)
        commands += operation.Path.Commands
    FreeCAD.closeDocument(FreeCAD.ActiveDocument.Name)
    return text(commands)


def main(source: str, folder: str = "") -> None:
    """Computes the paths of all cases."""
    boost = "libboost_python{}{}.so.*".format(*sys.version_info)
    for library in FilePath(folder).glob(f"usr/lib/*/{boost}") if folder else ():
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    asked = json.loads(FilePath(source).read_text(encoding="utf-8"))
    errors: dict[int, str] = {}
    for number, case in enumerate(asked["cases"]):
        try:
            moves = computed(asked, case)
        except Exception as error:
            traceback.print_exc(file=sys.stdout)
            errors[number] = f"{type(error).__name__}: {error}"[:200]
            continue
        (FilePath(asked["output"]) / f"{number}.ngc").write_text(moves, encoding="utf-8")
    cap.result(errors)


try:
    main(*sys.argv[sys.argv.index("--") + 1 :])
except BaseException:
    traceback.print_exc(file=sys.stdout)
finally:
    sys.stdout.flush()
    os._exit(0)
