"""What tests hand to worker processes: importable there whatever else is on the path, `conftest` for one."""

from __future__ import annotations

import styluscam as sc


def tall(job: sc.Job, part: sc.Part, tool: sc.Tool, machine: sc.Machine) -> tuple[sc.Report, float, str]:
    """What a worker does."""
    height = float(sc.drop_cutter(part, tool, [[5.0, 4.0]])[0])
    plan = sc.plan(job)
    return sc.verify(sc.post(plan), job), height, sc.post(plan, machine).text


def fails() -> None:
    """What a worker meets."""
    sc.Tool("clothoid")
