"""Writes docs/machines.md, the golden programs in docs/machines/ and the tables of docs/posts.md: `make machines`.

With ``--check`` it writes nothing and prints what is out of date.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import styluscam as sc
from styluscam import _engine

FOLDER = Path(__file__).parent
GOLDEN = FOLDER / "machines"

INTRODUCTION = """\
# Machines

Each comes as a file of facts and templates. `styluscam machine show NAME --toml` prints it, `styluscam machine check NAME` posts
a torture program by it and reads the text back, [Write a post for your machine](posts.md) describes how to make one of your own.

"Read" means that every fact was read in the sources named; "partly" that all were but those listed as not confirmed; "unverified"
that parts are guesses: the header of every program states it. The golden program of each is the same job: two tools (one where
the machine takes one), lines, arcs, a helix, holes where it has cycles, a wait and coolant.

| machine | what | evidence | second reader in the tests |
|---|---|---|---|
"""

BY_ANOTHER_HAND = "none was found; ours from the manual, for the tests alone"
SECOND_READERS = {"siemens": "`nc-gcode-interpreter`", "okuma": BY_ANOTHER_HAND, "heidenhain": BY_ANOTHER_HAND}
"""Other people's readers that can be installed; LinuxCNC's interpreter understands all the others."""


def golden_program(machine: sc.Machine) -> sc.Program:
    """The job that every machine's golden program is made of."""
    document = machine.document
    cycles = document.get("cycle") or {"kinds": []}
    several = document["tool"]["change"] in ("m6", "t", "tool-call")
    tools = [_tool(1, "clothoid D10"), _tool(2, "ball D6")][: 2 if several else 1]
    moves, events, holes = _first_part()
    if several:
        events += [
            {"before": len(moves), "kind": "tool-change", "tool": 1},
            {"before": len(moves), "kind": "spindle-on", "rpm": 2400.0, "direction": "clockwise"},
        ]
        moves += [_move("rapid", [0, 0, 10], 1), _move("rapid", [0, 0, 1], 1), _move("feed", [0, 12.5, -0.5], 1, 450.0)]
        moves += [_move("rapid", [0, 12.5, 10], 1)]
    flood = document["coolant"].get("flood") is not None
    events = [event for event in events if flood or event["kind"] != "flood"]
    program = {
        "schema": 1,
        "setup": {
            "title": "Golden",
            "wcs": document["wcs"][0],
            "zero": "top of the block",
            "part_min": [-20.0, -20.0, -10.0],
            "part_max": [20.0, 20.0, 0.0],
            "clearance": 10.0,
            "notes": ["reviewed against the machine's sources"],
        },
        "tools": tools,
        "operations": [
            {"id": "contour", "kind": "profile", "tool": 0},
            {"id": "groove", "kind": "zig-zag", "tool": len(tools) - 1},
        ],
        "moves": moves,
        "events": sorted(events, key=lambda event: event["before"]),
        "cycles": [hole for hole in holes if hole["kind"] in cycles["kinds"]],
    }
    return sc.Program.from_json(json.dumps(program))


def _first_part() -> tuple[list[Any], list[Any], list[Any]]:
    arc = {"plane": "xy", "clockwise": True, "turns": 0}
    moves = [_move("rapid", [-20, 0, 10]), _move("rapid", [-20, 0, 2]), _move("feed", [-20, 0, -1], feed=200.0)]
    moves += [_move("feed", [-10, 0, -1], feed=1200.0)]
    moves += [_move("feed", [10, 0, -1], feed=1200.0, arc={**arc, "centre": [0, 0, 0]})]
    moves += [_move("feed", [10, 0, -2], feed=1200.0, arc={**arc, "centre": [0, 0, 0], "clockwise": False})]
    moves += [_move("feed", [20.1234, 0.0006, -2], feed=1200.0), _move("rapid", [20.1234, 0.0006, 10])]
    events = [
        {"before": 0, "kind": "tool-change", "tool": 0},
        {"before": 0, "kind": "spindle-on", "rpm": 1800.0, "direction": "clockwise"},
        {"before": 2, "kind": "flood", "on": True},
        {"before": 3, "kind": "dwell", "seconds": 0.5},
        {"before": 3, "kind": "comment", "text": "wall (60°), \u00f8 20"},
    ]
    holes = []
    for x in (0.0, 8.0):
        first = len(moves)
        moves += [_move("rapid", [x, 15, 10]), _move("rapid", [x, 15, 2]), _move("feed", [x, 15, -6], feed=150.0)]
        moves += [_move("rapid", [x, 15, 10])]
        hole = {"first": first, "count": 4, "kind": "drill", "at": [x, 15], "retract": 2, "bottom": -6, "leave": 10}
        holes.append({**hole, "feed": 150.0})
    events += [{"before": len(moves), "kind": "flood", "on": False}, {"before": len(moves), "kind": "spindle-off"}]
    return moves, events, holes


