"""`sc.cutting_data`: the table's numbers, engagement, limits, a shop's own table."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import styluscam as sc
from styluscam.errors import JobError
from styluscam.programs.cutting import cutting_materials

FLAT = {"profile": {"kind": "flat", "diameter": 6.0}, "flutes": 2, "cutter_material": "carbide"}
BALL = {"profile": {"kind": "ball", "diameter": 10.0}, "flutes": 2, "cutter_material": "carbide"}

SHOP = """
[[materials]]
name = "aluminium"
data = [{ cutter = "carbide", work = ["rough-milling"], speed_m_min = 200, chip_mm = [[6, 0.02]], source = "our trials" }]
"""


def test_the_tool_states_its_flutes_and_its_material() -> None:
    data = sc.cutting_data(FLAT, "aluminium")
    # 367 m/min, 0.04 mm per tooth
    assert data.rpm == pytest.approx(367_000.0 / (6.0 * math.pi), rel=1e-12)
    assert data.feed == pytest.approx(0.08 * data.rpm, rel=1e-12) and data.plunge == pytest.approx(0.5 * data.feed)
    assert data.speed_m_min == pytest.approx(367.0) and data.chip == pytest.approx(0.04)
    assert len(data.reasons) == 2 and "atagroup" in data.sources[0]
    assert sc.cutting_data(FLAT, "aluminium", flutes=3).feed == pytest.approx(1.5 * data.feed, rel=1e-12)
    # 250 ft/min
    assert sc.cutting_data(FLAT, "aluminium", cutter_material="hss").speed_m_min == pytest.approx(76.2)


def test_a_tool_keeps_its_flutes_and_material(tmp_path: Path) -> None:
    tool = sc.Tool(FLAT)
    tool.write(tmp_path / "mine.json")
    assert sc.Tool(tmp_path / "mine.json") == tool and tool.to_dict()["flutes"] == 2
    with pytest.raises(sc.ToolError, match="flutes"):
        sc.Tool({**FLAT, "flutes": 0})
    with pytest.raises(sc.ToolError, match="unknown value") as caught:
        sc.Tool({**FLAT, "cutter_material": "wood"})
    assert "cutter_material" in caught.value.where


def test_engagement_is_taken_into_account() -> None:
    # 1 mm deep a ball of 10 mm cuts on 6 mm, at a slope whose sine is 0.6; 0.6 mm of 6 are engaged with a sine of 0.6
    data = sc.cutting_data(BALL, "aluminium", depth=1.0, width=0.6)
    assert data.diameter == pytest.approx(6.0) and data.feed_per_tooth == pytest.approx(0.08 / 0.36)
    assert data.chip == pytest.approx(0.08)
    assert sc.cutting_data(FLAT, "aluminium", angle_deg=30.0).feed_per_tooth == pytest.approx(0.08)
    with pytest.raises(JobError) as caught:
        sc.cutting_data(FLAT, "aluminium", width=1.0, angle_deg=30.0)
    assert (caught.value.code, caught.value.where) == ("conflict", "angle_deg")


def test_the_machine_s_limits_hold_and_numbers_go_before_them() -> None:
    document = sc.Machine("linuxcnc").document
    machine = {**document, "limits": {**document["limits"], "max_rpm": 10_000.0, "max_feed": 700.0}}
    data = sc.cutting_data(FLAT, "aluminium", machine=machine)
    assert (data.rpm, data.feed) == (10_000.0, 700.0)
    data = sc.cutting_data(FLAT, "aluminium", machine=machine, max_rpm=5_000.0)
    assert (data.rpm, data.feed) == (5_000.0, pytest.approx(400.0))


def test_a_shop_s_table_goes_before_the_shipped_one(tmp_path: Path) -> None:
    file = tmp_path / "shop.toml"
    file.write_text(SHOP)
    data = sc.cutting_data(FLAT, "aluminum", table=file)
    assert data.speed_m_min == pytest.approx(200.0) and data.sources == ["our trials"]
    assert sc.cutting_data(FLAT, "aluminium", "finish-milling", table=file).speed_m_min == pytest.approx(440.0)
    own = cutting_materials(file)[0]
    assert own.data[0].speed_m_min == [200.0, 200.0] and own.title == "aluminium, wrought alloys"
    file.write_text(SHOP.replace("200", "-1"))
    with pytest.raises(JobError, match=r"shop\.toml: materials\[0\]\.data\[0\]\.speed_m_min") as caught:
        sc.cutting_data(FLAT, "aluminium", table=file)
    assert caught.value.code == "cutting-data"
    with pytest.raises(JobError, match=r"none\.toml: cannot be read"):
        sc.cutting_data(FLAT, "aluminium", table=tmp_path / "none.toml")


def test_what_is_not_known_lists_what_is() -> None:
    with pytest.raises(JobError) as caught:
        sc.cutting_data(FLAT, "unobtainium")
    assert caught.value.code == "unknown"
    assert all(f'"{one.name}"' in caught.value.hint for one in cutting_materials())
    with pytest.raises(JobError, match="turning"):
        sc.cutting_data(FLAT, "aluminium", "turning")
    with pytest.raises(JobError) as caught:
        sc.cutting_data({"profile": FLAT["profile"], "flutes": 2}, "aluminium")
    assert (caught.value.code, caught.value.where) == ("missing", "cutter_material")


def test_every_shipped_number_has_its_source() -> None:
    for material in cutting_materials():
        for entry in material.data:
            assert entry.sources and all(len(source) > 30 for source in entry.sources), material.name


# --- what a job leaves out ----------------------------------------------------------------------------------------


def job(operation: dict[str, object] | None = None, **changed: object) -> dict[str, object]:
    """A job of rows in aluminium that states neither feeds nor the spindle."""
    rows = {"kind": "zig-zag", "tool": "cutter", "stepover": 2.0, "id": "rows"}
    return {
        "schema": 1,
        "part": {"file": "part.stl", "units": "mm"},
        "process": {"kind": "milling", "material": "aluminium"},
        "tools": {"cutter": FLAT},
        "operations": [{**rows, **(operation or {})}],
        "machine": {"name": "linuxcnc"},
        **changed,
    }


def feeds_of(made: sc.Job) -> tuple[float, float, float]:
    operation = made.document["operations"][0]
    return operation["feeds"]["cut"], operation["feeds"]["plunge"], operation["spindle"].get("rpm")


def test_feeds_and_spindle_that_a_job_leaves_out_follow_from_its_material() -> None:
    # 440 m/min: 23342.2 rev/min; 0.04 mm per tooth: 1867.4 mm/min, 933.7 mm/min
    made = sc.Job(job())
    assert feeds_of(made) == (1867.0, 933.0, 23342.0)
    assert made.cutting_data["rows"].reasons and "atagroup" in made.cutting_data["rows"].sources[0]
    # roughing: 367 m/min, at the engagement angle of the pocket, 60 deg
    pocket = {"kind": "pocket", "tool": "cutter", "step": {"height": 2.0}, "engagement_deg": 60.0, "id": "rows"}
    rpm = 367_000.0 / (6.0 * math.pi)
    cut = 0.08 * rpm / math.sin(math.radians(60.0))
    assert feeds_of(sc.Job({**job(), "operations": [pocket]})) == (
        math.floor(cut),
        math.floor(0.04 * rpm),
        math.floor(rpm),
    )


def test_numbers_of_the_job_go_before_the_table() -> None:
    stated = {"feeds": {"cut": 700.0, "plunge": 50.0}, "spindle": {"mode": "fixed", "rpm": 9000.0}}
    made = sc.Job(job(stated))
    assert feeds_of(made) == (700.0, 50.0, 9000.0) and made.cutting_data == {}
    # the feed follows the spindle that is stated
    assert feeds_of(sc.Job(job({"spindle": stated["spindle"]}))) == (720.0, 360.0, 9000.0)
    assert feeds_of(sc.Job(job({"feeds": {"cut": 700.0}}))) == (700.0, 700.0, 23342.0)
    # a tool that states nothing is asked for nothing
    bare = {"cutter": {"profile": FLAT["profile"]}}
    assert feeds_of(sc.Job(job(stated, tools=bare)))[0] == 700.0
    with pytest.raises(JobError) as caught:
        sc.Job(job(tools=bare))
    assert (caught.value.code, caught.value.where) == ("missing", "tools.cutter.cutter_material")


def test_without_a_material_a_job_is_as_it_was() -> None:
    made = sc.Job(job({"spindle": {"mode": "off"}}, process={"kind": "milling"}))
    assert feeds_of(made) == (1500.0, 300.0, None) and made.cutting_data == {}


def test_the_limits_of_the_job_s_machine_hold(tmp_path: Path) -> None:
    document = 'extends = "linuxcnc"\nname = "slow"\nlimits = { max_rpm = 12000.0 }\n'
    (tmp_path / "slow.toml").write_text(document)
    made = sc.Job.from_dict(job(machine={"file": "slow.toml"}), tmp_path)
    assert feeds_of(made) == (960.0, 480.0, 12000.0)


def test_a_job_takes_a_shop_s_table_and_a_library_s_tool(tmp_path: Path) -> None:
    (tmp_path / "shop.toml").write_text(SHOP.replace("rough-milling", "finish-milling"))
    sc.Tool(FLAT).write(tmp_path / "mine.json")
    text = """
