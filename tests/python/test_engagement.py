"""The engagement angle along plane paths: closed forms through the public name."""

from __future__ import annotations

import math

import numpy as np
import pytest

import styluscam as sc

SQUARE = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]]


def test_a_slot_engages_half_the_rim_and_a_pass_beside_it_by_its_stepover():
    r, s = 3.0, 1.2
    slot = ([[-16.0, 0.0], [16.0, 0.0]], "cut")
    over = ([[16.0, 0.0], [-16.0, s]], "rapid")
    beside = ([[-16.0, s], [16.0, s]], "cut")
    found = sc.engagement([slot, over, beside], r, None, SQUARE)
    assert [run.kind for run in found] == ["cut", "rapid", "cut"]
    middle = [run.angles_deg[np.abs(run.points[:, 0]) < 10.0] for run in found]
    assert np.allclose(middle[0], 180.0, atol=1e-6) and middle[1].size == 0
    assert np.allclose(middle[2], math.degrees(math.acos(1.0 - s / r)), atol=0.03)
    assert np.allclose(np.diff(found[0].distances[1:-1]), 0.02 * r)
    assert np.isinf(found[0].clearances[250]) and math.isclose(found[0].clearances[0], 4.0)


def test_material_ends_with_the_stock_and_with_the_walls():
    half = np.array([[-20.0, -20.0], [20.0, -20.0], [20.0, 0.0], [-20.0, 0.0]])
    slot = ([[-16.0, 0.0, 0.0], [16.0, 0.0, 0.0]], "cut")
    for stock, boundary in ((half, SQUARE), (None, half), (SQUARE, half)):
        (run,) = sc.engagement([slot], 3.0, stock, boundary)
        assert np.allclose(run.angles_deg[1:], 90.0, atol=1e-6) and math.isclose(run.angles_deg[0], 180.0)
    island = [[[-15.0, -2.0, 0.0], [15.0, -2.0, 0.0], [15.0, 2.0, 0.0], [-15.0, 2.0, 0.0]]]
    (run,) = sc.engagement([slot], 3.0, None, [SQUARE, *island])
    assert math.isclose(run.angles_deg[len(run.angles_deg) // 2], 2 * math.degrees(math.acos(2.0 / 3.0)), abs_tol=1e-6)


@pytest.mark.parametrize(
    ("runs", "radius", "where"),
    [
        ([([[0.0, 0.0], [1.0, math.nan]], "cut")], 1.0, "runs[0][1]"),
        ([([[0.0, 0.0], [1.0, 0.0]], "plunge")], 1.0, "runs[0]"),
        ([([[0.0, 0.0], [1.0, 0.0]], "cut"), "cut"], 1.0, "runs[1]"),
        ([([[0.0, 0.0], [1.0, 0.0]], "cut")], -1.0, "tool_radius"),
    ],
)
def test_what_is_no_path_is_refused_by_name(runs, radius, where):
    with pytest.raises(sc.GeometryError) as refused:
        sc.engagement(runs, radius, None, SQUARE)
    assert refused.value.where == where
