"""Text in and out: outputs appear whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
import unicodedata
from collections.abc import Iterable, Iterator
from pathlib import Path

from styluscam.errors import StylusError, VerifyError


def read_text(path: str | Path, failure: type[StylusError]) -> str:
    """The text of a file; what keeps it from being read raises ``failure``."""
    try:
        require_end(Path(path))
        return Path(path).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        why = "it is not text in UTF-8" if isinstance(error, UnicodeDecodeError) else reason(error)
        raise failure(f"{path}: cannot be read: {why}", code="unreadable", where=str(path)) from error


def require_end(path: Path) -> None:
    """Refuses devices: /dev/zero has no end. Pipes are read."""
    mode = path.stat().st_mode
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
        raise OSError(errno.EINVAL, "it is a device, not a file", str(path))


def read_gcode_text(path: str | Path) -> str:
    """The text of a G-code file: UTF-8, or where it is not, in the code page that controllers' editors write (1252).

    Raises:
        VerifyError: the file cannot be read, or is no text.
    """
    try:
        return read_text(path, VerifyError).removeprefix("\ufeff")
    except VerifyError as error:
        if not isinstance(error.__cause__, UnicodeDecodeError):
            raise
        text = Path(path).read_bytes().decode("cp1252", errors="replace")
        if any(unicodedata.category(char) == "Cc" and char not in "\t\r\n\f\x1a" for char in text):
            raise
        return text


def write_whole(path: Path, text: str) -> None:
    """Writes ``text`` beside ``path`` and renames it: a reader sees the old file or the new one, never a part."""
    write_all_whole({path: text})


def write_all_whole(files: dict[Path, str]) -> None:
    """As :func:`write_whole` for several files: none is renamed before all are written. Missing folders are made.

    Raises:
        StylusError: a place that must not be written to, or a full disk; nothing was renamed then. Where the system
            refuses a later renaming, the files before it are the new ones: each is whole.
    """
    require_writable(files)
    written: list[tuple[str, Path]] = []
    try:
        for path, text in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            written.append((_write_beside(path, text), path))
        while written:
            temporary, path = written[0]
            Path(temporary).replace(path)
            written.pop(0)
    except OSError as error:
        raise _unwritable(path, error) from error
    finally:
        for temporary, _ in written:
            with contextlib.suppress(OSError):
                Path(temporary).unlink()


def require_writable(outputs: Iterable[Path], inputs: Iterable[Path] = ()) -> None:
    """Asks before long work whether its outputs can be written; folders that do not exist will be made.

    Raises:
        StylusError: a folder or a device stands in the way, permission is missing, or an output would replace one of
            ``inputs`` or another output.
    """
    taken = {_place(path): "is read by this very job" for path in inputs}
    for path in outputs:
        try:
            _look(path)
            place = _place(path)
        except (OSError, ValueError) as error:
            raise _unwritable(path, error) from error
        if place in taken:
            raise StylusError(
                f"{path}: cannot be written: it {taken[place]}",
                code="unwritable",
                where=str(path),
                hint="give it another name",
            )
        taken[place] = "is another output of this job"


def require_new(path: Path, force: bool, failure: type[StylusError], otherwise: str) -> None:
    """Asks whether a file would be replaced that nobody said to replace; ``otherwise`` is what else can be done.

    Raises:
        StylusError: of class ``failure``: it is there already.
    """
    if is_file(path) and not force:
        hint = f"add --force to replace it, or {otherwise}"
        raise failure(f"{path}: the file is there already", code="exists", where=str(path), hint=hint)


def is_file(path: Path) -> bool:
    """Whether there is a file of this name."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # no file can have such a name
        return False


def _place(path: Path) -> str:
    """The same for all names of a file."""
    return os.path.normcase(path.resolve())


@contextlib.contextmanager
def drawn_whole(path: Path) -> Iterator[Path]:
    """A temporary name in the folder of ``path``, to be drawn to; it becomes ``path`` when all went well."""
    require_writable([path])
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        yield Path(name)
        Path(name).chmod(0o644)
        Path(name).replace(path)
    except OSError as error:
        Path(name).unlink()
        raise _unwritable(path, error) from error
    except BaseException:
        Path(name).unlink()
        raise


def _look(path: Path) -> None:
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "the name holds a character that no file name has", str(path))
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, "a folder has this name", str(path))
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "a device has this name", str(path))
    folder = next((parent for parent in path.absolute().parents if parent.exists()), path.absolute().parent)
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, f"{folder} is a file, not a folder", str(path))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, f"no permission to write to {folder}", str(path))


def _unwritable(path: Path, error: OSError | ValueError) -> StylusError:
    name = str(path).replace("\0", "?")
    message = f"{name}: cannot be written: {reason(error)}"
    return StylusError(message, code="unwritable", where=name, hint="choose another place")


def reason(error: OSError | ValueError) -> str:
    """What the system says, without the number and the name around it."""
    return str(getattr(error, "strerror", None) or error)


def _write_beside(path: Path, text: str) -> str:
    """The name of a temporary file in the same folder that holds ``text``."""
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)
    except BaseException:
        Path(name).unlink()
        raise
    return name
