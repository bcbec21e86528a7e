"""Draws the picture of a report in the guide: the page of the first job, as a browser shows it.

make report-picture
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
CHECKOUT = HERE.parent
sys.path[:0] = [str(CHECKOUT / "tests"), str(CHECKOUT / "tests" / "oracles")]

from gui.browser import browser  # noqa: E402

import styluscam as sc  # noqa: E402
from styluscam.report import Subject, report_page  # noqa: E402


def main() -> None:
    """Plans the job, judges it, and takes the page's picture."""
    job = sc.Job.read(CHECKOUT / "examples" / "first-light" / "job.toml")
    report = sc.verify(sc.post(sc.plan(job)).text, job)
    with tempfile.TemporaryDirectory() as name:
        page = Path(name) / "report.html"
        page.write_text(report_page(Subject.judged(report, job.machine(), "cone_cup.ngc")), encoding="utf-8")
        with browser(Path(name)) as tab:
            tab.size(1200, 760)
            tab.open(page)
            tab.run("window.styluscam.player.seek(0.72 * window.styluscam.player.path.duration)")
            tab.choose("#map", "left")
            tab.until("document.getElementById('legends').textContent.includes('left over')")
            tab.drawn()
            (HERE / "images" / "report.png").write_bytes(tab.picture())


if __name__ == "__main__":
    main()
