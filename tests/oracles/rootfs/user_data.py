"""The folder of a user's own data that FreeCAD reads in a root file system: addons and Python packages in it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rootfs.entering import INSIDE, Bind

USER_DATA = {"1.0": ".local/share/FreeCAD", "1.1": ".local/share/FreeCAD/v1-1"}
"""Below the user's home, by FreeCAD's version: from 1.1 on each version has its own."""


def user_data(version: str) -> str:
    """The folder inside the root; a bind to it, or to a folder in it, makes it what a user would find there."""
    return f"{INSIDE['HOME']}/{USER_DATA[version]}"


def installed(version: str, addons: Sequence[Path]) -> list[Bind]:
    """Binds that show addons (folders with package.xml), read-only, where FreeCAD's Addon Manager puts them."""
    return [Bind(addon.resolve(), f"{user_data(version)}/Mod/{addon.name}") for addon in addons]
