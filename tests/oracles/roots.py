"""Builds and enters root file systems in which foreign programs (FreeCAD, LinuxCNC, a browser) judge our work.

Everything is in `${STYLUSCAM_CACHE:-~/.cache/styluscam}`; nothing is installed on the host.

    python3 tests/oracles/roots.py ensure trixie forky browser
    python3 tests/oracles/roots.py enter trixie --bind /tmp/job:/job:rw -- freecadcmd /job/x.py
    python3 tests/oracles/roots.py doctor
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import fcntl
import functools
import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO

CHECKOUT = Path(__file__).resolve().parents[2]
FREECADCMD_ENV = "STYLUSCAM_FREECADCMD"
MIRROR_ENV = "STYLUSCAM_DEBIAN_MIRROR"
RECIPE = 1
"""Raise it when the way of building changes: every root is then built again."""

WHEELS_KEPT = 7 * 24 * 3600.0
"""Seconds after its last use that an unzipped wheel stays in the cache."""

DISPLAY_PACKAGES = ("xvfb", "xauth", "openbox", "xdotool")


CAGE = (
    *("setpriv", "--pdeathsig", "KILL", "--"),
    *("unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child"),
)
"""Starts every command that mounts: its mounts and processes end with it, and it with us."""


@dataclasses.dataclass(frozen=True)
class Root:
    """What one root file system holds."""

    suite: str
    packages: tuple[str, ...]
    freecad: str = ""
    """The version of the FreeCAD in it, if any."""

    def stamp(self) -> str:
        """A hash that changes when the root has to be built again."""
        recipe = json.dumps([RECIPE, self.suite, sorted(self.packages)])
        return hashlib.sha256(recipe.encode()).hexdigest()


ROOTS: Mapping[str, Root] = {
    "trixie": Root(
        suite="trixie",
        freecad="1.0",
        packages=(
            "freecad",
            "linuxcnc-uspace",
            "python3-numpy",
            "python3-pip",
            "python3-venv",
            *DISPLAY_PACKAGES,
        ),
    ),
    "forky": Root(
        suite="forky",
        freecad="1.1",
        packages=("freecad", "python3-numpy", "python3-pip", *DISPLAY_PACKAGES),
    ),
    "browser": Root(suite="trixie", packages=("chromium", "fonts-dejavu-core")),
}


class RootsError(Exception):
    """A root file system cannot be built or entered; the text says why."""


class Unavailable(RootsError):
    """This machine cannot do it at all; the text says why in one sentence."""


# ---------------------------------------------------------------------------- where things are


def cache_dir() -> Path:
    """The only directory outside the checkout that is ever written to."""
    named = os.environ.get("STYLUSCAM_CACHE")
    return Path(named).expanduser().resolve() if named else Path.home() / ".cache" / "styluscam"


def roots_dir() -> Path:
    """The directory that holds the root file systems, their logs and their locks."""
    path = cache_dir() / "roots"
    path.mkdir(parents=True, exist_ok=True)
    return path


def say(text: str) -> None:
    """Prints a progress line; standard output stays free for the programs in the root."""
    print(f"roots: {text}", file=sys.stderr, flush=True)


@contextlib.contextmanager
def locked(name: str, kind: int) -> Iterator[int]:
    """Holds the file lock of that name: LOCK_SH to use a root, LOCK_EX to replace it."""
    handle = os.open(roots_dir() / f"{name}.lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        try:
            fcntl.flock(handle, kind | fcntl.LOCK_NB)
        except BlockingIOError:
            say(f"{name}: waiting for another process that holds its lock")
            fcntl.flock(handle, kind)
        yield handle
    finally:
        os.close(handle)


# ------------------------------------------------------------------------------------- building


def why_not() -> str | None:
    """Says in one sentence why root file systems cannot work on this machine, or None."""
    if not sys.platform.startswith("linux"):
        return "Root file systems need Linux."
    if os.geteuid() != 0:
        return "Root file systems need uid 0 (for mount and chroot)."
    missing = [tool for tool in ("unshare", "setpriv", "mount", "chroot") if not shutil.which(tool)]
    if missing:
        return f"Root file systems need {', '.join(missing)}."
    if subprocess.run(["unshare", "-m", "true"], capture_output=True, check=False).returncode:
        return "This machine does not let us make a mount namespace (unshare -m)."
    return None


def why_no_build() -> str | None:
    """Says in one sentence why root file systems cannot be built here, or None."""
    missing = [tool for tool in ("perl", "apt-get", "dpkg", "dpkg-deb") if not shutil.which(tool)]
    if missing:
        return f"Building a root file system needs {', '.join(missing)}."
    return why_not()


def _apt(arguments: Sequence[str], state: Path, cwd: Path | None = None) -> str:
    """Runs apt-get with lists and caches of our own, so that the host's stay as they are."""
    for part in ("lists/partial", "archives/partial"):
        (state / part).mkdir(parents=True, exist_ok=True)
    config = state / "apt.conf"
    config.write_text(
        "#clear APT::Update::Pre-Invoke;\n"
        "#clear APT::Update::Post-Invoke;\n"
        "#clear APT::Update::Post-Invoke-Success;\n"
        "#clear DPkg::Post-Invoke;\n"
        f'Dir::State::Lists "{state}/lists";\n'
        f'Dir::Cache "{state}";\n'
        f'Dir::Cache::archives "{state}/archives";\n'
        'Dir::Cache::pkgcache "";\n'
        'Dir::Cache::srcpkgcache "";\n'
        'APT::Sandbox::User "root";\n'
        'Acquire::Languages "none";\n'
        'Acquire::Retries "5";\n'
        'Acquire::Check-Valid-Until "false";\n'
        'Acquire::IndexTargets::deb::DEP-11::DefaultEnabled "false";\n'
    )
    done = subprocess.run(
        ["apt-get", "-q", "-c", str(config), *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        tail = " ".join(done.stderr.split()[-60:])
        raise RootsError(f"apt-get {arguments[0]} failed: {tail}")
    return done.stdout


@dataclasses.dataclass(frozen=True)
class Builder:
    """The unpacked mmdebstrap, the archive's keys and the mirror to build from."""

    script: Path
    keyring: Path
    mirror: str


def _mirror(state: Path) -> str:
    """The Debian mirror this host is configured to use."""
    named = os.environ.get(MIRROR_ENV)
    if named:
        return named
    listing = _apt(["indextargets", "--format", "$(LABEL) $(COMPONENT) $(REPO_URI)"], state)
    for line in listing.splitlines():
        words = line.split()
        if words[:2] == ["Debian", "main"] and len(words) == 3:
            return words[2].rstrip("/")
    raise RootsError(f"This host's apt names no Debian mirror; set {MIRROR_ENV}.")


def builder() -> Builder:
    """Fetches mmdebstrap and the archive's newest keys through the host's apt, into the cache."""
    tools = roots_dir() / "tools"
    with locked("tools", fcntl.LOCK_EX):
        unpacked = tools / "unpacked"
        script = unpacked / "usr/bin/mmdebstrap"
        keyring = unpacked / "usr/share/keyrings/debian-archive-keyring.gpg"
        state = tools / "apt"
        if not (script.exists() and keyring.exists() and (state / "mirror").exists()):
            say("fetching mmdebstrap")
            shutil.rmtree(tools, ignore_errors=True)
            state.mkdir(parents=True)
            _apt(["update"], state)
            _apt(["download", "mmdebstrap", "debian-archive-keyring"], state, cwd=tools)
            for package in tools.glob("*.deb"):
                subprocess.run(["dpkg-deb", "-x", str(package), str(unpacked)], check=True)
            (state / "mirror").write_text(_mirror(state))
            shutil.rmtree(state / "lists")
        mirror = os.environ.get(MIRROR_ENV) or (state / "mirror").read_text()
    return Builder(script, keyring, mirror)


def _proxy_options() -> list[str]:
    """mmdebstrap options that carry the host's apt proxies over."""
    options: list[str] = []
    for key in ("Acquire::http::Proxy", "Acquire::https::Proxy"):
        shown = subprocess.run(
            ["apt-config", "shell", "VALUE", key], capture_output=True, text=True, check=False
        ).stdout
        found = re.fullmatch(r"VALUE='(.+)'", shown.strip())
        if found:
            options.append(f'--aptopt={key} "{found[1]}"')
    return options


def _build_command(root: Root, tools: Builder, target: Path) -> list[str]:
    """The command that fills `target`, with all its mounts in a namespace of its own."""
    return [
        *CAGE,
        "--mount-proc",
        *(
            "perl",
            str(tools.script),
            "--verbose",
            "--mode=root",
            "--variant=apt",
            "--format=directory",
        ),
        f"--keyring={tools.keyring}",
        '--aptopt=APT::Install-Recommends "false"',
        '--aptopt=Acquire::Check-Valid-Until "false"',
        '--aptopt=Acquire::Retries "5"',
        '--aptopt=Acquire::Languages "none"',
        *_proxy_options(),
        "--dpkgopt=force-unsafe-io",
        f"--include={','.join(root.packages)}",
        *(root.suite, str(target), tools.mirror),
    ]


def _follow(name: str, output: IO[str], record: IO[str]) -> None:
    """Copies mmdebstrap's output to the log and shows how far it is, every 15 seconds at least."""
    started = spoken = time.monotonic()
    unpacked = configured = 0
    for line in output:
        record.write(line)
        unpacked += line.startswith("Unpacking ")
        configured += line.startswith("Setting up ")
        now = time.monotonic()
        if line.startswith(("I: ", "E: ")):
            text = line[3:].rstrip()
        elif now - spoken > 15:
            text = f"{unpacked} packages unpacked, {configured} set up"
        else:
            continue
        spoken = now
        say(f"{name}: {now - started:5.0f} s  {text}")


def _fill(name: str, target: Path, tools: Builder) -> None:
    """Runs mmdebstrap, shows its main steps, and says what went wrong when it fails."""
    root = ROOTS[name]
    log = roots_dir() / f"{name}.log"
    temporary = roots_dir() / f"{name}.tmp"
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir()
    environment = {
        key: value
        for key, value in os.environ.items()
        if key in ("HOME", "LANG", "http_proxy", "https_proxy", "no_proxy")
    }
    environment |= {
        "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
        "TMPDIR": str(temporary),
        "DEBIAN_FRONTEND": "noninteractive",
    }
    with (
        log.open("w") as record,
        subprocess.Popen(
            _build_command(root, tools, target),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=environment,
        ) as process,
    ):
        try:
            assert process.stdout is not None
            _follow(name, process.stdout, record)
            code = process.wait()
        finally:
            process.kill()
    shutil.rmtree(temporary, ignore_errors=True)
    if code:
        tail = "\n".join(log.read_text().splitlines()[-15:])
        raise RootsError(f"Building {name} failed (mmdebstrap said {code}; all of it in {log}):\n{tail}")


def _remove(path: Path) -> None:
    """Deletes a tree of ours, but never through a mount."""
    mounts = [line.split()[4] for line in Path("/proc/self/mountinfo").read_text().splitlines()]
    inside = [mount for mount in mounts if Path(mount).is_relative_to(path)]
    if inside:
        raise RootsError(f"Refusing to delete {path}: {inside[0]} is mounted there.")
    shutil.rmtree(path, ignore_errors=True)


def _is_current(name: str) -> bool:
    """True when the root is there and was built from today's package list."""
    with contextlib.suppress(OSError):
        return (roots_dir() / name / "styluscam.stamp").read_text() == ROOTS[name].stamp()
    return False


def _finish(target: Path, root: Root) -> None:
    """Drops apt's caches and leaves the stamp that marks a root as whole."""
    for part in ("var/cache/apt", "var/lib/apt/lists"):
        shutil.rmtree(target / part, ignore_errors=True)
        (target / part / "partial").mkdir(parents=True)
    (target / "styluscam.stamp").write_text(root.stamp())


def ensure(name: str) -> Path:
    """Returns the root of that name, building it first when it is missing or out of date."""
    if name not in ROOTS:
        raise RootsError(f"There is no root named {name!r}; known: {', '.join(ROOTS)}.")
    target = roots_dir() / name
    if _is_current(name):
        return target
    reason = why_no_build()
    if reason:
        raise Unavailable(reason)
    tools = builder()
    with locked(name, fcntl.LOCK_EX):
        if _is_current(name):
            return target
        started = time.monotonic()
        say(f"{name}: building (a few minutes, 2 to 4 GB)")
        partial = roots_dir() / f"{name}.partial"
        _remove(partial)
        try:
            _fill(name, partial, tools)
            _finish(partial, ROOTS[name])
            _remove(target)
            partial.rename(target)
        finally:
            _remove(partial)
        say(f"{name}: ready after {time.monotonic() - started:.0f} s")
    return target


# ------------------------------------------------------------------------------------- entering


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
        """The same bind with an absolute source, or a RootsError that says what is wrong."""
        source = self.source.expanduser().resolve()
        target = os.path.normpath(self.target)
        if not source.exists():
            raise RootsError(f"Cannot bind {source}: it does not exist.")
        top, _, rest = target.removeprefix("/").partition("/")
        taken = top in KERNEL or (top in SHARED and not rest)
        if not target.startswith("/") or not top or taken:
            raise RootsError(f"Cannot bind to {self.target!r}: name a place like /out or /mnt/x.")
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


def _ready(name: str) -> None:
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
    _ready(name)
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


def _enter(name: str, argv: Sequence[str], binds: Sequence[Bind], cwd: str, env: Mapping[str, str]) -> int:
    """Runs a program inside a root on this terminal; it dies with us, however we are ended."""
    _ready(name)

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


# -------------------------------------------------------------------------------------- FreeCAD


@dataclasses.dataclass(frozen=True)
class FreeCadCmd:
    """A FreeCAD without a window: a command of the host's, or the one in a root."""

    version: str
    command: tuple[str, ...]
    root: str | None


@functools.cache
def _host_version(command: tuple[str, ...]) -> str | None:
    """The `1.1` of a FreeCAD on the host, or None when it does not answer."""
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60, check=False)
        found = re.search(r"FreeCAD (\d+\.\d+)", done.stdout)
        return found[1] if found else None
    return None


def _host_commands() -> Iterator[tuple[str, ...]]:
    """The FreeCADs that a person may have installed, the named one first."""
    named = os.environ.get(FREECADCMD_ENV)
    if named:
        command = tuple(shlex.split(named))
        if _host_version(command) is None:
            raise Unavailable(f"{FREECADCMD_ENV}={named} does not answer --version.")
        yield command
    for name in ("freecadcmd", "FreeCADCmd"):
        path = shutil.which(name)
        if path:
            yield (path,)


def freecadcmd(version: str) -> FreeCadCmd:
    """Finds FreeCAD `1.0` or `1.1`: the host's when its version matches, else the root's.

    Raises Unavailable with a one-sentence reason when this machine can have neither.
    """
    for command in _host_commands():
        if _host_version(command) == version:
            return FreeCadCmd(version, command, None)
    for name, root in ROOTS.items():
        if root.freecad == version:
            try:
                _ready(name)
            except Unavailable as error:
                raise Unavailable(f"No FreeCAD {version} on this host: {error}") from error
            return FreeCadCmd(version, ("freecadcmd",), name)
    raise Unavailable(f"No FreeCAD {version} on this host, and no root file system has it.")


def freecad_argv(
    version: str,
    script: Path,
    *args: str,
    python_path: Sequence[Path] = (),
    mod_path: Sequence[Path] = (),
    binds: Sequence[Bind] = (),
) -> list[str]:
    """The command that runs a script in FreeCAD; every path is the same inside and outside.

    `python_path` takes directories to import from (an unzipped wheel), `mod_path` takes addon
    directories themselves (the one with package.xml, not its parent). Only they, the checkout and
    the script's directory are seen inside, read-only: give a place to write as
    `binds=[Bind.same(directory, writable=True)]`. FreeCAD hides exceptions: the script has to end
    with flushing and `os._exit(code)`.
    """
    found = freecadcmd(version)
    script = script.resolve()
    pythons = [path.resolve() for path in python_path]
    mods = [path.resolve() for path in mod_path]
    program = list(found.command)
    for path in pythons:
        program += ["-P", str(path)]
    for path in mods:
        program += ["-M", str(path)]
    program += [str(script), *args]
    if found.root is None:
        home = cache_dir() / "freecad-user" / version
        home.mkdir(parents=True, exist_ok=True)
        return ["env", f"FREECAD_USER_HOME={home}", *program]
    seen = [
        CHECKOUT,
        *(p for p in (script.parent, *pythons, *mods) if not p.is_relative_to(CHECKOUT)),
    ]
    everything = [*(Bind.same(path) for path in dict.fromkeys(seen)), *binds]
    options = [word for bind in everything for word in ("--bind", str(bind))]
    here = str(Path(__file__).resolve())
    return [sys.executable, here, "enter", found.root, *options, "--", *program]


def run_freecad(
    version: str,
    script: Path,
    *args: str,
    python_path: Sequence[Path] = (),
    mod_path: Sequence[Path] = (),
    binds: Sequence[Bind] = (),
    timeout: float | None = None,
) -> subprocess.CompletedProcess[str]:
    """Runs a script in FreeCAD, its output captured; the arguments are those of freecad_argv.

    FreeCAD says 0 after an uncaught exception and after a script that is not there: here it is 1.
    """
    command = freecad_argv(version, script, *args, python_path=python_path, mod_path=mod_path, binds=binds)
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=timeout,
        check=False,
    )
    if done.returncode == 0 and "Exception while processing file" in done.stdout + done.stderr:
        done.returncode = 1
    return done


