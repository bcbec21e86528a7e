"""The offset surface as data: against the fixtures' exact envelopes and against plain cases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import styluscam as sc
from meridian import Floats, Meridian, Profile
from styluscam.offset.surface import FLAGS

CONTACT, BRIDGED, INTERFERES, RIM, UNDERCUT = range(5)
TOLERANCE = 0.005
BALL = {"kind": "ball", "diameter": 6.0}


def tool_of(profile: dict[str, object]) -> sc.Tool:
    return sc.Tool.from_dict({"profile": profile})


def drawn_out(section: list[tuple[float, float]], faces: list[int] | None = None) -> sc.Part:
    """A section (x, z) from left to right drawn out along Y from 0 to 60; `faces` are those of its pieces."""
    vertices = [(x, y, z) for x, z in section for y in (0.0, 60.0)]
    pieces = range(len(section) - 1)
    triangles = [t for i in pieces for t in ((2 * i, 2 * i + 2, 2 * i + 3), (2 * i, 2 * i + 3, 2 * i + 1))]
    return sc.Part.from_mesh(vertices, triangles, face_ids=None if faces is None else np.repeat(faces, 2))


STEP = [(-30.0, 0.0), (0.0, 0.0), (0.0, 20.0), (30.0, 20.0)]


@pytest.mark.parametrize("name", ("cone_cup", "vwaf", "pyramid", "cap_r60"))
@pytest.mark.parametrize("tool", ("ball-6", "clothoid-10"))
@pytest.mark.parametrize("sheet", ("none", "constant", "sine"))
def test_flags_are_those_of_the_exact_envelope(
    name: str,
    tool: str,
    sheet: str,
    part_of: Callable[[str], sc.Part],
    meridian_of: Callable[[str], Meridian],
) -> None:
    meridian = meridian_of(name)
    formed = [face["index"] for face in meridian.document["faces"] if face["slope_deg"][1] < 80.0]
    profile, document = meridian.document["tools"][tool], meridian.document["sheets"][sheet]
    found = sc.offset_surface(part_of(name), tool_of(profile), document, tolerance=TOLERANCE, faces=formed)
    assert np.isin(found.faces, formed).all()
    nodes = nodes_of(part_of(name), found)
    assert np.abs(found.points - closed_form(found, profile, document))[nodes].max() < 1e-9
    # the exact envelope gives how deep each position lies in the free side's complement
    inside = -meridian.envelope(found.points[:, :2], tool, sheet).clearance(found.points[:, 2])
    stopped = np.isin(found.flags, (BRIDGED, INTERFERES))
    assert (inside[stopped] > TOLERANCE - 0.002).all()
    assert (inside[nodes & ~stopped] < TOLERANCE + 0.002).all()
    assert (found.depths[stopped] > TOLERANCE).all() and (found.depths[~stopped] == 0.0).all()
    assert np.array_equal(found.places[~stopped], found.contacts[~stopped])
    # smooth all over but at the cap's sharp foot
    assert not (found.flags == (BRIDGED if name == "cap_r60" else INTERFERES)).any()
    # the sine law lifts the bare tool's answers
    case = (tool, "constant" if sheet == "constant" else "none")
    bridges = [row["bridged"] for row in meridian.document["bridges"] if (row["tool"], row["sheet"]) == case]
    assert len(bridges) > 0 and stopped.any() == any(bridges)


def nodes_of(part: sc.Part, found: sc.OffsetSurface) -> np.ndarray:
    """Which points are the triangles' own, on the surfaces: splitting adds others, on the triangles."""
    assert part.arrays is not None
    own = {tuple(vertex) for vertex in part.arrays.vertices}
    return np.array([tuple(point) in own for point in found.contacts])


def closed_form(found: sc.OffsetSurface, profile: dict[str, object], sheet: dict[str, object] | None) -> Floats:
    r, height = Profile.of(profile).at(np.sqrt(found.slopes * 2 / np.pi))
    up, across = np.array([0.0, 0.0, 1.0]), found.normals * [1.0, 1.0, 0.0]
    outward = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    between = 0.0 if sheet is None else sheet["thickness"] * (found.normals if sheet["law"] == "constant" else up)
    return np.asarray(found.contacts + between + r[:, None] * outward - height[:, None] * up)


