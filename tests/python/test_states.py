"""What a text leaves open or switches wrongly: each is a sound program with one change."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import styluscam as sc

DEPTH = 4.0


def tray(side: float = 20.0) -> sc.Part:
    """A square tray: a flange, walls of 45 degrees, a floor."""
    rings = [(2 * side, 0.0), (side, 0.0), (side - DEPTH, -DEPTH)]
    vertices = np.array([(x * r, y * r, z) for r, z in rings for x, y in [(1, 1), (-1, 1), (-1, -1), (1, -1)]])
    walls = [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    others = [(4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for k in range(2) for i in range(4)]
    return sc.Part.from_mesh(vertices, np.array([*walls, *others, (8, 9, 10), (8, 10, 11)]))


def job(*operations: dict[str, Any], forming: bool = False, machine: str = "linuxcnc") -> sc.Job:
    document: dict[str, Any] = {
        "schema": 1,
        "part": {"file": "tray.stl", "units": "mm"},
        "process": {"kind": "milling"},
        "setup": {"zero": "model"},
        "tools": {
            "ball": {"number": 1, "profile": {"kind": "ball", "diameter": 4.0}},
            "wide": {"number": 2, "profile": {"kind": "ball", "diameter": 6.0}},
        },
        "operations": [
            {"kind": "z-level", "tool": "ball", "step": {"height": 1.0}, "spindle": {"mode": "off"}, **one}
            for one in operations or ({},)
        ],
        "machine": {"name": machine},
    }
    if forming:
        document["process"] = {"kind": "spif"}
        document["part"]["model_face"] = "tool"
        document["setup"]["sheet"] = {"thickness": 1.0}
    return sc.Job.from_dict(document, part=tray())


TWO = ({"id": "first"}, {"id": "second", "tool": "wide", "feeds": {"cut": 800.0, "plunge": 100.0}})


def kinds(text: str, of: sc.Job) -> dict[str, str]:
    return {finding["kind"]: finding["severity"] for finding in sc.verify(text, of).findings}


def text_of(of: sc.Job) -> str:
    text = sc.post(sc.plan(of)).text
    assert not kinds(text, of)
    return text


def before(mark: str, words: str) -> Callable[[str], str]:
    """Words put before the first line that begins with a mark."""
    return lambda text: re.sub(rf"^(?={mark})", f"{words}\n", text, count=1, flags=re.M)


def without_remarks(text: str) -> str:
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith("(operation"))


FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "down in machine coordinates": (before("M2", "G53 G0 Z-150"), "machine-place"),
    "down before it is known where": (before("G0 Z", "G0 Z-30"), "unsafe-start"),
    "optional line": (before("M2", "/G1 Z-40 F100"), "optional-lines"),
    "mist": (before(r"\(operation", "M7"), "coolant-differs"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_an_error(name: str) -> None:
    change, kind = FAULTS[name]
    of = job()
    assert kinds(change(text_of(of)), of)[kind] == "error"


def test_machine_coordinates_are_for_going_up() -> None:
    of = job()
    text = text_of(of)
    # up and across at the start, and from where the last pass ends
    assert not kinds(before("G0 Z", "G53 G0 Z0\nG0 X3 Y3")(text), of)
    last = text.rindex("\nG0 Z")
    assert not kinds(text[:last] + "\nG53 G0 Z0\nM2\n", of)
    down = text[:last] + "\nG53 G0 X0 Y0\nM2\n"
    assert kinds(down, of)["machine-place"] == "error"


def test_after_a_tool_change_the_tool_goes_up_before_it_goes_across() -> None:
    of = job(*TWO)
    text = text_of(of)
    swapped = re.sub(r"(T2 M6\nG43 H2\n(?:.*\n)*?)(G0 )(Z\S+)\n(X.*)\n", r"\1\2\4\n\3\n", text, count=1)
    assert swapped != text
    assert kinds(swapped, of) == {"unknown-place": "error"}


def test_without_remarks_operations_are_known_by_their_tools() -> None:
    of = job(*TWO)
    bare = without_remarks(text_of(of))
    assert not kinds(bare, of)
    assert kinds(re.sub(r"F\d+", "F9000", bare), of)["feed-differs"] == "error"
    half = bare[: bare.index("T2 M6")] + "M2\n"
    assert kinds(half, of)["unnamed-operations"] == "error"
    swapped = (
        bare.replace("T1 M6\nG43 H1", "T9").replace("T2 M6\nG43 H2", "T1 M6\nG43 H1").replace("T9", "T2 M6\nG43 H2")
    )
    assert kinds(swapped, of)["unnamed-operations"] == "error"


def test_an_operation_that_the_job_lacks_is_found() -> None:
    of = job(*TWO)
    text = text_of(of)
    second = re.findall(r"\(operation ([^:]+):", text)[1]
    renamed = re.sub(r"F\d+", "F9000", text.replace(f"(operation {second}:", "(operation other:"))
    found = kinds(renamed, of)
    assert (found["unknown-operation"], found["missing-operation"]) == ("error", "error")
    more = text.replace("M2\n", "") + text[text.index(f"(operation {second}:") :].replace(second, "other")
    assert kinds(more, of)["unknown-operation"] == "error"


def test_operations_come_in_the_jobs_order() -> None:
    of, other = job(*TWO), job(*reversed(TWO))
    assert kinds(text_of(other), of)["operation-order"] == "error"


@pytest.mark.parametrize("where", ["before all", "halfway"])
def test_the_sheet_is_not_punched_through(where: str) -> None:
    of = job(forming=True)
    lines = text_of(of).splitlines()
    falls = [n for n, line in enumerate(lines) if re.match(r"G1 Z", line)]
    at = falls[0] if where == "before all" else falls[len(falls) // 2]
    punch = [*lines[:at], "G1 Z-3.9 F300", "G0 Z10", lines[at - 1].replace("Z", "G0 Z"), *lines[at:]]
    assert kinds("\n".join(punch) + "\n", of)["punch"] == "error"


REFUSED = {
    "joined lines": ("linuxcnc", "G64 P0.001 Q0", "G64 P0.001 Q5", "read-path-tolerance"),
    "many turns": ("linuxcnc", "M2", "G1 X5 Y0 Z12 F100\nG17 G3 X5 I-5 P100000\nM2", "read-arc-turns"),
    "no angle": ("linuxcnc", "M2", "G1 X2500 Y0 Z12 F100\nG3 X2500 Y0.001 I-2500 J0\nM2", "read-arc-of-no-angle"),
    "real-time character": ("grbl", "M2", "(wait!)\nM2", "read-character"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_text_is_refused(name: str) -> None:
    machine, found, written, code = REFUSED[name]
    of = job(machine=machine)
    text = text_of(of)
    assert found in text
    with pytest.raises(sc.VerifyError) as caught:
        sc.verify(text.replace(found, written), of)
    assert caught.value.code == code


@pytest.mark.parametrize(("code", "named"), [("G90 ", "G90"), ("G54\n", "G54")])
def test_modal_codes_that_are_not_stated_are_warned_of(code: str, named: str) -> None:
    of = job()
    text = text_of(of).replace(code, "", 1)
    (finding,) = sc.verify(text, of).findings
    assert (finding["kind"], finding["severity"]) == ("unsaid-mode", "warning")
    assert f": modal code not stated ({named}): " in finding["message"]


def test_what_is_measured_has_its_unit() -> None:
    of = job()
    text = re.sub(r"F1500", "F1700", text_of(of))
    finding = next(f for f in sc.verify(text, of).findings if f["kind"] == "feed-differs")
    assert (finding["value"], finding["limit"], finding["unit"]) == (1700.0, 1500.0, "mm/min")
    assert finding["value_mm"] is None


def test_one_operation_is_meant_whatever_the_text_calls_it() -> None:
    of = job()
    text = text_of(of)
    end = "M2\n"
    again = re.sub(r"F1500", "F9000", text[text.index("G0 Z") :])
    assert kinds(f"{text.removesuffix(end)}T1 M6\nG43 H1\n{again}", of)["feed-differs"] == "error"


@pytest.mark.parametrize("mode", ["per-minute", "inverse-time", "per-revolution"])
@pytest.mark.parametrize("feed", [300.0, 1000.0, 2000.0])
def test_feeds_of_every_mode_are_those_of_the_job(mode: str, feed: float) -> None:
    """Rounded numbers of F, times rounded lengths or speeds, are no other feeds."""
    spindle = {"mode": "fixed", "rpm": 5000.0}
    asked = job({"feeds": {"cut": feed, "plunge": 200.0}, "spindle": spindle})
    document = asked.to_dict()
    document["machine"] = {"name": "linuxcnc", "options": {"feed_mode": mode}}
    asked = sc.Job.from_dict(document, part=tray())
    report = sc.verify(sc.post(sc.plan(asked)), asked)
    assert report.findings == []


def test_another_feed_is_found_in_inverse_time() -> None:
    asked = job({"feeds": {"cut": 1000.0, "plunge": 200.0}})
    document = asked.to_dict()
    document["machine"] = {"name": "linuxcnc", "options": {"feed_mode": "inverse-time"}}
    asked = sc.Job.from_dict(document, part=tray())
    document["operations"][0]["feeds"]["cut"] = 1010.0
    faster = sc.Job.from_dict(document, part=tray())
    report = sc.verify(sc.post(sc.plan(faster)), asked)
    assert {finding["kind"] for finding in report.findings} == {"feed-differs"}
