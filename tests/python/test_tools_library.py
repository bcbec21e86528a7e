"""Libraries of tools, tool files and FreeCAD's tool bits: every shipped tool builds, every slip is named."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam.tools import fctb, library, starters, toolfile
from styluscam.tools.outline import pieces, polyline, silhouette, transition

BALL = {"kind": "ball", "diameter": 6.0}


def written(path: Path, document: Any) -> Path:
    path.write_text(document if isinstance(document, str) else json.dumps(document), encoding="utf-8")
    return path


def shelf(*tools: Any, **more: Any) -> dict[str, Any]:
    return {"schema": 1, "name": "mine", "tools": list(tools), **more}


def refused(function: Any, *arguments: Any) -> sc.ToolError:
    with pytest.raises(sc.ToolError) as caught:
        function(*arguments)
    error = caught.value
    assert error.code and "\n" not in str(error)
    return error


# --- the shipped libraries -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", library.names())
def test_every_shipped_tool_builds_and_has_the_size_that_it_states(name: str) -> None:
    document = library.find(name)
    tool = sc.Tool.library(name)
    assert tool.name == name and tool.title
    assert tool.diameter == pytest.approx(document["profile"].get("diameter", tool.diameter), rel=1e-9)
    assert 1.0 <= tool.diameter <= 26.0
    r, z = tool.radius_at(tool.max_slope), tool.height_at(tool.max_slope)
    assert math.isfinite(r) and math.isfinite(z)
    above = tool.diameter if document["profile"]["kind"] in ("v", "cone", "tapered-ball") else 0.0
    assert document["length"] > z + above
    assert document["shank_diameter"] <= 1.000001 * tool.diameter or document["base"]["height"] > tool.diameter
    numbers = [x for part in (document["profile"], document) for x in part.values() if isinstance(x, float)]
    assert all(len(repr(x)) <= 9 for x in numbers), "as short as a person would write it"
    assert sc.Tool.from_dict(tool.to_file()).to_dict() == tool.to_dict()


def test_the_patent_s_shapes_come_in_three_sizes() -> None:
    forming = library.shipped()[0].tools
    for shape in ("circle", "clothoid", "rounded-rectangle", "parabola", "ellipse", "cycloid", "cubic"):
        tools = [sc.Tool.library(shape, size) for size in ("small", "medium", "large")]
        assert [tool.diameter for tool in tools] == pytest.approx([6.0, 12.0, 24.0], rel=1e-12)
        slopes = np.linspace(0.01, 1.0, 20) * tools[0].max_slope
        for tool, scale in zip(tools, (1.0, 2.0, 4.0), strict=True):
            assert tool.radius_at(slopes) == pytest.approx(scale * tools[0].radius_at(slopes), rel=1e-9)
        assert f"{shape}:small" in forming


def test_no_two_shipped_tools_are_the_same() -> None:
    for shelf in library.shipped():
        profiles = [json.dumps(tool["profile"], sort_keys=True) for tool in shelf.tools.values()]
        assert len(profiles) == len(set(profiles))
    assert max(sc.Tool.library(name).diameter for name in library.shipped()[1].tools) >= 20.0


def test_titles_say_where_a_sharp_rim_takes_over() -> None:
    for tool in library.shipped()[0].tools.values():
        ends = math.degrees(sc.Tool.from_dict(tool).max_slope)
        assert ends > 89.9 or f"up to {int(ends)} degrees" in tool["title"]


def test_common_styluses_and_cutters_are_there() -> None:
    names = library.names()
    assert {"hemisphere-d3", "hemisphere-d10", "hemisphere-1in", "flat-end-d10-r2"} <= set(names)
    assert {"ball-d6", "ball-1-8in", "flat-1-2in", "bull-nose-d6-r1", "barrel-d10-r60", "v-90-d10"} <= set(names)
    assert len(names) == len(set(names))
    assert sc.Tool.library("ball-1-8in").diameter == 3.175


def test_a_size_is_named_both_ways() -> None:
    assert library.find("clothoid", "medium") == library.find("clothoid:medium")
    assert library.find("clothoid:medium")["title"].endswith(", medium")


def test_what_is_found_can_be_changed_without_harm() -> None:
    library.find("hemisphere-d10")["profile"]["diameter"] = 1.0
    assert library.find("hemisphere-d10")["profile"]["diameter"] == 10.0


def test_names_that_are_not_there_are_guessed() -> None:
    assert "did you mean 'hemisphere-d10'" in refused(library.find, "hemisphere-10").hint
    assert "clothoid:small or clothoid:medium" in refused(library.find, "clothoid").hint
    error = refused(library.find, "clothoid", "huge")
    assert error.code == "no-such-size" and "'huge'" in str(error)
    assert refused(library.find, "hemisphere-d10", "small").code == "no-such-size"
    assert refused(library.find, "zzz").hint == "see styluscam tool list"


# --- libraries in files --------------------------------------------------------------------------------------------


def test_a_library_of_one_s_own(tmp_path: Path) -> None:
    large = {"profile": {**BALL, "diameter": 12.0}, "length": 60.0}
    sizes = {"name": "b", "title": "Ball", "sizes": {"s": BALL, "l": large}, "length": 50.0}
    mine = library.read_library(written(tmp_path / "mine.json", shelf({"name": "a", "profile": BALL}, sizes)))
    assert list(mine.tools) == ["a", "b:s", "b:l"]
    assert mine.find("b", "l") == {
        "name": "b:l", "title": "Ball, l", "length": 60.0, "profile": {**BALL, "diameter": 12.0}
    }  # fmt: skip
    assert mine.find("b", "s")["length"] == 50.0
    assert sc.Tool.from_dict(mine.find("a")).diameter == 6.0


@pytest.mark.parametrize(
    ("document", "stated", "hint"),
    [
        ("", "not a library", "JSON"),
        ("[1]", "JSON object", ""),
        ('{"tools": [], "tools": []}', "'tools' is given twice", ""),
        ({"schema": 1}, "no list of tools", "ball-d10"),
        (shelf(), "no list of tools", ""),
        (shelf({"name": "a", "profile": BALL}, schema=2), "newer StylusCAM: schema 2", "update"),
        (shelf({"name": "a", "profile": BALL}, schema="one"), "whole number", ""),
        (shelf({"name": "a", "profile": BALL}, tool=[]), "unknown key 'tool'", "'tools'"),
        (shelf({"name": "a", "profile": BALL, "lengths": 5}), "a: unknown key 'lengths'", "'length'"),
        (shelf({"name": "a", "profile": {**BALL, "diametr": 5}}), "unknown key 'diametr'", "'diameter'"),
        (shelf({"name": "a", "profile": {"kind": "bal", "diameter": 5}}), "unknown kind 'bal'", "'ball'"),
        (shelf({"name": "a", "profile": "ball"}), "not a profile", "kind"),
        (shelf({"name": "a"}), "no profile", "profile"),
        (shelf({"profile": BALL}), "tool 1: needs a name", ""),
        (shelf({"name": "a:b", "profile": BALL}), "needs a name, not 'a:b'", "':'"),
        (shelf({"name": "a", "profile": BALL}, {"name": "a", "profile": BALL}), "two tools are called 'a'", "unique"),
        (shelf({"name": "a", "profile": BALL, "sizes": {"s": BALL}}), "both a profile and sizes", ""),
        (shelf({"name": "a", "sizes": {}}), "sizes are profiles by name", "small"),
        (shelf({"name": "a", "sizes": {"s": {"kind": "ball", "width": 5}}}), "size s of kind ball: unknown", ""),
        (
            shelf({"name": "a", "sizes": {"s": {"profile": BALL, "lengths": 5}}}),
            "size s: unknown key 'lengths'",
            "'length'",
        ),
        (shelf(5), "tool 1: not an object", ""),
        (shelf({"name": "a\nb", "profile": BALL}), "one line of text", ""),
    ],
)
def test_slips_in_a_library_are_named(tmp_path: Path, document: Any, stated: str, hint: str) -> None:
    error = refused(library.read_library, written(tmp_path / "mine.json", document))
    assert stated in str(error) and hint in error.hint and "mine.json" in str(error)


def test_a_library_that_is_not_there(tmp_path: Path) -> None:
    assert refused(library.read_library, tmp_path / "none.json").code == "unreadable"
    (tmp_path / "deep.json").write_text("[" * 100_000)
    assert refused(library.read_library, tmp_path / "deep.json").code == "unreadable"


# --- tool files ----------------------------------------------------------------------------------------------------

EXACT = {"kind": "clothoid", "diameter": 3.175 + 1e-11, "tip_flat": 1.0 / 3.0}


@pytest.mark.parametrize("more", ({"shank_diameter": 4.0 / 3.0, "length": 100.0 / 3.0}, {"length": 100.0 / 3.0}, {}))
@pytest.mark.parametrize("ending", (".json", ".fctb"))
def test_files_keep_every_bit(tmp_path: Path, ending: str, more: Any) -> None:
    document = {"title": "Odd one", "profile": EXACT, **more}
    tool = sc.Tool.from_dict(document)
    tool.write(tmp_path / f"odd{ending}")
    read = sc.Tool.read(tmp_path / f"odd{ending}")
    assert read.to_dict() == tool.to_dict()
    assert read.to_dict()["profile"]["diameter"] == EXACT["diameter"]
    assert read.to_dict().get("length") == more.get("length") and read.remarks == ()
    assert read.title == "Odd one"
    assert [file.name for file in tmp_path.iterdir()] == [f"odd{ending}"]


def test_random_documents_keep_every_bit(tmp_path: Path) -> None:
    generator = np.random.default_rng(5)
    for _ in range(50):
        diameter = float(generator.uniform(1.0, 30.0))
        tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": diameter}})
        for ending in (".json", ".fctb"):
            tool.write(tmp_path / f"t{ending}")
            assert sc.Tool.read(tmp_path / f"t{ending}").to_dict()["profile"]["diameter"] == diameter


@pytest.mark.parametrize(
    ("document", "stated", "hint"),
    [
        ({"profile": {"kind": "clotoid", "diameter": 5}}, "unknown kind 'clotoid'", "'clothoid'"),
        ({"profile": {**BALL, "tipflat": 5}}, "unknown key 'tipflat'", "'tip_flat'"),
        ({"profile": BALL, "shank_dia": 5}, "unknown key 'shank_dia'", "'shank_diameter'"),
        ({"profile": {"kind": "ball", "diameter": -1.0}}, "diameter = -1", ""),
        ({"profile": BALL, "schema": 9}, "newer", "update"),
        ({"name": "a"}, "no profile", ""),
        ({"profile": {"kind": ["ball"], "diameter": 5}}, "unknown kind ['ball']", "ball"),
        ('{"profile": {"kind": "ball", "diameter": NaN}}', "NaN is not a finite number", "JSON"),
        ('{"profile": {"kind": "ball", "diameter": 1e999}}', "1e999 is not a finite number", "JSON"),
        ({"profile": BALL, "name": 5}, "name must be", ""),
    ],
)
def test_slips_in_a_tool_file_are_named(tmp_path: Path, document: Any, stated: str, hint: str) -> None:
    error = refused(sc.Tool.read, written(tmp_path / "t.json", document))
    assert stated in str(error) and hint in error.hint and "t.json" in str(error)


def test_a_tool_file_appears_whole_or_not_at_all(tmp_path: Path) -> None:
    tool = sc.Tool.from_dict({"profile": BALL})
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(sc.StylusError):
        tool.write(tmp_path / "folder.json")
    assert [file.name for file in tmp_path.iterdir()] == ["folder.json"]


def test_file_names_are_safe() -> None:
    assert toolfile.file_name("clothoid:medium") == "clothoid-medium"
    assert toolfile.file_name("../..") == "tool"
    assert toolfile.file_name("a / b") == "a-b"


# --- starters ------------------------------------------------------------------------------------------------------


def test_there_is_a_starter_of_every_kind() -> None:
    assert set(toolfile.profile_keys()) == set(starters.profiles())


@pytest.mark.parametrize("kind", sorted(toolfile.profile_keys()))
def test_a_starter_builds_and_its_outline_is_convex(kind: str) -> None:
    tool = sc.Tool.from_dict(starters.starter(kind))
    outline = polyline(tool)
    assert outline[0] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert outline[-1] == pytest.approx([tool.diameter / 2.0, float(tool.height_at(tool.max_slope))], abs=1e-9)
    steps = np.diff(outline, axis=0)
    assert (steps >= -1e-9).all()
    slopes = np.arctan2(steps[:, 1], steps[:, 0])
    assert (np.diff(slopes) > -1e-6).all()


def test_outlines_have_straight_parts_with_exact_ends() -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "clothoid", "diameter": 10.0, "tip_flat": 1.0}})
    flat, curve = pieces(tool)
    assert flat.straight and flat.points.tolist() == [[0.0, 0.0], [1.0, 0.0]]
    assert not curve.straight and curve.points[-1, 0] == pytest.approx(5.0)


@pytest.mark.parametrize("stations", (3, 5, 65))
@pytest.mark.parametrize("side_deg", (20.0, 56.7))
def test_a_straight_part_has_exact_ends_at_any_slope(stations: int, side_deg: float) -> None:
    profile = {"kind": "cone", "tip_radius": 2.0, "half_angle_deg": side_deg, "diameter": 20.0, "tip_flat": 1.0}
    flat, arc, side = pieces(sc.Tool.from_dict({"profile": profile}), stations)
    slope = math.radians(90.0 - side_deg)
    foot = [1.0 + 2.0 * math.sin(slope), 2.0 * (1.0 - math.cos(slope))]
    assert flat.straight and side.straight and not arc.straight
    assert flat.points.tolist() == [[0.0, 0.0], [1.0, 0.0]]
    assert arc.points[-1] == pytest.approx(foot, abs=1e-14) and arc.points[0].tolist() == [1.0, 0.0]
    rim = [10.0, foot[1] + (10.0 - foot[0]) * math.tan(slope)]
    assert side.points == pytest.approx(np.array([foot, rim]), abs=1e-13)


def test_the_engine_names_the_parts_of_an_outline() -> None:
    arc, side = sc.Tool.from_dict(starters.starter("cone")).outline()
    assert not arc.straight and side.straight
    assert arc.slopes == (0.0, side.slopes[0]) and side.slopes[0] == side.slopes[1]
    assert arc.outer == side.inner and side.outer[0] == 5.0


@pytest.mark.parametrize("kind", ("cylindrical", "chamfer", "tangent"))
def test_a_base_joins_rim_and_shank(kind: str) -> None:
    points = transition({"kind": kind, "height": 4.0}, (5.0, 3.0), 8.0)
    assert points[0].tolist() == [5.0, 3.0] and points[-1] == pytest.approx([8.0, 7.0])
    assert (np.diff(points, axis=0) >= 0.0).all()
    if kind == "tangent":
        assert abs(points[1, 0] - points[0, 0]) < 0.06 * (points[1, 1] - points[0, 1])


def test_without_a_base_a_wider_shank_begins_behind_a_cone() -> None:
    assert transition(None, (5.0, 3.0), 8.0).tolist() == [[5.0, 3.0], [8.0, 6.0]]
    assert transition(None, (5.0, 3.0), 4.0).tolist() == [[5.0, 3.0], [4.0, 3.0]]


def test_a_silhouette_has_shank_and_holder() -> None:
    flat = {"profile": {"kind": "flat", "diameter": 1.0}, "shank_diameter": 3.0}
    tool = sc.Tool.from_dict(flat)
    assert silhouette(tool, flat, 9.0).tolist() == [[0, 0], [0.5, 0], [1.5, 1], [1.5, 9]]
    whole = {**flat, "base": {"kind": "cylindrical", "height": 3.0}, "length": 30.0}
    assert silhouette(tool, whole, 9.0).tolist()[2:] == [[0.5, 3], [1.5, 3], [1.5, 30], [0, 30]]
    held = {**whole, "holder": {"diameter": 20.0, "length": 15.0}}
    assert silhouette(tool, held, 9.0).tolist()[4:] == [[1.5, 30], [10, 30], [10, 45], [0, 45]]


def test_descriptions_have_short_numbers() -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "formula", "r": "6*sin(t)", "z": "4*(1-cos(t))", "t": [0.0, 1.5]}})
    assert tool.description == "formula D11.97"
    assert sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 4.7625}}).description == "ball D4.7625"
    assert sc.Tool.from_dict(starters.starter("formula")).max_slope == pytest.approx(math.pi / 2.0)


def test_outlines_of_kinds_with_corners() -> None:
    cone = pieces(sc.Tool.from_dict(starters.starter("cone")))
    assert [piece.straight for piece in cone] == [False, True]
    assert cone[0].points[-1] == pytest.approx([0.5 * math.cos(math.pi / 6), 0.5 * (1.0 - 0.5)], abs=1e-9)
    assert [len(piece.points) for piece in pieces(sc.Tool.from_dict(starters.starter("flat")))] == [2]
    v = pieces(sc.Tool.from_dict(starters.starter("v")))
    assert [piece.straight for piece in v] == [True, True]
    assert v[1].points == pytest.approx(np.array([[0.1, 0.0], [5.0, 4.9]]), abs=1e-9)


# --- FreeCAD's own bits --------------------------------------------------------------------------------------------


def native(shape: str, **parameters: str) -> dict[str, Any]:
    return {"version": 2, "name": "Native", "shape": f"{shape}.fcstd", "parameter": parameters, "attribute": {}}


LENGTHS = {"Length": "50.0000 mm", "ShankDiameter": "3.0000 mm", "CuttingEdgeHeight": "30.0000 mm"}


@pytest.mark.parametrize(
    ("bit", "profile"),
    [
        (native("ballend", Diameter="6.0000 mm", **LENGTHS), {"kind": "ball", "diameter": 6.0}),
        (native("endmill", Diameter='1/8"', **LENGTHS), {"kind": "flat", "diameter": 3.175}),
        (
            native("bullnose", Diameter="6,50 mm", CornerRadius="1,50 mm", **LENGTHS),
            {"kind": "bull-nose", "diameter": 6.5, "corner_radius": 1.5},
        ),
        (
            native("v-bit", Diameter="10 mm", TipDiameter="0.1 mm", CuttingEdgeAngle="60.0000 \u00b0", **LENGTHS),
            {"kind": "v", "tip_diameter": 0.1, "angle_deg": 60.0, "diameter": 10.0},
        ),
        (
            native("chamfer", Diameter="12 mm", TipDiameter="5 mm", CuttingEdgeAngle="45 \u00b0", **LENGTHS),
            {"kind": "v", "tip_diameter": 5.0, "angle_deg": 45.0, "diameter": 12.0},
        ),
        (
            native("taperedballnose", Diameter="1 mm", TaperAngle="10 \u00b0", TaperDiameter="6 mm", **LENGTHS),
            {"kind": "tapered-ball", "tip_radius": 0.5, "half_angle_deg": 5.0, "diameter": 6.0},
        ),
    ],
    ids=lambda value: value.get("shape", "") if "shape" in value else "",
)
def test_freecad_s_bits_are_read_as_the_nearest_kind(tmp_path: Path, bit: Any, profile: Any) -> None:
    document, remarks = fctb.read(written(tmp_path / "bit.fctb", bit))
    assert document["profile"] == {**profile, **{k: pytest.approx(v) for k, v in profile.items() if k != "kind"}}
    assert document["length"] == 50.0 and document["shank_diameter"] == 3.0
    assert document["name"] == "bit" and document["title"] == "Native"
    assert len(remarks) == 2
    tool = sc.Tool.read(tmp_path / "bit.fctb")
    assert tool.remarks == tuple(remarks) and tool.report()["notes"][:2] == remarks


@pytest.mark.parametrize(
    ("bit", "stated"),
    [
        (native("probe", Diameter="6 mm"), "no profile is known for a bit of shape 'probe'"),
        (native("ballend"), "without Diameter"),
        (native("ballend", Diameter="6 parsec"), "not a length"),
        (native("ballend", Diameter="1/0 mm"), "not a number"),
        (native("ballend", Diameter="1.2.3 mm"), "not a number"),
        ({"shape": "stylus.fcstd", "parameter": {"Profile": "{"}}, "not JSON"),
        ({"shape": "stylus.fcstd", "parameter": {"Profile": "[]"}}, "no JSON object"),
        ({"shape": "stylus.fcstd", "parameter": []}, "parameter is no object"),
        ("<xml/>", "not a tool bit"),
    ],
)
def test_bits_that_are_no_tools_are_refused(tmp_path: Path, bit: Any, stated: str) -> None:
    error = refused(sc.Tool.read, written(tmp_path / "bit.fctb", bit))
    assert stated in str(error) and "bit.fctb" in str(error)


def test_a_length_changed_in_freecad_counts(tmp_path: Path) -> None:
    sc.Tool.from_dict({"profile": BALL, "length": 100.0 / 3.0, "shank_diameter": 6.0}).write(tmp_path / "b.fctb")
    bit = json.loads((tmp_path / "b.fctb").read_text())
    bit["parameter"] |= {"Length": "45.00 mm", "ShankDiameter": "6.00 mm", "Diameter": "6.00 mm"}
    read = sc.Tool.read(written(tmp_path / "c.fctb", bit))
    assert read.to_dict()["length"] == 45.0 and read.to_dict()["shank_diameter"] == 6.0
    assert read.remarks == ("Length was changed in FreeCAD from 33.3333 to 45 mm",)
    bit["parameter"]["Length"] = "33.36 mm"
    assert sc.Tool.read(written(tmp_path / "e.fctb", bit)).to_dict()["length"] == 33.36
    bit["parameter"]["Length"] = "33.33 mm"
    assert sc.Tool.read(written(tmp_path / "d.fctb", bit)).to_dict()["length"] == 100.0 / 3.0


@pytest.mark.parametrize(
    ("text", "length"),
    [("33.3 mm", 100.0 / 3.0), ("33 mm", 100.0 / 3.0), ("33,333 mm", 100.0 / 3.0), ("33.334 mm", 33.334),
     ("33.4 mm", 33.4), ('1.3123 "', 100.0 / 3.0), ('1.3124 "', 1.3124 * 25.4), ('1 5/16"', 33.3375)],
)  # fmt: skip
def test_a_length_is_compared_as_it_is_shown(tmp_path: Path, text: str, length: float) -> None:
    sc.Tool.from_dict({"profile": BALL, "length": 100.0 / 3.0}).write(tmp_path / "b.fctb")
    bit = json.loads((tmp_path / "b.fctb").read_text())
    bit["parameter"]["Length"] = text
    assert sc.Tool.read(written(tmp_path / "c.fctb", bit)).to_dict()["length"] == pytest.approx(length, rel=1e-15)


def test_freecad_s_rounding_of_lengths_that_a_tool_leaves_open(tmp_path: Path) -> None:
    tool = sc.Tool.from_dict({"profile": {"kind": "ball", "diameter": 3.175}})
    tool.write(tmp_path / "b.fctb")
    bit = json.loads((tmp_path / "b.fctb").read_text())
    bit["parameter"] |= {"Length": "41.59 mm", "ShankDiameter": "3.17 mm"}
    assert sc.Tool.read(written(tmp_path / "c.fctb", bit)).to_dict() == tool.to_dict()
    bit["parameter"] |= {"Length": "50.00 mm"}
    assert sc.Tool.read(written(tmp_path / "c.fctb", bit)).to_dict() == {**tool.to_dict(), "length": 50.0}


def test_a_bit_keeps_the_tool_s_name_and_a_high_base(tmp_path: Path) -> None:
    base = {"kind": "cylindrical", "height": 45.0}
    document = {"name": "a:b", "title": "A ball", "profile": BALL, "base": base, "shank_diameter": 8.0}
    tool = sc.Tool.from_dict(document)
    tool.write(tmp_path / "other.fctb")
    read = sc.Tool.read(tmp_path / "other.fctb")
    assert (read.name, read.title, read.to_dict(), read.remarks) == ("a:b", "A ball", tool.to_dict(), ())


@pytest.mark.parametrize(
    ("exact", "stated"),
    [
        ('{"profile": {"kind": "ball", "kind": "flat", "diameter": 6}}', "'kind' is given twice"),
        (json.dumps({"schema": 9, "profile": BALL}), "newer StylusCAM"),
    ],
)
def test_slips_in_a_bit_s_document_are_named(tmp_path: Path, exact: str, stated: str) -> None:
    bit = {"shape": "stylus.fcstd", "parameter": {"Profile": exact}, "attribute": {}}
    assert stated in str(refused(sc.Tool.read, written(tmp_path / "b.fctb", bit)))


def test_a_diameter_changed_in_freecad_is_noted(tmp_path: Path) -> None:
    bit = {"shape": "stylus.fcstd", "parameter": {"Profile": json.dumps(BALL), "Diameter": "8.00 mm"}, "attribute": {}}
    (remark,) = sc.Tool.read(written(tmp_path / "b.fctb", bit)).remarks
    assert remark == "Diameter was changed in FreeCAD to 8 mm: the profile of 6 mm counts"


@pytest.mark.parametrize(
    ("document", "stated"),
    [
        (
            {"profile": {"kind": "ball", "diameter": math.nan}},
            "profile.diameter: expected a text, a finite number, a list or a dict, got float nan",
        ),
        (
            {"profile": {"kind": "points", "points": [[0.0, 0.0], [1.0, math.inf]]}},
            "profile.points[1][1]: expected a text, a finite number, a list or a dict, got float inf",
        ),
        (
            {"profile": {"kind": "points", "points": object()}},
            "profile.points: expected a text, a finite number, a list or a dict, got a value of type object",
        ),
        (
            {"profile": {"kind": "ball", "diameter": {3.0}}},
            "profile.diameter: expected a text, a finite number, a list or a dict, got a value of type set",
        ),
    ],
)
def test_what_is_no_document_is_named(document: Any, stated: str) -> None:
    assert stated in str(refused(sc.Tool.from_dict, document))


def test_a_tool_file_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    (tmp_path / "t.json").write_text(json.dumps({"profile": BALL}), encoding="utf-8-sig")
    assert sc.Tool.read(tmp_path / "t.json").diameter == 6.0


@pytest.mark.parametrize("length", (None, "a", [1.0], True, {}))
def test_a_malformed_length_in_a_bit_is_the_user_s(tmp_path: Path, length: Any) -> None:
    document = {"profile": BALL, "length": length}
    bit = {"shape": "stylus.fcstd", "parameter": {"Profile": json.dumps(document), "Length": "40 mm"}, "attribute": {}}
    if length is None:
        assert sc.Tool.read(written(tmp_path / "b.fctb", bit)).to_dict().get("length") is None
    else:
        assert "b.fctb" in str(refused(sc.Tool.read, written(tmp_path / "b.fctb", bit)))


def test_the_cutting_edge_of_a_bit_is_a_base(tmp_path: Path) -> None:
    bit = native("endmill", Diameter="1 mm", CuttingEdgeHeight="4 mm", Length="38 mm", ShankDiameter="3 mm")
    read = sc.Tool.read(written(tmp_path / "e.fctb", bit)).to_dict()
    assert read["base"] == {"kind": "cylindrical", "height": 4.0}
    bit["shape"], bit["parameter"]["Diameter"] = "ballend.fcstd", "2 mm"
    assert sc.Tool.read(written(tmp_path / "e.fctb", bit)).to_dict()["base"]["height"] == 3.0
    bit["parameter"]["ShankDiameter"] = "2 mm"
    assert "base" not in sc.Tool.read(written(tmp_path / "e.fctb", bit)).to_dict()


def test_a_profile_alone_is_a_stylus_too(tmp_path: Path) -> None:
    bit = {"shape": "stylus.fcstd", "parameter": {"Profile": json.dumps(BALL)}, "attribute": {}}
    assert sc.Tool.read(written(tmp_path / "b.fctb", bit)).diameter == 6.0


@pytest.mark.parametrize(
    ("text", "value"),
    [("5.0000 mm", 5.0), ('0.375 "', 9.525), ("0.5 in", 12.7), ("1 1/8 in", 28.575), ("1,234.5 mm", 1234.5),
     ("1.234,5 mm", 1234.5),
     ("45\u00b0", 45.0), ("12", 12.0), ("250 \u00b5m", 0.25), ("1e1 mm", 10.0), (7, 7.0)],
)  # fmt: skip
def test_lengths_are_read_as_freecad_writes_them(text: Any, value: float) -> None:
    assert fctb.number(text, "x") == pytest.approx(value, rel=1e-12)
