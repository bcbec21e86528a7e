"""Run by FreeCAD without a window, not imported by the package: hands a request to the addon, leaves a report.

    freecadcmd styluscam_document_run.py -- REQUEST.json

The report is a file, since FreeCAD prints what it likes and ends with 0 whatever happens.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import json
import os
import sys
import threading
import traceback
from pathlib import Path
from typing import Any

ADDON = "freecad.styluscam_wb"
"""Imported by its name at run time: it is FreeCAD that has it, this package does not depend on it."""


def main(request_file: Path) -> None:
    """Runs the request; the report appears whole beside it."""
    request: dict[str, Any] = json.loads(request_file.read_text(encoding="utf-8"))
    threading.Thread(target=_end_with_the_caller, daemon=True).start()
    try:
        report = _report(request)
    except BaseException as error:
        report = _failure("internal", f"a fault of StylusCAM: {error!r}", 4, traceback.format_exc())
    unfinished = request_file.with_name("report.part")
    unfinished.write_text(json.dumps(report, default=_plain), encoding="utf-8")
    unfinished.replace(request_file.with_name("report.json"))


def _report(request: dict[str, Any]) -> dict[str, Any]:
    try:
        _load_engine(Path(request["package"]))
    except Exception as error:
        python = ".".join(str(part) for part in sys.version_info[:3])
        message = f"FreeCAD's Python {python} cannot load the engine in {request['package']}: {error}"
        return _failure("engine-missing", f"{message}; it needs numpy, and a Python of 3.10 or later", 2)
    try:
        module = importlib.import_module(f"{ADDON}.headless.run")
    except ImportError as error:
        return _failure("addon-missing", _why_no_addon(error), 2)
    found = Path(str(module.__file__)).resolve()
    if request["addon"] and not found.is_relative_to(Path(request["addon"]).resolve()):
        other = found.parents[3]
        message = f"FreeCAD has loaded the addon in {other}, not the one in {request['addon']}"
        return _failure("addon-other", f"{message}: remove it from FreeCAD's Mod folder, or leave --addon out", 2)
    report: dict[str, Any] = module.run(request)
    return report


def _why_no_addon(error: ImportError) -> str:
    if importlib.util.find_spec("freecad") is not None:
        with contextlib.suppress(ImportError):
            addon = importlib.import_module(ADDON)
            return f"the addon in {addon.__path__[0]} cannot run documents ({error}): install a later version of it"
    return "FreeCAD has no addon StylusCAM: install it into FreeCAD's Mod folder, or name its folder with --addon DIR"


def _load_engine(package: Path) -> None:
    """The package that asks, and nothing else of the Python that it is installed in: numpy is FreeCAD's own."""
    origin = package / "__init__.py"
    spec = importlib.util.spec_from_file_location("styluscam", origin, submodule_search_locations=[str(package)])
    if spec is None or spec.loader is None:
        raise ImportError(f"{origin} is no module")
    module = importlib.util.module_from_spec(spec)
    sys.modules["styluscam"] = module
    spec.loader.exec_module(module)
    importlib.import_module("numpy")


def _end_with_the_caller() -> None:
    """Whoever asked holds the other end of stdin: when it is gone, nobody wants the report any more."""
    with contextlib.suppress(OSError):
        while os.read(0, 1024):
            pass
    os._exit(3)


def _failure(code: str, message: str, exit_code: int, trace: str = "") -> dict[str, Any]:
    error = {"class": "StylusError", "code": code, "where": "FreeCAD", "message": message, "hint": ""}
    return {"error": {**error, "exit_code": exit_code, **({"traceback": trace} if trace else {})}}


def _plain(value: object) -> object:
    """Records of the engine, and numbers of numpy."""
    for name in ("to_dict", "tolist"):
        if hasattr(value, name):
            return getattr(value, name)()
    raise TypeError(f"{type(value).__name__} is not JSON")


if __name__ in ("__main__", Path(__file__).stem):
    try:
        main(Path(sys.argv[-1]))
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)
