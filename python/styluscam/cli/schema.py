"""``styluscam schema``: the JSON Schema of the job document."""

from __future__ import annotations

from styluscam.cli import console
from styluscam.cli.options import Debug, Json
from styluscam.job import job_schema


def schema(json: Json = False, debug: Debug = False) -> int:
    """Print the JSON Schema of the job document."""
    console.say_json(job_schema())
    return 0
