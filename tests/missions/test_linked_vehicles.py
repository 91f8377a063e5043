"""Missions whose vehicles fly elsewhere, behind a transport."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Self

import pytest

from comms.clock import Lockstep
from comms.frames import geo_from_enu
from comms.mavlink import Endpoint
from comms.session import open_local_bus
from comms.signing import Signing
from comms.status import Activity
from comms.transport import Counts
from missions.cli import main
from missions.flight import Flight
from missions.load import load_mission
from missions.metrics import Metrics
from missions.mission import Mission
from missions.observation import Observation, Observer, Phase
from missions.overrides import Override
from missions.plan import plan_mission
from missions.report import Report, make_report
from missions.sides.phases import PERSONS_LIMIT_S
from tests.missions.test_pilot_flies_vehicle import mode_command
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


def fly(mission: Mission, pipes: dict[int, Pipe], *others: Observer) -> tuple[Flight, Log, Report]:
    log, metrics = Log(), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus, pipes)
        flight.run(pace=Lockstep(), observers=[metrics, log, *others], stop=lambda: False)
    return flight, log, make_report(flight.side, metrics, wall_s=1.0, recording=None)


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


class Gremlin:
    """An observer that does something once, at one tick of the mission."""

    def __init__(self, at_tick: int, what: Callable[[float], None]) -> None:
        self._at_tick, self._what = at_tick, what

    def observe(self, observation: Observation) -> None:
        if observation.mission_tick == self._at_tick:
            self._what(observation.time_s)


def activities(log: Log, uid: int) -> list[Activity]:
    """What an agent was doing, one after the other."""
    kinds = {Activity.EXPLORE, Activity.FOLLOW, Activity.CALLING, Activity.HELPING}
    found = ["on duty" if o.statuses[uid].activity in kinds else o.statuses[uid].activity.value for o in log.all]
    return [here for here, before in zip(found, ["", *found], strict=False) if here != before]


def test_a_vehicle_that_is_killed_and_switched_on_again_takes_up_its_mission() -> None:
    mission = mission_of("duration_s=60")
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}
    flight, log, report = fly(mission, pipes, Gremlin(100, pipes[0].switch_on))
    assert flight.complete
    assert activities(log, 0) == ["preparing", "on duty", "preparing", "on duty", "returning", "landed"]
    assert [(fault["agent"], fault["what"]) for fault in report["faults"]] == [(0, "the motors are off in flight")]
    assert "the autopilot has restarted: it is checked anew" in log.said(0)


def test_a_person_takes_a_vehicle_and_gives_it_back() -> None:
    mission = mission_of("duration_s=30")
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}
    taken = Gremlin(50, lambda _: pipes[1].station.send(mode_command(17, system_id=120)))
    given_back = Gremlin(150, lambda _: pipes[1].station.send(mode_command(4, system_id=120)))
    flight, log, report = fly(mission, pipes, taken, given_back)
    assert flight.complete
    again = ["preparing", "on duty"]  # the layer is looked at first
    assert activities(log, 1) == ["preparing", "on duty", "taken over", *again, "returning", "landed"]
    held = [o.statuses[1] for o in log.all if o.statuses[1].activity is Activity.TAKEN_OVER]
    assert {status.flight_mode for status in held} == {"BRAKE"}
    assert all(status.tags == () for status in held[1:])
    assert [(fault["agent"], fault["what"]) for fault in report["faults"]] == [(1, "leaves the mission: taken over")]


def test_a_link_that_breaks_for_a_while_is_told_and_flown_on() -> None:
    mission = mission_of("duration_s=40")
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}

    def plug(there: bool) -> Callable[[float], None]:
        return lambda _: setattr(pipes[0], "connected", there)

    flight, log, report = fly(mission, pipes, Gremlin(50, plug(False)), Gremlin(150, plug(True)))
    assert flight.complete
    assert activities(log, 0) == ["preparing", "on duty", "lost", "on duty", "returning", "landed"]
    assert [(fault["agent"], fault["what"]) for fault in report["faults"]] == [(0, "link lost: no heartbeat for 5 s")]


def test_a_link_that_stays_broken_does_not_hold_up_the_others() -> None:
    mission = mission_of()
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}
    flight, log, _ = fly(mission, pipes, Gremlin(50, lambda _: setattr(pipes[0], "connected", False)))
    assert flight.complete
    assert [status.activity for status in log.all[-1].statuses] == [Activity.LOST, Activity.LANDED]
    assert log.all[-1].time_s < 150.0


def test_nobody_watches_from_where_it_was_heard_last() -> None:
    mission = mission_of("targets.speed_m_s=0.1")
    pipes = {uid: Pipe(7 + uid, 5.0 - 10.0 * uid, mission) for uid in range(2)}

    def unplug(_: float) -> None:
        for pipe in pipes.values():
            pipe.connected = False

    _, log, _ = fly(mission, pipes, Gremlin(50, unplug))
    flown = [o for o in log.all if o.mission_tick is not None]
    lost = [all(status.activity is Activity.LOST for status in o.statuses) for o in flown]
    assert flown[lost.index(True) - 1].coverage == 1.0
    assert {o.coverage for o in flown[lost.index(True) + 1 :]} == {0.0}


def test_vehicles_that_persons_fly_at_the_end_are_left_to_them() -> None:
    mission = mission_of()
    pipes = {0: Pipe(7, 5.0, mission), 1: Pipe(120, -5.0, mission)}
    flight, log, report = fly(
        mission, pipes, Gremlin(100, lambda _: pipes[1].station.send(mode_command(17, system_id=120)))
    )
    assert flight.complete
    assert [status.activity for status in log.all[-1].statuses] == [Activity.LANDED, Activity.TAKEN_OVER]
    down_s = next(o.time_s for o in log.all if o.statuses[0].activity is Activity.LANDED)
    assert log.all[-1].time_s - down_s == pytest.approx(PERSONS_LIMIT_S, abs=1.0)
    assert report["faults"][-1]["what"] == "ends while a person flies A1"


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
    assert report["faults"][0]["what"] == "given up: no heartbeat from system 12 in 60 s"
    assert log.all[-1].statuses[0].activity is Activity.LOST
    assert not pipe.vehicle.truth.armed


class SignedPipe(Pipe):
    """A pipe whose vehicle hears and speaks on a signed link alone."""

    def __init__(self, system_id: int, east_m: float, mission: Mission, *, key: bytes) -> None:
        super().__init__(system_id, east_m, mission)
        self._channel = self.vehicle.open_channel(signing=Signing(key, unix_time=lambda: 1.8e9))

    def read(self, now_s: float) -> list[bytes]:
        wire, self._up = self._up, b""
        self._channel.hear(wire)
        self.vehicle.tick(now_s)
        return [self._channel.take()]


@pytest.mark.parametrize("right", [True, False])
def test_a_signed_link_is_flown_with_its_key_alone(right: bool, tmp_path: Path) -> None:
    key = tmp_path / "key"
    key.write_text("correct horse")
    key.chmod(0o600)
    mission = mission_of(f"vehicle.signing_key={key}", "vehicle.links=['tcp:127.0.0.1:1', null]", "duration_s=3")
    theirs = hashlib.sha256(b"correct horse" if right else b"battery staple").digest()
    flight, log, _ = fly(mission, {0: SignedPipe(7, 5.0, mission, key=theirs)})
    assert ("heartbeat of an ardupilot vehicle, system 7" in log.said(0)) is right
    refused = flight.agents[0].pilot.endpoint.signing
    assert refused is not None
    assert (refused.forged == 0) is right
    assert flight.agents[1].pilot.endpoint.signing is None  # simulated: no link to sign


@pytest.mark.parametrize(
    ("mode", "links", "allowed"),
    [
        (0o644, "['tcp:127.0.0.1:1', null]", "mode 0600, nobody but its owner may read a key"),
        (0o600, "[]", "null where no vehicle is behind a link"),
    ],
)
def test_a_key_must_be_secret_and_of_use(
    mode: int, links: str, allowed: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    key = tmp_path / "key"
    key.write_text("correct horse")
    key.chmod(mode)
    kind = "link" if links != "[]" else "simulated"
    vehicle = f"vehicle={{kind: {kind}, links: {links}, signing_key: {key}}}"
    assert main(["check", "quickstart", "--set", "agents.count=2", "--set", vehicle]) == 2
    assert "vehicle.signing_key: got" in (error := capsys.readouterr().err)
    assert allowed in error


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
