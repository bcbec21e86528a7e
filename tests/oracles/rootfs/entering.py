"""Runs programs inside root file systems, each in mounts and processes of its own."""

from __future__ import annotations

import dataclasses
import fcntl
import os
import shlex
import signal
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from rootfs.building import ensure, why_not
from rootfs.paths import CAGE, CHECKOUT, RootsError, Unavailable, locked, roots_dir

SHARED = ("usr", "etc", "var")
"""Directories of a root that are seen inside, read-only."""


ALIASES = ("bin", "sbin", "lib", "lib32", "lib64", "libx32")
"""Links of a root into /usr that are seen inside."""


KERNEL = ("proc", "dev", "sys")


@dataclasses.dataclass(frozen=True)
class Bind:
    """A host file or directory that is seen at `target` inside, read-only unless `writable`."""

    source: Path
    target: str
    writable: bool = False

    @classmethod
    def parse(cls, text: str) -> Bind:
        """Reads `SRC:DST`, `SRC:DST:ro` or `SRC:DST:rw`."""
        parts = text.split(":")
        if len(parts) not in (2, 3) or parts[2:] not in ([], ["ro"], ["rw"]):
            raise RootsError(f"A bind is SRC:DST or SRC:DST:rw, not {text!r}.")
        return cls(Path(parts[0]), parts[1], parts[2:] == ["rw"])

    @classmethod
    def same(cls, path: Path, writable: bool = False) -> Bind:
        """Shows a host path inside under the path it has outside."""
        path = path.resolve()
        return cls(path, str(path), writable)

    def __str__(self) -> str:
        return f"{self.source}:{self.target}:{'rw' if self.writable else 'ro'}"

    def checked(self) -> Bind:
        """The same bind with an absolute source, or a RootsError that states what is wrong."""
        source = self.source.expanduser().resolve()
        target = os.path.normpath(self.target)
        if not source.exists():
            raise RootsError(f"Cannot bind {source}: it does not exist.")
        top, _, rest = target.removeprefix("/").partition("/")
        taken = top in KERNEL or (top in SHARED and not rest)
        if not target.startswith("/") or not top or taken:
            raise RootsError(f"Cannot bind to {self.target!r}: name a folder like /out or /mnt/x.")
        return Bind(source, target, self.writable)


INSIDE = {
    "HOME": "/tmp/home",
    "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
    "LANG": "C.UTF-8",
    "TMPDIR": "/tmp",
    "XDG_RUNTIME_DIR": "/tmp/runtime",
    "PYTHONDONTWRITEBYTECODE": "1",
}
"""The whole environment of a program inside, apart from what the caller adds."""


def _show(root: Path, name: str, targets: Sequence[str]) -> list[str]:
    """Shell lines that show one entry of the root, read-only.

    A directory that has to hold a bind's target is made anew, from its entries.
    """
    source, quoted = root / name, shlex.quote(name)
    if source.is_symlink():
        if any(target.startswith(f"/{name}/") for target in targets):
            raise RootsError(f"Cannot bind below /{name}: it is a link inside the root.")
        return [f"ln -s {shlex.quote(str(source.readlink()))} {quoted}"]
    if any(target.startswith(f"/{name}/") for target in targets):
        entries = sorted(entry.name for entry in source.iterdir())
        inner = [_show(root, f"{name}/{entry}", targets) for entry in entries]
        return [f"mkdir {quoted}", *(line for lines in inner for line in lines)]
    return [
        f"mkdir {quoted}" if source.is_dir() else f": > {quoted}",
        f"mount --bind {shlex.quote(str(source))} {quoted}",
        f"mount -o remount,bind,ro {quoted}",
    ]


def _mount_script(root: Path, binds: Sequence[Bind], stage: Path) -> str:
    """The shell lines that lay out a view of the root on `stage`, in a namespace of their own."""
    at = shlex.quote(str(stage))
    lines = ["set -eu", "umask 022", f"mount -t tmpfs -o mode=755 roots {at}", f"cd {at}"]
    lines += ["mkdir -p proc dev sys run mnt home root srv media opt tmp"]
    targets = [bind.target for bind in binds]
    for name in (*SHARED, *ALIASES):
        if (root / name).exists():
            lines += _show(root, name, targets)
    lines += [
        "mount -t proc proc proc",
        "mount --rbind /dev dev",
        "mount -t tmpfs -o mode=1777 roots tmp",
        "mount -t tmpfs -o mode=1777 roots var/tmp",
        "mkdir -p -m 700 tmp/home tmp/runtime",
    ]
    for bind in binds:
        target = shlex.quote(bind.target.lstrip("/"))
        if bind.source.is_dir():
            lines.append(f"mkdir -p {target}")
        else:
            lines.append(f"mkdir -p $(dirname {target})")
            lines.append(f"[ -e {target} ] || : > {target}")
        lines.append(f"mount --bind {shlex.quote(str(bind.source))} {target}")
        if not bind.writable:
            lines.append(f"mount -o remount,bind,ro {target}")
    return "\n".join(lines)


def _enter_command(
    name: str,
    argv: Sequence[str],
    binds: Sequence[Bind],
    cwd: str,
    env: Mapping[str, str],
    project: Path,
) -> list[str]:
    """The command that runs `argv` inside; its mounts and processes all end with it."""
    stage = roots_dir() / "stage"
    stage.mkdir(exist_ok=True)
    everything = [Bind(project, "/project").checked(), *(bind.checked() for bind in binds)]
    layout = _mount_script(roots_dir() / name, everything, stage)
    environment = [f"{key}={value}" for key, value in {**INSIDE, **env}.items()]
    return [
        *CAGE,
        *("sh", "-c", layout + '\nchroot . "$@"\nexit $?', "roots"),
        *("/usr/bin/env", "-i", *environment),
        *("/bin/sh", "-c", 'cd "$1" && shift && exec "$@"', "roots", cwd, *argv),
    ]


def ready(name: str) -> None:
    """Makes sure that the root is there and that this machine can enter it."""
    reason = why_not()
    if reason:
        raise Unavailable(reason)
    ensure(name)


def run(
    name: str,
    argv: Sequence[str],
    binds: Sequence[Bind] = (),
    cwd: str = "/tmp",
    timeout: float | None = None,
    env: Mapping[str, str] | None = None,
    project: Path = CHECKOUT,
    stdin: str = "",
) -> subprocess.CompletedProcess[str]:
    """Runs a program inside a root (built first when missing), with its output captured.

    The checkout is at /project, read-only; /tmp and HOME are empty and vanish; a program that
    exceeds `timeout` seconds is killed with everything it started.
    """
    ready(name)
    with locked(name, fcntl.LOCK_SH) as handle:
        return subprocess.run(
            _enter_command(name, argv, binds, cwd, env or {}, project),
            input=stdin,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            check=False,
            pass_fds=(handle,),
        )


def enter(name: str, argv: Sequence[str], binds: Sequence[Bind], cwd: str, env: Mapping[str, str]) -> int:
    """Runs a program inside a root on this terminal; it dies with us, however we are ended."""
    ready(name)

    def end(number: int, _frame: object) -> None:
        raise SystemExit(128 + number)

    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, end)
    with locked(name, fcntl.LOCK_SH) as handle:
        command = _enter_command(name, argv, binds, cwd, env, CHECKOUT)
        with subprocess.Popen(command, pass_fds=(handle,)) as process:
            try:
                return process.wait()
            finally:
                process.kill()
