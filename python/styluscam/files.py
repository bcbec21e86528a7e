"""Text in and out: outputs appear whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TypeAlias

from styluscam.errors import StylusError, VerifyError

Buffer: TypeAlias = "bytes | bytearray | memoryview"


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


def write_whole(path: Path, content: str | Buffer) -> None:
    """Writes a text (as UTF-8) or bytes to a file: a reader sees the old file or the new one, never a part of it.

    Raises:
        StylusError: as :func:`drawn_whole`.
    """
    write_all_whole({path: content})


def write_all_whole(files: Mapping[Path, str | Buffer]) -> None:
    """As :func:`write_whole` for several files: none is replaced before all are written.

    Raises:
        StylusError: as :func:`all_drawn_whole`.
    """
    with all_drawn_whole(files) as temporaries:
        for (path, content), temporary in zip(files.items(), temporaries, strict=True):
            with _naming(path):
                temporary.write_bytes(content.encode() if isinstance(content, str) else content)


@contextlib.contextmanager
def drawn_whole(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path``, for a writer that takes a name; it becomes ``path`` when all went well.

    Raises:
        StylusError: as :func:`all_drawn_whole`.
    """
    with all_drawn_whole([path]) as (temporary,), _naming(path):
        yield temporary


@contextlib.contextmanager
def all_drawn_whole(paths: Iterable[Path]) -> Iterator[list[Path]]:
    """Temporary files beside ``paths``, to be written; they take the paths' names when the block ends without an error.

    Missing folders are made. Files that are replaced keep their permissions, new ones have those of the umask. Contents
    are on the disk before the first name changes, the names before the block is left.

    Raises:
        StylusError: a path that must not be written to, or a full disk; nothing was replaced then. Where the system
            refuses a later renaming, the files before it are the new ones: each is whole.
    """
    paths = list(paths)
    require_writable(paths)
    temporaries: dict[Path, Path] = {}
    try:
        for path in paths:
            with _naming(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                temporaries[path] = _temporary(path)
        yield list(temporaries.values())
        for path, temporary in temporaries.items():
            with _naming(path):
                _sync(temporary)
        for path in paths:
            with _naming(path):
                _take_permissions(temporaries[path], path)
                temporaries[path].replace(path)
            del temporaries[path]
        for folder in {path.parent for path in paths}:
            _sync_folder(folder)
    finally:
        for temporary in temporaries.values():
            with contextlib.suppress(OSError):
                temporary.unlink()


def _temporary(path: Path) -> Path:
    """A new, empty file in the folder of ``path``, with the permissions that the umask leaves."""
    while True:
        temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
        try:
            handle = os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666)
        except FileExistsError:
            continue
        os.close(handle)
        return temporary


def _take_permissions(temporary: Path, path: Path) -> None:
    """Gives a file the permissions of the one that it replaces, if there is one."""
    with contextlib.suppress(FileNotFoundError):
        temporary.chmod(stat.S_IMODE(path.stat().st_mode))


def _sync(file: Path) -> None:
    """Brings a file's content to the disk."""
    handle = os.open(file, os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _sync_folder(folder: Path) -> None:
    """Brings a folder's names to the disk, where the system can: Windows opens no folders."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextlib.contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Errors of the system as one that names the output."""
    try:
        yield
    except OSError as error:
        raise _unwritable(path, error) from error


def require_writable(outputs: Iterable[Path], inputs: Iterable[Path] = ()) -> None:
    """Asks before long work whether its outputs can be written; folders that do not exist will be made.

    Raises:
        StylusError: a folder or a device has that name, permission is missing, or an output would replace one of
            ``inputs`` or another output.
    """
    taken = {_key(path): "is read by this very job" for path in inputs}
    for path in outputs:
        try:
            _look(path)
            key = _key(path)
        except (OSError, ValueError) as error:
            raise _unwritable(path, error) from error
        if key in taken:
            raise StylusError(
                f"{path}: cannot be written: it {taken[key]}",
                code="unwritable",
                where=str(path),
                hint="give it another name",
            )
        taken[key] = "is another output of this job"


def require_new(path: Path, force: bool, failure: type[StylusError], otherwise: str) -> None:
    """Asks whether a file would be replaced without leave to replace it; ``otherwise`` is what else can be done.

    Raises:
        StylusError: of class ``failure``: the file exists.
    """
    if is_file(path) and not force:
        hint = f"add --force to replace it, or {otherwise}"
        raise failure(f"{path}: the file exists", code="exists", where=str(path), hint=hint)


def is_file(path: Path) -> bool:
    """Whether there is a file of this name."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # no file can have such a name
        return False


def _key(path: Path) -> str:
    """The same for all names of a file."""
    return os.path.normcase(path.resolve())


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
    return StylusError(message, code="unwritable", where=name, hint="choose another folder or name")


def reason(error: OSError | ValueError) -> str:
    """What the system reports, without the number and the name around it."""
    return str(getattr(error, "strerror", None) or error)
