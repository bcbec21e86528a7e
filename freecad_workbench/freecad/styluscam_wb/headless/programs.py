# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job's programs: posted, verified where that is ours to do, and named by FreeCAD's own rules."""

from __future__ import annotations

from typing import Any

from .. import compat, machines
from ..posts.processor import Section, VerificationError
from .failures import RunError
from .objects import one_line

POLICIES = {
    "append unique id on conflict": "unique",
    "open file dialog on conflict": "ask",
    "open file dialog": "ask",
}
"""FreeCAD's preference for output files that are there already; anything else replaces them."""


def programs_of(job: Any) -> tuple[list[dict[str, Any]], BaseException | None]:
    """Records of the job's programs with their texts, and the verification that failed; then none may be written.

    Raises:
        RunError and the posts' own errors: there are no texts.
    """
    from Path.Post.Processor import PostProcessorFactory

    post = PostProcessorFactory.get_post_processor(job, job.PostProcessor)
    if post is None:
        raise RunError(f"{job.Label}: FreeCAD cannot load the post {job.PostProcessor}")
    if not job.PostProcessor.startswith(machines.POST_PREFIX):
        return _foreign(job, post), None
    failed = None
    try:
        sections = post.sections()
    except VerificationError as error:
        sections, failed = error.sections, error
    names = file_names(job, [section.name for section in sections])
    return [_record(section, name) for section, name in zip(sections, names, strict=True)], failed


def file_names(job: Any, sections: list[str]) -> list[str]:
    """Where FreeCAD would write these sections: the job's PostProcessorOutputFile with its substitutions."""
    from Path.Post.Utils import FilenameGenerator

    generator = FilenameGenerator(job=job)
    names = generator.generate_filenames()
    found = []
    for section in sections:
        generator.set_subpartname("" if section == "allitems" else section)
        found.append(str(next(names)))
    return found


def policy() -> str:
    """What becomes of a file that is there already: replace, unique, ask."""
    from Path import Preferences

    return POLICIES.get(str(Preferences.defaultOutputPolicy()).casefold(), "replace")


def _record(section: Section, file: str) -> dict[str, Any]:
    report = section.report
    return {
        "section": section.name,
        "file": file,
        "lines": len(section.text.splitlines()),
        "length_mm": section.program.length,
        "duration_s": float(section.program.times(section.machine)[-1]),
        "verified": report is not None,
        "unverified": section.unverified,
        "report": None if report is None else {k: v for k, v in report.to_dict().items() if k != "contacts"},
        "text": section.text,
    }


def _foreign(job: Any, post: Any) -> list[dict[str, Any]]:
    """What a post of FreeCAD's own, or of anybody else, makes of the job.

    Raises:
        RunError: it fails, or makes nothing.
    """
    try:
        sections = post.export()
    except SystemExit as error:  # so argparse ends over an argument
        message = f"{job.Label}: the post {job.PostProcessor} does not take the arguments {job.PostProcessorArgs!r}"
        raise RunError(f"{message}: correct them in the job") from error
    except Exception as error:
        raise RunError(f"{job.Label}: the post {job.PostProcessor} fails: {one_line(error)}") from error
    made = [(name, compat.text_of_section(text)) for name, text in sections or () if text is not None]
    if not made:
        raise RunError(f"{job.Label}: the post {job.PostProcessor} makes no text: look at its arguments")
    why = f"{job.PostProcessor} is not StylusCAM's post: only texts of its own are verified (--post MACHINE)"
    names = file_names(job, [name for name, _ in made])
    return [
        {
            "section": section,
            "file": name,
            "lines": len(text.splitlines()),
            "length_mm": None,
            "duration_s": None,
            "verified": False,
            "unverified": why,
            "report": None,
            "text": text,
        }
        for (section, text), name in zip(made, names, strict=True)
    ]
