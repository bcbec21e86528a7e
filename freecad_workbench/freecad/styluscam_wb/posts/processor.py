# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's posts for our machines: a job's files as texts, verified where all of it is ours."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from Path.Post.Processor import PostProcessor

from .. import documents, engine, machines, mistakes, settings
from ..long_work import long_work
from ..verification import Draft, PostError, draft_of, figures, refuse_unfinished

if TYPE_CHECKING:
    from styluscam import Machine, Program, Report

NOT_OURS = "operations that are not StylusCAM's are in it"
"""Why a program was not verified."""

SWITCHED_OFF = "--no-verify is among the job's arguments"
"""Why a program was not verified."""

OFF_IN_PREFERENCES = "verification is switched off in StylusCAM's preferences"
"""Why a program was not verified."""


@dataclass(frozen=True)
class Section:
    """One file of a job."""

    name: str
    """FreeCAD's: "allitems", or the fixture, tool or operation that the output is split by."""
    text: str
    program: Program
    machine: Machine
    """With the options that the job's arguments choose."""
    report: Report | None
    """What verification found; None where there was none."""
    unverified: str
    """Why there was none; empty where there was."""


_refused: list[Exception] | None = None
"""Where errors of posts are kept instead of being thrown at FreeCAD, which prints their traces and shows nothing."""


@contextmanager
def kept_refusals() -> Iterator[list[Exception]]:
    """Keeps the errors of what is posted meanwhile, for who can show them; FreeCAD writes nothing."""
    global _refused  # noqa: PLW0603  (FreeCAD makes the posts: nothing can be handed to them)
    _refused = []
    try:
        yield _refused
    finally:
        _refused = None


class VerificationError(PostError):
    """Verification found an error in a text: nothing must be written."""

    def __init__(self, section: Section, finding: Any, sections: list[Section]) -> None:
        super().__init__(f"the posted text fails verification: {finding['message']}")
        self.section = section
        self.sections = sections


def post_for(machine: str) -> type[PostProcessor]:
    """The class that FreeCAD makes for each job that it posts for this machine."""

    class MachinePost(PostProcessor):
        """Posts for one machine."""

        def __init__(self, job: Any) -> None:
            super().__init__(job, tooltip="", tooltipargs="", units="Metric")

        @property
        def tooltip(self) -> str:
            return f"StylusCAM's post for the machine {machine}: verifies what it posts where all of it is StylusCAM's."

        @property
        def tooltipArgs(self) -> str:
            return "Arguments: " + ", ".join(machines.known_arguments())

        def export(self) -> list[tuple[str, str]]:
            """Sections of text, as FreeCAD writes them to files.

            Raises:
                PostError, MotionError, ToolError, DocumentError: nothing must be written.
            """
            try:
                return self._exported()
            except Exception as error:
                if _refused is None:
                    raise
                _refused.append(error)
                return []  # FreeCAD writes nothing then

        def _exported(self) -> list[tuple[str, str]]:
            try:
                return [(section.name, section.text) for section in self.sections()]
            except engine.styluscam().StylusError as error:
                raise PostError(mistakes.reason(error)) from error

        def sections(self) -> list[Section]:
            """As `export`, with what verification found in each.

            Raises:
                As `export`.
            """
            refuse_unfinished(self._job)
            return verified([section_of(self._job, name, items, machine) for name, items in self._buildPostList()])

    return MachinePost


def verified(sections: list[Section]) -> list[Section]:
    """The sections, none of which has an error.

    Raises:
        VerificationError: one has.
    """
    for section in sections:
        if section.report is not None and not section.report.ok:
            finding = next(one for one in section.report.findings if one["severity"] == "error")
            raise VerificationError(section, finding, sections)
    return sections


def section_of(job: Any, name: str, items: list[Any], machine: str) -> Section:
    """One file: what FreeCAD puts into it, in order."""
    draft = draft_of(job, items, machine)
    unverified = _why_not(draft)
    if unverified:
        return Section(name, _unverified_text(draft, unverified), draft.program, draft.target, None, unverified)
    return _verified(name, draft)


def _why_not(draft: Draft) -> str:
    """Why a program is not verified; empty where it is."""
    if not draft.is_ours:
        return NOT_OURS
    stated = machines.verifies(documents.post_arguments(draft.job))
    if stated is None:
        return "" if settings.verifies() else OFF_IN_PREFERENCES
    return "" if stated else SWITCHED_OFF


def _unverified_text(draft: Draft, why: str) -> str:
    """The text of a program that is not verified, which it states.

    Raises:
        PostError: verification is switched off, and so is the comment that would state it.
    """
    if why == NOT_OURS:
        return draft.text(["not judged: operations that are not StylusCAM's are in it"])
    text = draft.text([*draft.notes, f"not verified: {why}"])
    if "notverified" not in "".join(letter for letter in text.lower() if letter.isalpha()):
        raise PostError(
            f"{why}: the program must state in a comment that it was not verified, and its header is switched off: "
            "remove --no-header and --no-comments, or have it verified"
        )
    return text


def _verified(name: str, draft: Draft) -> Section:
    """A program that is all ours, after the engine's verifier has read its text against the model.

    The figures go into the header, so it is posted again with them; nothing but comments differs then.
    """
    text = draft.text_to_verify()
    with long_work(f"{draft.job.Label}: verification") as run:
        report = draft.report(text, run)
    final = draft.text([*draft.notes, figures(f"{report.gouge_max:.4f}", f"{report.excess_max:.4f}")])
    if _code(final) != _code(text):
        raise PostError("the header changed the program: please report this")
    return Section(name, final, draft.program, draft.target, report, "")


def _code(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.startswith(("(", ";"))]
