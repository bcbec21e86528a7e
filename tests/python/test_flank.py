"""Flank milling: positions of a cylinder along ruled surfaces, against published figures, hand-made answers and other methods."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import styluscam as sc
from styluscam import _engine
from styluscam.flank.rails import RailLike
from styluscam.programs.posting import cl_text

Rails = tuple[RailLike, RailLike]
TURN = np.radians(20.0)
UP = np.array([0.0, 0.0, 30.0])
HP20: Rails = (
    lambda u: np.outer(60.0 * (u - 0.5), [1.0, 0.0, 0.0]),
    lambda u: np.outer(60.0 * (u - 0.5), [np.cos(TURN), np.sin(TURN), 0.0]) + UP,
)
CV: Rails = (
    {"poles": [(0, 0, 0), (30, 15, 0), (60, 0, 0)]},
    {"poles": [(0, 5, 30), (30, 28, 30), (60, -8, 30)]},
)
STRIPS: dict[str, Rails] = {"HP20": HP20, "CV": CV}
OTHERS = ("one-point", "two-points", "rails", "three-points")


def cylinder(radius: float) -> dict[str, Any]:
    return {"profile": {"kind": "flat", "diameter": 2.0 * radius}}


def placed(rails: Rails, radius: float, method: Any = "swept", count: int = 200, **how: Any) -> sc.FlankPositions:
    return sc.flank_positions(*rails, cylinder(radius), count, method=method, **how)


def micrometres(error: sc.FlankError) -> tuple[float, float]:
    middle = error.between(0.25, 0.75)
    return 1e3 * middle.over, 1e3 * middle.under


@pytest.mark.parametrize(
    ("strip", "radius", "method", "over", "under"),
    [
        ("HP20", 5.0, "one-point", 75.97, 0.0),
        ("HP20", 10.0, "one-point", 151.95, 0.0),
        ("CV", 5.0, "one-point", 114.79, 0.0),
        ("CV", 10.0, "one-point", 262.18, 0.0),
        ("HP20", 5.0, "two-points", 19.32, 57.26),
        ("HP20", 10.0, "two-points", 38.64, 112.96),
        ("CV", 5.0, "two-points", 21.66, 63.87),
        ("CV", 10.0, "two-points", 43.33, 126.09),
        ("HP20", 5.0, "rails", 76.2, 0.0),
        ("HP20", 10.0, "rails", 154.0, 0.0),
        ("CV", 5.0, "rails", 86.8, 0.1),
        ("CV", 10.0, "rails", 175.5, 0.1),
    ],
)
def test_other_methods_leave_what_is_known_of_them(
    strip: str, radius: float, method: str, over: float, under: float
) -> None:
    found = micrometres(placed(STRIPS[strip], radius, method, 400, side="right").error)
    assert found == pytest.approx((over, under), rel=0.02, abs=0.15)


@pytest.mark.parametrize(
    ("strip", "radius", "most"), [("HP20", 5.0, 0.2), ("HP20", 10.0, 0.4), ("CV", 5.0, 3.5), ("CV", 10.0, 7.5)]
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_the_swept_surface_is_near(strip: str, radius: float, most: float, side: Any) -> None:
    assert max(micrometres(placed(STRIPS[strip], radius, count=400, side=side).error)) < most


def test_few_positions_cut_in_between() -> None:
    # chords lie off a curve by the square of their length
    over = [micrometres(placed(HP20, 5.0, count=count).error)[0] for count in (7, 13, 25)]
    assert over[0] > 5.0 and over[0] == pytest.approx(4.0 * over[1], rel=0.2) == pytest.approx(16.0 * over[2], rel=0.5)


def moved_off(found: sc.FlankPositions, continuous: sc.FlankPositions) -> float:
    """How much more or less straight moves leave than the continuous movement, mm, at most."""
    off = np.abs(found.error.left - continuous.error.left)
    return float(np.nanmax(off))


# both rails bend in one place, so that evenly spaced positions do not do
BENT: Rails = (
    {"poles": [(0, 0, 0), (28, 0, 0), (32, 0, 0), (60, 12, 0)]},
    {"poles": [(0, 2, 30), (28, -3, 30), (32, -3, 30), (60, 14, 30)]},
)


@pytest.mark.parametrize(
    ("method", "strip"),
    # of the bent one a cone does not touch the ruling everywhere
    [(method, strip) for method in ("swept", *OTHERS) for strip in ("HP20", "CV")]
    + [(method, "bent") for method in ("swept", "rails", "two-points", "one-point")],
)
@pytest.mark.parametrize("tolerance", [0.02, 0.002])
def test_straight_moves_lie_off_by_the_tolerance_at_most(method: Any, strip: str, tolerance: float) -> None:
    rails, tool = {"HP20": (HP20, cylinder(10.0)), "CV": (CV, cylinder(5.0)), "bent": (BENT, {"profile": CONES[0]})}[
        strip
    ]
    how: Any = {"method": method, "side": "right"}
    continuous = sc.flank_positions(*rails, tool, 2001, **how)
    found = sc.flank_positions(*rails, tool, tolerance=tolerance, **how)
    assert 0.25 * tolerance < moved_off(found, continuous) < 1.03 * tolerance, len(found.tips)
    # hardly fewer would do
    fewer = sc.flank_positions(*rails, tool, int(0.85 * len(found.tips)), **how)
    assert moved_off(fewer, continuous) > tolerance


def test_positions_lie_denser_where_the_movement_bends() -> None:
    bent = [{"poles": [(0, 0, z), (28, 0, z), (32, 0, z), (60, 12, z)]} for z in (0, 30)]
    found = sc.flank_positions(*bent, cylinder(5.0), tolerance=0.002)
    lengths = np.linalg.norm(np.diff(found.tips, axis=0), axis=1)
    assert lengths.max() > 2.5 * lengths.min()
    # a wall needs no positions between
    wall: Rails = ([(0, 0, 0), (40, 0, 0)], [(0, 0, 20), (40, 0, 20)])
    assert len(sc.flank_positions(*wall, cylinder(5.0), tolerance=1e-6).tips) == 2


@pytest.mark.parametrize(("count", "tolerance"), [(6, 0.023), (16, 0.003)])
def test_tolerances_that_known_counts_meet(count: int, tolerance: float) -> None:
    found = sc.flank_positions(*HP20, cylinder(5.0), tolerance=tolerance)
    assert len(found.tips) == pytest.approx(count, abs=1)


@pytest.mark.parametrize(
    ("how", "code"),
    [
        ({}, "argument"),
        ({"count": 5, "tolerance": 0.01}, "argument"),
        ({"tolerance": "fine"}, "argument"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": float("nan")}, "tolerance"),
        ({"tolerance": float("inf")}, "tolerance"),
        ({"tolerance": -1.0}, "tolerance"),
        ({"tolerance": 1e-7}, "tolerance"),
        ({"count": 5.0}, "argument"),
    ],
)
def test_either_count_or_tolerance(how: dict[str, Any], code: str) -> None:
    with pytest.raises(sc.GeometryError) as caught:
        sc.flank_positions(*HP20, cylinder(5.0), **how)
    assert caught.value.code == code


def test_the_cylinder_touches_both_rails() -> None:
    found = placed(CV, 5.0)
    aside = np.cross(found.contacts - found.tips[:, None], found.axes[:, None])
    assert np.linalg.norm(aside, axis=2) == pytest.approx(5.0, abs=1e-10)
    steps = np.linalg.norm(np.diff(found.axes, axis=0), axis=1)
    assert steps.max() < 5.0 * steps.mean()


def test_a_hyperboloid_of_one_sheet_is_milled_by_its_other_lines() -> None:
    # the axis is a line of the other family of the hyperboloid that lies off by the radius: about Z all positions are one
    ring, half, turn = 20.0, 12.0, np.radians(40.0)

    def rail(z: float, ahead: float) -> RailLike:
        def at(u: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
            angle = 1.5 * u + ahead
            return np.column_stack([ring * np.cos(angle), ring * np.sin(angle), np.full(len(u), z)])

        return at

    found = placed((rail(-half, 0.0), rail(half, turn)), 3.0, count=401, side="right")
    middle = slice(100, 301)
    distances = np.linalg.norm(np.cross(found.tips, found.axes)[middle], axis=1)
    heights = found.axes[middle, 2]
    assert np.ptp(heights) < 1e-4 and np.ptp(distances) < 1e-3
    assert max(micrometres(found.error)) < 2.0


def test_developable_surfaces_are_exact() -> None:
    def circle(radius: float, z: float) -> RailLike:
        return lambda u: np.column_stack([radius * np.cos(0.1 * u), radius * np.sin(0.1 * u), np.full(len(u), z)])

    # so many positions that chords of the movement count for less than 1e-6 mm: 5 um long, 1e-7 mm
    for rails in ((circle(30.0, 0.0), circle(30.0, 20.0)), (circle(30.0, 0.0), circle(20.0, 20.0))):
        error = sc.flank_positions(*rails, cylinder(4.0), 600).error.between(0.25, 0.75)
        assert max(error.over, error.under) < 1e-6


def test_no_other_method_is_better() -> None:
    # 200 of them: bench/flank.py
    random = np.random.default_rng(4)
    for degree in (1, 3, 2, 3):
        twist, length, radius = np.radians(random.uniform(3, 40)), random.uniform(40, 100), random.uniform(2, 6)
        base = np.linspace(-0.5, 0.5, degree + 1)[:, None] * [length, 0.0, 0.0]
        poles = [base + random.uniform(-0.04, 0.04, base.shape) * length * [0.5, 1.0, 0.2] for _ in range(2)]
        turn = np.array([[np.cos(twist), np.sin(twist), 0], [-np.sin(twist), np.cos(twist), 0], [0, 0, 1]])
        rails = ({"poles": poles[0]}, {"poles": poles[1] @ turn + [0, 0, 25.0]})
        left = {}
        for method in ("swept", *OTHERS):
            try:
                error = placed(rails, radius, method, 60).error
            except sc.GeometryError as refusal:
                assert refusal.code == "no-three-points"
                continue
            left[method] = max(error.over, error.under)
        swept = left.pop("swept")
        assert swept <= max(min(left.values()), 1e-6)


def beziers(first: list[Any], second: list[Any]) -> Rails:
    return {"poles": first}, {"poles": second}


# of bench/flank.py: numbers 81 and 169, where chords of the movement count most; 98 and 115, where no position touches both
# rails at equal parameters
MEMBERS: dict[int, tuple[Rails, float, Any]] = {
    81: (
        beziers(
            [(-41.41, 0.32, 0.4), (-11.68, -3.57, -0.42), (14.18, 8.81, -0.66), (40.8, 2.14, -0.37)],
            [(-43.42, 8.55, 28.47), (-15.53, 6.58, 27.99), (8.5, 15.31, 29.23), (37.16, 7.63, 28.47)],
        ),
        4.44135,
        "right",
    ),
    169: (
        beziers(
            [(-29.45, -1.52, -0.38), (0.66, -5.13, -0.26), (30.97, -1.08, -0.21)],
            [(-36.01, -5.4, 13.84), (-4.89, -8.97, 13.49), (26.67, -2.17, 13.35)],
        ),
        11.50539,
        "left",
    ),
    98: (
        beziers(
            [(-37.79, -0.78, -0.35), (-1.64, -3.28, 0.7), (41.43, -0.96, -0.45)],
            [(-27.36, -10.91, 13.41), (8.98, -2.43, 13.23), (40.65, 23.88, 13.82)],
        ),
        9.99197,
        "right",
    ),
    115: (
        beziers(
            [(-24.03, 1.1, -0.26), (-0.96, -6.24, -0.2), (24.98, -0.88, -0.16)],
            [(-18.46, -10.37, 12.68), (3.55, 0.04, 12.0), (21.04, 19.19, 12.3)],
        ),
        9.75874,
        "right",
    ),
}


@pytest.mark.parametrize("number", MEMBERS)
def test_the_axis_does_not_jump_where_little_depends_on_it(number: int) -> None:
    rails, radius, side = MEMBERS[number]
    found = placed(rails, radius, count=120, side=side)
    turns = np.linalg.norm(np.diff(found.axes, axis=0), axis=1)
    assert turns.max() < 4.0 * turns.mean()
    swept = max(found.error.over, found.error.under)
    for method in OTHERS:
        try:
            error = placed(rails, radius, method, 120, side=side).error
        except sc.GeometryError as refusal:
            assert refusal.code in ("no-three-points", "no-position")
            continue
        assert swept <= max(error.over, error.under), method


def test_where_no_position_touches_both_rails() -> None:
    rails, radius, side = MEMBERS[115]
    with pytest.raises(sc.GeometryError, match=r"u = 0\.1.* method swept") as caught:
        placed(rails, radius, "rails", 120, side=side)
    assert caught.value.code == "no-position"
    assert max(micrometres(placed(rails, radius, count=120, side=side).error)) < 30.0


def positions_beside(twist: float, height: float, radius: float, u: float, spread: float) -> int:
    """How many positions of a cylinder touch two straight rails 40 mm long, by Newton's steps from a grid of all angles."""
    t = np.radians(twist)
    tangents = np.array([[1.0, 0.0, 0.0], [np.cos(t), np.sin(t), 0.0]])
    contacts = [40.0 * (u + sign * spread - 0.5) * tangents[i] for i, sign in enumerate((-1, 1))]
    contacts[1] = contacts[1] + [0.0, 0.0, height]
    rulings = [40.0 * (u + sign * spread - 0.5) * (tangents[1] - tangents[0]) + [0.0, 0.0, height] for sign in (-1, 1)]
    normals = [np.cross(ruling, tangent) for ruling, tangent in zip(rulings, tangents, strict=True)]
    normals = [normal / np.linalg.norm(normal) for normal in normals]
    around = [np.cross(tangent, normal) for tangent, normal in zip(tangents, normals, strict=True)]
    grid = np.linspace(-np.pi / 2, np.pi / 2, 25)
    angles = np.stack(np.meshgrid(grid, grid)).reshape(2, -1)
    for _ in range(40):
        q = [np.outer(np.cos(x), n) + np.outer(np.sin(x), b) for x, n, b in zip(angles, normals, around, strict=True)]
        d = [np.outer(np.cos(x), b) - np.outer(np.sin(x), n) for x, n, b in zip(angles, normals, around, strict=True)]
        axis = contacts[1] - contacts[0] + radius * (q[1] - q[0])
        f = [(axis * side).sum(axis=1) for side in q]
        slopes = (axis * d[0]).sum(axis=1), radius * (d[1] * q[0]).sum(axis=1)
        slopes += -radius * (d[0] * q[1]).sum(axis=1), (axis * d[1]).sum(axis=1)
        determinant = slopes[0] * slopes[3] - slopes[1] * slopes[2]
        determinant = np.where(np.abs(determinant) < 1e-9, 1e-9, determinant)
        step = [slopes[3] * f[0] - slopes[1] * f[1], slopes[0] * f[1] - slopes[2] * f[0]]
        angles = angles - np.clip(np.stack(step) / determinant, -0.2, 0.2)
    return int(((np.hypot(*f) < 1e-8) & (np.abs(angles) < np.pi / 2).all(axis=0)).sum())


