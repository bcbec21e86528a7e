"""A verdict without errors means that the part can be made: sound programs for parts that cannot be made, and that can."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import styluscam as sc


def tray(
    wall_deg: float = 45.0, depth: float = 12.0, side: float = 20.0, flange: float = 15.0, count: int = 1
) -> sc.Part:
    """Square trays beside each other: flanges at Z0 (Face1, Face4), walls of an angle (Face2, Face5), floors (Face3, Face6)."""
    inner = side - (depth / np.tan(np.radians(wall_deg)) if wall_deg < 90 else 0.0)
    rings = [(side + flange, 0.0), (side, 0.0), (inner, -depth)]
    vertices = np.array([(x * r, y * r, z) for r, z in rings for x, y in [(1, 1), (-1, 1), (-1, -1), (1, -1)]])
    walls = [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    others = [(4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    faces = np.array([1] * 4 + [2] * 4 + [1] * 4 + [2] * 4 + [3] * 2)
    triangles = np.array([*walls, *others, (8, 9, 10), (8, 10, 11)])
    pitch = np.array([2.0 * (side + flange), 0.0, 0.0])
    return sc.Part.from_mesh(
        np.concatenate([vertices + n * pitch for n in range(count)]),
        np.concatenate([triangles + n * len(vertices) for n in range(count)]),
        face_ids=np.concatenate([faces + 3 * n for n in range(count)]),
    )


LEVELS: dict[str, Any] = {"id": "levels", "kind": "z-level", "step": {"height": 1.0}}
ROWS: dict[str, Any] = {"id": "rows", "kind": "zig-zag", "stepover": 1.0}


def found(
    part: sc.Part,
    *operations: dict[str, Any],
    diameter: float = 6.0,
    sheet: dict[str, Any] | None = None,
    process: dict[str, Any] | None = None,
    accept: tuple[str, ...] = (),
) -> dict[str, str]:
    """What the verifier finds in the job's own program: kinds and severities."""
    job = sc.Job.from_dict(
        {
            "schema": 1,
            "accept": list(accept),
            "part": {"file": "tray.stl", "units": "mm", "model_face": "tool"},
            "process": {"kind": "spif", **(process or {})},
            "setup": {"zero": "model", "sheet": {"thickness": 1.0, **(sheet or {})}},
            "tools": {"ball": {"profile": {"kind": "ball", "diameter": diameter}}},
            "operations": [{"tool": "ball", **one} for one in operations or (LEVELS,)],
            "machine": {"name": "linuxcnc"},
        },
        part=part,
    )
    report = sc.verify(sc.post(sc.plan(job)), job)
    assert report.ok == all(finding["severity"] == "warning" for finding in report.findings)
    return {finding["kind"]: finding["severity"] for finding in report.findings}


def test_levels_down_a_tray_are_sound() -> None:
    assert not found(tray())


@pytest.mark.parametrize("faces", ["all", ["Face3"]], ids=["all", "floor"])
def test_rows_do_not_go_straight_into_flat_sheet(faces: Any) -> None:
    assert found(tray(), {**ROWS, "faces": faces})["punch"] == "error"
    assert found(tray(), {**ROWS, "faces": faces}, accept=("punch",))["punch"] == "warning"


def test_rows_finish_what_levels_have_formed() -> None:
    assert "punch" not in found(tray(), LEVELS, ROWS)


def test_what_is_formed_beside_a_position_is_not_formed_there() -> None:
    trays, first = tray(count=2), {**LEVELS, "faces": ["Face1", "Face2", "Face3"]}
    assert not found(trays)
    assert not found(trays, first)
    assert found(trays, first, {**ROWS, "faces": ["Face6"]})["punch"] == "error"
    assert "punch" not in found(trays, LEVELS, {**ROWS, "faces": ["Face6"]})


def test_rows_may_press_a_dent() -> None:
    assert "punch" not in found(tray(depth=0.6), ROWS)


def test_levels_of_the_floor_alone_go_straight_into_flat_sheet() -> None:
    assert found(tray(), {**LEVELS, "z_top": -8.0, "z_bottom": -12.0})["punch"] == "error"


@pytest.mark.parametrize(("wall_deg", "operation"), [(82.0, LEVELS), (90.0, ROWS)])
def test_a_wall_that_no_sheet_withstands_is_refused(wall_deg: float, operation: dict[str, Any]) -> None:
    assert found(tray(wall_deg), operation)["wall-angle"] == "error"
    assert found(tray(wall_deg), operation, accept=("wall-angle",))["wall-angle"] == "warning"


def test_the_jobs_own_wall_angle_goes_before_what_is_known() -> None:
    assert "wall-angle" not in found(tray(82.0), sheet={"max_wall_angle_deg": 85.0})
    assert found(tray(50.0), sheet={"max_wall_angle_deg": 45.0})["wall-angle"] == "error"


@pytest.mark.parametrize(
    ("wall_deg", "material", "severity"),
    [(58.0, None, None), (66.0, None, "warning"), (72.0, None, "error"), (66.0, "PVC", "error"), (64.0, "pvc", None)],
)
def test_a_material_states_what_it_withstands(wall_deg: float, material: str | None, severity: str | None) -> None:
    process = {"material": material} if material else {}
    assert found(tray(wall_deg), process=process).get("wall-angle") == severity


def test_a_material_that_is_not_known_is_an_error() -> None:
    with pytest.raises(sc.JobError, match='unknown material "oak"') as caught:
        found(tray(), process={"material": "oak"})
    assert caught.value.where == "process.material"
    assert "sheet-metal" in caught.value.hint


def test_a_tool_that_gets_into_nothing_is_refused() -> None:
    assert found(tray(), diameter=100.0) == {"bridged": "error", "unreached": "error"}
    accepted = found(tray(), diameter=100.0, accept=("bridged", "unreached"))
    assert accepted == {"bridged": "warning", "unreached": "warning"}


def test_what_may_be_bridged_is_the_jobs_to_say() -> None:
    # where two walls meet the floor a ball of 6 mm leaves 0.48 mm, and a scallop
    assert "bridged" not in found(tray(), process={"max_bridged": 0.7})
    assert found(tray(), process={"max_bridged": 0.1, "max_unreached": 0.5}) == {"bridged": "error"}
