"""Inside FreeCAD: what a user prefers, and what it changes."""

from __future__ import annotations

import json
import os
import sys
import traceback
from pathlib import Path
from typing import Any

(FOLDER,) = sys.argv[sys.argv.index("--") + 1 :]

GROUP = "User parameter:BaseApp/Preferences/Mod/StylusCAM"


def report(name: str, result: dict[str, Any]) -> None:
    print("\nRESULT " + json.dumps([name, result]), flush=True)


def outcome(action: Any) -> str:
    try:
        return str(action())
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def folders() -> dict[str, Any]:
    import FreeCAD

    from freecad.styluscam_wb import machines, settings

    file = Path(FOLDER) / "a file"
    file.write_text("")
    refused = {text: outcome(lambda text=text: settings.choose_machine_folder(text)) for text in ("mine", str(file))}
    default = str(machines.user_folder())
    settings.choose_machine_folder(f" {FOLDER} ")
    chosen = str(machines.user_folder())
    FreeCAD.ParamGet(GROUP).SetString("MachineFolder", str(file))
    gone = settings.machine_folder_problem(settings.chosen_machine_folder())
    machines.write_user_posts()  # a folder that is gone is a warning, and no end of the start
    settings.choose_machine_folder("")
    return {
        "refused": refused,
        "default": Path(default).is_relative_to(FreeCAD.getUserAppDataDir()),
        "chosen": chosen,
        "gone": gone,
        "again": str(machines.user_folder()) == default,
        "file": str(file),
    }


def posted() -> dict[str, Any]:
    """The same job with and without verification, and a new job with a machine that is chosen."""
    import FreeCAD
    import Path.Main.Job as PathJob
    from Path.Post.Processor import PostProcessorFactory

    from freecad.styluscam_wb import examples, post_list, settings

    job = next(one for one in examples.EXAMPLES if one.name == "MilledDome").make()
    job.PostProcessor = "styluscam_linuxcnc"
    job.Operations.Group[0].Stepover = 10.0
    job.Document.recompute()

    def text() -> str:
        return "\n".join(part for _, part in PostProcessorFactory.get_post_processor(job, job.PostProcessor).export())

    settings.set_verifies(False)
    without = outcome(text)
    job.PostProcessorArgs = "--verify"
    by_the_job = outcome(text)
    job.PostProcessorArgs = ""
    settings.set_verifies(True)
    verified = outcome(text)
    box = FreeCAD.newDocument("New").addObject("Part::Box", "Box")
    with post_list.beginning_with("grbl"):
        ours = PathJob.Create("Job", [box]).PostProcessor
    theirs = PathJob.Create("Job", [box]).PostProcessor
    return {"without": without, "by the job": by_the_job, "verified": verified, "new": [ours, theirs]}


try:
    report("folders", folders())
    report("posted", posted())
except BaseException:
    report("broke", {"broke": traceback.format_exc()})
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
