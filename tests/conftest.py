"""Long proofs run only where they are asked for: `pytest -m long`. What several folders of tests share."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import addon_zip
import styluscam as sc


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if "long" in config.getoption("markexpr"):
        return
    long = [item for item in items if item.get_closest_marker("long")]
    config.hook.pytest_deselected(items=long)
    items[:] = [item for item in items if item not in long]


@pytest.fixture(scope="session")
def addon(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The addon's folder, from the zip that `make addon` makes."""
    return addon_zip.unpacked(tmp_path_factory.mktemp("addon"))


@pytest.fixture(scope="session")
def engine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package that these tests import, alone in a directory: its engine is for every Python."""
    folder = tmp_path_factory.mktemp("engine")
    package = Path(sc.__file__).parent
    shutil.copytree(package, folder / "styluscam", ignore=shutil.ignore_patterns("__pycache__"))
    return folder
