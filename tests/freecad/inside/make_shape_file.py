"""Inside FreeCAD 1.1: makes the addon's `resources/stylus.fcstd`, which CAM 1.1 looks for among its shapes of tools.

It holds the names, types and first values of a stylus' properties, as CAM's own shape files do: a body and a bag of
properties; 1.0 has no use for it. Run it where `SHAPE_PROPERTIES` changed:

    freecadcmd -P python -M freecad_workbench tests/freecad/inside/make_shape_file.py -- stylus.fcstd
"""

from __future__ import annotations

import os
import sys
import traceback


def make(path: str) -> None:
    import FreeCAD
    import Path.Base.PropertyBag as PathPropertyBag

    from freecad.styluscam_wb import stylus

    document = FreeCAD.newDocument("stylus")
    body = document.addObject("PartDesign::Body", "Body")
    body.Label = "Stylus"
    bag = PathPropertyBag.Create("Attributes")
    values = stylus.properties_of({"profile": {"kind": "ball", "diameter": 10.0}})
    for name, (kind, text) in stylus.SHAPE_PROPERTIES.items():
        bag.Proxy.addCustomProperty(kind, name, "Shape", text)
        setattr(bag, name, values[name])
    document.recompute()
    document.saveAs(path)


try:
    make(sys.argv[sys.argv.index("--") + 1])
except BaseException:
    traceback.print_exc()
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
