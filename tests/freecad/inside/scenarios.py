"""Inside FreeCAD: operations that work and operations that fail, each reported as one line of JSON.

Names of scenarios after the other arguments choose among them.
"""

from __future__ import annotations

import importlib.util
import json
import os
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import tomllib

EXAMPLE, STEP, FOLDER, COARSE, *CHOSEN = sys.argv[sys.argv.index("--") + 1 :]

Scenario = Callable[[], dict[str, Any]]

MODEL: dict[str, Any] = {}


def module_of(name: str, path: str | Path) -> Any:
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def example() -> Any:
    return module_of("first_light", EXAMPLE)


def own(name: str, *needs: Callable[[], Any], file: str = "properties.py") -> Scenario:
    """A function of a file beside this one, with what it needs."""

    def scenario() -> dict[str, Any]:
        module = module_of(f"stylus_{file.removesuffix('.py')}", Path(__file__).with_name(file))
        return getattr(module, name)(*[need() for need in needs])

    return scenario


def settings(machine: str = "linuxcnc", **changes: Any) -> dict[str, Any]:
    found = tomllib.loads(Path(EXAMPLE).with_name("job.toml").read_text(encoding="utf-8"))
    operation = found["operations"][0] | changes
    del operation["step"]
    operation |= {"stepover": float(COARSE)} if operation["kind"] == "zig-zag" else {"step": {"height": float(COARSE)}}
    found["operations"][0] = operation | changes
    found["machine"]["name"] = machine
    return found


def make_job(document: Any, numbers: dict[str, Any]) -> Any:
    """The example's job, on a model that was read once: its triangles are then made once as well."""
    if not MODEL:
        MODEL["shape"] = example().read_shape(Path(STEP))
    return example().make_job(document, MODEL["shape"], numbers)


class Stage:
    """A new document with the example's job, at a coarse step; computed."""

    def __init__(self, machine: str = "linuxcnc", **changes: Any) -> None:
        import FreeCAD

        self.document = FreeCAD.newDocument("Stage")
        self.job = make_job(self.document, settings(machine, **changes))
        self.operation = example().make_operation(self.job, settings(machine, **changes))
        self.document.recompute()

    def again(self) -> Stage:
        self.operation.touch()
        self.document.recompute()
        return self

    def close(self) -> None:
        import FreeCAD

        FreeCAD.closeDocument(self.document.Name)

    def motions(self) -> int:
        return sum(c.Name in ("G0", "G1", "G2", "G3") for c in self.operation.Path.Commands)

    def seen(self) -> dict[str, Any]:
        """State, path and what posting returns."""
        commands = self.operation.Path.Commands
        return {
            "state": list(self.operation.State),
            "commands": len(commands),
            "motions": self.motions(),
            "first": commands[0].Name if commands else "",
            "post": posted(self.job),
        }


def posted(job: Any) -> dict[str, str]:
    try:
        return {"text": example().post(job)}
    except Exception as error:
        return {"refused": str(error), "type": type(error).__name__}


def broken(break_it: Callable[[Stage], Any], mend: Callable[[], Any] | None = None) -> Scenario:
    """A job that works, then something is done to it, then it is computed again."""

    def scenario() -> dict[str, Any]:
        stage = Stage()
        before = stage.motions()
        try:
            break_it(stage)
            after = stage.again().seen()
        finally:
            if mend:
                mend()
        stage.close()
        return {"before": before, "after": after}

    return scenario


def no_step(stage: Stage) -> None:
    stage.operation.Step = 0.0


def low_clearance(stage: Stage) -> None:
    stage.operation.setExpression("ClearanceHeight", None)
    stage.operation.ClearanceHeight = -30.0


def no_tolerance(stage: Stage) -> None:
    stage.operation.ModelTolerance = 0.0


def no_faces(stage: Stage) -> None:
    stage.operation.Base = []


def other_model(stage: Stage) -> None:
    import Part

    stage.operation.Base[0][0].Objects[0].Shape = Part.makeSphere(20)


def no_controller(stage: Stage) -> None:
    stage.operation.ToolController = None


