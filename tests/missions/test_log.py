"""The event log of a launch with real vehicles: what is printed, and what is not."""

from __future__ import annotations

from io import StringIO

from rich.console import Console

from comms.status import Activity, AgentStatus, Event, Level
from missions.log import EventLog
from missions.observation import Observation, Phase

WORDS = (Event(Level.INFO, "follows T1"), Event(Level.WARNING, "[red] :smile: lost"))


def observation(time_s: float, activity: Activity, events: tuple[Event, ...]) -> Observation:
    status = AgentStatus(uid=3, activity=activity, events=events)
    return Observation(
        tick=0, time_s=time_s, phase=Phase.MISSION, statuses=(status,), truths=(), targets=(), links=(),
        events=(Event(Level.INFO, "the mission begins"),) if time_s == 1.0 else (),
    )  # fmt: skip


def test_everything_off_duty_and_what_matters_on_duty() -> None:
    out = StringIO()
    log = EventLog(Console(file=out, width=40))
    log.observe(observation(1.0, Activity.PREPARING, (Event(Level.INFO, "x" * 60),)))
    log.observe(observation(2.0, Activity.EXPLORE, (Event(Level.INFO, "the link is back"),)))
    log.observe(observation(3.0, Activity.FOLLOW, WORDS))
    assert out.getvalue().splitlines() == [
        "    1.0 s  mission: the mission begins",
        f"    1.0 s  A3: {'x' * 60}",
        "    2.0 s  A3: the link is back",
        "    3.0 s  A3: [red] :smile: lost",
    ]
