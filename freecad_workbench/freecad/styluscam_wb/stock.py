# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stock of a CAM job as the section `setup.stock` of a job document."""

from __future__ import annotations

from typing import Any

Document = dict[str, Any]

SAME_MM = 1e-3
"""How far a cylinder's axis may lie beside the middle of the part."""


def section_of(job: Any, low: list[float], high: list[float]) -> Document | None:
    """The section for a part with a box between two corners, mm; none where the job has no stock.

    FreeCAD's extended box becomes the part's box with the same allowances, and an upright cylinder around the middle of the part
    itself. All other stock becomes its bounding box, which holds it.
    """
    from Path.Main.Stock import StockType

    stock = job.Stock
    if stock is None:
        return None
    kind = StockType.FromStock(stock)
    if kind == StockType.FromBase:  # counted from the exact part: the box of a shape depends on how finely it was drawn
        below, above = ([float(getattr(stock, f"Ext{axis}{side}")) for axis in "XYZ"] for side in ("neg", "pos"))
        return _box(
            [at - by for at, by in zip(low, below, strict=True)], [at + by for at, by in zip(high, above, strict=True)]
        )
    if kind == StockType.CreateCylinder and _is_around(stock, low, high):
        bottom = float(stock.Placement.Base.z)
        top = bottom + float(stock.Height)
        return {
            "kind": "cylinder",
            "diameter": 2.0 * float(stock.Radius),
            "top": top - high[2],
            "bottom": low[2] - bottom,
        }
    box = stock.Shape.BoundBox
    return _box([box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax])


def top_of(section: Document | None, top: float) -> float:
    """Height of the stock's top over a part whose top is at a height, mm; the part's where there is no stock."""
    if section is None:
        return top
    return float(section["high"][2]) if section["kind"] == "box" else top + float(section["top"])


def _is_around(stock: Any, low: list[float], high: list[float]) -> bool:
    """Whether a cylinder is upright, around the middle of the part, and as high as the part at least."""
    base = stock.Placement.Base
    beside = max(abs(at - (low[i] + high[i]) / 2.0) for i, at in enumerate((base.x, base.y)))
    is_high = base.z <= low[2] and base.z + float(stock.Height) >= high[2]
    return bool(stock.Placement.Rotation.Angle < 1e-9 and beside <= SAME_MM and is_high)


def _box(low: list[float], high: list[float]) -> Document:
    return {"kind": "box", "low": low, "high": high}
