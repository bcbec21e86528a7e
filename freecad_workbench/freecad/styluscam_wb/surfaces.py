# SPDX-License-Identifier: LGPL-2.1-or-later
"""The exact surfaces under FreeCAD's faces, as the engine's readers describe them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from styluscam.parts.surfaces import ExactSurface, Floats, Parametric
    from styluscam.parts.tessellation import FaceMesh

SAME_POINT = 1e-5
"""Nodes and seeds nearer to each other than this (mm) are one point."""


def surface_of(face: Any) -> ExactSurface:
    """The surface of a Part.Face, oriented out of the material. A freeform one has no seeds yet: see `with_uv`."""
    from styluscam.parts.surfaces import Cone

    found = _closed_form(face.Surface)
    if found is None:
        return _parametric(face)
    kind, arguments = found
    point, outward = _middle(face)
    if kind is Cone and float((point - arguments[0]) @ arguments[1]) * np.tan(arguments[3]) < -arguments[2]:
        arguments = (*arguments[:2], -arguments[2], -arguments[3])  # the face lies on the other nappe
    agrees = float(kind(*arguments).normal(point[None])[0] @ outward)
    oriented: ExactSurface = kind(*arguments, sign=1.0 if agrees > 0.0 else -1.0)
    return oriented


def _closed_form(surface: Any) -> tuple[Any, tuple[Any, ...]] | None:
    """The engine's class and its arguments; None for a freeform surface."""
    import Part

    from styluscam.parts.surfaces import Cone, Cylinder, Plane, Sphere, Torus

    if isinstance(surface, Part.Plane):
        return Plane, (_array(surface.Position), _array(surface.Axis))
    if isinstance(surface, Part.Cylinder):
        return Cylinder, (_array(surface.Center), _array(surface.Axis), surface.Radius)
    if isinstance(surface, Part.Cone):
        return Cone, (_array(surface.Center), _array(surface.Axis), surface.Radius, surface.SemiAngle)
    if isinstance(surface, Part.Sphere):
        return Sphere, (_array(surface.Center), surface.Radius)
    if isinstance(surface, Part.Toroid):
        return Torus, (_array(surface.Center), _array(surface.Axis), surface.MajorRadius, surface.MinorRadius)
    return None


def _array(vector: Any) -> Floats:
    return np.array((vector.x, vector.y, vector.z))


def _middle(face: Any) -> tuple[Floats, Floats]:
    """A point in the middle of the face's parameters, and the normal out of the material there."""
    u0, u1, v0, v1 = face.ParameterRange
    u, v = (u0 + u1) / 2.0, (v0 + v1) / 2.0
    return _array(face.valueAt(u, v)), _array(face.normalAt(u, v))


# --- freeform ----------------------------------------------------------------------------------------------------


def _parametric(face: Any) -> Parametric:
    from styluscam.parts.surfaces import Parametric

    evaluate, bounds = _evaluator(face)
    _, outward = _middle(face)
    u0, u1, v0, v1 = face.ParameterRange
    _, along_u, along_v = evaluate(np.array([[(u0 + u1) / 2.0, (v0 + v1) / 2.0]]))
    sign = 1.0 if float(np.cross(along_u[0], along_v[0]) @ outward) > 0.0 else -1.0
    return Parametric(evaluate, bounds, np.zeros((0, 3)), np.zeros((0, 2)), sign)


def _evaluator(face: Any) -> tuple[Any, tuple[float, float, float, float]]:
    """What evaluates the face's surface, and the parameters' range."""
    import Part

    surface, needed = face.Surface, face.ParameterRange
    if isinstance(surface, Part.BSplineSurface):
        nurbs = _nurbs(surface)
        u0, u1, v0, v1 = nurbs.bounds
        slack = 1e-9 * (u1 - u0 + v1 - v0)
        if needed[0] >= u0 - slack and needed[1] <= u1 + slack and needed[2] >= v0 - slack and needed[3] <= v1 + slack:
            return nurbs, nurbs.bounds
    return _swept(surface) or _by_kernel(surface), needed


