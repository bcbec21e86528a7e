"""Exact surfaces of a part's faces: signed distance and normal, vectorised, without a CAD kernel."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import ClassVar, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from .. import _engine
from ..flank.rails import basis

Floats: TypeAlias = NDArray[np.float64]
Vector: TypeAlias = tuple[float, float, float]


@runtime_checkable
class ExactSurface(Protocol):
    """The unbounded surface a face lies on, oriented so that its normal leaves the material."""

    def distance(self, points: Floats) -> Floats:
        """Return signed distance in mm, (N,3) -> (N,): positive outside the material, negative inside."""
        ...

    def normal(self, points: Floats) -> Floats:
        """Return the unit normal out of the material at the surface point nearest each point, (N,3) -> (N,3)."""
        ...


def unit(vectors: Floats) -> Floats:
    """Return each row scaled to length 1; a zero row stays zero. (N,3) -> (N,3)."""
    lengths = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)[:, None]


def _vector(value: Iterable[float]) -> Vector:
    x, y, z = (float(c) for c in value)
    return (x, y, z)


def _direction(value: Iterable[float]) -> Vector:
    vector = np.array(_vector(value))
    return _vector(vector / np.linalg.norm(vector))


ANYWHERE: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
"""Directions across an axis, where it does not matter from where angles about it are counted."""


class Elementary(ABC):
    """A plane, cylinder, cone, sphere or torus: the engine computes."""

    kind: ClassVar[str]
    location: Vector
    sign: float

    @property
    def _axis(self) -> Vector:
        axis: Vector = getattr(self, "axis", (0.0, 0.0, 1.0))
        return axis

    @property
    @abstractmethod
    def _sizes(self) -> list[float]:
        """Return radii (mm) and angles (rad) as the engine takes them."""

    def engine(self, axis: Vector | None = None, across: tuple[Vector, Vector] = ANYWHERE) -> _engine.ElementarySurface:
        """Return the surface in the engine; angles about `axis` are counted from across[0] towards across[1]."""
        axis = self._axis if axis is None else axis
        return _engine.ElementarySurface(self.kind, self.location, axis, across, self._sizes, self.sign)

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface. Past a cone's apex the nearest point is the apex."""
        return self.engine().distance(np.ascontiguousarray(points, dtype=np.float64))

    def distance_between(self, nodes: Floats, triangles: NDArray[np.int64], weights: Floats) -> Floats:
        """Return signed distances (T,S) at barycentric weights (S,3) of triangles (T,3) between nodes (N,3)."""
        corners = np.ascontiguousarray(nodes[triangles].reshape(-1, 3))  # not all nodes: callers ask part by part
        return self.engine().distance_between(corners, np.arange(len(corners)).reshape(-1, 3), weights)

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface. On an axis: that of any half-plane through it; at a sphere's centre any."""
        return self.engine().normal(np.ascontiguousarray(points, dtype=np.float64))


@dataclass(frozen=True)
class Plane(Elementary):
    """A plane through `location`; the material lies against `axis` (with `sign` -1: along it)."""

    location: Vector
    axis: Vector
    sign: float = 1.0
    kind = "plane"

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    @property
    def _sizes(self) -> list[float]:
        return []


@dataclass(frozen=True)
class Cylinder(Elementary):
    """A cylinder of `radius`; with `sign` +1 the material is inside (a shaft), with -1 outside (a hole)."""

    location: Vector
    axis: Vector
    radius: float
    sign: float = 1.0
    kind = "cylinder"

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    @property
    def _sizes(self) -> list[float]:
        return [self.radius]


@dataclass(frozen=True)
class Cone(Elementary):
    """A cone (one nappe): `radius` at `location`, growing along `axis` by tan(`semi_angle`) (rad, may be negative).

    With `sign` +1 the material is inside, on the side of the axis.
    """

    location: Vector
    axis: Vector
    radius: float
    semi_angle: float
    sign: float = 1.0
    kind = "cone"

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    @property
    def _sizes(self) -> list[float]:
        return [self.radius, self.semi_angle]


