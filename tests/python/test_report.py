"""The report: what is in it, that it loads nothing, and that it is the same every time."""

from __future__ import annotations

import base64
import gzip
import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Floats, Mesh, box, milling_document

import styluscam as sc
from styluscam import _engine
from styluscam.drawing.decimation import thinned
from styluscam.report import Subject, comparison_page, figures, heatmaps, report_page
from styluscam.report.columns import packed
from styluscam.report.findings import spoken
from styluscam.report.surface import Surface, vertices_of

RADIUS, STEPOVER = 3.0, 0.6
BLOCK = box([0.0, 0.0, -5.0], [30.0, 20.0, 0.0])


def write_stl(mesh: Mesh, path: Path) -> None:
    vertices, triangles = mesh
    record = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    record["v"] = vertices[triangles]
    path.write_bytes(b"\0" * 80 + np.uint32(len(triangles)).tobytes() + record.tobytes())


def job_of(folder: Path, mesh: Mesh = BLOCK, title: str = "") -> sc.Job:
    write_stl(mesh, folder / "made.stl")
    ball, off = {"kind": "ball", "diameter": 2 * RADIUS}, {"mode": "off"}
    document = milling_document("zig-zag", ball, stepover=STEPOVER, angle_deg=0.0, spindle=off)
    return sc.Job.from_dict({**document, "title": title}, folder)


DEPTH = 0.25
SCRATCH = f"G0 Z10\nG0 X15 Y10\nG1 Z{-DEPTH} F300\nG1 X16 F1500\nG0 Z10\nM2\n"
"""The end of a program that enters the block's top."""


def test_every_kind_of_finding_has_words_that_people_read() -> None:
    words = json.loads(_engine.finding_kinds())
    assert len(words) == len(set(words.values())) > 50
    for code, shown in words.items():
        assert spoken(code) == shown and "-" not in shown and shown.strip() == shown != "", code
    assert (spoken("unsaid-mode"), spoken("of-tomorrow")) == ("modal code not stated", "of tomorrow")


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> sc.Job:
    return job_of(tmp_path_factory.mktemp("job"), title="A <b>bold</b> block & more")


@pytest.fixture(scope="module")
def texts(job: sc.Job) -> tuple[str, str]:
    """A sound program and a faulty one."""
    text = sc.post(sc.plan(job)).text
    return text, text.replace("M2\n", SCRATCH)


@pytest.fixture(scope="module")
def subjects(job: sc.Job, texts: tuple[str, str]) -> tuple[Subject, Subject]:
    machine = job.machine()
    reports = [sc.verify(text, job) for text in texts]
    return Subject.judged(reports[0], machine, "sound.ngc"), Subject.judged(reports[1], machine, "faulty.ngc")


@pytest.fixture(scope="module")
def pages(subjects: tuple[Subject, Subject]) -> tuple[str, str]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 20_000)
        return report_page(subjects[0]), report_page(subjects[1])


class Page(HTMLParser):
    """Text, addresses and classes of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self._silent = False
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._silent = tag in ("script", "style")
        self.tags.append((tag, dict(attrs)))
        names = ("src", "href", "srcset", "action", "data", "poster", "xlink:href")
        self.addresses += [value or "" for name, value in attrs if name in names]

    def handle_endtag(self, tag: str) -> None:
        self._silent = False

    def handle_data(self, data: str) -> None:
        self.text += "" if self._silent else data


def given(page: str) -> dict[str, Any]:
    """What the page's script works with."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found
    return dict(json.loads(found[1]))


