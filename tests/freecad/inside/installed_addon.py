"""Inside FreeCAD with the addon in the user's folder: what works with and without the engine there."""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path
from typing import Any


def report(name: str, result: dict[str, Any]) -> None:
    print("\nRESULT " + json.dumps([name, result]), flush=True)


def outcome(action: Any) -> str:
    try:
        return f"made {action()}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def main() -> None:
    import FreeCAD

    import freecad.styluscam_wb as addon
    from freecad.styluscam_wb import engine, tools

    user = FreeCAD.getUserAppDataDir()
    document = FreeCAD.newDocument("Any")
    profile = {"kind": "clothoid", "diameter": 10.0}
    made = outcome(lambda: tools.create_stylus(document, "Stylus", profile).Profile)
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    report(
        "installed",
        {
            "folder": Path(addon.__file__).is_relative_to(Path(user) / "Mod" / "StylusCAM"),
            "engine": Path(engine.styluscam().__file__).is_relative_to(engine.package_dir())
            if engine.is_there()
            else None,
            "packages": engine.package_dir(),
            "made": made,
            "volume": box.Shape.Volume,
        },
    )


try:
    main()
except BaseException:
    report("installed", {"broke": traceback.format_exc()})
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
