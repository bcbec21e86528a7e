"""Exact surfaces of a part's faces: signed distance and normal, vectorised, without a CAD kernel."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Vector: TypeAlias = tuple[float, float, float]

# Points evaluated together: small enough that the temporaries of one chunk stay in the processor's cache.
CHUNK = 16384


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


@dataclass(frozen=True)
class _Meridian:
    """Points seen in the half-plane through an axis: radius, height, and the directions that span it."""

    radius: Floats
    height: Floats
    radial: Floats

    @classmethod
    def of(cls, points: Floats, location: Vector, axis: Vector) -> _Meridian:
        """Return radius >= 0 and height along `axis` from `location`, of points (N,3)."""
        away = np.asarray(points, dtype=np.float64) - np.array(location)
        direction = np.array(axis)
        height = away @ direction
        across = away - height[:, None] * direction
        radius = np.sqrt(np.einsum("ij,ij->i", across, across))
        on_axis = radius <= 1e-12 * (1.0 + np.abs(height))
        if on_axis.any():  # any direction serves there: take one across the axis
            across[on_axis] = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
        return cls(radius, height, unit(across))


@dataclass(frozen=True)
class Plane:
    """A plane through `location`; the material lies against `axis` (with `sign` -1: along it)."""

    location: Vector
    axis: Vector
    sign: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return np.asarray(self.sign * ((points - np.array(self.location)) @ np.array(self.axis)))

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return np.tile(self.sign * np.array(self.axis), (len(points), 1))


@dataclass(frozen=True)
class Cylinder:
    """A cylinder of `radius`; with `sign` +1 the material is inside (a shaft), with -1 outside (a hole)."""

    location: Vector
    axis: Vector
    radius: float
    sign: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return self.sign * (_Meridian.of(points, self.location, self.axis).radius - self.radius)

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface."""
        return self.sign * _Meridian.of(points, self.location, self.axis).radial


@dataclass(frozen=True)
class Cone:
    """A cone (one nappe): `radius` at `location`, growing along `axis` by tan(`semi_angle`) (rad, may be negative).

    With `sign` +1 the material is inside, on the side of the axis.
    """

    location: Vector
    axis: Vector
    radius: float
    semi_angle: float
    sign: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface. Past the apex the nearest point is the apex."""
        at = _Meridian.of(points, self.location, self.axis)
        sine, cosine = np.sin(self.semi_angle), np.cos(self.semi_angle)
        from_line = (at.radius - self.radius) * cosine - at.height * sine
        above_apex = at.height + self.radius * cosine / sine
        along = at.radius * abs(sine) + above_apex * cosine * np.sign(sine)
        return np.asarray(self.sign * np.where(along >= 0.0, from_line, np.hypot(at.radius, above_apex)))

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface. At the apex: that of the generator in the point's half-plane."""
        at = _Meridian.of(points, self.location, self.axis)
        sine, cosine = np.sin(self.semi_angle), np.cos(self.semi_angle)
        return np.asarray(self.sign * (cosine * at.radial - sine * np.array(self.axis)))


