"""What two engines write for the same parts: the proof that a change of structure changed nothing else.

    python tests/corpus/same.py write STYLUSCAM FOLDER [--slice N] [--jobs 2]
    python tests/corpus/same.py compare BEFORE AFTER

`write` runs `new` and `run` of the given command (a path to `styluscam`) on the fixtures, the examples and the corpus, and
keeps one line a part: the job's keys, the checksum of every program, and the figures and findings of the JSON answers
without their texts. `compare` prints every line that differs, and ends with 1 where one does.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).resolve().parent)]

from jobs import read  # noqa: E402
from run import CACHE, sliced  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
TEXTS = {"message", "hint", "reasons", "notes", "written", "words", "title", "advice", "where", "remark"}
"""Keys of the JSON answers that hold sentences or paths."""


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    writing = commands.add_parser("write")
    writing.add_argument("styluscam", type=Path)
    writing.add_argument("folder", type=Path)
    writing.add_argument("--corpus", type=Path, default=CACHE / "corpus", help="where parts.json is")
    writing.add_argument("--slice", type=int, default=0, help="so many parts of the corpus, of every family")
    writing.add_argument("--jobs", type=int, default=2)
    writing.set_defaults(action=_write)
    comparing = commands.add_parser("compare")
    comparing.add_argument("before", type=Path)
    comparing.add_argument("after", type=Path)
    comparing.set_defaults(action=_compare)
    options = parser.parse_args()
    return int(options.action(options))


def _write(options: argparse.Namespace) -> int:
    parts = json.loads((options.corpus / "parts.json").read_text(encoding="utf-8"))
    if options.slice:
        parts = sliced(parts, options.slice)
    tasks = [(part["name"], options.corpus / part["file"], part["units"]) for part in parts]
    tasks += [(f"fixture {path.stem}", path, None) for path in sorted((ROOT / "fixtures").glob("*.step"))]
    command = options.styluscam.absolute()
    options.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(options.jobs) as pool:
        kept = list(pool.map(lambda task: _part(command, options.folder, Path(scratch), *task), tasks))
        kept += [_example(command, Path(scratch), job) for job in sorted((ROOT / "examples").glob("*/job.toml"))]
    with (options.folder / "lines.jsonl").open("w", encoding="utf-8") as table:
        table.writelines(json.dumps(line, sort_keys=True) + "\n" for line in kept)
    print(f"{len(kept)} parts, {sum(len(line['programs']) for line in kept)} programs")
    return 0


def _part(command: Path, folder: Path, scratch: Path, name: str, file: Path, units: str | None) -> dict[str, Any]:
    home = scratch / name.replace("/", "_")
    home.mkdir()
    shutil.copy(file, home / file.name)
    named = ["--units", units] if units else []
    new = _answer(command, ["new", file.name, *named, "--out", "job.toml"], home)
    line = {"name": name, "new": new, "job": None, "run": None, "programs": {}}
    if new["code"] == 0:
        line["job"] = read(home / "job.toml")
        line["run"] = _answer(command, ["run", "job.toml"], home)
        line["programs"] = _programs(home)
        for program in home.glob("*.ngc"):
            shutil.copy(program, folder / f"{home.name}.{program.name}")
    shutil.rmtree(home)
    return line


def _example(command: Path, scratch: Path, job: Path) -> dict[str, Any]:
    shutil.copytree(ROOT / "fixtures", scratch / "fixtures", dirs_exist_ok=True)
    home = scratch / "examples" / job.parent.name
    shutil.copytree(job.parent, home, ignore=shutil.ignore_patterns("out"))
    answer = _answer(command, ["run", job.name], home)
    return {"name": f"example {job.parent.name}", "new": None, "job": None, "run": answer, "programs": _programs(home)}


def _answer(command: Path, arguments: list[str], home: Path) -> dict[str, Any]:
    ended = subprocess.run(
        [str(command), *arguments, "--json"], cwd=home, capture_output=True, text=True, env=os.environ, check=False
    )
    try:
        document = json.loads(ended.stdout)
    except ValueError:
        document = {"unreadable": ended.stdout[-300:] + ended.stderr[-300:]}
    return {"code": ended.returncode, "answer": _without_texts(document)}


def _without_texts(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_texts(one) for key, one in value.items() if key not in TEXTS}
    return [_without_texts(one) for one in value] if isinstance(value, list) else value


def _programs(home: Path) -> dict[str, str]:
    files = sorted(path for path in home.rglob("*.ngc"))
    return {str(path.relative_to(home)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def _compare(options: argparse.Namespace) -> int:
    before, after = (_lines(folder) for folder in (options.before, options.after))
    differing = 0
    for name in sorted(before.keys() | after.keys()):
        if name not in before or name not in after:
            print(f"{name}: {'before' if name in before else 'after'} only")
            differing += 1
        elif found := list(_differences(before[name], after[name], "")):
            print(f"{name}: " + "; ".join(found[:6]) + (f"; {len(found) - 6} more" if len(found) > 6 else ""))
            differing += 1
    programs = sum(len(line["programs"]) for line in before.values())
    print(f"{len(before)} parts, {programs} programs: {differing} differ")
    return 1 if differing else 0


def _lines(folder: Path) -> dict[str, Any]:
    text = (folder / "lines.jsonl").read_text(encoding="utf-8")
    lines = [_with_figures(line) for line in map(json.loads, text.splitlines())]
    return {line["name"]: line for line in lines}


def _with_figures(value: Any) -> Any:
    """With an operation's figures as a list, whether they are keys of their own (until 0.1) or facts."""
    if isinstance(value, list):
        return [_with_figures(one) for one in value]
    if not isinstance(value, dict):
        return value
    value = {key: _with_figures(one) for key, one in value.items()}
    if "facts" in value:
        value["figures"] = [fact["value"] for fact in value.pop("facts")]
    elif "groups" in value and "passes" in value:
        smallest = value.pop("smallest_feature")
        figures = [float(value.pop("groups")), float(value.pop("passes"))]
        value["figures"] = [*figures, smallest] if value["kind"] == "z-level" else figures
    return value


def _differences(before: Any, after: Any, path: str) -> Any:
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(before.keys() | after.keys()):
            yield from _differences(before.get(key), after.get(key), f"{path}.{key}".lstrip("."))
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, pair in enumerate(zip(before, after, strict=True)):
            yield from _differences(*pair, f"{path}[{index}]")
    elif before != after:
        yield f"{path}: {json.dumps(before)[:60]} -> {json.dumps(after)[:60]}"


if __name__ == "__main__":
    sys.exit(main())
