"""When a fault was noticed, by which sign, and what it cost in coverage: hand-made missions of one tick a second."""

from __future__ import annotations

from typing import Any

import pytest

from comms.status import Activity, AgentStatus, Event, Level
from missions.coverage import Coverage
from missions.faults.costs import Costs
from missions.faults.detection import SIGNS
from missions.mission import Mission
from missions.mission.faults import KINDS
from missions.observation import Observation, Phase

SILENT = "no word from A{} for 1 s, though it was near"
HALVES = [[0, 1], [2, 3, 4]]
POOR = "reception is poor: 30% of mates' frames lost, 0.1 s old"


def told(
    fault: dict[str, Any], said: dict[tuple[int, int], str], *, seen: list[int], level: Level = Level.WARNING
) -> dict[str, Any]:
    """What is told of a fault when, by (tick, agent), this was said, and so many of ten targets were seen."""
    faults = Mission.model_validate({"name": "m", "tick_s": 1, "faults": [fault]}).faults
    costs, coverage = Costs(faults, tick_s=1.0), Coverage()
    for tick, count in enumerate(seen):
        coverage.add(seen=count, present=10)
        statuses = tuple(
            AgentStatus(
                uid=uid,
                activity=Activity.EXPLORE,
                events=(Event(level, said[tick, uid]),) if (tick, uid) in said else (),
            )
            for uid in range(5)
        )
        costs.observe(
            Observation(
                tick=tick + 7,
                time_s=tick + 7.0,
                phase=Phase.MISSION,
                statuses=statuses,
                truths=(),
                targets=(),
                mission_tick=tick,
            )
        )
    (one,) = costs.told(coverage)
    return one


def noticed(fault: dict[str, Any], said: dict[tuple[int, int], str], **others: Any) -> tuple[Any, Any]:
    found = told(fault, said, seen=[10] * 200, **others)
    return found["noticed_after_s"], found["noticed_by"]


def test_every_kind_has_a_sign() -> None:
    assert set(SIGNS) == set(KINDS)


# fault, what is said when and by whom, who notices it when.
CASES: list[tuple[dict[str, Any], dict[tuple[int, int], str], tuple[Any, Any]]] = [
    ({"kind": "kill", "agents": [3]}, {(52, 1): SILENT.format(3)}, (2, 1)),
    ({"kind": "kill", "agents": [3]}, {(52, 1): SILENT.format(2), (60, 0): SILENT.format(3)}, (10, 0)),
    ({"kind": "freeze", "agents": [1, 2]}, {(55, 0): SILENT.format(2)}, (5, 0)),
    ({"kind": "freeze", "agents": [1]}, {(49, 0): SILENT.format(1)}, (None, None)),  # before it happened
    ({"kind": "freeze", "agents": [1], "for_s": 10}, {(64, 0): SILENT.format(1)}, (14, 0)),
    ({"kind": "freeze", "agents": [1], "for_s": 10}, {(65, 0): SILENT.format(1)}, (None, None)),  # long after
    ({"kind": "silence", "agents": [1]}, {(53, 1): SILENT.format(4)}, (3, 1)),
    ({"kind": "partition", "groups": HALVES}, {(52, 0): SILENT.format(1), (53, 4): SILENT.format(0)}, (3, 4)),
    ({"kind": "loss"}, {(54, 2): POOR}, (4, 2)),
    ({"kind": "loss", "agents": [1]}, {(54, 2): POOR, (56, 1): POOR}, (6, 1)),
    ({"kind": "latency"}, {(54, 2): SILENT.format(0)}, (4, 2)),
    ({"kind": "gps_lost", "agents": [4]}, {(51, 4): "has lost T3", (58, 4): "EKF variance"}, (8, 4)),
    ({"kind": "gps_lost", "agents": [4]}, {(58, 3): "EKF variance"}, (None, None)),
    ({"kind": "reboot", "agents": [0]}, {(50, 0): POOR, (53, 0): "the motors are off in flight"}, (3, 0)),
    ({"kind": "identity"}, {(51, 0): "anything"}, (None, None)),
]  # fmt: skip


