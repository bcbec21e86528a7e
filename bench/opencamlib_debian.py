"""OpenCAMLib for the Pythons of the FreeCADs in the roots: Debian's packages, unpacked beside the roots.

PyPI has no wheels for these Pythons.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import freecad_host  # finds the roots

from rootfs import building, paths

PACKAGE = "python3-opencamlib"

NEEDED = re.compile(r"libboost-python[\d.]+")
"""What the package depends on and FreeCAD does not."""


SITE = "usr/lib/python3/dist-packages"
"""Where the module is in the folder."""


def unpacked(version: str) -> tuple[Path | None, str]:
    """The folder with the packages for a FreeCAD, or why there is none."""
    found = freecad_host.roots.freecadcmd(version)
    if found.root is None:
        return None, "FreeCAD is the host's: install OpenCAMLib for it"
    folder = paths.cache_dir() / "opencamlib" / found.root
    if not folder.is_dir():
        partial = folder.with_name(f"{found.root}.partial")
        shutil.rmtree(partial, ignore_errors=True)
        try:
            fetch(paths.ROOTS[found.root].suite, partial)
        except (paths.RootsError, subprocess.CalledProcessError) as error:
            return None, f"OpenCAMLib could not be fetched: {error}"
        partial.rename(folder)
    return folder, ""


def fetch(suite: str, folder: Path) -> None:
    """Downloads and unpacks the package of a Debian suite, and what it needs."""
    tools = building.builder()
    state = folder / "apt"
    state.mkdir(parents=True)
    sources = state / "sources.list"
    sources.write_text(f"deb [signed-by={tools.keyring}] {tools.mirror} {suite} main\n")
    apt = ["-o", f"Dir::Etc::SourceList={sources}", "-o", "Dir::Etc::SourceParts=/dev/null"]
    building.apt([*apt, "update"], state)
    download(apt, PACKAGE, folder)
    (package,) = folder.glob("*.deb")
    depends = subprocess.run(
        ["dpkg-deb", "-f", str(package), "Depends"], check=True, capture_output=True, text=True
    ).stdout
    for needed in sorted(set(NEEDED.findall(depends))):
        download(apt, needed, folder)
    for package in folder.glob("*.deb"):
        subprocess.run(["dpkg-deb", "-x", str(package), str(folder)], check=True)
        package.unlink()
    shutil.rmtree(state)


def download(apt: list[str], package: str, folder: Path) -> None:
    building.apt([*apt, "download", package], folder / "apt", cwd=folder)