def test_a_strip_that_is_twisted_too_much_has_no_position_at_all() -> None:
    t = np.radians(40.0)
    end = 20.0 * np.array([np.cos(t), np.sin(t), 0.0])
    rails: Rails = ([(-20, 0, 0), (20, 0, 0)], [(-end[0], -end[1], 4.0), (end[0], end[1], 4.0)])
    with pytest.raises(sc.GeometryError, match="up to a ruling's length apart") as caught:
        placed(rails, 12.0, count=60)
    assert caught.value.code == "no-position"
    u = float(str(caught.value).split("u = ")[1].split(",")[0])
    most = float(str(caught.value).split("at most ")[1].split(" mm")[0])
    widest = np.hypot(4.0, 40.0 * (u - 0.5) * 2.0 * np.sin(0.5 * t)) / 80.0
    for radius, does in ((12.0, False), (1.02 * most, False), (0.98 * most, True)):
        found = [positions_beside(40.0, 4.0, radius, u, apart) for apart in np.linspace(-widest, widest, 65)]
        assert (max(found) > 0) == does, (radius, most)


CONES: list[dict[str, Any]] = [
    {"kind": "tapered-ball", "tip_radius": 3.0, "half_angle_deg": 5.0, "diameter": 16.0},
    {"kind": "v", "tip_diameter": 6.0, "angle_deg": 16.0, "diameter": 20.0},
]


