"""The job of a part as `styluscam new` wrote it, and its variants: another strategy, another tool."""

from __future__ import annotations

import sys
import zlib
from copy import deepcopy
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

KINDS = ("z-level", "zig-zag")
TOOLS = ("ball", "clothoid", "flat", "bull-nose")
VARIANTS = tuple(f"{kind}.{tool}" for kind in KINDS for tool in TOOLS)


def variants_of(name: str, *, every: bool) -> tuple[str, ...]:
    """The variants of a part: all eight, or one of levels and one of rows that its name chooses."""
    if every:
        return VARIANTS
    turn = zlib.crc32(name.encode())
    return f"z-level.{TOOLS[turn % 4]}", f"zig-zag.{TOOLS[(turn // 4) % 4]}"


def read(path: Path) -> dict[str, Any]:
    """A job file."""
    with path.open("rb") as file:
        return tomllib.load(file)


def varied(job: dict[str, Any], variant: str, body: str, thickness: float | None) -> dict[str, Any]:
    """The job with one operation of a kind and one tool, formed if the part is a sheet, else milled."""
    kind, shape = variant.split(".")
    job = deepcopy(job)
    setup, part = job.setdefault("setup", {}), job["part"]
    if body in ("sheet", "shell"):
        face = part.get("model_face", "tool")
        part["model_face"] = face
        sheet = setup.setdefault("sheet", {"thickness": 1.0, "law": "constant"})
        sheet["thickness"] = thickness or sheet["thickness"]
        setup.setdefault("zero", "sheet-top")
        job["process"] = {**job.get("process", {}), "kind": "spif"}
        if kind == "zig-zag":
            job["accept"] = ["punch"]  # rows alone form no sheet
    else:
        setup.pop("sheet", None)
        part.pop("model_face", None)
        if setup.get("zero") == "sheet-top":
            setup.pop("zero")
        job["process"] = {"kind": "milling"}
    part["faces"] = "all"
    name, first = next(iter(job["tools"].items()))
    diameter = _diameter(first)
    profile = {"kind": shape, "diameter": diameter}
    if shape == "bull-nose":
        profile["corner_radius"] = round(diameter / 5, 6)
    job["tools"] = {
        name: {key: value for key, value in first.items() if key in ("number", "reference")} | {"profile": profile}
    }
    step = round(0.1 * diameter, 6)
    kept = {key: value for key, value in job["operations"][0].items() if key in ("feeds", "tolerance", "spindle")}
    if job["process"]["kind"] == "milling":
        kept.setdefault("spindle", {"mode": "fixed", "rpm": 8000.0})
    operation = {"kind": kind, "tool": name, **kept}
    job["operations"] = [operation | ({"step": {"height": step}} if kind == "z-level" else {"stepover": step})]
    return job


def _diameter(tool: dict[str, Any]) -> float:
    """Of the tool that `new` chose; one from the library has none in the job."""
    return float(tool.get("profile", {}).get("diameter", 10.0))


def text(job: dict[str, Any]) -> str:
    """A job as TOML."""
    lines = [
        f"{key} = {_value(value)}" for key, value in job.items() if not isinstance(value, dict) and key != "operations"
    ]
    for key, value in job.items():
        if key == "operations":
            for operation in value:
                lines += ["", "[[operations]]", *(f"{name} = {_value(item)}" for name, item in operation.items())]
        elif isinstance(value, dict):
            lines += ["", f"[{key}]", *(f"{name} = {_value(item)}" for name, item in value.items())]
    return "\n".join(lines) + "\n"


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{name} = {_value(item)}" for name, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(value)
