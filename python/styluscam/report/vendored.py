"""three.js as it stands in the package: `make vendor` bundles it."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).parent / "vendor"
(THREE,) = FOLDER.glob("three.*.min.js")
THREE_VERSION = re.sub(r"^three\.|\.min\.js$", "", THREE.name)


def three() -> str:
    """The script, with its licence before it."""
    licence = (FOLDER / "three.LICENSE").read_text(encoding="utf-8")
    return f"/*\n{licence}*/\n{THREE.read_text(encoding='utf-8')}"
