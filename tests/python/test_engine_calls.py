"""Long calls: the same bytes for any number of threads, progress, cancelling from everywhere, Ctrl-C, the free GIL."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Floats, job_document, made_part
from numpy.typing import NDArray

import styluscam as sc

STOP = 0.5
"""Long work stops within this of a cancel: processor time of all threads, s, which other work on the machine hardly
changes."""
PREPARED = 2.0
"""What it takes at most to look at the part before planning begins, which a cancel waits for: processor time, s."""
BALL = {"kind": "ball", "diameter": 6.0}
TOOL = {"profile": BALL}


@pytest.fixture(scope="module")
def wide_part() -> sc.Part:
    """A plate of 20 x 20 cells with pits and bumps."""
    rng = np.random.default_rng(6)
    return sc.Part.from_mesh(*made_part(20, rng.uniform(1.2, 2.0, 400), rng.uniform(-0.2, 0.2, (400, 2)), 2.0, 60.0))


@pytest.fixture(scope="module")
def many() -> Floats:
    """Positions for some tens of seconds of work."""
    return np.random.default_rng(7).uniform(5.0, 115.0, (20_000_000, 2))


# --- the same bytes ---------------------------------------------------------------------------------------------

PLAN = """
import hashlib, json, sys
import numpy as np
import styluscam as sc
from styluscam import _engine
arrays = np.load(sys.argv[1])
part = sc.Part(_engine.Part(arrays["vertices"], arrays["triangles"], arrays["faces"], 0.0005, 0.001))
for document in json.loads(sys.argv[2]):
    plan = sc.plan(sc.Job.from_dict(document, part=part))
    program = plan.engine.programs["main"].to_json()
    for text in (program, sc.post(plan).text):
        print(len(text), hashlib.sha256(text.encode()).hexdigest())
tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0}})
points = np.random.default_rng(8).uniform(-60.0, 60.0, (20000, 2))
print(hashlib.sha256(sc.drop_cutter(part, tool, points).tobytes()).hexdigest())
loops = sc.waterline(part, tool, -8.0)
print(len(loops), hashlib.sha256(b"".join(loop.tobytes() for loop in loops)).hexdigest())
"""


def test_any_number_of_threads_gives_the_same_bytes(tmp_path: Path, part_of: Callable[[str], sc.Part]) -> None:
    import json

    arrays = part_of("cone_cup").arrays
    assert arrays is not None
    np.savez(tmp_path / "part.npz", vertices=arrays.vertices, triangles=arrays.triangles, faces=arrays.face_ids)
    clothoid = {"kind": "clothoid", "diameter": 10.0}
    documents = json.dumps([job_document("cone_cup", kind, clothoid) for kind in ("z-level", "zig-zag")])

    def outcome(threads: int) -> str:
        return subprocess.run(
            [sys.executable, "-c", PLAN, tmp_path / "part.npz", documents],
            env={**os.environ, "RAYON_NUM_THREADS": str(threads)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout

    one = outcome(1)
    assert len(one.splitlines()) == 6
    assert int(one.splitlines()[-1].split()[0]) > 0
    assert int(one.split()[0]) > 100_000
    assert outcome(2) == one
    assert outcome(4) == one


# --- progress ---------------------------------------------------------------------------------------------------


def test_progress_comes_on_the_calling_thread_with_phases(part_of: Callable[[str], sc.Part]) -> None:
    calls: list[tuple[str, float, int, float]] = []

    def progress(phase: str, fraction: float) -> None:
        calls.append((phase, fraction, threading.get_ident(), time.monotonic()))

    document = job_document("vwaf", "z-level", BALL, step={"height": 0.5}, smallest_feature=0.3)
    sc.plan(sc.Job.from_dict(document, part=part_of("vwaf")), progress=progress)
    assert {thread for _, _, thread, _ in calls} == {threading.get_ident()}
    assert all(0.0 <= fraction <= 1.0 for _, fraction, _, _ in calls)
    phases = [phase for phase, *_ in calls]
    order = list(dict.fromkeys(phases))
    assert phases == sorted(phases, key=order.index)
    assert "levels" in order
    for phase in order:
        fractions = [fraction for name, fraction, _, _ in calls if name == phase]
        assert fractions == sorted(fractions)
    # at most 20 times a second
    assert len(calls) <= 20 * (calls[-1][3] - calls[0][3]) + 2


def test_false_cancels_and_anything_else_goes_on(wide_part: sc.Part, many: Floats) -> None:
    tool = sc.Tool.from_dict(TOOL)
    began = time.monotonic()
    with pytest.raises(sc.Cancelled) as caught:
        sc.drop_cutter(wide_part, tool, many, progress=lambda phase, fraction: False)
    assert time.monotonic() - began < 5.0
    assert caught.value.code == "cancelled"
    few = many[:2000]
    for answer in (None, True, 0, ""):
        found = sc.drop_cutter(wide_part, tool, few, progress=lambda phase, fraction, answer=answer: answer)
        assert len(found) == 2000


def test_an_exception_in_progress_comes_through(wide_part: sc.Part, many: Floats) -> None:
    class Mine(Exception):
        pass

    def progress(phase: str, fraction: float) -> None:
        raise Mine(phase)

    with pytest.raises(Mine, match="drop-cutter"):
        sc.drop_cutter(wide_part, sc.Tool.from_dict(TOOL), many, progress=progress)
    fine = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 0.2}})
    with pytest.raises(Mine):
        sc.waterline(wide_part, fine, 1.0, tolerance=1e-6, progress=progress)


# --- cancelling -------------------------------------------------------------------------------------------------


def stopped_after(work: Callable[[sc.CancelToken], object], wait: float = 0.3) -> float:
    """Processor time from a cancel on another thread, `wait` s into the work, to its end, s."""
    token = sc.CancelToken()
    asked: list[float] = []

    def stop() -> None:
        asked.append(time.process_time())
        token.cancel()

    timer = threading.Timer(wait, stop)
    timer.start()
    try:
        with pytest.raises(sc.Cancelled):
            work(token)
    finally:
        timer.cancel()
    assert token.cancelled
    return time.process_time() - asked[0]


def test_a_token_stops_drop_cutter(wide_part: sc.Part, many: Floats) -> None:
    tool = sc.Tool.from_dict(TOOL)
    assert stopped_after(lambda token: sc.drop_cutter(wide_part, tool, many, cancel=token)) < STOP


def test_a_token_stops_a_waterline(wide_part: sc.Part) -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 0.2}})
    assert stopped_after(lambda token: sc.waterline(wide_part, tool, 1.0, tolerance=1e-6, cancel=token)) < STOP


def test_a_token_stops_the_first_call_of_a_large_part() -> None:
    side = 1001
    x, y = np.meshgrid(np.linspace(0.0, 100.0, side), np.linspace(0.0, 100.0, side))
    vertices = np.stack([x, y, np.sin(x) * np.cos(y)], axis=-1).reshape(-1, 3)
    corner = np.arange(side * side).reshape(side, side)[:-1, :-1].reshape(-1)
    cells = [[corner, corner + 1, corner + side + 1], [corner, corner + side + 1, corner + side]]
    triangles = np.concatenate([np.stack(cell, axis=1) for cell in cells])
    tool = sc.Tool.from_dict(TOOL)
    part = sc.Part.from_mesh(vertices, triangles)
    assert stopped_after(lambda token: first_call(part, tool, token), 0.05) < STOP


def first_call(part: sc.Part, tool: sc.Tool, token: sc.CancelToken) -> None:
    sc.drop_cutter(part, tool, [[50.0, 50.0]], cancel=token)
    pytest.fail("it ended before it was cancelled")


@pytest.mark.parametrize("kind", ("z-level", "zig-zag"))
def test_a_token_stops_planning(kind: str, part_of: Callable[[str], sc.Part]) -> None:
    document = job_document("vwaf", kind, BALL, smallest_feature=0.1)
    document["operations"][0].update({"step": {"height": 0.01}} if kind == "z-level" else {"stepover": 0.01})
    job = sc.Job.from_dict(document, part=part_of("vwaf"))
    assert stopped_after(lambda token: sc.plan(job, cancel=token)) < PREPARED + STOP


def test_a_token_that_is_spent_stops_at_once(wide_part: sc.Part, many: Floats) -> None:
    token = sc.CancelToken()
    token.cancel()
    tool = sc.Tool.from_dict(TOOL)
    with pytest.raises(sc.Cancelled):
        sc.drop_cutter(wide_part, tool, many, cancel=token)
    with pytest.raises(sc.Cancelled):
        sc.waterline(wide_part, tool, 1.0, cancel=token)


INTERRUPTED = """
import os, signal, sys, threading, time
import numpy as np
import styluscam as sc
corners = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 1.0]]
part = sc.Part.from_mesh(corners, [[0, 1, 2]])
tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 6.0}})
points = np.random.default_rng(1).uniform(-1.0, 101.0, (40_000_000, 2))
asked = []
def interrupt():
    asked.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(0.3, interrupt).start()
