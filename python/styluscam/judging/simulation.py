"""The material as a verified program leaves it: heights over the plan, as a mesh, and compared with the part."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from styluscam import _engine
from styluscam.arguments import A_FILE, FileName, file_of, number_of, refused
from styluscam.errors import GeometryError, VerifyError
from styluscam.files import require_writable
from styluscam.judging.verification import Report
from styluscam.parts.meshfile import write_triangles, writer
from styluscam.types import Document, FloatArray, IntArray, Progress

FINE, NODES = 0.05, 200.0 * 200.0 / 0.05**2
"""mm: the spacing unless another is given, and how many nodes there are then at most."""

UNTOUCHED = 1e-9
"""A node that was lowered by less (mm) was not cut."""


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """The simulated surface against the part, node by node. Lengths mm."""

    distances: FloatArray
    """Signed distance of every node to the part, (rows along Y, columns along X): negative where it lies below the part's
    upper surface (gouged), positive where it lies above it or beside the part (left)."""
    touched: npt.NDArray[np.bool_]
    """Nodes that the program lowered, of the same shape."""
    points: FloatArray
    """The nodes with their heights in work coordinates, (rows, columns, 3)."""

    @property
    def gouge_max(self) -> float:
        """Deepest entry into the part, mm; 0 where there is none."""
        return max(0.0, -float(self.distances.min()))

    @property
    def gouge_at(self) -> tuple[float, float, float] | None:
        """Where that is; None where nothing is gouged."""
        return self._place(int(self.distances.argmin())) if self.gouge_max > 0.0 else None

    @property
    def left_max(self) -> float:
        """Most that is left where the program cut, mm; 0 where it cut nothing."""
        return max(0.0, float(self.distances[self.touched].max(initial=0.0)))

    @property
    def left_at(self) -> tuple[float, float, float] | None:
        """Where that is; None where nothing is left."""
        cut = np.where(self.touched, self.distances, -np.inf)
        return self._place(int(cut.argmax())) if self.left_max > 0.0 else None

    def share_within(self, tolerance: float) -> float:
        """Share of the nodes that the program cut that lie within ``tolerance`` (mm) of the part; 1 where it cut none."""
        tolerance = number_of(tolerance, "tolerance")
        cut = self.distances[self.touched]
        return float((np.abs(cut) <= tolerance).mean()) if len(cut) else 1.0

    def to_dict(self) -> Document:
        """The figures as plain data: gouge_max, gouge_at, left_max, left_at, touched (share of the nodes)."""
        return {
            "gouge_max": self.gouge_max,
            "gouge_at": self.gouge_at,
            "left_max": self.left_max,
            "left_at": self.left_at,
            "touched": float(self.touched.mean()),
        }

    def __repr__(self) -> str:
        """The figures."""
        return f"<Comparison: gouged {self.gouge_max:.4f} mm, left {self.left_max:.4f} mm at most>"

    def __eq__(self, other: object) -> bool:
        """Whether all nodes are the same."""
        if not isinstance(other, Comparison):
            return NotImplemented
        return all(np.array_equal(mine, vars(other)[name]) for name, mine in vars(self).items())

    __hash__ = None  # type: ignore[assignment]  # arrays can be written to

    def _place(self, index: int) -> tuple[float, float, float]:
        x, y, z = self.points.reshape(-1, 3)[index]
        return float(x), float(y), float(z)


class Simulation:
    """The stock, or the sheet, after every move of a program; :func:`simulate` makes it. Work coordinates, mm."""

    def __init__(self, engine: _engine.Simulation, report: Report, face: str | None) -> None:
        self.engine = engine
        self.heights: FloatArray = engine.heights
        """Height of the surface at every node, exact there: (rows along Y, columns along X)."""
        self._report, self._face = report, face

    @property
    def _scene(self) -> _engine.Scene:
        return self._report.scene

    def __repr__(self) -> str:
        """How many nodes, how far apart, and between which heights."""
        rows, columns = self.heights.shape
        apart = max(self.engine.step)
        heights = f"Z {self.heights.min():.3f} to {self.heights.max():.3f}"
        return f"<Simulation: {columns} x {rows} nodes, {apart:.4g} mm apart, {heights}>"

    def __eq__(self, other: object) -> bool:
        """Whether all nodes are the same."""
        if not isinstance(other, Simulation):
            return NotImplemented
        mine, theirs = ((one.engine.origin, one.engine.step, one.engine.top, one._face) for one in (self, other))
        same = mine == theirs and np.array_equal(self.heights, other.heights)
        return same and np.array_equal(self.before, other.before)

    __hash__ = None  # type: ignore[assignment]  # arrays can be written to

    def __getstate__(self) -> Document:
        """For pickle and copy."""
        engine = (self.engine.origin, self.engine.step, self.engine.heights, self.engine.top, self.engine.before)
        return {**vars(self), "engine": engine}

    def __setstate__(self, state: Document) -> None:
        """From :meth:`__getstate__`."""
        vars(self).update(state, engine=_engine.Simulation(*state["engine"]))

    @property
    def x(self) -> FloatArray:
        """X of the columns."""
        return np.asarray(self.engine.origin[0] + self.engine.step[0] * np.arange(self.heights.shape[1]))

    @property
    def y(self) -> FloatArray:
        """Y of the rows."""
        return np.asarray(self.engine.origin[1] + self.engine.step[1] * np.arange(self.heights.shape[0]))

    @property
    def points(self) -> FloatArray:
        """The nodes with their heights, (rows, columns, 3)."""
        x, y = np.meshgrid(self.x, self.y)
        return np.stack([x, y, self.heights], axis=-1)

    @property
    def before(self) -> FloatArray:
        """Height before any move: of every node, (rows, columns), of stock that is a body or cut before; else of all, ()."""
        levels = self.engine.before
        return np.asarray(self.engine.top if levels is None else levels)

    @property
    def touched(self) -> npt.NDArray[np.bool_]:
        """Nodes that the program lowered, (rows, columns)."""
        return np.asarray(self.heights < self.before - UNTOUCHED)

    def mesh(self, tolerance: float = 0.005) -> tuple[FloatArray, IntArray]:
        """Vertices (V, 3) and triangles (T, 3), counterclockwise from outside: many where the surface bends, few where not.

        No node is off the triangles by more than ``tolerance`` (mm). Of stock it is the closed body down to the underside
        of the part's box, of a sheet the face that was followed.

        Raises:
            GeometryError: a tolerance below 0.
        """
        tolerance = number_of(tolerance, "tolerance")
        if not tolerance >= 0.0:
            message = f"tolerance = {tolerance:g}: 0 or more mm expected"
            raise GeometryError(message, code="out-of-range", where="tolerance", hint="0.005 keeps scallops visible")
        floor = None if self._face else self._scene.bounds[0][2]
        return self.engine.mesh(tolerance, floor)

    def save(self, path: FileName, tolerance: float = 0.005) -> None:
        """Writes :meth:`mesh` as ``.stl`` or ``.ply`` (extra ``mesh``).

        Raises:
            StylusError: another ending, or a path that cannot be written to.
        """
        file = file_of(path, "path", A_FILE, GeometryError)
        require(file)
        write_triangles(file, *self.mesh(tolerance))

    def compare(self, *, progress: Progress | None = None, cancel: _engine.CancelToken | None = None) -> Comparison:
        """Signed distances of the nodes to the part: what is left on it, what was taken out of it.

        Raises:
            GeometryError: another face of the sheet was followed than the one that the part is.
        """
        if self._face and self._face != self._scene.model_face:
            message = f"the {self._face} face was followed, the part is the sheet's {self._scene.model_face} face"
            hint = "simulate without face="
            raise GeometryError(message, code="another-face", where="face", hint=hint)
        distances = self.engine.distances(self._scene, progress=progress, cancel=cancel)
        return Comparison(distances, self.touched, self.points)


def simulate(
    report: Report,
    spacing: float | None = None,
    *,
    face: str | None = None,
    progress: Progress | None = None,
    cancel: _engine.CancelToken | None = None,
) -> Simulation:
    """What every move of a verified program, rapids as straight lines, makes of the stock; nodes at most ``spacing`` (mm) apart.

    Without one they are 0.05 mm apart, on parts larger than 200 x 200 mm as much farther as keeps their number.

    Milling begins with the job's stock. The tool's profile cuts as it passes, exactly at the nodes; shank and holder do not.
    A sheet begins flat and follows the tool: the face that the tool touches is the lowest that the tool was, ``face``
    ("tool", "mid", "back"; the part's if None) its offset by the sheet's law. That is kinematics: nothing springs back or
    wrinkles, and where the tool was not the sheet stays as flat as it was, also within a formed loop.

    Raises:
        GeometryError: a spacing that is no length or asks for more than forty million nodes, a face that does not exist.
    """
    if not isinstance(report, Report):
        raise refused(
            "report", report, "the Report of a verified program", VerifyError, "sc.verify(text, job) makes one"
        )
    job, scene = report.job, report.scene
    if spacing is None:
        low, high = np.array(scene.bounds)
        spacing = max(FINE, float(np.sqrt((high - low)[:2].prod() / NODES)))
    spacing = number_of(spacing, "spacing")
    if face is not None and not isinstance(face, str):
        raise refused("face", face, '"tool", "mid" or "back"', GeometryError)
    engine = report.judgement.simulate(job.engine, scene, spacing, face, progress=progress, cancel=cancel)
    return Simulation(engine, report, (face or scene.model_face) if scene.model_face else None)


def require(file: Path, inputs: Iterable[Path] = ()) -> None:
    """Asks before long work whether a simulation can be written there.

    Raises:
        StylusError: another ending than ``.stl`` and ``.ply``, trimesh is missing, a path that cannot be written to, or
            one of ``inputs``.
    """
    if file.suffix.lower() not in (".stl", ".ply"):
        message = f"{file}: a simulation is written as .stl or .ply"
        raise GeometryError(message, code="ending-unknown", where=str(file), hint=".stl or .ply")
    writer(file)
    require_writable([file], inputs)