def _root_python(name: str) -> tuple[int, int]:
    """The version of a root's Python, read from its files."""
    link = (roots_dir() / name / "usr/bin/python3").readlink().name
    found = re.fullmatch(r"python(\d+)\.(\d+)", link)
    if not found:
        raise RootsError(f"{name}: python3 is a link to {link}, which names no version.")
    return int(found[1]), int(found[2])


def install_wheel(root_name: str, wheel_path: Path) -> Path:
    """Unzips a wheel into the cache and returns the directory to give as `python_path`.

    The directory is keyed by the wheel's contents, so it is never stale. A wheel made for a newer
    Python than the root's, or for one exact other Python, is refused.
    """
    ensure(root_name)
    tags = wheel_path.name.removesuffix(".whl").split("-")[-3:]
    found = re.match(r"cp(\d)(\d+)", tags[0])
    if found:
        wanted, have = (int(found[1]), int(found[2])), _root_python(root_name)
        if wanted > have or (tags[1] != "abi3" and wanted != have):
            raise RootsError(f"{wheel_path.name} does not fit the Python {have[0]}.{have[1]} of {root_name}.")
    digest = hashlib.sha256(wheel_path.read_bytes()).hexdigest()[:16]
    target = cache_dir() / "wheels" / digest
    if not target.is_dir():
        _drop_old_wheels(target.parent)
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=target.parent, prefix="partial-") as partial:
            with zipfile.ZipFile(wheel_path) as archive:
                archive.extractall(Path(partial) / digest)
            _rename_unless_there(Path(partial) / digest, target)
    os.utime(target)
    return target


