"""Rails of a ruled surface as B-splines: from poles, from points, or from any function."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam.arguments import refused
from styluscam.errors import GeometryError
from styluscam.types import FloatArray, numbers, points, shaped

RailLike: TypeAlias = "Rail | Mapping[str, Any] | npt.ArrayLike | Callable[[FloatArray], npt.ArrayLike]"
"""What a rail may be given as; see :meth:`Rail.of`."""

WANTED = "a Rail, a dict with poles, points (N, 3), or a function of an array of shares (N,) that returns points (N, 3)"

DEGREE = 5
"""Of what is fitted to a function."""
COARSEST, FINEST = 32, 2048
"""Spans of that, at first and at most."""
FIT = 1e-9
"""How far it may lie off, as a share of the rail's size: 1e-7 mm on a rail of 100 mm."""
THROUGH_POINTS = 3
"""Degree of what passes through points."""
SAME_KNOT = 1e-9
"""Parameters no farther apart than this share of a rail are one."""


@dataclass(frozen=True, eq=False)
class Rail:
    """A B-spline, rational or not."""

    degree: int
    knots: FloatArray
    """Flat: multiplicities written out, (N + degree + 1,)."""
    poles: FloatArray
    """(N, 3), mm."""
    weights: FloatArray
    """(N,)."""

    @classmethod
    def of(cls, rail: RailLike, name: str = "rail") -> Rail:
        """A rail as a B-spline.

        A dict holds ``poles`` (N, 3), and may hold ``degree``, flat ``knots`` and ``weights``: without them a Bézier curve. An
        array (N, 3) is passed through by a cubic B-spline, parametrised by the length of its chords. A function is followed
        within 1e-9 of its size.

        Raises:
            GeometryError: nothing of these, or a function that cannot be followed.
        """
        if isinstance(rail, Rail):
            return rail
        if isinstance(rail, Mapping):
            return cls._of_poles(rail, name)
        if callable(rail):
            return cls._of_function(rail, name)
        if isinstance(rail, str):
            raise refused(name, rail, WANTED, GeometryError)
        return cls._through(points(rail, 3, name), name)

    @property
    def columns(self) -> tuple[int, list[float], FloatArray, FloatArray]:
        """As the engine takes it."""
        return self.degree, self.knots.tolist(), self.poles, self.weights

    @classmethod
    def _of_poles(cls, rail: Mapping[str, Any], name: str) -> Rail:
        unknown = set(rail) - {"poles", "degree", "knots", "weights"}
        if unknown or "poles" not in rail:
            raise refused(name, dict(rail), "poles, and degree, knots and weights if there are any", GeometryError)
        poles = points(rail["poles"], 3, f"{name}.poles")
        degree = rail.get("degree", len(poles) - 1)
        if not isinstance(degree, int) or isinstance(degree, bool) or degree < 1:
            raise refused(f"{name}.degree", degree, "a whole number from 1 on", GeometryError)
        knots = rail.get("knots")
        flat = _clamped(len(poles), degree) if knots is None else numbers(knots, f"{name}.knots").ravel()
        if (np.diff(flat) < 0.0).any():
            raise refused(f"{name}.knots", flat, "knots that never fall", GeometryError)
        weights = numbers(rail.get("weights", np.ones(len(poles))), f"{name}.weights")
        if not (weights > 0.0).all():
            raise refused(f"{name}.weights", weights, "numbers above 0", GeometryError)
        return cls(degree, flat, poles, shaped(weights, (len(poles),), f"{name}.weights"))

    @classmethod
    def _through(cls, given: FloatArray, name: str) -> Rail:
        if len(given) < 2 or not np.isfinite(given).all():
            raise refused(name, given, "two points at least, of finite numbers", GeometryError)
        with np.errstate(over="ignore"):
            chords = np.linalg.norm(np.diff(given, axis=0), axis=1)
        if not np.isfinite(chords).all():
            raise refused(name, given, "points a finite distance apart", GeometryError)
        if not (chords > 0.0).all():
            number = int(np.argmin(chords))
            message = f"{name}: points {number} and {number + 1} are the same; leave one out"
            raise GeometryError(message, code="same-points", where=name, hint="give each point once")
        shares = np.concatenate([[0.0], np.cumsum(chords)]) / chords.sum()
        return cls._interpolated(shares, given, min(THROUGH_POINTS, len(given) - 1))

    @classmethod
    def _of_function(cls, function: Callable[[FloatArray], npt.ArrayLike], name: str) -> Rail:
        spans = COARSEST
        while True:
            shares = np.linspace(0.0, 1.0, spans + 1)
            rail = cls._interpolated(shares, _asked(function, shares, name), DEGREE)
            between = 0.5 * (shares[1:] + shares[:-1])
            found = _asked(function, between, name)
            off = float(np.linalg.norm(rail.at(between) - found, axis=1).max())
            if off <= FIT * max(float(np.ptp(found, axis=0).max()), 1.0):
                return rail
            if spans >= FINEST:
                message = (
                    f"{name}: the function is not smooth: {spans} pieces of degree {DEGREE} lie {off:.2g} mm off it"
                )
                raise GeometryError(message, code="not-smooth", where=name, hint="part it at its corners")
            spans *= 2

    @classmethod
    def _interpolated(cls, shares: FloatArray, through: FloatArray, degree: int) -> Rail:
        """Through points at shares of the way (The NURBS Book, equations 9.5 and 9.8)."""
        count = len(shares)
        inner = [shares[i + 1 : i + degree + 1].mean() for i in range(count - degree - 1)]
        knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
        counts = basis(shares, knots, degree, count)
        return cls(degree, knots, np.ascontiguousarray(np.linalg.solve(counts, through)), np.ones(count))

    def between(self, first: float, last: float) -> Rail:
        """The part of it between two of its parameters, exactly: by knots that are put in.

        W. Boehm: Inserting new knots into B-spline curves. Computer-Aided Design 12, 1980.
        """
        knots, poles = self.knots, np.column_stack([self.poles * self.weights[:, None], self.weights])
        low, high = float(knots[self.degree]), float(knots[-1 - self.degree])
        nothing = SAME_KNOT * (high - low)
        for value in (first, last):
            if abs(value - low) <= nothing or abs(value - high) <= nothing:
                continue
            while np.count_nonzero(np.abs(knots - value) <= nothing) < self.degree:
                knots, poles = _with_knot(knots, poles, self.degree, value)
        ends = max(low, first) + nothing, min(high, last) - nothing
        start = int(np.searchsorted(knots, ends[0])) - 1
        stop = int(np.searchsorted(knots, ends[1]))
        inner = knots[start + 1 : stop]
        kept = poles[start - self.degree : stop]
        flat = np.concatenate([np.full(self.degree + 1, knots[start]), inner, np.full(self.degree + 1, knots[stop])])
        return Rail(
            self.degree, flat, np.ascontiguousarray(kept[:, :3] / kept[:, 3:]), np.ascontiguousarray(kept[:, 3])
        )

    def at(self, shares: FloatArray) -> FloatArray:
        """Points (M, 3) at shares (M,) of the way."""
        first, last = self.knots[self.degree], self.knots[-1 - self.degree]
        counts = basis(first + shares * (last - first), self.knots, self.degree, len(self.poles)) * self.weights
        return np.asarray(counts @ self.poles / counts.sum(axis=1, keepdims=True))


