"""The engine's types as they are written down and as they are."""

from __future__ import annotations

import subprocess
import sys


def test_the_engine_is_what_its_stub_states():
    ran = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "styluscam._engine"], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
