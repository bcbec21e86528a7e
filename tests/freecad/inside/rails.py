"""Inside FreeCAD: curves of edges, and of ruled faces."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def rails_as_in_the_file(step: Path) -> dict[str, Any]:
    """The curves of a blade's edges and the rails of its ruled faces: degree, knots, poles, weights of each."""
    import Part

    from freecad.styluscam_wb import part
    from styluscam.parts.ruled import ruled_faces

    def columns(rail: Any) -> Any:
        degree, knots, poles, weights = rail.columns
        return [degree, knots, poles.tolist(), weights.tolist()]

    shape = Part.Shape()
    shape.read(str(step))
    arrays = part.arrays_of(shape, 0.01, "blade")
    return {
        "count": [len(shape.Edges), len(arrays.edges)],
        "ends": [[list(end.Point) for end in (edge.firstVertex(), edge.lastVertex())] for edge in shape.Edges],
        "edges": [None if rail is None else columns(rail) for rail in arrays.edges],
        "ruled": {str(face): [columns(rail) for rail in rails] for face, rails in ruled_faces(arrays).items()},
    }