@dataclass(frozen=True)
class Sphere:
    """A sphere; with `sign` +1 the material is inside."""

    location: Vector
    radius: float
    sign: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        away = points - np.array(self.location)
        return np.asarray(self.sign * (np.sqrt(np.einsum("ij,ij->i", away, away)) - self.radius))

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface. At the centre: +X."""
        away = points - np.array(self.location)
        away[~away.any(axis=1)] = (1.0, 0.0, 0.0)
        return self.sign * unit(away)


@dataclass(frozen=True)
class Torus:
    """A torus; with `sign` +1 the material is inside the tube. The tube may reach over the axis (minor > major)."""

    location: Vector
    axis: Vector
    major_radius: float
    minor_radius: float
    sign: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "location", _vector(self.location))
        object.__setattr__(self, "axis", _direction(self.axis))

    def _from_tube_centre(self, at: _Meridian) -> tuple[Floats, Floats]:
        """Return the radial offset from, and distance to, the centre of the generating circle whose arc is nearest."""
        near = at.radius - self.major_radius
        distance = np.hypot(near, at.height)
        if self.minor_radius <= self.major_radius:
            return near, distance
        far = at.radius + self.major_radius
        far_distance = np.hypot(far, at.height)
        take_far = np.abs(far_distance - self.minor_radius) < np.abs(distance - self.minor_radius)
        return np.where(take_far, far, near), np.where(take_far, far_distance, distance)

    def distance(self, points: Floats) -> Floats:
        """See ExactSurface."""
        _, distance = self._from_tube_centre(_Meridian.of(points, self.location, self.axis))
        return self.sign * (distance - self.minor_radius)

    def normal(self, points: Floats) -> Floats:
        """See ExactSurface. On the tube's centre line: along the axis."""
        at = _Meridian.of(points, self.location, self.axis)
        offset, distance = self._from_tube_centre(at)
        height = np.where(distance > 0.0, at.height, 1.0)
        return self.sign * unit(offset[:, None] * at.radial + height[:, None] * np.array(self.axis))


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
    ROUNDS = 40
    # A chord between two points of a border may leave the parameter domain by this part of it.
    OVERSHOOT = 0.01
    # A bound that is shorter than this part of the surface is a pole.
    POLE = 1e-7
    # Ways off a pole that are tried.
    SIDES = 33

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
        low, high = self._limits
        outside = ((foot <= low) | (foot >= high)).any(axis=1)
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
        foot = np.array(uv, dtype=np.float64)
        surface, along_u, along_v = (np.empty((len(points), 3)) for _ in range(3))
        low, high = self._limits
        active = np.arange(len(points))
        for _ in range(self.ROUNDS):
            self._leave_poles(points, foot, active)
            surface[active], along_u[active], along_v[active] = now = self.evaluate(foot[active])
            step = _tangent_step(points[active] - now[0], now[1], now[2])
            moved = np.clip(foot[active] + step, low, high)
            step = np.abs(moved - foot[active])
            foot[active] = moved
            length = step[:, 0] * np.abs(now[1]).max(axis=1) + step[:, 1] * np.abs(now[2]).max(axis=1)
            active = active[length > self.STEP]
            if not len(active):
                break
        return foot, surface, along_u, along_v

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
    def _is_pole(self) -> tuple[bool, ...]:
        """Whether the bounds u0, u1, v0 and v1 are one point each."""
        ends = np.reshape(self.bounds, (2, 2))
        places = np.stack(np.meshgrid(*np.linspace(*ends.T, 5).T), axis=-1).reshape(-1, 2)
        size = np.ptp(self.evaluate(places)[0], axis=0).max()
        found = []
        for bound, value in enumerate(self.bounds):
            along = 1 - bound // 2
            uv = np.full((5, 2), value)
            uv[:, along] = np.linspace(*ends[along], 5)
            found.append(bool(np.ptp(self.evaluate(uv)[0], axis=0).max() <= self.POLE * size))
        return tuple(found)

    def _leave_poles(self, points: Floats, foot: Floats, active: NDArray[np.intp]) -> None:
        """Turn those of the feet (N,2) that stand on a pole to the side on which their points (N,3) lie."""
        for bound, (along, inward) in self._round_poles.items():
            near = np.abs(foot[active, bound // 2] - self.bounds[bound]) <= self.POLE * abs(np.diff(self.bounds)[bound & 2])
            standing = active[near]
            if len(standing):
                away = points[standing] - self.evaluate(foot[standing])[0]
                foot[standing, 1 - bound // 2] = along[np.argmax(away @ inward.T, axis=1)]

    @cached_property
    def _round_poles(self) -> dict[int, tuple[Floats, Floats]]:
        """For each bound that is a pole parameters (K,) along it, and the unit ways (K,3) that lead off it there."""
        found = {}
        for bound in np.flatnonzero(self._is_pole).tolist():
            across, opposite = bound // 2, self.bounds[bound ^ 1]
            u0, u1, v0, v1 = self.bounds
            along = np.linspace(*((v0, v1) if across == 0 else (u0, u1)), self.SIDES)
            uv = np.full((self.SIDES, 2), self.bounds[bound])
            uv[:, 1 - across] = along
            pole = self.evaluate(uv)[0]
            uv[:, across] += 1e-3 * (opposite - self.bounds[bound])
            found[bound] = along, unit(self.evaluate(uv)[0] - pole)
        return found

    @cached_property
    def _limits(self) -> tuple[Floats, Floats]:
        # beyond a pole the surface turns over
        u0, u1, v0, v1 = self.bounds
        slack = self.OVERSHOOT * np.repeat([u1 - u0, v1 - v0], 2) * ~np.array(self._is_pole)
        return np.array([u0 - slack[0], v0 - slack[2]]), np.array([u1 + slack[1], v1 + slack[3]])

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


def _tangent_step(residual: Floats, along_u: Floats, along_v: Floats) -> Floats:
    """Return the parameter step (N,2) that removes the residual's tangential part, to first order."""
    uu = np.einsum("ij,ij->i", along_u, along_u)
    uv = np.einsum("ij,ij->i", along_u, along_v)
    vv = np.einsum("ij,ij->i", along_v, along_v)
    ru = np.einsum("ij,ij->i", residual, along_u)
    rv = np.einsum("ij,ij->i", residual, along_v)
    determinant = uu * vv - uv * uv
    regular = determinant > np.maximum(1e-14 * uu * vv, 1e-20 * np.maximum(uu, vv) ** 2)
    safe = np.where(regular, determinant, 1.0)
    step = np.stack([ru * vv - rv * uv, rv * uu - ru * uv], axis=1) / safe[:, None]
    # Where one derivative vanishes (a pole), walk along the other.
    fallback = np.stack([ru / np.where(uu > 0, uu, 1.0), rv / np.where(vv > 0, vv, 1.0)], axis=1)
    return np.where(regular[:, None], step, fallback * np.stack([uu >= vv, vv > uu], axis=1))


@dataclass(frozen=True, eq=False)
class Nurbs:
    """A (rational) B-spline surface as arrays: an evaluator for `Parametric`.

    `knots_u` and `knots_v` are flat (multiplicities written out) and not periodic; `poles` is (nu,nv,3), `weights`
    (nu,nv). Outside the knots the end polynomials continue. Evaluation: Piegl and Tiller, The NURBS Book, A2.2, A4.3.
    """

    degree_u: int
    degree_v: int
    knots_u: Floats
    knots_v: Floats
    poles: Floats
    weights: Floats
    _homogeneous: Floats = field(init=False, repr=False)
    _polynomials: dict[tuple[int, int], Floats] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        weighted = np.concatenate([self.poles * self.weights[..., None], self.weights[..., None]], axis=2)
        object.__setattr__(self, "_homogeneous", np.ascontiguousarray(weighted))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Return the parameter range u0, u1, v0, v1."""
        return (
            float(self.knots_u[self.degree_u]),
            float(self.knots_u[-self.degree_u - 1]),
            float(self.knots_v[self.degree_v]),
            float(self.knots_v[-self.degree_v - 1]),
        )

    def __call__(self, uv: Floats) -> tuple[Floats, Floats, Floats]:
        """Return points and derivatives along u and v, each (N,3), at parameters (N,2)."""
        span_u = _spans(self.knots_u, self.degree_u, uv[:, 0])
        span_v = _spans(self.knots_v, self.degree_v, uv[:, 1])
        patches, patch_of = np.unique(span_u * len(self.knots_v) + span_v, return_inverse=True)
        out = np.empty((3, len(uv), 3))
        order = np.argsort(patch_of, kind="stable")
        starts = np.searchsorted(patch_of[order], np.arange(len(patches) + 1))
        for number, patch in enumerate(patches.tolist()):
            for start in range(int(starts[number]), int(starts[number + 1]), CHUNK):
                rows = order[start : min(start + CHUNK, int(starts[number + 1]))]
                out[:, rows] = self._evaluate(uv[rows], *divmod(patch, len(self.knots_v)))
        return out[0], out[1], out[2]

    def _evaluate(self, uv: Floats, span_u: int, span_v: int) -> tuple[Floats, Floats, Floats]:
        """Evaluate points of one polynomial patch: its poles meet the basis functions in matrix products."""
        basis_u, slope_u = self._basis(0, span_u, uv[:, 0])
        basis_v, slope_v = self._basis(1, span_v, uv[:, 1])
        poles = self._homogeneous[span_u - self.degree_u : span_u + 1, span_v - self.degree_v : span_v + 1]
        flat = poles.transpose(1, 0, 2).reshape(self.degree_v + 1, -1)
        rows = (basis_v.T @ flat).reshape(len(uv), self.degree_u + 1, 4)
        row_slopes = (slope_v.T @ flat).reshape(len(uv), self.degree_u + 1, 4)
        point = np.einsum("in,nik->nk", basis_u, rows)
        along_u = np.einsum("in,nik->nk", slope_u, rows)
        along_v = np.einsum("in,nik->nk", basis_u, row_slopes)
        weight = point[:, 3:]
        position = point[:, :3] / weight
        return (
            position,
            (along_u[:, :3] - along_u[:, 3:] * position) / weight,
            (along_v[:, :3] - along_v[:, 3:] * position) / weight,
        )

    def _basis(self, direction: int, span: int, at: Floats) -> tuple[Floats, Floats]:
        """Return a span's basis functions and their derivatives, each (degree+1, N), at parameters (N,)."""
        knots, degree = ((self.knots_u, self.degree_u), (self.knots_v, self.degree_v))[direction]
        if degree > HIGHEST:
            return _basis(knots, degree, span, at)
        matrix = self._polynomials.get((direction, span))
        if matrix is None:
            matrix = self._polynomials[direction, span] = _basis_polynomials(knots, degree, span)
        start, width = knots[span], knots[span + 1] - knots[span]
        share = (at - start) / width
        powers = np.empty((degree + 1, len(at)))
        powers[0] = 1.0
        for k in range(1, degree + 1):
            np.multiply(powers[k - 1], share, out=powers[k])
        derivatives = matrix[:, 1:] * (np.arange(1, degree + 1) / width)
        return matrix @ powers, derivatives @ powers[:-1]


# Basis functions of a higher degree are not written as polynomials: cancellation would cost digits.
HIGHEST = 7


def _basis_polynomials(knots: Floats, degree: int, span: int) -> Floats:
    """Return a span's basis functions as polynomials of the share of the span, (degree+1, degree+1), constants first."""
    start, width = knots[span], knots[span + 1] - knots[span]
    basis = np.ones((1, 1))
    for k in range(1, degree + 1):
        raised = np.zeros((k + 1, k + 1))
        for i in range(k):
            left, right = knots[span + 1 + i - k], knots[span + 1 + i]
            share = basis[i] / (right - left)
            # (right - at) and (at - left), where at = start + width * share of the span
            raised[i, :k] += (right - start) * share
            raised[i, 1:] -= width * share
            raised[i + 1, :k] += (start - left) * share
            raised[i + 1, 1:] += width * share
        basis = raised
    return basis


def _spans(knots: Floats, degree: int, at: Floats) -> NDArray[np.int64]:
    """Return the non-empty knot span of each parameter (N,); beyond the ends: the first and the last."""
    starts = np.flatnonzero(knots[:-1] < knots[1:])
    starts = starts[(starts >= degree) & (starts <= len(knots) - degree - 2)]
    return np.asarray(starts[np.clip(np.searchsorted(knots[starts], at, side="right") - 1, 0, None)], dtype=np.int64)


def _basis(knots: Floats, degree: int, span: int, at: Floats) -> tuple[Floats, Floats]:
    """Return a knot span's basis functions and their derivatives, each (degree+1, N), at parameters (N,)."""
    basis = np.ones((1, len(at)))
    slopes = np.zeros((1, len(at)))
    for k in range(1, degree + 1):
        raised, slopes = np.zeros((k + 1, len(at))), np.zeros((k + 1, len(at)))
        for i in range(k):
            left, right = knots[span + 1 + i - k], knots[span + 1 + i]
            share = basis[i] / (right - left)
            raised[i] += (right - at) * share
            raised[i + 1] += (at - left) * share
            slopes[i] -= k * share
            slopes[i + 1] += k * share
        basis = raised
    return basis, slopes