@pytest.mark.parametrize(("fault", "said", "found"), CASES)
def test_noticed(fault: dict[str, Any], said: dict[tuple[int, int], str], found: tuple[Any, Any]) -> None:
    assert noticed({**fault, "at_s": 50}, said) == found


# Of a vehicle's faults: what is said of them first, in flights of either flavor.
SAID = [
    ("gps_lost", "EKF3 lane switch 1"),
    ("gps_lost", "Failsafe activated"),  # PX4
    ("gps_lost", "no position for 1.5 s: holding still"),
    ("gps_glitch", "GPS Glitch or Compass error"),
    ("reboot", "the motors are off in flight"),
    ("reboot", "telemetry has fallen silent: asking for it again"),
    ("reboot", "the autopilot has restarted: it is checked anew"),  # PX4
    ("battery_low", "battery at 10.7 V: coming home"),
    ("battery_low", "Battery 1 is low 10.50V used 3000 mAh"),
    ("battery_low", "Critical battery level, land now"),  # PX4
    ("wind", "0.1 m outside its fence: coming back"),
]
GPS = ("gps_lost", "gps_glitch")
# What is said of the very agent, and not of its vehicle: by the world, of the world, of targets and mates, by people.
FOREIGN = [
    "its process has died, or its link is cut",
    "no answer for 10 s: lost",
    "its process is back",
    "no word from the world: holds still, for 30 s at most",
    "has lost T3: out of sight",
    SILENT.format(3),
    POOR,
    "Glitch cleared",
    "EKF Failsafe Cleared",
]


@pytest.mark.parametrize("kind", ["gps_lost", "gps_glitch", "reboot", "battery_low", "wind"])
def test_a_vehicles_fault_is_noticed_by_words_of_its_own_and_by_no_others(kind: str) -> None:
    for of, text in [*SAID, *(("", text) for text in FOREIGN)]:
        tells = of == kind or (of in GPS and kind in GPS)
        found = noticed({"kind": kind, "agents": [2], "at_s": 50}, {(55, 2): text})
        assert found == ((5, 2) if tells else (None, None)), text


def test_mere_information_is_no_sign() -> None:
    assert noticed({"kind": "kill", "agents": [3], "at_s": 5}, {(7, 1): SILENT.format(3)}, level=Level.INFO)[0] is None


def test_coverage_before_meanwhile_and_afterwards() -> None:
    seen = [10] * 20 + [8] * 30 + [4] * 10 + [6] * 30 + [9] * 50  # the fault lasts from 50 s to 60 s
    found = told({"kind": "freeze", "agents": [1], "at_s": 50, "for_s": 10}, {}, seen=seen)
    assert found["coverage"] == {"before": 0.8, "during": 0.4, "after": 0.6}
    assert (found["at_s"], found["until_s"]) == (50.0, 60.0)


@pytest.mark.parametrize("fault", [{"kind": "kill", "agents": [1]}, {"kind": "reboot", "agents": [1]}])
def test_what_has_no_end_is_told_for_half_a_minute(fault: dict[str, Any]) -> None:
    seen = [10] * 50 + [5] * 30 + [7] * 30 + [0] * 30
    found = told({**fault, "at_s": 50}, {}, seen=seen)
    assert found["coverage"] == {"before": 1.0, "during": 0.5, "after": 0.7}
    assert found["until_s"] is None


@pytest.mark.parametrize(
    ("at_s", "coverage"),
    [
        (0, {"before": None, "during": 0.5, "after": None}),
        (20, {"before": 0.5, "during": 0.5, "after": None}),
        (99, {"before": None, "during": None, "after": None}),
    ],
)
def test_what_was_not_flown_is_not_told(at_s: int, coverage: dict[str, Any]) -> None:
    assert told({"kind": "kill", "agents": [1], "at_s": at_s}, {}, seen=[5] * 30)["coverage"] == coverage
