"""``styluscam freecad run``: FreeCAD documents computed, verified and posted without a window."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from styluscam.cli import console, progress
from styluscam.cli.findings import SHOWN
from styluscam.cli.options import Debug, Force, Json, Quiet
from styluscam.cli.summary import shown_path
from styluscam.freecad.batch import run_documents
from styluscam.freecad.document import DocumentRun, Options
from styluscam.types import Document
from styluscam.words import clock

app = typer.Typer(help="Run FreeCAD documents without a window.", rich_markup_mode=None)

Files = Annotated[list[Path], typer.Argument(metavar="FILE.FCStd", help="The documents.", show_default=False)]
Post = Annotated[
    str | None,
    typer.Option(
        "--post", metavar="MACHINE", help="The machine; default: each job's own post processor.", show_default=False
    ),
]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="LABEL.PROPERTY=VALUE",
        help="Set a property first, with units as FreeCAD reads them: Cup.Step=0.3. Repeatable.",
        show_default=False,
    ),
]
Jobs = Annotated[
    list[str] | None,
    typer.Option("--job", metavar="LABEL", help="This job only. Repeatable.", show_default=False),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", "-o", metavar="FILE", help="The file to write; default: the job's own output file.", show_default=False
    ),
]
Save = Annotated[bool, typer.Option("--save", help="Also save the computed document if no error was found.")]
Addon = Annotated[
    Path | None,
    typer.Option(
        "--addon", metavar="DIR", help="The addon's folder, if it is not in FreeCAD's Mod folder.", show_default=False
    ),
]
Workers = Annotated[int, typer.Option("--jobs", metavar="N", min=1, help="Number of documents processed at a time.")]


@app.callback(invoke_without_command=True)
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        console.say(context.get_help())


@app.command("run")
def run(
    files: Files,
    *,
    post: Post = None,
    settings: Set = None,
    job: Jobs = None,
    out: Out = None,
    save: Save = False,
    addon: Addon = None,
    workers: Workers = 1,
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Compute, verify, post and write the CAM jobs of FreeCAD documents.

    The programs of a document are written together, or none of them. What goes wrong in one document does not stop the
    others; the exit code is that of the worst. FreeCAD is looked for in STYLUSCAM_FREECADCMD and on the PATH.
    """
    options = Options(post=post or "", jobs=job or (), settings=settings or (), save=save, addon=addon)
    with progress.shown(not (json or quiet)) as shown:
        runs = run_documents(files, options, out=out, force=force, workers=workers, progress=shown)
    code = max((each.exit_code for each in runs), default=0)
    if debug:
        for each in runs:
            console.complain(f"{each.file}: FreeCAD printed:\n{each.printed.rstrip()}")
            for error in each.errors:
                console.complain(error.get("traceback", "").rstrip())
    if json:
        console.say_json({"ok": code == 0, "exit_code": code, "files": [each.to_dict() for each in runs]})
    else:
        for each in runs:
            _print(each, quiet)
    return code


def _print(run: DocumentRun, quiet: bool) -> None:
    """What a person looks at first; what is wrong, and what was not verified, in any case."""
    if not quiet:
        rows = [(key, value) for job in run.jobs for key, value in _rows(job)]
        rows += [("written", shown_path(path)) for path in run.written]
        console.say(f"{run.file}: {'done' if run.exit_code == 0 else 'NOTHING WRITTEN'}")
        console.fields([(f"  {key}", value) for key, value in rows])
    notes = [*run.report.get("notes", []), *(f"{job['label']}: {note}" for job in run.jobs for note in job["notes"])]
    for note in notes:
        console.complain(f"note: {run.file}: {note}")
    for job in run.jobs:
        for line in _findings(job):
            console.complain(f"{run.file}: {line}")
    for error in run.errors:
        console.complain(f"error: {_line(run, error)}")


def _rows(job: Document) -> list[tuple[str, str]]:
    rows = [("job", f"{job['label']}: {job['post']}")]
    for each in job["operations"]:
        rows.append(("operation", f"{each['label']}: {_operation(each)}"))
    for each in job["programs"]:
        length = "" if each["length_mm"] is None else f", {each['length_mm']:.0f} mm, {clock(each['duration_s'])}"
        rows.append(("program", f"{each['lines']} lines{length}: {_verified(each)}"))
    return rows


def _operation(operation: Document) -> str:
    if not operation["active"]:
        return f"{operation['kind']}, switched off"
    if operation["error"]:
        return f"{operation['kind']}, FAILED"
    duration = "" if operation["duration_s"] is None else f", {clock(operation['duration_s'])}"
    return f"{operation['kind']}, {operation['length_mm']:.0f} mm{duration}"


def _verified(program: Document) -> str:
    report = program["report"]
    if report is None:
        return f"not verified: {program['unverified']}"
    figures = f"worst gouge {report['gouge_max']:.4f} mm, worst excess {report['excess_max']:.4f} mm"
    return f"{'verified' if report['ok'] else 'FAILED'}, {figures}"


def _findings(job: Document) -> list[str]:
    """Groups of findings as sentences, errors first."""
    groups = [group for each in job["programs"] if each["report"] for group in each["report"]["groups"]]
    more = len(groups) - SHOWN
    sentences = [f"{group['severity']}: {group['message']}" for group in groups[:SHOWN]]
    return [*sentences, *([f"and {more} more: --json lists them all"] if more > 0 else [])]


def _line(run: DocumentRun, error: Document) -> str:
    """One line: file, what, where, what to do."""
    where = [str(run.file), error["where"]]
    names = [name for name in dict.fromkeys(where) if name and name not in error["message"]]
    hint = f"; {error['hint']}" if error["hint"] and error["hint"] not in error["message"] else ""
    return " ".join(f"{''.join(f'{name}: ' for name in names)}{error['message']}{hint}".split())
