"""Viewers beside a running mission: rerun's own window, or its page in a browser. Both serve this machine alone."""

from __future__ import annotations

import logging
import os
import signal
import socket
import subprocess
from urllib.parse import quote

from missions.recording.optimize import rerun_command

LOOPBACK = "127.0.0.1"
_STOP_S = 5.0
_log = logging.getLogger(__name__)


def open_window(server_url: str) -> None:
    """Start the viewer's window; it stays when the mission is over, and nobody minds when it is closed."""
    _start([*rerun_command(), "--hide-welcome-screen", server_url], server_url)


# A shell that ends its command when its input ends, which is when whoever holds the other end does: by kill -9, too.
_LEASH = ("/bin/sh", "-c", '"$@" & read _; kill $!', "leash")


class WebPage:
    """A web server with the viewer's page, which reads the recording from `server_url`, until it is closed.

    It ends with this process, whatever ends that.

    Attributes:
        url: what to open in a browser, as often as one likes.
    """

    def __init__(self, server_url: str) -> None:
        port = free_port()
        self.url = f"http://{LOOPBACK}:{port}/?url={quote(server_url, safe='')}"
        serve = ["--serve-web", "--bind", LOOPBACK, "--web-viewer-port", str(port)]
        # Which browser to open is the user's choice: rerun would open one by itself.
        command = [*_LEASH, *rerun_command(), server_url, *serve]
        self._process = _start(command, server_url, stdin=subprocess.PIPE, BROWSER="true")

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
    command: list[str], server_url: str, *, stdin: int = subprocess.DEVNULL, **environment: str
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
        _log.warning("no live viewer: %s; the recording goes on, open %s to watch", error, server_url)
        return None