def _nurbs(surface: Any) -> Any:
    """A Part.BSplineSurface as arrays."""
    from styluscam.parts.surfaces import Nurbs

    surface = surface.copy()
    if surface.isUPeriodic():
        surface.setUNotPeriodic()
    if surface.isVPeriodic():
        surface.setVNotPeriodic()
    poles = [[(p.x, p.y, p.z) for p in row] for row in surface.getPoles()]
    return Nurbs(
        surface.UDegree,
        surface.VDegree,
        np.array(surface.UKnotSequence),
        np.array(surface.VKnotSequence),
        np.array(poles),
        np.array(surface.getWeights()),
    )


def _swept(surface: Any) -> Any:
    """An evaluator of a B-spline that is revolved or extruded, in the kernel's parameters; None of any other surface.

    The kernel is asked point by point, which takes a hundred times as long.
    """
    import Part

    if not isinstance(surface, (Part.SurfaceOfRevolution, Part.SurfaceOfExtrusion)):
        return None
    curve = surface.BasisCurve
    if not isinstance(curve, Part.BSplineCurve):
        return None
    along = _curve(curve)
    direction = _array(surface.Direction)
    if isinstance(surface, Part.SurfaceOfExtrusion):
        return lambda uv: _extruded(*along(uv[:, 0]), direction, uv[:, 1])
    location = _array(surface.Location)
    return lambda uv: _revolved(*along(uv[:, 1]), location, direction, uv[:, 0])


def _curve(curve: Any) -> Any:
    """Points and derivatives, (N,3) each, of a Part.BSplineCurve at parameters (N,): a surface of one degree across."""
    from styluscam.parts.surfaces import Nurbs

    curve = curve.copy()
    if curve.isPeriodic():
        curve.setNotPeriodic()
    poles = np.array([_array(pole) for pole in curve.getPoles()])
    weights, knots = np.array(curve.getWeights()), np.array(curve.KnotSequence)
    aside = np.stack([poles, poles + np.array((0.0, 0.0, 1.0))])
    ribbon = Nurbs(1, curve.Degree, np.array([0.0, 0.0, 1.0, 1.0]), knots, aside, np.stack([weights, weights]))

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        points, _, derivatives = ribbon(np.stack([np.zeros_like(t), t], axis=1))
        return points, derivatives

    return evaluate


