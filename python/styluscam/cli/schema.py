"""``styluscam schema``: the JSON Schemas of the documents."""

from __future__ import annotations

import json as json_module
from typing import Annotated

import typer

from styluscam import _engine
from styluscam.cli import console
from styluscam.cli.options import Debug, Json
from styluscam.programs.job import job_schema

OfMachine = Annotated[bool, typer.Option("--machine", help="Print the schema of machine files.")]


def schema(machine: OfMachine = False, json: Json = False, debug: Debug = False) -> int:
    """Print the JSON Schema of the job document, or of machine files."""
    console.say_json(json_module.loads(_engine.machine_schema()) if machine else job_schema())
    return 0