@pytest.mark.parametrize("faces", (None, [7, 8, 9]))
def test_a_step_interferes_as_deep_as_the_ball_would_enter_it(faces: list[int] | None) -> None:
    found = sc.offset_surface(drawn_out(STEP, faces), tool_of(BALL))
    floor = (found.normals[:, 2] > 0.5) & (found.contacts[:, 2] == 0.0)
    x = found.contacts[:, 0]
    assert (found.flags[floor & (x < -3.01)] == CONTACT).all()
    near = floor & (x > -2.99)
    assert near.sum() > 50 and (found.flags[near] == INTERFERES).all()
    assert np.abs(found.depths - (3.0 + x))[near].max() < 1e-6
    assert np.abs(found.places[near, 0]).max() < 1e-9
    if faces is not None:
        assert (found.place_faces[near] == 8).all()


def test_a_fillet_into_a_floor_is_bridged_a_sharp_corner_is_not() -> None:
    turn = np.linspace(0.0, 0.25 * np.pi, 60)
    arc = list(zip(2.0 * np.sin(turn), 2.0 - 2.0 * np.cos(turn), strict=True))
    fillet = drawn_out([(-30.0, 0.0), *arc, (arc[-1][0] + 20.0, arc[-1][1] + 20.0)])
    sharp = drawn_out([(-30.0, 0.0), (0.0, 0.0), (20.0, 20.0)])
    for part, flag in ((fillet, BRIDGED), (sharp, INTERFERES)):
        assert set(sc.offset_surface(part, tool_of(BALL)).flags.tolist()) == {CONTACT, flag}
    assert (sc.offset_surface(fillet, tool_of({**BALL, "diameter": 3.9})).flags == CONTACT).all()


def test_rim_and_undercut() -> None:
    shallow = tool_of({"kind": "clothoid", "scale": 30.0, "end_slope_deg": 40.0})
    found = sc.offset_surface(drawn_out([(-30.0, 30.0), (0.0, 0.0), (-5.0, -20.0)]), shallow)
    assert np.array_equal(found.flags, np.where(found.normals[:, 2] < 0.0, UNDERCUT, RIM))
    assert {region.flag for region in found.regions()} == {"rim", "undercut"}


def test_regions_share_out_the_faces() -> None:
    found = sc.offset_surface(drawn_out(STEP, [7, 8, 9]), tool_of(BALL))
    regions = {(region.face, region.flag): region for region in found.regions()}
    assert list(regions) == [(7, "contact"), (7, "interferes"), (8, "contact"), (8, "interferes"), (9, "contact")]
    for face, whole in ((7, 1800.0), (8, 1200.0), (9, 1800.0)):
        assert sum(region.area for key, region in regions.items() if key[0] == face) == pytest.approx(whole)
    # three millimetres beside the wall's foot, on both faces
    for face in (7, 8):
        assert regions[face, "interferes"].area == pytest.approx(180.0, rel=0.1)
        assert regions[face, "interferes"].depth == pytest.approx(3.0, abs=1e-6)
    assert regions[7, "interferes"].contact[0] == pytest.approx(0.0)
    assert regions[9, "contact"].depth == 0.0


def test_faces_are_chosen_by_number_or_name() -> None:
    part, tool = drawn_out(STEP, [7, 8, 9]), tool_of(BALL)
    assert set(sc.offset_surface(part, tool, faces=["Face8", 9]).faces.tolist()) == {8, 9}
    for wrong in (3, "Face3", "wall", -8):
        with pytest.raises(sc.GeometryError) as raised:
            sc.offset_surface(part, tool, faces=[wrong])
        assert raised.value.code == "no-such-face"


def test_normals_that_were_given_place_the_tool() -> None:
    corners = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 10.0, 0.0)]
    normals = np.tile([0.6, 0.0, 0.8], (1, 3, 1)) * 2.0
    found = sc.offset_surface(sc.Part.from_mesh(corners, [[0, 1, 2]], normals), tool_of(BALL))
    assert np.allclose(found.points[:3], np.add(corners, [1.8, 0.0, 2.4 - 3.0]), atol=1e-12)
    for wrong in (np.full((1, 3, 3), np.nan), np.ones((2, 3, 3))):
        with pytest.raises((sc.GeometryError, ValueError)):
            sc.Part.from_mesh(corners, [[0, 1, 2]], wrong)


