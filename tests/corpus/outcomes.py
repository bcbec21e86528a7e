"""One part: `new`, `run` as written, `run` of its variants; what came of each, and whether a user expects it."""

from __future__ import annotations

import argparse
import json
import re
import shutil
import zlib
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import jobs
import numpy as np
from gouge import Checked, checked
from process import Ended, Limit, styluscam

GOUGE_DEPTH = 0.001
"""The depth from which the engine's own verifier calls an entry a gouge, mm."""
AS_WRITTEN = "as-written"
THICKEST_SHEET = 6.0
"""mm: thicker ones are pressed; a corpus part of 2 m is a small one made larger."""
REASONS = {
    "unit": r"\bunits?\b",
    "undercut": r"undercut|look(s)? down|other side|from this side|up = ",
    "inside-out": r"inside out|inward|turned|orient",
    "open": r"\bopen\b|hole|gap|border|not closed",
    "steep": r"steep|wall angle|deg",
    "nothing": r"nothing|flat",
    "long": r"long|time|minutes|points",
    "format": r"format|ending|\.xyz|reads",
    "no-part": r"no (faces|part|solid|triangles)|holds no",
    "damaged": r"empty|not a whole|holds no|damaged|not numbers|no area",
    "mesh": r"cannot mesh|overlap|fold",
}
"""What the sentence of a refusal matches, by the reason."""
CLASSES = re.compile(r"\b[A-Z]\w*(Error|Exception)\b|Traceback|Standard_|StdFail")
ACCEPTED = {"wall-angle"}
"""Warnings that are true of some parts: sheets steeper than any material is sure to withstand."""
FEW = 10
IN_PIECES = 0.05
"""Lifts for nothing that are many: more than these, and more than this share of all cuts."""


@dataclass
class Outcome:
    """A line of the table."""

    part: str
    family: str
    variant: str
    outcome: str
    """done, refused, findings, timeout, crash, gouge, misplaced."""
    detail: str = ""
    """The sentence, the findings' kinds, what was wrong."""
    kinds: dict[str, int] = field(default_factory=dict)
    new_seconds: float = 0.0
    run_seconds: float = 0.0
    cpu: float = 0.0
    peak_mb: float = 0.0
    codes: list[int] = field(default_factory=list)
    wrong: str = ""
    """Why a user would not have expected it; empty where it is right."""
    gouge: float = 0.0
    touching: float | None = None
    samples: int = 0
    command: str = ""

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    def line(self) -> str:
        seconds = f"{self.new_seconds:.1f}+{self.run_seconds:.1f} s"
        why = f"{self.wrong}. " if self.wrong else ""
        start = f"{self.part:44} {self.variant:18} {self.outcome:9} {seconds:12} {self.peak_mb:5.0f} MB"
        return f"{start} {why}{self.detail[:150]}"


def run_part(part: dict[str, Any], folder: Path, scratch: Path, options: argparse.Namespace) -> list[Outcome]:
    """All runs of a part."""
    home = (options.keep or scratch) / re.sub(r"[^\w.-]", "_", part["name"])
    home.mkdir(parents=True, exist_ok=True)
    shutil.copy(folder / part["file"], home / part["file"])
    limit = Limit(options.limit, options.patience)
    named = ["--units", part["units"]] if part["units"] else []
    made = styluscam(["new", part["file"], *named, "--force", "--out", "job.toml", "--json"], home, limit)
    start = Outcome(
        part["name"], part["family"], AS_WRITTEN, "", new_seconds=made.seconds, cpu=made.cpu, peak_mb=made.peak_mb
    )
    start.codes = [made.code]
    start.command = f"styluscam new {part['file']} {' '.join(named)}".strip()
    rows = []
    if made.code != 0 or made.timed_out:
        _ended(start, made, part)
        rows.append(start)
    else:
        wanted = options.variant or [
            AS_WRITTEN,
            *([] if options.base else jobs.variants_of(part["name"], every=options.all)),
        ]
        for variant in wanted:
            rows.append(_run(part, variant, start, home, folder, limit))
    if not options.keep:
        shutil.rmtree(home)
    return rows