def unpacked(column: dict[str, Any]) -> Floats:
    """As the page does it."""
    planes = np.frombuffer(gzip.decompress(base64.b64decode(column["data"])), dtype=np.uint8)
    shape = column["columns"], column["count"]
    if not column["scale"]:
        return planes.reshape(8, -1).T.copy().view("<f8").reshape(shape).T
    folded = planes.reshape(4, -1).T.copy().view("<u4").astype(np.int64).reshape(shape)
    return np.cumsum(np.where(folded % 2, -(folded + 1) // 2, folded // 2), axis=1).T / column["scale"]


# --- numbers for the page ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "values",
    [
        [],
        [0.0],
        [1.001, -2.75, 1e5 + 0.001],
        [[1.5, 2.25], [-3.125, 4e6]],
        [1.0 / 3.0, 25.4 / 7.0, -1e300],
        [1e300],
        [np.nan, 1.0, np.inf],
        [2**40 + 1.0, 2**41],
        [-(2.0**31), 2.0**31],
    ],
)
def test_columns_come_back_bit_by_bit(values: Any) -> None:
    array = np.asarray(values, dtype=np.float64)
    back = unpacked(packed(array))
    assert np.array_equal(back.reshape(array.shape), array, equal_nan=True)


def test_decimal_columns_are_small() -> None:
    steps = np.random.default_rng(1).integers(-300, 300, 100_000)
    ends = np.round(np.cumsum(steps) / 1000.0, 3)
    assert packed(ends)["scale"] == 1000.0
    assert len(packed(ends)["data"]) < 2 * len(ends)


def test_rounded_columns_are_within_half_a_step() -> None:
    values = np.random.default_rng(2).normal(0.0, 40.0, (500, 3))
    assert np.abs(unpacked(packed(values, 1e-4)) - values).max() <= 0.5e-4 * (1.0 + 1e-9)


def test_a_thinned_path_states_how_far_it_is_off() -> None:
    turn = np.linspace(0.0, 40.0 * np.pi, 20_001)
    points = np.stack([10.0 * np.cos(turn), 10.0 * np.sin(turn), -turn / 50.0], axis=1)
    keep = np.zeros(len(points), dtype=bool)
    keep[[77, 5001]] = True
    drawn = thinned(points, keep, 2_000)
    assert len(drawn.indices) <= 2_000
    assert {0, 77, 5001, 20_000} <= set(drawn.indices.tolist())
    assert 1e-5 < drawn.error_mm < 0.05
    chord = np.searchsorted(drawn.indices, np.arange(len(points)), side="right") - 1
    chord = np.minimum(chord, len(drawn.indices) - 2)
    start, end = points[drawn.indices[chord]], points[drawn.indices[chord + 1]]
    off = np.linalg.norm(np.cross(end - start, points - start), axis=1) / np.linalg.norm(end - start, axis=1)
    assert off.max() == pytest.approx(drawn.error_mm, rel=1e-6)
    assert thinned(points[:1], keep[:1], 10).error_mm == 0.0


def test_positions_along_arcs_have_their_time_and_move(job: sc.Job) -> None:
    text = "G21 G90 G54 G17\nG0 X0 Y0 Z5\nG1 Z0 F60\nG4 P2.5\nG3 X20 Y0 I10 J0 F600\nG1 X30\nG0 Z5\nM2\n"
    program = sc.read_gcode(text, job.machine())
    subject = Subject("arc", "arc.ngc", program, job.machine())
    assert len(subject.positions) > 50 + len(program.moves)
    assert (np.diff(subject.times) >= 0.0).all() and (np.diff(subject.owners) >= 0).all()
    ends = np.searchsorted(subject.owners, np.arange(len(program.moves)), side="right") - 1
    assert subject.times[ends] == pytest.approx(program.times(job.machine()), abs=1e-6)
    assert np.array_equal(subject.positions[ends], program.moves["end"])
    (arc,) = np.flatnonzero(program.moves["kind"] == 3)
    on_it = np.flatnonzero(subject.owners == arc)
    assert np.linalg.norm(subject.positions[on_it, :2] - [10.0, 0.0], axis=1) == pytest.approx(10.0, abs=1e-3)
    assert np.ptp(np.diff(subject.times[on_it[0] - 1 : on_it[-1] + 1])) < 1e-4
    data = given(report_page(subject))["path"]
    assert data["sag"] == 0.001 and data["count"] == len(program.moves)
    assert np.array_equal(unpacked(data["moves"])[:, 0], subject.owners)


# --- the part ------------------------------------------------------------------------------------------------------


def closed_box() -> Surface:
    vertices, triangles = box([0.0, 0.0, 0.0], [8.0, 4.0, 2.0])
    bottom = np.array([[0, 2, 3], [0, 3, 1]])
    triangles = np.concatenate([triangles, bottom])
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Surface(vertices, triangles, np.repeat(normals[:, None], 3, axis=1), np.arange(len(triangles)) // 2, True)


def sides(surface: Surface) -> dict[tuple[int, int], int]:
    counts: dict[tuple[int, int], int] = {}
    for triangle in surface.triangles.tolist():
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            counts[min(a, b), max(a, b)] = counts.get((min(a, b), max(a, b)), 0) + 1
    return counts


@pytest.mark.parametrize("limit", [100_000, 150])
def test_a_refined_surface_has_no_gaps(limit: int) -> None:
    surface = closed_box()
    wanted = surface.faces < 2
    finer, still = surface.refined(wanted, 0.5, limit)
    assert len(finer.points) <= limit
    assert set(sides(finer).values()) == {2}
    for face in range(6):
        area = surface.areas[surface.faces == face].sum()
        assert finer.areas[finer.faces == face].sum() == pytest.approx(area)
    assert np.array_equal(still, finer.faces < 2)
    assert (finer.longest_side(still) <= 0.5) == (limit > 1000)
    facets = np.cross(*(finer.points[finer.triangles[:, k]] - finer.points[finer.triangles[:, 0]] for k in (1, 2)))
    assert (np.einsum("ij,ij->i", facets, finer.normals[:, 0]) > 0.0).all()


def test_borders_are_the_edges_of_a_box() -> None:
    surface = closed_box()
    assert len(surface.borders()) == 12
    mesh = Surface(surface.points, surface.triangles, surface.normals, np.ones(12, dtype=np.int64), False)
    assert len(mesh.borders()) == 12
    assert len(vertices_of(surface).at) == 24
    assert len(vertices_of(mesh).at) == 36


def test_a_part_with_too_many_points_is_drawn_coarser() -> None:
    fine, _ = closed_box().refined(np.ones(12, dtype=bool), 0.1, 100_000)
    coarse, cell = fine.coarsened(500)
    assert 50 < len(coarse.points) <= 500 and cell > 0.1
    assert coarse.areas.sum() == pytest.approx(fine.areas.sum(), rel=0.1)
    same, none = fine.coarsened(100_000)
    assert same is fine and none == 0.0


def test_left_at_a_point_is_its_distance_from_what_is_swept(subjects: tuple[Subject, Subject]) -> None:
    report = subjects[0].report
    assert report is not None
    high = report.left([[15.0, 10.0, 7.0]])[0]
    top = report.left([[15.0, 10.0 + STEPOVER * k / 8.0, 0.0] for k in range(9)])
    assert -0.01 < top.min() < 0.01
    assert top.max() == pytest.approx(RADIUS - np.sqrt(RADIUS**2 - STEPOVER**2 / 4.0), abs=0.006)
    assert high < -2.0
    assert report.left(np.zeros((0, 3))).shape == (0,)
    with pytest.raises(sc.GeometryError):
        report.left([[1.0, 2.0]])
    token = sc.CancelToken()
    token.cancel()
    with pytest.raises(sc.Cancelled):
        report.left(np.random.default_rng(3).uniform(0.0, 20.0, (400_000, 3)), cancel=token)


def test_maps_say_what_the_verifier_states(subjects: tuple[Subject, Subject]) -> None:
    subject = subjects[1]
    assert subject.surface is not None and subject.report is not None
    shown = heatmaps.shown_judged(subject.surface, subject.report)
    maps = {one.key: one for one in shown.maps}
    assert list(maps) == ["left", "gouge", "wall"]
    assert maps["gouge"].values.max() == pytest.approx(DEPTH, abs=0.02)
    assert set(np.round(maps["wall"].values, 6)) == {0.0, 90.0}
    left = maps["left"]
    height = RADIUS - np.sqrt(RADIUS**2 - STEPOVER**2 / 4.0)
    assert shown.scallops.max() <= 0.06 and np.median(shown.scallops) < height + 0.006
    assert left.limit == pytest.approx(0.06) and (left.values > left.limit).any()
    covered = sum(face["covered"] * face["area"] for face in subject.report.coverage())
    assert shown.weights.sum() == pytest.approx(covered, rel=0.02)


# --- the page ------------------------------------------------------------------------------------------------------


def test_the_page_states_the_verdict(pages: tuple[str, str], subjects: tuple[Subject, Subject]) -> None:
    sound, faulty = (Page(page) for page in pages)
    assert "Nothing was found" in sound.text and "Must not run" not in sound.text
    assert "Must not run" in faulty.text and "gouge (1, along " in faulty.text
    for page, subject in zip((sound, faulty), subjects, strict=True):
        assert "A <b>bold</b> block & more" in page.text and subject.file in page.text
        assert subject.report is not None
        rows = [attributes["data-finding"] for _, attributes in page.tags if "data-finding" in attributes]
        assert {int(str(row)) for row in rows} == set(range(len(subject.report.findings)))
        for finding in subject.report.findings:
            assert finding["message"] in page.text
        for words in (
            "stepover",
            "0.6",
            "made.stl",
            "zig-zag",
            "StylusCAM " + sc.__version__,
            "three.js 0.",
            "ball D6",
        ):
            assert words in page.text, words
        for numbers in subject.report.coverage():
            assert f"{100.0 * numbers['covered']:.1f}" in page.text


def test_a_kind_is_one_row_and_the_rest_is_folded_away(job: sc.Job, texts: tuple[str, str]) -> None:
    scratches = "".join(f"G0 Z10\nG0 X15 Y{y}\nG1 Z-{depth} F300\nG1 X16 F1500\n" for y, depth in SCRATCHES)
    report = sc.verify(texts[0].replace("M2\n", f"{scratches}G0 Z10\nM2\n"), job)
    (gouge,) = (group for group in report.groups if group["kind"] == "gouge")
    assert gouge["count"] == len(SCRATCHES) == report.to_dict()["counts"]["gouge"]
    assert gouge["value"] == pytest.approx(0.5, abs=0.01) and gouge["position"][1] == 10.5
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 20_000)
        page = report_page(Subject.judged(report, job.machine(), "faulty.ngc"))
    table = page[page.index('<section class="findings">') : page.index("What is left on each face")]
    folded = "".join(re.findall(r"<details>.*?</details>", table, re.DOTALL))
    assert folded.count("data-finding") == 20 and f"the worst 20 of {len(SCRATCHES)}" in folded
    open_rows = re.findall(r'data-finding="(\d+)"', re.sub(r"<details>.*?</details>", "", table, flags=re.DOTALL))
    assert len(open_rows) == len(report.groups)
    assert gouge["message"] in Page(page).text
    assert report.findings[int(open_rows[0])]["severity"] == "error"


SCRATCHES = [(2.0 + 0.5 * i, 0.5 if i == 17 else 0.1) for i in range(30)]
"""Where plunges go into the block's top, and how deep."""


def test_findings_know_their_moment(pages: tuple[str, str], subjects: tuple[Subject, Subject]) -> None:
    data, subject = given(pages[1]), subjects[1]
    times, ends = unpacked(data["path"]["times"])[:, 0], unpacked(data["path"]["places"])
    assert data["findings"]
    for finding, whole in zip(data["findings"], subject.findings, strict=True):
        move = int(np.searchsorted(times, finding["time"]))
        assert subject.program.moves["line"][move] == whole["line"]
        begins = times[move - 1]
        share = (finding["time"] - begins) / (times[move] - begins)
        tip = ends[move - 1] + share * (ends[move] - ends[move - 1])
        assert np.linalg.norm(tip - finding["position"]) < 1e-3


def test_the_path_in_the_page_is_exact(pages: tuple[str, str], subjects: tuple[Subject, Subject]) -> None:
    path, program = given(pages[0])["path"], subjects[0].program
    assert np.array_equal(unpacked(path["places"]), program.positions)
    assert np.array_equal(unpacked(path["lines"])[:, 0], program.moves["line"])
    assert np.array_equal(unpacked(path["feeds"])[:, 0], program.moves["feed"])
    assert np.abs(unpacked(path["times"])[:, 0] - program.times(subjects[0].machine)).max() <= 1e-6


def test_the_page_loads_nothing(pages: tuple[str, str], subjects: tuple[Subject, Subject]) -> None:
    for text in (*pages, comparison_page(subjects)):
        page = Page(text)
        assert page.addresses and all(address.startswith(("data:", "#")) for address in page.addresses)
        (policy,) = [a["content"] for tag, a in page.tags if tag == "meta" and "http-equiv" in a]
        assert policy is not None and policy.startswith("default-src 'none'")
        styles = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
        assert not re.search(r"@import|url\((?!#|'#|\"#)", styles)
        assert not re.search(r"https?://(?!www\.w3\.org/|purl\.org/|creativecommons\.org/)", styles)


def test_the_same_subject_gives_the_same_page(pages: tuple[str, str], job: sc.Job, texts: tuple[str, str]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(heatmaps, "LIMIT", 20_000)
        assert report_page(Subject.judged(sc.verify(texts[0], job), job.machine(), "sound.ngc")) == pages[0]


def test_two_programs_side_by_side(subjects: tuple[Subject, Subject]) -> None:
    page = comparison_page(subjects)
    assert page == comparison_page(subjects)
    text = Page(page).text
    for words in ("sound.ngc", "faulty.ngc", "Nothing was found", "Must not run", "worst gouge", "covered", "blocks"):
        assert words in text, words
    numbers = [figures(subject) for subject in subjects]
    assert numbers[0]["gouge_mm"] < numbers[1]["gouge_mm"]
    assert numbers[0]["findings"] == 0 < numbers[1]["findings"]
    assert numbers[1]["gouge_mm"] == pytest.approx(DEPTH, abs=1e-6)
    assert numbers[1]["blocks"] == numbers[0]["blocks"] + 5


def test_a_page_without_part_and_job(job: sc.Job) -> None:
    program = sc.read_gcode("G20 G90 G54\nG0 X0 Y0 Z1\nG1 Z0 F7\nX1.3333333\nG0 Z1\nM2\n", job.machine())
    page = report_page(Subject("a.ngc", "a.ngc", program, job.machine()))
    assert "Not verified" in Page(page).text
    data = given(page)
    assert data["part"] is None and data["path"]["places"]["scale"] == 0
    assert np.array_equal(unpacked(data["path"]["places"]), program.positions)


def test_without_the_extra_it_states_what_to_install(
    subjects: tuple[Subject, Subject], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "jinja2", None)
    with pytest.raises(sc.StylusError, match=r"pip install 'styluscam\[report\]'"):
        report_page(subjects[0])
