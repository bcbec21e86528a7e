"""The documents: the schema describes itself soundly, jobs and programs come back as they went."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Mesh, job_document, milling_document

import styluscam as sc
from styluscam.programs.program import FEED, MOVE, RAPID

BALL = {"kind": "ball", "diameter": 1.5}
TYPES = {"array", "boolean", "integer", "null", "number", "object", "string"}


@pytest.fixture(scope="module")
def plan(small_part: Mesh) -> sc.Plan:
    """A job of two operations on the small made part."""
    document = milling_document("z-level", BALL, step={"height": 0.5}, id="levels")
    document["operations"] += milling_document("zig-zag", BALL, stepover=0.5, spindle={"mode": "fixed", "rpm": 6000.0})[
        "operations"
    ]
    return sc.plan(sc.Job.from_dict(document, part=sc.Part.from_mesh(*small_part)))


def nodes(schema: Any) -> Iterator[dict[str, Any]]:
    """Every object of a document."""
    if isinstance(schema, dict):
        yield schema
        for value in schema.values():
            yield from nodes(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from nodes(value)


def test_the_job_schema_is_a_sound_json_schema() -> None:
    schema = sc.job_schema()
    assert json.loads(json.dumps(schema)) == schema
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["type"] == "object"
    used = set()
    for node in nodes(schema):
        if isinstance(reference := node.get("$ref"), str):
            assert reference.startswith("#/$defs/")
            used.add(reference.removeprefix("#/$defs/"))
        for word in ("oneOf", "anyOf", "allOf"):
            assert node.get(word, [{}])
        if isinstance(node.get("properties"), dict) and "type" in node:
            assert set(node.get("required", [])) <= set(node["properties"])
        kinds = node.get("type")
        if isinstance(kinds, (str, list)):
            assert set([kinds] if isinstance(kinds, str) else kinds) <= TYPES
    assert used == set(schema["$defs"])
    assert set(schema["required"]) >= {"schema", "part", "tools", "operations", "machine"}
    assert schema["additionalProperties"] is False


def test_every_key_of_the_schema_has_a_description() -> None:
    missing = [
        f"{owner}.{key}"
        for owner, definition in {**sc.job_schema()["$defs"], "job": sc.job_schema()}.items()
        for key, value in definition.get("properties", {}).items()
        if "description" not in value and "$ref" not in value
    ]
    assert missing == []


def test_jsonschema_agrees() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator
    validator.check_schema(sc.job_schema())
    job = sc.Job.from_dict(job_document("cone_cup", "z-level", BALL))
    assert list(validator(sc.job_schema()).iter_errors(job.to_dict())) == []
    assert list(validator(sc.job_schema()).iter_errors({**job.to_dict(), "stuff": 1}))


@pytest.mark.parametrize("kind", ("z-level", "zig-zag"))
def test_a_job_comes_back_as_it_went(kind: str, tmp_path: Path) -> None:
    job = sc.Job.from_dict(job_document("cone_cup", kind, BALL))
    assert sc.Job.from_dict(job.to_dict()).to_dict() == job.to_dict()
    (tmp_path / "job.json").write_text(json.dumps(job.to_dict()))
    read = sc.Job.read(tmp_path / "job.json")
    assert read.to_dict() == job.to_dict()
    assert read.folder == tmp_path
    # defaults are filled in
    assert job.to_dict()["operations"][0]["tolerance"] == 0.005
    assert job.to_dict()["setup"]["wcs"] == "G54"


def test_a_program_comes_back_bit_by_bit(plan: sc.Plan, tmp_path: Path) -> None:
    program = plan.programs["main"]
    program.save(tmp_path / "path.json")
    loaded = sc.Program.load(tmp_path / "path.json")
    assert loaded.moves.dtype == program.moves.dtype
    assert loaded.moves.tobytes() == program.moves.tobytes()
    assert (loaded.events, loaded.tools, loaded.operations, loaded.setup) == (
        program.events,
        program.tools,
        program.operations,
        program.setup,
    )
    loaded.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "path.json").read_bytes()


def test_a_file_that_is_no_program_is_refused(tmp_path: Path) -> None:
    with pytest.raises(sc.StylusError):
        sc.Program.load(tmp_path / "none.json")
    for text in ("", "{}", "[1, 2]", '{"schema": 99}'):
        (tmp_path / "bad.json").write_text(text)
        with pytest.raises(sc.StylusError):
            sc.Program.load(tmp_path / "bad.json")


def test_moves_are_a_structured_array(plan: sc.Plan) -> None:
    program = plan.programs["main"]
    moves = program.moves
    assert moves.dtype == MOVE
    assert set(np.unique(moves["kind"])) == {RAPID, FEED}
    assert set(np.unique(moves["operation"])) == {0, 1}
    assert (np.diff(moves["operation"].astype(int)) >= 0).all()
    assert np.isfinite(moves["end"]).all()
    assert set(np.unique(moves["feed"][moves["kind"] == FEED])) == {300.0, 1500.0}
    assert (moves["line"] == 0).all()
    assert program.positions.shape == (len(moves), 3)
    assert [o["id"] for o in program.operations] == ["levels", "zig-zag-2"]
    assert [e["before"] for e in program.events] == sorted(e["before"] for e in program.events)


def test_length_and_duration_are_those_of_the_moves(plan: sc.Plan) -> None:
    program = plan.programs["main"]
    moves, ends = program.moves, program.positions
    lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)
    feeds = moves["kind"][1:] == FEED
    assert program.length == pytest.approx(lengths[feeds].sum(), rel=1e-12)
    rates = np.where(feeds, moves["feed"][1:], 3000.0)
    assert program.duration == pytest.approx((lengths / rates).sum() * 60.0, rel=1e-9)


@pytest.mark.parametrize("machine", sc.Machine.names())
def test_posted_text_reads_back_as_the_same_moves(machine: str, plan: sc.Plan) -> None:
    shipped = sc.Machine.shipped(machine)
    read = sc.read_gcode(sc.post(plan, shipped).text, shipped)
    wanted = plan.programs["main"]
    count = len(wanted.moves)
    assert (read.moves["kind"][-count:] == wanted.moves["kind"]).all()
    assert np.abs(read.positions[-count:] - wanted.positions).max() <= 0.5 * shipped.resolution_mm + 1e-12
    cuts = wanted.moves["kind"] == FEED
    feeds, stated = read.moves["feed"][-count:][cuts], wanted.moves["feed"][cuts]
    if shipped.document["feed"]["mode"] == "inverse-time":
        # a time is rounded, and with it the feed: the last digit of the coordinates of a short move
        lengths = np.linalg.norm(np.diff(wanted.positions, axis=0, prepend=wanted.positions[:1]), axis=1)[cuts]
        assert (np.abs(feeds - stated) <= stated * (1e-4 + 4.0 * shipped.resolution_mm / lengths)).all()
    else:
        assert (feeds == stated).all()
    lines = read.moves["line"].astype(int)
    assert lines[0] > 0
    assert (np.diff(lines) > 0).all()
