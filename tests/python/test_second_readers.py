"""Other people's readers of other dialects than LinuxCNC's: they see the positions that our reader sees, block by block."""

from __future__ import annotations

import re
from typing import Any

import pytest

import styluscam as sc

nc_gcode_interpreter = pytest.importorskip(
    "nc_gcode_interpreter", reason="NOT TESTED with a reader of Sinumerik's words"
)

INCH = 25.4
SINGLE = 2e-7
"""The other reader keeps numbers with 24 bits."""
KINDS = {"G0": "rapid", "G1": "feed", "G2": "feed", "G3": "feed"}


def states(text: str) -> dict[int, dict[str, Any]]:
    """What the other reader knows after each block, by the block's number."""
    table, _ = nc_gcode_interpreter.nc_to_dataframe(text)
    return {int(row["N"]): row for row in table.to_dicts() if row["N"] is not None}


def block_number(line: str) -> int:
    match = re.match(r"N(\d+) ", line)
    assert match, line
    return int(match[1])


@pytest.mark.world
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_sinumerik_blocks_end_where_the_other_reader_states(units: str) -> None:
    machine = sc.Machine.shipped("siemens").with_options({"block_numbers": True, "units": units})
    compared = 0
    for trial in machine.check():
        # it does not read TURN= and does not drill; block numbers begin again in long texts
        if not trial.text or re.search("TURN=|MCALL", trial.text) or trial.text.count("\nN10 ") > 1:
            continue
        lines, seen = trial.text.splitlines(), states(trial.text)
        for move in sc.read_gcode(trial.text, machine).moves:
            state = seen[block_number(lines[int(move["line"]) - 1])]
            scale = INCH if state["gg13_wp_measure"] == "G700" else 1.0
            for axis, ours in zip("XYZ", move["end"], strict=True):
                theirs = state[axis]
                # our first moves take the first position that an axis is given
                if theirs is not None and state["gg09_frame_tool_suppress"] is None:
                    assert abs(scale * theirs - ours) <= SINGLE * abs(ours) + 1e-9, (trial.name, state)
                    compared += 1
            assert KINDS[state["gg01_motion"]] == ("feed" if move["feed"] > 0 else "rapid"), (trial.name, state)
            if move["feed"] > 0 and state["gg15_feed_type"] == "G94":
                assert abs(scale * state["F"] - move["feed"]) <= SINGLE * move["feed"], (trial.name, state)
    assert compared > 1000, "too few positions to say anything"
