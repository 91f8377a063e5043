"""Cues of now and of the past, and an agent's own clock while none comes."""

from __future__ import annotations

from math import inf

import pytest

from missions.daemons.contact import DRIFT, SILENT_S, STALE_S, Contact
from missions.sides.exchange import Cue

PERIOD_S = 0.1


def met(*, at_s: float, tick: int = 100) -> Contact:
    contact = Contact(period_s=PERIOD_S)
    cue = Cue(tick=tick, mission_tick=tick - 50, fault_tick=tick - 40)
    assert not contact.is_stale(cue, at_s)
    contact.hear(cue, at_s)
    return contact


@pytest.mark.parametrize(("under_way_s", "stale"), [(0.0, False), (0.4, False), (0.6, True), (13.0, True)])
def test_a_cue_is_of_the_past_when_it_was_under_way_for_long(under_way_s: float, stale: bool) -> None:
    contact = met(at_s=1000.0)
    assert contact.is_stale(Cue(tick=110), 1001.0 + under_way_s) is stale


def test_a_world_that_is_late_says_so_and_is_believed() -> None:
    contact = met(at_s=1000.0)
    assert not contact.is_stale(Cue(tick=110, late_s=4.0), 1005.0)
    assert contact.is_stale(Cue(tick=111, late_s=4.0), 1005.7)


def test_the_offset_of_clocks_does_not_matter_and_their_drift_is_followed() -> None:
    """A computer whose clock is quicker than the world's, by as much as quartz never is, believes it for an hour."""
    contact = met(at_s=7.0, tick=0)
    for tick in range(0, 36_000, 10):
        assert not contact.is_stale(Cue(tick=tick), 7.0 + tick * PERIOD_S * (1.0 + 0.9 * DRIFT))


def test_late_cues_do_not_become_the_measure() -> None:
    contact = met(at_s=1000.0)
    held_up = [contact.is_stale(Cue(tick=100 + n), 1000.0 + n * PERIOD_S + 2 * STALE_S) for n in range(1, 200)]
    assert all(held_up)


def test_an_agent_goes_on_alone_after_a_silence_and_makes_up_for_it() -> None:
    contact = met(at_s=1000.0)
    assert contact.alone(101, 1000.0 + SILENT_S - 0.01) is None
    silent_ticks = round(SILENT_S / PERIOD_S)
    for tick in range(101, 101 + silent_ticks):
        assert contact.alone(tick, 1000.0 + SILENT_S + 0.001) is not None
    assert contact.alone(101 + silent_ticks, 1000.0 + SILENT_S + 0.001) is None
    assert contact.due_s(110) == pytest.approx(1001.0)


def test_alone_it_holds_still_and_its_clocks_go_on() -> None:
    cue = met(at_s=1000.0).alone(120, 1002.1)
    assert cue is not None
    assert (cue.tick, cue.mission_tick, cue.fault_tick) == (120, 70, 80)
    assert cue.hold
    assert not cue.come_home
    assert cue.sightings == ()
    assert cue.frames is None


@pytest.mark.parametrize("has_own_radio", [False, True])
def test_alone_it_speaks_to_those_alone_who_hear_it_without_the_world(has_own_radio: bool) -> None:
    contact = Contact(period_s=PERIOD_S, has_own_radio=has_own_radio)
    contact.hear(Cue(tick=5), 3.0)
    cue = contact.alone(20, 5.0)
    assert cue is not None
    assert cue.silent is not has_own_radio


def test_who_comes_home_goes_on_coming_home() -> None:
    contact = Contact(period_s=PERIOD_S)
    contact.hear(Cue(tick=5, come_home=True), 3.0)
    cue = contact.alone(20, 5.0)
    assert cue is not None
    assert cue.come_home


def test_an_agent_that_was_never_cued_waits() -> None:
    contact = Contact(period_s=PERIOD_S)
    assert contact.due_s(0) == inf
    assert contact.alone(0, 1e9) is None


def test_in_lockstep_time_waits_and_what_was_missed_is_made_up_for() -> None:
    contact = Contact(period_s=None)
    contact.hear(Cue(tick=100, mission_tick=50), 1000.0)
    assert contact.due_s(101) == inf
    assert not contact.is_stale(Cue(tick=101), 2000.0)
    missed = list(contact.missed(101, Cue(tick=104)))
    assert [(cue.tick, cue.mission_tick) for cue in missed] == [(101, 51), (102, 52), (103, 53)]
    assert all(cue.hold and cue.silent for cue in missed)


def test_who_comes_back_to_a_mission_begins_with_its_cue() -> None:
    assert not list(Contact(period_s=None).missed(0, Cue(tick=104)))
    assert not list(met(at_s=1000.0).missed(101, Cue(tick=104)))  # in real time it has gone on alone
