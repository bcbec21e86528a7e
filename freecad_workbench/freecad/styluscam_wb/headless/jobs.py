# SPDX-License-Identifier: LGPL-2.1-or-later
"""The CAM jobs of a document: which are run, by which post, and whether what they hold may be posted."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

from .. import engine, machines, ops, properties, verification
from .failures import RunError
from .objects import find, listed, near

NO_TOOL_MOTION = ("G0", "G00")
"""What FreeCAD writes around an operation that found nothing to cut."""

FREE_TEXT = "Gcode"
"""The property of an operation whose lines are the user's own: it need not move the tool."""


def choose(document: Any, names: list[str]) -> list[Any]:
    """The jobs with these labels or names, in this order; all of the document's where none is named.

    Raises:
        RunError: no such job, or the document has none.
    """
    from Path.Main.Job import ObjectJob

    jobs = [obj for obj in document.Objects if isinstance(getattr(obj, "Proxy", None), ObjectJob)]
    if not jobs:
        raise RunError("the document has no CAM job: make one in FreeCAD's CAM workbench")
    if not names:
        return jobs
    chosen = []
    for name in names:
        found = find(document, name) if any(name in (job.Label, job.Name) for job in jobs) else None
        if found not in jobs:
            raise RunError(f"--job {name!r}: {near(name, [job.Label for job in jobs])}")
        chosen.append(found)
    return list(dict.fromkeys(chosen))


def require_known(document: Any) -> None:
    """Refuses a document with tools, operations or jobs whose makers are not here: FreeCAD would keep their old paths.

    Raises:
        RunError: it has some.
    """
    orphans = [obj for obj in document.Objects if obj.isDerivedFrom("Path::Feature") and _is_orphan(obj)]
    if orphans:
        names = listed([obj.Label for obj in orphans])
        raise RunError(
            f"{names}: made by an addon, or a later version of one, that this FreeCAD does not have: install it"
        )


def _is_orphan(obj: Any) -> bool:
    return "Proxy" in obj.PropertiesList and (obj.Proxy is None or isinstance(obj.Proxy, str | dict))


# --- posts --------------------------------------------------------------------------------------------------------


def choose_post(job: Any, machine: str, file: str) -> list[str]:
    """Gives a job the post for a machine, where one is named, else asks for its own; sentences about what that changes.

    Raises:
        RunError: no such machine, or the job has no post.
    """
    from Path import Preferences

    own = str(job.PostProcessor or "") or Preferences.defaultPostProcessor()
    available = Preferences.allAvailablePostProcessors()
    if not machine:
        _require_own(job, own, file, available)
        _set_post(job, own)
        return []
    post = _post_named(machine, available)
    notes = []
    if post != own and not (post.startswith(machines.POST_PREFIX) and own.startswith(machines.POST_PREFIX)):
        if job.PostProcessorArgs:
            notes.append(
                f"{job.Label}: the arguments {job.PostProcessorArgs!r} are for {own or 'no post'}: not used for {post}"
            )
        job.PostProcessorArgs = ""
    _set_post(job, post)
    return notes


def _require_own(job: Any, own: str, file: str, available: list[str]) -> None:
    saved = saved_post(file, job.Name)
    if saved and saved not in available:
        hint = "give --post, or put its machine file or post where FreeCAD finds it"
        raise RunError(f"{job.Label}: its post {saved} is not here: {hint}")
    if not own:
        raise RunError(f"{job.Label} has no post: choose one in the job, or give --post MACHINE")
    if own not in available:
        raise RunError(f"{job.Label}: its post {own} is not here: {near(own, available)}")


def _post_named(machine: str, available: list[str]) -> str:
    """A machine's post, or one of FreeCAD's own."""
    post = machines.POST_PREFIX + machine.removeprefix(machines.POST_PREFIX)
    for name in (post, machine):
        if name in available:
            return name
    if machine.endswith(".toml"):
        raise RunError(f"--post {machine}: put the machine file into {machines.user_folder()} and give its name")
    known = [name.removeprefix(machines.POST_PREFIX) for name in available if name.startswith(machines.POST_PREFIX)]
    raise RunError(f"--post {machine!r} is no machine: {near(machine, [*known, *available], shown=len(known))}")


def _set_post(job: Any, post: str) -> None:
    """Sets it also where FreeCAD's preferences leave it out of the jobs' lists."""
    if job.PostProcessor == post:
        return
    if post not in job.getEnumerationsOfProperty("PostProcessor"):
        job.PostProcessor = [*job.getEnumerationsOfProperty("PostProcessor"), post]
    job.PostProcessor = post


