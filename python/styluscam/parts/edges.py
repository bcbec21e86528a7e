"""The edges around the CAD kernel's faces, for the engine's mesher."""

from __future__ import annotations

import numpy as np

from styluscam.flank.rails import Rail
from styluscam.parts.exact import area_and_centre
from styluscam.parts.kernel import Kernel, map_shapes, thrown_by_kernel, xyz
from styluscam.parts.surfaces import Elementary, ExactSurface
from styluscam.parts.trimmed import GUIDES, Edge, EdgeUse, Face, Model


def model_of(shape: Kernel, faces: list[Kernel], surfaces: list[ExactSurface]) -> Model | None:
    """Return a shape's faces within their edges; None where a surface is not elementary, or an edge lacks its curves."""
    if not all(isinstance(surface, Elementary) for surface in surfaces):
        return None
    edges = map_shapes(shape, "EDGE")
    try:
        return Model(
            [_edge(edges.FindKey(i)) for i in range(1, edges.Size() + 1)], [_face(face, edges) for face in faces]
        )
    except ValueError:
        return None
    except thrown_by_kernel():
        return None


def edge_curves(shape: Kernel) -> tuple[Rail | None, ...]:
    """Return the edges' curves from end to end in TopExp order, the first is Edge1 in FreeCAD; None for one without a curve."""
    edges = map_shapes(shape, "EDGE")
    return tuple(_curve(edges.FindKey(i)) for i in range(1, edges.Size() + 1))


def _curve(shape: Kernel) -> Rail | None:
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.Geom import Geom_TrimmedCurve
    from OCP.GeomConvert import GeomConvert
    from OCP.TopoDS import TopoDS

    edge = TopoDS.Edge_s(shape)
    if BRep_Tool.Degenerated_s(edge):
        return None
    try:
        adaptor = BRepAdaptor_Curve(edge)
        first, last = adaptor.FirstParameter(), adaptor.LastParameter()
        whole = BRep_Tool.Curve_s(edge, first, last)
        if whole is None:
            return None
        curve = GeomConvert.CurveToBSplineCurve_s(Geom_TrimmedCurve(whole, first, last))
        if curve.IsPeriodic():
            curve.SetNotPeriodic()
    except thrown_by_kernel():
        return None
    poles = range(1, curve.NbPoles() + 1)
    knots = [curve.Knot(i) for i in range(1, curve.NbKnots() + 1) for _ in range(curve.Multiplicity(i))]
    rational = curve.IsRational()
    return Rail(
        curve.Degree(),
        np.array(knots),
        np.array([xyz(curve.Pole(i)) for i in poles]),
        np.array([curve.Weight(i) if rational else 1.0 for i in poles]),
    )


def _edge(shape: Kernel) -> Edge:
    """Return an edge's curve; raises ValueError where it has no ends."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.GeomAbs import GeomAbs_CurveType as Type
    from OCP.TopAbs import TopAbs_Orientation
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS

    edge = TopoDS.Edge_s(shape.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    vertices = (TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge))
    if any(vertex.IsNull() for vertex in vertices):
        raise ValueError("an edge without ends")
    ends = (xyz(BRep_Tool.Pnt_s(vertices[0])), xyz(BRep_Tool.Pnt_s(vertices[1])))
    if BRep_Tool.Degenerated_s(edge):
        return Edge(lambda _: ends[0], (0.0, 1.0), ends, 0.0)
    curve = BRepAdaptor_Curve(edge)
    kind = curve.GetType()
    radius = None
    if kind == Type.GeomAbs_Line:
        radius = 0.0
    elif kind == Type.GeomAbs_Circle:
        radius = float(curve.Circle().Radius())
    return Edge(lambda t: xyz(curve.Value(t)), (curve.FirstParameter(), curve.LastParameter()), ends, radius)


def _face(face: Kernel, edges: Kernel) -> Face:
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    surface = BRepAdaptor_Surface(face)
    middle = (
        (surface.FirstUParameter() + surface.LastUParameter()) / 2.0,
        (surface.FirstVParameter() + surface.LastVParameter()) / 2.0,
    )
    uses = []
    found = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while found.More():
        edge = TopoDS.Edge_s(found.Current())
        use = EdgeUse(edges.FindIndex(edge) - 1, _guides(edge, face))
        # a slit in the face is no border: the face is on both of its sides
        is_slit = edge.Orientation() in (TopAbs_Orientation.TopAbs_INTERNAL, TopAbs_Orientation.TopAbs_EXTERNAL)
        uses += [use, use] if is_slit else [use]
        found.Next()
    return Face(lambda u, v: xyz(surface.Value(u, v)), middle, uses, area_and_centre(face)[0])


def _guides(edge: Kernel, face: Kernel) -> list[tuple[float, float]]:
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d

    curve = BRepAdaptor_Curve2d(edge, face)
    at = [curve.Value(t) for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), GUIDES).tolist()]
    return [(point.X(), point.Y()) for point in at]
