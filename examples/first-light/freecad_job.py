"""The first-light job inside FreeCAD, without a window: freecadcmd freecad_job.py PART.step OUT.ngc.

Makes a CAM job with a stylus tool bit and an operation from the numbers of the job.toml beside it, computes, posts
through FreeCAD's own post mechanism, and writes the G-code. Ends with 0, or with 1 and one line that says why.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path
from typing import Any

import tomllib

JOB = Path(__file__).with_name("job.toml")

OWN = {"stepover": "Stepover", "angle_deg": "Angle", "direction": "Direction", "tolerance": "Tolerance"}
"""Properties by the job's keys; each kind of operation has its own."""


def main(part: Path, out: Path) -> str:
    """Runs the job; returns the summary."""
    import FreeCAD

    settings = tomllib.loads(JOB.read_text(encoding="utf-8"))
    document = FreeCAD.newDocument("FirstLight")
    job = make_job(document, read_shape(part), settings)
    operation = make_operation(job, settings)
    document.recompute()
    if "Invalid" in operation.State:
        raise RuntimeError(operation.Path.Commands[0].Name.strip("()"))
    text = post(job)
    write_whole(out, text)
    return "\n".join([f"{out}: {len(text.splitlines())} lines, cycle time {operation.CycleTime}", *operation.Notes])


def read_shape(part: Path) -> Any:
    """The solid in a STEP file."""
    import Part

    shape = Part.Shape()
    shape.read(str(part))
    return shape


def make_job(document: Any, shape: Any, settings: dict[str, Any]) -> Any:
    """A CAM job on the part's solid, with one tool controller that holds the stylus."""
    import Path.Main.Job as PathJob

    from freecad.styluscam_wb import tools

    model = document.addObject("Part::Feature", "Model")
    model.Shape = shape
    document.recompute()
    job = PathJob.Create("Job", [model])
    job.PostProcessor = f"styluscam_{settings['machine']['name']}"
    job.Fixtures = [settings["setup"]["wcs"]]
    stylus = settings["tools"]["stylus"]
    controller = job.Tools.Group[0]
    old = controller.Tool
    controller.Tool = tools.create_stylus(document, "Stylus", stylus["profile"])
    controller.Label = "TC: Stylus"
    controller.ToolNumber = stylus["number"]
    if old.BitBody:
        old.BitBody.removeObjectsFromDocument()
        document.removeObject(old.BitBody.Name)
    document.removeObject(old.Name)
    feeds = settings["operations"][0]["feeds"]
    controller.HorizFeed = f"{feeds['cut']} mm/min"
    controller.VertFeed = f"{feeds['plunge']} mm/min"
    controller.HorizRapid = controller.VertRapid = "3000 mm/min"
    return job


def make_operation(job: Any, settings: dict[str, Any]) -> Any:
    """The operation on the same faces with the same numbers."""
    from freecad.styluscam_wb import ops

    section, setup = settings["operations"][0], settings["setup"]
    operation = ops.Create("Cup", parentJob=job)
    operation.Label = section["id"]
    operation.Process = settings["process"]["kind"]
    operation.SheetThickness = setup["sheet"]["thickness"]
    operation.SheetLaw = setup["sheet"]["law"]
    operation.ModelFace = settings["part"]["model_face"]
    operation.ModelTolerance = settings["part"]["tolerance"]
    operation.Base = [(job.Model.Group[0], tuple(settings["part"]["faces"]))]
    operation.Strategy = section["kind"]
    if "step" in section:
        operation.Step = section["step"]["height"]
    for key, name in OWN.items():
        if key in section:
            setattr(operation, name, section[key])
    operation.setExpression("ClearanceHeight", f"OpStartDepth + {setup['clearance']} mm")
    operation.setExpression("SafeHeight", f"OpStartDepth + {setup['retract']} mm")
    return operation


def post(job: Any) -> str:
    """The job's text, as FreeCAD's own command gets it."""
    from Path.Post.Processor import PostProcessorFactory

    processor = PostProcessorFactory.get_post_processor(job, job.PostProcessor)
    if processor is None:
        raise RuntimeError(f"FreeCAD finds no post {job.PostProcessor}: is the addon in Mod, or named with -M?")
    ((_, text),) = processor.export()
    return text


def write_whole(path: Path, text: str) -> None:
    """A reader sees the whole file or none."""
    with tempfile.NamedTemporaryFile("w", dir=path.parent, suffix=".part", delete=False, encoding="utf-8") as file:
        file.write(text)
    Path(file.name).chmod(0o644)
    Path(file.name).replace(path)


def arguments() -> tuple[Path, Path]:
    """The part and the output: what follows this script in FreeCAD's command line."""
    at = max(i for i, word in enumerate(sys.argv) if Path(word).name == Path(__file__).name)
    words = [word for word in sys.argv[at + 1 :] if word != "--"]
    if len(words) != 2:
        raise RuntimeError("give a STEP file and the G-code file to write")
    part, out = (Path(word).resolve() for word in words)
    if not part.is_file():
        raise RuntimeError(f"{part}: no such file")
    if not out.parent.is_dir() or not os.access(out.parent, os.W_OK):
        raise RuntimeError(f"{out.parent}: not a folder that can be written to")
    return part, out


def run() -> int:
    """The exit code; FreeCAD itself would end with 0 whatever happens."""
    try:
        print(main(*arguments()))
    except BaseException as error:
        if os.environ.get("STYLUSCAM_DEBUG"):
            raise
        print(f"freecad_job: {error or type(error).__name__}", file=sys.stderr)
        return 1
    return 0


if __name__ in ("__main__", "freecad_job"):
    code = 1
    try:
        code = run()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
