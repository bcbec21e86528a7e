"""The time that the estimate states for posted programs, beside that of LinuxCNC's own trajectory planner; as a table.

Run: ``python bench/linuxcnc_time.py [--set check] [NAME ...]``, or ``--corners``. LinuxCNC runs without a display in the root
file system of the tests' oracles, as a simulation whose clock is faster than the real one; what it takes is counted in servo
cycles, from the place on that is known in all axes. Waits for tool changes and for the interpreter are not counted.
"""

from __future__ import annotations

import argparse
import dataclasses
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import styluscam as sc

HERE = Path(__file__).resolve().parent
FIXTURES = HERE.parent / "fixtures"
SIMULATION = HERE / "linuxcnc"
sys.path.insert(0, str(HERE.parent / "tests" / "oracles"))

import roots  # noqa: E402 - the LinuxCNC that the tests use

ROOT = "trixie"
FASTER = 2
"""How much faster than the real one the simulation's clock is. At 10, on a computer with other work, LinuxCNC's interpreter does
not keep up with programs of more than 200 blocks in a second, and its planner waits: it takes 14 % longer then."""

JOINT = """\
TYPE = LINEAR
HOME = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
FERROR = 50
MIN_FERROR = 50
"""
"""An axis that is where it is asked to be, and at home where it stands."""

CLEARANCE = {"clearance": 5.0, "retract": 1.0}


@dataclasses.dataclass(frozen=True)
class Case:
    """A part with one operation, and the machine that it is for."""

    part: str
    operation: dict[str, Any]
    tool: dict[str, Any]
    feed: float
    tolerance: float = 0.01
    """Of the machine's blending, mm."""
    acceleration: float = 500.0
    rapid_rate: float = 6000.0
    axes: dict[str, list[float]] = dataclasses.field(default_factory=dict)
    """Limits of the single axes."""

    @property
    def machine(self) -> sc.Machine:
        """The machine."""
        each = {"axis_rate": [self.rapid_rate] * 3, "axis_acceleration": [self.acceleration] * 3, **self.axes}
        limits = {"rapid_rate": self.rapid_rate, "acceleration": self.acceleration, **each}
        file = {"schema": 1, "extends": "linuxcnc", "name": "linuxcnc-timed", "limits": limits}
        return sc.Machine.of({**file, "smoothing": {"tolerance": self.tolerance}})

    def text(self) -> str:
        """The posted program."""
        operation = {"tool": "a", "feeds": {"cut": self.feed, "plunge": 0.5 * self.feed}, **self.operation}
        spindle = {"mode": "fixed", "rpm": 3000.0}
        job = {
            "schema": 1,
            "part": {"file": str(FIXTURES / self.part), "faces": "all"},
            "setup": {"up": "+z", "zero": "model", **CLEARANCE},
            "process": {"kind": "milling"},
            "tools": {"a": {"number": 1, "profile": self.tool}},
            "operations": [{"spindle": spindle, **operation}],
            "machine": {"name": "linuxcnc"},
            "output": {"file": "out.ngc"},
        }
        return sc.post(sc.plan(job), self.machine).text


def ball(diameter: float) -> dict[str, Any]:
    """A ball end mill."""
    return {"kind": "ball", "diameter": diameter}


def flat(diameter: float) -> dict[str, Any]:
    """A flat end mill."""
    return {"kind": "flat", "diameter": diameter}


Z = {"kind": "z-level", "tolerance": 0.005}
ROWS = {"kind": "zig-zag", "tolerance": 0.005}
TURNS = {"kind": "spiral", "tolerance": 0.005}
ROUGH = {"kind": "pocket"}
ARCS = {"fit": "arcs"}
SLOW_Z = {"axis_rate": [6000.0, 6000.0, 1800.0], "axis_acceleration": [500.0, 500.0, 200.0]}

