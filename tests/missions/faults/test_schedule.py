"""A mission's faults in time: in force from their tick to their end, together where they overlap, and nowhere else."""

from __future__ import annotations

from typing import Any

import pytest

from comms.disturbance import CALM, Trouble
from comms.status import Level
from missions.faults.schedule import WELL, Schedule
from missions.mission import Mission


def schedule(*faults: dict[str, Any], **others: Any) -> Schedule:
    return Schedule(Mission.model_validate({"name": "m", "faults": list(faults), **others}))


def ticks(found: Schedule, of: str) -> dict[int, list[int]]:
    """For every agent the ticks, of the first hundred, at which it is in that set."""
    told: dict[int, list[int]] = {}
    for tick in range(100):
        for uid in getattr(found.at(tick), of):
            told.setdefault(uid, []).append(tick)
    return told


def test_without_faults_and_before_the_mission_all_is_well() -> None:
    killed = schedule({"kind": "kill", "at_s": 0, "agents": [1]})
    assert killed.at(None) is WELL
    assert all(schedule().at(tick) is WELL for tick in (None, 0, 1, 10**9))
    assert killed.news(None) == ()


# at_s, for_s, tick_s -> first tick, and the first that is well again.
@pytest.mark.parametrize(
    ("at_s", "for_s", "tick_s", "first", "end"),
    [
        (0, 1, 0.1, 0, 10),
        (0.3, 0.6, 0.1, 3, 9),  # neither sum is exact
        (0.35, 0.1, 0.1, 4, 5),
        (1, 0.01, 0.1, 10, 11),  # at least a tick
        (2, 3, 1, 2, 5),
    ],
)
def test_a_fault_holds_from_the_first_tick_at_its_time_to_the_first_at_its_end(
    at_s: float, for_s: float, tick_s: float, first: int, end: int
) -> None:
    found = schedule({"kind": "freeze", "at_s": at_s, "for_s": for_s, "agents": [4]}, tick_s=tick_s)
    assert ticks(found, "frozen") == {4: list(range(first, end))}
    told = {tick: [(event.level, event.text) for event in found.news(tick)] for tick in range(100) if found.news(tick)}
    words = f"freeze: A4, for {for_s:g} s"
    assert told == {first: [(Level.WARNING, f"fault: {words}")], end: [(Level.INFO, f"over: {words}")]}


def test_who_is_killed_while_frozen_is_dead_and_a_death_without_end_is_one() -> None:
    found = schedule(
        {"kind": "freeze", "at_s": 1, "for_s": 5, "agents": [0, 1]},
        {"kind": "kill", "at_s": 3, "for_s": 1, "agents": [1]},
        {"kind": "kill", "at_s": 8, "agents": [1]},
    )
    assert ticks(found, "frozen") == {0: list(range(10, 60)), 1: [*range(10, 30), *range(40, 60)]}
    assert ticks(found, "dead") == {1: [*range(30, 40), *range(80, 100)]}
    assert found.comes_back(1, 35)
    assert not found.comes_back(1, 85)
    assert found.comes_back(0, 85)


def test_link_faults_overlap() -> None:
    found = schedule(
        {"kind": "loss", "at_s": 1, "for_s": 2, "share": 0.5},
        {"kind": "loss", "at_s": 2, "for_s": 2, "share": 0.2, "agents": [3]},
        {"kind": "partition", "at_s": 2, "for_s": 1, "groups": [[0, 1], [2]]},
        {"kind": "silence", "at_s": 5, "for_s": 1, "agents": [7]},
        {"kind": "bursts", "at_s": 7, "for_s": 1, "burst_s": 0.5},
    )
    both = found.at(25).links
    assert both.loss == (Trouble(0.5), Trouble(0.2, frozenset({3})))
    assert both.partitions == ({0: 0, 1: 0, 2: 1},)
    assert found.at(35).links.loss == (Trouble(0.2, frozenset({3})),)
    assert found.at(55).links.silent == {7}
    assert found.at(75).links.bursts == (Trouble(0.3, ticks=5),)
    assert found.at(45).links is CALM


