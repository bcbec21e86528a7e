"""Inside FreeCAD: its own Addon Manager reads package.xml, and installs the zip into the user's folder of addons."""

from __future__ import annotations

import contextlib
import io
import json
import os
import sys
import traceback
from pathlib import Path
from typing import Any

(ZIP,) = sys.argv[sys.argv.index("--") + 1 :]


def report(name: str, result: dict[str, Any]) -> None:
    print("\nRESULT " + json.dumps([name, result]), flush=True)


def addon() -> Any:
    from Addon import Addon

    return Addon("StylusCAM", ZIP, Addon.Status.NOT_INSTALLED, "addon")


def installed() -> None:
    import FreeCAD
    from addonmanager_installer import AddonInstaller

    one = addon()
    done = AddonInstaller(one, allow_list=[]).run()
    folder = Path(FreeCAD.getUserAppDataDir()) / "Mod" / "StylusCAM"
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    report("installed", {"done": done, "files": [n for n in names if n != "MANIFEST.txt"]})


def read() -> None:
    """What the Addon Manager makes of package.xml, and what it prints about it."""
    import FreeCAD
    from addonmanager_metadata import MetadataReader

    path = Path(FreeCAD.getUserAppDataDir()) / "Mod" / "StylusCAM" / "package.xml"
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        found = MetadataReader.from_file(str(path))
        one = addon()
        one.load_metadata_file(str(path))
    workbench = found.content["workbench"][0]
    report(
        "read",
        {
            "printed": printed.getvalue(),
            "requires": sorted(one.requires),
            "workbench": one.contains_workbench(),
            "classname": workbench.classname,
            "subdirectory": workbench.subdirectory,
            "licence": [[one.name, one.file] for one in found.license],
            "supported": bool(FreeCAD.Metadata(str(path)).supportsCurrentFreeCAD()),
            "errors": checked(one),
        },
    )


def checked(one: Any) -> list[str] | None:
    """What the Addon Manager's checks for developers find; None where it has none any more (from 1.1 on).

    Without the addresses: it would read the page that they name.
    """
    try:
        from addonmanager_devmode_metadata_checker import MetadataValidators
    except ImportError:
        return None
    checks = MetadataValidators()
    checks.validate_urls = lambda urls: []
    return [*checks.validate_top_level(one), *checks.validate_content(one)]


try:
    installed()
    read()
except BaseException:
    report("broke", {"broke": traceback.format_exc()})
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
