"""Missions in which things go wrong, flown: the swarm goes on, and who is right again rejoins."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from comms.status import OFF_DUTY, Activity, AgentStatus
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.observation import Observation, Phase
from missions.overrides import Override
from missions.report import Report, make_report

SMALL = ("agents.count=4", "targets.count=4", "vehicle.boot_s=0.5", "agents.altitude.base_m=4", "duration_s=40")
TICKS_PER_S = 10


class Notes:
    """An observer that keeps what is seen in MISSION, and what was said at all."""

    def __init__(self) -> None:
        self.on_duty: list[Observation] = []
        self.said: list[str] = []
        self.last: tuple[AgentStatus, ...] = ()

    def observe(self, observation: Observation) -> None:
        if observation.phase is Phase.MISSION:
            self.on_duty.append(observation)
        self.said += [event.text for event in observation.events]
        self.said += [event.text for status in observation.statuses for event in status.events]
        self.last = observation.statuses

    def of(self, uid: int) -> list[AgentStatus]:
        return [observation.statuses[uid] for observation in self.on_duty]

    def at(self, time_s: float) -> Observation:
        return self.on_duty[round(time_s * TICKS_PER_S)]


@cache
def fly(faults: str, *changes: str, name: str = "narrow") -> tuple[Notes, Report]:
    texts = [*SMALL, *changes, f"faults={faults}"]
    mission = load_mission(name, overrides=[Override(text) for text in texts])
    notes, metrics = Notes(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[notes, metrics], stop=lambda: False)
    return notes, make_report(flight.side, metrics, wall_s=1.0, recording=None)


def playing(statuses: Sequence[AgentStatus]) -> list[bool]:
    return [status.activity not in OFF_DUTY for status in statuses]


KILL = "[{kind: kill, at_s: 5, for_s: 10, agents: [1]}]"


class TestAKilledAgent:
    def test_is_gone_at_its_tick_and_back_within_seconds_of_its_restart(self) -> None:
        notes, _ = fly(KILL)
        plays = playing(notes.of(1))
        assert all(plays[:50])
        assert not any(plays[50:150])
        assert all(plays[200:])
        assert all(all(playing(notes.of(uid))) for uid in (0, 2, 3))

    def test_is_heard_by_its_mates_again(self) -> None:
        notes, _ = fly(KILL)
        assert 1 in notes.at(4.0).statuses[0].mates
        assert not any(1 in status.mates for status in notes.of(0)[60:150])
        assert any(1 in status.mates for status in notes.of(0)[200:])

    def test_leaves_its_targets_to_its_mates_within_a_lease(self) -> None:
        # Two agents over one target: who is left takes it as soon as the other's claim has run out (0.5 s).
        duel = ("agents.count=2", "targets={motion: static, count: 1, deployment: {radius_m: 1}}",
                "agents.deployment={radius_m: 3, spacing_m: 1}", "duration_s=12")  # fmt: skip
        tags = [status.tags for status in fly("[]", *duel)[0].at(7.9).statuses]
        owner = tags.index((0,))
        assert tags[1 - owner] == ()
        notes, _ = fly(f"[{{kind: kill, at_s: 8, agents: [{owner}]}}]", *duel)
        assert notes.at(7.9).statuses[owner].tags == (0,)
        assert notes.at(8.7).statuses[1 - owner].tags == (0,)

    def test_without_a_restart_is_not_waited_for(self) -> None:
        notes, report = fly("[{kind: kill, at_s: 5, agents: [1, 2]}]")
        assert report["duration_s"] == 40.0
        assert [status.activity for status in notes.last] == [
            Activity.LANDED,
            Activity.LOST,
            Activity.LOST,
            Activity.LANDED,
        ]
        left = "its vehicle is left in the air: nobody flies it"
        assert [fault["agent"] for fault in report["faults"] if fault["what"] == left] == [1, 2]

    def test_that_begins_anew_after_the_mission_is_brought_home_all_the_same(self) -> None:
        notes, _ = fly("[{kind: kill, at_s: 38, for_s: 4, agents: [2]}]")
        assert {status.activity for status in notes.last} == {Activity.LANDED}


def test_who_was_frozen_goes_on_where_it_was() -> None:
    notes, report = fly("[{kind: freeze, at_s: 5, for_s: 10, agents: [1]}]")
    plays = playing(notes.of(1))
    assert not any(plays[50:150])
    assert all(plays[160:])
    assert "no setpoint for 10.1 s: the vehicle stops after 3 s" in notes.said
    assert report["mavlink"]["bad"] == report["mavlink"]["dropped"] == 0


def test_an_autopilot_that_lost_its_power_takes_off_again() -> None:
    notes, _ = fly("[{kind: reboot, at_s: 5, agents: [1]}]")
    assert "the autopilot has restarted: it is checked anew" in notes.said
    assert min(observation.truths[1].position_m[2] for observation in notes.on_duty[50:100]) < 0.1
    assert playing(notes.of(1))[-1]
    assert notes.on_duty[-1].truths[1].position_m[2] == pytest.approx(6.0, abs=0.6)


@pytest.mark.parametrize(
    ("fault", "silent"),
    [
        ("kind: partition, groups: [[0, 1], [2, 3]]", {(0, 2), (0, 3), (1, 2), (1, 3)}),
        ("kind: silence, agents: [3]", {(0, 3), (1, 3), (2, 3)}),
        ("kind: loss, share: 1, agents: [3]", {(0, 3), (1, 3), (2, 3)}),
    ],
)
def test_links_that_are_cut_are_heard_again(fault: str, silent: set[tuple[int, int]]) -> None:
    notes, _ = fly(f"[{{{fault}, at_s: 5, for_s: 10}}]")
    everybody = {(low, high) for high in range(4) for low in range(high)}
    assert set(notes.at(4.0).links) == everybody
    for time_s in (5.2, 10.0, 14.8):
        assert set(notes.at(time_s).links) == everybody - silent
    assert set(notes.at(15.5).links) == everybody


def test_losses_are_counted() -> None:
    _, report = fly("[{kind: loss, at_s: 10, for_s: 20, share: 0.4}]")
    radio = report["radio"]
    assert radio["lost"] / (radio["lost"] + radio["delivered"]) == pytest.approx(0.4 * 20 / 40, abs=0.02)


def test_late_frames_are_heard_late_and_once() -> None:
    _, report = fly("[{kind: latency, at_s: 10, for_s: 10, latency_s: 0.2}]")
    radio = report["radio"]
    assert radio["delivered"] + radio["out_of_range"] == 4 * 3 * 400
    assert report["coverage"] > 0.9


def test_wind_comes_and_goes() -> None:
    notes, _ = fly("[{kind: wind, at_s: 5, for_s: 10, speed_m_s: 8, from_deg: 0, agents: [0]}]")
    assert all(playing(notes.of(0)))
    places = [observation.truths[0].position_m for observation in notes.on_duty]
    others = fly("[]")[0].on_duty
    assert places[:50] == [observation.truths[0].position_m for observation in others[:50]]
    assert places[60] != others[60].truths[0].position_m


def test_the_same_seed_has_the_same_faults() -> None:
    bursts = "[{kind: bursts, at_s: 5, for_s: 20}, {kind: kill, at_s: 6, for_s: 4, agents: [0]}]"
    first, again = fly(bursts)[1], fly.__wrapped__(bursts)[1]

    def told(report: Report) -> dict[str, Any]:
        return {key: value for key, value in report.items() if key != "timing"}

    assert told(first) == told(again)
    assert told(fly(bursts, "seed=2")[1]) != told(first)
