"""Results are records: typed fields for those who write code, mappings for those who had dicts."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass

import pytest
from conftest import job_document

import styluscam as sc
from styluscam.judging.results import FaceCoverage, Finding, Group
from styluscam.programs.summary import OperationSummary, Summary, SurfaceSummary
from styluscam.records import Record, plain

FINDING = {
    "kind": "gouge",
    "severity": "error",
    "line": 7,
    "first_line": 6,
    "last_line": 9,
    "moves": 4,
    "length_mm": 12.5,
    "position": [1.0, 2.0, -3.0],
    "value_mm": 0.25,
    "value": 0.25,
    "limit": 0.001,
    "unit": "mm",
    "message": "line 7: the tool enters the part",
}
COVERAGE = {
    "face": 3,
    "area": 100.0,
    "flat": 0.25,
    "carried": 0.25,
    "covered": 0.5,
    "scallop": 0.01,
    "mean": 0.005,
    "left": 0.2,
    "at": [0.0, 0.0, -1.0],
    "points": 40,
}


@dataclass(frozen=True, slots=True, eq=False)
class Both(Record):
    findings: tuple[Finding, ...]
    face: FaceCoverage


def test_a_record_reads_as_the_dict_of_its_fields() -> None:
    finding = Finding(**FINDING)
    assert finding.position == finding["position"] == FINDING["position"]
    assert finding == FINDING and finding == FINDING and {**finding} == FINDING
    assert list(finding) == list(FINDING) and len(finding) == len(FINDING) and finding.get("none") is None
    assert finding != {**FINDING, "line": 8}
    with pytest.raises(KeyError):
        finding["to_dict"]


def test_a_record_cannot_be_written_to_and_travels() -> None:
    finding = Finding(**FINDING)
    with pytest.raises(FrozenInstanceError):
        finding.line = 8  # type: ignore[misc]
    assert pickle.loads(pickle.dumps(finding)) == finding


def test_an_unknown_key_of_the_engine_is_no_silent_loss() -> None:
    with pytest.raises(TypeError, match="surprise"):
        Finding(**FINDING, surprise=1)


def test_records_are_json_with_what_they_hold() -> None:
    both = Both((Finding(**FINDING),), FaceCoverage(**COVERAGE))
    assert both.to_dict() == {"findings": [FINDING], "face": COVERAGE}
    assert json.dumps(both, default=plain) == json.dumps({"findings": [FINDING], "face": COVERAGE})
    with pytest.raises(TypeError, match="set is not JSON"):
        json.dumps({1}, default=plain)


def test_what_a_face_asks_for() -> None:
    face = FaceCoverage(**COVERAGE)
    assert face.to_form == 50.0 and "to_form" not in face
    assert FaceCoverage(**{**COVERAGE, "flat": 0.9}).to_form == 0.0


def test_groups_have_what_findings_have_and_more() -> None:
    assert set(Finding._names()) - set(Group._names()) == {"value_mm"}
    assert set(Group._names()) - set(Finding._names()) == {"count", "regions", "box", "findings"}


@pytest.fixture(scope="module")
def coarse_plan(part_of: Callable[[str], sc.Part]) -> sc.Plan:
    document = job_document("cone_cup", "z-level", {"kind": "ball", "diameter": 10.0})
    return sc.plan(sc.Job.from_dict(document, part=part_of("cone_cup")))


def test_a_summary_is_what_the_engine_reports(coarse_plan: sc.Plan) -> None:
    summary, notes = coarse_plan.summary()
    scene, machine = coarse_plan.settings["main"]
    document, lines = coarse_plan.engine.summary("main", scene, machine.engine)
    assert json.dumps(summary, default=plain) == json.dumps(json.loads(document)) and notes == lines
    (operation,) = summary.operations
    assert isinstance(operation, SurfaceSummary) and summary["operations"][0]["faces"] == operation.faces == [
        1,
        2,
        3,
        4,
    ]
    assert operation.facts[0].fact == "levels" and summary.ok is None
    assert Summary.of(summary.to_dict()) == summary and pickle.loads(pickle.dumps(summary)) == summary


def test_an_operation_that_follows_no_faces_has_no_keys_of_faces(coarse_plan: sc.Plan) -> None:
    document = coarse_plan.summary()[0].to_dict()
    kept = {key: document["operations"][0][key] for key in ("id", "kind", "words", "facts")}
    summary = Summary.of({**document, "operations": [kept]})
    assert type(summary.operations[0]) is OperationSummary and summary.to_dict()["operations"] == [kept]
