"""LinuxCNC's display in the simulation: turns the machine on, runs job.ngc and writes what it does in each servo cycle."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import linuxcnc  # of the root file system

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def hal(*words: str) -> str:
    """What a command to the hardware layer answers."""
    return subprocess.run(["halcmd", *words], check=True, capture_output=True, text=True).stdout.strip()


def until(what: str, do: Callable[[], object], holds: Callable[[], bool]) -> None:
    """Repeats a command until it has had its effect."""
    for _ in range(40):
        do()
        command.wait_complete(1)
        time.sleep(0.1)
        status.poll()
        if holds():
            return
    sys.exit(f"LinuxCNC does not {what}: {errors.poll()}")


def main() -> None:
    """Runs the program."""
    until("leave emergency stop", lambda: command.state(linuxcnc.STATE_ESTOP_RESET), lambda: not status.estop)
    until("turn on", lambda: command.state(linuxcnc.STATE_ON), lambda: status.task_state == linuxcnc.STATE_ON)
    until("home", lambda: command.home(-1), lambda: all(status.homed[:3]))
    until("change its mode", lambda: command.mode(linuxcnc.MODE_AUTO), lambda: status.task_mode == linuxcnc.MODE_AUTO)
    command.program_open("job.ngc")
    command.wait_complete()
    with Path("trace.txt").open("w") as trace:
        sampler = subprocess.Popen(["halsampler", "-c", "0"], stdout=trace)
        time.sleep(1.0)
        hal("setp", "sampler.0.enable", "1")
        command.auto(linuxcnc.AUTO_RUN, 0)
        time.sleep(1.0)
        while True:
            status.poll()
            error = errors.poll()
            if error:
                sys.exit(f"LinuxCNC: {error}")
            if status.interp_state == linuxcnc.INTERP_IDLE:
                break
            time.sleep(0.1)
        hal("setp", "sampler.0.enable", "0")
        time.sleep(2.0)
        sampler.terminate()
        sampler.wait()
    print("overruns", hal("getp", "sampler.0.overruns"))


main()
