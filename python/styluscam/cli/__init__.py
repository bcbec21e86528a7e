"""The command line: ``styluscam`` and ``python -m styluscam``."""

from __future__ import annotations

from styluscam.cli.app import invoke, main

__all__ = ["invoke", "main"]