def _rename_unless_there(source: Path, target: Path) -> None:
    """Moves a finished directory into place; one that another process put there first stays."""
    try:
        source.rename(target)
    except OSError:
        if not target.is_dir():
            raise


def _drop_old_wheels(directory: Path) -> None:
    """Deletes unzipped wheels that nobody used for a week."""
    for entry in directory.glob("*"):
        if time.time() - entry.stat().st_mtime > WHEELS_KEPT:
            shutil.rmtree(entry, ignore_errors=True)


# --------------------------------------------------------------------------------- command line


VERSION_SCRIPT = """\
import os, sys
try:
    import FreeCAD
    import numpy
    version = ".".join(FreeCAD.Version()[:3])
    print(f"FreeCAD {version} Python {sys.version.split()[0]} numpy {numpy.__version__}")
except BaseException as error:
    print(f"failed: {error!r}")
sys.stdout.flush()
os._exit(0)
"""


def program_line(name: str) -> str:
    """What the program that a root is for says of itself."""
    if ROOTS[name].freecad:
        return freecad_line(name)
    done = run(name, ["chromium", "--version"], timeout=120)
    return done.stdout.strip() or f"failed: {done.stderr.strip()[-300:]}"


def freecad_line(name: str) -> str:
    """What the FreeCAD in a root says of itself: `FreeCAD 1.0.0 Python 3.13.5 numpy 2.2.4`."""
    script = f"printf %s {shlex.quote(VERSION_SCRIPT)} > v.py && exec freecadcmd v.py"
    done = run(name, ["sh", "-c", script], timeout=120)
    lines = [line for line in done.stdout.splitlines() if line.startswith(("FreeCAD ", "failed: "))]
    return lines[-1] if lines else f"failed: {done.stderr.strip()[-300:]}"


