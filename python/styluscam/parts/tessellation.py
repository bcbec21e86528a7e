"""Triangle meshes of exact surfaces: refining inside faces, checking the deviation by sampling, welding."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from styluscam.errors import GeometryError
from styluscam.parts.arrays import Ints
from styluscam.parts.surfaces import Elementary, ExactSurface, Floats, Parametric, Plane

# Samples lie on a barycentric grid of this order, and at the centroid. A surface's distance over a small triangle
# whose corners lie on it is a quadratic form that vanishes at the corners; over each cell of the grid it differs from
# its own linear interpolation by 1/ORDER^2 of its maximum over the whole triangle (the same form, scaled). So the
# largest sample is at least (1 - 1/ORDER^2) = 0.9375 of the true maximum. The rest down to 0.93 is for the terms of
# higher order. Dividing by it bounds the true maximum: at most 7.5 % too high.
ORDER = 4
SHORTFALL = 0.93
# The grid's points on a triangle's sides, three each: corner 0 to 1, 1 to 2, 2 to 0. One in the middle is not enough: a
# surface that swings from one side of an edge to the other crosses it there.
ON_SIDES = np.array([np.roll((1.0 - share, share, 0.0), side) for side in range(3) for share in (0.25, 0.5, 0.75)])
INSIDE = np.array([(0.5, 0.25, 0.25), (0.25, 0.5, 0.25), (0.25, 0.25, 0.5), (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)])
# A node's weight, and those of the samples along one side.
ONE, ALONG = np.ones((1, 1)), np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])
# What a distance to a freeform surface may be off (mm), see Parametric.STEP: a bound is never below the samples.
FOOT = 2e-8
# More triangles than this on one face are a mistake of units or tolerance.
MOST_TRIANGLES = 10_000_000
# The mesher's deflection, as a part of the tolerance, at the first attempt.
FIRST_SHARE = 0.9
# Edges of a good file lie off their surfaces by less than this part of the tolerance; where they lie farther off, what
# they are off is allowed on top, this many times: the bound on a triangle's deviation is that much above its samples.
GAP_SHARE, GAP_TIMES = 0.5, 1.25
# Edges farther off than this (mm) are a model that needs repair: no shop's file is that loose.
LARGEST_GAP = 0.1
# Splitting a side quarters its deviation: 40 rounds are far more than a face that can be refined needs.
REFINEMENTS = 40
# A triangle is a sliver where its longest side is longer than this part of the other two together: an angle above 157 degrees.
SLIVER = 0.98
# A sample is as far from its foot as this part of the distance to the nearest corner only where the foot is a wrong one: on a
# right angle's arc it is 0.41.
LOST = 0.4
ROUNDS = 4


@dataclass(frozen=True)
class FaceMesh:
    """One face's triangles: nodes (n,3) mm, triangles (t,3) wound outward, and each node's parameters (n,2) if any."""

    nodes: Floats
    triangles: Ints
    uv: Floats | None = None

    @cached_property
    def border(self) -> Ints:
        """Keys of the edges that only one triangle has, ascending."""
        keys = np.sort(_side_keys(self.triangles))
        differs = np.concatenate([[True], keys[1:] != keys[:-1], [True]])
        first = np.flatnonzero(differs)
        return np.asarray(keys[first[:-1]][np.diff(first) != 2])


@dataclass(frozen=True)
class Deviation:
    """How far a mesh leaves the exact surface, mm, both >= 0: into the material, and out of it."""

    inward: float
    outward: float

    @property
    def worst(self) -> float:
        """The larger of the two."""
        return max(self.inward, self.outward)


@dataclass(frozen=True)
class Tessellation:
    """Meshes of all faces that hold the tolerance, with each face's checked deviation.

    `edge_gaps` gives how far each face's edges lie off its surface, mm: the model's own looseness, which is allowed on
    top of the tolerance where it is larger than half of it.
    """

    meshes: tuple[FaceMesh, ...]
    deviations: tuple[Deviation, ...]
    edge_gaps: tuple[float, ...]
    deflection: float  # with which the mesher was called at last
    rounds: int


MeshAt = Callable[[float], Sequence[FaceMesh]]


def refine_until(
    mesh_at: MeshAt,
    surfaces: Sequence[ExactSurface],
    tolerance: float,
    where: str = "",
    *,
    checked: Callable[[float], None] = lambda _: None,
    shares: Sequence[float] | None = None,
) -> Tessellation:
    """Make meshes whose checked deviation is <= `tolerance` (mm), inward and outward each.

    `shares`: inside each face triangles are split down to this part of the tolerance; its border may take all of it.

    `mesh_at(deflection)` meshes the whole shape so that neighbouring faces share their border nodes, with borders
    within `deflection`; the insides may be coarser, they are refined here. Borders are never touched here (the mesh
    stays conforming): where they do not hold, the whole shape is meshed again with a smaller deflection.
    `checked` gets the share of an attempt's triangles is done; it may raise.
    Raises GeometryError when the tolerance does not hold after ROUNDS attempts.
    """
    deflection = FIRST_SHARE * tolerance
    for attempt in range(1, ROUNDS + 1):
        meshed = mesh_at(deflection)
        gaps = [edge_gap(m, s) for m, s in zip(meshed, surfaces, strict=True)]
        _check_gaps(gaps, tolerance, where)
        allowed = [tolerance + (GAP_TIMES * gap if gap > GAP_SHARE * tolerance else 0.0) for gap in gaps]
        refined = []
        work = np.cumsum([0] + [len(m.triangles) for m in meshed]) / max(1, sum(len(m.triangles) for m in meshed))
        for i, (m, s, bound) in enumerate(zip(meshed, surfaces, allowed, strict=True)):
            aim = bound - tolerance + tolerance * (shares[i] if shares is not None else 1.0)
            refined.append(refine(m, s, bound, _within(checked, float(work[i]), float(work[i + 1])), aim))
        meshes, deviations = [m for m, _ in refined], [d for _, d in refined]
        worst = max(d.worst / bound for d, bound in zip(deviations, allowed, strict=True))
        if worst <= 1.0:
            return Tessellation(tuple(meshes), tuple(deviations), tuple(gaps), deflection, attempt)
        deflection *= min(0.5, max(0.25, 0.8 / worst))
    at = int(np.argmax([d.worst / bound for d, bound in zip(deviations, allowed, strict=True)]))
    name = f"{where}:Face{at + 1}"
    raise GeometryError(
        f"{name}: its mesh stays {deviations[at].worst:.2g} mm off the surface, the tolerance is {tolerance:g} mm: "
        "repair the face, or ask for a larger tolerance",
        code="part-tolerance-missed",
        where=name,
        hint="a larger tolerance",
    )


def _within(checked: Callable[[float], None], start: float, end: float) -> Callable[[float], None]:
    """Return a callback that reports a part's share as that of the whole."""
    return lambda share: checked(start + share * (end - start))