def _run(part: dict[str, Any], variant: str, start: Outcome, home: Path, folder: Path, limit: Limit) -> Outcome:
    job, file = jobs.read(home / "job.toml"), home / "job.toml"
    if variant != AS_WRITTEN:
        job = jobs.varied(job, variant, part["body"], part["thickness"])
        file = home / f"{variant}.toml"
        job["output"] = {"file": f"{variant}.ngc"}
        file.write_text(jobs.text(job), encoding="utf-8")
    ended = styluscam(["run", file.name, "--json"], home, limit)
    row = Outcome(part["name"], part["family"], variant, "", new_seconds=start.new_seconds, run_seconds=ended.seconds)
    row.codes, row.cpu, row.peak_mb = (
        [*start.codes, ended.code],
        start.cpu + ended.cpu,
        max(start.peak_mb, ended.peak_mb),
    )
    row.command = f"python tests/corpus/run.py --only {part['name']} --variant {variant} --keep /tmp/corpus --verbose"
    _ended(row, ended, part)
    if row.outcome == "done":
        if variant == AS_WRITTEN:
            row.wrong = _mistaken(job, part)
        _check(row, json.loads(ended.out), job, part, home, folder)
    return row


def _ended(row: Outcome, ended: Ended, part: dict[str, Any]) -> None:
    """What an exit code and its JSON mean."""
    if ended.timed_out:
        row.outcome, row.detail = "timeout", f"after {ended.seconds:.0f} s, {ended.cpu:.0f} s of them computed"
    elif ended.code < 0 or "Traceback" in ended.err or ended.code not in (0, 1, 2):
        row.outcome, row.detail = "crash", f"exit {ended.code}: {ended.err.strip()[-300:] or ended.out[-300:]}"
    elif ended.code == 2:
        row.outcome, row.detail = "refused", _sentence(ended)
    elif ended.code == 1:
        report = _json(ended.out).get("report", {})
        row.outcome, row.kinds = "findings", {k: n for k, n in report.get("counts", {}).items() if n}
        errors = [f for f in report.get("findings", []) if f.get("severity") == "error"]
        row.detail = "; ".join(f.get("message", f.get("kind", "")) for f in errors[:2])
    else:
        row.outcome = "done"
        row.kinds = {k: n for k, n in _json(ended.out).get("report", {}).get("counts", {}).items() if n}
    row.wrong = unexpected(row, part["expect"])


def unexpected(row: Outcome, expect: list[str]) -> str:
    """Why an outcome is none of those expected."""
    wanted = " or ".join(expect)
    if row.outcome in ("crash", "timeout", "findings", "gouge", "misplaced"):
        return f"{row.outcome}, expected {wanted}"
    if row.outcome == "done":
        if warned := sorted(set(row.kinds) - ACCEPTED):
            return f"done with a warning of {', '.join(warned)}"
        return "" if "done" in expect else f"done, expected {wanted}"
    if CLASSES.search(row.detail):
        return "the sentence names a class"
    if len(row.detail) < 30:
        return "the sentence states nothing to do"
    reasons = [word.partition(":")[2] for word in expect if word.startswith("refused")]
    if not reasons:
        return f"refused, expected {wanted}"
    fits = any(not reason or re.search(REASONS[reason], row.detail, re.IGNORECASE) for reason in reasons)
    return "" if fits else f"refused for another reason than {wanted}"


def _sentence(ended: Ended) -> str:
    error = _json(ended.out).get("error", {})
    return str(error.get("message") or ended.err.strip()[-400:])


def _json(text: str) -> dict[str, Any]:
    try:
        document = json.loads(text)
    except ValueError:
        return {}
    return document if isinstance(document, dict) else {}


def _check(
    row: Outcome, document: dict[str, Any], job: dict[str, Any], part: dict[str, Any], home: Path, folder: Path
) -> None:
    """The independent check of a done program: gouges, and whether it is where the part is."""
    if part["truth"] is None:
        return
    corners = _corners(folder / part["truth"])
    placed = _in_work(corners, job)
    text = (home / job["output"]["file"]).read_text(encoding="utf-8")
    allowed = GOUGE_DEPTH + float(job["part"].get("tolerance", 0.001)) + 1.5 * part["deviation"]
    found = checked(text, job, placed, allowed, "linuxcnc", zlib.crc32(part["name"].encode()))
    row.gouge, row.touching, row.samples = found.deepest, found.touching, found.samples
    if found.refused:
        row.outcome, row.detail = "misplaced", f"the text is not one: {found.refused}"
    elif found.deepest > 0:
        row.outcome = "gouge"
        row.detail = f"{found.deepest:.4f} mm into the part at line {found.line}, tip {found.at}"
    elif wrong := _misplaced(found, placed, document):
        row.outcome, row.detail = "misplaced", wrong
    row.wrong = row.wrong or unexpected(row, part["expect"])


