"""Builds root file systems with the host's apt."""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from rootfs.paths import CAGE, ROOTS, Root, RootsError, Unavailable, locked, roots_dir, say

MIRROR_ENV = "STYLUSCAM_DEBIAN_MIRROR"


def why_not() -> str | None:
    """States in one sentence why root file systems cannot work on this machine, or None."""
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
    """States in one sentence why root file systems cannot be built here, or None."""
    missing = [tool for tool in ("perl", "apt-get", "dpkg", "dpkg-deb") if not shutil.which(tool)]
    if missing:
        return f"Building a root file system needs {', '.join(missing)}."
    return why_not()


def apt(arguments: Sequence[str], state: Path, cwd: Path | None = None) -> str:
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
    listing = apt(["indextargets", "--format", "$(LABEL) $(COMPONENT) $(REPO_URI)"], state)
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
            apt(["update"], state)
            apt(["download", "mmdebstrap", "debian-archive-keyring"], state, cwd=tools)
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
    """Runs mmdebstrap, shows its main steps, and reports what went wrong when it fails."""
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
        raise RootsError(f"Building {name} failed (mmdebstrap ended with {code}; all of it in {log}):\n{tail}")


def _remove(path: Path) -> None:
    """Deletes a tree of ours, but never through a mount."""
    mounts = [line.split()[4] for line in Path("/proc/self/mountinfo").read_text().splitlines()]
    inside = [mount for mount in mounts if Path(mount).is_relative_to(path)]
    if inside:
        raise RootsError(f"Refusing to delete {path}: {inside[0]} is mounted there.")
    shutil.rmtree(path, ignore_errors=True)


def is_current(name: str) -> bool:
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
    if is_current(name):
        return target
    reason = why_no_build()
    if reason:
        raise Unavailable(reason)
    tools = builder()
    with locked(name, fcntl.LOCK_EX):
        if is_current(name):
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
