"""A command in a process of its own: with a limit of time and memory, measured."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

MEMORY = 6 * 2**30
"""Address space, bytes: an engine that wants more is stopped instead of the machine."""


@dataclass(frozen=True)
class Ended:
    """How a command ended."""

    code: int
    """Exit code; negative: a signal."""
    out: str
    err: str
    seconds: float
    cpu: float
    peak_mb: float
    timed_out: bool


@dataclass(frozen=True)
class Limit:
    """Seconds that a command may take; on a machine that others use, `patience` times as many, and as many of its processors."""

    seconds: float
    patience: float = 1.0


class _Peak(threading.Thread):
    """Watches how much memory a process holds at most, of its own: what wait4 reports begins with its parent's."""

    def __init__(self, pid: int) -> None:
        super().__init__(daemon=True)
        self.status = Path(f"/proc/{pid}/status")
        self.megabytes = 0.0
        self.ended = threading.Event()

    def run(self) -> None:
        """Looks every hundredth of a second: the kernel keeps the highest."""
        while not self.ended.wait(0.01):
            try:
                lines = self.status.read_text().splitlines()
            except OSError:
                return
            highest = [line.split()[1] for line in lines if line.startswith("VmHWM")]
            self.megabytes = max([self.megabytes, *(int(kilobytes) / 1024 for kilobytes in highest)])


PROCESSORS = 1.5
"""How many of them a command keeps busy, about."""


def styluscam(words: list[str], folder: Path, limit: Limit) -> Ended:
    """Runs `styluscam WORDS` in a folder."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        process = subprocess.Popen(
            [sys.executable, "-m", "styluscam", *words],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            start_new_session=True,
            env={**os.environ, "COLUMNS": "400", "NO_COLOR": "1"},
        )
        resource.prlimit(process.pid, resource.RLIMIT_AS, (MEMORY, MEMORY))
        most = round(PROCESSORS * limit.seconds)
        resource.prlimit(process.pid, resource.RLIMIT_CPU, (most, most))
        stopped, peak = threading.Event(), _Peak(process.pid)
        peak.start()

        def stop() -> None:
            stopped.set()
            process.send_signal(signal.SIGKILL)

        timer = threading.Timer(limit.seconds * limit.patience, stop)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        peak.ended.set()
        seconds = time.monotonic() - start
        code = process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode("utf-8", "replace"))
    cpu = usage.ru_utime + usage.ru_stime
    late = stopped.is_set() or (code in (-signal.SIGKILL, -signal.SIGXCPU) and cpu > 0.95 * most)
    return Ended(code, texts[0], texts[1], seconds, cpu, peak.megabytes, late)
