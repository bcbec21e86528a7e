"""Inside FreeCAD: tool bit files that the package wrote, loaded by FreeCAD's own readers, and written again."""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path
from typing import Any

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])

LENGTHS = ("Diameter", "CuttingEdgeHeight", "Length", "ShankDiameter")


def described(bit: Any) -> dict[str, Any]:
    from freecad.styluscam_wb import compat, tools

    box = bit.Shape.BoundBox
    return {
        "label": bit.Label,
        "kind": compat.tool_kind(bit),
        "lengths": [getattr(bit, name).Value for name in LENGTHS],
        "document": tools.tool_document(bit),
        "valid": bit.Shape.isValid(),
        "box": [box.XLength, box.YLength, box.ZMin, box.ZMax],
        "volume": bit.Shape.Volume,
    }


def compared(bit: Any) -> dict[str, float]:
    """The solid and the engine's profile: the largest distance (mm) of the profile's points, and the volume that it bounds."""
    import numpy as np
    import Part

    import styluscam as sc
    from freecad.styluscam_wb import tools

    tool = sc.Tool.from_dict(tools.tool_document(bit))
    slopes = np.linspace(0.0, tool.max_slope, 121)
    turned = np.arange(len(slopes)) * 0.7
    radii, heights = tool.radius_at(slopes), tool.height_at(slopes)
    shell = bit.Shape.Shells[0]
    points = zip(radii * np.cos(turned), radii * np.sin(turned), heights, strict=True)
    distance = max(shell.distToShape(Part.Vertex(*map(float, point)))[0] for point in points)
    fine = np.linspace(0.0, tool.diameter / 2.0, 200001)
    under = 2.0 * np.pi * fine * (heights[-1] - tool.height_at_radius(fine))
    return {"distance": distance, "tip volume": float(np.sum(0.5 * (under[1:] + under[:-1])) * (fine[1] - fine[0]))}


def load(document: Any, path: Path) -> Any:
    """By FreeCAD's own reader, with nothing of ours imported for it: its start-up makes the stylus known."""
    import Path.Main.Job  # noqa: F401

    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        return Factory.CreateFrom(str(path))
    return ToolBit.from_file(path).attach_to_doc(document)


def saved_by_freecad(bit: Any, path: Path) -> None:
    """FreeCAD's own file of the bit: its lengths rounded to the user's decimals."""
    if hasattr(bit.Proxy, "saveToFile"):
        bit.Proxy.saveToFile(bit, str(path))
        return
    from Path.Tool.toolbit.serializers import FCTBSerializer

    path.write_bytes(FCTBSerializer.serialize(bit.Proxy))


def one(path: Path) -> dict[str, Any]:
    import FreeCAD

    from freecad.styluscam_wb import compat, tools

    document = FreeCAD.newDocument("Bits")
    bit = load(document, path)
    document.recompute()
    seen = described(bit) | compared(bit)
    saved_by_freecad(bit, path.with_suffix(".freecad.fctb"))
    tools.write_toolbit(bit, str(path.with_suffix(".ours.fctb")))
    seen["again"] = described(compat.load_toolbit(document, str(path.with_suffix(".freecad.fctb"))))
    FreeCAD.closeDocument(document.Name)
    return seen


for file in sorted(FOLDER.glob("*.fctb")):
    try:
        result = one(file)
    except BaseException:
        result = {"broke": traceback.format_exc()}
    print("\nRESULT " + json.dumps([file.stem, result]), flush=True)
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
