"""Pairs of programs for double-sided forming: sound ones pass, and seeded defects of the pair are found."""

from __future__ import annotations

import copy
import random
from functools import lru_cache
from typing import Any, NamedTuple

import pytest

import styluscam as sc
from pairs import KINDS, Between, Pair, matters

from .cases import ROUND

LEAST_SCORE = 0.99
DRAWN = 8
"""Seeds of a kind among which one must matter."""
CASES: list[tuple[dict[str, Any], float, list[float]]] = [
    ({"thickness": 0.8}, 0.95, [4.0, 3.0]),
    ({"thickness": 1.0, "law": "sine"}, 0.9, [5.0, 3.0]),
    ({"thickness": 0.6}, 1.0, [4.0, 6.0]),
]
"""Sheet, squeeze, diameters of both balls."""


class Planned(NamedTuple):
    """A job and its two texts."""

    job: sc.Job
    pair: Pair
    between: Between


def document(number: int) -> dict[str, Any]:
    sheet, squeeze, (diameter, below) = CASES[number]
    return {
        "schema": 1,
        "part": {"file": "cone.stl", "model_face": "tool"},
        "process": {"kind": "dsif", "squeeze": squeeze, "support_tool": "below"},
        "setup": {"sheet": sheet},
        "tools": {
            "tool": {"profile": {"kind": "ball", "diameter": diameter}},
            "below": {"profile": {"kind": "ball", "diameter": below}},
        },
        "operations": [{"kind": "z-level", "tool": "tool", "step": {"height": 1.0}, "z_bottom": -4.0}],
        "machine": {"name": "linuxcnc"},
        "machines": {"support": {"name": "linuxcnc"}},
        "accept": ["bridged", "unreached"],
    }


def job_of(described: dict[str, Any]) -> sc.Job:
    return sc.Job.from_dict(described, part=sc.Part.from_mesh(*ROUND["cone"]))


def pair_of(job: sc.Job) -> Pair:
    return Pair(*sc.post(sc.plan(job)).files.values())


@lru_cache
def planned(number: int) -> Planned:
    job = job_of(document(number))
    sheet, squeeze, (diameter, below) = CASES[number]
    left = squeeze * sheet["thickness"]
    along = (0.0, left) if sheet.get("law") == "sine" else (left, 0.0)
    return Planned(job, pair_of(job), Between(diameter / 2, below / 2, *along))


def is_found(pair: Pair, job: sc.Job) -> bool:
    """Whether an error is found in either text, or one cannot be read."""
    try:
        reports = [sc.verify(pair.main, job, beside=pair.support)]
        reports.append(sc.verify(pair.support, job, channel="support", beside=pair.main))
    except sc.VerifyError:
        return True
    return not all(report.ok for report in reports)


def trial(kind: str, seed: int) -> bool | None:
    """Whether a defect is found; nothing where there is none, or it does not matter."""
    case = planned(seed % len(CASES))
    spoilt = KINDS[kind](case.pair, random.Random(f"{kind} {seed}"))
    if spoilt is None or not matters(case.pair, spoilt, case.between):
        return None
    return is_found(spoilt, case.job)


@pytest.mark.parametrize("number", range(len(CASES)))
def test_a_sound_pair_passes(number: int) -> None:
    case = planned(number)
    assert not matters(case.pair, case.pair, case.between)
    for text, beside, channel in ((*case.pair, "main"), (*case.pair[::-1], "support")):
        report = sc.verify(text, case.job, channel=channel, beside=beside)
        errors = [finding.message for finding in report.findings if finding.severity == "error"]
        assert report.ok, errors


@pytest.mark.parametrize("kind", KINDS)
def test_a_defect_of_each_kind_is_found(kind: str) -> None:
    found = next((found for seed in range(DRAWN) if (found := trial(kind, seed)) is not None), None)
    assert found is not None, "none of them matters"
    assert found


@pytest.mark.parametrize("squeeze", (0.85, 1.0))
def test_another_squeeze_is_found_in_the_pair_and_in_the_support_alone(squeeze: float) -> None:
    case = planned(0)
    other = copy.deepcopy(document(0))
    other["process"]["squeeze"] = squeeze
    spoilt = pair_of(job_of(other))
    report = sc.verify(spoilt.main, case.job, beside=spoilt.support)
    assert {"squeeze", "unsupported"} & set(report.to_dict()["counts"])
    alone = sc.verify(spoilt.support, case.job, channel="support")
    assert {"gouge", "excess"} & set(alone.to_dict()["counts"])


def test_another_tool_below_is_found() -> None:
    other = document(0)
    other["tools"]["below"]["profile"]["diameter"] = 3.5
    assert is_found(planned(0).pair, job_of(other))


def test_a_start_at_different_times_is_found() -> None:
    case = planned(0)
    support = case.pair.support.replace("M0\n", "", 1)
    assert support != case.pair.support
    report = sc.verify(case.pair.main, case.job, beside=support)
    assert "out-of-step" in report.to_dict()["counts"]


@pytest.mark.parametrize("channel", ("main", "support"))
def test_a_text_alone_is_reported_as_half_checked(channel: str) -> None:
    case = planned(0)
    text = case.pair.main if channel == "main" else case.pair.support
    report = sc.verify(text, case.job, channel=channel)
    warnings = [finding for finding in report.findings if finding.severity == "warning"]
    assert any(finding.kind == "not-checked" and "not given" in finding.message for finding in warnings)


@pytest.mark.long
def test_the_score(record_property: Any) -> None:
    found = [(kind, seed, found) for kind in KINDS for seed in range(30) if (found := trial(kind, seed)) is not None]
    missed = [(kind, seed) for kind, seed, was_found in found if not was_found]
    record_property("score", f"{len(found) - len(missed)} of {len(found)}")
    assert len(found) > 10 * len(KINDS)
    assert 1.0 - len(missed) / len(found) >= LEAST_SCORE, missed
