"""Properties from the engine's schema inside FreeCAD, documents of earlier versions, and arcs."""

from __future__ import annotations

from typing import Any

import pytest
from freecad_host import FreeCad

pytestmark = [pytest.mark.world, pytest.mark.freecad]

ROUNDED = 1e-6
"""FreeCAD saves paths with six decimals."""


def test_a_document_of_an_earlier_version_opens_as_it_was(session: Any) -> None:
    seen = session["earlier document"]
    before, after = seen["before"], seen["after"]
    assert before["Strategy"][0] == "z-level" and before["Step"][0] == 5.0 and before["ModelFace"][0] == "back"
    for name, (value, _) in before.items():
        assert after[name][0] == value or name == "Notes", name
    assert set(before) < set(after)
    assert after["MaxUnreached"][0] == 0.1, "a property that is new begins with the engine's default"


def test_its_stylus_is_one_of_this_freecad(session: Any, freecad: FreeCad) -> None:
    """FreeCAD reports what it cannot restore, and goes on."""
    seen = session["earlier document"]
    assert "Traceback" not in seen["printed"], seen["printed"]
    kind, profile, diameter, volume = seen["bit"]
    assert kind == {"1.0": "StylusBit", "1.1": "ToolBitStylus"}[freecad.version]
    assert (profile, diameter) == ('{"kind": "clothoid", "diameter": 10.0}', 10.0) and volume > 1000.0
    assert seen["edited bit"] == 6.0, "its lengths follow its profile"


def test_it_computes_to_the_same_path(session: Any) -> None:
    seen = session["earlier document"]
    assert seen["state"] == ["Up-to-date"]
    opened, (label, upwards, *moves) = seen["opened"], seen["computed"]
    assert upwards == ["G0", {"Z": pytest.approx(moves[0][1]["Z"], abs=ROUNDED)}]  # later versions begin with it
    computed = [label, *moves]
    # the model's triangles are others, and so are the points of the path; it is the same one within its tolerance
    assert opened[0] == computed[0]
    assert heights(opened) == pytest.approx(heights(computed), abs=0.01)
    assert length(opened) == pytest.approx(length(computed), rel=1e-3)


Command = tuple[str, dict[str, float]]


def heights(commands: list[Command]) -> list[float]:
    """The highest and the lowest height of a path's feeds."""
    found = [words["Z"] for name, words in commands if name == "G1" and "Z" in words]
    return [max(found), min(found)]


def length(commands: list[Command]) -> float:
    """The length of a path's feeds, mm."""
    at, total = {"X": 0.0, "Y": 0.0, "Z": 0.0}, 0.0
    for name, words in commands:
        to = {axis: words.get(axis, value) for axis, value in at.items()}
        if name == "G1":
            total += sum((to[axis] - at[axis]) ** 2 for axis in at) ** 0.5
        at = to
    return total


def test_a_new_kind_needs_no_line_of_the_addon(session: Any) -> None:
    seen = session["new kind"]
    strategy, before = seen["before"]
    assert strategy == "z-level" and before["RingDistance"] == [1.5, True] and before["Step"] == [5.0, False]
    assert seen["text"] == "Distance between rings in plan.\nRange: above 0 to 100 mm"
    after, section = seen["after"]
    assert after["RingDistance"] == [2.5, False] and after["Step"] == [5.0, True]
    assert (section["kind"], section["ring_distance"]) == ("rings", 2.5)
    assert not {"step", "stepover", "angle_deg"} & set(section), "keys of other kinds are not sent"


def test_without_a_sheet_its_properties_are_hidden_and_not_sent(session: Any) -> None:
    properties, part = session["new kind"]["milling"]
    hidden = {name for name, (_, is_hidden) in properties.items() if is_hidden}
    assert {"SheetThickness", "SheetLaw", "ModelFace"} <= hidden
    assert "model_face" not in part


def test_freecads_own_bits_are_supported(session: Any) -> None:
    assert session["native tool"]["tool"]


@pytest.mark.parametrize(
    ("name", "codes"),
    [
        ("xy", ["G3", "G2", "G3"]),
        ("zx", ["G18", "G2", "G3", "G1", "G17"]),
        ("yz", ["G19", "G3", "G2", "G17"]),
        ("helix", ["G3", "G3", "G3", "G1"]),
    ],
)
def test_arcs_are_arcs_for_freecad(session: Any, name: str, codes: list[str]) -> None:
    """FreeCAD's own box holds them, but for its chords; what it writes is read back as the same arcs."""
    seen = session["arcs"][name]
    assert seen["names"] == ["G0", "G0", "G0", "G1", *codes]  # straight up first, as FreeCAD's own operations
    assert seen["box"] == pytest.approx(seen["expected"], abs=0.02)
    ours, theirs = seen["length"]
    assert ours == pytest.approx(theirs, abs=1e-4)
    ours, theirs = seen["ends"]
    assert ours == pytest.approx(theirs, abs=ROUNDED)


def test_a_sketch_bounds_the_passes(session: Any) -> None:
    """Its arc becomes chords within a thousandth; the tool's axis stays behind its line at Y2.5."""
    seen = session["wires"]
    assert seen["whole"][1] > 20.0
    assert seen["bounded"] == pytest.approx([seen["whole"][0], 2.5], abs=2e-3)
    assert len(seen["corners"]) == 1 and seen["corners"][0] > 100
    assert seen["off"] <= 1e-6, "corners of the polyline lie on the arc"
    assert "do not close" in seen["open"]


def test_check_faces_are_a_property(session: Any) -> None:
    count, (_, highest) = session["wires"]["rest"]
    assert count > 100
    assert highest < session["wires"]["whole"][1] - 1.0
