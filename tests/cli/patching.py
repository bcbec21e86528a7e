"""A page's changes to the code, applied to a copy of the workspace that cargo then checks."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from .conftest import CHECKOUT

COPY = CHECKOUT / "target" / "howto"
"""Where copies are, one for each page: what did not change since the last run need not be checked again."""


def patched(text: str, diff: str) -> str:
    """A text with the added lines of a diff beside its context, which the text must hold once."""
    lines = diff.splitlines(keepends=True)
    before, after = ("".join(line[1:] for line in lines if line[0] in marks) for marks in (" -", " +"))
    assert before.strip(), f"nothing says where this goes:\n{diff}"
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
        """A copy of the workspace with the change; files keep their times, so that cargo sees what is new."""
        folder = COPY / self.name
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(CHECKOUT / "rust", folder / "rust")
        for name in ("Cargo.toml", "Cargo.lock"):
            shutil.copy2(CHECKOUT / name, folder / name)
        for file, text in self.files.items():
            (folder / file).write_text(text, encoding="utf-8")
        return folder

    def crate(self) -> str:
        """The crate that it changes."""
        (crate,) = {file.split("/")[1] for file in self.files}
        return crate

    @property
    def target(self) -> Path:
        """Where cargo builds the copy. Not the checkout's own: cargo names what it builds by the paths within a workspace, so
        that a copy's crates would be taken for the checkout's.
        """
        return COPY / f"{self.name}-target"

    def cargo(self, *words: str) -> None:
        """Runs cargo in a copy with the change, on the changed crate."""
        command = ["cargo", *words, "--quiet", "--offline", "--target-dir", str(self.target)]
        command += ["--package", f"styluscam-{self.crate()}"]
        ran = subprocess.run(command, cwd=self.copy(), capture_output=True, text=True, check=False)
        assert ran.returncode == 0 and "warning" not in ran.stderr, ran.stderr + ran.stdout