CASES: dict[str, dict[str, Case]] = {
    "main": {
        "cone-levels": Case("cone_cup.step", {**Z, "step": {"height": 2.0}}, ball(8.0), 3000.0),
        "cone-spiral": Case("cone_cup.step", {**TURNS, "step": {"height": 2.0}}, ball(8.0), 3000.0, 0.001),
        "cone-rows": Case("cone_cup.step", {**ROWS, "stepover": 4.0}, ball(8.0), 3000.0, 0.02),
        "pyramid-levels": Case("pyramid.step", {**Z, "step": {"height": 3.0}}, ball(8.0), 3000.0, 0.001),
        "pyramid-rows": Case("pyramid.step", {**ROWS, "stepover": 4.0, "turns": "rounded"}, ball(8.0), 2400.0),
        "cap-rows": Case("cap_r60.step", {**ROWS, "stepover": 5.0, "angle_deg": 30.0}, ball(10.0), 3000.0, 0.005),
        "cap-spiral": Case("cap_r60.step", {**TURNS, "step": {"height": 1.5}}, ball(10.0), 3600.0),
        "freeform-rows": Case("matrix/freeform.step", {**ROWS, "stepover": 3.0}, ball(6.0), 3000.0, 0.01, 1000.0),
        "tray-pocket": Case("matrix/tray.step", {**ROUGH, "step": {"height": 10.0}}, flat(8.0), 2400.0),
        "cups-pocket": Case("matrix/two_cups.step", {**ROUGH, "step": {"height": 10.0}}, flat(8.0), 3000.0, 0.02),
    },
    "check": {
        "ellipse-levels": Case("matrix/ellipse.step", {**Z, "step": {"height": 2.0}}, ball(6.0), 3000.0, 0.005),
        "ellipse-rows": Case("matrix/ellipse.step", {**ROWS, "stepover": 3.0, "angle_deg": 45.0}, ball(6.0), 2400.0),
        "freeform-levels": Case("matrix/freeform.step", {**Z, "step": {"height": 1.5}}, ball(6.0), 3600.0, 0.02, 800.0),
        "frustum-spiral": Case("matrix/frustum_male.step", {**TURNS, "step": {"height": 2.0}}, ball(6.0), 3000.0, 0.05),
        "cone-pocket": Case("cone_cup.step", {**ROUGH, "step": {"height": 10.0}}, flat(6.0), 3000.0, 0.01),
    },
    "arcs": {
        "vwaf-rows": Case(
            "vwaf.step", {**ROWS, **ARCS, "stepover": 12.0}, ball(16.0), 6000.0, 0.01, 500.0, axes=SLOW_Z
        ),
        "cone-arcs": Case("cone_cup.step", {**Z, **ARCS, "step": {"height": 4.0}}, ball(8.0), 3600.0, 0.02),
        "tray-arcs": Case("matrix/tray.step", {**ROUGH, **ARCS, "step": {"height": 10.0}}, flat(6.0), 2400.0, 0.005),
        "cap-levels": Case("cap_r60.step", {**Z, **ARCS, "step": {"height": 4.0}}, ball(6.0), 4800.0, 0.01, 900.0),
        "cups-rows": Case("matrix/two_cups.step", {**ROWS, "stepover": 2.5}, ball(5.0), 3600.0, 0.01, axes=SLOW_Z),
    },
}
"""Programs by set: those that the model was looked at with, and two that it is checked by."""


def ini(case: Case) -> str:
    """The simulation's settings for a machine."""
    template = (SIMULATION / "sim.ini").read_text(encoding="utf-8")
    speeds = [rate / 60.0 for rate in case.axes.get("axis_rate", [case.rapid_rate] * 3)]
    accelerations = case.axes.get("axis_acceleration", [case.acceleration] * 3)
    speed, acceleration = case.rapid_rate / 60.0, case.acceleration
    text = template.replace("@SPEED@", f"{speed:.6f}").replace("@ACCELERATION@", f"{acceleration:.6f}")
    for joint, (axis, fastest, most) in enumerate(zip("XYZ", speeds, accelerations, strict=True)):
        limits = f"MIN_LIMIT = -5000\nMAX_LIMIT = 5000\nMAX_VELOCITY = {fastest:.6f}\nMAX_ACCELERATION = {most:.6f}\n"
        text += f"[AXIS_{axis}]\n{limits}[JOINT_{joint}]\n{JOINT}{limits}"
    return text