def edge_gap(mesh: FaceMesh, surface: ExactSurface) -> float:
    """Return how far the nodes on the face's edges lie off its surface at most, mm."""
    border = mesh.border
    nodes = np.unique(np.concatenate([border >> 31, border & (2**31 - 1)]))
    if not len(nodes):
        return 0.0
    uv = None if mesh.uv is None else mesh.uv[nodes]
    points = FaceMesh(mesh.nodes[nodes], np.arange(len(nodes))[:, None], uv)
    return float(np.abs(_distance(points, surface, ONE)).max())


def _check_gaps(gaps: Sequence[float], tolerance: float, where: str) -> None:
    """Refuse a model whose edges are nowhere near its surfaces; a tolerance that wide makes it usable all the same."""
    at = int(np.argmax(gaps))
    if gaps[at] > max(LARGEST_GAP, tolerance):
        name, cure = f"{where}:Face{at + 1}", f"tolerance = {1.1 * gaps[at]:.2g}"
        raise GeometryError(
            f"{name}: the face's edges lie up to {gaps[at]:.2g} mm off its surface, there is a gap to its neighbours: "
            f"repair the face in the CAD system, or ask for {cure} mm",
            code="part-inexact-edges",
            where=name,
            hint=cure,
        )


def deviation(mesh: FaceMesh, surface: ExactSurface) -> Deviation:
    """Bound the deviation of a face's mesh from its surface, by samples on every triangle (see ORDER)."""
    return _largest(_bounds(mesh, surface))


def _largest(bounds: Floats) -> Deviation:
    inward, outward = bounds[:, :2].max(axis=0, initial=0.0)
    return Deviation(float(inward), float(outward))


