"""Viewers of recordings and of running missions: rerun's own window, or its page for browsers on this machine."""

from __future__ import annotations

import logging
import os
import signal
import socket
import subprocess
from collections.abc import Sequence
from urllib.parse import quote

from missions.recording.optimize import rerun_command

LOOPBACK = "127.0.0.1"
_STOP_S = 5.0
_OPENED_S = 0.5  # a window that is there for so long is there
_log = logging.getLogger(__name__)


# A window has a server of its own.
_WINDOW = ("--hide-welcome-screen", "--bind", LOOPBACK, "--port", "auto")


def run_window(*sources: str) -> int:
    """Show recordings in the viewer's window until it is closed. Returns its exit code; there may be no screen."""
    process = _start([*rerun_command(), *_WINDOW, *sources], sources)
    return 1 if process is None else process.wait()


def open_window(*sources: str) -> None:
    """Start the viewer's window on a live server; it stays after the mission, and nobody minds when it is closed.

    Without a screen there is none: that is told, and no more.
    """
    process = _start([*rerun_command(), *_WINDOW, *sources], sources)
    if process is None:
        return
    try:
        code = process.wait(timeout=_OPENED_S)
    except subprocess.TimeoutExpired:
        return
    _log.warning("no viewer: it ended at once with %d (is there a screen?); to watch: %s", code, ", ".join(sources))


# A shell that ends its command when its input ends, which is when whoever holds the other end does: by kill -9, too.
_LEASH = ("/bin/sh", "-c", '"$@" & read _; kill $!', "leash")


class WebPage:
    """A web server with the viewer's page, which shows recordings or reads from a live server, until it is closed.

    It ends with this process, whatever ends that.

    Attributes:
        url: what to open in a browser, as often as one likes.
    """

    def __init__(self, *sources: str) -> None:
        port, data_port = free_port(), free_port()
        # A live server is read by the page itself, files are passed on to it.
        data_url = sources[0] if "://" in sources[0] else f"rerun+http://{LOOPBACK}:{data_port}/proxy"
        self.url = f"http://{LOOPBACK}:{port}/?url={quote(data_url, safe='')}"
        serve = ["--serve-web", "--bind", LOOPBACK, "--port", str(data_port), "--web-viewer-port", str(port)]
        # Which browser to open is the user's choice: rerun would open one by itself.
        command = [*_LEASH, *rerun_command(), *sources, *serve]
        self._process = _start(command, sources, stdin=subprocess.PIPE, BROWSER="true")

    def wait(self) -> None:
        """Until the server ends, which it does not by itself."""
        if self._process is not None:
            self._process.wait()

    def close(self) -> None:
        """Stop serving; pages that are open keep what they have loaded."""
        if self._process is None:
            return
        if self._process.stdin is not None:
            self._process.stdin.close()
        try:
            self._process.wait(timeout=_STOP_S)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)


def free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port: int = probe.getsockname()[1]
        return port


def _start(
    command: list[str], sources: Sequence[str], *, stdin: int = subprocess.DEVNULL, **environment: str
) -> subprocess.Popen[bytes] | None:
    quiet = subprocess.DEVNULL
    try:
        return subprocess.Popen(
            command,
            env={**os.environ, "RERUN_APP_ONLY": "true", **environment},
            stdin=stdin,
            stdout=quiet,
            stderr=quiet,
            start_new_session=True,
        )
    except OSError as error:
        _log.warning("no viewer: %s; to watch: %s", error, ", ".join(sources))
        return None
