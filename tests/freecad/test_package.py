"""The zip of the addon: what it holds, what its package.xml states, and its installation as a user does it."""

from __future__ import annotations

import importlib.metadata
import json
import os
import re
import subprocess
import sys
import zipfile
from datetime import date
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import tomllib
from freecad_host import ADDON, CHECKOUT, INSIDE, FreeCad

import addon_zip
import roots


def package() -> ElementTree.Element:
    return ElementTree.parse(ADDON / "package.xml").getroot()


def texts(name: str, **attributes: str) -> list[str]:
    found = package().findall(f"{{*}}{name}")
    return [node.text or "" for node in found if attributes.items() <= node.attrib.items()]


def copied(folder: Path, names: list[str]) -> Path:
    """The addon's files elsewhere, written in another order and at another time."""
    for name in reversed(names):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes((ADDON / name).read_bytes())
        os.utime(path, (1e9, 1e9))
    return folder


def test_the_same_files_are_the_same_bytes(tmp_path: Path) -> None:
    other = copied(tmp_path / "other", addon_zip.files())
    (other / "freecad" / "styluscam_wb" / "__pycache__").mkdir()
    (other / "freecad" / "styluscam_wb" / "__pycache__" / "init.cpython-313.pyc").write_bytes(b"x")
    (other / "notes.txt").write_text("not of the addon")
    one, two = addon_zip.build(tmp_path / "one"), addon_zip.build(tmp_path / "two", other)
    assert one.name == two.name == f"StylusCAM-{addon_zip.version()}.zip"
    assert one.read_bytes() == two.read_bytes()


def test_it_holds_what_git_knows_and_nothing_else(tmp_path: Path) -> None:
    with zipfile.ZipFile(addon_zip.build(tmp_path)) as archive:
        names = archive.namelist()
    assert {name.partition("/")[0] for name in names} == {"package.xml", "README.md", "LICENSE", "freecad"}
    assert "freecad/styluscam_wb/init_gui.py" in names and "freecad/__init__.py" not in names
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", "freecad_workbench"]
    listed = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("no checkout: git lists no files")
    known = {line.removeprefix("freecad_workbench/") for line in listed.stdout.splitlines()}
    assert set(names) == {name for name in known if not name.startswith("scripts/")}


def test_a_file_of_an_unknown_ending_is_refused_by_name(tmp_path: Path) -> None:
    other = copied(tmp_path, addon_zip.files())
    (other / "freecad" / "styluscam_wb" / "part.py.orig").write_text("")
    with pytest.raises(addon_zip.AddonError, match=r"freecad/styluscam_wb/part.py.orig: only"):
        addon_zip.build(tmp_path / "out", other)
    (other / "freecad" / "styluscam_wb" / "part.py.orig").unlink()
    (other / "LICENSE").unlink()
    with pytest.raises(addon_zip.AddonError, match="has no LICENSE"):
        addon_zip.build(tmp_path / "out", other)


def test_the_command_prints_the_path(tmp_path: Path) -> None:
    command = [sys.executable, str(ADDON / "scripts" / "addon_zip.py")]
    done = subprocess.run([*command, str(tmp_path)], capture_output=True, text=True, check=True)
    assert Path(done.stdout.strip()).is_file()
    assert subprocess.run(command, capture_output=True, check=False).returncode == 2


def test_one_version_everywhere() -> None:
    stated = addon_zip.version()
    assert stated == importlib.metadata.version("styluscam")
    assert stated == tomllib.loads((CHECKOUT / "Cargo.toml").read_text())["workspace"]["package"]["version"]


def test_package_xml_states_what_the_addon_manager_asks_for() -> None:
    root = package()
    assert root.tag == "{https://wiki.freecad.org/Package_Metadata}package" and root.attrib == {"format": "1"}
    for name in ("name", "description", "version", "maintainer", "license", "icon", "freecadmin", "pythonmin"):
        assert len(texts(name)) == 1 and texts(name)[0].strip(), name
    assert date.fromisoformat(texts("date")[0])
    assert re.fullmatch(r"\S+@\S+", package().find("{*}maintainer").attrib["email"])
    assert package().find("{*}url[@type='repository']").attrib["branch"]
    for kind in ("repository", "readme", "bugtracker", "documentation"):
        assert len(texts("url", type=kind)) == 1 and texts("url", type=kind)[0].startswith("https://"), kind
    assert texts("depend", type="internal") == ["cam"]
    assert len(texts("tag")) > 3
    required = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]["requires-python"]
    assert required == f">={texts('pythonmin')[0]}"


def test_what_package_xml_names_is_there() -> None:
    names = addon_zip.files()
    assert texts("icon")[0] in names
    assert package().find("{*}license").attrib["file"] in names
    classname = package().findtext("{*}content/{*}workbench/{*}classname")
    assert f"class {classname}(" in (ADDON / "freecad/styluscam_wb/gui/workbench.py").read_text()
    for kind in ("readme", "documentation"):
        _, _, path = texts("url", type=kind)[0].partition("/blob/main/")
        assert (CHECKOUT / path).is_file(), path


def results_of(freecad: FreeCad, script: str, *args: str, binds: list[roots.Bind]) -> dict[str, Any]:
    """What a script reports in a FreeCAD of which only the binds are a user's."""
    done = roots.run_freecad(freecad.version, INSIDE / script, *args, binds=binds, timeout=120)
    lines = [line.removeprefix("RESULT ") for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    results = dict(json.loads(line) for line in lines)
    assert results and "broke" not in results, f"{results}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    assert "Traceback" not in done.stdout + done.stderr
    return results


@pytest.fixture(scope="module")
def user(freecad: FreeCad) -> list[roots.Bind]:
    """A user's folder, kept from one start to the next."""
    if roots.freecadcmd(freecad.version).root is None:
        pytest.skip(f"NOT TESTED: the FreeCAD {freecad.version} of this host has a user's folder that is not ours")
    folder = freecad.folder / "user"
    folder.mkdir()
    return [roots.Bind(folder, roots.user_data(freecad.version), writable=True)]


@pytest.mark.world
@pytest.mark.freecad
def test_the_addon_manager_installs_it(freecad: FreeCad, user: list[roots.Bind], tmp_path: Path) -> None:
    path = addon_zip.build(tmp_path)
    found = results_of(freecad, "addon_manager.py", "--", str(path), binds=[*user, roots.Bind.same(tmp_path)])
    assert found["installed"] == {"done": True, "files": addon_zip.files()}
    read = found["read"]
    assert read.pop("errors") in ([], None)
    assert read == {
        "printed": "",
        "requires": ["cam"],
        "workbench": True,
        "classname": "StylusCamWorkbench",
        "subdirectory": "./",
        "licence": [["LGPL-2.1-or-later", "LICENSE"]],
        "supported": True,
    }
    bare = results_of(freecad, "installed_addon.py", binds=user)["installed"]
    assert bare["folder"] and bare["engine"] is None and bare["volume"] == pytest.approx(1000.0)
    sentence = (
        r"EngineMissingError: the StylusCAM engine cannot be loaded \(No module named 'styluscam'\); install it with: "
    )
    command = rf'python3\.\d+ -m pip install --target "{re.escape(bare["packages"])}" styluscam'
    assert re.fullmatch(sentence + command, bare["made"])
    with_engine = results_of(
        freecad, "installed_addon.py", binds=[*user, roots.Bind(freecad.engine, bare["packages"])]
    )["installed"]
    assert with_engine["engine"] is True
    assert with_engine["made"].startswith("made {") and "clothoid" in with_engine["made"]
