"""A part whose shape was changed before it is planned, as arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from styluscam import _engine
from styluscam.parts.arrays import FaceInfo, Ints, PartArrays, area_vectors, describe_face
from styluscam.parts.surfaces import Floats, unit


def changed(before: PartArrays, engine: _engine.Part) -> PartArrays:
    """The arrays of what the engine made of a part.

    Faces keep their numbers and kinds, those of an addendum come after them; no exact surface lies behind them.
    """
    vertices, triangles, face_ids, normals = engine.arrays()
    if normals is None:
        normals = np.repeat(unit(area_vectors(vertices, triangles))[:, None, :], 3, axis=1)
    inward, outward = engine.deviation
    known = {face.id for face in before.faces}
    added = (number for number in np.unique(face_ids).tolist() if number not in known)
    faces = [_face(face, vertices[triangles], normals, face_ids) for face in before.faces]
    faces += [_added(number, vertices[triangles], normals, face_ids) for number in added]
    return replace(
        before,
        vertices=vertices,
        triangles=triangles,
        normals=normals,
        face_ids=face_ids,
        faces=tuple(faces),
        deviation_inward=inward,
        deviation_outward=outward,
        surfaces=(),
        edges=(),
    )


def _face(face: FaceInfo, corners: Floats, normals: Floats, face_ids: Ints) -> FaceInfo:
    own = face_ids == face.id
    return describe_face(face.id, face.kind, corners[own], normals[own]) if own.any() else face


def _added(number: int, corners: Floats, normals: Floats, face_ids: Ints) -> FaceInfo:
    own = face_ids == number
    return describe_face(number, "other", corners[own], normals[own])
