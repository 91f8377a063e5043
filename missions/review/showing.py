"""`swarm review --view` and `--web`: the recordings in the viewer, until it is closed."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console

from missions.problems import InputError
from missions.recording.watch import WebPage, run_window
from missions.recording.whole import whole


def show(recordings: Sequence[Path], console: Console, *, window: bool) -> None:
    """Show recordings, repaired if need be, in a window, or on a page until Ctrl-C.

    Raises:
        InputError: there is no screen for a window.
    """
    with ExitStack() as stack:
        files = [str(file) for path in recordings for file in stack.enter_context(whole(path)).files]
        try:
            if window:
                _show_window(files)
            else:
                page = WebPage(*files)
                stack.callback(page.close)
                console.print(f"Look at it in a browser: {page.url}\nCtrl-C ends it.", soft_wrap=True, markup=False)
                page.wait()
        except KeyboardInterrupt:
            return


def _show_window(files: Sequence[str]) -> None:
    code = run_window(*files)
    if code > 0:  # below zero: somebody ended it by a signal
        raise InputError(f"--view: got no window (the viewer ended with {code}); allowed: with a screen; else --web")
