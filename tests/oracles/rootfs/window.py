"""FreeCAD with a window, on a display of its own inside a root file system: never on a person's own screen."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from rootfs.entering import Bind, ready, run
from rootfs.paths import CHECKOUT, ROOTS, Unavailable, roots_dir

SCREEN = "1600x1000"
"""Size of the display, pixels."""

START_SCRIPT = Path(__file__).with_name("window.sh")

FOLDER_ENV, ARGUMENTS_ENV = "STYLUSCAM_TEST_FOLDER", "STYLUSCAM_TEST_ARGUMENTS"

Preferences = Mapping[str, Mapping[str, str | bool | int]]
"""Values by the path of their group below `BaseApp/Preferences`."""

THEMES = {"light": "FreeCAD Light", "dark": "FreeCAD Dark"}
"""FreeCAD's own packs of preferences, which set style, style sheet and colours."""

EMPTY = "<FCParameters/>"
"""A file of parameters without any."""

PREFERENCES: Preferences = {
    "Mod/Start": {"ShowOnStartup": False, "FirstStart2024": False},
    "General": {"AutoloadModule": "CAMWorkbench"},
    "Document": {"AutoSaveEnabled": False},
    "Units": {"UserSchema": 6},
}
"""What every window starts with: no page of welcome, CAM in front, feeds per minute (CAM warns of others)."""


def freecad_root(version: str) -> str:
    """The root with FreeCAD `1.0` or `1.1`."""
    for name, root in ROOTS.items():
        if root.freecad == version:
            return name
    raise Unavailable(f"No root file system has FreeCAD {version}.")


def ready_window(version: str) -> None:
    """Makes sure that there can be a window of FreeCAD `1.0` or `1.1`; Unavailable, with the reason, where not."""
    ready(freecad_root(version))


def run_window(
    version: str,
    script: Path,
    *args: str,
    folder: Path,
    python_path: Sequence[Path] = (),
    mod_path: Sequence[Path] = (),
    binds: Sequence[Bind] = (),
    preferences: Preferences = PREFERENCES,
    theme: str = "",
    timeout: float | None = None,
) -> subprocess.CompletedProcess[str]:
    """Runs a script in a FreeCAD with a window; its output is captured.

    The checkout and `mod_path` are seen inside, read-only, under the paths that they have outside; `folder` can be
    written to. User data are new each time, apart from `binds`; `theme` is one of `THEMES`. The script finds the folder and the
    arguments, separated by newlines, in its environment (`FOLDER_ENV`, `ARGUMENTS_ENV`): FreeCAD would open those of its command
    line. It has to end FreeCAD itself.
    """
    configuration = folder / "user.cfg"
    configuration.write_text(configuration_of(preferences, _pack(version, theme)), encoding="utf-8")
    seen = [CHECKOUT, *(p.resolve() for p in (script.parent, *python_path, *mod_path))]
    outside = [path for path in dict.fromkeys(seen) if path == CHECKOUT or not path.is_relative_to(CHECKOUT)]
    program = ["freecad", "--user-cfg", str(configuration)]
    for option, paths in (("-P", python_path), ("-M", mod_path)):
        for path in paths:
            program += [option, str(path.resolve())]
    return run(
        freecad_root(version),
        ["sh", str(START_SCRIPT), SCREEN, *program, str(script.resolve())],
        binds=[*(Bind.same(path) for path in outside), Bind.same(folder, writable=True), *binds],
        env={FOLDER_ENV: str(folder.resolve()), ARGUMENTS_ENV: "\n".join(args)},
        timeout=timeout,
    )


def _pack(version: str, theme: str) -> str:
    """FreeCAD's pack of preferences for a theme; no parameters where none is named."""
    if not theme:
        return EMPTY
    packs = roots_dir() / freecad_root(version) / "usr/share/freecad/Gui/PreferencePacks"
    return (packs / THEMES[theme] / f"{THEMES[theme]}.cfg").read_text(encoding="utf-8")


def configuration_of(preferences: Preferences, base: str = EMPTY) -> str:
    """FreeCAD's file of parameters `base` with these values as well."""
    root = ElementTree.fromstring(base)
    for path, values in preferences.items():
        group = root
        for name in ("Root", "BaseApp", "Preferences", *path.split("/")):
            group = _part(group, "FCParamGroup", name)
        for name, value in values.items():
            if isinstance(value, str):
                _part(group, "FCText", name).text = value
            else:
                kind = "FCBool" if isinstance(value, bool) else "FCInt"
                _part(group, kind, name).set("Value", str(int(value)))
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _part(group: ElementTree.Element, kind: str, name: str) -> ElementTree.Element:
    """The group or value of a name, which is added where it is not there."""
    found = group.find(f"{kind}[@Name='{name}']")
    return found if found is not None else ElementTree.SubElement(group, kind, Name=name)
