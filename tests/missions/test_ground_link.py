"""A swarm on one port: who is addressed hears and answers, everybody is seen, and nobody flies otherwise for it."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.clock import Lockstep
from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from comms.session import open_local_bus
from comms.signing import Signing
from comms.transport import Transport, TransportError, transport_of
from missions.cli import main
from missions.exit_codes import BAD_INPUT
from missions.flight import Flight
from missions.ground_link import GroundLink, open_ground_link
from missions.load import load_mission
from missions.metrics import Metrics
from missions.observation import Observer
from missions.options import LaunchOptions
from missions.overrides import Override
from missions.report import make_report
from tests.patience import until
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import VehicleConfig

HOME = GeoPoint(47.397742, 8.545594, 488.1)
N_VEHICLES = 3


class Watched:
    """Some vehicles on one port, and a ground station there."""

    def __init__(self, link: GroundLink, vehicles: list[SimulatedVehicle], ground: Transport) -> None:
        self.link, self.vehicles, self.ground = link, vehicles, ground
        self.ours = Endpoint(system_id=255, component_id=190)
        self.now_s = 0.0

    def send(self, *messages: Any) -> None:
        for message in messages:
            self.ours.send(message)
        self.ground.write(self.ours.take())

    def tick(self) -> list[Any]:
        self.now_s += 0.1
        self.link.hear()
        for vehicle in self.vehicles:
            vehicle.tick(self.now_s)
        self.link.say()
        return [message for chunk in self.ground.read(self.now_s) for message in self.ours.receive(chunk)]

    def wait_for(self, kind: str, count: int) -> list[Any]:
        """The next messages of this kind, `count` or more."""
        got: list[Any] = []

        def enough() -> bool:
            got.extend(message for message in self.tick() if message.get_type() == kind)
            return len(got) >= count

        until(enough)
        return got


@pytest.fixture(params=[("udpin", "udpout"), ("tcpin", "tcp")], ids=["udp", "tcp"])
def watched(request: pytest.FixtureRequest) -> Iterator[Watched]:
    """Three vehicles that the ground station has seen."""
    ours, theirs = request.param
    vehicles = [
        SimulatedVehicle(config=VehicleConfig(), system_id=number, home=HOME) for number in range(1, N_VEHICLES + 1)
    ]
    with (
        open_ground_link(f"{ours}:127.0.0.1:0", vehicles, option="--gcs") as link,
        transport_of(link.url.replace(ours, theirs)) as ground,
    ):
        watched = Watched(link, vehicles, ground)

        def seen() -> bool:
            watched.send(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
            return bool(watched.tick())

        until(seen)
        yield watched


def command(system_id: int, number: int, *params: float) -> Any:
    return dialect.MAVLink_command_long_message(system_id, 1, number, 0, *params, *[0.0] * (7 - len(params)))


def test_everybody_is_seen(watched: Watched) -> None:
    beats = watched.wait_for("HEARTBEAT", 2 * N_VEHICLES)
    assert {message.get_srcSystem() for message in beats} == {1, 2, 3}


def test_only_the_vehicle_addressed_answers(watched: Watched) -> None:
    watched.send(command(2, 512, 148))
    (version,) = watched.wait_for("AUTOPILOT_VERSION", 1)
    assert version.get_srcSystem() == 2
    assert [vehicle.autopilot.mode.name for vehicle in watched.vehicles] == ["STABILIZE"] * 3
    watched.send(command(3, 176, 1, 4))
    watched.wait_for("COMMAND_ACK", 1)
    assert [vehicle.autopilot.mode.name for vehicle in watched.vehicles] == ["STABILIZE", "STABILIZE", "GUIDED"]


def test_all_answer_what_is_for_all(watched: Watched) -> None:
    watched.send(command(0, 512, 148))
    assert {message.get_srcSystem() for message in watched.wait_for("AUTOPILOT_VERSION", 3)} == {1, 2, 3}


def test_nobody_answers_for_a_stranger(watched: Watched) -> None:
    watched.send(command(77, 176, 1, 4), command(1, 512, 148))
    watched.wait_for("AUTOPILOT_VERSION", 1)
    assert all(vehicle.autopilot.mode.name == "STABILIZE" for vehicle in watched.vehicles)


def test_rates_are_the_ground_stations_own(watched: Watched) -> None:
    watched.send(command(1, 511, 30, 100_000))
    attitudes = watched.wait_for("ATTITUDE", 5)
    assert Counter(message.get_srcSystem() for message in attitudes).keys() == {1}
    assert watched.vehicles[0].tick(watched.now_s + 0.5).count(bytes([30, 0, 0])) == 0  # none on the agent's link


def test_rubbish_is_counted(watched: Watched) -> None:
    watched.ground.write(b"GET / HTTP/1.1\r\n")
    until(lambda: (watched.tick(), " 1 bad" in str(watched.link))[-1])


def flown(observers: Callable[[Flight], list[Observer]]) -> dict[str, Any]:
    """The report of a short mission with somebody else watching too."""
    overrides = [Override("agents.count=3"), Override("duration_s=20"), Override("seed=4")]
    mission, metrics = load_mission("quickstart", overrides=overrides), Metrics()
    with open_local_bus() as bus:
        flight = Flight(mission, bus)
        flight.run(pace=Lockstep(), observers=[metrics, *observers(flight)], stop=lambda: False)
        report = make_report(flight.side, metrics, wall_s=1.0, recording=None)
    del report["timing"]
    return report


def test_a_port_that_nobody_uses_changes_nothing() -> None:
    alone = flown(lambda flight: [])
    with transport_of("udpin:127.0.0.1:0") as transport:
        assert flown(lambda flight: [GroundLink(transport, flight.vehicles)]) == alone  # type: ignore[arg-type]


def test_a_ground_station_that_listens_changes_nothing() -> None:
    alone = flown(lambda flight: [])
    ours, heard = Endpoint(system_id=255, component_id=190), Counter[int]()

    class Listener:
        def observe(self, observation: object) -> None:
            ours.send(dialect.MAVLink_request_data_stream_message(0, 0, 0, 4, 1))
            ground.write(ours.take())
            for chunk in ground.read(0.0):
                heard.update(message.get_srcSystem() for message in ours.receive(chunk))

    with (
        transport_of("udpin:127.0.0.1:0") as transport,
        transport_of(transport.url.replace("udpin", "udpout")) as ground,
    ):
        watching = flown(lambda flight: [GroundLink(transport, flight.vehicles), Listener()])  # type: ignore[arg-type]
    assert watching["mavlink"].pop("vehicles")["received"] > alone["mavlink"].pop("vehicles")["received"]
    assert watching == alone
    assert min(heard[system_id] for system_id in (1, 2, 3)) > 1000


def test_a_taken_port_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    with transport_of("udpin:127.0.0.1:0") as taken:
        arguments = ["launch", "narrow", "--duration", "1", "--gcs", taken.url]
        assert main(arguments) == BAD_INPUT
        assert f"--gcs: {taken.url}: Address already in use" in capsys.readouterr().err
    with pytest.raises(TransportError):
        transport_of("tcp:no.such.host.invalid:1").__enter__()


def test_a_wrong_url_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "narrow", "--gcs", "udp:14550"]) == BAD_INPUT
    assert 'argument --gcs: got "udp:14550"; allowed: tcp:HOST:PORT, ' in capsys.readouterr().err


def test_nobody_watches_unless_asked() -> None:
    assert LaunchOptions().gcs == ()


def test_on_a_signed_port_only_who_has_the_key_is_heard() -> None:
    key = bytes(range(32))
    vehicle = SimulatedVehicle(config=VehicleConfig(), system_id=1, home=HOME)
    with (
        transport_of("udpin:127.0.0.1:0") as transport,
        transport_of(transport.url.replace("udpin", "udpout")) as ground,
    ):
        link = GroundLink(transport, [vehicle], key=key)
        stranger = Watched(link, [vehicle], ground)
        stranger.send(command(1, 176, 1, 4))
        until(lambda: (stranger.tick(), ", 1 refused" in str(link))[-1])
        assert vehicle.autopilot.mode.name == "STABILIZE"
        friend = Watched(link, [vehicle], ground)
        friend.ours = Endpoint(system_id=255, component_id=190, signing=Signing(key, unix_time=time.time))
        friend.now_s = stranger.now_s
        friend.send(command(1, 176, 1, 4))
        (ack,) = friend.wait_for("COMMAND_ACK", 1)
        assert ack.result == 0
        assert vehicle.autopilot.mode.name == "GUIDED"


def test_a_key_that_others_may_read_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "key"
    path.write_text("swordfish\n")
    path.chmod(0o644)
    for arguments in (["sim", "--signing-key", str(path)], ["launch", "narrow", "--gcs-signing-key", str(path)]):
        assert main(arguments) == BAD_INPUT
        assert "allowed: mode 0600" in capsys.readouterr().err
