"""The exact surfaces under the CAD kernel's faces, and the faces' areas."""

from __future__ import annotations

import io

import numpy as np

from styluscam.parts.kernel import Kernel, thrown_by_kernel, xyz
from styluscam.parts.surfaces import Cone, Cylinder, ExactSurface, Floats, Nurbs, Parametric, Plane, Sphere, Torus


def surface_of(face: Kernel) -> ExactSurface:
    """Return the exact surface under a face, oriented out of the material."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopAbs import TopAbs_Orientation

    adaptor = BRepAdaptor_Surface(face)
    outward = -1.0 if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else 1.0
    closed_form = _closed_form(adaptor)
    if closed_form is None:
        return _parametric(face, outward)
    kind, arguments = closed_form
    point, normal = _middle(adaptor)
    if kind is Cone and float((np.array(point) - arguments[0]) @ arguments[1]) * np.tan(arguments[3]) < -arguments[2]:
        arguments = (*arguments[:2], -arguments[2], -arguments[3])  # the face lies on the other nappe
    plain: ExactSurface = kind(*arguments)
    agrees = float(plain.normal(np.array([point]))[0] @ np.array(normal))
    oriented: ExactSurface = kind(*arguments, sign=outward if agrees > 0.0 else -outward)
    return oriented


def _closed_form(adaptor: Kernel) -> tuple[Kernel, tuple[Kernel, ...]] | None:
    """Return the class and arguments of a surface with a closed form; None for a freeform one."""
    from OCP.GeomAbs import GeomAbs_SurfaceType as Type

    kind = adaptor.GetType()
    if kind == Type.GeomAbs_Plane:
        plane = adaptor.Plane()
        return Plane, (xyz(plane.Location()), xyz(plane.Axis().Direction()))
    if kind == Type.GeomAbs_Cylinder:
        cylinder = adaptor.Cylinder()
        return Cylinder, (xyz(cylinder.Location()), xyz(cylinder.Axis().Direction()), cylinder.Radius())
    if kind == Type.GeomAbs_Cone:
        cone = adaptor.Cone()
        placed = (xyz(cone.Location()), xyz(cone.Axis().Direction()))
        return Cone, (*placed, cone.RefRadius(), cone.SemiAngle())
    if kind == Type.GeomAbs_Sphere:
        sphere = adaptor.Sphere()
        return Sphere, (xyz(sphere.Location()), sphere.Radius())
    if kind == Type.GeomAbs_Torus:
        torus = adaptor.Torus()
        placed = (xyz(torus.Location()), xyz(torus.Axis().Direction()))
        return Torus, (*placed, torus.MajorRadius(), torus.MinorRadius())
    return None


def _middle(adaptor: Kernel) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return a point in the middle of the face's parameters, and the surface's own normal there (not the face's)."""
    from OCP.gp import gp_Pnt, gp_Vec

    u = (adaptor.FirstUParameter() + adaptor.LastUParameter()) / 2.0
    v = (adaptor.FirstVParameter() + adaptor.LastVParameter()) / 2.0
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    adaptor.D1(u, v, point, along_u, along_v)
    return xyz(point), xyz(along_u.Crossed(along_v))