def simulate(case: Case, text: str, keep: Path | None = None) -> np.ndarray:
    """Line, speed and distance to go, mm and s, of each servo cycle (N, 3) that LinuxCNC takes for a program."""
    with tempfile.TemporaryDirectory(prefix="linuxcnc-time-") as name:
        folder = Path(name)
        for file in SIMULATION.iterdir():
            if file.is_file():
                (folder / file.name).write_bytes(file.read_bytes())
                (folder / file.name).chmod(0o755)
        (folder / "sim.ini").write_text(ini(case), encoding="utf-8")
        (folder / "job.ngc").write_text(text, encoding="utf-8")
        (folder / "sim.var").touch()
        (folder / "tool.tbl").write_text("T1 P1 Z50\nT2 P2 Z50\n")
        library = folder / "clock.so"
        subprocess.run(
            ["cc", "-O2", "-shared", "-fPIC", "-o", str(library), str(folder / "clock.c"), "-ldl"], check=True
        )
        environment = {
            "CLOCK_FACTOR": str(FASTER),
            "LD_PRELOAD": "/job/clock.so",
            "RTAPI_UID": "1000",
            "RTAPI_FIFO_PATH": "/tmp/rtapi_fifo",
        }
        done = roots.run(
            ROOT,
            ["unshare", "--ipc", "linuxcnc", "-r", "/job/sim.ini"],
            binds=[roots.Bind(folder, "/job", writable=True)],
            cwd="/job",
            env=environment,
            timeout=600.0,
        )
        trace = folder / "trace.txt"
        if not trace.exists() or "overruns 0" not in done.stdout:
            raise RuntimeError(f"LinuxCNC did not run: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        if keep is not None:
            keep.with_suffix(".trace").write_bytes(trace.read_bytes())
        return np.loadtxt(trace)


def measured(trace: np.ndarray, first: int) -> float:
    """Seconds in motion after line `first` was reached, in cycles of 1 ms."""
    return float(np.count_nonzero((trace[:, 1] > 0.0) & (trace[:, 0] > first))) * 1e-3


def first_line(text: str) -> int:
    """The line after which the tool's place is known in all axes: the way there is not estimated."""
    unknown = set("XYZ")
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("(")[0].split()
        unknown -= {word[0] for word in words}
        if not unknown:
            return number
    raise ValueError("the program does not move in all axes")


TURNS_DEG = (10, 20, 30, 45, 60, 75, 90, 120, 150)
CHAINS = ((0.01, 20.0), (0.05, 20.0), (0.01, 1.0), (0.01, 0.3), (0.05, 0.3), (0.001, 0.3))
"""Tolerance of the blending and length of the lines, mm."""


def chains(length: float) -> str:
    """A program of chains of nine lines that turn left and right by the same angle, with a pause before and behind each."""
    text = ["G21 G90 G17 G40 G49 G80 G94", "G64 P@TOLERANCE@ Q0", "G0 X0 Y0 Z0"]
    for angle in TURNS_DEG:
        headings = np.radians(angle) * (np.arange(9) % 2)
        positions = np.cumsum(length * np.column_stack([np.cos(headings), np.sin(headings)]), axis=0)
        text += ["G4 P0.01", *(f"G1 X{x:.4f} Y{y:.4f} F3000" for x, y in positions), "G4 P0.01", "G0 X0 Y0"]
    return "\n".join([*text, "M2", ""])


def corners() -> None:
    """Prints the time of the five lines in the middle of each chain."""
    print(f"{'tolerance':>9} {'length':>6} {'turn deg':>8} {'LinuxCNC ms':>11} {'estimate ms':>11}")
    for tolerance, length in CHAINS:
        case = Case("", {}, {}, 3000.0, tolerance)
        text = chains(length).replace("@TOLERANCE@", str(tolerance))
        trace = simulate(case, text)
        cycles = np.bincount(trace[trace[:, 1] > 0.0, 0].astype(int), minlength=len(text.splitlines()) + 1)
        times = np.diff(sc.read_gcode(text, case.machine).engine.times(case.machine.engine)[0], prepend=0.0)
        moves = [number for number, line in enumerate(text.splitlines(), 1) if line.startswith(("G0 ", "G1 "))]
        for index, angle in enumerate(TURNS_DEG):
            first = 1 + 10 * index + 2
            lines = moves[first : first + 5]
            print(
                f"{tolerance:9} {length:6} {angle:8} {cycles[lines].sum():11} {1000.0 * times[first : first + 5].sum():11.1f}"
            )


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--corners", action="store_true", help="corners of one angle each instead of posted programs")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--set", choices=sorted(CASES), default="main")
    parser.add_argument("--keep", type=Path, help="folder for programs and traces")
    options = parser.parse_args()
    if options.corners:
        corners()
        return
    print(f"{'program':16} {'blocks':>7} {'LinuxCNC s':>10} {'estimate s':>10} {'off %':>6}")
    for name, case in CASES[options.set].items():
        if options.names and name not in options.names:
            continue
        text = case.text()
        keep = None if options.keep is None else options.keep / name
        if keep is not None:
            keep.with_suffix(".ngc").write_text(text, encoding="utf-8")
        machine = case.machine
        program = sc.read_gcode(text, machine)
        estimate = program.engine.times(machine.engine)[1]
        seconds = measured(simulate(case, text, keep), first_line(text))
        off = 100.0 * (estimate / seconds - 1.0)
        print(f"{name:16} {program.engine.move_count:7} {seconds:10.2f} {estimate:10.2f} {off:6.1f}", flush=True)


if __name__ == "__main__":
    main()