def _bounds(mesh: FaceMesh, surface: ExactSurface, hopeless: float = np.inf) -> Floats:
    """Return for each triangle the bounds inward and outward, and how far each side is off at most, (t,5) mm >= 0.

    Side k runs from corner k to corner k + 1. A triangle with a side that is more than `hopeless` off is not sampled
    further: its bounds are then only known to exceed that.
    """
    if isinstance(surface, Parametric) and mesh.uv is not None:
        return _freeform_bounds(mesh, surface, hopeless)
    out = np.empty((len(mesh.triangles), 5))
    for start in range(0, len(mesh.triangles), 2048):
        part = slice(start, start + 2048)
        triangles = mesh.triangles[part]
        sides = _distance(FaceMesh(mesh.nodes, triangles, mesh.uv), surface, ON_SIDES)
        corners = _distance(FaceMesh(mesh.nodes, triangles, mesh.uv), surface, np.eye(3))
        out[part] = _triangle_bounds(FaceMesh(mesh.nodes, triangles, mesh.uv), surface, sides, corners, hopeless)
    return out


def _freeform_bounds(mesh: FaceMesh, surface: Parametric, hopeless: float) -> Floats:
    """As :func:`_bounds`, on a surface that is slow to evaluate: what triangles share is sampled once."""
    ends, of_triangle = _edges(mesh.triangles)
    used, corner = np.unique(mesh.triangles, return_inverse=True)
    corner = corner.reshape(-1, 3)
    at_node = np.concatenate([_distance(part, surface, ONE) for part in _parts(mesh, used[:, None])])[:, 0]
    on_edge = np.concatenate([_distance(part, surface, ALONG) for part in _parts(mesh, ends)])
    out = np.empty((len(mesh.triangles), 5))
    for start in range(0, len(mesh.triangles), 2048):
        part = slice(start, start + 2048)
        sides = on_edge[of_triangle[part]].reshape(-1, 9)
        corners = at_node[corner[part]]
        triangles = FaceMesh(mesh.nodes, mesh.triangles[part], mesh.uv)
        out[part] = _triangle_bounds(triangles, surface, sides, corners, hopeless)
    return out


def _parts(mesh: FaceMesh, corners: Ints) -> Iterator[FaceMesh]:
    """Yield the mesh with some of the corners (N,k) at a time."""
    for start in range(0, len(corners), 8192):
        yield FaceMesh(mesh.nodes, corners[start : start + 8192], mesh.uv)


def _triangle_bounds(mesh: FaceMesh, surface: ExactSurface, sides: Floats, corners: Floats, hopeless: float) -> Floats:
    """Return the rows of :func:`_bounds` for triangles whose samples on sides (t,9) and corners (t,3) are known."""
    bounds = _extremes(sides)
    full = bounds.max(axis=1) <= hopeless
    inside = FaceMesh(mesh.nodes, mesh.triangles[full], mesh.uv)
    bounds[full] = _full_bounds(inside, surface, sides[full], corners[full])
    off = np.abs(sides).reshape(-1, 3, 3)
    off = np.maximum(np.maximum(off[:, :, 0], off[:, :, 1]), off[:, :, 2])
    return np.concatenate([np.maximum(bounds, 0.0), off], axis=1)


def _extremes(distances: Floats) -> Floats:
    """Return how far each row (N,S) reaches inward and outward (N,2): column by column, which is ten times faster."""
    columns = np.ascontiguousarray(distances.T)
    return np.stack([-columns.min(axis=0), columns.max(axis=0)], axis=1)


def _full_bounds(mesh: FaceMesh, surface: ExactSurface, sides: Floats, corners: Floats) -> Floats:
    """Return bounds inward and outward (t,2) from the whole grid of samples, those on the sides (t,9) being known."""
    if isinstance(surface, Plane):  # the distance is linear: the corners are the extremes
        return _extremes(corners)
    distances = np.concatenate([corners, sides, _distance(mesh, surface, INSIDE)], axis=1)
    # Corners off the surface (by the file's own edge tolerance) add a linear part, that the samples see fully.
    slack = np.maximum.reduce(_extremes(corners), axis=1) / ORDER**2
    rounding = FOOT if isinstance(surface, Parametric) else 0.0
    return np.asarray((_extremes(distances) + slack[:, None] + rounding) / SHORTFALL)


