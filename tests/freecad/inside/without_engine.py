"""Inside FreeCAD, where there is no engine: a saved document opens, keeps its paths, and reports what is missing."""

from __future__ import annotations

import json
import os
import sys
import traceback
from typing import Any

(DOCUMENT,) = sys.argv[sys.argv.index("--") + 1 :]


def report(name: str, result: dict[str, Any]) -> None:
    print("\nRESULT " + json.dumps([name, result]), flush=True)


def main() -> None:
    import FreeCAD

    early = "Path" in sys.modules
    import Path.Main.Job
    import Path.Preferences

    report("started", {"early": early, "posts": Path.Preferences.allAvailablePostProcessors()})
    document = FreeCAD.openDocument(DOCUMENT)
    operation = next(o for o in document.Objects if o.Label.startswith("cup"))
    report(
        "opened",
        {
            "commands": [[c.Name, c.Parameters] for c in operation.Path.Commands],
            "state": list(operation.State),
            "loaded": "styluscam" in sys.modules,
            "volume": operation.ToolController.Tool.Shape.Volume,
        },
    )
    print("\nOPENED", flush=True)
    operation.touch()
    document.recompute()
    commands = operation.Path.Commands
    report("computed", {"state": list(operation.State), "names": [c.Name for c in commands]})
    from freecad.styluscam_wb import ops

    count = len(document.Objects)
    try:
        ops.Create("Another", parentJob=next(o for o in document.Objects if o.Name == "Job"))
        message = "nothing"
    except Exception as error:
        message = str(error)
    report("created", {"message": message, "objects": [count, len(document.Objects)]})


try:
    main()
except BaseException:
    report("broke", {"broke": traceback.format_exc()})
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
