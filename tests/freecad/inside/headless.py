"""Inside FreeCAD: makes documents, spoils copies of them, and has the addon run requests on them; a line of JSON for each.

    freecadcmd headless.py -- FOLDER

FOLDER holds requests.json: pairs of a name and a request, whose files are in FOLDER.
"""

from __future__ import annotations

import json
import os
import re
import sys
import traceback
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])

CONE = "cöne 1.FCStd"


class Stage:
    """A new document: a cone's frustum, milled by levels."""

    def __init__(self, name: str, with_job: bool = True) -> None:
        import FreeCAD
        import Path.Main.Job as PathJob

        self.document = FreeCAD.newDocument("Stage")
        self.name = name
        model = self.document.addObject("Part::Cone", "Model")
        model.Radius1, model.Radius2, model.Height = 14, 8, 6
        self.document.recompute()
        if not with_job:
            return
        self.job = PathJob.Create("Job", [model])
        self.job.PostProcessor = "styluscam_linuxcnc"
        self.controller(self.job.Tools.Group[0])

    def controller(self, controller: Any, number: int = 1) -> Any:
        from freecad.styluscam_wb import tools

        profile = {"kind": "ball", "diameter": 4.0 + 2.0 * number}
        controller.Tool = tools.create_stylus(self.document, f"Ball {number}", profile)
        controller.Label, controller.ToolNumber = f"TC: Ball {number}", number
        controller.HorizFeed, controller.VertFeed = "1200 mm/min", "300 mm/min"
        return controller

    def levels(self, label: str = "Cone") -> Any:
        from freecad.styluscam_wb import ops

        operation = ops.Create("Levels", parentJob=self.job)
        operation.Label = label
        operation.ToolController = self.job.Tools.Group[0]
        operation.WholeModel = True
        operation.Process, operation.Strategy = "milling", "z-level"
        operation.Step, operation.ModelTolerance, operation.Tolerance = 3.0, 0.01, 0.05
        return operation

    def lines(self) -> Any:
        """An operation of FreeCAD's own."""
        from Path.Op import Custom

        own = Custom.Create("Own", parentJob=self.job)
        own.Label = "Own lines"
        own.ToolController = self.job.Tools.Group[0]
        own.Gcode = ["G0 X0 Y0 Z20", "G1 Z15 F10", "G0 Z20"]
        return own

    def helix(self) -> Any:
        """FreeCAD's own, without a hole to cut. FreeCAD 1.0 would look for holes at creation, which fails without a window."""
        from Path.Op import Helix

        helix = self.document.addObject("Path::FeaturePython", "Helix")
        helix.Proxy = Helix.ObjectHelix(helix, "Helix", self.job)
        helix.ToolController = self.job.Tools.Group[0]
        return helix

    def second_controller(self) -> Any:
        import Path.Tool.Controller as PathController

        self.job.Proxy.addToolController(PathController.Create("TC 2"))
        return self.controller(self.job.Tools.Group[1], 2)

    def save(self) -> None:
        import FreeCAD

        self.document.recompute()
        self.document.saveAs(str(FOLDER / self.name))
        FreeCAD.closeDocument(self.document.Name)


def make() -> None:
    stage = Stage(CONE)
    stage.levels()
    stage.job.Label = "Jöb"
    stage.save()

    stage = Stage("mixed.FCStd")
    stage.levels()
    stage.lines()
    stage.job.PostProcessorOutputFile = "%D/out of %d/%j-%S.tap"
    stage.save()

    stage = Stage("native.FCStd")
    stage.lines()
    stage.job.PostProcessor, stage.job.PostProcessorArgs = "linuxcnc", "--no-show-editor"
    stage.save()

    stage = Stage("two tools.FCStd")
    stage.second_controller()
    stage.levels("First")
    stage.levels("Second").ToolController = stage.job.Tools.Group[1]
    stage.job.OrderOutputBy, stage.job.SplitOutput = "Tool", True
    stage.job.PostProcessorOutputFile = "%D/%d.nc"
    stage.save()

    stage = Stage("nothing to cut.FCStd")
    stage.helix()
    stage.save()

    Stage("empty.FCStd").save()

    Stage("no job.FCStd", with_job=False).save()


def edited(name: str, edit: Callable[[str], str], *more: tuple[str, bytes]) -> None:
    """A copy of the cone's document with another Document.xml, and more files in it."""
    with zipfile.ZipFile(FOLDER / CONE) as old, zipfile.ZipFile(FOLDER / name, "w") as new:
        for each in old.namelist():
            content = old.read(each)
            if each == "Document.xml":
                text = edit(content.decode())
                assert text != content.decode() or more, name
                content = text.encode()
            new.writestr(each, content)
        for each, content in more:
            new.writestr(each, content)


def spoil() -> None:
    edited("later kind.FCStd", lambda text: text.replace('<Enum value="z-level"/>', '<Enum value="ultra"/>'))
    edited("later addon.FCStd", lambda text: text.replace('"freecad.styluscam_wb.ops"', '"freecad.styluscam_wb.later"'))
    edited("later FreeCAD.FCStd", lambda text: re.sub('ProgramVersion="[^"]*"', 'ProgramVersion="9.2R1 (Git)"', text))
    edited("other post.FCStd", lambda text: text.replace('"styluscam_linuxcnc"', '"styluscam_shop"'))
    views = b'<Document><ViewProvider name="Levels"><Property file="Levels.ShapeAppearance"/></ViewProvider></Document>'
    edited(
        "viewed.FCStd",
        str,
        ("GuiDocument.xml", views),
        ("Levels.ShapeAppearance", b"colours"),
        ("thumbnails/Thumbnail.png", b"picture"),
    )


def add_property() -> None:
    """A property that a later engine would have made."""
    import FreeCAD

    document = FreeCAD.openDocument(str(FOLDER / CONE))
    operation = document.getObject("Levels")
    operation.addProperty("App::PropertyLength", "StepOfLater", "Stylus", "")
    document.saveAs(str(FOLDER / "later property.FCStd"))
    FreeCAD.closeDocument(document.Name)


def run(request: dict[str, Any]) -> dict[str, Any]:
    import FreeCAD

    from freecad.styluscam_wb.headless.run import run as run_request

    report = run_request(request)
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    return report


def main() -> None:
    make()
    spoil()
    add_property()
    for name, request in json.loads((FOLDER / "requests.json").read_text(encoding="utf-8")):
        try:
            result = run(request)
        except BaseException:
            result = {"broke": traceback.format_exc()}
        print("\nRESULT " + json.dumps([name, result], default=lambda value: value.to_dict()), flush=True)


try:
    main()
except BaseException:
    traceback.print_exc()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