def _distance(mesh: FaceMesh, surface: ExactSurface, weights: Floats) -> Floats:
    """Return signed distances (t, S) at barycentric weights (S,3) of each triangle."""
    if isinstance(surface, Elementary) and mesh.triangles.shape[1] == 3:
        return surface.distance_between(mesh.nodes, mesh.triangles, weights)
    points = (weights @ mesh.nodes[mesh.triangles]).reshape(-1, 3)
    if not isinstance(surface, Parametric) or mesh.uv is None:
        return surface.distance(points).reshape(-1, len(weights))
    uv = (weights @ surface.beside_poles(mesh.uv[mesh.triangles])).reshape(-1, 2)
    found = surface.distance_from(points, uv)
    ends = np.repeat(mesh.triangles, len(weights), axis=0)
    lost = _lost(np.abs(found), points, mesh.nodes, ends)
    for corner in ends[lost].T:
        again = surface.distance_from(points[lost], mesh.uv[corner])
        found[lost] = np.where(np.abs(again) < np.abs(found[lost]), again, found[lost])
    return found.reshape(-1, len(weights))


def _lost(away: Floats, points: Floats, nodes: Floats, ends: Ints) -> NDArray[np.bool_]:
    """Return which points (N,3), so far `away` (N,) from their feet, hardly gained on the nearest of their `ends` (N,k).

    Round a pole, or across a seam, parameters between those of the ends may lead Newton to another part of the surface.
    """
    nearest = np.full(len(points), np.inf)
    for end in ends.T:
        offset = points - nodes[end]
        np.minimum(nearest, np.einsum("ij,ij->i", offset, offset), out=nearest)
    return np.asarray((away * away > LOST * LOST * nearest) & (nearest > 0.0))


def refine(
    mesh: FaceMesh,
    surface: ExactSurface,
    tolerance: float,
    checked: Callable[[float], None] = lambda _: None,
    aim: float | None = None,
) -> tuple[FaceMesh, Deviation]:
    """Split triangles until each is within `aim` mm of the surface (the tolerance); return also the deviation left.

    New nodes lie on the surface. Sides on the face's border stay: a neighbour shares them. Where they alone are the
    cause, the deviation left exceeds the tolerance.
    """
    nodes, triangles, uv = mesh.nodes, mesh.triangles, mesh.uv
    bounds = _bounds(mesh, surface, hopeless=tolerance)
    aim = tolerance if aim is None else aim
    if not (bounds[:, :2] > aim).any():
        checked(1.0)
        return mesh, _largest(bounds)
    border = mesh.border
    off = _side_keys(triangles)[(bounds[:, 2:] > tolerance).reshape(-1)]
    if np.isin(off, border).any():  # to be meshed again: refining would chase the border
        return mesh, deviation(mesh, surface)
    node_off = np.zeros(len(nodes))
    node_off[triangles] = np.abs(_distance(mesh, surface, np.eye(3)))
    for attempt in range(REFINEMENTS):
        checked(1.0 - 0.5 ** (attempt + 1))  # each round has fewer triangles to look at than the one before
        failing = bounds[:, :2].max(axis=1) > aim
        if isinstance(surface, Plane) or not failing.any():
            break
        ends, of_triangle = _edges(triangles)
        inner = ~np.isin(_keys(ends), border)
        sides = of_triangle[failing]
        length = np.linalg.norm(nodes[ends[:, 0]] - nodes[ends[:, 1]], axis=1)
        bow = bounds[failing, 2:] - node_off[ends].max(axis=1)[sides]
        off = node_off[triangles[failing]].max(axis=1)
        split = _sides_to_split(bow, inner[sides], length[sides], off, aim)
        marked = np.zeros(len(ends), dtype=bool)
        marked[sides[split]] = True
        if not marked.any() or len(triangles) > MOST_TRIANGLES:
            break
        new_ids = np.full(len(ends), -1, dtype=np.int64)
        new_ids[marked] = len(nodes) + np.arange(np.count_nonzero(marked))
        new_nodes, new_uv = _middles_on_surface(nodes, uv, ends[marked], surface)
        nodes = np.concatenate([nodes, new_nodes])
        node_off = np.concatenate([node_off, np.zeros(len(new_nodes))])
        uv = np.concatenate([uv, new_uv]) if uv is not None and new_uv is not None else None
        touched = marked[of_triangle].any(axis=1)
        parts = _subdivide(triangles[touched], new_ids[of_triangle[touched]], nodes)
        triangles = np.concatenate([triangles[~touched], parts])
        bounds = np.concatenate([bounds[~touched], _bounds(FaceMesh(nodes, parts, uv), surface, hopeless=tolerance)])
    refined, left = FaceMesh(nodes, triangles, uv), _largest(bounds)
    # Hopeless triangles were not sampled fully: what is reported of a mesh that fails is found anew.
    return refined, left if left.worst <= tolerance else deviation(refined, surface)