def test_a_tolerance_below_the_part_s_deviation_is_refused(part_of: Callable[[str], sc.Part]) -> None:
    for part, tolerance in ((part_of("cone_cup"), 1e-4), (drawn_out(STEP), 0.0), (drawn_out(STEP), np.nan)):
        with pytest.raises(sc.GeometryError) as raised:
            sc.offset_surface(part, tool_of(BALL), tolerance=tolerance)
        assert raised.value.where == "tolerance"


def test_progress_cancels(part_of: Callable[[str], sc.Part]) -> None:
    token = sc.CancelToken()
    token.cancel()
    with pytest.raises(sc.Cancelled):
        sc.offset_surface(part_of("cone_cup"), tool_of(BALL), cancel=token)


def test_it_is_saved_whole(tmp_path: Path) -> None:
    found = sc.offset_surface(drawn_out(STEP, [7, 8, 9]), tool_of(BALL))
    found.save(tmp_path / "offset.npz")
    with np.load(tmp_path / "offset.npz") as arrays:
        for name in ("points", "triangles", "contacts", "normals", "slopes", "flags", "depths", "places", "faces"):
            assert np.array_equal(arrays[name], getattr(found, name)), name
    trimesh = pytest.importorskip("trimesh", reason="needs the mesh extra")
    found.save(tmp_path / "offset.ply")
    mesh = trimesh.load(tmp_path / "offset.ply", process=False)
    assert np.allclose(mesh.vertices, found.points, atol=1e-5) and np.array_equal(mesh.faces, found.triangles)
    assert len(np.unique(mesh.visual.vertex_colors, axis=0)) == len(np.unique(found.flags))
    with pytest.raises(sc.GeometryError):
        found.save(tmp_path / "offset.obj")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["offset.npz", "offset.ply"]


def test_the_same_bytes_for_any_thread_count(part_of: Callable[[str], sc.Part]) -> None:
    first, second = (sc.offset_surface(part_of("pyramid"), tool_of({**BALL, "diameter": 14.0})) for _ in range(2))
    assert np.array_equal(first.points, second.points) and np.array_equal(first.flags, second.flags)
    assert [FLAGS[flag] for flag in np.unique(first.flags)][:2] == ["contact", "bridged"]


def test_the_plan_states_what_becomes_of_each_face(
    part_of: Callable[[str], sc.Part], meridian_of: Callable[[str], Meridian]
) -> None:
    document = {
        "schema": 1,
        "part": {"file": "cone_cup.step", "faces": ["Face1", "Face2", "Face3", "Face4"], "model_face": "back"},
        "setup": {"zero": "sheet-top", "sheet": {"thickness": 1.0}},
        "tools": {"tool": {"profile": {"kind": "clothoid", "diameter": 10.0}}},
        "operations": [{"kind": "z-level", "tool": "tool", "step": {"height": 5.0}}],
        "machine": {"name": "linuxcnc"},
    }
    part = part_of("cone_cup")
    (operation,) = sc.plan(sc.Job.from_dict(document, part=part)).summary()[0].operations
    areas = {face["index"]: face["area"] for face in meridian_of("cone_cup").document["faces"]}
    reached = {face.face: {key: area for key, area in face.items() if key != "face"} for face in operation.reached}
    assert list(reached) == [1, 2, 3, 4]
    for face, row in reached.items():
        assert sum(row.values()) == pytest.approx(areas[face], rel=1e-3)
        assert row["interferes"] == row["rim"] == row["undercut"] == 0.0
    tool, sheet = tool_of({"kind": "clothoid", "diameter": 10.0}), {"thickness": 1.0, "model_face": "back"}
    for region in sc.offset_surface(part, tool, sheet, faces=[1, 2, 3, 4]).regions():
        assert abs(reached[region.face][region.flag] - region.area) < 0.02 * areas[region.face]