def test_targets_are_mistaken_more_often_but_never_less() -> None:
    sensing = {"agents": {"sensing": {"identity_error": 0.2}, "count": 3}}
    found = schedule(
        {"kind": "identity", "at_s": 1, "for_s": 1, "identity_error": 0.1},
        {"kind": "identity", "at_s": 3, "for_s": 1, "identity_error": 0.5, "agents": [2]},
        **sensing,
    )
    assert found.at(15).identity_errors == {0: 0.2, 1: 0.2, 2: 0.2}
    assert found.at(35).identity_errors == {2: 0.5}


def test_what_is_broken_in_whose_vehicle() -> None:
    found = schedule(
        {"kind": "gps_glitch", "at_s": 1, "for_s": 3, "north_m": 111.32, "agents": [1]},
        {"kind": "wind", "at_s": 2, "for_s": 1, "speed_m_s": 6, "from_deg": 90, "gust_m_s": 1},
        {"kind": "reboot", "at_s": 5, "agents": [0]},
        {"kind": "battery_low", "at_s": 6, "charge": 1, "agents": [0]},
        agents={"count": 2},
    )
    assert found.at(15).breakage == {1: {"SIM_GPS_GLITCH_X": pytest.approx(0.001, rel=1e-3), "SIM_GPS_GLITCH_Y": 0}}
    wind = {"SIM_WIND_SPD": 6, "SIM_WIND_DIR": 90, "SIM_WIND_TURB": 1}
    assert found.at(25).breakage[0] == wind
    assert found.at(25).breakage[1].items() > wind.items()
    assert [tick for tick in range(100) if found.reboots(0, tick, since=tick - 1)] == [50]
    assert not any(found.reboots(1, tick, since=tick - 1) for tick in range(100))
    assert [tick for tick in range(0, 100, 4) if found.reboots(0, tick, since=tick - 4)] == [52]  # it was skipped
    assert found.at(70).breakage == {0: {"SIM_BATT_CAP_AH": 5.0, "SIM_BATT_VOLTAGE": 12.6}}


def wind(at_s: float, for_s: float | None, speed_m_s: float) -> dict[str, Any]:
    return {"kind": "wind", "at_s": at_s, "for_s": for_s, "speed_m_s": speed_m_s}


# The winds of a mission -> tick, speed of the wind there.
@pytest.mark.parametrize("listed_first", [0, 1], ids=["listed in time", "listed the other way round"])
@pytest.mark.parametrize(
    ("winds", "blows"),
    [
        ([wind(1, 6, 2), wind(3, 2, 9)], {9: None, 10: 2, 29: 2, 30: 9, 49: 9, 50: 2, 69: 2, 70: None}),
        ([wind(1, 3, 2), wind(3, 3, 9)], {29: 2, 30: 9, 39: 9, 40: 9, 59: 9, 60: None}),
        ([wind(1, None, 2), wind(3, 1, 9)], {29: 2, 30: 9, 40: 2, 99: 2}),
    ],
    ids=["one within the other", "one after the other", "one without an end"],
)
def test_of_two_faults_of_a_kind_the_one_that_begins_later_holds_while_it_lasts(
    winds: list[dict[str, Any]], blows: dict[int, float | None], listed_first: int
) -> None:
    found = schedule(*(reversed(winds) if listed_first else winds), agents={"count": 1})
    speeds = {tick: found.at(tick).breakage.get(0, {}).get("SIM_WIND_SPD") for tick in blows}
    assert speeds == blows


def test_of_two_that_begin_at_once_the_one_that_is_listed_later_holds() -> None:
    found = schedule(wind(1, 2, 9), wind(1, 4, 2), agents={"count": 1})
    assert [found.at(tick).breakage[0]["SIM_WIND_SPD"] for tick in (15, 35)] == [2, 2]
