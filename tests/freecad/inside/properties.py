"""Inside FreeCAD: properties from the engine's schema, a document of an earlier version, and arcs in paths."""

from __future__ import annotations

import contextlib
import copy
import json
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD

SAVED = Path(__file__).parents[1] / "saved" / "operation_of_0.1.FCStd"


def commands_of(operation: Any) -> list[Any]:
    return [[command.Name, command.Parameters] for command in operation.Path.Commands]


def properties_of(operation: Any) -> dict[str, Any]:
    """Value and editor mode of each property of ours."""
    names = [name for name in operation.PropertiesList if operation.getGroupOfProperty(name) == "Stylus"]
    values = {name: getattr(operation, name) for name in names}
    return {
        name: [getattr(value, "Value", value), "Hidden" in operation.getEditorMode(name)]
        for name, value in values.items()
    }


@contextlib.contextmanager
def output() -> Iterator[list[str]]:
    """What FreeCAD itself prints meanwhile, which Python's streams do not see."""
    printed: list[str] = []
    with tempfile.TemporaryFile("w+", encoding="utf-8") as file:
        streams = (1, 2)
        kept = [os.dup(stream) for stream in streams]
        sys.stdout.flush()
        for stream in streams:
            os.dup2(file.fileno(), stream)
        try:
            yield printed
        finally:
            sys.stdout.flush()
            for stream, real in zip(streams, kept, strict=True):
                os.dup2(real, stream)
                os.close(real)
            file.seek(0)
            printed.append(file.read())


def earlier_document() -> dict[str, Any]:
    """A document that an earlier version of the addon saved in FreeCAD 1.0: opened, then computed again."""
    with output() as printed:
        document = FreeCAD.openDocument(str(SAVED))
    operation = next(o for o in document.Objects if o.Label == "cup")
    opened = commands_of(operation)
    before = properties_of(operation)
    bit = operation.ToolController.Tool
    restored = [type(bit.Proxy).__name__, bit.Profile, bit.Diameter.Value, bit.Shape.Volume]
    operation.touch()
    document.recompute()
    bit.Profile = json.dumps({"kind": "ball", "diameter": 6.0})
    result = {
        "printed": "".join(printed),
        "bit": restored,
        "edited bit": bit.Diameter.Value,
        "opened": opened,
        "before": before,
        "computed": commands_of(operation),
        "after": properties_of(operation),
        "state": list(operation.State),
    }
    FreeCAD.closeDocument(document.Name)
    return result


def new_kind(stage: Any) -> dict[str, Any]:
    """A kind and a key that the engine has and the addon has never heard of."""
    import styluscam
    from freecad.styluscam_wb import documents, properties

    real = styluscam.job_schema
    schema = with_kind(copy.deepcopy(real()))
    styluscam.job_schema = lambda: schema
    properties._read.cache_clear()
    try:
        operation = stage.operation
        properties.update(operation)
        text = operation.getDocumentationOfProperty("RingDistance")
        result = {"before": [operation.Strategy, properties_of(operation)], "text": text}
        operation.Strategy = "rings"
        operation.RingDistance = 2.5
        result["after"] = [properties_of(operation), documents.operation_section(operation)]
        operation.Process = "milling"
        part = properties.section(operation, "part")
        result["milling"] = [properties_of(operation), part]
    finally:
        styluscam.job_schema = real
        properties._read.cache_clear()
    stage.close()
    return result


