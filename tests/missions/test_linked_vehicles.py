"""Missions whose vehicles fly elsewhere, behind a transport."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Self

import pytest

from comms.clock import Lockstep
from comms.frames import geo_from_enu
from comms.mavlink import Endpoint
from comms.session import open_local_bus
from comms.status import Activity
from comms.transport import Counts
from missions.cli import main
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation, Phase
from missions.overrides import Override
from missions.plan import plan_mission
from missions.report import Report, make_report
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import VehicleConfig

LINKS = "vehicle={kind: link, links: ['tcp:127.0.0.1:1', 'udpin:127.0.0.1:2'], boot_s: 0.5}"
SMALL = ("agents={count: 2, altitude: {base_m: 4}}", "targets={count: 2, deployment: {radius_m: 6}}", "duration_s=15")


class Pipe:
    """A transport in memory to a vehicle that lives as its reader's clock does."""

    def __init__(self, system_id: int, east_m: float, mission: Mission) -> None:
        self.url, self.counts, self.connected = "pipe", Counts(), True
        self._system_id, self._home = system_id, geo_from_enu(mission.home.place, (east_m, 3.0, 0.0))
        self._up = b""
        self.station = Endpoint(system_id=255, component_id=190)  # a ground station beside the agent
        self.switch_on(0.0)

    def switch_on(self, now_s: float) -> None:
        """A vehicle that boots now, on its pad, whatever was there before."""
        self._on_since_s = now_s
        self.vehicle = SimulatedVehicle(
            config=VehicleConfig(boot_s=0.5), system_id=self._system_id, home=self._home, started_at_s=0.0
        )

    def read(self, now_s: float) -> list[bytes]:
        wire, self._up = self._up + self.station.take(), b""
        said = self.vehicle.tick(now_s - self._on_since_s, wire if self.connected else b"")
        return [said] if self.connected else []

    def write(self, data: bytes) -> None:
        self._up += data

    def close(self) -> None:
        self.connected = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Log:
    """An observer that keeps everything."""

    def __init__(self) -> None:
        self.all: list[Observation] = []

    def observe(self, observation: Observation) -> None:
        self.all.append(observation)

    def said(self, uid: int) -> list[str]:
        return [event.text for o in self.all for event in o.statuses[uid].events]


def mission_of(*changes: str) -> Mission:
    return load_mission("quickstart", overrides=[Override(text) for text in (*SMALL, LINKS, *changes)])


def fly(mission: Mission, pipes: dict[int, Pipe]) -> tuple[Flight, Log, Report]:
    log, metrics = Log(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus, pipes)
        flight.run(pace=Lockstep(), observers=[metrics, log], stop=lambda: False)
    return flight, log, make_report(flight, metrics, wall_s=1.0, recording=None)


def test_vehicles_elsewhere_fly_the_mission_from_where_they_stand() -> None:
    mission = mission_of()
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}
    flight, log, report = fly(mission, pipes)
    assert flight.complete
    assert report["faults"] == []
    assert report["coverage"] > 0.5
    assert {status.activity for status in log.all[-1].statuses} == {Activity.LANDED}
    first = next(o for o in log.all if o.phase is Phase.MISSION)
    assert first.truths[0].position_m == pytest.approx((5.0, 3.0, 4.0), abs=0.6)
    assert first.truths[1].position_m == pytest.approx((-5.0, 3.0, 6.0), abs=0.6)
    assert "heartbeat of an ardupilot vehicle, system 7" in log.said(0)
    assert "heartbeat of an ardupilot vehicle, system 120" in log.said(1)


def test_some_vehicles_may_be_simulated() -> None:
    mission = mission_of("vehicle.links=['tcp:127.0.0.1:1', null]")
    flight, _, report = fly(mission, {0: Pipe(9, 5.0, mission)})
    assert flight.complete
    assert report["faults"] == []
    assert isinstance(flight.vehicles[1], SimulatedVehicle)


def test_another_vehicle_than_the_one_named_is_left_alone() -> None:
    mission = mission_of("vehicle.links=['tcp:127.0.0.1:1', null]", "vehicle.system_ids=[12, null]")
    pipe = Pipe(7, 5.0, mission)
    _, log, report = fly(mission, {0: pipe})
    assert report["faults"][0]["what"] == "leaves the mission: lost"
    assert log.all[-1].statuses[0].activity is Activity.LOST
    assert not pipe.vehicle.truth.armed


def test_the_plan_says_how_they_are_reached() -> None:
    plan = plan_mission(mission_of("vehicle.links=['tcp:127.0.0.1:5760', null]"))
    assert [(agent.system_id, agent.link) for agent in plan.agents] == [(None, "tcp:127.0.0.1:5760"), (2, None)]
    plan = plan_mission(mission_of("vehicle.system_ids=[null, 7]"))
    assert [agent.system_id for agent in plan.agents] == [None, 7]


@pytest.mark.parametrize("speed", ["max", "2"])
def test_real_time_cannot_be_hurried(speed: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changes = [word for text in (*SMALL, LINKS) for word in ("--set", text)]
    assert main(["launch", "quickstart", *changes, "--speed", speed]) == 2
    assert capsys.readouterr().err == (
        f"--speed: got {speed}; allowed: 1: the vehicles behind vehicle.links fly in real time\n"
    )


def test_a_link_that_cannot_be_opened_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    links = "vehicle={kind: link, links: ['serial:/dev/nothing:57600', null]}"
    changes = [word for text in (*SMALL, links) for word in ("--set", text)]
    assert main(["launch", "quickstart", *changes]) == 2
    error = capsys.readouterr().err
    assert error.startswith("vehicle.links: serial:/dev/nothing:57600: ")
    assert "Traceback" not in error