def deleted_controller(stage: Stage) -> None:
    stage.document.removeObject(stage.operation.ToolController.Name)


def no_bit(stage: Stage) -> None:
    stage.operation.ToolController.Tool = None


def no_model_face(stage: Stage) -> None:
    stage.operation.ModelFace = ""


def other_diameter(stage: Stage) -> None:
    from freecad.styluscam_wb import tools

    profile = {"kind": "clothoid", "diameter": 1e-3}
    stage.operation.ToolController.Tool = tools.create_stylus(stage.document, "Wrong", profile)
    stage.operation.ToolController.Tool.Diameter = "12 mm"


def engine_raises(stage: Stage) -> None:
    import styluscam

    def plan(*_: Any, **__: Any) -> None:
        raise RuntimeError("the engine (broke)\nin two lines")

    plan.real = styluscam.plan
    styluscam.plan = plan


def engine_works() -> None:
    import styluscam

    styluscam.plan = styluscam.plan.real


KEPT: dict[str, Any] = {}


def engine_is_gone(stage: Stage) -> None:
    KEPT["styluscam"] = sys.modules["styluscam"]
    sys.modules["styluscam"] = None


def engine_is_back() -> None:
    sys.modules.update(KEPT)


def touched() -> dict[str, Any]:
    stage = Stage()
    stage.operation.Angle = 10
    seen = stage.seen()
    stage.close()
    return seen


def tampered() -> dict[str, Any]:
    """One coordinate of a computed path moved into the part."""
    import Path as CamPath

    stage = Stage()
    commands = stage.operation.Path.Commands
    deepest = min(c.Parameters["Z"] for c in commands if c.Name == "G1")
    at = next(i for i, c in enumerate(commands) if c.Name == "G1" and c.Parameters["Z"] == deepest) + 3
    commands[at] = CamPath.Command("G1", commands[at].Parameters | {"Z": deepest - 0.05})
    stage.operation.Path = CamPath.Path(commands)
    stage.operation.purgeTouched()
    seen = stage.seen()
    stage.close()
    return seen


def with_native(*lines: str) -> Scenario:
    """A job with an operation of FreeCAD's own beside ours."""

    def scenario() -> dict[str, Any]:
        from Path.Op import Custom

        stage = Stage()
        own = Custom.Create("Own", parentJob=stage.job)
        own.Label = "Own lines"
        own.ToolController = stage.operation.ToolController
        own.Gcode = list(lines)
        stage.document.recompute()
        seen = stage.seen()
        stage.close()
        return seen

    return scenario


def two_fixtures() -> dict[str, Any]:
    stage = Stage()
    stage.job.Fixtures = ["G54", "G55"]
    together = posted(stage.job)
    stage.job.SplitOutput = True
    from Path.Post.Processor import PostProcessorFactory

    processor = PostProcessorFactory.get_post_processor(stage.job, stage.job.PostProcessor)
    apart = dict(processor.export())
    stage.close()
    return {"together": together, "apart": apart}


def zig_zag_grbl() -> dict[str, Any]:
    stage = Stage("grbl", kind="zig-zag")
    stage.operation.AcceptedRisks = ["punch"]  # rows alone form no sheet
    seen = stage.again().seen()
    stage.close()
    return seen


def native_ball() -> dict[str, Any]:
    """FreeCAD's own ball end mill, milling the whole model, with the spindle on."""
    stage = Stage()
    tool = stage.operation.ToolController.Tool
    tool.Profile = json.dumps({"kind": "ball", "diameter": 10.0})
    stage.document.recompute()
    operation = stage.operation
    operation.Process = "milling"
    seen = stage.again().seen()
    seen["diameter"], seen["height"] = tool.Diameter.Value, tool.CuttingEdgeHeight.Value
    stage.close()
    return seen


