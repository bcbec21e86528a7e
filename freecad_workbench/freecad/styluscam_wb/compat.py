# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every difference between FreeCAD's versions; no other module tests for a version."""

from __future__ import annotations

import importlib
import importlib.util
import json
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import FreeCAD

from .stylus import ToolError

STYLUS = "stylus"
"""The shape of our tool bits, as CAM names it in lower case."""

LIBRARY = "StylusCAM"
"""The tool library that tools are added to."""

SHAPE_FILE = FilePath(__file__).parent / "resources" / "stylus.fcstd"
"""What CAM looks for among its shapes: names and types of a stylus' properties; saved by FreeCAD 1.1, which alone reads it."""

SHAPE_ICON = SHAPE_FILE.parent / "icons" / "tool.svg"


def make_toolbit(document: Any, label: str, parameters: dict[str, Any]) -> Any:
    """A stylus tool bit in the document; `parameters` are the properties of `stylus.SHAPE_PROPERTIES`.

    FreeCAD 1.1 has classes for shapes and bits; 1.0 has one class of bits over shape files.
    """
    if _has_tool_assets():
        from .stylus_asset import create
    else:
        from .stylus_bit_of_1_0 import create
    return create(document, label, parameters)


def toolbit_class() -> Any:
    """The class of a stylus tool bit."""
    if _has_tool_assets():
        from .stylus_asset import ToolBitStylus

        return ToolBitStylus
    from .stylus_bit_of_1_0 import StylusBit

    return StylusBit


def register_toolbits() -> None:
    """Makes FreeCAD know the stylus among its tool bits, so that its own readers of files build ours."""
    if _has_tool_assets():
        from . import stylus_asset  # noqa: F401  (its classes are found once they exist)
    else:
        from . import stylus_bit_of_1_0

        stylus_bit_of_1_0.register()


def adopt_toolbit(obj: Any) -> None:
    """Gives a stylus whose class FreeCAD does not know any more (None, or one of CAM's own) its class back."""
    found = toolbit_class()
    if isinstance(obj.Proxy, found):
        return
    if _has_tool_assets():
        proxy = found(found.SHAPE_CLASS(STYLUS), id=obj.ToolBitID or None)
    else:
        proxy = found.__new__(found)
        proxy.obj = obj
    obj.Proxy = proxy
    proxy.onDocumentRestored(obj)


def load_toolbit(document: Any, path: str) -> Any:
    """The tool bit of a file (`.fctb`) in the document: a stylus, or one of FreeCAD's own."""
    register_toolbits()
    if _has_tool_assets():
        from Path.Tool.toolbit import ToolBit

        return ToolBit.from_file(path).attach_to_doc(document)
    import Path.Tool.Bit

    FreeCAD.setActiveDocument(document.Name)
    return Path.Tool.Bit.Factory.CreateFrom(path)


def make_tool_controller(label: str, bit: Any, number: int) -> Any:
    """A tool controller, shown where there is a window; not yet in a job."""
    if FreeCAD.GuiUp:
        from Path.Tool.Gui.Controller import Create
    else:
        from Path.Tool.Controller import Create
    return Create(label, bit, number)


def tool_kind(bit: Any) -> str:
    """The shape of a tool bit in lower case: `stylus`, or FreeCAD's own: `ballend`, `endmill`."""
    for name in ("ShapeType", "ShapeName"):  # 1.1, 1.0
        kind = getattr(bit, name, "")
        if kind:
            return str(kind).lower()
    return ""


def _has_tool_assets() -> bool:
    """Whether tools are assets, as from FreeCAD 1.1 on."""
    return importlib.util.find_spec("Path.Tool.toolbit") is not None


def native_toolbit(document: Any, shape: str) -> Any:
    """One of FreeCAD's own tool bits by its shape: `ballend`."""
    file = f"{shape}.fcstd"
    if _has_tool_assets():
        from Path.Tool.toolbit import ToolBit

        return ToolBit.from_shape_id(file).attach_to_doc(document)
    from Path.Tool.Bit import Factory

    FreeCAD.setActiveDocument(document.Name)
    return Factory.Create(shape, file)


def remove_toolbit(bit: Any) -> None:
    """Deletes a tool bit that nothing uses, with the body that shows it."""
    document = bit.Document
    body = getattr(bit, "BitBody", None)
    if body is not None:
        body.removeObjectsFromDocument()
        if body.Name:
            document.removeObject(body.Name)
    document.removeObject(bit.Name)


def make_job(model: Any) -> Any:
    """A CAM job on a model, with its view where there is a window."""
    import Path.Main.Job as PathJob

    job = PathJob.Create("Job", [model])
    if FreeCAD.GuiUp:
        import Path.Main.Gui.Job as PathJobGui

        job.ViewObject.Proxy = PathJobGui.ViewProvider(job.ViewObject)
        hide(model)
        job.Model.Group[0].ViewObject.Visibility = True
    return job


