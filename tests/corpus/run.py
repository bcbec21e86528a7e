"""Runs every part of the corpus as a user would, and writes what came of it.

    python tests/corpus/run.py [--slice N] [--jobs 2] [--only NAME] [--all] [--base] [--limit 60] [--patience 1] [--out TABLE]

`styluscam new PART`, then `styluscam run` on the job that it wrote, then the same job with other strategies and tools: two a
part that its name chooses, or all eight. Each command is a process with a limit. Done programs are checked by `gouge` against
the triangles that the modeller made. TABLE.jsonl has a line a run, TABLE.md the summary.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "oracles")]

from outcomes import Outcome, run_part  # noqa: E402
from summary import markdown  # noqa: E402

CACHE = Path(os.environ.get("STYLUSCAM_CACHE", Path.home() / ".cache" / "styluscam"))


def sliced(parts: list[dict[str, Any]], count: int) -> list[dict[str, Any]]:
    """So many parts, of every family as evenly as it goes."""
    families: dict[str, list[dict[str, Any]]] = {}
    for part in parts:
        families.setdefault(part["family"], []).append(part)
    chosen: list[dict[str, Any]] = []
    turn = 0
    while len(chosen) < min(count, len(parts)):
        chosen += [members[turn] for members in families.values() if turn < len(members)]
        turn += 1
    return chosen[:count]


def main() -> int:
    """Command line."""
    options = _options()
    folder: Path = options.folder
    parts = json.loads((folder / "parts.json").read_text(encoding="utf-8"))
    if options.only:
        parts = [part for part in parts if any(word in part["name"] for word in options.only)]
    if options.slice:
        parts = sliced(parts, options.slice)
    rows: list[Outcome] = []
    with (
        options.out.with_suffix(".jsonl").open("w", encoding="utf-8") as table,
        tempfile.TemporaryDirectory() as scratch,
        ThreadPoolExecutor(options.jobs) as pool,
    ):
        jobs = [pool.submit(run_part, part, folder, Path(scratch), options) for part in parts]
        for job in jobs:
            for row in job.result():
                rows.append(row)
                table.write(json.dumps(row.as_dict(), ensure_ascii=False) + "\n")
                if options.verbose:
                    print(row.line(), flush=True)
            table.flush()
    text = markdown(rows)
    options.out.with_suffix(".md").write_text(text, encoding="utf-8")
    print(text.split("\n## ", 1)[0])
    return 1 if any(row.wrong for row in rows) else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=CACHE / "corpus", help="where parts.json is")
    parser.add_argument("--slice", type=int, default=0, help="so many parts, of every family")
    parser.add_argument("--only", action="append", default=[], help="parts whose name has this")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for each command")
    parser.add_argument("--patience", type=float, default=1.0, help="so many times longer where others use the machine")
    parser.add_argument("--all", action="store_true", help="all eight variants of a part")
    parser.add_argument("--base", action="store_true", help="no variants: what `new` wrote alone")
    parser.add_argument("--variant", action="append", default=[], help="these variants alone: z-level.ball, as-written")
    parser.add_argument("--keep", type=Path, help="a folder in which jobs and programs stay")
    parser.add_argument("--out", type=Path, default=Path("target/corpus"))
    parser.add_argument("--verbose", action="store_true")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