@pytest.mark.parametrize("profile", CONES, ids=["ball end", "flat end"])
def test_a_cone_lies_along_what_is_developable(profile: dict[str, Any]) -> None:
    def circle(radius: float, z: float) -> RailLike:
        return lambda u: np.column_stack([radius * np.cos(0.1 * u), radius * np.sin(0.1 * u), np.full(len(u), z)])

    for side in ("left", "right"):
        found = sc.flank_positions(circle(40.0, 0.0), circle(34.0, 20.0), {"profile": profile}, 900, side=side)
        error = found.error.between(0.25, 0.75)
        assert max(error.over, error.under) < 1e-6
        # the whole tool touches, between the rails as well
        middle = 37.0 * np.array([[np.cos(0.05), np.sin(0.05), 10.0 / 37.0]])
        assert found.clearance(middle) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("profile", CONES, ids=["ball end", "flat end"])
def test_a_cone_on_a_twisted_strip(profile: dict[str, Any]) -> None:
    found = {m: sc.flank_positions(*HP20, {"profile": profile}, 200, method=m) for m in ("swept", "two-points")}
    swept, offset = (micrometres(found[method].error) for method in ("swept", "two-points"))
    assert max(swept) < 13.0 < 0.5 * max(offset)
    with pytest.raises(sc.ToolError) as caught:
        sc.flank_positions(*HP20, {"profile": {**profile, "diameter": 8.0}}, 20)
    assert caught.value.code == "short-flank"


