"""The arrows between the rooms of the house, and the fences around heavy packages, read from the source."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAY_IMPORT = {
    "comms": set(),
    "swarm_agent": {"comms"},
    "vehicle_sim": {"comms"},
    "missions": {"comms", "swarm_agent", "vehicle_sim"},
}
# A package, and the files (or folders) that alone may import it.
FENCES = {
    "zenoh": {"comms/session.py"},
    "pymavlink": {"comms/mavlink.py", "comms/packing.py", "swarm_agent/autopilot/", "vehicle_sim/autopilot/"},
    "rerun": {"missions/recording/"},
    "numpy": {"missions/recording/", "missions/review/figures/", "missions/study/", "missions/train"},
    "torch": {"missions/train"},
    "numba": {"missions/study/"},
    "cryptography": {"missions/daemons/issue.py"},
}


def sources() -> list[Path]:
    return [path for room in MAY_IMPORT for path in sorted((ROOT / room).rglob("*.py"))]


def imported(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative imports hide the arrows"
            yield node.module or ""


def test_there_is_something_to_guard() -> None:
    assert {path.relative_to(ROOT).parts[0] for path in sources()} == set(MAY_IMPORT)


@pytest.mark.parametrize("path", sources(), ids=lambda path: str(path.relative_to(ROOT)))
def test_rooms_know_only_whom_they_may(path: Path) -> None:
    here = path.relative_to(ROOT)
    room = here.parts[0]
    for name in imported(path):
        top = name.partition(".")[0]
        if top in MAY_IMPORT and top != room:
            assert top in MAY_IMPORT[room], f"{here} imports {name}"
        if top in FENCES:
            allowed = any(str(here).startswith(place) for place in FENCES[top])
            assert allowed, f"{here} imports {name}, which is fenced"
        assert name != "pymavlink.mavutil", f"{here} imports mavutil, with its global state"
