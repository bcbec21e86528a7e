"""A headless Chromium in a root file system, driven through its DevTools protocol."""

from __future__ import annotations

import base64
import contextlib
import itertools
import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Any

from websockets.sync.client import ClientConnection, connect

import roots

PATIENCE = 60.0
"""Seconds for anything that a page is waited for."""

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-watchdog",
    "--hide-scrollbars",
    "--no-first-run",
    "--disable-background-networking",
    "--force-prefers-reduced-motion",
)


class PageError(AssertionError):
    """A page's script failed."""


class Tab:
    """One page. What it complains about is collected in ``complaints``, what it asks for in ``requests``."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._numbers = itertools.count(1)
        self.complaints: list[str] = []
        self.requests: list[str] = []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Calls a method of the protocol and returns its result."""
        number = next(self._numbers)
        self._connection.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._connection.recv(timeout=PATIENCE))
            if message.get("id") == number:
                if "error" in message:
                    raise PageError(f"{method}: {message['error']}")
                return dict(message["result"])
            self._note(message)

    def _note(self, message: dict[str, Any]) -> None:
        """Keeps what events say of faults and of the network."""
        given = message.get("params", {})
        if message["method"] == "Runtime.exceptionThrown":
            details = given["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description") or details["text"])
        elif message["method"] == "Runtime.consoleAPICalled" and given["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(arg.get("value", arg.get("description"))) for arg in given["args"]))
        elif message["method"] == "Log.entryAdded" and given["entry"]["level"] in ("error", "warning"):
            self.complaints.append(given["entry"]["text"])
        elif message["method"] == "Network.requestWillBeSent":
            self.requests.append(given["request"]["url"])

    def size(self, width: int, height: int, scheme: str = "light", media: str = "") -> None:
        """The window's size in CSS pixels, a light or dark scheme, screen or paper."""
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500
        )
        features = [
            {"name": "prefers-color-scheme", "value": scheme},
            {"name": "prefers-reduced-motion", "value": "reduce"},
        ]
        self.call("Emulation.setEmulatedMedia", media=media, features=features)

    def open(self, page: Path, ready: str = "document.documentElement?.dataset.ready === 'yes'") -> float:
        """Opens a file and waits until it is ready: a report's script reports when; the seconds that took."""
        begun = time.monotonic()
        self.call("Page.navigate", url=page.as_uri())
        self.until(ready)
        return time.monotonic() - begun

    def run(self, script: str) -> Any:
        """The value of an expression in the page; promises are waited for."""
        answered = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answered:
            raise PageError(answered["exceptionDetails"].get("exception", {}).get("description", script))
        return answered["result"].get("value")

    def until(self, condition: str) -> None:
        """Waits until an expression is true."""
        end = time.monotonic() + PATIENCE
        while not self.run(condition):
            if time.monotonic() > end:
                raise PageError(f"never true: {condition}; {self.complaints}")
            time.sleep(0.05)

    def choose(self, selector: str, value: str) -> None:
        """Sets a control to a value, as a person would."""
        self.run(
            f"""(() => {{ const e = document.querySelector({json.dumps(selector)}); e.value = {json.dumps(value)};
            e.dispatchEvent(new Event('input', {{bubbles: true}}));
            e.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"""
        )
        self.drawn()

    def click(self, selector: str) -> None:
        """Clicks what a selector finds first."""
        self.run(f"document.querySelector({json.dumps(selector)}).click()")
        self.drawn()

    def drawn(self) -> None:
        """Waits until two frames were drawn."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def picture(self, selector: str = "", whole: bool = False) -> bytes:
        """A PNG of the window, of an element, or of the whole page."""
        options: dict[str, Any] = {"format": "png", "captureBeyondViewport": whole}
        if selector:
            script = f"""(() => {{ const r = document.querySelector({json.dumps(selector)}).getBoundingClientRect();
            return {{x: r.x + scrollX, y: r.y + scrollY, width: r.width, height: r.height, scale: 1}}; }})()"""
            options["clip"] = self.run(script)
        return base64.b64decode(self.call("Page.captureScreenshot", **options)["data"])


@contextlib.contextmanager
def browser(seen: Path) -> Iterator[Tab]:
    """A tab of a new Chromium, which sees the folder ``seen`` under its own path, read-only.

    Raises:
        roots.Unavailable: this machine cannot have one.
    """
    roots.ensure("browser")
    reason = roots.why_not()
    if reason:
        raise roots.Unavailable(reason)
    command = [sys.executable, roots.__file__, "enter", "browser", "--bind", str(roots.Bind.same(seen))]
    command += ["--", "chromium", *FLAGS, "--user-data-dir=/tmp/home/profile", "about:blank"]
    with tempfile.NamedTemporaryFile(prefix="chromium-", suffix=".log") as log, _process(command, log) as process:
        address = _address(process, Path(log.name))
        with connect(address, max_size=None, open_timeout=PATIENCE) as top:
            made = _once(top, "Target.createTarget", url="about:blank")
            page = re.sub(r"/devtools/.*", f"/devtools/page/{made['targetId']}", address)
            with connect(page, max_size=None, open_timeout=PATIENCE) as connection:
                yield Tab(connection)


@contextlib.contextmanager
def _process(command: Sequence[str], log: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    """A process that ends with the block."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def _address(process: subprocess.Popen[bytes], log: Path) -> str:
    """Where the browser listens, as it reports itself."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and process.poll() is None:
        found = re.search(r"DevTools listening on (ws://\S+)", log.read_text(errors="replace"))
        if found:
            return found[1]
        time.sleep(0.05)
    raise roots.RootsError(f"Chromium did not start: {log.read_text(errors='replace')[-500:]}")


def _once(connection: ClientConnection, method: str, **parameters: Any) -> dict[str, Any]:
    connection.send(json.dumps({"id": 0, "method": method, "params": parameters}))
    while True:
        message = json.loads(connection.recv(timeout=PATIENCE))
        if message.get("id") == 0:
            return dict(message["result"])