def saved_post(file: str, name: str) -> str:
    """The post that a job was saved with: FreeCAD chooses another one where it does not find that. "" where unknown."""
    with zipfile.ZipFile(file) as archive, archive.open("Document.xml") as stream:
        for _, element in ElementTree.iterparse(stream):
            if element.tag == "Object" and element.get("name") == name:
                for found in element.findall("Properties/Property[@name='PostProcessor']"):
                    choices = [each.get("value", "") for each in found.findall("CustomEnumList/Enum")]
                    at = int(found.find("Integer").get("value", "-1"))
                    return choices[at] if 0 <= at < len(choices) else ""
    return ""


# --- operations ---------------------------------------------------------------------------------------------------


def touch(job: Any) -> None:
    """Has every active operation computed again, ours and others."""
    for obj in verification.active_operations(job):
        for each in chain(obj):
            each.touch()


def chain(obj: Any) -> Iterator[Any]:
    """An operation, and what its dressups stand on."""
    seen = []
    while obj is not None and obj not in seen and hasattr(obj, "Path"):
        seen.append(obj)
        yield obj
        base = getattr(obj, "Base", None)
        obj = base if hasattr(base, "Path") else None


def error_of(obj: Any) -> BaseException | None:
    """Why an operation must not be posted; None where it may be."""
    for each in chain(obj):
        if "Invalid" in each.State:
            known = getattr(getattr(each, "Proxy", None), "error", None)
            which = "it" if each is obj else each.Label
            return known or RunError(f"{which} has failed: {_status(each)}")
        for needed in _needs(each):
            if "Invalid" in needed.State:
                return RunError(f"{needed.Label} has failed: {_status(needed)}")
        if "Touched" in each.State:
            return RunError("FreeCAD did not compute it: look at what it depends on")
    if not _does_something(obj):
        return RunError(
            "it has no path, FreeCAD found nothing to cut: correct it, or switch it off (Active) in the job"
        )
    return None


def job_error(job: Any) -> BaseException | None:
    """Why nothing of a job can be posted; None where that depends on its operations."""
    if not job.Operations.Group:
        return RunError(f"{job.Label} has no operation: there is nothing to post")
    if not verification.active_operations(job):
        return RunError(f"{job.Label} has no active operation: there is nothing to post")
    for obj in (*(job.Model.Group if job.Model else ()), job.Stock):
        for each in () if obj is None else (*reversed(obj.OutListRecursive), obj):
            if "Invalid" in each.State and each != job:
                return RunError(f"{each.Label} has failed: {_status(each)}")
    return None


def _needs(obj: Any) -> Iterator[Any]:
    controller = getattr(obj, "ToolController", None)
    for needed in (controller, getattr(controller, "Tool", None)):
        if needed is not None:
            yield needed


def _status(obj: Any) -> str:
    return " ".join(str(obj.getStatusString()).split())


def _does_something(obj: Any) -> bool:
    names = [command.Name for command in obj.Path.Commands]
    if ops.is_ours(obj):
        return ops.has_motion(obj)
    if hasattr(obj, FREE_TEXT) or getattr(obj, "ToolController", None) is None:
        return True  # comments, stops, lines of the user's own
    return any(name and not name.startswith("(") and name not in NO_TOOL_MOTION for name in names)


def record(obj: Any) -> dict[str, Any]:
    """An operation in the report: lengths mm, times s as FreeCAD estimates them."""
    is_ours, is_active = ops.is_ours(obj), verification.is_active(obj)
    error = error_of(obj) if is_active else None
    return {
        "label": obj.Label,
        "name": obj.Name,
        "kind": f"{obj.Process} {obj.Strategy}" if is_ours else type(getattr(obj, "Proxy", obj)).__name__,
        "styluscam": is_ours,
        "active": is_active,
        "state": list(obj.State),
        "commands": len(obj.Path.Commands),
        "length_mm": float(obj.Path.Length),
        "duration_s": _duration(obj),
        "notes": list(obj.Notes) if is_ours else [],
        "error": None if error is None else ops.reason(error),
    }


def _duration(obj: Any) -> float | None:
    """As FreeCAD estimates it; None where a feed is not known."""
    controller = next((each.ToolController for each in chain(obj) if getattr(each, "ToolController", None)), None)
    if controller is None:
        return None
    speeds = [getattr(controller, name).Value for name in ("HorizFeed", "VertFeed", "HorizRapid", "VertRapid")]
    seconds = float(obj.Path.getCycleTime(*speeds)) if min(speeds[:2]) > 0.0 else math.nan
    return seconds if math.isfinite(seconds) else None


def unknown_properties(job: Any) -> list[str]:
    """Sentences about properties of our operations that this engine does not know: a later version made them."""
    known = {field.name for field in properties.fields()} | {"WholeModel", "Notes"}
    sentences = []
    for obj in filter(ops.is_ours, verification.active_operations(job)):
        own = [name for name in obj.PropertiesList if obj.getGroupOfProperty(name) == properties.GROUP]
        foreign = [name for name in own if name not in known]
        if foreign:
            version = engine.styluscam().__version__
            sentences.append(f"{obj.Label}: styluscam {version} does not know, and does not use, {', '.join(foreign)}")
    return sentences
