"""A Chromium without a window, driven from here: opens a page, waits until it stands still, takes a picture.

    with browser() as page:
        page.open("http://127.0.0.1:9090", size=(1280, 720), dark=False)
        page.save("page.png")

WebGL is drawn in software, so that a page of the web viewer needs no graphics card either.
"""

from __future__ import annotations

import fcntl
import json
import os
import signal
import subprocess
import tempfile
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import which
from typing import Any

from tests.pictures.image import write_image

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking"),
    *("--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader", "--ignore-gpu-blocklist"),
    *("--hide-scrollbars", "--remote-debugging-pipe"),
)
_STOP_S, _DRAW_S = 20.0, 240.0
_LOOK_EVERY_S, _STILL = 0.5, 4  # so many equal pictures in a row are a finished one
_CHUNK = 1 << 20
_BLANK_BYTES = 20_000  # a page of one color, or with a spinner, is smaller


class Page:
    """One page of a running browser."""

    def __init__(self, commands: int, answers: int) -> None:
        self._commands, self._answers = commands, answers
        self._heard = bytearray()
        self._number = 0
        self._session: str | None = None
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self._ask("Page.enable")

    def open(self, url: str, *, size: tuple[int, int], dark: bool = False) -> None:
        """Go to a page, on a screen of `size` points, in the theme that its reader likes."""
        wide, high = size
        self._ask("Emulation.setDeviceMetricsOverride", width=wide, height=high, deviceScaleFactor=1, mobile=False)
        likes = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self._ask("Emulation.setEmulatedMedia", features=[likes])
        self._ask("Page.navigate", url=url)
        while self._told().get("method") != "Page.loadEventFired":
            pass

    def save(self, path: Path | str, *, whole: bool = False) -> None:
        """A picture of what the window shows, or of the whole page, once it stands still.

        Raises:
            TimeoutError: it never does.
        """
        write_image(self._still(whole), path)

    def _still(self, whole: bool) -> bytes:
        equal, before, until = 0, b"", time.monotonic() + _DRAW_S
        while time.monotonic() < until:
            picture = b64decode(self._ask("Page.captureScreenshot", captureBeyondViewport=whole)["data"])
            equal = equal + 1 if picture == before and len(picture) > _BLANK_BYTES else 0
            if equal == _STILL:
                return picture
            before = picture
            time.sleep(_LOOK_EVERY_S)
        raise TimeoutError(f"the page was still moving after {_DRAW_S:g} s")

    def _ask(self, method: str, **parameters: Any) -> Any:
        """A command of the DevTools protocol, and what it returns; events in between are left aside."""
        self._number += 1
        asked = {"id": self._number, "method": method, "params": parameters}
        if self._session is not None:
            asked["sessionId"] = self._session
        os.write(self._commands, json.dumps(asked).encode() + b"\0")
        while (told := self._told()).get("id") != self._number:
            pass
        if "error" in told:
            raise RuntimeError(f"{method}: {told['error']['message']}")
        return told["result"]

    def _told(self) -> Any:
        """The next thing the browser says: each ends with a zero."""
        while (end := self._heard.find(b"\0")) < 0:
            more = os.read(self._answers, _CHUNK)
            if not more:
                raise RuntimeError("the browser is gone")
            self._heard += more
        said = bytes(self._heard[:end])
        del self._heard[: end + 1]
        return json.loads(said)


@contextmanager
def browser() -> Iterator[Page]:
    """A page of a browser of its own, which ends with the block."""
    program = next(filter(None, map(which, _NAMES)), None)
    assert program is not None, f"a picture of a page needs one of {', '.join(_NAMES)}"
    (hears, commands), (answers, tells) = os.pipe(), os.pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        process = _start([program, *_FLAGS, f"--user-data-dir={home}"], hears, tells)
        try:
            yield Page(commands, answers)
        finally:
            os.close(commands)
            os.close(answers)
            os.killpg(process.pid, signal.SIGTERM)
            process.wait(timeout=_STOP_S)


def _start(command: list[str], hears: int, tells: int) -> subprocess.Popen[bytes]:
    """Start a browser that takes commands at its descriptor 3 and answers at 4."""
    # Out of the way first: the pipes may have the numbers 3 and 4 themselves, crosswise.
    spare = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (hears, tells)]
    os.close(hears)
    os.close(tells)

    def connect() -> None:
        os.dup2(spare[0], 3)
        os.dup2(spare[1], 4)

    quiet = subprocess.DEVNULL
    process = subprocess.Popen(
        command,
        stdin=quiet,
        stdout=quiet,
        stderr=quiet,
        pass_fds=(3, 4),
        preexec_fn=connect,
        start_new_session=True,
    )
    for end in spare:
        os.close(end)
    return process
