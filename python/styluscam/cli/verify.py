"""``styluscam verify``: checks a G-code file against a job's part."""

from __future__ import annotations

from pathlib import Path

from styluscam.cli import console, findings, pages, progress, summary
from styluscam.cli.failures import FOUND, naming
from styluscam.cli.options import (
    BesideFile,
    ChannelName,
    Debug,
    ForJob,
    GcodeFile,
    Json,
    Picture,
    Quiet,
    ReportFile,
    SimulationFile,
)
from styluscam.errors import VerifyError
from styluscam.judging import clearing, coverage, flanks, simulation, verification
from styluscam.programs.job import MAIN_CHANNEL, Job
from styluscam.report.findings import verdict_of
from styluscam.report.subject import Subject
from styluscam.words import position


def verify(
    file: GcodeFile,
    job: ForJob,
    *,
    report: ReportFile = None,
    picture: Picture = None,
    simulated: SimulationFile = None,
    channel: ChannelName = MAIN_CHANNEL,
    beside: BesideFile = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Verify a G-code file against a job's part.

    The text is read as the job's machine reads it: gouges, excess, rapids, order; and what it leaves on each face.
    """
    with naming(job), naming(file, VerifyError), progress.shown(not (json or quiet)) as shown:
        work = Job.read(job)
        pages.require(report, picture, inputs=[file, *work.inputs()])
        if simulated is not None:
            simulation.require(simulated, inputs=[file, *work.inputs()])
        checked = verification.verify_file(file, work, channel=channel, beside=beside, progress=shown)
        covered = checked.coverage(progress=shown) if json or not quiet else []
        written = pages.write(lambda: Subject.judged(checked, work.machine(channel), file.name), report, picture, shown)
        if simulated is not None:
            simulation.simulate(checked, progress=shown).save(simulated)
            written.append(simulated)
    if json:
        document = {"file": str(file), "job": str(job), **findings.document(checked), "coverage": covered}
        document["engagement"] = [one.figures for one in checked.engagement]
        console.say_json({**document, "written": [str(path) for path in written]})
    elif quiet and checked.ok:
        for line in findings.lines(checked):
            console.complain(line)
    else:
        _print(checked, file)
        console.fields([("written", summary.shown_path(path)) for path in written])
    return 0 if checked.ok else FOUND


def _print(report: verification.Report, file: Path) -> None:
    document = report.to_dict()
    console.say(f"{file}: {verdict_of(report).headline.lower()}")
    for line in findings.lines(report):
        console.say(line)
    console.fields(
        [
            ("worst gouge", f"{report.gouge_max:.4f} mm{_at(document['gouge_at'])}"),
            ("worst excess", f"{report.excess_max:.4f} mm{_at(document['excess_at'])}"),
            ("probed", f"{document['samples']} points, {document['brep_checked']} compared with the exact model"),
            *(("coverage", line) for line in coverage.lines(report.coverage())),
            *(("engagement", line) for line in clearing.lines(report.engagement)),
            *(("flank", line) for line in flanks.lines(report.flanks)),
        ]
    )


def _at(where: dict[str, object] | None) -> str:
    if not where:
        return ""
    return f" (line {where['line']}, {position(where['position'])})"  # type: ignore[arg-type]
