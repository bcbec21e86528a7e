"""Inside FreeCAD: a job's stock of every kind as the section of a job document."""

from __future__ import annotations

from typing import Any

LOW, HIGH = [0.0, -10.0, -20.0], [40.0, 30.0, 5.0]
"""The corners of the part's box, mm."""


def stocks(stage: Any) -> dict[str, Any]:
    """By name: the section, and the height of the stock's top."""
    import FreeCAD
    from Path.Main import Stock

    from freecad.styluscam_wb import stock

    job, turned = stage.job, FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 45)

    def at(x: float, y: float, z: float, rotation: Any = None) -> Any:
        return FreeCAD.Placement(FreeCAD.Vector(x, y, z), rotation or FreeCAD.Rotation())

    def seen(made: Any) -> Any:
        job.Stock = made
        stage.document.recompute()
        section = stock.section_of(job, LOW, HIGH)
        return {"section": section, "top": stock.top_of(section, HIGH[2])}

    size, middle = FreeCAD.Vector(50.0, 60.0, 30.0), (20.0, 10.0)
    found = {
        "extended": seen(Stock.CreateFromBase(job, FreeCAD.Vector(1, 2, 3), FreeCAD.Vector(4, 5, 6))),
        "box": seen(Stock.CreateBox(job, size, at(-5.0, -15.0, -22.0))),
        "turned box": seen(Stock.CreateBox(job, FreeCAD.Vector(100, 100, 30), at(20.0, -60.0, -22.0, turned))),
        "cylinder": seen(Stock.CreateCylinder(job, 35.0, 29.0, at(*middle, -22.0))),
        "cylinder beside": seen(Stock.CreateCylinder(job, 50.0, 29.0, at(25.0, 10.0, -22.0))),
        "none": seen(None),
    }
    stage.close()
    return found
