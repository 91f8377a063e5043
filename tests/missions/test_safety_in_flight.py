"""Fence, separation and battery in whole missions, judged by where the vehicles really are."""

from __future__ import annotations

from itertools import combinations
from math import hypot

import pytest

from comms.clock import Lockstep
from comms.session import open_local_bus
from comms.status import Activity
from missions import compose
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation
from missions.overrides import Override
from swarm_agent.fence import encloses

QUICK = ("vehicle.boot_s=0.5", "agents.altitude.base_m=4")
BENT = "{shape: polygon, corners_m: [[18, 18], [-18, 18], [-18, -40], [8, -40], [8, -10], [18, -10]]}"


class Kept:
    """An observer that keeps the ticks of the mission proper."""

    def __init__(self) -> None:
        self.ticks: list[Observation] = []

    def observe(self, observation: Observation) -> None:
        if observation.mission_tick is not None:
            self.ticks.append(observation)


def fly(*changes: str) -> tuple[Mission, Kept, Metrics]:
    mission = load_mission("quickstart", overrides=[Override(text) for text in (*QUICK, *changes)])
    kept, metrics = Kept(), Metrics()
    with open_local_bus() as bus:
        Flight(mission, bus).run(pace=Lockstep(), observers=[kept, metrics], stop=lambda: False)
    return mission, kept, metrics


def nearest_m(observation: Observation) -> float:
    places = [truth.position_m for truth in observation.truths]
    return min(hypot(a[0] - b[0], a[1] - b[1]) for a, b in combinations(places, 2))


def test_agents_that_share_a_layer_keep_apart() -> None:
    drones = "agents={count: 8, speed_m_s: 2, altitude: {base_m: 4, layers: 1}, deployment: {spacing_m: 2.5}}"
    changes = ("arena.radius_m=15", "targets={motion: random, speed_m_s: 1.5, count: 3}", "duration_s=60")
    _, kept, metrics = fly(drones, *changes)
    assert metrics.faults == []
    assert min(map(nearest_m, kept.ticks)) > 1.2
    _, kept, metrics = fly(drones, *changes, "safety.separation_m=0")
    assert min(map(nearest_m, kept.ticks)) < 0.8
    assert any("came within 1 m" in fault.what for fault in metrics.faults)


@pytest.mark.parametrize(
    ("fence", "flavor"), [("{shape: circle, radius_m: 18}", "ardupilot"), (BENT, "px4")], ids=["ardupilot", "px4"]
)
def test_nobody_leaves_the_fence_though_targets_do(fence: str, flavor: str) -> None:
    wish = ("agents.count=4", "agents.speed_m_s=5", "targets={motion: random, speed_m_s: 4, count: 4}", "duration_s=60")
    mission, kept, metrics = fly(
        *wish, f"safety.fence={fence}", f"vehicle.flavor={flavor}", "vehicle.wind={speed_m_s: 3, gust_m_s: 1}"
    )
    corners = compose.fence(mission).corners_m
    targets = [target for tick in kept.ticks for target in tick.targets]
    assert any(not encloses(corners, target.x_m, target.y_m) for target in targets)
    assert all(encloses(corners, *truth.position_m[:2]) for tick in kept.ticks for truth in tick.truths)
    assert metrics.faults == []


def test_an_agent_whose_battery_is_at_its_reserve_lets_go_and_comes_home() -> None:
    changes = ("agents.count=3", "duration_s=30", "safety.battery_reserve=0.9", "vehicle.battery.capacity_mah=2000")
    _, kept, metrics = fly(*changes)
    homing = [s for tick in kept.ticks for s in tick.statuses if s.activity is Activity.RETURNING]
    assert homing
    assert all(status.tags == () and status.helping is None for status in homing)
    told = [fault.what for fault in metrics.faults if fault.what.startswith("battery")]
    assert told == ["battery at 90%: coming home"] * 3


@pytest.mark.parametrize("flavor", ["ardupilot", "px4"])
def test_whose_battery_is_nearly_empty_calls_for_its_targets_and_lands_before_it_falls(flavor: str) -> None:
    changes = ("agents={count: 3, deployment: {radius_m: 6}}", "seed=2", "duration_s=70", "policy.call=predicted")
    targets = "targets={motion: static, count: 4, deployment: {radius_m: 6}}"
    fault = "faults=[{kind: battery_low, at_s: 5, agents: [0], charge: 0.1}]"
    _, kept, metrics = fly(*changes, targets, fault, f"vehicle.flavor={flavor}")
    [number] = [
        number
        for number, tick in enumerate(kept.ticks)
        if tick.statuses[0].activity is Activity.RETURNING
        and kept.ticks[number - 1].statuses[0].activity is not Activity.RETURNING
    ]
    left, goes, last = kept.ticks[number - 1].statuses[0].tags, kept.ticks[number].statuses[0], kept.ticks[-1]
    assert goes.tags == ()
    assert goes.calls
    assert {call.target for call in goes.calls} <= set(left)
    assert last.statuses[0].activity is Activity.LANDED
    assert set(left) <= {target for mate in last.statuses[1:] for target in mate.tags}
    assert [fault.what.partition(" at ")[0] for fault in metrics.faults] == ["battery", "leaves the mission: landed"]
    assert min(tick.truths[0].velocity_m_s[2] for tick in kept.ticks) > -3.0  # what falls is faster


def test_the_fence_of_an_arena_leaves_room_to_stop() -> None:
    disc = load_mission("quickstart", overrides=[Override("safety.fence.margin_m=7")])
    assert compose.fence(disc).core_m == pytest.approx(37.0, rel=0.002)
    arena = "arena={shape: rectangle, width_m: 80, height_m: 50}"
    wide = load_mission("quickstart", overrides=[Override(arena), Override("agents.speed_m_s=7")])
    stop_m = 7.0 + 49.0 / 1.75
    assert compose.fence(wide).corners_m[0] == pytest.approx((50.0 + stop_m, 35.0 + stop_m))
