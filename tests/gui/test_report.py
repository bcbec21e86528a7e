"""The page in headless Chromium: it loads without a complaint, maps switch, scrubbing moves the tool, findings jump."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import roots
import styluscam as sc
from blocks import write_stl
from styluscam.report import Subject, comparison_page, heatmaps, report_page

from .browser import Tab, browser

pytestmark = pytest.mark.world

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
WIDE, NARROW = (1400, 900), (390, 844)

JOB = {
    "schema": 1,
    "title": "Coarse cup",
    "part": {"file": "cone_cup.step", "faces": ["Face1", "Face2", "Face3", "Face4"], "model_face": "back"},
    "setup": {
        "zero": "sheet-top",
        "sheet": {"thickness": 1.0},
        "fixture": {"clamp": {"opening": [140.0, 120.0], "height": 8.0}, "backing": {"opening": 90.0}},
    },
    "tools": {
        "stylus": {
            "profile": {"kind": "clothoid", "diameter": 10.0},
            "shank_diameter": 12.0,
            "length": 40.0,
            "holder": {"diameter": 30.0, "length": 25.0},
        }
    },
    "operations": [
        {"id": "cup", "kind": "z-level", "tool": "stylus", "step": {"height": 4.0}, "smallest_feature": 4.0}
    ],
    "machine": {"name": "linuxcnc"},
}
MOVED = 0.2

OVERFLOWING = """[...document.querySelectorAll("section *:not(svg *)")].filter(e => {
  const [inner, outer] = [e.getBoundingClientRect(), e.closest("section").getBoundingClientRect()];
  return inner.width && !e.closest("#ticks") && (inner.right > outer.right + 1 || inner.left < outer.left - 1);
}).map(e => e.className || e.tagName)"""
"""What sticks out of its section."""


def spoilt(text: str) -> str:
    """With one coordinate, halfway through, moved into the wall."""
    lines = text.splitlines()
    number = next(n for n in range(len(lines) // 2, len(lines)) if re.match(r"X\d\d", lines[n]))
    lines[number] = re.sub(r"X([\d.]+)", lambda word: f"X{float(word[1]) + MOVED:.3f}", lines[number])
    return "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def subject() -> Subject:
    """A program with one gouge."""
    pytest.importorskip("OCP", reason="needs the step extra")
    job = sc.Job.from_dict(JOB, FIXTURES)
    text = spoilt(sc.post(sc.plan(job)).text)
    return Subject.judged(sc.verify(text, job), job.machine(), "cup.ngc")


@pytest.fixture(scope="module")
def page(subject: Subject, folder: Path) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 80_000)
        (folder / "cup.html").write_text(report_page(subject), encoding="utf-8")
    return folder / "cup.html"


@pytest.fixture(scope="module")
def tab(folder: Path) -> Iterator[Tab]:
    """A browser; skipped where there can be none, but not in CI, which has to have it."""
    try:
        roots.ensure("browser")
    except roots.Unavailable as error:
        if os.environ.get("CI"):
            pytest.fail(str(error))
        pytest.skip(str(error))
    with browser(folder) as tab:
        yield tab


@pytest.fixture
def opened(tab: Tab, page: Path) -> Tab:
    tab.size(*WIDE)
    tab.open(page)
    tab.drawn()
    return tab


def without_complaints(tab: Tab, page: Path) -> None:
    """Nothing went wrong in a page, and it asked for nothing but itself."""
    assert tab.complaints == []
    assert [url for url in tab.requests if not url.startswith(("data:", "about:"))] == [page.as_uri()]


def tip(tab: Tab) -> np.ndarray:
    """Where the tool that is seen stands, mm."""
    return np.array(
        tab.run(
            """(() => { const { stage, tool } = window.styluscam;
            const { position } = tool.shapes.find(one => one.visible);
            return position.toArray().map((x, k) => x + stage.origin[k]); })()"""
        )
    )


def readout(tab: Tab, key: str) -> str:
    """The text of the readout."""
    return str(tab.run(f"document.querySelector('#readout [data-key={key}]').textContent"))


def test_it_loads_without_a_complaint_and_asks_for_nothing(tab: Tab, page: Path) -> None:
    tab.complaints.clear()
    tab.requests.clear()
    tab.size(*WIDE)
    assert tab.open(page) < 20.0
    tab.drawn()
    without_complaints(tab, page)
    assert tab.run("document.getElementById('stage').classList.contains('flat')") is False
    assert len(tab.picture("#stage")) > 20_000


def test_the_page_fits_wide_and_narrow(opened: Tab) -> None:
    for size in (WIDE, (1050, 700), (700, 900), NARROW):
        opened.size(*size)
        opened.drawn()
        assert opened.run("document.documentElement.scrollWidth") <= size[0]
        assert opened.run(OVERFLOWING) == []
        width, height = opened.run(
            "(() => { const c = document.querySelector('canvas'); return [c.width, c.height] })()"
        )
        assert width > 0.5 * min(size[0], 900) and height >= 300


def test_maps_change_what_is_seen(opened: Tab) -> None:
    seen = [opened.picture("#stage")]
    for key, legend in (
        ("left", "left over, mm"),
        ("gouge", "gouge, mm"),
        ("wall", "wall angle, °"),
        ("thickness", "thickness, mm"),
    ):
        opened.choose("#map", key)
        opened.until(f"document.getElementById('legends').textContent.includes({legend!r})")
        opened.drawn()
        seen.append(opened.picture("#stage"))
        assert opened.run("document.getElementById('map-note').textContent")
    assert len(set(seen)) == len(seen)
    opened.choose("#map", "")
    opened.until("document.getElementById('legends').textContent.startsWith('path')")
    assert opened.complaints == []


def test_the_sheet_and_what_holds_it_stand_where_the_job_states_and_can_be_hidden(opened: Tab) -> None:
    boxes = opened.run(
        """Object.fromEntries(Object.entries(window.styluscam.shapes.layers).map(([key, layer]) => {
        const { geometry } = layer.children[0];
        geometry.computeBoundingBox();
        const { origin } = window.styluscam.stage;
        return [key, [geometry.boundingBox.min, geometry.boundingBox.max].map(p => p.toArray().map((x, k) => x + origin[k]))];
        }))"""
    )
    # a band of 8 % of the larger side around the openings, plates a quarter of it deep; the sheet's top is Z0, it is 1 mm thick
    expected = {
        "blank": [[-81.2, -71.2, -1.0], [81.2, 71.2, 0.0]],
        "clamp": [[-81.2, -71.2, 0.0], [81.2, 71.2, 8.0]],
        "backing": [[-52.2, -52.2, -23.5], [52.2, 52.2, -1.0]],
    }
    for key, box in expected.items():
        np.testing.assert_allclose(boxes[key], box, atol=1e-3)
    # as it stands is rounded to 0.02 mm
    assert boxes["formed-sheet"][1][2] == pytest.approx(0.0, abs=0.015)
    for key in (*expected, "formed-sheet", "tool"):
        shown = opened.picture("#stage")
        opened.click(f"[data-layer={key}]")
        opened.drawn()
        assert opened.picture("#stage") != shown, key
        opened.click(f"[data-layer={key}]")
        opened.drawn()


def test_the_formed_sheet_stands_for_the_part_but_for_a_map(opened: Tab) -> None:
    seen = """(() => { const { part, shapes } = window.styluscam;
    return [part.mesh.visible, shapes.layers["formed-sheet"].visible]; })()"""
    assert opened.run(seen) == [False, True]
    opened.choose("#map", "wall")
    assert opened.run(seen) == [True, False]
    opened.choose("#map", "")
    opened.click("[data-layer=formed-sheet]")
    assert opened.run(seen) == [True, False]
    opened.click("[data-layer=formed-sheet]")
    assert opened.run(seen) == [False, True]


def test_the_path_has_its_colours(opened: Tab) -> None:
    seen = set()
    for by in ("kind", "feed", "height", ""):
        opened.choose("#path-colour", by)
        seen.add(opened.picture("#stage"))
    assert len(seen) == 4


def test_scrubbing_moves_the_tool_to_the_exact_position(opened: Tab, subject: Subject) -> None:
    times, ends, moves = subject.times, subject.positions, subject.program.moves
    for move in (2, 3, len(times) // 3, len(times) // 2, len(times) - 1):
        opened.choose("#time", repr(float(times[move])))
        assert tip(opened) == pytest.approx(ends[move], abs=2e-5)
        assert [float(readout(opened, axis)) for axis in "xyz"] == pytest.approx(ends[move].tolist(), abs=5.1e-5)
        assert int(readout(opened, "line")) == moves["line"][move]
        assert readout(opened, "tool") == "T1: clothoid D10" and readout(opened, "operation") == "cup"
    half = float(times[-2] + times[-3]) / 2.0
    opened.choose("#time", repr(half))
    assert tip(opened) == pytest.approx((ends[-2] + ends[-3]) / 2.0, abs=2e-5)
    opened.click("#forth")
    assert float(readout(opened, "z")) == pytest.approx(ends[-2][2], abs=5.1e-5)
    opened.click("#back")
    assert float(readout(opened, "z")) == pytest.approx(ends[-3][2], abs=5.1e-5)


def test_every_number_of_the_path_is_exact(opened: Tab, subject: Subject) -> None:
    moves = np.linspace(0, len(subject.times) - 1, 500).astype(int)
    given = opened.run(
        f"(() => {{ const p = window.styluscam.player.path; return {moves.tolist()}.map(m => [...p.place(m), p.feeds[m]]) }})()"
    )
    assert np.array_equal(np.array(given)[:, :3], subject.positions[moves])
    assert np.array_equal(np.array(given)[:, 3], subject.program.moves["feed"][moves])


def test_steps_go_from_move_to_move(opened: Tab) -> None:
    opened.choose("#time", "0")
    assert readout(opened, "move").startswith("1 of")
    opened.run("window.styluscam.player.path.times.fill(0, 0, 4)")  # moves that take no time are met too
    for move in (2, 3, 4, 5):
        opened.click("#forth")
        assert readout(opened, "move").startswith(f"{move} of")
    opened.click("#back")
    assert readout(opened, "move").startswith("4 of")


def test_play_moves_on_and_pauses(opened: Tab) -> None:
    opened.choose("#time", "0")
    opened.click("#play")
    opened.until("window.styluscam.player.time > 0.5")
    opened.click("#play")
    stopped = opened.run("window.styluscam.player.time")
    opened.drawn()
    assert opened.run("window.styluscam.player.time") == stopped
    assert opened.run("document.getElementById('play').getAttribute('aria-label')") == "play"


def test_a_click_in_a_plot_goes_to_its_moment(opened: Tab, subject: Subject) -> None:
    opened.run(
        """(() => { const plot = document.querySelector('.over-time .plot'); const r = plot.getBoundingClientRect();
        const f = plot.parentElement.dataset; const x = r.x + r.width * (Number(f.left) + 0.25 * Number(f.width));
        plot.dispatchEvent(new MouseEvent('click', {clientX: x, clientY: r.y + 20, bubbles: true})); })()"""
    )
    assert opened.run("window.styluscam.player.time") == pytest.approx(0.25 * subject.times[-1], rel=0.01)


def test_a_finding_jumps_to_its_position_and_moment(opened: Tab, subject: Subject) -> None:
    before = opened.picture("#stage")
    finding = subject.findings[0]
    opened.click(".finding")
    opened.drawn()
    assert opened.run("window.styluscam.player.time") == pytest.approx(finding["time"])
    assert tip(opened) == pytest.approx(finding["position"], abs=1e-3)
    target = opened.run(
        "(({ stage }) => stage.controls.target.toArray().map((x, k) => x + stage.origin[k]))(window.styluscam)"
    )
    assert target == pytest.approx(finding["position"], abs=1e-3)
    assert int(readout(opened, "line")) == finding["line"]
    assert opened.picture("#stage") != before
    assert opened.run("document.querySelectorAll('#ticks i').length") == len(subject.findings)


def test_on_paper_there_is_a_picture_and_no_slider(opened: Tab) -> None:
    opened.size(*WIDE, media="print")
    shown = "(s => getComputedStyle(document.querySelector(s)).display)"
    assert opened.run(f"{shown}('.still')") == "block"
    assert opened.run(f"{shown}('.transport')") == opened.run(f"{shown}('canvas')") == "none"
    assert opened.run(f"{shown}('.findings')") != "none"


def test_any_program_without_a_part(tab: Tab, folder: Path, subject: Subject) -> None:
    text = "G20 G90 G54\nG0 X0 Y0 Z1\nG1 Z0 F7\nX1.3333333 Y0.7\nX0\nG0 Z1\nM2\n"
    program = sc.read_gcode(text, subject.machine)
    bare = folder / "bare.html"
    bare.write_text(report_page(Subject("bare.ngc", "bare.ngc", program, subject.machine)), encoding="utf-8")
    tab.complaints.clear()
    tab.requests.clear()
    tab.size(*NARROW, scheme="dark")
    tab.open(bare)
    tab.drawn()
    without_complaints(tab, bare)
    ends = tab.run("window.styluscam.player.path.places.map(column => [...column])")
    assert np.array_equal(np.transpose(ends), program.positions)
    assert tab.run("document.querySelector('#map')") is None


POCKET = {
    "schema": 1,
    "title": "Block",
    "part": {"file": "block.stl", "units": "mm"},
    "process": {"kind": "milling"},
    "setup": {"zero": "model"},
    "tools": {"mill": {"profile": {"kind": "flat", "diameter": 4.0}}},
    "operations": [
        {
            "id": "an-id-that-is-much-longer-than-any-column-of-a-narrow-page-is-wide",
            "kind": "pocket",
            "tool": "mill",
            "step": {"height": 2.0},
            "engagement_deg": 80.0,
            "fit": "arcs",
            "spindle": {"mode": "fixed", "rpm": 8000.0},
        }
    ],
    "machine": {"name": "linuxcnc"},
}

CLIPPED = """[...document.querySelectorAll(".pairs svg text")].filter(text => {
  const [inner, outer] = [text.getBoundingClientRect(), text.closest("svg").getBoundingClientRect()];
  return inner.left < outer.left || inner.right > outer.right || inner.top < outer.top || inner.bottom > outer.bottom;
}).map(text => text.textContent)"""
"""Words that stick out of their plot."""


def test_what_a_pocket_engages_is_drawn_wide_and_narrow(tab: Tab, folder: Path) -> None:
    write_stl(folder / "block.stl")
    job = sc.Job.from_dict(POCKET, folder)
    pocket = folder / "pocket.html"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 20_000)
        report = sc.verify(sc.post(sc.plan(job)).text, job)
        pocket.write_text(report_page(Subject.judged(report, job.machine(), "block.ngc")), encoding="utf-8")
    tab.complaints.clear()
    tab.requests.clear()
    ink = {}
    for size in (WIDE, NARROW):
        for scheme in ("light", "dark"):
            tab.size(*size, scheme=scheme)
            tab.open(pocket)
            tab.drawn()
            assert tab.run("document.documentElement.scrollWidth") <= size[0]
            assert tab.run(OVERFLOWING) == [] and tab.run(CLIPPED) == []
            assert tab.run("document.querySelectorAll('.pairs figure').length") == 2
            tops = tab.run(
                "[...document.querySelectorAll('.pairs figure')].map(one => one.getBoundingClientRect().top)"
            )
            assert (tops[0] == tops[1]) is (size == WIDE)
            ink[scheme] = tab.run("getComputedStyle(document.querySelector('.pairs svg text')).fill")
    assert ink["light"] != ink["dark"]
    tab.size(*WIDE, media="print")
    shown = "(s => getComputedStyle(document.querySelector(s)).display)"
    assert (tab.run(f"{shown}('.pairs .note')"), tab.run(f"{shown}('main > section > .note')")) == ("block", "none")
    assert tab.complaints == []


def test_two_programs_fit_side_by_side(tab: Tab, folder: Path, subject: Subject) -> None:
    both = folder / "both.html"
    both.write_text(comparison_page([subject, subject]), encoding="utf-8")
    tab.complaints.clear()
    tab.requests.clear()
    for size in (WIDE, NARROW):
        tab.size(*size)
        tab.open(both, ready=f"document.readyState === 'complete' && location.href === {both.as_uri()!r}")
        assert tab.run("document.documentElement.scrollWidth") <= size[0]
        assert tab.run(OVERFLOWING) == []
    assert tab.complaints == [] and {url for url in tab.requests if not url.startswith("data:")} == {both.as_uri()}


def test_without_webgl_the_picture_stands_in(tab: Tab, page: Path) -> None:
    tab.complaints.clear()
    script = tab.call(
        "Page.addScriptToEvaluateOnNewDocument", source="HTMLCanvasElement.prototype.getContext = () => null"
    )
    try:
        tab.size(*WIDE)
        tab.open(page)
        assert "cannot be shown" in tab.run("document.getElementById('trouble').textContent")
        assert tab.run("getComputedStyle(document.querySelector('.still')).display") == "block"
    finally:
        tab.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])
        tab.complaints.clear()
