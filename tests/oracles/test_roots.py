"""Tests that the programs in the root file systems answer, and that they refuse bad work."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

import roots
import rs274

pytestmark = pytest.mark.world

VERSIONS = {root.freecad: name for name, root in roots.ROOTS.items() if root.freecad}

GOOD = """\
G21 G90 G54 G17 G94
G64 P0.001
T1 M6
G43 H1
S1000 M3
N10 G0 X10 Y20 Z5
N20 G1 Z-1.5 F600
N30 G2 X20 Y20 I5 J0
N40 G18 G3 X26 Z-1.5 I3 K0
N50 G17 G1 X27.12345 F300
M5
M30
"""

REPORT = """\
import os, sys
try:
    import FreeCAD
    import dummy
    from freecad import dummy_wb
    print("version", ".".join(FreeCAD.Version()[:3]))
    print("answer", dummy.ANSWER + dummy_wb.ANSWER)
    print("arguments", *sys.argv[-2:])
    code = 7
except BaseException as error:
    print("failed", repr(error))
    code = 8
sys.stdout.flush()
os._exit(code)
"""


def need(find: Callable[[], object]) -> None:
    """Skips where root file systems are impossible, but fails in CI, which has to have them."""
    try:
        find()
    except roots.Unavailable as error:
        if os.environ.get("CI"):
            pytest.fail(str(error))
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def trixie() -> str:
    """The root that has LinuxCNC."""
    need(lambda: roots.run("trixie", ["true"]))
    return "trixie"


@pytest.fixture(scope="module", params=sorted(VERSIONS))
def freecad(request: pytest.FixtureRequest) -> str:
    """Each version of FreeCAD."""
    version = str(request.param)
    need(lambda: roots.freecadcmd(version))
    return version


def refused(text: str) -> str:
    """What the interpreter reports of a program that it must refuse."""
    result = rs274.interpret(text)
    assert not result.ok
    assert result.returncode == 1
    return result.error


def test_rs274_reads_a_good_program(trixie: str) -> None:
    result = rs274.interpret(GOOD)
    assert result.ok, result.error
    assert result.other == ()
    rapid, plunge, clockwise, counter, last = result.moves
    assert (rapid.kind, rapid.line, rapid.mm) == ("STRAIGHT_TRAVERSE", 10, (10.0, 20.0, 5.0))
    assert (plunge.kind, plunge.feed, plunge.mm) == ("STRAIGHT_FEED", 600.0, (10.0, 20.0, -1.5))
    assert (clockwise.mm, clockwise.center, clockwise.turns) == (
        (20.0, 20.0, -1.5),
        (15.0, 20.0, None),
        -1,
    )
    assert (counter.mm, counter.center, counter.turns) == (
        (26.0, 20.0, -1.5),
        (23.0, None, -1.5),
        1,
    )
    assert (last.line, last.feed) == (50, 300.0)
    assert last.x == pytest.approx(27.12345, abs=5.1e-5)
    (offset,) = result.of("USE_TOOL_LENGTH_OFFSET")
    assert offset.numbers[2] == rs274.TOOLS[1]
    assert [call.numbers for call in result.of("SET_SPINDLE_SPEED")] == [(0.0, 1000.0)]


def test_rs274_numbers_are_in_the_units_in_force(trixie: str) -> None:
    first, second = rs274.interpret("G21\nG0 X25.4\nG20\nG0 Y2\nM2\n").moves
    assert (first.unit, first.x, second.unit, second.x) == ("mm", 25.4, "inch", 1.0)
    assert second.mm == pytest.approx((25.4, 50.8, 0.0))


def test_rs274_tool_length_moves_only_what_a_line_does_not_name(trixie: str) -> None:
    unnamed, named = rs274.interpret("G21 G90\nG43 H2\nG0 X1\nG0 Z3\nM2\n").moves
    assert unnamed.mm == (1.0, 0.0, -rs274.TOOLS[2])
    assert named.mm == (1.0, 0.0, 3.0)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("G21 G90\nG1 X1 F100\nG1 X2 Q\nM2\n", "G1 X2 Q"),
        ("G21 G90\nG1 X1\nM2\n", "zero feed rate"),
        ("G21 G90 G17\nG0 X0 Y0\nG2 X10 Y0 I4 J0 F100\nM2\n", "Radius to end of arc"),
        ("G21 G90\nT100 M6\nM2\n", "tool 100 not found"),
        ("G21 G90\nG0 X1\n", "no percent sign"),
        ("G21 G90\nG0 X1 \u00fc\nM2\n", "Bad character"),
    ],
)
def test_rs274_refuses_a_bad_program(trixie: str, text: str, reason: str) -> None:
    assert reason in refused(text)


def test_freecad_runs_a_script_with_our_packages(freecad: str, tmp_path: Path) -> None:
    addon = tmp_path / "Addon" / "freecad" / "dummy_wb"
    addon.mkdir(parents=True)
    (addon / "__init__.py").write_text("ANSWER = 2\n")
    script = tmp_path / "script" / "report.py"
    script.parent.mkdir()
    script.write_text(REPORT)
    wheel = tmp_path / "dummy-1-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr(zipfile.ZipInfo("dummy/__init__.py"), "ANSWER = 40\n")
    packages = roots.install_wheel(VERSIONS[freecad], wheel)
    done = roots.run_freecad(
        freecad,
        script,
        "one",
        "two",
        python_path=[packages],
        mod_path=[tmp_path / "Addon"],
        timeout=120,
    )
    lines = done.stdout.splitlines()
    assert done.returncode == 7, done.stdout + done.stderr
    assert any(line.startswith(f"version {freecad}.") for line in lines)
    assert "answer 42" in lines
    assert "arguments one two" in lines


def test_freecad_script_that_fails_is_seen(freecad: str, tmp_path: Path) -> None:
    script = tmp_path / "broken.py"
    script.write_text("raise RuntimeError('on purpose')\n")
    done = roots.run_freecad(freecad, script, timeout=120)
    assert done.returncode == 1
    assert "on purpose" in done.stdout + done.stderr


def test_a_root_shows_the_checkout_but_cannot_change_it(trixie: str, tmp_path: Path) -> None:
    script = "cat out/in; touch /project/x; touch /etc/x; touch ro/x; echo back > out/back; env"
    (tmp_path / "in").write_text("hello\n")
    binds = [roots.Bind(tmp_path, "/job/out", True), roots.Bind(tmp_path, "/job/ro")]
    done = roots.run(trixie, ["sh", "-c", script], binds=binds, cwd="/job")
    assert done.stdout.startswith("hello\n")
    assert done.stderr.count("Read-only file system") == 3
    assert (tmp_path / "back").read_text() == "back\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["back", "in"]
    names = {line.split("=")[0] for line in done.stdout.splitlines() if "=" in line}
    assert names <= {*roots.INSIDE, "PWD", "OLDPWD"}


def test_nothing_outlives_the_command(trixie: str) -> None:
    marker = f"271828.{os.getpid()}"
    with pytest.raises(subprocess.TimeoutExpired):
        roots.run(trixie, ["sh", "-c", f"sleep {marker} & sleep {marker}"], timeout=1)
    processes = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True)
    assert f"sleep {marker}" not in processes.stdout.splitlines()
    assert str(roots.roots_dir()) not in Path("/proc/self/mountinfo").read_text()


def test_a_bind_may_lie_deep_in_the_root(trixie: str, tmp_path: Path) -> None:
    (tmp_path / "in").write_text("hello\n")
    binds = [roots.Bind(tmp_path, "/var/lib/work"), roots.Bind(tmp_path / "in", "/usr/src/a/b")]
    script = "cat /var/lib/work/in /usr/src/a/b && ls -d /var/lib/dpkg && ! touch /var/lib/dpkg/x"
    done = roots.run(trixie, ["sh", "-c", script], binds=binds)
    assert (done.returncode, done.stdout) == (0, "hello\nhello\n/var/lib/dpkg\n")
    assert "Read-only file system" in done.stderr


def test_a_bind_over_the_root_is_refused(trixie: str, tmp_path: Path) -> None:
    for target in ("/usr", "/", "relative", "/proc/x", "/bin/x", "/var/run/x"):
        with pytest.raises(roots.RootsError, match="Cannot bind"):
            roots.run(trixie, ["true"], binds=[roots.Bind(tmp_path, target)])
    with pytest.raises(roots.RootsError, match="does not exist"):
        roots.run(trixie, ["true"], binds=[roots.Bind(tmp_path / "none", "/x")])


def test_the_named_freecad_goes_first(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fake = tmp_path / "freecad-here"
    fake.write_text("#!/bin/sh\necho 'FreeCAD 1.1.7 Libs'\n")
    fake.chmod(0o755)
    monkeypatch.setenv(roots.FREECADCMD_ENV, str(fake))
    assert roots.freecadcmd("1.1") == roots.FreeCadCmd("1.1", (str(fake),), None)
    monkeypatch.setenv(roots.FREECADCMD_ENV, str(tmp_path / "none"))
    with pytest.raises(roots.Unavailable, match="does not answer"):
        roots.freecadcmd("1.1")


def test_without_freecad_the_reason_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(roots.FREECADCMD_ENV, raising=False)
    monkeypatch.setattr("os.geteuid", lambda: 1000)
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent))
    with pytest.raises(roots.Unavailable, match=r"^No FreeCAD 1\.0 on this host: .*\.$"):
        roots.freecadcmd("1.0")


def test_a_changed_package_list_asks_for_a_new_root() -> None:
    root = roots.ROOTS["trixie"]
    assert root.stamp() != roots.Root(root.suite, (*root.packages, "x")).stamp()
    assert root.stamp() != roots.Root("forky", root.packages).stamp()


def test_a_wheel_for_another_python_is_refused(trixie: str, tmp_path: Path) -> None:
    for tags in ("cp399-abi3-linux_x86_64", "cp310-cp310-linux_x86_64"):
        with pytest.raises(roots.RootsError, match="does not fit the Python"):
            roots.install_wheel(trixie, tmp_path / f"dummy-1-{tags}.whl")
