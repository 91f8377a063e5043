"""Compaction of a finished recording with rerun's own tool: the same data in a fifth of the bytes, with an index."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

_TIMEOUT_S = 600.0


def rerun_command() -> list[str]:
    """How to start rerun's command line here.

    The native program inside the rerun_cli package when it is there, since the installed `rerun` script only wraps it
    and would leave it running when killed; else the wrapper.
    """
    chosen = os.environ.get("RERUN_CLI_PATH")
    if chosen:
        return [chosen]
    spec = find_spec("rerun_cli")
    if spec is not None and spec.origin is not None:
        folder = Path(spec.origin).parent
        for name in ("rerun", "rerun.exe", "Rerun.app/Contents/MacOS/Rerun"):
            if (folder / name).is_file():
                return [str(folder / name)]
    return [sys.executable, "-m", "rerun_cli"]


def optimize(source: Path, destination: Path, *options: str, views: Sequence[Path] = ()) -> None:
    """Write a compacted, indexed copy of `source` to `destination`, whole or not at all; they may be the same.

    Args:
        views: files of blueprints that the copy is to have besides.

    Raises:
        RuntimeError: rerun's tool is missing or refused, with what it said.
    """
    unfinished = destination.with_name(destination.name + ".tmp")
    command = [*rerun_command(), "rrd", "optimize", *options, *map(str, views), str(source), "-o", str(unfinished)]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=_TIMEOUT_S)
        os.replace(unfinished, destination)
    except (OSError, subprocess.SubprocessError) as error:
        raise RuntimeError(f"cannot optimize {source}: {_reason(error)}") from error
    finally:
        unfinished.unlink(missing_ok=True)


def _reason(error: Exception) -> str:
    """The tool's own word on it; around that it tells where to report bugs."""
    lines = (getattr(error, "stderr", None) or str(error)).strip().splitlines()
    return next((line for line in lines if line.startswith("Error")), lines[-1] if lines else str(error))