def hide(obj: Any) -> None:
    """Hides an object in the window, where there is one: the job shows its own copy of the model, and no tools."""
    if FreeCAD.GuiUp:
        obj.ViewObject.Visibility = False


# --- with a window ------------------------------------------------------------------------------------------------


def load_cam_commands() -> None:
    """CAM's commands, icons and tool assets, as its own workbench loads them; harmless where it has done so."""
    import FreeCADGui
    import Path.GuiInit
    import PathGui  # noqa: F401  (its icons and panels)

    FreeCADGui.addLanguagePath(":/translations")
    FreeCADGui.addIconPath(":/icons")
    if _has_tool_assets():
        from Path.Tool.camassets import cam_assets

        cam_assets.setup()
    for module in ("PathCommands", "Path.Main.Gui.JobCmd", "Path.Main.Gui.SanityCmd", "Path.Post.Command"):
        importlib.import_module(module)
    Path.GuiInit.Startup()


def toolbit_view_class() -> Any:
    """CAM's own view provider of tool bits."""
    if _has_tool_assets():
        from Path.Tool.toolbit.ui.view import ViewProvider
    else:
        from Path.Tool.Gui.Bit import ViewProvider
    return ViewProvider


def replace_tool_editors(dialog: Any, page: Any) -> None:
    """CAM's tool library opens ours for a stylus: a dialog in FreeCAD 1.1, a page of its own dialog in 1.0."""
    if _has_tool_assets():
        _add_shape_asset()
        modules, ours = ("Path.Tool.library.ui.browser", "Path.Tool.toolbit.ui.browser"), dialog
    else:
        modules, ours = ("Path.Tool.Gui.BitEdit",), page
    for name in modules:
        module = importlib.import_module(name)
        if not hasattr(module.ToolBitEditor, "styluscam"):
            module.ToolBitEditor = _chooser(ours, module.ToolBitEditor)


def _chooser(ours: Any, theirs: Any) -> Callable[..., Any]:
    def editor(tool: Any, *args: Any, **keywords: Any) -> Any:
        is_ours = tool_kind(getattr(tool, "obj", tool)) == STYLUS
        return (ours if is_ours else theirs)(tool, *args, **keywords)

    editor.styluscam = True  # type: ignore[attr-defined]
    return editor


def add_to_library(bit: Any, write: Callable[[Any, str], None]) -> str:
    """Adds a tool bit to CAM's tool library, and reports where; `write` writes a bit's file.

    Raises:
        ToolError: CAM has no folder for tools of the user's yet.
        OSError, styluscam.StylusError: it cannot be written.
    """
    if not _has_tool_assets():
        return _add_to_library_of_1_0(bit, write)
    from Path.Tool.camassets import cam_assets
    from Path.Tool.library import Library

    _add_shape_asset()
    cam_assets.add(bit.Proxy)
    found = cam_assets.get_or_none(f"toolbitlibrary://{LIBRARY.lower()}")
    library = Library(LIBRARY, id=LIBRARY.lower()) if found is None else found
    library.add_bit(bit.Proxy)
    cam_assets.add(library)
    return f"{bit.Label} stands in the tool library {LIBRARY}"


def _add_shape_asset() -> None:
    """CAM looks for a file of every shape among the user's: ours is put there once."""
    from Path.Tool.camassets import cam_assets

    for kind, file, name in (("toolbitshape", SHAPE_FILE, STYLUS), ("toolbitshapesvg", SHAPE_ICON, f"{STYLUS}.svg")):
        if not cam_assets.exists(f"{kind}://{name}"):
            cam_assets.add_file(kind, file, asset_id=name)


def _add_to_library_of_1_0(bit: Any, write: Callable[[Any, str], None]) -> str:
    """A library is a file of names; its tools are files in a folder beside its own."""
    import Path.Preferences

    from styluscam.files import write_whole

    folder = FilePath(Path.Preferences.lastPathToolLibrary())
    if folder == FilePath(Path.Preferences.pathDefaultToolsPath("Library")) or not folder.is_dir():
        raise ToolError("CAM has no folder for your tools yet; open CAM's tool library once, it asks for one")
    bits = folder.parent / "Bit"
    bits.mkdir(exist_ok=True)
    file = bits / f"{bit.Label}.fctb"
    write(bit, str(file))
    library = folder / f"{LIBRARY}.fctl"
    content = json.loads(library.read_text(encoding="utf-8")) if library.is_file() else {"version": 1, "tools": []}
    if file.name not in [tool["path"] for tool in content["tools"]]:
        number = max((int(tool["nr"]) for tool in content["tools"]), default=0) + 1
        content["tools"].append({"nr": number, "path": file.name})
        write_whole(library, json.dumps(content, indent=2, sort_keys=True))  # half a library would be a lost one
    return f"{bit.Label} stands in the tool library {library}"


# --- posts --------------------------------------------------------------------------------------------------------


def text_of_section(text: str) -> str:
    """What FreeCAD writes of a post's section: from 1.1 on two empty lines at its start ask for it as it stands."""
    return text[2:] if text.startswith("\n\n") and _has_tool_assets() else text