def test_the_ball_end_is_found_in_a_floor() -> None:
    # a wall upright on a floor that lies higher than the tip
    wall: Rails = ([(0, 0, 0), (40, 0, 0)], [(0, 0, 20), (40, 0, 20)])
    found = sc.flank_positions(*wall, {"profile": {"kind": "ball", "diameter": 6.0}}, 9)
    assert found.tips[:, 2] == pytest.approx(-3.0)
    floor = [(20.0, 3.0, -2.9), (20.0, 3.0, -3.2), (20.0, 0.0, 5.0)]
    assert found.clearance(floor) == pytest.approx([-0.1, 0.2, 0.0], abs=1e-9)


def test_how_fast_the_axis_turns() -> None:
    # a cone's axis turns evenly about its own: once in 2 pi of the rails' parameter
    def circle(radius: float, z: float) -> RailLike:
        return lambda u: np.column_stack([radius * np.cos(u), radius * np.sin(u), np.full(len(u), z)])

    turning = sc.flank_positions(circle(30.0, 0.0), circle(20.0, 20.0), cylinder(4.0), 200).turning(600.0)
    lean = np.arctan2(10.0, 20.0)
    # 10 mm/s along the middle circle of radius 25
    assert turning.speed == pytest.approx(np.degrees(10.0 / 25.0 * np.sin(lean)), rel=1e-3)
    # the axis of that turn goes round too
    assert turning.acceleration == pytest.approx(np.degrees(0.4**2 * np.sin(lean) * np.cos(lean)), rel=1e-3)