def native_bits() -> dict[str, Any]:
    """FreeCAD's own ball end mill, turning; and its probe, which has no profile here."""
    stage = Stage()
    controller = stage.operation.ToolController
    result = {}
    for shape in ("ballend", "probe"):
        controller.Tool = native_bit(stage.document, f"{shape}.fcstd")
        controller.SpindleSpeed, controller.SpindleDir = 5000.0, "Forward"
        stage.operation.Process = "milling"
        stage.operation.CoolantMode = "Flood"
        result[shape] = stage.again().seen()
    stage.close()
    return result


def native_bit(document: Any, shape: str) -> Any:
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        return Factory.Create("Native", shape)
    return ToolBit.from_shape_id(shape).attach_to_doc(document)


def depths() -> dict[str, Any]:
    """Automatic depths, then a range of one's own."""
    stage = Stage()
    operation = stage.operation
    automatic = [operation.StartDepth.Value, operation.FinalDepth.Value]
    operation.setExpression("StartDepth", None)
    operation.setExpression("FinalDepth", None)
    operation.StartDepth, operation.FinalDepth = -5.0, -15.0
    stage.again()
    heights = sorted({round(c.Parameters["Z"], 6) for c in operation.Path.Commands if c.Name == "G1"})
    stage.close()
    return {"automatic": automatic, "lowest": heights[0], "highest": heights[-1]}


def tool_bit() -> dict[str, Any]:
    import FreeCAD

    from freecad.styluscam_wb import compat, tools

    stage = Stage()
    controller = stage.operation.ToolController
    controller.SpindleSpeed, controller.SpindleDir = 3000.0, "Forward"
    stage.document.recompute()
    bit = controller.Tool
    box = bit.Shape.BoundBox
    from styluscam import Tool

    odd = tools.create_stylus(stage.document, "Odd", {"kind": "ball", "diameter": 3.175})
    result = {
        "kind": compat.tool_kind(bit),
        "profile": bit.Profile,
        "lengths": [getattr(bit, n).Value for n in ("Diameter", "CuttingEdgeHeight", "Length", "ShankDiameter")],
        "box": [box.XLength, box.YLength, box.ZMin, box.ZMax],
        "volume": bit.Shape.Volume,
        "valid": bit.Shape.isValid(),
        "commands": [c.Name for c in controller.Path.Commands],
        "odd": Tool.from_dict(tools.tool_document(odd)).diameter,
    }
    bit.Profile = json.dumps({"kind": "ball", "diameter": 6.0})
    stage.document.recompute()
    result["edited"] = [bit.Diameter.Value, bit.CuttingEdgeHeight.Value, bit.Shape.Volume]
    stage.close()
    assert FreeCAD.listDocuments() == {}
    return result


def shapes() -> dict[str, Any]:
    """Parts of each kind of surface: the mesh's own figures and the exact shape's."""
    import Part
    from FreeCAD import Placement, Rotation
    from FreeCAD import Vector as At

    from freecad.styluscam_wb import part
    from styluscam.parts.arrays import signed_volume

    cup = Part.Shape()
    cup.read(STEP)
    square = Part.makePolygon([At(*p) for p in ((0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 0))])
    wave = Part.BSplineCurve()
    wave.interpolate([At(*p) for p in ((4, 0, 3), (6, 0, 5), (9, 0, 4), (12, 0, 5))])
    foot = Part.makePolygon([At(*p) for p in ((12, 0, 5), (12, 0, 0), (4, 0, 0), (4, 0, 3))])
    waved = Part.Face(Part.Wire([wave.toShape(), *foot.Edges]))
    moved = Part.makeCone(8, 3, 10)
    moved.Placement = Placement(At(5, 6, 7), Rotation(10, 20, 30))
    found = {}
    for name, shape in {
        "cup": cup,
        "cylinder": Part.makeBox(20, 20, 20).cut(Part.makeCylinder(5, 30, At(10, 10, -5))),
        "cone, moved": moved,
        "sphere": Part.makeSphere(10),
        "torus": Part.makeTorus(10, 3),
        "sphere as nurbs": Part.makeSphere(10).toNurbs(),
        "loft": Part.makeLoft([square, Part.Wire(Part.makeCircle(4, At(5, 5, 10)))], True),
        "extrusion": waved.extrude(At(0, 5, 0)),
        "revolution": waved.revolve(At(0, 0, 0), At(0, 0, 1), 360),
    }.items():
        arrays = part.arrays_of(shape, 0.01, name)
        found[name] = {
            "faces": [len(arrays.faces), len(shape.Faces)],
            "closed": arrays.is_closed,
            "deviation": [arrays.deviation_inward, arrays.deviation_outward],
            "volume": [signed_volume(arrays.vertices, arrays.triangles), shape.Volume],
            "area": shape.Area,
            "apart": max(
                abs(mine.area_mm2 - face.Area)
                + sum(abs(a - b) for a, b in zip(mine.centre, face.CenterOfMass, strict=True))
                for mine, face in zip(arrays.faces, shape.Faces, strict=True)
            ),
        }
    return found


