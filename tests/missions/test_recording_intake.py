"""Observations that come too fast: ticks may be dropped, words never."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from msgspec import structs

from comms.status import Event, Level
from missions.observation import Observation
from missions.recording.intake import Intake
from tests.missions.toy_observations import toy_observations, toy_scene

TICKS = 12


@pytest.fixture(scope="module")
def talkative() -> Sequence[Observation]:
    """In every tick the mission and agent 1 say which tick it is."""
    told = []
    for seen in toy_observations(toy_scene(n_agents=3), ticks=TICKS):
        word = (Event(Level.ERROR, f"tick {seen.tick}"),)
        statuses = [structs.replace(status, events=word if status.uid == 1 else ()) for status in seen.statuses]
        told.append(replace(seen, statuses=tuple(statuses), events=word))
    return told


def _taken(intake: Intake) -> list[Observation]:
    found = []
    while (observation := intake.take()) is not None:
        found.append(observation)
    return found


def _words(observations: Sequence[Observation], uid: int | None) -> list[str]:
    return [
        event.text for seen in observations for event in (seen.events if uid is None else seen.statuses[uid].events)
    ]


@pytest.mark.parametrize("at_once", [3, 5, TICKS])
def test_every_word_is_kept_in_its_order_and_the_last_tick_too(talkative: Sequence[Observation], at_once: int) -> None:
    intake, kept = Intake(4, lossless=False), list[Observation]()
    for first in range(0, TICKS, at_once):
        for observation in talkative[first : first + at_once]:
            intake.put(observation)
        for _ in range(min(2, at_once)):
            observation = intake.take()
            assert observation is not None
            kept.append(observation)
    intake.end()
    kept += _taken(intake)
    assert len(kept) + intake.dropped == TICKS
    assert kept[-1].tick == TICKS - 1
    ticks = [f"tick {tick}" for tick in range(TICKS)]
    assert _words(kept, None) == _words(kept, 1) == ticks
    assert _words(kept, 0) == []


def test_nothing_is_dropped_where_one_may_wait(talkative: Sequence[Observation]) -> None:
    intake = Intake(TICKS + 1, lossless=True)
    for observation in talkative:
        intake.put(observation)
    intake.end()
    assert _taken(intake) == list(talkative)
    assert intake.dropped == 0
