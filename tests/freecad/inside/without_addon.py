"""Inside FreeCAD: a document with a stylus, made with the addon, opened and saved without it, and opened with it again.

Arguments: the step (`made`, `without`, `again`) and a folder.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path
from typing import Any

STEP, FOLDER = sys.argv[sys.argv.index("--") + 1 :][:2]
FIRST, SECOND = (str(Path(FOLDER) / name) for name in ("first.FCStd", "second.FCStd"))


def described(bit: Any) -> dict[str, Any]:
    return {
        "class": type(bit.Proxy).__name__,
        "profile": bit.Profile,
        "lengths": [getattr(bit, name).Value for name in ("Diameter", "CuttingEdgeHeight", "Length", "ShankDiameter")],
        "volume": bit.Shape.Volume,
    }


def bit_of(document: Any) -> Any:
    return next(obj for obj in document.Objects if obj.Label == "Odd")


def made() -> dict[str, Any]:
    import FreeCAD
    import Path.Main.Job as PathJob

    from freecad.styluscam_wb import tools

    document = FreeCAD.newDocument("Tools")
    model = document.addObject("Part::Box", "Model")
    document.recompute()
    job = PathJob.Create("Job", [model])
    profile = {"kind": "ball", "diameter": 7.12345678912}
    job.Tools.Group[0].Tool = tools.create_stylus(document, "Odd", profile, length=100.0 / 3.0)
    document.recompute()
    document.saveAs(FIRST)
    return described(bit_of(document))


def without() -> dict[str, Any]:
    import FreeCAD

    document = FreeCAD.openDocument(FIRST)
    document.recompute()
    document.saveAs(SECOND)
    return described(bit_of(document))


def again() -> dict[str, Any]:
    import FreeCAD

    document = FreeCAD.openDocument(SECOND)
    bit = bit_of(document)
    found = described(bit)
    bit.Profile = '{"kind": "ball", "diameter": 5.0}'
    document.recompute()
    return {**found, "edited": described(bit)}


try:
    result = {"made": made, "without": without, "again": again}[STEP]()
except BaseException:
    result = {"broke": traceback.format_exc()}
print("\nRESULT " + json.dumps(result), flush=True)
sys.stderr.flush()
os._exit(0)
