"""OpenCAMLib in an environment of its own, and what its workers answer."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
PEER = "opencamlib==2023.1.11"


def peer_python() -> tuple[Path | None, str]:
    """Python with OpenCAMLib in an environment of its own, or why there is none."""
    cache = Path(os.environ.get("STYLUSCAM_CACHE") or Path.home() / ".cache" / "styluscam")
    python = cache / "bench-venv" / "bin" / "python"
    if not python.exists():
        base = shutil.which("python3.11")
        if base is None:
            return None, "OpenCAMLib has wheels for Python 3.11 and older only, and there is no python3.11 on the PATH"
        try:
            subprocess.run([base, "-m", "venv", str(cache / "bench-venv")], check=True)
            subprocess.run([str(python), "-m", "pip", "install", "--quiet", PEER, "numpy"], check=True)
        except subprocess.CalledProcessError as error:
            shutil.rmtree(cache / "bench-venv", ignore_errors=True)
            return None, f"OpenCAMLib could not be installed: {error}"
    return python, ""


def answer(python: Path, worker: str, *words: str, question: str | None = None) -> Any:
    """The JSON document that a worker of this folder prints last; it reads `question`."""
    command = [str(python), str(HERE / worker), *words]
    done = subprocess.run(command, input=question, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])