def once_a_session() -> dict[str, Any]:
    """The same shape is tessellated once, also when a property changes."""
    from freecad.styluscam_wb import part

    count = {"calls": 0}
    real = part.arrays_of

    def counted(*args: Any) -> Any:
        count["calls"] += 1
        return real(*args)

    part.arrays_of = counted
    MODEL.clear()
    try:
        stage = Stage()
        stage.operation.Angle = 5
        stage.again().seen()
    finally:
        part.arrays_of = real
    stage.close()
    return count


def faces_as_in_the_file() -> dict[str, Any]:
    """How the model's faces are numbered, and how long its triangles take."""
    import Part

    from freecad.styluscam_wb import part

    shape = Part.Shape()
    shape.read(STEP)
    start = time.monotonic()
    arrays = part.arrays_of(shape, 0.001, "cup")
    return {
        "seconds": time.monotonic() - start,
        "faces": [[f.kind, f.area_mm2, *f.centre] for f in arrays.faces],
        "deviation": [arrays.deviation_inward, arrays.deviation_outward],
    }


def two_tools() -> dict[str, Any]:
    """Two operations of ours with a tool each: FreeCAD cannot choose between controllers by itself."""
    from Path.Tool import Controller

    from freecad.styluscam_wb import tools

    stage = Stage()
    other = Controller.Create(
        "Other", tool=tools.create_stylus(stage.document, "Six", {"kind": "ball", "diameter": 6.0})
    )
    other.ToolNumber = 2
    other.HorizFeed = other.VertFeed = "600 mm/min"
    stage.job.Proxy.addToolController(other)
    second = example().make_operation(stage.job, settings())
    second.Label = "second"
    second.ToolController = other
    stage.document.recompute()
    seen = stage.seen() | {"second": list(second.State)}
    second.SheetThickness = 1.5
    stage.document.recompute()
    seen["differ"] = posted(stage.job)
    stage.close()
    return seen


def first_of_two_tools() -> dict[str, Any]:
    """The first operation of a job that has two controllers."""
    import FreeCAD
    from Path.Tool import Controller

    from freecad.styluscam_wb import ops, tools

    document = FreeCAD.newDocument("Two")
    job = make_job(document, settings())
    other = Controller.Create("Other", tool=tools.create_stylus(document, "Six", {"kind": "ball", "diameter": 6.0}))
    job.Proxy.addToolController(other)
    operation = ops.Create("First", parentJob=job)
    result = {"tool": operation.ToolController.Label}
    FreeCAD.closeDocument(document.Name)
    return result


def saved() -> dict[str, Any]:
    import FreeCAD

    stage = Stage()
    stage.operation.Label = "cup (1) of München"
    stage.again()
    before = [[c.Name, c.Parameters] for c in stage.operation.Path.Commands]
    texts = [stage.operation.Path.toGCode()]
    path = str(Path(FOLDER) / "saved.FCStd")
    stage.document.saveAs(path)
    text = posted(stage.job)
    stage.close()
    document = FreeCAD.openDocument(path)
    operation = next(o for o in document.Objects if o.Label.startswith("cup"))
    texts.append(operation.Path.toGCode())
    after = [[c.Name, c.Parameters] for c in operation.Path.Commands]
    job = next(o for o in document.Objects if o.Name == "Job")
    result = {
        "before": before,
        "after": after,
        "state": list(operation.State),
        "posts_the_same": posted(job) == text,
        "bit": [operation.ToolController.Tool.Profile, operation.ToolController.Tool.Shape.Volume],
    }
    operation.touch()
    document.recompute()
    result["texts"] = [*texts, operation.Path.toGCode()]
    result["as_commands"] = as_commands(operation)
    operation.Step = 10.0
    document.recompute()
    result["recomputed"] = list(operation.State)
    result["commands"] = len(operation.Path.Commands)
    FreeCAD.closeDocument(document.Name)
    return result