def with_kind(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with the kind of `docs/howto/add-an-operation.md`: the keys that all kinds take, and its own."""
    kinds = schema["$defs"][schema["properties"]["operations"]["items"]["$ref"].rpartition("/")[2]]["oneOf"]
    common = set.intersection(*[set(kind["properties"]) for kind in kinds])
    distance = {"type": "number", "x-unit": "mm", "x-example": "1.5", "exclusiveMinimum": 0.0, "maximum": 100.0}
    kinds.append(
        {
            **kinds[0],
            "description": "Concentric circles.",
            "properties": {
                **{key: entry for key, entry in kinds[0]["properties"].items() if key in common},
                "kind": {"type": "string", "const": "rings"},
                "ring_distance": {**distance, "description": "Distance between rings in plan."},
            },
            "required": ["kind", "ring_distance"],
        }
    )
    return schema


LINES = {
    "xy": ["G1 X10 F600", "G3 X0 Y10 I-10 J0", "G2 X10 Y0 I0 J-10", "G3 X10 Y0 I-4 J3"],
    "zx": ["G1 X10 F600", "G18", "G2 X0 Z-10 I-10 K0", "G3 X10 Z0 I0 K10", "G1 X20"],
    "yz": ["G1 Y10 F600", "G19", "G3 Y0 Z-10 J-10 K0", "G2 Y10 Z0 J0 K10"],
    "helix": ["G1 X10 F600", "G3 X0 Y10 Z-9 I-10 J0 P3", "G1 X1"],
}


TOOL = {
    "name": "T1",
    "number": 1,
    "length_offset": 1,
    "description": "any",
    "reference": "tip",
    "reference_height": 0.0,
    "diameter": 6.0,
}


def arcs() -> dict[str, Any]:
    """Arcs of programs as FreeCAD's path: its own box around them, and the program that is read back."""
    import styluscam
    from freecad.styluscam_wb import engine, motion

    linuxcnc = styluscam.Machine.shipped("linuxcnc")
    result = {}
    for name, lines in LINES.items():
        text = "\n".join(["G21 G90 G94 G17 G54", "G0 X0 Y0 Z5", "G0 Z0", *lines, "M2", ""])
        program = styluscam.read_gcode(text, linuxcnc)
        path = motion.path_of([], program, [])
        setup = {**program.setup, "wcs": "G54"}
        sections = [("tool", None, "None", "M6 T1\n"), ("arcs", "arcs", "None", path.toGCode())]
        again = engine.program_of_path(sections, json.dumps([TOOL]), json.dumps(setup))
        box, points = path.BoundBox, program.positions
        result[name] = {
            "names": [command.Name for command in path.Commands],
            "box": [box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax],
            "expected": [*points.min(axis=0), *points.max(axis=0)],
            "length": [again.length, program.length],
            "ends": [again.moves["end"][-1].tolist(), program.moves["end"][-1].tolist()],
        }
    return result


def wires(stage: Any) -> dict[str, Any]:
    """An operation bounded by a sketch of two lines and an arc, by an edge that does not close, and by check faces."""
    import Part

    from freecad.styluscam_wb import wires as module

    def ends() -> list[float]:
        """The cuts' farthest Y, and the largest distance from the axis where they are in front."""
        cuts = [c.Parameters for c in stage.operation.Path.Commands if c.Name == "G1" and "Y" in c.Parameters]
        return [min(c["Y"] for c in cuts), max(c["Y"] for c in cuts)]

    operation, document = stage.operation, stage.document
    sketch = document.addObject("Sketcher::SketchObject", "Outline")
    left, right = FreeCAD.Vector(-60.0, 2.5, 0.0), FreeCAD.Vector(60.0, 2.5, 0.0)
    arc = Part.ArcOfCircle(
        Part.Circle(FreeCAD.Vector(0.0, 2.5, 0.0), FreeCAD.Vector(0, 0, 1), 60.0), 3.141592653589793, 0.0
    )
    sketch.addGeometry([Part.LineSegment(left, right), arc])
    document.recompute()
    whole = ends()
    operation.BoundaryWires = [(sketch, ("",))]
    stage.again()
    bounded, loops = ends(), module.loops(operation)
    operation.BoundaryWires = [(sketch, ("Edge1",))]
    stage.again()
    result = {
        "whole": whole,
        "bounded": bounded,
        "corners": [len(loop) for loop in loops],
        "off": max(abs((x * x + (y - 2.5) ** 2) ** 0.5 - 60.0) for x, y in loops[0]),
        "open": stage.operation.Path.Commands[0].Name,
    }
    operation.BoundaryWires = []
    operation.CheckFaces, operation.CheckClearance = '"rest"', 2.0
    stage.again()
    result["rest"] = [len(stage.operation.Path.Commands), ends()]
    stage.close()
    return result


def native_tool() -> dict[str, Any]:
    """An operation in a job whose only tool is FreeCAD's end mill."""
    import Part
    import Path.Main.Job as PathJob

    from freecad.styluscam_wb import ops

    document = FreeCAD.newDocument("Native")
    body = document.addObject("Part::Feature", "Body")
    body.Shape = Part.makeBox(20, 20, 10)
    document.recompute()
    job = PathJob.Create("Job", [body])
    operation = ops.Create("First", parentJob=job)
    result = {"tool": operation.ToolController is not None and operation.ToolController == job.Tools.Group[0]}
    FreeCAD.closeDocument(document.Name)
    return result
