"""Types of the Rust engine."""

from collections.abc import Callable
from typing import final

import numpy as np
import numpy.typing as npt

_F = npt.NDArray[np.float64]
_I = npt.NDArray[np.int64]
_Progress = Callable[[str, float], bool | None]

__all__ = [
    "CancelToken",
    "FootSearch",
    "Job",
    "Judgement",
    "Machine",
    "Nurbs",
    "Part",
    "Plan",
    "Program",
    "Scene",
    "Simulation",
    "Tool",
    "__version__",
    "cl_text",
    "drop_cutter",
    "job_schema",
    "judge",
    "lines_of_moves",
    "machine_options",
    "machine_schema",
    "materials",
    "mended",
    "offset_surface",
    "plan",
    "post",
    "post_to",
    "program_of_path",
    "push_cutter",
    "read_back",
    "read_gcode",
    "read_to_post",
    "sheet_raise",
    "shipped_machines",
    "slope_matched_offset",
    "starter",
    "template_names",
    "trace_gcode",
    "waterlines",
]
__version__: str

@final
class CancelToken:
    def __new__(cls) -> CancelToken: ...
    def cancel(self) -> None: ...
    @property
    def cancelled(self) -> bool: ...

@final
class Tool:
    def __new__(cls, document: str) -> Tool: ...
    def to_json(self) -> str: ...
    def report(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def max_slope(self) -> float: ...
    @property
    def diameter(self) -> float: ...
    def radius_at(self, slope: _F) -> _F: ...
    def radius_range_at(self, slope: _F) -> tuple[_F, _F]: ...
    def height_at(self, slope: _F) -> _F: ...
    def curvature_radius_at(self, slope: _F) -> _F: ...
    def height_at_radius(self, radius: _F) -> _F: ...

@final
class Part:
    def __new__(
        cls,
        vertices: _F,
        triangles: _I,
        face_ids: _I | None = None,
        inward: float = 0.0,
        outward: float = 0.0,
        normals: _F | None = None,
    ) -> Part: ...
    @property
    def bounds(self) -> tuple[list[float], list[float]]: ...
    @property
    def deviation(self) -> tuple[float, float]: ...
    def arrays(self) -> tuple[_F, _I, _I, _F | None]: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def dropped(self) -> int: ...

@final
class Program:
    @staticmethod
    def from_json(text: str) -> Program: ...
    def to_json(self) -> str: ...
    def columns(
        self,
    ) -> tuple[
        npt.NDArray[np.uint8],
        _F,
        _F,
        npt.NDArray[np.uint8],
        npt.NDArray[np.uint32],
        _F,
        npt.NDArray[np.uint32],
        npt.NDArray[np.uint32],
    ]: ...
    @property
    def move_count(self) -> int: ...
    def polyline(self, sag: float) -> tuple[_F, npt.NDArray[np.uint32]]: ...
    def times(self, machine: Machine) -> tuple[_F, float]: ...
    def records(self) -> str: ...
    def with_notes(self, notes: list[str]) -> Program: ...
    def restarted(self, first: int) -> Program | None: ...
    def level_start(self, operation: int, level: int) -> int | None: ...
    def raised(self, by: float) -> Program: ...
    def with_optional_stops(self) -> Program: ...
    def paired(self, other: Program) -> tuple[Program, Program] | None: ...
    def same_moves(self, other: Program) -> bool: ...
    def statistics(self, rapid_rate: float = 3000.0) -> tuple[float, float]: ...

@final
class Job:
    @staticmethod
    def from_toml(text: str) -> Job: ...
    @staticmethod
    def from_json(text: str) -> Job: ...
    def to_json(self) -> str: ...

@final
class Machine:
    @staticmethod
    def shipped(name: str) -> Machine: ...
    @staticmethod
    def from_toml(text: str, folder: str | None = None) -> Machine: ...
    @staticmethod
    def from_json(text: str, folder: str) -> Machine: ...
    def to_toml(self) -> str: ...
    def to_json(self) -> str: ...
    def with_options(self, options: str) -> Machine: ...
    def check(self) -> list[tuple[str, str, str, str, str, str, str, str]]: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def resolution_mm(self) -> float: ...

@final
class Scene:
    def __new__(cls, job: Job, part: Part) -> Scene: ...
    @property
    def frame(self) -> list[list[float]]: ...
    @property
    def bounds(self) -> tuple[list[float], list[float]]: ...
    def fixture(self, job: Job) -> list[tuple[str, list[list[float]], list[float]]]: ...
    @property
    def fitting_radius(self) -> float | None: ...
    @property
    def model_face(self) -> str | None: ...

@final
class Plan:
    @property
    def program(self) -> Program: ...
    def summary(self, scene: Scene, machine: Machine, judgement: Judgement | None = None) -> tuple[str, list[str]]: ...

@final
class Judgement:
    def report(self) -> str: ...
    def coverage(
        self, job: Job, scene: Scene, progress: _Progress | None = None, cancel: CancelToken | None = None
    ) -> str: ...
    def left(
        self, job: Job, scene: Scene, points: _F, progress: _Progress | None = None, cancel: CancelToken | None = None
    ) -> _F: ...
    def needs(
        self,
        job: Job,
        scene: Scene,
        points: _F,
        normals: _F,
        progress: _Progress | None = None,
        cancel: CancelToken | None = None,
    ) -> npt.NDArray[np.uint8]: ...
    def simulate(
        self,
        job: Job,
        scene: Scene,
        spacing: float,
        face: str | None = None,
        progress: _Progress | None = None,
        cancel: CancelToken | None = None,
    ) -> Simulation: ...
    @property
    def program(self) -> Program: ...

@final
class Simulation:
    def __new__(cls, origin: list[float], step: list[float], heights: _F, top: float) -> Simulation: ...
    @property
    def origin(self) -> list[float]: ...
    @property
    def step(self) -> list[float]: ...
    @property
    def heights(self) -> _F: ...
    @property
    def top(self) -> float: ...
    def mesh(self, tolerance: float, floor: float | None = None) -> tuple[_F, npt.NDArray[np.int64]]: ...
    def distances(self, scene: Scene, progress: _Progress | None = None, cancel: CancelToken | None = None) -> _F: ...

def mended(points: _F, triangles: _I) -> tuple[_F, _I, _I, str]: ...
def slope_matched_offset(
    tool: Tool, points: _F, normals: _F, sheet: str | None = None
) -> tuple[_F, npt.NDArray[np.uint8]]: ...
def sheet_raise(sheet: str) -> float: ...
def drop_cutter(
    part: Part,
    tool: Tool,
    xy: _F,
    sheet: str | None = None,
    floor: float | None = None,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> _F: ...
def push_cutter(
    part: Part,
    tool: Tool,
    xy: _F,
    directions: _F,
    z: float,
    sheet: str | None = None,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> _F: ...
def offset_surface(
    part: Part,
    tool: Tool,
    sheet: str | None = None,
    tolerance: float = 0.005,
    faces: list[int] | None = None,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> tuple[
    tuple[_F, _F, _F, _F, npt.NDArray[np.uint8], _F, _F, _I],
    tuple[_I, _I, float],
    list[tuple[int, str, float, float, list[float], list[float]]],
]: ...
def waterlines(
    part: Part,
    tool: Tool,
    heights: list[float],
    sheet: str | None = None,
    tolerance: float = 0.005,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> list[list[_F]]: ...
def plan(
    job: Job,
    scene: Scene,
    machine: Machine,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> Plan: ...
def post(program: Program, machine: Machine) -> str: ...
def post_to(program: Program, machine: Machine, path: str) -> None: ...
def cl_text(program: Program) -> str: ...
def lines_of_moves(program: Program, machine: Machine) -> list[int]: ...
def machine_options() -> list[tuple[str, str]]: ...
def machine_schema() -> str: ...
def template_names() -> tuple[list[tuple[str, str]], list[tuple[str, str, str]]]: ...
def program_of_path(sections: list[tuple[str, str | None, str, str]], tools: str, setup: str) -> Program: ...
def read_to_post(text: str, machine: Machine, target: Machine) -> Program: ...
def read_gcode(text: str, machine: Machine) -> Program: ...
def trace_gcode(
    text: str,
    find: Callable[[str], str | None],
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> tuple[Program, list[str]]: ...
def read_back(job: Job, machine: Machine, text: str) -> Program: ...
def judge(
    job: Job,
    scene: Scene,
    machine: Machine,
    text: str,
    progress: _Progress | None = None,
    cancel: CancelToken | None = None,
) -> Judgement: ...
def job_schema() -> str: ...
def materials() -> str: ...
def starter(
    part: Part,
    file: str,
    faces: list[tuple[str, str, float, tuple[float, float]]],
    units: str | None = None,
    edge_gap: float = 0.0,
) -> tuple[str, list[str]]: ...
def shipped_machines() -> list[str]: ...

@final
class Nurbs:
    def __new__(
        cls, degrees: tuple[int, int], knots_u: list[float], knots_v: list[float], poles: _F, weights: _F
    ) -> Nurbs: ...
    def __call__(self, parameters: _F) -> tuple[_F, _F, _F]: ...

@final
class FootSearch:
    def __new__(
        cls,
        limits: tuple[tuple[float, float], tuple[float, float]],
        periods: tuple[float | None, float | None],
        poles: list[tuple[int, float, float, _F, _F]],
        step: float,
    ) -> FootSearch: ...
    def feet(
        self, surface: Nurbs | Callable[[_F], tuple[_F, _F, _F]], points: _F, near: _F
    ) -> tuple[_F, tuple[_F, _F, _F]]: ...