def _parametric(face: Kernel, outward: float) -> Parametric:
    """Return a freeform face's surface; its seeds come with the mesh (see _with_seeds)."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepTools import BRepTools
    from OCP.Geom import Geom_BSplineSurface, Geom_RectangularTrimmedSurface
    from OCP.GeomConvert import GeomConvert

    surface = BRep_Tool.Surface_s(face)
    while isinstance(surface, Geom_RectangularTrimmedSurface):
        surface = surface.BasisSurface()
    none = np.zeros((0, 3)), np.zeros((0, 2))
    if not isinstance(surface, Geom_BSplineSurface):
        if _is_offset(surface):
            return Parametric(*_by_kernel(face), *none, outward)
        u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
        try:
            trimmed = Geom_RectangularTrimmedSurface(surface, u0, u1, v0, v1)
            surface = GeomConvert.SurfaceToBSplineSurface_s(trimmed)
        except thrown_by_kernel():
            return Parametric(*_by_kernel(face), *none, outward)
    nurbs = nurbs_of(surface)
    return Parametric(nurbs, nurbs.bounds, *none, outward)


def _is_offset(surface: Kernel) -> bool:
    """Return whether an offset is involved: the kernel converts those approximately only."""
    from OCP.Geom import Geom_OffsetSurface, Geom_SweptSurface, Geom_TrimmedCurve

    if isinstance(surface, Geom_SweptSurface):
        curve = surface.BasisCurve()
        while isinstance(curve, Geom_TrimmedCurve):
            curve = curve.BasisCurve()
        return "Offset" in type(curve).__name__
    return isinstance(surface, Geom_OffsetSurface)


def nurbs_of(surface: Kernel) -> Nurbs:
    """Return a kernel's B-spline surface as arrays."""
    surface = surface.Copy()
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    rows, columns = range(1, surface.NbUPoles() + 1), range(1, surface.NbVPoles() + 1)
    rational = surface.IsURational() or surface.IsVRational()
    knots_u = [surface.UKnot(i) for i in range(1, surface.NbUKnots() + 1) for _ in range(surface.UMultiplicity(i))]
    knots_v = [surface.VKnot(i) for i in range(1, surface.NbVKnots() + 1) for _ in range(surface.VMultiplicity(i))]
    return Nurbs(
        surface.UDegree(),
        surface.VDegree(),
        np.array(knots_u),
        np.array(knots_v),
        np.array([[xyz(surface.Pole(i, j)) for j in columns] for i in rows]),
        # asked for the weights of one without, the kernel reads beside its array once SetUNotPeriodic has added poles
        np.array([[surface.Weight(i, j) if rational else 1.0 for j in columns] for i in rows]),
    )


class _KernelSurface:
    """An evaluator that asks the kernel point by point (some 3 us each)."""

    def __init__(self, face: Kernel) -> None:
        from OCP.BRep import BRep_Tool

        self._face = face
        self._surface = BRep_Tool.Surface_s(face)

    def __call__(self, uv: Floats) -> tuple[Floats, Floats, Floats]:
        from OCP.gp import gp_Pnt, gp_Vec

        out = np.empty((len(uv), 3, 3))
        point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
        for i, (u, v) in enumerate(uv.tolist()):
            self._surface.D1(u, v, point, along_u, along_v)
            out[i] = xyz(point), xyz(along_u), xyz(along_v)
        return out[:, 0], out[:, 1], out[:, 2]

    def __reduce__(self) -> tuple[Kernel, tuple[bytes]]:
        """For workers: the kernel's own binary form, exact."""
        from OCP.BinTools import BinTools

        stream = io.BytesIO()
        BinTools.Write_s(self._face, stream)
        return _kernel_surface, (stream.getvalue(),)


def _kernel_surface(face: bytes) -> _KernelSurface:
    """Return the evaluator that was written."""
    from OCP.BinTools import BinTools
    from OCP.TopoDS import TopoDS, TopoDS_Shape

    shape = TopoDS_Shape()
    BinTools.Read_s(shape, io.BytesIO(face))
    return _KernelSurface(TopoDS.Face_s(shape))


def _by_kernel(face: Kernel) -> tuple[_KernelSurface, tuple[float, float, float, float]]:
    """Return an evaluator that asks the kernel, and the face's parameter range."""
    from OCP.BRepTools import BRepTools

    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    return _KernelSurface(face), (u0, u1, v0, v1)


def area_and_centre(face: Kernel) -> tuple[float, tuple[float, float, float]]:
    """Return the exact area (mm^2) and its centre."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return abs(properties.Mass()), xyz(properties.CentreOfMass())


def careful_area(face: Kernel) -> float:
    """Return the exact area (mm^2) by a quadrature that halves its steps until 0.01 % is sure."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties, 1e-4)
    return abs(float(properties.Mass()))
