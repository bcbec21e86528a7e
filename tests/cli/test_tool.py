"""`styluscam tool`: list, show, new, plot and suggest."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest

import styluscam as sc
from styluscam.tools import library, toolfile

from .conftest import COARSE_CUP, changed, write_step

SHELF = {
    "schema": 1,
    "name": "mine",
    "title": "Two balls and a clothoid",
    "tools": [
        {"name": "ball", "sizes": {"s": {"kind": "ball", "diameter": 6.0}, "l": {"kind": "ball", "diameter": 12.0}}},
        {"name": "clothoid", "title": "flat tip", "profile": {"kind": "clothoid", "diameter": 20.0}, "length": 60.0},
    ],
}


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(SHELF))
    return path


def test_list_names_every_tool(cli: Any, mine: Path) -> None:
    ran = cli("tool", "list")
    assert ran.code == 0 and ran.err == ""
    first = [line.split()[0] for line in ran.out.splitlines() if line.startswith("  ")]
    assert first == library.names()
    document = cli("tool", "list", "--json").json
    assert [tool["name"] for shelf in document for tool in shelf["tools"]] == library.names()
    own = cli("tool", "list", "--library", mine)
    assert "mine: Two balls and a clothoid" in own.out and "ball:s" in own.out and "hemisphere" not in own.out


def test_show_states_what_a_tool_is(cli: Any) -> None:
    ran = cli("tool", "show", "clothoid:medium")
    assert ran.code == 0
    rows = dict(line.strip().split("  ", 1) for line in ran.out.splitlines())
    rows = {key: value.strip() for key, value in rows.items()}
    assert rows["kind"] == "clothoid" and rows["diameter"] == "12 mm" and rows["max slope"] == "90 deg"
    document = cli("tool", "show", "clothoid:medium", "--json").json
    assert document["diameter_mm"] == 12.0 and document["max_slope_deg"] == pytest.approx(90.0)
    assert document["height_mm"] == pytest.approx(12.0 * 5.6195 / 20.0, abs=1e-4)
    assert document["tip_curvature_radius_mm"] is None and document["notes"] == []
    assert cli("tool", "show", "hemisphere-d10", "--json").json["tip_curvature_radius_mm"] == 5.0


def test_show_reads_files_and_own_libraries(cli: Any, mine: Path, tmp_path: Path) -> None:
    assert cli("tool", "show", "ball:l", "--library", mine, "--json").json["diameter_mm"] == 12.0
    sc.Tool.library("hemisphere-d10").write(tmp_path / "h.fctb")
    assert cli("tool", "show", tmp_path / "h.fctb", "--json").json["profile"]["kind"] == "ball"


@pytest.mark.parametrize(
    ("words", "stated"),
    [
        (("show", "clotoid:small"), "did you mean 'clothoid:small'"),
        (("show", "clothoid"), "choose clothoid:small"),
        (("show", "none.json"), "none.json: cannot be read: No such file or directory\n"),
        (("list", "--library", "none.json"), "none.json"),
        (("new", "x.json", "--kind", "bal"), "did you mean 'ball'"),
        (("new", "x.txt", "--kind", "ball"), "ends in .json or .fctb"),
        (("plot", "hemisphere-d10", "--out", "x.pdf"), "call it x.svg"),
        (("plot", "hemisphere-d10", "--out", "x.svg", "--step-mm", "0"), "step_mm"),
        (("plot", *["hemisphere-d10"] * 9, "--out", "x.svg"), "1 to 8"),
    ],
)
def test_slips_are_one_line(cli: Any, tmp_path: Path, monkeypatch: Any, words: Any, stated: str) -> None:
    monkeypatch.chdir(tmp_path)
    ran = cli("tool", *words)
    assert ran.code == 2 and ran.out == "" and ran.err.count("\n") == 1 and stated in ran.err
    assert cli("tool", *words, "--json").json["error"]["message"]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", sorted(toolfile.profile_keys()))
def test_new_writes_a_tool_that_loads(cli: Any, tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"my-{kind}.json"
    ran = cli("tool", "new", path, "--kind", kind)
    assert ran.code == 0 and str(path) in ran.out
    tool = sc.Tool.read(path)
    assert tool.name == f"my-{kind}" and tool.to_dict()["profile"]["kind"] == kind
    assert cli("tool", "new", path, "--kind", kind).code == 2
    assert cli("tool", "new", path, "--kind", kind, "--force", "--json").json == {"written": [str(path)]}
    assert cli("tool", "new", path.with_suffix(".fctb"), "--kind", kind).code == 0
    assert sc.Tool.read(path.with_suffix(".fctb")).to_dict()["profile"] == tool.to_dict()["profile"]


def test_new_begins_with_measured_points(cli: Any, tmp_path: Path) -> None:
    table = tmp_path / "scan.csv"
    table.write_text("r;z\n0;0\n1,5;0,125\n3;0,5\n4,5;1,25\n")
    for path in (tmp_path / "scan.json", tmp_path / "scan.fctb"):
        ran = cli("tool", "new", path, "--points", table, "--fit-tolerance", "0.05")
        assert ran.code == 0, ran.err
        profile = sc.Tool.read(path).to_dict()["profile"]
        assert profile["points"][1] == [1.5, 0.125] and profile["fit_tolerance"] == 0.05
    assert "      [1.5, 0.125],\n" in (tmp_path / "scan.json").read_text()
    table.write_text("r;z\n0;0\n1,5;x\n")
    ran = cli("tool", "new", tmp_path / "no.json", "--points", table)
    assert ran.code == 2 and "scan.csv: line 3: '1,5;x'" in ran.err and not (tmp_path / "no.json").exists()


def test_new_turns_a_tool_into_another_format(cli: Any, mine: Path, tmp_path: Path) -> None:
    bit, back = tmp_path / "c.fctb", tmp_path / "c.json"
    assert cli("tool", "new", bit, "--from", "clothoid", "--library", mine).code == 0
    assert cli("tool", "new", back, "--from", bit).code == 0
    tool = sc.Tool.read(back)
    assert tool.to_dict() == sc.Tool.of_library(library.read_library(mine), "clothoid").to_dict()
    assert tool.title == "flat tip"
    for words in ((), ("--kind", "ball", "--from", "hemisphere-d10")):
        ran = cli("tool", "new", tmp_path / "x.json", *words)
        assert ran.code == 2 and "one of --kind, --from and --points" in ran.err


def test_a_job_takes_a_tool_from_one_s_own_library(cli: Any, mine: Path, tmp_path: Path) -> None:
    text = changed(COARSE_CUP, ('profile = { kind = "clothoid", diameter = 10.0 }', 'library = "mine.json:ball:l"'))
    (tmp_path / "job.toml").write_text(text)
    job = sc.Job.read(tmp_path / "job.toml")
    assert job.to_dict()["tools"]["stylus"]["profile"] == {"kind": "ball", "diameter": 12.0, "tip_flat": 0.0}
    assert mine in job.inputs()
    for name, stated in (
        ("mine.json", "a library of 3 tools, not one tool; name one of them: "),
        ("mine.json:bal:l", "did you mean 'ball:l'"),
        ("mine.json:ball", "choose ball:s or ball:l"),
        ("mine.json:zzz", "see styluscam tool list --library "),
        ("none.json:a", "none.json: cannot be read: No such file"),
    ):
        (tmp_path / "job.toml").write_text(text.replace("mine.json:ball:l", name))
        ran = cli("plan", tmp_path / "job.toml")
        assert ran.code == 2 and ran.err.count("\n") == 1 and stated in ran.err, ran.err


def test_a_library_of_one_tool_is_a_tool_file(cli: Any, tmp_path: Path) -> None:
    one = tmp_path / "one.json"
    one.write_text(json.dumps({"tools": [{"name": "a", "profile": {"kind": "ball", "diameter": 7.0}}]}))
    assert sc.Tool.read(one).diameter == 7.0
    assert cli("tool", "show", f"{one}:a", "--json").json["diameter_mm"] == 7.0
    sc.Tool.read(one).write(tmp_path / "tool.json")
    ran = cli("tool", "show", f"{tmp_path / 'tool.json'}:a")
    assert ran.code == 2 and "one tool, not a library" in ran.err
    assert cli("tool", "list", "--library", tmp_path / "tool.json").code == 2


def test_an_entry_that_cannot_be_built_is_named_and_alone(cli: Any, tmp_path: Path) -> None:
    bad = {"name": "c", "sizes": {"s": {"kind": "ball", "diameter": 3.0, "tip_flat": 1.5}}}
    shop = tmp_path / "shop.json"
    shop.write_text(json.dumps({"tools": [{"name": "a", "profile": {"kind": "ball", "diameter": 3.0}}, bad]}))
    listed = cli("tool", "list", "--library", shop)
    assert listed.code == 0 and "ball D3" in listed.out and "c:s  cannot be built: c:s: tip_flat" in listed.out
    tools = cli("tool", "list", "--library", shop, "--json").json[0]["tools"]
    assert tools[0]["description"] == "ball D3" and "tip_flat" in tools[1]["error"]
    for words in (("c:s", "--library", shop), (f"{shop}:c:s",)):
        ran = cli("tool", "show", *words)
        assert ran.code == 2 and f"{shop}: c:s: tip_flat" in ran.err


def test_one_s_own_library_goes_before_the_shipped_ones(cli: Any, tmp_path: Path) -> None:
    shop = tmp_path / "shop.json"
    shop.write_text(json.dumps({"tools": [{"name": "hemisphere-d12", "profile": {"kind": "ball", "diameter": 7.0}}]}))
    assert cli("tool", "show", "hemisphere-d12", "--library", shop, "--json").json["diameter_mm"] == 7.0
    assert cli("tool", "show", "hemisphere-d10", "--library", shop, "--json").json["diameter_mm"] == 10.0


def test_suggest_names_the_library_s_bad_entry(cli: Any, tmp_path: Path) -> None:
    shop, job = tmp_path / "shop.json", tmp_path / "job.toml"
    shop.write_text(json.dumps({"tools": [{"name": "a", "profile": {"kind": "ball", "diameter": -1.0}}]}))
    job.write_text(COARSE_CUP)
    ran = cli("tool", "suggest", job, "--library", shop)
    assert ran.code == 2 and ran.err.startswith(f"error: {shop}: a: diameter = -1")


@pytest.mark.parametrize("title", ["a$\\frac$b", "cost $5 and $6", "x_1^2"])
def test_any_name_can_be_drawn(cli: Any, tmp_path: Path, title: str) -> None:
    path = tmp_path / "t.json"
    path.write_text(json.dumps({"name": title, "title": title, "profile": {"kind": "ball", "diameter": 7.0}}))
    for names in ([path], [path, path]):
        ran = cli("tool", "plot", *names, "--out", tmp_path / "t.svg")
        assert ran.code == 0, ran.err


def test_positions_that_cannot_be_are_the_user_s(cli: Any, tmp_path: Path) -> None:
    long = tmp_path / ("a" * 300 + ".json")
    for words in (
        ("show", "a" * 5000),
        ("show", long),
        ("new", long, "--kind", "ball"),
        ("plot", "hemisphere-d10", "--out", long.with_suffix(".svg")),
        ("plot", "hemisphere-d10", "--out", "/proc/a.svg"),
    ):
        ran = cli("tool", *words)
        assert ran.code == 2 and ran.err.count("\n") == 1, ran.err[:300]


def test_plot_draws_svg_and_png(cli: Any, tmp_path: Path) -> None:
    from matplotlib.image import imread

    for ending in ("svg", "png"):
        path = tmp_path / "new" / f"tools.{ending}"
        ran = cli("tool", "plot", "hemisphere-d10", "clothoid:medium", "--out", path, "--step-mm", "0.3")
        assert ran.code == 0 and f"tools.{ending}" in ran.out
        first = path.read_bytes()
        assert cli("tool", "plot", "hemisphere-d10", "clothoid:medium", "--out", path, "--step-mm", "0.3").code == 0
        assert path.read_bytes() == first
    assert imread(tmp_path / "new" / "tools.png").shape[:2] == (600, 1200)
    assert (tmp_path / "new" / "tools.svg").read_text().startswith("<?xml")
    assert sorted(file.name for file in (tmp_path / "new").iterdir()) == ["tools.png", "tools.svg"]


@pytest.mark.parametrize(
    "names",
    [
        ["hemisphere-d3"],
        ["clothoid:large"],
        ["hemisphere-d10", "clothoid:small", "hemisphere-1in"],
        ["held"],
        ["flat-d6"],
    ],
    ids="+".join,
)
def test_nothing_on_a_plot_is_clipped_or_overlaps(names: list[str], tmp_path: Path, monkeypatch: Any) -> None:
    from styluscam.drawing import toolplot

    kept = []
    monkeypatch.setattr(toolplot, "_save", lambda figure, path: kept.append(figure))
    held = {"profile": {"kind": "ball", "diameter": 6.0}, "length": 50.0, "holder": {"diameter": 40.0, "length": 30.0}}
    tools = [sc.Tool.from_dict(held) if name == "held" else sc.Tool.library(name) for name in names]
    toolplot.tool_picture(tools, tmp_path / "t.png")
    (figure,) = kept
    figure.canvas.draw()
    texts = [text for text in figure.texts if text.get_text()]
    for axes in figure.axes:
        labels = [axes.xaxis.label, axes.yaxis.label, axes.title, axes._left_title, axes._right_title]
        ticks = [] if axes is figure.axes[1] else axes.get_xticklabels()
        low, high = sorted(axes.get_ylim())
        sides = [
            label for label, at in zip(axes.get_yticklabels(), axes.get_yticks(), strict=True) if low <= at <= high
        ]
        left, right = axes.get_xlim()
        ticks = [label for label, at in zip(ticks, axes.get_xticks(), strict=False) if left <= at <= right]
        texts += [text for text in [*labels, *ticks, *sides] if text.get_text()]
    boxes = [text.get_window_extent() for text in texts]
    for i, box in enumerate(boxes):
        assert box.x0 >= 0 and box.x1 <= 1200 and box.y0 >= 0 and box.y1 <= 600, texts[i].get_text()
        for j in range(i):
            assert not box.overlaps(boxes[j]), (texts[i].get_text(), texts[j].get_text())


def test_without_matplotlib_the_extra_is_named(cli: Any, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    ran = cli("tool", "plot", "hemisphere-d10", "--out", tmp_path / "p.png")
    assert ran.code == 2 and ran.err.count("\n") == 1 and "styluscam[plot]" in ran.err
    assert not list(tmp_path.iterdir())


FINE_CUP = changed(
    COARSE_CUP,
    ("tolerance = 0.001", "tolerance = 0.01"),
    ("tolerance = 0.005", "tolerance = 0.05"),
    ("height = 4.0", "height = 0.4"),
)


def test_suggest_ranks_by_scallop_and_reach(cli: Any, mine: Path, tmp_path: Path) -> None:
    job = tmp_path / "job.toml"
    job.write_text(FINE_CUP)
    ran = cli("tool", "suggest", job, "--library", mine, "--plan", "2", "--json")
    assert ran.code == 0, ran.err
    document = ran.json
    tools = {tool["name"]: tool for tool in document["tools"]}
    # D12 and D6 fit the R8 fillet; the D20 clothoid leaves less than D12 on the wall but 0.2 mm at the fillet's foot
    assert [tool["name"] for tool in document["tools"]] == ["ball:l", "ball:s", "clothoid"]
    assert tools["clothoid"]["scallop_mean_mm"] < tools["ball:l"]["scallop_mean_mm"]
    assert tools["clothoid"]["unreached_share"] > 0.02 > tools["ball:l"]["unreached_share"]
    assert tools["clothoid"]["bridged_estimate_mm"] > 0.1 and tools["ball:l"]["bridged_estimate_mm"] == 0.0
    assert any("too flat" in reason for reason in tools["clothoid"]["reasons"])
    assert tools["ball:s"]["bridged"] == [] == tools["ball:l"]["bridged"] and tools["clothoid"]["bridged"] is None
    assert tools["ball:l"]["scallop_mean_mm"] < tools["ball:s"]["scallop_mean_mm"]
    walls = document["part"]["walls"]
    assert sum(wall["share"] for wall in walls) == pytest.approx(1.0)
    assert max(walls, key=lambda wall: wall["share"])["angle_deg"] == pytest.approx(45.0, abs=0.1)
    assert document["part"]["smallest_concave_radius_mm"] == pytest.approx(8.0, rel=0.02)
    # what `new` chooses a tool by
    assert document["part"]["fitting_radius_mm"] == pytest.approx(8.0, rel=0.02)
    assert any(re.search(r"up to 16(\.[0-2])? mm fits", reason) for reason in tools["clothoid"]["reasons"])
    table = cli("tool", "suggest", job, "--library", mine, "--plan", "0")
    assert table.code == 0 and table.out.index("ball:l") < table.out.index("ball:s")
    assert not list(tmp_path.glob("*.ngc"))


CAP = (
    ("cone_cup.step", "cap_r60.step"),
    ('faces = ["Face1", "Face2", "Face3", "Face4"]', 'faces = ["Face1"]'),
    ('"back"', '"tool"'),
)


def test_suggest_ranks_by_what_stays_in_a_crease(cli: Any, tmp_path: Path) -> None:
    balls = [{"name": f"d{d}", "profile": {"kind": "ball", "diameter": d}} for d in (3.0, 25.0)]
    shelf = tmp_path / "balls.json"
    shelf.write_text(json.dumps({"schema": 1, "name": "balls", "tools": balls}))
    job = tmp_path / "job.toml"
    job.write_text(changed(FINE_CUP, *CAP))
    estimated = cli("tool", "suggest", job, "--library", shelf, "--plan", "0", "--json").json["tools"]
    planned = cli("tool", "suggest", job, "--library", shelf, "--plan", "2", "--json").json["tools"]
    for tools in (estimated, planned):
        assert [tool["name"] for tool in tools] == ["d3.0", "d25.0"]
        assert tools[1]["scallop_mean_mm"] < tools[0]["scallop_mean_mm"]
    excesses = [max(bridge["excess"] for bridge in tool["bridged"]) for tool in planned]
    assert [tool["bridged_estimate_mm"] for tool in estimated] == pytest.approx(excesses, rel=0.2)


@pytest.mark.parametrize("planned", ["0", "2"])
def test_suggest_ranks_a_tool_that_bridges_behind_one_that_does_not(cli: Any, tmp_path: Path, planned: str) -> None:
    """Levels 4 mm apart: D20 leaves lower scallops than D12, but 0.2 mm in the R8 fillet."""
    balls = [{"name": f"d{d}", "profile": {"kind": "ball", "diameter": d}} for d in (20.0, 12.0)]
    shelf = tmp_path / "balls.json"
    shelf.write_text(json.dumps({"schema": 1, "name": "balls", "tools": balls}))
    job = tmp_path / "job.toml"
    job.write_text(changed(FINE_CUP, ("height = 0.4", "height = 4.0")))
    best, other = cli("tool", "suggest", job, "--library", shelf, "--plan", planned, "--json").json["tools"]
    assert (best["name"], other["name"]) == ("d12.0", "d20.0")
    assert not best["bridges"] and other["bridges"]
    assert other["left_rms_mm"] < best["left_rms_mm"]


def test_suggest_takes_each_operation_s_faces(cli: Any, mine: Path, tmp_path: Path) -> None:
    job = tmp_path / "job.toml"
    floor = '[[operations]]\nid = "floor"\nkind = "zig-zag"\ntool = "stylus"\nstepover = 0.2\nfaces = ["Face1"]\n\n[machine]'
    job.write_text(changed(FINE_CUP, ("[machine]", floor)))
    words = ("tool", "suggest", job, "--library", mine, "--plan", "0")
    document = cli(*words, "--json").json
    cup, only = document["part"]["operations"]
    assert (cup["id"], cup["faces"]) == ("cup", [1, 2, 3, 4]) and (only["id"], only["faces"]) == ("floor", [1])
    alone = cli(*words, "--json", "--operation", "floor").json
    assert [each["id"] for each in alone["part"]["operations"]] == ["floor"]
    assert [wall["angle_deg"] for wall in alone["part"]["walls"]] == pytest.approx([0.0], abs=0.1)
    assert "rows 0.2 mm apart at 0 deg, on Face1" in cli(*words).out
    ran = cli(*words, "--operation", "ground")
    assert ran.code == 2 and "no operation 'ground'" in ran.err and "floor" in ran.err
    job.write_text(changed(FINE_CUP, ('"Face4"', '"Face44"')))
    assert 'no face "Face44"' in cli(*words).err


def test_suggest_puts_last_what_cannot_be_planned(cli: Any, mine: Path, tmp_path: Path, monkeypatch: Any) -> None:
    from styluscam.programs import planning

    plan = planning.plan

    def refusing(job: sc.Job, **more: Any) -> Any:
        if job.document["tools"]["stylus"]["profile"]["diameter"] == 12.0:
            raise sc.PlanError("it meets nothing", code="empty", where="operations[0]")
        return plan(job, **more)

    monkeypatch.setattr(planning, "plan", refusing)
    job = tmp_path / "job.toml"
    job.write_text(FINE_CUP)
    tools = cli("tool", "suggest", job, "--library", mine, "--plan", "2", "--json").json["tools"]
    assert [tool["name"] for tool in tools] == ["ball:s", "clothoid", "ball:l"]
    assert tools[2]["failure"] == "it meets nothing" and "cannot be planned" in tools[2]["reasons"][-1]
    assert tools[0]["bridged"] == []


ROWS = (('"z-level"', '"zig-zag"'), ("step = { height = 4.0 }", "stepover = 10.0\nangle_deg = 30.0"))


def test_suggest_states_what_a_zig_zag_leaves(cli: Any, mine: Path, tmp_path: Path) -> None:
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, *ROWS, ("tolerance = 0.001", "tolerance = 0.01")))
    document = cli("tool", "suggest", job, "--library", mine, "--plan", "0", "--json").json
    assert document["part"]["passes"] == "rows 10 mm apart at 30 deg"
    assert all(tool["bridged"] is None for tool in document["tools"])


def test_suggest_passes_over_upright_walls(cli: Any, mine: Path, tmp_path: Path) -> None:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

    write_step(BRepPrimAPI_MakeBox(60.0, 40.0, 20.0).Shape(), tmp_path / "box.step")
    made = cli("new", tmp_path / "box.step", "--force")
    assert made.code == 0, made.err
    document = sc.Job.read(tmp_path / "box.toml").document
    assert [operation["kind"] for operation in document["operations"]] == ["pocket", "z-level", "zig-zag"]
    ran = cli("tool", "suggest", tmp_path / "box.toml", "--library", mine, "--plan", "0", "--json")
    assert ran.code == 0 and ran.json["part"]["passes"].startswith("rows"), ran.err


def test_suggest_refuses_a_job_without_walls(cli: Any, mine: Path, tmp_path: Path) -> None:
    job = tmp_path / "job.toml"
    job.write_text(changed(COARSE_CUP, ('"Face1", "Face2", "Face3", "Face4"', '"Face1"')))
    ran = cli("tool", "suggest", job, "--library", mine)
    assert ran.code == 2 and "no sloping walls" in ran.err


def test_feeds_prints_speed_and_feeds_with_their_reasons_and_sources(cli: Any) -> None:
    asked = ("tool", "feeds", "ball-d6", "--material", "aluminium", "--cutter", "carbide", "--flutes", "2")
    ran = cli(*asked, "--max-rpm", "12000")
    assert ran.code == 0, ran.err
    rows = dict(
        re.split(r" {2,}", line.strip(), maxsplit=1) for line in ran.out.splitlines() if not line.startswith(" ")
    )
    assert (rows["spindle"], rows["feed"], rows["plunge"]) == ("12000 rev/min", "960 mm/min", "480 mm/min")
    assert "367 m/min" in rows["because"] and "atagroup" in rows["source"]
    document = cli(*asked, "--work", "finish-milling", "--json").json
    assert document["speed_m_min"] == pytest.approx(440.0) and len(document["sources"]) == 1
    wrong = cli(*asked, "--work", "turning")
    assert wrong.code == 2 and "rough-milling" in wrong.err


def test_materials_of_workpieces_are_listed_and_the_listing_is_a_table_again(cli: Any, tmp_path: Path) -> None:
    ran = cli("material", "cutting")
    assert ran.code == 0 and "stainless: stainless steel, austenitic" in ran.out
    names = [material["name"] for material in cli("material", "cutting", "--json").json]
    assert "aluminium" in names and "wood" in names
    table = tmp_path / "shop.toml"
    table.write_text(cli("material", "cutting", "--toml").out)
    again = cli("material", "cutting", "--cutting-data", table, "--json").json
    assert [material["name"] for material in again] == names