@dataclass(frozen=True)
class Sphere(Elementary):
    """A sphere; with `sign` +1 the material is inside."""

    location: Vector
    radius: float
    sign: float = 1.0
    kind = "sphere"

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))

    @property
    def _sizes(self) -> list[float]:
        return [self.radius]


@dataclass(frozen=True)
class Torus(Elementary):
    """A torus; with `sign` +1 the material is inside the tube. The tube may reach over the axis (minor > major)."""

    location: Vector
    axis: Vector
    major_radius: float
    minor_radius: float
    sign: float = 1.0
    kind = "torus"

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    @property
    def _sizes(self) -> list[float]:
        return [self.major_radius, self.minor_radius]


Evaluator: TypeAlias = Callable[[Floats], tuple[Floats, Floats, Floats]]


@dataclass(frozen=True, eq=False)
class Parametric:
    """A freeform surface, known by evaluating it: `evaluate(uv (N,2))` -> points and both derivatives, each (N,3).

    `bounds` is (u0, u1, v0, v1); `seed_points` (S,3) and `seed_uv` (S,2) are points on the face, the start of each
    projection; with `sign` +1 the material lies against the cross product of the derivatives.
    """

    evaluate: Evaluator
    bounds: tuple[float, float, float, float]
    seed_points: Floats
    seed_uv: Floats
    sign: float = 1.0

    # Newton stops when a step moves the foot point by less than this (mm): the distance is then off by its square over
    # twice the radius of curvature, 2e-8 mm where that is 0.01 mm.
    STEP = 2e-5
    # A chord between two points of a border may leave the parameter domain by this part of it.
    OVERSHOOT = 0.01
    # A bound that is shorter than this part of the surface is a pole.
    POLE = 1e-7
    # Directions off a pole that are tried.
    SIDES = 33

    def __getstate__(self) -> dict[str, object]:
        """For pickle and copy: without what is kept of the engine."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface; right for points nearer to the surface than its smallest radius of curvature."""
        return self.distance_from(points, self.nearest_seed(points))

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return self.normal_from(points, self.nearest_seed(points))

    def distance_from(self, points: Floats, uv: Floats) -> Floats:
        """Return the signed distance (N,) of points (N,3) whose foot points are near parameters uv (N,2)."""
        foot, surface, along_u, along_v = self._foot(points, uv)
        away = points - surface
        height = np.einsum("ij,ij->i", away, self._oriented(foot, along_u, along_v))
        low, high = map(np.array, self._limits)
        closes = np.array([period is not None for period in self._periods])
        outside = (((foot <= low) | (foot >= high)) & ~closes).any(axis=1)
        size = np.sqrt(np.einsum("ij,ij->i", away, away))
        return np.asarray(np.where(outside, np.copysign(size, height), height))

    def normal_from(self, points: Floats, uv: Floats) -> Floats:
        """Return the unit normal (N,3) at the foot points of points (N,3), near parameters uv (N,2)."""
        foot, _, along_u, along_v = self._foot(points, uv)
        return self._oriented(foot, along_u, along_v)

    def nearest_seed(self, points: Floats) -> Floats:
        """Return the parameters (N,2) of the seed nearest to each point (N,3)."""
        squared = np.einsum("ij,ij->i", self.seed_points, self.seed_points)
        found = np.empty(len(points), dtype=np.intp)
        rows = max(1, 4_000_000 // max(1, len(self.seed_points)))
        for start in range(0, len(points), rows):
            part = points[start : start + rows]
            found[start : start + rows] = np.argmin(squared - 2.0 * part @ self.seed_points.T, axis=1)
        return self.seed_uv[found]

    def project(self, points: Floats, uv: Floats) -> Floats:
        """Return the parameters (N,2) of the foot points of points (N,3), near parameters uv (N,2)."""
        return self._foot(points, uv)[0]

    def _foot(self, points: Floats, uv: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Find foot points by Gauss-Newton from uv (N,2), kept inside the bounds: parameters, point, both derivatives.

        Point and derivatives are those before the last step, which is below STEP: the height over their tangent
        plane is the distance up to its square.
        """
        surface = self.evaluate.engine if isinstance(self.evaluate, Nurbs) else self.evaluate
        near = np.ascontiguousarray(uv, dtype=np.float64)
        foot, found = self._search.feet(surface, np.ascontiguousarray(points), near)
        return foot, *found

    def beside_poles(self, uv: Floats) -> Floats:
        """Return the parameters (N,k,2) of the corners of N triangles or edges, those on a pole made fit for the others.

        All of a bound is one point at a pole: there the parameter along the bound is the mean of the other corners'.
        """
        uv = uv.copy()
        for bound, value in enumerate(self.bounds):
            if self._is_pole[bound]:
                across, along = bound // 2, 1 - bound // 2
                on_pole = np.abs(uv[:, :, across] - value) <= 1e-9 * max(1.0, abs(value))
                others = (~on_pole).sum(axis=1)
                mean = np.where(on_pole, 0.0, uv[:, :, along]).sum(axis=1) / np.maximum(others, 1)
                uv[:, :, along] = np.where(on_pole & (others > 0)[:, None], mean[:, None], uv[:, :, along])
        return uv

    @cached_property
    def _search(self) -> _engine.FootSearch:
        return _engine.FootSearch(self._limits, self._periods, self._round_poles, self.STEP)

    @cached_property
    def _borders(self) -> tuple[Floats, float]:
        """Points (4,5,3) along the bounds u0, u1, v0 and v1, and what counts as no distance between them, mm."""
        ends = np.reshape(self.bounds, (2, 2))
        uv = np.empty((4, 5, 2))
        for bound, value in enumerate(self.bounds):
            uv[bound, :, bound // 2] = value
            uv[bound, :, 1 - bound // 2] = np.linspace(ends[1 - bound // 2, 0], ends[1 - bound // 2, 1], 5)
        inside = np.stack(np.meshgrid(*np.linspace(ends[:, 0], ends[:, 1], 5).T), axis=-1).reshape(-1, 2)
        size = float(np.ptp(self.evaluate(inside)[0], axis=0).max())
        return self.evaluate(uv.reshape(-1, 2))[0].reshape(4, 5, 3), self.POLE * size

    @cached_property
    def _is_pole(self) -> tuple[bool, ...]:
        """Whether the bounds u0, u1, v0 and v1 are one point each."""
        borders, nothing = self._borders
        return tuple(bool(np.ptp(border, axis=0).max() <= nothing) for border in borders)

    @cached_property
    def _periods(self) -> tuple[float | None, float | None]:
        """After how much of u, and of v, the surface is the same again; None where it does not close."""
        borders, nothing = self._borders
        closes = [np.abs(borders[k] - borders[k + 1]).max() <= nothing for k in (0, 2)]
        u0, u1, v0, v1 = self.bounds
        return (u1 - u0 if closes[0] else None), (v1 - v0 if closes[1] else None)

    @cached_property
    def _round_poles(self) -> list[tuple[int, float, float, Floats, Floats]]:
        """Return what is known of each bound that is a pole.

        The parameter that is fixed there, its value, how near it is meant; values (K,) of the other one, and the unit directions
        (K,3) that lead off the pole at them.
        """
        ends = np.reshape(self.bounds, (2, 2))
        found = []
        for bound in np.flatnonzero(self._is_pole).tolist():
            fixed, value, inward = bound // 2, self.bounds[bound], self.bounds[bound ^ 1] - self.bounds[bound]
            uv = np.full((self.SIDES, 2), value)
            uv[:, 1 - fixed] = np.linspace(ends[1 - fixed, 0], ends[1 - fixed, 1], self.SIDES)
            pole, along = self.evaluate(uv)[0], uv[:, 1 - fixed].copy()
            uv[:, fixed] += 1e-3 * inward
            found.append((fixed, value, self.POLE * abs(inward), along, unit(self.evaluate(uv)[0] - pole)))
        return found

    @cached_property
    def _limits(self) -> tuple[tuple[float, float], tuple[float, float]]:
        # beyond a pole the surface turns over
        u0, u1, v0, v1 = self.bounds
        slack = (self.OVERSHOOT * np.repeat([u1 - u0, v1 - v0], 2) * ~np.array(self._is_pole)).tolist()
        return (u0 - slack[0], v0 - slack[2]), (u1 + slack[1], v1 + slack[3])

    def _oriented(self, uv: Floats, along_u: Floats, along_v: Floats) -> Floats:
        """Return unit normals out of the material, from the derivatives at uv (N,2)."""
        cross = np.cross(along_u, along_v)
        size = np.linalg.norm(cross, axis=1)
        scale = np.linalg.norm(along_u, axis=1).max(initial=0.0) * np.linalg.norm(along_v, axis=1).max(initial=0.0)
        degenerate = size <= 1e-9 * scale
        if degenerate.any():  # a pole: the normal just beside it
            u0, u1, v0, v1 = self.bounds
            middle = np.array([(u0 + u1) / 2, (v0 + v1) / 2])
            _, beside_u, beside_v = self.evaluate(uv[degenerate] + 1e-5 * (middle - uv[degenerate]))
            cross[degenerate] = np.cross(beside_u, beside_v)
        return self.sign * unit(cross)


@dataclass(frozen=True, eq=False)
class Nurbs:
    """A (rational) B-spline surface as arrays: an evaluator for `Parametric`.

    `knots_u` and `knots_v` are flat (multiplicities written out) and not periodic; `poles` is (nu,nv,3), `weights`
    (nu,nv). Outside the knots the end polynomials continue.
    """

    degree_u: int
    degree_v: int
    knots_u: Floats
    knots_v: Floats
    poles: Floats
    weights: Floats

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Return the parameter range u0, u1, v0, v1."""
        return (
            float(self.knots_u[self.degree_u]),
            float(self.knots_u[-self.degree_u - 1]),
            float(self.knots_v[self.degree_v]),
            float(self.knots_v[-self.degree_v - 1]),
        )

    def __getstate__(self) -> dict[str, object]:
        """For pickle and copy: without what is kept of the engine."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def __call__(self, uv: Floats) -> tuple[Floats, Floats, Floats]:
        """Return points and derivatives along u and v, each (N,3), at parameters (N,2)."""
        return self.engine(np.ascontiguousarray(uv))

    @cached_property
    def engine(self) -> _engine.Nurbs:
        """The surface in the engine."""
        degrees, weights = (self.degree_u, self.degree_v), np.ascontiguousarray(self.weights)
        return _engine.Nurbs(
            degrees, self.knots_u.tolist(), self.knots_v.tolist(), np.ascontiguousarray(self.poles), weights
        )

    def iso_curve(self, across: int, value: float) -> tuple[int, Floats, Floats, Floats]:
        """Return the B-spline (degree, knots, poles (N,3), weights (N,)) along which parameter `across` (0: u) has a value."""
        degree, knots = (self.degree_u, self.knots_u) if across == 0 else (self.degree_v, self.knots_v)
        poles, weights = (self.poles, self.weights) if across == 0 else (self.poles.swapaxes(0, 1), self.weights.T)
        counts = basis(np.array([value]), knots, degree, len(poles))[0]
        along = np.einsum("i,ij->j", counts, weights)
        moved = np.einsum("i,ij,ijk->jk", counts, weights, poles) / along[:, None]
        other = (self.degree_v, self.knots_v) if across == 0 else (self.degree_u, self.knots_u)
        return *other, np.ascontiguousarray(moved), np.ascontiguousarray(along)
