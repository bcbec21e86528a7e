"""``styluscam tool suggest``: a library's tools, ranked for a job."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam import library
from styluscam.cli import console, progress
from styluscam.cli.failures import naming
from styluscam.cli.options import Debug, JobFile, Json, Quiet
from styluscam.job import Job
from styluscam.types import Document

LibraryFile = Annotated[
    Path | None,
    typer.Option(
        "--library",
        metavar="FILE.json",
        help="A library of your own; else the shipped one for the job's process.",
        show_default=False,
    ),
]
Best = Annotated[int, typer.Option("--plan", min=0, max=50, help="Plan the job with so many of the best.")]
Rows = Annotated[int, typer.Option("--rows", min=1, help="Show so many tools.")]


def suggest(
    job: JobFile,
    *,
    own: LibraryFile = None,
    plan: Best = 3,
    rows: Rows = 12,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Rank a library's tools for a job: by the scallops they leave and by what they cannot reach.

    All follow the job's passes, so that the paths are equally long. It only ranks: the choice is yours.
    """
    from styluscam.suggest import suggest as advise

    with naming(job), progress.shown(not (json or quiet)) as report:
        work = Job.read(job)
        shelf = _shelf(work) if own is None else library.read_library(own)
        advice = advise(work, list(shelf.tools.values()), best=plan, progress=report)
    if json:
        console.say_json({"library": shelf.name, **advice.to_dict()})
        return 0
    candidates = advice.candidates[:rows]
    console.say(f"{shelf.name}: {len(advice.candidates)} tools, {advice.facts['passes']}; best first")
    console.say()
    table = [
        [
            candidate.tool.name,
            candidate.tool.description,
            f"{1e3 * candidate.scallop_mm:.3g}",
            f"{1e3 * candidate.worst_mm:.3g} at {candidate.worst_at_deg:.0f}°",
            f"{100.0 * candidate.unreached:.1f}",
        ]
        for candidate in candidates
    ]
    headings = {"tool": "left", "profile": "left", "scallop um": "right", "largest": "right", "unreached %": "right"}
    console.table(headings, table)
    console.say()
    console.fields([(candidate.tool.name, "; ".join(candidate.reasons)) for candidate in candidates[: max(plan, 3)]])
    console.say()
    console.fields(_part(advice.facts) + [("note", note) for note in advice.notes])
    return 0


def _shelf(job: Job) -> library.Library:
    """The shipped library for the job's process."""
    milling = job.document.get("process", {}).get("kind") == "milling"
    return next(shelf for shelf in library.shipped() if shelf.name == ("milling" if milling else "forming"))


def _part(facts: Document) -> list[tuple[str, str]]:
    most = sorted(facts["walls"], key=lambda wall: -wall["share"])[:3]
    walls = ", ".join(f"{100.0 * wall['share']:.0f} % near {wall['angle_deg']:.0f} deg" for wall in most)
    hollow = facts["smallest_concave_radius_mm"]
    return [
        ("wall angles", walls),
        ("most concave", "nowhere" if hollow is None else f"radius {hollow:.3g} mm"),
    ]
