"""Where the jobs of the mutation tests are."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the machine files of the jobs are."""
    return tmp_path_factory.mktemp("machines")
