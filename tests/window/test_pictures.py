"""Pictures of a job in FreeCAD's window: colours, verification, heat map, contact track, the moving tool."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jinja2
import markupsafe
import numpy as np
import pytest
from window_host import Window, WindowSession

pytestmark = [pytest.mark.world, pytest.mark.freecad]

RAPID, DOWN, UP, CUT = (0xCB, 0x09, 0x51), (0xC0, 0x8A, 0x00), (0x8A, 0x2B, 0xF0), (0x2E, 0x93, 0xD8)

THEIR_RAPID = [170 / 255, 0.0, 0.0]
"""FreeCAD's own colour of rapids."""

BACKGROUNDS = ((255, 255, 255), (204, 204, 204), (173, 173, 190), (51, 51, 101), (33, 33, 33))
"""White, a grey part, both ends of FreeCAD's gradient, a dark theme."""

COLOUR_VISION = {
    "normal": np.eye(3),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
"""On linear RGB: Machado, Oliveira, Fernandes, A Physiologically-based Model for Simulation of Color Vision Deficiency, 2009."""


OVER, UNFORMED, NOTHING = (0xCC, 0x4C, 0x9C), (0xE8, 0xE2, 0xCF), (0xD3, 0xD8, 0xDE)
"""Colours of a heat map beside its scale."""

PALEST = 0.96
"""Share of viridis that is used."""

Seen = Callable[[str], dict[str, Any]]


@pytest.fixture
def pictures(scenarios: Any, window: Window) -> WindowSession:
    """The session, in a FreeCAD that has what reports need."""
    for package in (jinja2, markupsafe):
        source = Path(package.__file__).parent
        shutil.copytree(source, window.engine / source.name, dirs_exist_ok=True)
    return scenarios("pictures", timeout=900.0)


@pytest.fixture
def seen(pictures: WindowSession) -> Seen:
    """What was seen of a part of the session; its traceback where it broke."""

    def part(name: str) -> dict[str, Any]:
        found: dict[str, Any] = pictures["pictures"][name]
        assert "broke" not in found, f"{found['broke']}\n{pictures.errors[-3000:]}"
        return found

    return part


def test_nothing_is_printed(pictures: WindowSession) -> None:
    errors = pictures.errors
    for word in ("Traceback", "Exception", "Cannot find icon"):
        assert word not in errors


# --- the path ----------------------------------------------------------------------------------------------------


def segments(seen: dict[str, Any]) -> np.ndarray:
    """Steps (S, 3) of the lines that are drawn."""
    points, index = np.array(seen["points"]), np.array(seen["index"])
    starts = np.flatnonzero((index[:-1] >= 0) & (index[1:] >= 0))
    return points[index[starts + 1]] - points[index[starts]]


def rgb(colours: Any) -> list[tuple[int, ...]]:
    return [tuple(round(255 * part) for part in colour) for colour in colours]


def linear(colour: tuple[int, int, int]) -> np.ndarray:
    share = np.array(colour) / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def lab(rgb_linear: np.ndarray) -> np.ndarray:
    """CIE 1976 L*a*b*, D65."""
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    x, y, z = to_xyz @ np.clip(rgb_linear, 0.0, 1.0) / [0.9505, 1.0, 1.089]
    f = [np.cbrt(v) if v > 0.008856 else 7.787 * v + 16.0 / 116.0 for v in (x, y, z)]
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def luminance(colour: tuple[int, int, int]) -> float:
    return float(linear(colour) @ [0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize("vision", COLOUR_VISION)
def test_kinds_of_moves_are_distinguished(vision: str) -> None:
    seen = [lab(COLOUR_VISION[vision] @ linear(colour)) for colour in (RAPID, DOWN, UP, CUT)]
    assert min(np.linalg.norm(a - b) for a, b in itertools.combinations(seen, 2)) > 30.0


@pytest.mark.parametrize("background", BACKGROUNDS)
def test_kinds_of_moves_are_seen(background: tuple[int, int, int]) -> None:
    for colour in (RAPID, DOWN, UP, CUT):
        low, high = sorted((luminance(colour), luminance(background)))
        assert (high + 0.05) / (low + 0.05) > 1.35


def test_a_path_has_a_colour_for_each_kind_of_move(seen: Seen) -> None:
    path = seen("path in colours")
    steps, plain = segments(path["on"]), path["off"]["colours"]
    expected = []
    for step, theirs in zip(steps, plain, strict=True):
        upright = abs(step[0]) < 1e-4 and abs(step[1]) < 1e-4
        is_rapid = np.allclose(theirs, THEIR_RAPID, atol=1e-3)
        expected.append(RAPID if is_rapid else (UP if step[2] > 0 else DOWN) if upright else CUT)
    assert rgb(path["on"]["colours"]) == expected
    assert set(expected) == {RAPID, DOWN, CUT}
    assert path["on"]["legend"] == ["Path", "rapid", "down at a feed", "up at a feed", "cut, or link along the part"]


def test_the_command_gives_freecads_colours_back(seen: Seen) -> None:
    path = seen("path in colours")
    assert len(set(rgb(path["off"]["colours"]))) == 2
    assert path["off"]["legend"] is None


def test_a_part_of_a_path_has_the_same_colours(seen: Seen) -> None:
    path = seen("path in colours")
    whole, part = path["on"], path["part"]
    known = {tuple(step): colour for step, colour in zip(segments(whole).round(4), rgb(whole["colours"]), strict=True)}
    steps = segments(part).round(4)
    assert 0 < len(steps) < len(known)
    assert rgb(part["colours"])[: len(steps)] == [known[tuple(step)] for step in steps]


# --- verification ------------------------------------------------------------------------------------------------


def test_a_sound_path_has_no_findings(seen: Seen) -> None:
    sound = seen("sound")
    assert sound["rows"] == []
    assert sound["texts"]["Verdict"] == "Nothing was found"
    assert "Worst gouge 0.0000 mm" in sound["texts"]["Figures"]


def test_a_gouge_is_listed_and_marked(seen: Seen) -> None:
    spoilt = seen("spoilt")
    assert spoilt["texts"]["Verdict"] == "Must not run"
    ((kind, value, line),) = spoilt["rows"]
    assert kind == "gouge"
    assert 0.2 < float(value.removesuffix(" mm")) < 0.3
    assert f"line {line}, " in spoilt["texts"]["Message"]
    assert spoilt["marker"] == pytest.approx(spoilt["at"], abs=1e-3)
    assert spoilt["centre"] == pytest.approx(spoilt["at"], abs=1e-2)
    assert spoilt["faces"] == ["Face3"]
    assert spoilt["after"] is False


def test_a_report_is_written_beside_the_document(seen: Seen) -> None:
    (page,) = seen("report")["opened"]
    assert Path(page).name == "cup-Job.html"
    text = Path(page).read_text(encoding="utf-8")
    assert "Nothing was found" in text
    assert "wall angle" in text


# --- heat maps ---------------------------------------------------------------------------------------------------


def viridis(shares: np.ndarray) -> np.ndarray:
    from matplotlib import colormaps

    return 255.0 * colormaps["viridis"](PALEST * np.clip(shares, 0.0, 1.0))[:, :3]


def test_the_scale_is_viridis(seen: Seen) -> None:
    scale = np.array(seen("heat map")["scale"])
    even = np.linspace(0.0, 1.0, 200)
    ours = np.stack([np.interp(even, np.linspace(0.0, 1.0, len(scale)), scale[:, k]) for k in range(3)], axis=1)
    assert np.abs(ours - viridis(even)).max() < 4.0


def limits(legend: list[str]) -> tuple[float, float]:
    """The ends of a legend's scale."""
    return float(legend[1]), float(legend[3].removeprefix("≥ "))


def test_there_is_a_map_for_all_that_a_report_shows(seen: Seen) -> None:
    maps = seen("heat map")["maps"]
    assert list(maps) == ["left over, mm", "gouge, mm", "wall angle, °", "thickness, mm"]
    for title, one in maps.items():
        assert one["legend"][0] == title
        assert one["count"][0] == one["count"][1] > 10_000


def test_colours_are_those_of_the_engines_numbers(seen: Seen) -> None:
    """What is left at each point, asked of the engine anew, and the colour that is drawn there."""
    heat = seen("heat map")
    one = heat["maps"]["left over, mm"]
    low, high = limits(one["legend"])
    limit = float(one["legend"][4].split()[-2])
    kinds = set()
    for left, colour in zip(heat["left"], map(tuple, one["colours"]), strict=True):
        if colour in (NOTHING, UNFORMED):
            kinds.add(colour)
        elif colour == OVER:
            kinds.add(colour)
            assert left > limit * 0.999
        else:
            kinds.add("scale")
            assert left <= limit * 1.001
            expected = viridis(np.array([(max(left, 0.0) - low) / (high - low)]))[0]
            assert np.abs(expected - colour).max() < 8.0  # the legend has three digits
    assert kinds >= {NOTHING, OVER, "scale"}


def test_thickness_follows_the_sine_law(seen: Seen) -> None:
    """The cup's wall stands at 45 degrees, its floor is level: 0.707 mm and 1 mm of the sheet are left."""
    legend = seen("heat map")["maps"]["thickness, mm"]["legend"]
    assert limits(legend) == (0.707, 1.0)
    assert legend[4].startswith("largest: 1 mm\nat X ")
    assert legend[5].startswith("smallest: 0.707 mm\nat X ")


def test_the_extreme_is_marked_where_the_legend_states(seen: Seen) -> None:
    for title in ("left over, mm", "wall angle, °", "thickness, mm"):
        one = seen("heat map")["maps"][title]
        words = one["legend"][-1].split()
        stated = [float(words[words.index(axis) + 1]) for axis in "XYZ"]
        assert min(np.abs(np.array(marker) - stated).max() for marker in one["markers"]) < 1e-3
    assert seen("heat map")["maps"]["gouge, mm"]["legend"][-1] == "nowhere"


def test_a_map_stands_for_the_model_until_the_operation_changes(seen: Seen) -> None:
    heat = seen("heat map")
    assert heat["model is drawn"] is False
    assert heat["after OK"] is True
    assert heat["after a change"] == [None, True]


# --- contacts, and the tool --------------------------------------------------------------------------------------


def test_the_contact_track_lies_on_the_model(seen: Seen) -> None:
    track = seen("contact track")
    assert track["far"] < 0.002
    assert track["count"] > 2000
    assert sum(track["runs"]) == track["count"]
    assert track["longest step"] < 5.0
    assert track["legend"][0] == "Contact track"
    assert track["legend after"] is None


def test_the_sheet_stands_for_stock_and_model(seen: Seen) -> None:
    """The cup is the back of 1 mm of sheet: its flange lies at Z 0, the blank on it."""
    sheet = seen("sheet")
    assert sheet["legend"] == ["Sheet", "formed sheet", "blank"]
    blank, formed = (np.array(sheet["spif"][key]) for key in ("blank", "formed_sheet"))
    assert blank[:, 2] == pytest.approx([0.0, 1.0], abs=1e-4)
    assert formed[:, :2] == pytest.approx(blank[:, :2], abs=0.02)
    assert formed[1, 2] == pytest.approx(1.0, abs=2e-3)  # heights of the mesh are rounded
    assert formed[0, 2] < -20.0
    assert sheet["stock and model are drawn"] == [False, False]
    assert sheet["after"] == [None, True, True]
    assert sheet["objects"][0] == sheet["objects"][1]


def test_the_tool_stands_where_the_path_is_after_a_length(seen: Seen) -> None:
    tool = seen("moving tool")
    ends = np.array(tool["positions"])
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ends, axis=0), axis=1))])
    expected = [float(np.interp(500.0, lengths, ends[:, k])) for k in range(3)]
    assert tool["end by length"] == pytest.approx(lengths[-1], abs=0.1)
    assert tool["tip"] == pytest.approx(expected, abs=2e-3)
    assert tool["slider"] == pytest.approx(500.0 / lengths[-1], abs=1e-3)
    x, y, z = (float(tool["readout"].split()[k]) for k in (1, 3, 5))
    assert [x, y, z] == pytest.approx(expected, abs=2e-3)
    assert "F 1500 mm/min, line " in tool["readout"]


def test_the_tool_has_its_size_and_its_tip_at_the_position(seen: Seen) -> None:
    low, high = np.reshape(seen("moving tool")["box"], (2, 3))
    assert low[2] == pytest.approx(0.0, abs=1e-4)
    assert high[0] - low[0] == pytest.approx(10.0, abs=0.1)
    assert high[2] > 40.0


def test_the_tool_plays_to_the_end_of_the_path(seen: Seen) -> None:
    tool = seen("moving tool")
    assert tool["at the end"] == pytest.approx(tool["positions"][-1], abs=1e-3)
    assert tool["text at the end"] == "Play"
    assert tool["after"] is False


def test_freecads_simulators_take_the_operation_and_its_tool(seen: Seen) -> None:
    simulated = seen("simulators")
    assert simulated["listed"] == ["Cup"]
    theirs, ours = (np.array(simulated["profile"][key]) for key in ("theirs", "ours"))
    assert np.abs(theirs - ours).max() < 0.1  # it draws a chord of each span
    assert simulated["cut"] == pytest.approx(simulated["path"], abs=0.5)  # a voxel
