"""A job of FreeCAD's own operations: contour, pocket, holes of three kinds, a helix, adaptive clearing."""

from __future__ import annotations

from typing import Any

import FreeCAD
import Part
from FreeCAD import Vector


def native_job() -> dict[str, Any]:
    """The job posted by our post, by FreeCAD's, and by ours with arguments and for other machines."""
    write_shop()
    document = FreeCAD.newDocument("native")
    job = job_of(document)
    texts = {
        "ours": text(job, "styluscam_linuxcnc", "--no-split-rapids"),
        "theirs": text(job, "linuxcnc", "--no-show-editor"),
        "arguments": text(job, "styluscam_linuxcnc", "--inches --precision=5 --no-header --no-comments --line-numbers"),
        "shop": text(job, "styluscam_shop", ""),
        "unknown argument": text(job, "styluscam_linuxcnc", "--no-heder"),
    }
    for machine in ("grbl", "fanuc", "heidenhain", "siemens", "okuma", "marlin"):
        texts[machine] = text(job, f"styluscam_{machine}", "")
    counts = {op.Label: len(op.Path.Commands) for op in job.Operations.Group}
    FreeCAD.closeDocument(document.Name)
    return {"texts": texts, "commands": counts}


def mixed_job() -> dict[str, Any]:
    """Pocket, drilling of three kinds and an operation of ours in one job, posted for every machine that is shipped."""
    import styluscam
    from freecad.styluscam_wb import machines, ops

    document = FreeCAD.newDocument("mixed")
    job = job_of(document, ("Pocket", "Drilling", "Pecks", "Dwells"))
    operation = ops.Create("Ours", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    operation.Process, operation.Strategy, operation.Stepover = "milling", "zig-zag", 2.0
    operation.Base = [(job.Model.Group[0], faces_at(job.Model.Group[0], 20.0))]
    drill = second_tool(job)
    for native in job.Operations.Group[1:4]:
        native.ToolController = drill
    document.recompute()
    texts = {name: text(job, machines.POST_PREFIX + name, "") for name in styluscam.Machine.names()}
    job.OrderOutputBy, job.SplitOutput = "Tool", True
    apart = {name: files(job, machines.POST_PREFIX + name) for name, whole in texts.items() if "refused" in whole}
    kinds = [type(op.Proxy).__name__ for op in job.Operations.Group]
    FreeCAD.closeDocument(document.Name)
    return {"texts": texts, "apart": apart, "operations": kinds}


def second_tool(job: Any) -> Any:
    """Another tool controller, number 2; it comes after the operations: FreeCAD cannot choose between two by itself."""
    from Path.Tool import Controller

    from freecad.styluscam_wb import tools

    bit = tools.create_stylus(job.Document, "Six", {"kind": "ball", "diameter": 6.0})
    controller = Controller.Create("Other", tool=bit, toolNumber=2)
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = 10, 5, 3000
    job.Proxy.addToolController(controller)
    return controller


def write_shop() -> None:
    """A machine file in the user's folder, as it would be there before FreeCAD starts."""
    from freecad.styluscam_wb import machines

    machines.user_folder().mkdir(parents=True, exist_ok=True)
    shop = 'schema = 1\nextends = "fanuc"\nname = "shop"\nend = "M2"\n\n[stop]\nalways = "M60"\n'
    (machines.user_folder() / "shop.toml").write_text(shop, encoding="utf-8")
    machines.write_user_posts()


def text(job: Any, post: str, arguments: str) -> str:
    """What a post makes of the job, or why it makes nothing."""
    from Path.Post.Processor import PostProcessorFactory

    job.PostProcessor = post
    job.PostProcessorArgs = arguments
    try:
        sections = PostProcessorFactory.get_post_processor(job, post).export()
    except Exception as error:
        return f"refused: {error}"
    return str(sections[0][1])


ALL = ("Profile", "Pocket", "Drilling", "Pecks", "Dwells", "Helix", "Adaptive")


def files(job: Any, post: str) -> list[str]:
    """The texts that a post makes of a job whose output is split."""
    from Path.Post.Processor import PostProcessorFactory

    job.PostProcessor = post
    return [text for _, text in PostProcessorFactory.get_post_processor(job, post).export()]


def job_of(document: Any, wanted: tuple[str, ...] = ALL) -> Any:
    """A block with a pocket, two through holes and a round recess, and the wanted operations."""
    import Path.Main.Job as PathJob

    body = document.addObject("Part::Feature", "Body")
    body.Shape = block()
    document.recompute()
    job = PathJob.Create("Job", [body])
    controller = job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = 10, 5, 3000
    for name in wanted:
        operation, base = operation_of(job, name)
        operation.ToolController = controller
        if base:
            operation.Base = [(job.Model.Group[0], base)]
    document.recompute()
    return job


def operation_of(job: Any, name: str) -> tuple[Any, list[str]]:
    """A new operation and the faces that it is for; none for the whole model."""
    import Path.Op.PocketShape as Pocket
    from Path.Op import Adaptive, Drilling, Helix, Profile

    model = job.Model.Group[0]
    if name == "Profile":
        return Profile.Create(name, parentJob=job), []
    if name == "Pocket":
        return Pocket.Create(name, parentJob=job), faces_at(model, 12.0)
    if name == "Adaptive":
        return Adaptive.Create(name, parentJob=job), faces_at(model, 12.0)
    if name == "Helix":
        return bare(Helix.ObjectHelix, name, job), faces_at(model, 10.0)
    operation = bare(Drilling.ObjectDrilling, name, job)
    if name == "Pecks":
        operation.PeckEnabled, operation.PeckDepth = True, 3
    if name == "Dwells":
        operation.DwellEnabled, operation.DwellTime = True, 0.5
    return operation, holes(model)


def bare(proxy: Any, name: str, job: Any) -> Any:
    """An operation without what its module does at creation: FreeCAD 1.0 looks for holes there, which fails without a window."""
    operation = job.Document.addObject("Path::FeaturePython", name)
    operation.Proxy = proxy(operation, name, job)
    return operation


def faces_at(model: Any, height: float) -> list[str]:
    """Horizontal faces at a height, mm."""
    faces = enumerate(model.Shape.Faces, 1)
    return [f"Face{i}" for i, face in faces if abs(face.CenterOfMass.z - height) < 1e-6 and level(face)]


def holes(model: Any) -> list[str]:
    """The walls of the through holes."""
    faces = enumerate(model.Shape.Faces, 1)
    return [f"Face{i}" for i, face in faces if abs(getattr(face.Surface, "Radius", 0.0) - 3) < 1e-6]


def block() -> Any:
    """80 x 60 x 20 mm."""
    shape = Part.makeBox(80, 60, 20).cut(Part.makeBox(30, 20, 8, Vector(10, 10, 12)))
    for x in (55, 70):
        shape = shape.cut(Part.makeCylinder(3, 20, Vector(x, 15, 0)))
    return shape.cut(Part.makeCylinder(9, 10, Vector(60, 42, 10)))


def level(face: Any) -> bool:
    """Whether a face is horizontal."""
    return abs(abs(face.normalAt(0, 0).z) - 1) < 1e-6
