"""The launcher at the end of its world: who still flies is waited for, and told of; a person may end that."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from missions.daemons import launcher, processes
from missions.daemons.launcher import run_processes
from missions.daemons.processes import ProcessPlan
from missions.sides.phases import RETURN_LIMIT_S
from tests.missions.daemons.swarm import free_endpoint
from tests.patience import PATIENCE_S

WORLD_CODE = 3
AWAIT = f"""
import os, pathlib, signal, time
folder, deadline_s = pathlib.Path({{folder!r}}), time.monotonic() + {PATIENCE_S}
while not (folder / "told").exists() and time.monotonic() < deadline_s:
    time.sleep(0.01)
"""
LAND = AWAIT + '(folder / "landed").touch()'
# Two of a kind would be one.
HURRY = AWAIT + "[os.kill(os.getppid(), number) for number in (signal.SIGINT, signal.SIGTERM)]; time.sleep(600)"


class Watcher(StringIO):
    """A person who lets the agent go on as soon as the launcher has said that it is waited for."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._folder = folder

    def write(self, text: str) -> int:
        if "still under way: agent 0" in text:
            (self._folder / "told").touch()
        return super().write(text)


def launched(folder: Path, agent: str, monkeypatch: pytest.MonkeyPatch) -> int:
    """The exit code of a launch whose world ends at once, with this program for its only agent."""
    monkeypatch.setattr(launcher, "SAY_EVERY_S", 0.1)
    monkeypatch.setattr(processes, "COMMAND", (processes.COMMAND[0], "-c"))
    plans = (
        ProcessPlan(name="world", identity="world", words=(f"raise SystemExit({WORLD_CODE})",), vital=True),
        ProcessPlan(name="agent 0", identity="agent-0", words=(agent.format(folder=str(folder)),)),
    )
    return run_processes(plans, endpoint=free_endpoint(), console=Console(file=Watcher(folder)))


def test_agents_that_outlive_their_world_are_told_of_and_may_land(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert launched(tmp_path, LAND, monkeypatch) == WORLD_CODE
    assert (tmp_path / "landed").exists()
    assert launcher.LANDING_S > RETURN_LIMIT_S


def test_a_person_need_not_wait_for_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert launched(tmp_path, HURRY, monkeypatch) == 130