def as_commands(operation: Any) -> str:
    """The program's moves as text when they go into the path as numbers, one command at a time."""
    import Path as CamPath

    import styluscam
    from freecad.styluscam_wb import documents, part

    job, model = operation.Proxy.job, documents.model_of(operation)
    read = part.part_of(model.Shape, operation.ModelTolerance.Value, model.Label)
    document = documents.job_document(job, [operation], read, documents.machine_of(job))
    moves = styluscam.plan(styluscam.Job.from_dict(document, part=read)).programs["main"].moves
    commands = []
    for move in moves:
        words = dict(zip("XYZ", (float(value) for value in move["end"]), strict=True))
        feed = {"F": float(move["feed"]) / 60.0} if move["kind"] == 1 else {}
        commands.append(CamPath.Command(f"G{move['kind']}", words | feed))
    return CamPath.Path(commands).toGCode()


SCENARIOS: dict[str, Scenario] = {
    "zig-zag grbl": zig_zag_grbl,
    "milling ball": native_ball,
    "native bits": native_bits,
    "depths": depths,
    "tool bit": tool_bit,
    "shapes": shapes,
    "faces": faces_as_in_the_file,
    "rails": own("rails_as_in_the_file", lambda: Path(STEP).with_name("blade.step"), file="rails.py"),
    "once": once_a_session,
    "two tools": two_tools,
    "first of two tools": first_of_two_tools,
    "saved": saved,
    "no step": broken(no_step),
    "low clearance": broken(low_clearance),
    "no tolerance": broken(no_tolerance),
    "no faces": broken(no_faces),
    "other model": broken(other_model),
    "no controller": broken(no_controller),
    "deleted controller": broken(deleted_controller),
    "no bit": broken(no_bit),
    "no model face": broken(no_model_face),
    "other diameter": broken(other_diameter),
    "engine raises": broken(engine_raises, engine_works),
    "engine is gone": broken(engine_is_gone, engine_is_back),
    "touched": touched,
    "tampered": tampered,
    "native straight": with_native("G0 Z20", "G0 X1 Y2", "G1 Z15 F10", "G1 X5"),
    "native arc": with_native("G0 X0 Y0 Z20", "G2 X1 Y1 I1 J0 F10"),
    "native cycle": with_native(
        "G0 X0 Y0 Z20", "G98 G81 X0 Y0 Z-1 R2 F5", "G81 X5 Y0 Z-1 R2 F5", "G80", "M10", "G0 Z20"
    ),
    "native probe": with_native("G0 X0 Y0 Z20", "G38.2 Z-5 F2", "G0 Z20"),
    "native axis": with_native("G0 X0 Y0 Z20 A10"),
    "two fixtures": two_fixtures,
    "native job": own("native_job", file="native_job.py"),
    "earlier document": own("earlier_document"),
    "new kind": own("new_kind", Stage),
    "arcs": own("arcs"),
    "wires": own("wires", Stage),
    "native tool": own("native_tool"),
}

SHARED = tuple(SCENARIOS)
"""What runs where none is chosen; the others have a FreeCAD of their own."""

SCENARIOS["mixed job"] = own("mixed_job", file="native_job.py")


def main() -> None:
    for name, scenario in SCENARIOS.items():
        if name not in (CHOSEN or SHARED):
            continue
        try:
            result = scenario()
        except BaseException:
            result = {"broke": traceback.format_exc()}
        print("\nRESULT " + json.dumps([name, result]), flush=True)


try:
    main()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