def _sides_to_split(
    bow: Floats, inner: NDArray[np.bool_], length: Floats, corners_off: Floats, tolerance: float
) -> NDArray[np.bool_]:
    """Return which sides (F,3) of failing triangles to split: the one that bows most, and those that bow about as much.

    `bow` (F,3) is how much farther each side is off the surface than its ends: what splitting removes. A side much
    longer than that one goes too when it bows half as much, or slivers would be cut into ever finer slivers.
    Where no side bows, the surface swings about the triangle: the longest side goes. It goes with the others in a sliver, too
    (longest-edge bisection: Rivara, International Journal for Numerical Methods in Engineering 20, 1984): all lie in one line
    there, and were the longest to
    stay because the surface crosses it at the samples, each round would put the same slivers against it. A side on the border
    (not `inner`) stays, and a triangle that only its border or its corners keep off the surface is not split.
    """
    inner_bow = np.where(inner, bow, 0.0)
    most, worst = inner_bow.max(axis=1)[:, None], np.argmax(inner_bow, axis=1)[:, None]
    much_longer = length > 1.5 * np.take_along_axis(length, worst, axis=1)
    split = (inner_bow >= np.where(much_longer, 0.5, 0.9) * most) & (inner_bow > 0.1 * tolerance)
    swings = ~split.any(axis=1) & (bow.max(axis=1) < 0.5 * tolerance) & (corners_off < 0.5 * tolerance)
    inner_length = np.where(inner, length, 0.0)
    longest = (inner_length == inner_length.max(axis=1)[:, None]) & inner
    sliver = split.any(axis=1) & (length.max(axis=1) > SLIVER * (length.sum(axis=1) - length.max(axis=1)))
    sliver &= corners_off < 0.5 * tolerance
    along = (length == length.max(axis=1)[:, None]) & inner & sliver[:, None]
    return np.asarray(np.where(swings[:, None], longest, split | along))


def _keys(ends: Ints) -> Ints:
    """Return one number per edge, from its sorted end nodes (E,2)."""
    return np.asarray(ends[:, 0] * np.int64(2**31) + ends[:, 1])


def _side_keys(triangles: Ints) -> Ints:
    """Return the keys of each triangle's sides, from corner k to corner k + 1, (3T,)."""
    following = np.roll(triangles, -1, axis=1)
    lower, upper = np.minimum(triangles, following), np.maximum(triangles, following)
    return np.asarray(lower * np.int64(2**31) + upper).reshape(-1)


def _edges(triangles: Ints) -> tuple[Ints, Ints]:
    """Return the edges' sorted end nodes (E,2), and for each triangle its three edges (T,3)."""
    keys, inverse = np.unique(_side_keys(triangles), return_inverse=True)
    return np.stack([keys >> 31, keys & (2**31 - 1)], axis=1), inverse.reshape(-1, 3)


def _middles_on_surface(
    nodes: Floats, uv: Floats | None, ends: Ints, surface: ExactSurface
) -> tuple[Floats, Floats | None]:
    """Return the surface points (E,3) nearest to the middles of edges (E,2), and their parameters if any."""
    middle = nodes[ends].mean(axis=1)
    if isinstance(surface, Parametric):
        if uv is None:
            foot = surface.project(middle, surface.nearest_seed(middle))
            return surface.evaluate(foot)[0], foot
        foot, away = _feet(surface, middle, surface.beside_poles(uv[ends]).mean(axis=1))
        lost = np.flatnonzero(_lost(away, middle, nodes, ends))
        for end in ends[lost].T:
            again, distance = _feet(surface, middle[lost], uv[end])
            nearer = distance < away[lost]
            foot[lost[nearer]], away[lost[nearer]] = again[nearer], distance[nearer]
        return surface.evaluate(foot)[0], foot
    return middle - surface.distance(middle)[:, None] * surface.normal(middle), None


