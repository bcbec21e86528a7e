"""Parts as they were read, kept by what is in their files: plan, run and verify tessellate and check once.

An entry is named by a hash of the file's bytes, the tolerance, the kernel's version, the reader's own code and which engine it
is: it is right or absent, never old. It is written whole or not at all; one that cannot be read back is thrown away. Where the
folder cannot be written to, nothing is kept and nothing is reported.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import sys
import zipfile
from dataclasses import asdict, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from styluscam import _engine
from styluscam.errors import StylusError
from styluscam.files import write_whole
from styluscam.flank.rails import Rail
from styluscam.parts.arrays import FaceInfo, PartArrays
from styluscam.parts.surfaces import Cone, Cylinder, ExactSurface, Nurbs, Parametric, Plane, Sphere, Torus

# What the folder may hold, and one part of it, bytes: the least recently used parts go.
MOST, MOST_OF_ONE = 1 << 30, 1 << 28

CLOSED_FORMS = {kind.__name__: kind for kind in (Plane, Cylinder, Cone, Sphere, Torus)}
ARRAYS = ("vertices", "triangles", "normals", "face_ids")
# Kept beside the arrays, as JSON.
PLAIN = ("deviation_inward", "deviation_outward", "tolerance", "units", "is_closed", "notes", "edge_gap_mm")


def folder() -> Path:
    """Return where parts are kept: below STYLUSCAM_CACHE, else below the system's folder for caches."""
    if own := os.environ.get("STYLUSCAM_CACHE"):
        return Path(own) / "parts"
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "styluscam" / "parts"


def key(file: Path, tolerance: float) -> str | None:
    """Return the name under which a part is kept; None where its file cannot be read."""
    found = hashlib.sha256(f"{_kernel()} {file.suffix.lower()} {tolerance!r}\n".encode())
    try:
        engine = Path(_engine.__file__).stat()
        found.update(f"{engine.st_size} {engine.st_mtime_ns}\n".encode())
        for code in sorted(Path(__file__).parent.glob("*.py")):
            found.update(code.read_bytes())
        with file.open("rb") as stream:
            while block := stream.read(1 << 20):
                found.update(block)
    except OSError:
        return None
    return found.hexdigest()


def _kernel() -> str:
    """Return the CAD kernel's version, without loading it."""
    for name in ("cadquery-ocp-novtk", "cadquery-ocp"):
        with contextlib.suppress(metadata.PackageNotFoundError):
            return metadata.version(name)
    return "none"


def kept(name: str | None, source: str) -> PartArrays | None:
    """Return the part of that name, as read from `source`; None where there is none."""
    if name is None:
        return None
    try:
        path = folder() / f"{name}.npz"
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            part = _part({key: archive[key] for key in archive.files}, source)
        os.utime(path)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, IndexError, RuntimeError, EOFError, zipfile.BadZipFile):
        with contextlib.suppress(OSError, RuntimeError):
            (folder() / f"{name}.npz").unlink()
        return None
    return part


def keep(name: str | None, part: PartArrays) -> None:
    """Keep a part under that name, if its surfaces can be written down and there is space."""
    entries = None if name is None else _entries(part)
    if entries is None:
        return
    with contextlib.suppress(
        OSError, RuntimeError, StylusError
    ):  # no home, no space, no right to write: it is read again then
        directory = folder()
        directory.mkdir(parents=True, exist_ok=True)
        _free_space(directory)
        stream = io.BytesIO()
        np.savez(stream, **entries)
        if stream.tell() <= MOST_OF_ONE:
            write_whole(directory / f"{name}.npz", stream.getbuffer())


def _free_space(directory: Path) -> None:
    """Remove the parts that were used least recently, until one more fits."""
    found = []
    for path in directory.iterdir():
        with contextlib.suppress(OSError):  # another process may remove it just now
            status = path.stat()
            found.append((status.st_mtime, status.st_size, path))
    total = sum(size for _, size, _ in found)
    for _, size, path in sorted(found):
        if total <= MOST - MOST_OF_ONE:
            break
        with contextlib.suppress(OSError):
            path.unlink()
        total -= size


# --- parts as arrays and back ------------------------------------------------------------------------------------


def _entries(part: PartArrays) -> dict[str, Any] | None:
    """Return a part as named arrays; None where a surface is known by asking the kernel only."""
    entries: dict[str, Any] = {name: getattr(part, name) for name in ARRAYS}
    surfaces = []
    for i, surface in enumerate(part.surfaces):
        if type(surface).__name__ in CLOSED_FORMS:
            surfaces.append({"kind": type(surface).__name__, "values": asdict(surface)})  # type: ignore[call-overload]
        elif isinstance(surface, Parametric) and isinstance(surface.evaluate, Nurbs):
            nurbs = surface.evaluate
            degrees = (nurbs.degree_u, nurbs.degree_v)
            surfaces.append({"kind": "Nurbs", "degrees": degrees, "bounds": surface.bounds, "sign": surface.sign})
            arrays = (nurbs.knots_u, nurbs.knots_v, nurbs.poles, nurbs.weights, surface.seed_points, surface.seed_uv)
            entries |= {f"surface {i} {j}": array for j, array in enumerate(arrays)}
        else:
            return None
    for i, edge in enumerate(part.edges):
        curve = () if edge is None else (edge.knots, edge.poles, edge.weights)
        entries |= {f"edge {i} {j}": array for j, array in enumerate(curve)}
    edges = [None if edge is None else edge.degree for edge in part.edges]
    plain = {name: getattr(part, name) for name in PLAIN}
    faces = [asdict(face) for face in part.faces]
    text = json.dumps({"plain": plain, "faces": faces, "surfaces": surfaces, "edges": edges})
    return entries | {"text": np.frombuffer(text.encode(), np.uint8)}


def _part(entries: dict[str, Any], source: str) -> PartArrays:
    """Return the part that was kept; raises what numpy and json do where it is damaged."""
    document = json.loads(entries["text"].tobytes())
    surfaces: list[ExactSurface] = []
    for i, known in enumerate(document["surfaces"]):
        if known["kind"] == "Nurbs":
            knots_u, knots_v, poles, weights, points, uv = (entries[f"surface {i} {j}"] for j in range(6))
            degree_u, degree_v = known["degrees"]
            nurbs = Nurbs(degree_u, degree_v, knots_u, knots_v, poles, weights)
            surfaces.append(Parametric(nurbs, tuple(known["bounds"]), points, uv, known["sign"]))
        else:
            surfaces.append(CLOSED_FORMS[known["kind"]](**known["values"]))
    edges = [
        None if degree is None else Rail(degree, *(entries[f"edge {i} {j}"] for j in range(3)))
        for i, degree in enumerate(document["edges"])
    ]
    vectors = ("centre", "anchor", "normal")
    faces = [FaceInfo(**(face | {name: tuple(face[name]) for name in vectors})) for face in document["faces"]]
    part = PartArrays(
        **{name: entries[name] for name in ARRAYS},
        **document["plain"],
        faces=tuple(faces),
        source=source,
        surfaces=tuple(surfaces),
        edges=tuple(edges),
    )
    return replace(part, notes=tuple(part.notes))
