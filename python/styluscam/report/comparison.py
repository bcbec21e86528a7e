"""Programs side by side, as one HTML file."""

from __future__ import annotations

import base64
from collections.abc import Sequence

from styluscam.report import tables
from styluscam.report.findings import grouped, measured, spoken, verdict_of
from styluscam.report.plots import Plot, Series, feed_over_time, height_over_time
from styluscam.report.subject import Subject
from styluscam.report.templates import PAGE, template


def comparison_page(subjects: Sequence[Subject]) -> str:
    """The page's text: figures, pictures, plots over each other, findings. The same subjects give the same text.

    Raises:
        StylusError: jinja2 or matplotlib are missing.
        GeometryError: a part that keeps no triangles to draw, or a program without moves.
    """
    page = template("comparison.html.jinja")
    return str(
        page.render(
            subjects=subjects,
            verdicts=[verdict_of(subject.report) for subject in subjects],
            figures=tables.side_by_side(subjects),
            faces=[tables.faces(subject) for subject in subjects],
            pictures=["data:image/png;base64," + base64.b64encode(one.png()).decode("ascii") for one in subjects],
            plots=_plots(subjects),
            groups=[grouped(subject.report) for subject in subjects],
            spoken=spoken,
            measured=measured,
            versions=tables.versions(subjects[0]),
            style=(PAGE / "style.css").read_text(encoding="utf-8"),
        )
    )


def _plots(subjects: Sequence[Subject]) -> list[Plot]:
    series = []
    for subject in subjects:
        series.append(
            Series(subject.times, subject.positions[:, 2], subject.moves["feed"], subject.moves["kind"], subject.file)
        )
    return [height_over_time(series), feed_over_time(series)]