def _with_knot(knots: FloatArray, poles: FloatArray, degree: int, value: float) -> tuple[FloatArray, FloatArray]:
    span = int(np.searchsorted(knots, value, side="right")) - 1
    moved = np.arange(span - degree + 1, span + 1)
    moved = moved[knots[moved] < value]
    shares = ((value - knots[moved]) / (knots[moved + degree] - knots[moved]))[:, None]
    between = shares * poles[moved] + (1.0 - shares) * poles[moved - 1]
    # one pole of each pair goes, one more comes
    found = np.concatenate([poles[: moved[0]], between, poles[moved[-1] :]])
    return np.insert(knots, span + 1, value), found


def _clamped(count: int, degree: int) -> FloatArray:
    inner = np.linspace(0.0, 1.0, max(count - degree + 1, 2))[1:-1]
    return np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])


def basis(at: FloatArray, knots: FloatArray, degree: int, count: int) -> FloatArray:
    """Basis functions (M, N) by Cox and de Boor."""
    inside = np.clip(at, knots[degree], np.nextafter(knots[count], knots[0]))[:, None]
    basis = ((knots[:-1] <= inside) & (inside < knots[1:])).astype(np.float64)
    for k in range(1, degree + 1):
        spans = knots[k:-1] - knots[: -k - 1], knots[k + 1 :] - knots[1:-k]
        left, right = (np.divide(1.0, span, out=np.zeros_like(span), where=span > 0.0) for span in spans)
        rising, falling = (at[:, None] - knots[: -k - 1]) * left, (knots[k + 1 :] - at[:, None]) * right
        basis = rising * basis[:, :-1] + falling * basis[:, 1:]
    return np.asarray(basis)


def _asked(function: Callable[[FloatArray], npt.ArrayLike], shares: FloatArray, name: str) -> FloatArray:
    try:
        given = function(shares.copy())
    except Exception as error:
        message = f"{name}: the function fails: {type(error).__name__}: {error}"
        hint = "it is given an array of shares from 0 to 1, (N,), and returns points (N, 3)"
        raise GeometryError(message, code="rail-function", where=name, hint=hint) from error
    found = shaped(numbers(given, name), (len(shares), 3), name)
    if not np.isfinite(found).all():
        share = shares[~np.isfinite(found).all(axis=1)][0]
        message = f"{name}: the function gives no finite point at u = {share:.4f}"
        raise GeometryError(message, code="not-finite", where=name, hint="it is asked from 0 to 1")
    return found
