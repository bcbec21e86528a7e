"""Takes the pictures of the tutorial: its steps in FreeCAD's window, by mouse and keyboard.

make shot
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
CHECKOUT = HERE.parent
sys.path[:0] = [str(CHECKOUT / "tests" / "oracles")]

import roots  # noqa: E402
import styluscam as sc  # noqa: E402

VERSION = "1.1"
IMAGES = HERE / "images" / "freecad"


def main() -> int:
    """Runs the steps and keeps their pictures; 1 where a step fails."""
    with tempfile.TemporaryDirectory() as name:
        folder, engine = Path(name) / "pictures", Path(name) / "engine"
        folder.mkdir()
        shutil.copytree(Path(sc.__file__).parent, engine / "styluscam", ignore=shutil.ignore_patterns("__pycache__"))
        script = CHECKOUT / "tests" / "window" / "inside" / "tutorial.py"
        addon = CHECKOUT / "freecad_workbench"
        done = roots.run_window(VERSION, script, folder=folder, python_path=[engine], mod_path=[addon], timeout=300.0)
        results = folder / "results.jsonl"
        ((_, result),) = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]
        if "broke" in result:
            print(result["broke"], done.stderr[-2000:], file=sys.stderr)
            return 1
        IMAGES.mkdir(parents=True, exist_ok=True)
        for picture in sorted(folder.glob("tutorial-*.png")):
            shutil.copyfile(picture, IMAGES / picture.name)
            print(IMAGES / picture.name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
