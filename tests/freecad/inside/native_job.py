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


def job_of(document: Any) -> Any:
    """A block with a pocket, two through holes and a round recess, and operations for each."""
    import Path.Main.Job as PathJob
    import Path.Op.PocketShape as Pocket
    from Path.Op import Adaptive, Drilling, Helix, Profile

    body = document.addObject("Part::Feature", "Body")
    body.Shape = block()
    document.recompute()
    job = PathJob.Create("Job", [body])
    model, controller = job.Model.Group[0], job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = 10, 5, 3000
    faces = {f"Face{i}": face for i, face in enumerate(model.Shape.Faces, 1)}
    pocket = [name for name, face in faces.items() if abs(face.CenterOfMass.z - 12) < 1e-6 and level(face)]
    recess = [name for name, face in faces.items() if abs(face.CenterOfMass.z - 10) < 1e-6 and level(face)]
    holes = [name for name, face in faces.items() if abs(getattr(face.Surface, "Radius", 0.0) - 3) < 1e-6]

    def add(operation: Any, base: list[str]) -> Any:
        operation.ToolController = controller
        if base:
            operation.Base = [(model, base)]
        return operation

    def bare(proxy: Any, name: str) -> Any:
        """FreeCAD 1.0 looks for holes on its own at creation, which fails without a window."""
        operation = document.addObject("Path::FeaturePython", name)
        operation.Proxy = proxy(operation, name, job)
        return operation

    add(Profile.Create("Profile", parentJob=job), [])
    add(Pocket.Create("Pocket", parentJob=job), pocket)
    add(bare(Drilling.ObjectDrilling, "Drilling"), holes)
    pecks = add(bare(Drilling.ObjectDrilling, "Pecks"), holes)
    pecks.PeckEnabled, pecks.PeckDepth = True, 3
    dwells = add(bare(Drilling.ObjectDrilling, "Dwells"), holes)
    dwells.DwellEnabled, dwells.DwellTime = True, 0.5
    add(bare(Helix.ObjectHelix, "Helix"), recess)
    add(Adaptive.Create("Adaptive", parentJob=job), pocket)
    document.recompute()
    return job


def block() -> Any:
    """80 x 60 x 20 mm."""
    shape = Part.makeBox(80, 60, 20).cut(Part.makeBox(30, 20, 8, Vector(10, 10, 12)))
    for x in (55, 70):
        shape = shape.cut(Part.makeCylinder(3, 20, Vector(x, 15, 0)))
    return shape.cut(Part.makeCylinder(9, 10, Vector(60, 42, 10)))


def level(face: Any) -> bool:
    """Whether a face is horizontal."""
    return abs(abs(face.normalAt(0, 0).z) - 1) < 1e-6
