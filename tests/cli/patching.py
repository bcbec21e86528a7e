"""A page's changes to the code, applied to a copy of the workspace that cargo then checks."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from .conftest import CHECKOUT

COPIES = CHECKOUT / "target" / "howto"
"""Where copies are, one for each page: what did not change since the last run need not be checked again."""
TARGET = CHECKOUT / "target"
"""Where cargo builds all copies: what the engine depends on is compiled there for its own tests."""
SOON = ("--profile", "quick", "--config", "profile.quick.opt-level=0")
"""For what is to be built soon and not to run fast; what it depends on has a level of its own, and is built already."""


def patched(text: str, diff: str) -> str:
    """A text with the added lines of a diff beside its context, which the text must hold once."""
    lines = diff.splitlines(keepends=True)
    before, after = ("".join(line[1:] for line in lines if line[0] in marks) for marks in (" -", " +"))
    assert before.strip(), f"nothing states where this goes:\n{diff}"
    assert text.count(before) == 1, f"not there, or not once:\n{before}"
    return text.replace(before, after)


class Change:
    """New files and diffs of a page, by file of the repository."""

    def __init__(self, page: str) -> None:
        self.name = Path(page).stem
        self.files: dict[str, str] = {}

    def add(self, file: str, text: str) -> None:
        """A file that the page makes."""
        assert file.startswith("rust/"), f"no new file of the engine: {file}"
        assert not (CHECKOUT / file).exists() and file not in self.files, f"{file} is there already"
        self.files[file] = text

    def patch(self, file: str, diff: str) -> None:
        """A file that the page changes."""
        text = self.files.get(file) or (CHECKOUT / file).read_text(encoding="utf-8")
        self.files[file] = patched(text, diff)

    def copy(self) -> Path:
        """A copy of the workspace with the change; files keep their times, so that cargo sees what is new.

        Its crates are in a folder of the page's name, not in `rust`: cargo distinguishes what it builds by the paths within
        a workspace, so that in one target folder the crates of one copy would be taken for those of another.
        """
        folder = COPIES / self.name
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(CHECKOUT / "rust", folder / self.name)
        manifest = (CHECKOUT / "Cargo.toml").read_text(encoding="utf-8")
        (folder / "Cargo.toml").write_text(manifest.replace('"rust/', f'"{self.name}/'), encoding="utf-8")
        shutil.copy2(CHECKOUT / "Cargo.lock", folder)
        for file, text in self.files.items():
            (folder / self.name / file.removeprefix("rust/")).write_text(text, encoding="utf-8")
        return folder

    def crate(self) -> str:
        """The crate that it changes."""
        (crate,) = {file.split("/")[1] for file in self.files}
        return crate

    def cargo(self, *words: str, crate: str = "") -> None:
        """Runs cargo in a copy with the change, on a crate: the changed one where none is named."""
        run_cargo(self.copy(), *words, "--package", f"styluscam-{crate or self.crate()}")


def run_cargo(folder: Path, *words: str) -> None:
    """Runs cargo in a copy; neither an error nor a warning may come of it. What is checked alone is so as `make lint` does."""
    soon = () if words[0] == "check" else SOON
    command = ["cargo", *words, *soon, "--quiet", "--offline", "--target-dir", str(TARGET)]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert ran.returncode == 0 and "warning" not in ran.stderr, ran.stderr + ran.stdout
