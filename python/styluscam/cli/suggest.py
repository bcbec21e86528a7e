"""``styluscam tool suggest``: a library's tools, ranked for a job."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from styluscam.cli import console, progress
from styluscam.cli.failures import naming
from styluscam.cli.options import Debug, JobFile, Json, Quiet
from styluscam.programs.job import Job
from styluscam.tools import library
from styluscam.tools.tool import Tool

if TYPE_CHECKING:
    from styluscam.advice.facts import Facts
    from styluscam.advice.suggest import Candidate

LibraryFile = Annotated[
    Path | None,
    typer.Option(
        "--library",
        metavar="FILE.json",
        help="A library of your own; default: the shipped one for the job's process.",
        show_default=False,
    ),
]
Best = Annotated[int, typer.Option("--plan", min=0, max=50, help="Plan the job with this many of the best.")]
Operation = Annotated[
    str | None, typer.Option("--operation", metavar="ID", help="Rank for one operation alone.", show_default=False)
]
Rows = Annotated[int, typer.Option("--rows", min=1, help="Number of tools to show.")]


def suggest(
    job: JobFile,
    *,
    own: LibraryFile = None,
    operation: Operation = None,
    plan: Best = 3,
    rows: Rows = 12,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Rank a library's tools for a job: by what they bridge, then by the scallops they leave.

    All follow the job's passes, so that the paths are equally long, and do all of its operations. It only ranks: the
    choice is yours.
    """
    from styluscam.advice.suggest import micrometres
    from styluscam.advice.suggest import suggest as advise

    if own is not None:
        _check(own)
    with naming(job), progress.shown(not (json or quiet)) as report:
        work = Job.read(job)
        shelf = _shelf(work) if own is None else library.read_library(own)
        advice = advise(work, list(shelf.tools.values()), best=plan, operation=operation, progress=report)
    if json:
        console.say_json({"library": shelf.name, **advice.to_dict()})
        return 0
    candidates = advice.candidates[:rows]
    console.say(f"{shelf.name}: {len(advice.candidates)} tools, {advice.facts.passes}; best first")
    console.say()
    table = [
        [
            candidate.tool.name,
            candidate.tool.description,
            micrometres(candidate.left_mm),
            micrometres(candidate.scallop_mm),
            f"{micrometres(candidate.worst_mm)} at {candidate.worst_at_deg:.0f}°",
            _bridged(candidate),
            f"{100.0 * candidate.unreached:.1f}",
        ]
        for candidate in candidates
    ]
    headings = {
        "tool": "left", "profile": "left", "left um": "right", "scallop um": "right", "largest": "right",
        "bridged mm": "right", "unreached %": "right",
    }  # fmt: skip
    console.table(headings, table)
    console.say()
    shown = [candidate for number, candidate in enumerate(candidates) if candidate.asked or number < 3]
    console.fields([(candidate.tool.name, "; ".join(candidate.reasons)) for candidate in shown])
    console.say()
    console.fields(_part(advice.facts) + [("note", note) for note in advice.notes])
    return 0


def _bridged(candidate: Candidate) -> str:
    """As planning found it, or with a ~ as the profile has it."""
    if candidate.failure:
        return "no path"
    return f"{'' if candidate.asked else '~'}{candidate.bridged_mm:.3f}"


def _check(own: Path) -> None:
    """Refuses a library with a tool that cannot be built: that is no fault of the job."""
    shelf = library.read_library(own)
    for name in shelf.tools:
        Tool.of_library(shelf, name)


def _shelf(job: Job) -> library.Library:
    """The shipped library for the job's process."""
    name = "forming" if job.engine.forms else "milling"
    return next(shelf for shelf in library.shipped() if shelf.name == name)


def _part(facts: Facts) -> list[tuple[str, str]]:
    most = sorted(facts.walls, key=lambda wall: -wall.share)[:3]
    walls = ", ".join(f"{100.0 * wall.share:.0f} % near {wall.angle_deg:.0f} deg" for wall in most)
    hollow, fits = facts.smallest_concave_radius_mm, facts.fitting_radius_mm
    operations = [(each.id, f"{each.passes}, on {_faces(each.faces)}") for each in facts.operations]
    return [
        *operations,
        ("wall angles", walls),
        ("most concave", "nowhere" if hollow is None else f"radius {hollow:.3g} mm"),
        ("narrow gaps", "none" if fits is None else f"a tool of up to {2.0 * fits:.3g} mm fits nearly all"),
    ]


def _faces(numbers: list[int]) -> str:
    shown = ", ".join(f"Face{number}" for number in numbers[:6])
    return shown if len(numbers) <= 6 else f"{shown}, ... {len(numbers)} faces in all"