def test_the_path_as_cutter_locations() -> None:
    positions = placed(CV, 5.0, count=30)
    program = sc.flank_program(positions, feed=600.0, clearance=20.0, extension=2.0, lead=5.0, rpm=3000.0)
    lines = [line.removeprefix("GOTO/") for line in cl_text(program).splitlines() if line.startswith("GOTO/")]
    found = np.array([[float(number) for number in line.split(",")] for line in lines])
    # down, in and on; out and up
    assert len(found) == 3 + 30 + 3
    assert found[3:-3, :3] == pytest.approx(positions.tips, abs=5.1e-5)
    assert found[3:-3, 3:] == pytest.approx(positions.axes, abs=5.1e-8)
    lengths = np.linalg.norm(np.diff(found[:, :3], axis=0), axis=1)
    assert lengths[[0, 1, 2, -3, -2, -1]] == pytest.approx([20.0, 5.0, 2.0, 2.0, 5.0, 20.0], abs=2e-4)
    # in from the free side: the whole tool clear of the strip but where it begins
    away = np.vstack([positions.tips[:1], found[1:2, :3]])
    entering = replace(positions, tips=away, axes=positions.axes[[0, 0]])
    assert entering.clearance(positions.contacts[5:].reshape(-1, 3)).min() > 0.0
    with pytest.raises(sc.MachineError, match="no rotary axes"):
        sc.post(program, "linuxcnc")
    with pytest.raises(sc.GeometryError, match="feed"):
        sc.flank_program(positions, feed=0.0, clearance=20.0)