def _extruded(points: Floats, along: Floats, direction: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """A curve's points and derivatives (N,3), moved by v (N,) along a direction: points and both derivatives."""
    return points + v[:, None] * direction, along, np.tile(direction, (len(v), 1))


def _revolved(
    points: Floats, along: Floats, location: Floats, axis: Floats, u: Floats
) -> tuple[Floats, Floats, Floats]:
    """A curve's points and derivatives (N,3), turned by u (N,) about an axis: points and both derivatives."""
    away = points - location
    turned = _turned(away, axis, u)
    return turned + location, np.cross(axis, turned), _turned(along, axis, u)


def _turned(vectors: Floats, axis: Floats, angle: Floats) -> Floats:
    """Vectors (N,3) turned by angles (N,) about a unit axis (Rodrigues)."""
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    level = (vectors @ axis)[:, None] * axis
    return np.asarray(level + cos * (vectors - level) + sin * np.cross(axis, vectors))


def _by_kernel(surface: Any) -> Any:
    """An evaluator that asks the kernel point by point."""

    def evaluate(uv: Floats) -> tuple[Floats, Floats, Floats]:
        out = np.empty((len(uv), 3, 3))
        for i, (u, v) in enumerate(uv.tolist()):
            at = (surface.getD0(u, v), surface.getDN(u, v, 1, 0), surface.getDN(u, v, 0, 1))
            out[i] = [(p.x, p.y, p.z) for p in at]
        return out[:, 0], out[:, 1], out[:, 2]

    return evaluate


def with_uv(face: Any, surface: Parametric, mesh: FaceMesh) -> tuple[Parametric, FaceMesh]:
    """The mesh of a freeform face with its nodes' parameters, which become the surface's seeds.

    Where the surface closes on itself, or shrinks to a pole, nodes are doubled: each triangle has its parameters in
    one piece, as in the kernel's own mesh.
    """
    from styluscam.parts.surfaces import Parametric
    from styluscam.parts.tessellation import FaceMesh

    seeds = np.array(face.getUVNodes())
    start = Parametric(surface.evaluate, surface.bounds, surface.evaluate(seeds)[0], seeds, surface.sign)
    uv = start.project(mesh.nodes, _nearest(start, mesh.nodes))
    corners, free = uv[mesh.triangles], _is_pole(surface, uv)[mesh.triangles]
    for axis, closed in enumerate((face.Surface.isUClosed(), face.Surface.isVClosed())):
        low, high = surface.bounds[2 * axis : 2 * axis + 2]
        period = high - low if closed else 0.0
        corners[..., axis] = _in_one_piece(corners[..., axis], free[..., axis], low, period)
    nodes, triangles, uv = _split(mesh, corners)
    return Parametric(surface.evaluate, surface.bounds, nodes, uv, surface.sign), FaceMesh(nodes, triangles, uv)


def _nearest(surface: Parametric, nodes: Floats) -> Floats:
    """The seed's parameters nearest to each node (N,2): the seed at the same point, for nearly all; else by search."""
    count = len(surface.seed_points)
    cells = np.rint(np.concatenate([surface.seed_points, nodes]) / SAME_POINT).astype(np.int64)
    _, index = np.unique(cells, axis=0, return_inverse=True)
    index = index.reshape(-1)
    seed_at = np.full(index.max() + 1, -1)
    seed_at[index[:count]] = np.arange(count)
    found = seed_at[index[count:]]
    uv = surface.seed_uv[found]
    uv[found < 0] = surface.nearest_seed(nodes[found < 0])
    return uv


def _is_pole(surface: Parametric, uv: Floats) -> Any:
    """Whether each parameter of uv (N,2) is free to choose: the surface does not move along it, (N,2)."""
    _, along_u, along_v = surface.evaluate(uv)
    sizes = np.stack([np.linalg.norm(along_u, axis=1), np.linalg.norm(along_v, axis=1)], axis=1)
    return sizes < 1e-9 * sizes.max(axis=0)


def _in_one_piece(values: Floats, free: Any, low: float, period: float) -> Floats:
    """One parameter of triangles' corners (T,3): on the seam at the end where the others are, poles between them."""
    values = values.copy()
    if period > 0.0:
        values = low + np.mod(values - low + 1e-9 * period, period) - 1e-9 * period
        highest = np.where(free, -np.inf, values).max(axis=1, keepdims=True)
        on_seam = values < low + 1e-6 * period
        values[~free & on_seam & (highest > low + period / 2.0)] += period
    count = np.maximum((~free).sum(axis=1, keepdims=True), 1)
    mean = np.where(free, 0.0, values).sum(axis=1, keepdims=True) / count
    return np.where(free & ~free.all(axis=1, keepdims=True), mean, values)


def _split(mesh: FaceMesh, corners: Floats) -> tuple[Floats, Any, Floats]:
    """Nodes, triangles and the nodes' parameters, a node for each pair of point and parameters (corners: (T,3,2))."""
    flat = corners.reshape(-1, 2)
    steps = np.rint(flat / (1e-9 * np.maximum(np.ptp(flat, axis=0), 1e-300))).astype(np.int64)
    rows = np.column_stack([mesh.triangles.reshape(-1), steps])
    unique, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return mesh.nodes[unique[:, 0]], inverse.reshape(-1, 3), flat[first]