def _size(path: Path) -> str:
    """How much disk a tree takes, as du says it."""
    done = subprocess.run(["du", "-sh", str(path)], capture_output=True, text=True, check=False)
    return done.stdout.split("\t")[0]


def doctor() -> int:
    """Prints what is there and whether it works; 1 when something is missing or wrong."""
    print(f"cache     {cache_dir()}")
    print(f"entering  {why_not() or 'works'}")
    print(f"building  {why_no_build() or 'works'}")
    try:
        for command in _host_commands():
            print(f"host      {shlex.join(command)}: FreeCAD {_host_version(command)}")
    except Unavailable as error:
        print(f"host      {error}")
    wrong = 0
    for name, root in ROOTS.items():
        if not _is_current(name):
            there = "out of date" if (roots_dir() / name).exists() else "not built"
            print(f"{name:9} {there}: roots.py ensure {name}")
            wrong += 1
            continue
        line = program_line(name) if not why_not() else "failed: cannot be entered here"
        expected = f"FreeCAD {root.freecad}." if root.freecad else "Chromium "
        good = line.startswith(expected)
        wrong += not good
        verdict = "" if good else f"  WRONG: expected {expected}"
        print(f"{name:9} {_size(roots_dir() / name):>5}  {line}{verdict}")
    return 1 if wrong else 0


def _parser() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    build = commands.add_parser("ensure", help="build roots that are missing or out of date")
    build.add_argument("names", nargs="+", choices=sorted(ROOTS))
    inside = commands.add_parser("enter", help="run the command that follows -- inside a root")
    inside.add_argument("name", choices=sorted(ROOTS))
    inside.add_argument("--bind", action="append", default=[], metavar="SRC:DST[:rw]")
    inside.add_argument("--env", action="append", default=[], metavar="KEY=VALUE")
    inside.add_argument("--cwd", default="/tmp")
    commands.add_parser("doctor", help="say what is there and whether it works")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    cut = words.index("--") if "--" in words else len(words)
    options, argv = _parser().parse_args(words[:cut]), words[cut + 1 :]
    try:
        if options.command == "doctor":
            return doctor()
        if options.command == "ensure":
            for name in options.names:
                say(f"{name}: {ensure(name)}")
            return 0
        environment = dict(pair.partition("=")[::2] for pair in options.env)
        return _enter(
            options.name,
            argv or ["bash"],
            [Bind.parse(text) for text in options.bind],
            options.cwd,
            environment,
        )
    except RootsError as error:
        say(f"error: {error}")
    return 2


if __name__ == "__main__":
    sys.exit(main())