def _mistaken(job: dict[str, Any], part: dict[str, Any]) -> str:
    """Where `new` takes a sheet for a block, a block for a sheet, or a sheet for another one."""
    kind = job.get("process", {}).get("kind", "spif")
    if part["body"] == "solid" and kind != "milling":
        return f"a solid body is planned as {kind}"
    cannot_be_formed = "refused:steep" in part["expect"] or part["family"] == "flat-sheet"
    if part["body"] == "sheet" and part["thickness"] > THICKEST_SHEET:
        if kind != "milling":
            return f"a sheet of {part['thickness']:.1f} mm is formed"
        cannot_be_formed = True
    if part["body"] == "sheet" and "done" in part["expect"] and kind == "milling" and not cannot_be_formed:
        return "a sheet part is milled"
    stated = job.get("setup", {}).get("sheet", {}).get("thickness")
    if part["body"] == "sheet" and stated is not None and abs(stated - part["thickness"]) > 0.05 * part["thickness"]:
        return f"the sheet is {part['thickness']:.3f} mm thick, the job states {stated:g}"
    return ""


def _in_work(corners: np.ndarray, job: dict[str, Any]) -> np.ndarray:
    """Triangles in the job's work coordinates."""
    setup = job.get("setup", {})
    corners = corners @ turn_up(setup.get("up", "+z"), setup.get("rotation", 0.0)).T
    zero = setup.get("zero", "sheet-top" if "sheet" in setup else "model")
    if isinstance(zero, list):
        return corners - np.array(zero)
    if zero == "model":
        return corners
    share = {"tool": 0.0, "mid": 0.5, "back": 1.0}[job["part"].get("model_face", "tool")]
    top = corners[..., 2].max() + share * setup["sheet"]["thickness"]
    return corners - np.array([0.0, 0.0, top])


def turn_up(up: str, about_z_deg: float) -> np.ndarray:
    """The rotation (3, 3) that brings an axis of the model upright by the least angle (down: about X), and turns it then."""
    axis = np.zeros(3)
    axis["xyz".index(up[-1])] = -1.0 if up[0] == "-" else 1.0
    if axis[2] == -1.0:
        shortest = np.diag([1.0, -1.0, -1.0])
    else:
        x, y, _ = np.cross(axis, [0.0, 0.0, 1.0])
        cross = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
        shortest = np.eye(3) + cross + cross @ cross / (1.0 + axis[2])
    sine, cosine = np.sin(np.radians(about_z_deg)), np.cos(np.radians(about_z_deg))
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]) @ shortest


def _corners(path: Path) -> np.ndarray:
    """The triangles as they were made (T, 3, 3), mm; committed ones are vertices in millionths and indices."""
    held = np.load(path)
    return held if path.suffix == ".npy" else 1e-6 * held["steps"][held["triangles"]]


def _misplaced(found: Checked, placed: np.ndarray, document: dict[str, Any]) -> str:
    """Where path and part do not lie together (a wrong unit, a wrong zero), or the path is cut to pieces."""
    points = placed.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    stated = document.get("summary", {})
    if "part_min" in stated:
        off = max(np.abs(np.array(stated["part_min"]) - low).max(), np.abs(np.array(stated["part_max"]) - high).max())
        if off > 0.01 + 1e-3 * float(np.max(high - low)):
            return f"the summary's box is off the part's by {off:.3f} mm"
    if found.touching == 0.0:
        return "the path touches the part nowhere"
    if found.lifts > max(FEW, IN_PIECES * found.cuts):
        return f"the path is in pieces: {found.lifts} of {found.cuts} cuts begin where the one before ended"
    return ""
