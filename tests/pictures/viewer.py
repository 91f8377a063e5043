"""A viewer without a window, driven from here: opens a recording, turns to a tab and a moment, takes a picture.

with viewer("flight.rrd", size=(1600, 900)) as seen:
    seen.turn_to("Knowledge", "A4")
    seen.save("a4.png", at_s=151.0)
    assert not seen.complaints

Needs a Vulkan driver (Debian's mesa-vulkan-drivers and libvulkan1), and xvfb for the light theme.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rerun
from rerun.experimental import ViewerClient

from missions.recording.optimize import rerun_command
from missions.recording.tape import TIME_LINE
from tests.pictures.image import write_image

_START_S, _OPEN_S, _DRAW_S = 20.0, 60.0, 40.0
_LOOK_EVERY_S = 0.3
_GREETING_S = 6.0  # so long a window tells where it listens
_TITLE_BAR = 38  # pixels of window above the tabs: it says nothing of the recording


class NoViewerError(RuntimeError):
    """No viewer runs on this computer."""


class Viewer:
    """A running viewer with one recording open.

    Attributes:
        complaints: the viewer's own reports of errors, of all that was saved; the values say nothing.
    """

    def __init__(self, client: ViewerClient) -> None:
        self._client = client
        self.complaints: dict[str, None] = {}

    def hide_menu(self) -> None:
        """Leave out the menu."""
        self._client.run_command("ui.toggle_top_panel")

    def turn_to(self, *tabs: str) -> None:
        """Bring a tab to the front, and a tab in it, by their names.

        Raises:
            KeyError: there is no such tab.
        """
        blueprint = self._client.get_blueprint().blueprint
        for name in tabs:
            wanted = _named(blueprint, name)
            holder = next(path for path, parts in blueprint.items() if wanted in _contents(parts))
            blueprint[holder]["ContainerBlueprint"]["active_tab"] = wanted
        self._client.set_blueprint(blueprint, of="recording")

    def save(self, path: Path | str, *, at_s: float) -> None:
        """A picture of the moment `at_s` seconds after power-on, once the viewer has settled."""
        self._client.set_time(TIME_LINE, duration=at_s, play_state="paused")
        time.sleep(1.0)
        before, until = b"", time.monotonic() + _DRAW_S
        # What is near the cursor is loaded while it is drawn: two equal pictures are a finished one.
        while (picture := self._client.take_screenshot()) != before and time.monotonic() < until:
            before = picture
            time.sleep(_LOOK_EVERY_S)
        write_image(picture, path, cut_top=_TITLE_BAR)
        self._complain()

    def _complain(self) -> None:
        """Note what the viewer has to report of the views it shows now, and the errors in its log."""
        views = [f"{view.name}: {report}" for view in self._client.get_state().views for report in view.reports]
        errors = [str(entry) for entry in self._client.get_logs() if "error" in str(entry.level).lower()]
        self.complaints.update(dict.fromkeys([*views, *errors]))

    def open(self, recording: Path | str) -> None:
        """Show a recording, whole."""
        self._client.open(str(Path(recording).resolve()))
        until = time.monotonic() + _OPEN_S
        while time.monotonic() < until:
            state = self._client.get_state()
            if state.recordings and not state.loading:
                return
            time.sleep(_LOOK_EVERY_S)
        raise TimeoutError(f"{recording} was not open after {_OPEN_S:g} s")


@contextmanager
def viewer(recording: Path | str, *, size: tuple[int, int] = (1600, 900), light: bool = False) -> Iterator[Viewer]:
    """A viewer that has `recording` open, in a window of `size` that nobody sees, dark or light."""
    port, window = _free_port(), f"{size[0]}x{size[1] + _TITLE_BAR}"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        command = [*rerun_command(), "--bind", "127.0.0.1", "--port", str(port), "--window-size", window]
        command += ["--hide-welcome-screen", "--memory-limit", "4GB"]
        command = _on_a_screen(command, size, Path(home)) if light else [*command, "--headless"]
        environment = {**os.environ, "RUST_LOG": "error", "XDG_RUNTIME_DIR": home, "XDG_DATA_HOME": home}
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, env=environment, stdout=quiet, stderr=quiet, start_new_session=True)
        try:
            _await_port(port, process)
            shown = Viewer(ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy"))
            shown.open(recording)
            shown.hide_menu()
            if light:
                time.sleep(_GREETING_S)
            yield shown
        finally:
            os.killpg(process.pid, signal.SIGTERM)
            process.wait(timeout=_START_S)


def _on_a_screen(command: list[str], size: tuple[int, int], home: Path) -> list[str]:
    """The command on a screen of its own, as somebody who likes it light: without a window it knows dark alone."""
    # The pointer is in the middle of the screen: there it shall point at nothing.
    screen = f"-screen 0 {2 * size[0] + 100}x{2 * size[1] + 100}x24"
    settings = home / "rerun" / "app.ron"
    settings.parent.mkdir()
    version = rerun.__version__
    settings.write_text(f'{{"rerun.version": "{version}", "egui": "(options:(theme_preference:Light))"}}')
    return ["xvfb-run", "-a", "-s", screen, *command, "--persist-state"]


def _named(blueprint: dict[str, Any], name: str) -> str:
    for path, parts in blueprint.items():
        for kind in ("ContainerBlueprint", "ViewBlueprint"):
            if parts.get(kind, {}).get("display_name") == name:
                return path.lstrip("/")
    raise KeyError(name)


def _contents(parts: dict[str, Any]) -> list[str]:
    return parts.get("ContainerBlueprint", {}).get("contents", [])  # type: ignore[no-any-return]


def _await_port(port: int, process: subprocess.Popen[bytes]) -> None:
    until = time.monotonic() + _START_S
    while time.monotonic() < until:
        if process.poll() is not None:
            raise NoViewerError(f"the viewer ended at once, with {process.returncode}: is there a Vulkan driver?")
        try:
            socket.create_connection(("127.0.0.1", port), timeout=0.2).close()
            return
        except OSError:
            time.sleep(0.1)
    raise TimeoutError(f"the viewer did not listen after {_START_S:g} s")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