def _tool(number: int, description: str) -> dict[str, Any]:
    return {"name": f"T{number}", "number": number, "length_offset": number, "description": description,
            "reference": "tip", "reference_height": 0.0, "diameter": 10.0}  # fmt: skip


def _move(
    kind: str, end: list[float], operation: int = 0, feed: float = 0.0, arc: dict[str, Any] | None = None
) -> dict[str, Any]:
    move = {"kind": kind, "end": [float(v) for v in end], "feed": feed, "operation": operation}
    return {**move, "arc": arc} if arc else move


def pages() -> dict[Path, str]:
    """Every file and what it should hold."""
    machines = [sc.Machine.shipped(name) for name in sc.Machine.names()]
    text = INTRODUCTION
    for machine in machines:
        reader = SECOND_READERS.get(machine.name, "LinuxCNC's `rs274`")
        text += f"| [{machine.name}](#{machine.name}) | {machine.description} | {machine.evidence} | {reader} |\n"
    files = {}
    for machine in machines:
        golden = GOLDEN / f"{machine.name}.txt"
        files[golden] = sc.post(golden_program(machine), machine).text.replace("\r\n", "\n")
        text += f"\n{_section(machine, golden)}"
    files[FOLDER / "machines.md"] = text
    files[FOLDER / "posts.md"] = _with_names((FOLDER / "posts.md").read_text(encoding="utf-8"))
    return files


def _with_names(text: str) -> str:
    """The page of posts with the names that templates may use and the options that every machine has."""
    everywhere, own = _engine.template_names()
    rows = ["| name | is | in |", "|---|---|---|"]
    rows += [f"| `{name}` | {what} | every template |" for name, what in everywhere]
    rows += [f"| `{name}` | {what} | `{key}{'...' if key.endswith('_') else ''}` |" for key, name, what in own]
    options = ", ".join(f"`{name}` ({takes})" for name, takes in _engine.machine_options())
    text = _between(text, "names", "\n" + "\n".join(rows) + "\n")
    return _between(text, "options", options)


def _between(text: str, mark: str, inside: str) -> str:
    before, _, rest = text.partition(f"<!-- {mark} -->")
    _, _, after = rest.partition(f"<!-- /{mark} -->")
    return f"{before}<!-- {mark} -->{inside}<!-- /{mark} -->{after}"


def _section(machine: sc.Machine, golden: Path) -> str:
    source = machine.document["source"]
    lines = [f"## {machine.name}", "", f"{machine.description}. [Golden program]({golden.relative_to(FOLDER)})."]
    titles = {"read": "Read:", "unconfirmed": "Not confirmed:", "notes": "Notes:"}
    for key, title in titles.items():
        if source[key]:
            lines += ["", title, "", *(f"- {line}" for line in source[key])]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Writes what differs, or prints what does."""
    stale = [path for path, text in pages().items() if not path.is_file() or path.read_text(encoding="utf-8") != text]
    if "--check" in sys.argv:
        for path in stale:
            print(f"{path} is out of date: run make machines")
        return 1 if stale else 0
    GOLDEN.mkdir(exist_ok=True)
    for path in stale:
        path.write_text(pages()[path], encoding="utf-8")
        print(f"written: {path}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
