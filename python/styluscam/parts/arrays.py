"""What a reader hands over: the part as arrays, with its faces described and its exact surfaces kept for rechecks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from styluscam.flank.rails import Rail
from styluscam.parts.surfaces import ExactSurface, Floats

Ints: TypeAlias = NDArray[np.int64]
Vector: TypeAlias = tuple[float, float, float]

KINDS = ("plane", "cylinder", "cone", "sphere", "torus", "spline", "freeform", "other")


@dataclass(frozen=True)
class FaceInfo:
    """One face of the part, as a person picks it. Lengths mm, slopes in degrees against +Z of the file's frame."""

    id: int  # 1-based: OpenCASCADE's TopExp order, as FreeCAD shows it; of a mesh, from the top down
    kind: str  # one of KINDS
    area_mm2: float
    centre: Vector  # of the area: it need not lie on the face
    anchor: Vector  # a point of the face (of its mesh) near the centre
    normal: Vector  # out of the material, at the anchor
    slope_min_deg: float
    slope_max_deg: float
    triangles: int

    @property
    def name(self) -> str:
        """The name that FreeCAD gives this face."""
        return f"Face{self.id}"


@dataclass(frozen=True, eq=False)
class PartArrays:
    """A part as the engine takes it. Lengths mm, float64 and int64, C order; the arrays are read-only.

    The mesh is welded: corners at one point share one index. Triangles wind so that their normal leaves the material.
    """

    vertices: Floats  # (V,3)
    triangles: Ints  # (T,3) indexes into vertices
    normals: Floats  # (T,3,3) unit normals of the exact surface at each triangle's corners
    face_ids: Ints  # (T,)
    faces: tuple[FaceInfo, ...]  # faces[i].id == i + 1
    deviation_inward: float  # checked bound on how far the mesh lies inside the material
    deviation_outward: float  # checked bound on how far it stands outside
    tolerance: float  # what was asked: the deviations are within it, except where edge_gap_mm forbids
    source: str
    units: str  # of the file; the arrays are always in mm
    is_closed: bool  # each edge is shared by exactly two triangles that run it in opposite directions
    notes: tuple[str, ...] = ()  # sentences for the user, e.g. that the file holds a sheet body
    edge_gap_mm: float = 0.0  # how far the file's own edges lie off its surfaces at most; the deviations include it
    is_mesh: bool = False  # the triangles are the part: there are no exact surfaces behind them
    surfaces: tuple[ExactSurface, ...] = field(default=(), repr=False)  # surfaces[i] belongs to faces[i]
    edges: tuple[Rail | None, ...] = field(
        default=(), repr=False
    )  # edges[0] is Edge1 in FreeCAD; None: it has no curve

    def __post_init__(self) -> None:
        for array in (self.vertices, self.triangles, self.normals, self.face_ids):
            array.setflags(write=False)

    @property
    def box(self) -> tuple[Vector, Vector]:
        """Lowest and highest corner of the mesh, mm."""
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return (float(low[0]), float(low[1]), float(low[2])), (float(high[0]), float(high[1]), float(high[2]))

    def surface_distance(self, points: Floats, face_ids: Ints) -> Floats:
        """Return the signed distance (N,) in mm from points (N,3) to the exact surface of the face beside each.

        Positive outside the material. The surface is the unbounded one: not cut at the face's borders.
        Raises IndexError where a face id does not exist.
        """
        points = np.ascontiguousarray(points, dtype=np.float64)
        face_ids = np.asarray(face_ids)
        if len(points) != len(face_ids):
            raise ValueError(f"{len(points)} points but {len(face_ids)} face ids")
        distances = np.empty(len(points))
        for face_id in np.unique(face_ids):
            if not 1 <= face_id <= len(self.surfaces):
                raise IndexError(f"face {face_id} does not exist: the part has {len(self.surfaces)}")
            at = face_ids == face_id
            distances[at] = self.surfaces[face_id - 1].distance(points[at])
        return distances


def signed_volume(vertices: Floats, triangles: Ints) -> float:
    """Return the volume enclosed by an outward-wound closed mesh, mm^3; negative when it is wound inward."""
    origin = vertices.mean(axis=0)
    a, b, c = (vertices[triangles[:, k]] - origin for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def area_vectors(vertices: Floats, triangles: Ints) -> Floats:
    """Return twice each triangle's area along its normal, (T,3) mm^2."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a))


def surface_area(vertices: Floats, triangles: Ints) -> float:
    """Return the area of triangles, mm^2."""
    return float(np.linalg.norm(area_vectors(vertices, triangles), axis=1).sum() / 2.0)


def describe_face(
    face_id: int,
    kind: str,
    corners: Floats,
    normals: Floats,
    *,
    area: float | None = None,
    centre: Vector | None = None,
) -> FaceInfo:
    """Describe a face from its triangles' corners (T,3,3) and corner normals (T,3,3).

    `area` and `centre` are the kernel's, where there is one; else the mesh's.
    """
    sizes = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2.0
    centroids = corners.mean(axis=1)
    if area is None:
        area = float(sizes.sum())
    if centre is None:
        x, y, z = np.average(centroids, axis=0, weights=sizes if sizes.sum() > 0.0 else None)
        centre = (float(x), float(y), float(z))
    nearest = int(np.argmin(np.linalg.norm(centroids - np.array(centre), axis=1)))
    mean = normals[nearest].mean(axis=0)
    mean /= max(float(np.linalg.norm(mean)), 1e-300)
    slopes = np.degrees(np.arctan2(np.hypot(normals[..., 0], normals[..., 1]), normals[..., 2]))
    ax, ay, az = (float(value) for value in centroids[nearest])
    return FaceInfo(
        face_id,
        kind,
        area,
        centre,
        (ax, ay, az),
        (float(mean[0]), float(mean[1]), float(mean[2])),
        float(slopes.min()),
        float(slopes.max()),
        len(corners),
    )
