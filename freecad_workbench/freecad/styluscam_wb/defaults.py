# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a new operation starts with beyond its keys' defaults, so that it can be computed as it is."""

from __future__ import annotations

from typing import Any

from PathScripts import PathUtils

from . import ops, properties, setup_sheet
from .fields import CHOICE, OPERATION, PATHS, PROCESS, TAKES_SHEET, Field, kind_field
from .stylus import PROFILE


def fill(obj: Any, kind: str) -> None:
    """Makes a new operation one of a kind; what a program's operations must agree on is taken from the job's others.

    What the job's setup sheet sets stays.
    """
    job = PathUtils.findParentJob(obj)
    setattr(obj, kind_field(properties.fields(), OPERATION).name, kind)
    stated = setup_sheet.stated(job)
    for name, value in properties.of_kind(kind).items():
        if name not in stated:
            setattr(obj, name, value)
    others = [other for other in job.Operations.Group if ops.is_ours(other) and other != obj]
    known = next((other for other in others if properties.are_complete(other)), None)
    if known is not None:
        for name in properties.shared():
            setattr(obj, name, getattr(known, name))
        return
    if _process_name() not in stated:
        setattr(obj, _process_name(), _process_for(obj.ToolController))
    _choose(obj, stated)


def follow_tool(obj: Any, before: Any) -> None:
    """The process of a new operation follows its tool, where it was chosen by the tool (controller) it had before."""
    chosen = _process_for(obj.ToolController)
    if getattr(obj, _process_name()) == _process_for(before) != chosen:
        setattr(obj, _process_name(), chosen)
        _choose(obj, set())


def _process_name() -> str:
    return kind_field(properties.fields(), PROCESS).name


def _choose(obj: Any, stated: set[str]) -> None:
    for field in properties.fields():
        if _must_be_chosen(obj, field) and field.name not in stated:
            setattr(obj, field.name, next(word for word in field.choices if word))


def _must_be_chosen(obj: Any, field: Field) -> bool:
    """Whether a word is missing that is none of the operation's own, such as the side of the sheet that is modelled."""
    is_open = field.type == CHOICE and properties.is_shown(obj, field) and not getattr(obj, field.name)
    return is_open and field.section not in (OPERATION, PROCESS) and any(field.choices)


def _process_for(controller: Any) -> str:
    """The first process on a sheet for a stylus, the first one without for a tool that turns."""
    is_stylus = controller is not None and hasattr(controller.Tool, PROFILE)
    kinds = properties.schema().table(*PATHS[PROCESS]).kinds
    fitting = [kind.word for kind in kinds if bool(kind.stated.get(TAKES_SHEET)) == is_stylus]
    return fitting[0] if fitting else kinds[0].word
