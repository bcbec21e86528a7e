"""Many documents: through any `concurrent.futures.Executor`, a FreeCAD each; what fails does not stop the others."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from pathlib import Path

from styluscam._engine import CancelToken
from styluscam.arguments import A_FILE, FileName, file_of
from styluscam.errors import Cancelled, StylusError
from styluscam.freecad.document import DocumentRun, Options, require_addon, run_document
from styluscam.freecad.finding import freecad_command
from styluscam.freecad.writing import Writer, require_replaceable
from styluscam.types import Document, Progress

LOOK = 0.1
"""Seconds between two looks at progress and cancelling."""

INPUT = 2
EXIT_CODES = {"cancelled": 3, "internal": 4, "freecad-crashed": 4}
"""Exit codes of errors by their code; of all others: the input is wrong."""


def run_documents(
    files: Sequence[FileName],
    options: Options | None = None,
    *,
    out: Path | None = None,
    force: bool = False,
    workers: int = 1,
    executor: Executor | None = None,
    progress: Progress | None = None,
    cancel: CancelToken | None = None,
) -> list[DocumentRun]:
    """Has FreeCAD compute, verify and post documents, and writes the programs of each that is without an error.

    ``workers`` FreeCADs run at a time in this process's threads, or ``executor`` decides (processes, machines of a
    cluster): what is submitted to it, and what it gives back, can be pickled. Files are written here. The results have
    the order of the files. An error of one document stands in its result.

    Raises:
        StylusError: FreeCAD or the addon's folder is not there, or ``out`` is given and there are several files.
        Cancelled: by ``progress`` or ``cancel``; what is finished stays written.
    """
    paths = [file_of(file, "files", A_FILE, StylusError) for file in files]
    chosen = options or Options()
    _require(paths, chosen, out, executor)
    writer = Writer(paths, out, force)
    stop = threading.Event()
    with _pool(executor, workers, stop) as pool:
        own = () if executor is not None else (stop,)  # an event cannot be pickled
        futures = [pool.submit(_outcome, path, chosen, *own) for path in paths]
        results: dict[int, DocumentRun] = {}
        try:
            for number in _finished(futures, progress, cancel):
                results[number] = _written(futures[number], paths[number], writer)
        except BaseException:
            stop.set()
            for future in futures:
                future.cancel()
            raise
    return [results[number] for number in range(len(paths))]


def _require(paths: list[Path], options: Options, out: Path | None, executor: Executor | None) -> None:
    """Asks before long work what would fail in each document alike."""
    if options.addon is not None:
        require_addon(options.addon)
    if executor is None and not options.command:
        freecad_command()
    if out is not None and len(paths) > 1:
        message = f"--out names one file, and there are {len(paths)} documents"
        hint = "leave it out: FreeCAD's names are used"
        raise StylusError(message, code="outputs", where="--out", hint=hint)


@contextlib.contextmanager
def _pool(executor: Executor | None, workers: int, stop: threading.Event) -> Iterator[Executor]:
    """The executor, or threads of ours, which end with the block."""
    if executor is not None:
        yield executor
        return
    with ThreadPoolExecutor(max_workers=max(1, workers)) as pool:
        try:
            yield pool
        finally:
            stop.set()


def _outcome(path: Path, options: Options, stop: threading.Event | None = None) -> DocumentRun:
    """A document's result, its errors in it."""
    try:
        if options.save and path.is_file():
            require_replaceable(path)
        return run_document(path, options, stop)
    except StylusError as error:
        return DocumentRun(path, error=_record(error))


def _finished(
    futures: list[Future[DocumentRun]], progress: Progress | None, cancel: CancelToken | None
) -> Iterator[int]:
    """The numbers of the futures as they are done."""
    numbers = {future: number for number, future in enumerate(futures)}
    left = set(futures)
    while left:
        if cancel is not None and cancel.cancelled:
            raise Cancelled("cancelled", code="cancelled")
        done, left = wait(left, timeout=LOOK, return_when="FIRST_COMPLETED")
        yield from sorted(numbers[future] for future in done)
        ready = len(futures) - len(left)
        if progress is not None and progress(f"{ready} of {len(futures)}", ready / len(futures)) is False:
            raise Cancelled("cancelled", code="cancelled")


def _written(future: Future[DocumentRun], path: Path, writer: Writer) -> DocumentRun:
    """A document's result after its programs were written."""
    try:
        run = future.result()
    except Exception as error:
        return DocumentRun(path, error=_record(error))
    try:
        writer.write(run)
    except Exception as error:
        run.error = _record(error)
    return run


def _record(error: Exception) -> Document:
    """An error as FreeCAD's report has them."""
    known = isinstance(error, StylusError)
    code = str(getattr(error, "code", "internal")) if known else "internal"
    return {
        "class": type(error).__name__,
        "code": code,
        "where": str(getattr(error, "where", "")),
        "message": str(error) if known else f"a fault of StylusCAM: {error!r}",
        "hint": str(getattr(error, "hint", "")),
        "exit_code": EXIT_CODES.get(code, INPUT),
    }
