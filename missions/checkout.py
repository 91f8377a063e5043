"""Which commit of this source runs, where it runs from a git checkout."""

from __future__ import annotations

import subprocess
from pathlib import Path

_TIMEOUT_S = 5.0


def commit() -> str | None:
    """The commit's hash, with `-dirty` behind it where files differ; None for an installed package, or without git."""
    here = Path(__file__)
    try:
        _git("ls-files", "--error-unmatch", here.name, folder=here.parent)  # else it is another project's checkout
        return _git("describe", "--always", "--dirty", "--abbrev=12", "--exclude=*", folder=here.parent)
    except (OSError, subprocess.SubprocessError):
        return None


def _git(*words: str, folder: Path) -> str:
    run = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=True, timeout=_TIMEOUT_S)
    return run.stdout.strip()