schema = 1
part = { file = "part.stl", units = "mm" }
process = { kind = "milling", material = "aluminium", cutting_data = "shop.toml" }
machine = { name = "linuxcnc" }
tools = { cutter = { library = "mine.json" } }

[[operations]]
kind = "zig-zag"
tool = "cutter"
stepover = 2.0
"""
    (tmp_path / "job.toml").write_text(text)
    made = sc.Job(tmp_path / "job.toml")
    # 200 m/min, 0.02 mm per tooth
    assert feeds_of(made) == (424.0, 212.0, 10610.0)
    assert tmp_path / "shop.toml" in made.inputs()
    assert made.cutting_data["zig-zag-1"].sources == ["our trials"]
    for changed, code in [("shop.toml", "unreadable"), ("aluminium", "unknown")]:
        (tmp_path / "job.toml").write_text(text.replace(changed, "none"))
        with pytest.raises(JobError) as caught:
            sc.Job(tmp_path / "job.toml")
        assert caught.value.code == code


def test_an_unknown_material_of_a_job_lists_the_known_ones() -> None:
    with pytest.raises(JobError) as caught:
        sc.Job(job(process={"kind": "milling", "material": "unobtainium"}))
    assert (caught.value.code, caught.value.where) == ("unknown", "process.material")
    assert '"stainless"' in caught.value.hint