def test_rails_of_every_form_are_one() -> None:
    poles = np.array([(0, 0, 0), (30, 15, 0), (60, 0, 0)], dtype=float)

    def bezier(u: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        u = u[:, None]
        return np.asarray((1 - u) ** 2 * poles[0] + 2 * u * (1 - u) * poles[1] + u * u * poles[2])

    shares = np.linspace(0.0, 1.0, 9)
    forms = [sc.Rail.of({"poles": poles}), sc.Rail.of(bezier), sc.Rail.of({"poles": poles, "weights": [2, 2, 2]})]
    for rail in forms:
        assert rail.at(shares) == pytest.approx(bezier(shares), abs=1e-7)
    points = bezier(np.linspace(0.0, 1.0, 200))
    ends = sc.Rail.of(points).at(np.array([0.0, 1.0]))
    assert ends == pytest.approx(points[[0, -1]], abs=1e-9)


CORNER = [(0, 0, 0), (10, 0, 0), (20, 0, 0), (20, 10, 0), (20, 20, 0)]
GAP = [(0, 0, 0), (10, 0, 0), (15, 0, 0), (20, 0, 0), (30, 0, 0), (40, 0, 0)]


@pytest.mark.parametrize(
    ("rails", "code"),
    [
        (([(0, 0, 0), (40, 0, 0)], [(0, -10, 0), (40, 10, 0)]), "rails-meet"),
        (([(0, 0, 0), (40, 0, 0)], {"poles": [(0, 0, 20), (60, 0, 20), (-20, 0, 20), (40, 0, 20)]}), "rail-cusp"),
        (([(0, 0, 0), (40, 0, 0)], [(50, 0, 0), (90, 0, 0)]), "no-normal"),
        (([(0, 0, 0), (40, 0, np.nan)], [(0, 0, 20), (40, 0, 20)]), "argument"),
        (([(0, 0, 0), (0, 0, 0), (40, 0, 0)], [(0, 0, 20), (40, 0, 20)]), "same-points"),
        (([(0, 0, 0)], [(0, 0, 20), (40, 0, 20)]), "argument"),
        ((lambda u: np.full((len(u), 3), np.nan), [(0, 0, 20), (40, 0, 20)]), "not-finite"),
        ((lambda u: np.column_stack([u, np.abs(u - 0.3), 0 * u]) * 40, [(0, 0, 20), (40, 0, 20)]), "not-smooth"),
        (({"poles": [(0, 0, 0), (40, 0, 0)], "weights": [1, -1]}, [(0, 0, 20), (40, 0, 20)]), "argument"),
        (({"poles": [(0, 0, 0), (40, 0, 0)], "weights": [1, 0]}, [(0, 0, 20), (40, 0, 20)]), "argument"),
        (({"poles": [(0, 0, 0), (40, 0, 0)], "weights": [1, np.nan]}, [(0, 0, 20), (40, 0, 20)]), "argument"),
        (({"poles": [(0, 0, 0), (40, 0, 0)], "knots": [1, 1, 0, 0]}, [(0, 0, 20), (40, 0, 20)]), "argument"),
        (({"poles": [(0, 0, 0), (40, 0, 0)], "knots": [0, 0, 0, 0]}, [(0, 0, 20), (40, 0, 20)]), "not-finite"),
        (({"poles": [(i, 0, 0) for i in range(41)]}, [(0, 0, 20), (40, 0, 20)]), "out-of-range"),
        ((lambda u: 1 / np.zeros(0)[0], [(0, 0, 20), (40, 0, 20)]), "rail-function"),
        ((lambda u: np.zeros((len(u), 2)), [(0, 0, 20), (40, 0, 20)]), "shape"),
        ((lambda u: None, [(0, 0, 20), (40, 0, 20)]), "shape"),
        (([(0, 0, 0), (40, 0, 0)], [(40, 0, 20), (0, 0, 20)]), "rails-opposite"),
        (
            ({"poles": [(0, 0, 0), (20, 3, 0), (40, 0, 0)]}, {"poles": [(40, 0, 20), (20, 5, 20), (0, 0, 20)]}),
            "rails-opposite",
        ),
        (([(0, 0, 0), (4e8, 0, 0)], [(0, 0, 2e8), (4e8, 0, 2e8)]), "rail-size"),
        (([(0, 0, 0), (4e200, 0, 0)], [(0, 0, 20), (40, 0, 20)]), "argument"),
        (([(0, 0, 0), (4e-8, 0, 0)], [(0, 0, 2e-8), (4e-8, 0, 2e-8)]), "rail-size"),
        (
            ({"poles": CORNER, "degree": 2, "knots": [0, 0, 0, 0.5, 0.5, 1, 1, 1]}, [(0, 0, 20), (20, 20, 20)]),
            "rail-corner",
        ),
        (
            ({"poles": GAP, "degree": 2, "knots": [0, 0, 0, 0.3, 0.3, 0.3, 1, 1, 1]}, [(0, 0, 20), (40, 0, 20)]),
            "rail-corner",
        ),
    ],
)
def test_what_is_no_strip_is_refused(rails: Rails, code: str) -> None:
    with pytest.raises(sc.GeometryError) as caught:
        placed(rails, 3.0, count=5)
    assert caught.value.code == code


def test_what_is_not_known_is_not_nothing() -> None:
    # two positions so far apart that the first or the last of them comes nearest to every point
    rails: Rails = ([(0, 0, 0), (40, 0, 0)], [(0, 0, 20), (40, 0, 20)])
    unknown = placed(rails, 3.0, count=2).error.between(0.0, 0.0)
    assert np.isnan(unknown.left).all() and np.isnan(unknown.over) and np.isnan(unknown.under)
    # sharp bends are no corners
    bent: Rails = tuple({"poles": [(0, 0, z), (19.9, 0, z), (20, 0, z), (20, 0.1, z), (20, 20, z)]} for z in (0, 20))  # type: ignore[assignment]
    assert len(placed(bent, 3.0, "rails", 50, side="right").tips) == 50
    with pytest.raises(sc.GeometryError, match="100000 at most"):
        placed(rails, 3.0, count=10**9)


def test_a_hollow_and_a_taper_are_refused() -> None:
    arcs = [{"poles": [(0, 0, z), (10, 20, z), (20, 0, z)]} for z in (0, 15)]
    with pytest.raises(sc.GeometryError, match="hollow with a radius"):
        sc.flank_positions(*arcs, cylinder(12.0), 5, side="right")
    with pytest.raises(sc.ToolError) as caught:
        sc.flank_positions(*arcs, {"profile": {"kind": "clothoid", "diameter": 6.0, "end_slope_deg": 60.0}}, 5)
    assert caught.value.code in ("tapered-flank", "unknown-key")
    with pytest.raises(sc.GeometryError, match="count"):
        placed(CV, 5.0, count=1)


def test_a_position_without_its_axis_is_refused() -> None:
    tips, axes, points = np.zeros((3, 3)), np.tile([0.0, 0.0, 1.0], (2, 1)), np.zeros((1, 3))
    with pytest.raises(sc.GeometryError, match="2 axes for 3 tips"):
        _engine.clearance_of_tilted(sc.Tool.from_dict(cylinder(12.0))._engine, tips, axes, points)