try:
    sc.drop_cutter(part, tool, points)
except KeyboardInterrupt:
    print("interrupted", time.process_time() - asked[0])
"""


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or os.name == "nt", reason="needs POSIX signals")
def test_ctrl_c_interrupts() -> None:
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, check=False)
    word, seconds = done.stdout.split()
    assert word == "interrupted"
    assert float(seconds) < STOP


def test_other_threads_run_meanwhile(wide_part: sc.Part, many: Floats) -> None:
    counted, running = [0], threading.Event()

    def count() -> None:
        while not running.wait(0.001):
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    try:
        began = time.monotonic()
        sc.drop_cutter(wide_part, sc.Tool.from_dict(TOOL), many[:400_000])
        took = time.monotonic() - began
    finally:
        running.set()
        thread.join()
    # a held GIL lets the other thread run a few times only, whatever the work takes
    assert took > 0.05
    assert counted[0] > 20 * took


def test_calls_from_several_threads_do_not_disturb_each_other(wide_part: sc.Part, many: Floats) -> None:
    tool = sc.Tool.from_dict(TOOL)
    alone = sc.drop_cutter(wide_part, tool, many[:20_000])
    found: list[Any] = [None] * 4

    def work(n: int) -> None:
        found[n] = sc.drop_cutter(wide_part, tool, many[:20_000])

    threads = [threading.Thread(target=work, args=(n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((tips == alone).all() for tips in found)


def test_what_comes_in_need_not_be_contiguous_or_float(wide_part: sc.Part) -> None:
    tool = sc.Tool.from_dict(TOOL)
    points: NDArray[np.int64] = np.stack(np.meshgrid(np.arange(5, 60), np.arange(5, 60)), axis=-1).reshape(-1, 2)
    as_floats = sc.drop_cutter(wide_part, tool, np.ascontiguousarray(points, dtype=np.float64))
    assert (sc.drop_cutter(wide_part, tool, points) == as_floats).all()
    assert (sc.drop_cutter(wide_part, tool, np.asfortranarray(points)) == as_floats).all()
    # other positions, other neighbours to begin the search from: the same to rounding
    assert np.abs(sc.drop_cutter(wide_part, tool, points[::2]) - as_floats[::2]).max() < 1e-13
    assert (sc.drop_cutter(wide_part, tool, points.tolist()) == as_floats).all()
    # beside multiples of their size in memory, as `numpy.frombuffer` may leave them
    data = b"." + points.astype(np.float64).tobytes()
    beside = np.frombuffer(data, np.float64, points.size, 1).reshape(points.shape)
    assert not beside.flags.aligned
    assert (sc.drop_cutter(wide_part, tool, beside) == as_floats).all()
    slopes = np.frombuffer(b"." + np.linspace(0.0, 1.0, 9).tobytes(), np.float64, 9, 1)
    assert (tool.radius_at(slopes) == tool.radius_at(np.linspace(0.0, 1.0, 9))).all()
    records = np.zeros(9, [("slope", "<f8"), ("flag", "u1")])
    records["slope"] = slopes
    assert (tool._engine.radius_at(records["slope"]) == tool.radius_at(slopes)).all()