def _feet(surface: Parametric, points: Floats, near: Floats) -> tuple[Floats, Floats]:
    """Return the parameters (N,2) of the feet of points (N,3), sought from parameters (N,2), and how far they are, mm."""
    foot = surface.project(points, near)
    return foot, np.asarray(np.linalg.norm(surface.evaluate(foot)[0] - points, axis=1))


def _subdivide(triangles: Ints, middles: Ints, nodes: Floats) -> Ints:
    """Return triangles cut at the middles of their sides, (T,3) with -1 for a side that stays whole."""
    parts: list[Ints] = []
    count = (middles >= 0).sum(axis=1)

    a, b, c = triangles[count == 3].T
    ab, bc, ca = middles[count == 3].T
    parts += [np.stack(p, axis=1) for p in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]

    one, one_middle = _turned(triangles[count == 1], middles[count == 1], np.argmax(middles[count == 1], axis=1))
    a, b, c = one.T
    ab = one_middle[:, 0]
    parts += [np.stack((a, ab, c), axis=1), np.stack((ab, b, c), axis=1)]

    whole_side = np.argmin(middles[count == 2], axis=1)  # turned so that the side c-a stays whole
    two, two_middle = _turned(triangles[count == 2], middles[count == 2], (whole_side + 1) % 3)
    a, b, c = two.T
    ab, bc = two_middle[:, 0], two_middle[:, 1]
    from_a = np.linalg.norm(nodes[a] - nodes[bc], axis=1) <= np.linalg.norm(nodes[c] - nodes[ab], axis=1)
    parts.append(np.stack((ab, b, bc), axis=1))
    parts.append(np.where(from_a[:, None], np.stack((a, ab, bc), axis=1), np.stack((a, ab, c), axis=1)))
    parts.append(np.where(from_a[:, None], np.stack((a, bc, c), axis=1), np.stack((ab, bc, c), axis=1)))
    return np.concatenate(parts)


def _turned(triangles: Ints, middles: Ints, first: Ints) -> tuple[Ints, Ints]:
    """Return triangles and their sides, renumbered so that side `first` (T,) comes first."""
    order = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, order, axis=1), np.take_along_axis(middles, order, axis=1)


def weld(points: Floats, triangles: Ints, distance: float = 1e-9) -> tuple[Floats, Ints, Ints]:
    """Merge points that share a position.

    Returns the vertices, the triangles with new indexes, and which triangles (indexes) remain: those that collapse
    to an edge go. Points merge when their coordinates agree within about `distance` (mm).
    """
    position = np.zeros(len(points), dtype=np.int64)
    for axis in range(3):
        along = _clusters(points[:, axis], distance)
        _, position = np.unique(position * (along.max(initial=0) + 1) + along, return_inverse=True)
    _, keep, index = np.unique(position, return_index=True, return_inverse=True)
    welded = index[triangles]
    remaining = np.flatnonzero(
        (welded[:, 0] != welded[:, 1]) & (welded[:, 1] != welded[:, 2]) & (welded[:, 2] != welded[:, 0])
    )
    return np.ascontiguousarray(points[keep]), np.ascontiguousarray(welded[remaining]), remaining


def _clusters(values: Floats, distance: float) -> Ints:
    """Return numbers (N,) for values (N,): the same one where a chain of steps <= `distance` connects them."""
    order = np.argsort(values, kind="stable")
    numbers = np.zeros(len(values), dtype=np.int64)
    numbers[order[1:]] = np.cumsum(np.diff(values[order]) > distance)
    return numbers


def is_closed(triangles: Ints) -> bool:
    """Return whether each edge is shared by exactly two triangles that run it in opposite directions."""
    backwards = triangles > np.roll(triangles, -1, axis=1)
    run = np.sort(2 * _side_keys(triangles) + backwards.reshape(-1))
    forth, back = run[::2], run[1::2]
    paired = len(forth) == len(back) and bool((forth % 2 == 0).all() and (back == forth + 1).all())
    return paired and len(forth) > 0 and bool((forth[1:] != forth[:-1]).all())
