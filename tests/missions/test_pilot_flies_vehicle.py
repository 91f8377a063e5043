"""The agent's pilot and the simulated autopilot on one wire: whole flights, judged by where the vehicle really is."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import hypot

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint, Vec3, geo_from_enu, swap_enu_ned
from comms.mavlink import Endpoint
from comms.status import Event, Level
from swarm_agent.autopilot import Fly, Intent, Land, Phase, Pilot, PilotConfig, PilotState, Prepare, Return
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.vehicle import FLAVOR_NAMES, KINDS, FlavorName, Kind, VehicleConfig
from vehicle_sim.wind import Wind

MISSION_HOME = GeoPoint(47.397742, 8.545594, 488.1)
LAYER_M = 16.0
TICK_S = 0.1


class Flight:
    """One pilot and its vehicle, standing `offset_m` (ENU) from the mission's home."""

    def __init__(self, *, offset_m: Vec3 = (40.0, -25.0, 0.0), vehicle: VehicleConfig | None = None) -> None:
        self.offset_m = offset_m
        self.vehicle = SimulatedVehicle(
            config=vehicle or VehicleConfig(), system_id=4, home=geo_from_enu(MISSION_HOME, offset_m), seed=7
        )
        self.pilot = Pilot(PilotConfig(uid=3, system_id=4, home=MISSION_HOME, altitude_m=LAYER_M, max_speed_m_s=5.0))
        self.second = Endpoint(system_id=255, component_id=190)  # a ground station on the same link
        self.events: list[Event] = []
        self.phases = [Phase.CONNECT]
        self.track_m: list[Vec3] = []
        self.ticks = 0
        self.cut_s = self.deaf_s = 0.0  # how long nothing comes through, or nothing to the vehicle
        self._config = vehicle or VehicleConfig()
        self._up = b""

    def reboot(self) -> Flight:
        """The vehicle is switched off and on again, and stands where it stood at first."""
        home, now_s = geo_from_enu(MISSION_HOME, self.offset_m), self.ticks * TICK_S
        self.vehicle = SimulatedVehicle(config=self._config, system_id=4, home=home, seed=7, started_at_s=now_s)
        return self

    @property
    def truth_m(self) -> Vec3:
        """Where the vehicle really is, in the mission's frame."""
        east, north, up = swap_enu_ned(self.vehicle.truth.position_ned_m)
        return (east + self.offset_m[0], north + self.offset_m[1], up + self.offset_m[2])

    @property
    def state(self) -> PilotState:
        return self.pilot.state

    @property
    def texts(self) -> list[str]:
        return [event.text for event in self.events]

    def run(self, intent: Intent, *, seconds: float, until: Callable[[], bool] | None = None) -> Flight:
        for _ in range(round(seconds / TICK_S)):
            self.ticks += 1
            now_s = self.ticks * TICK_S
            deaf, cut = self.deaf_s > 0.0, self.cut_s > 0.0
            self.deaf_s, self.cut_s = self.deaf_s - TICK_S, self.cut_s - TICK_S
            wire = self.vehicle.tick(now_s, (b"" if deaf or cut else self._up) + self.second.take())
            wire = b"" if cut else wire
            self._up = self.pilot.tick(now_s, wire, intent)
            self.events += self.pilot.take_events()
            self.track_m.append(self.truth_m)
            if self.phases[-1] is not self.state.phase:
                self.phases.append(self.state.phase)
            if until is not None and until():
                return self
        assert until is None, f"not in {seconds} s: {self.state}; {self.texts[-12:]}"
        return self

    def climbed(self) -> Flight:
        return self.run(Prepare(), seconds=60.0, until=lambda: self.state.ready)

    def ended(self, intent: Intent, *, seconds: float = 120.0) -> Flight:
        return self.run(intent, seconds=seconds, until=lambda: self.state.phase is Phase.DONE)


@pytest.mark.parametrize("flavor", FLAVOR_NAMES)
@pytest.mark.parametrize("kind", KINDS)
class TestWholeFlight:
    def test_from_power_on_to_landed(self, kind: Kind, flavor: FlavorName) -> None:
        flight = Flight(vehicle=VehicleConfig(kind=kind, flavor=flavor)).climbed()
        flight.run(Fly((3.0, 2.0)), seconds=15.0).ended(Return())
        assert flight.phases == [
            Phase.CONNECT,
            Phase.PREFLIGHT,
            Phase.ARM,
            Phase.TAKEOFF,
            Phase.ON_STATION,
            Phase.FLYING,
            Phase.RETURN,
            Phase.DONE,
        ]
        assert not flight.vehicle.truth.armed
        assert flight.truth_m == pytest.approx(flight.offset_m, abs=1.5)
        assert flight.pilot.endpoint.bad == flight.vehicle.endpoint.bad == flight.pilot.ignored == 0
        assert not [event for event in flight.events if event.level is Level.ERROR]

    def test_believes_what_is_true(self, kind: Kind, flavor: FlavorName) -> None:
        flight = Flight(vehicle=VehicleConfig(kind=kind, flavor=flavor)).climbed().run(Fly((0.0, -4.0)), seconds=10.0)
        position_m, velocity_m_s = flight.state.position_m, flight.state.velocity_m_s
        assert position_m is not None
        assert velocity_m_s is not None
        assert position_m == pytest.approx(flight.truth_m, abs=0.6)
        assert velocity_m_s == pytest.approx((0.0, -4.0, 0.0), abs=0.3)

    def test_stays_on_its_layer_and_under_its_speed(self, kind: Kind, flavor: FlavorName) -> None:
        flight = Flight(vehicle=VehicleConfig(kind=kind, flavor=flavor)).climbed().run(Prepare(), seconds=10.0)
        begin = len(flight.track_m)
        for wish in ((30.0, 0.0), (-30.0, 30.0), (0.0, -1.0), (0.0, 0.0)):
            flight.run(Fly(wish), seconds=8.0)
        flown = flight.track_m[begin:]
        assert all(abs(up - LAYER_M) < 0.5 for _, _, up in flown)
        speeds = [hypot(b[0] - a[0], b[1] - a[1]) / TICK_S for a, b in pairwise(flown)]
        assert 4.8 < max(speeds) < 5.5

    def test_a_hill_changes_neither_layer_nor_return(self, kind: Kind, flavor: FlavorName) -> None:
        flight = Flight(offset_m=(0.0, 60.0, 6.0), vehicle=VehicleConfig(kind=kind, flavor=flavor)).climbed()
        flight.run(Fly((2.0, -2.0)), seconds=15.0)
        assert flight.truth_m[2] == pytest.approx(LAYER_M, abs=0.3)
        begin = len(flight.track_m)
        flight.ended(Return())
        # It comes home at the layer, not at an autopilot's own height: sinking starts above its pad.
        sinking = [place for place in flight.track_m[begin:] if place[2] < LAYER_M - 1.0]
        assert max(hypot(east, north - 60.0) for east, north, _ in sinking) < 2.0


class TestNotAsPlanned:
    def test_a_slow_boot_is_waited_for(self) -> None:
        flight = Flight(vehicle=VehicleConfig(boot_s=41.2)).run(Prepare(), seconds=35.0)
        assert flight.state.phase is Phase.PREFLIGHT
        flight.climbed()

    def test_holds_its_layer_in_wind(self) -> None:
        config = VehicleConfig(wind=Wind(speed_m_s=6.0, gust_m_s=1.0))
        flight = Flight(vehicle=config).climbed().run(Prepare(), seconds=20.0)
        assert flight.truth_m[2] == pytest.approx(LAYER_M, abs=0.5)
        assert hypot(flight.truth_m[0] - 40.0, flight.truth_m[1] + 25.0) < 5.0

    def test_another_stations_mode_is_respected_and_its_return_followed(self) -> None:
        flight = Flight().climbed().run(Fly((2.0, 0.0)), seconds=5.0)
        flight.second.send(mode_command(17))
        flight.run(Fly((2.0, 0.0)), seconds=5.0)
        assert flight.state.phase is Phase.TAKEN_OVER
        assert flight.state.flight_mode == "BRAKE"
        flight.second.send(mode_command(4))
        flight.run(Fly((2.0, 0.0)), seconds=5.0, until=lambda: flight.state.phase is Phase.FLYING)
        flight.second.send(mode_command(6))
        flight.ended(Fly((2.0, 0.0)))
        assert flight.truth_m == pytest.approx(flight.offset_m, abs=1.5)

    def test_land_comes_down_where_it_is(self) -> None:
        flight = Flight().climbed().run(Fly((4.0, 0.0)), seconds=10.0).ended(Land())
        assert flight.truth_m[0] > 70.0
        assert flight.truth_m[2] == pytest.approx(0.0, abs=0.3)

    def test_a_new_pilot_takes_up_a_flying_vehicle(self) -> None:
        flight = Flight().climbed().run(Fly((2.0, 0.0)), seconds=3.0)
        flight.pilot, flight.phases = Pilot(flight.pilot.config), [Phase.CONNECT]
        begin = len(flight.track_m)
        flight.run(Prepare(), seconds=20.0, until=lambda: flight.state.ready)
        assert Phase.ARM not in flight.phases
        assert min(place[2] for place in flight.track_m[begin:]) > LAYER_M - 0.5
        flight.ended(Return())

    def test_a_pilot_that_falls_silent_lets_the_vehicle_stop(self) -> None:
        flight = Flight().climbed().run(Fly((3.0, 0.0)), seconds=5.0)
        now_s = flight.ticks * TICK_S
        flight.vehicle.tick(now_s + 10.0, b"")
        assert hypot(*flight.vehicle.truth.velocity_ned_m_s) < 0.3
        flight.ticks += 100
        flight.run(Fly((3.0, 0.0)), seconds=0.2)
        assert any(text.startswith("no setpoint for 10") for text in flight.texts)

    def test_disarmed_in_the_air_is_told(self) -> None:
        flight = Flight().climbed()
        forced = (0.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        flight.second.send(dialect.MAVLink_command_long_message(4, 1, 400, 0, *forced))
        flight.run(Prepare(), seconds=5.0, until=lambda: flight.state.phase is Phase.FAILED)
        assert flight.state.failure == "disarmed in the air"

    def test_a_pilots_return_can_be_given_back_on_the_way(self) -> None:
        flight = Flight().climbed().run(Fly((4.0, 0.0)), seconds=10.0)
        flight.second.send(mode_command(6))
        flight.run(Fly((4.0, 0.0)), seconds=3.0, until=lambda: flight.state.phase is Phase.RETURN)
        flight.run(Fly((4.0, 0.0)), seconds=2.0)
        flight.second.send(mode_command(4))
        flight.run(Fly((4.0, 0.0)), seconds=5.0, until=lambda: flight.state.phase is Phase.FLYING)
        assert "GUIDED again: going on" in flight.texts

    def test_a_failsafe_is_an_error_that_gives_the_autopilots_reason(self) -> None:
        flight = Flight().climbed()
        flight.second.send(dialect.MAVLink_param_set_message(4, 1, b"FS_GCS_ENABLE", 1.0, 9))
        flight.run(Prepare(), seconds=2.0).deaf_s = 8.0
        flight.run(Prepare(), seconds=20.0, until=lambda: flight.state.phase is Phase.RETURN)
        errors = [event.text for event in flight.events if event.level is Level.ERROR]
        assert errors == ["in RTL without being asked (GCS Failsafe): following it down"]
        flight.ended(Prepare())

    def test_hovering_alone_while_the_link_was_lost_it_is_asked_back(self) -> None:
        flight = Flight().climbed().run(Fly((2.0, 0.0)), seconds=5.0)
        flight.second.send(dialect.MAVLink_param_set_message(4, 1, b"FS_GCS_ENABLE", 7.0, 9))  # BRAKE or land
        flight.run(Fly((2.0, 0.0)), seconds=1.0).cut_s = 9.0
        flight.run(Fly((2.0, 0.0)), seconds=8.0)
        assert flight.state.link_lost
        assert flight.vehicle.mode_name == "BRAKE"
        flight.run(Fly((2.0, 0.0)), seconds=10.0, until=lambda: flight.vehicle.mode_name == "GUIDED")
        flight.run(Fly((2.0, 0.0)), seconds=3.0, until=lambda: flight.state.phase is Phase.FLYING)
        assert "the link was lost and is back: asking for GUIDED" in flight.texts

    def test_hovering_by_a_persons_choice_it_is_not_asked_back(self) -> None:
        flight = Flight().climbed()
        flight.second.send(mode_command(17))
        flight.run(Fly((2.0, 0.0)), seconds=20.0)
        assert flight.state.phase is Phase.TAKEN_OVER
        assert flight.vehicle.mode_name == "BRAKE"

    def test_a_person_wins_at_the_end_too(self) -> None:
        flight = Flight().climbed()
        flight.second.send(mode_command(17))
        flight.run(Prepare(), seconds=3.0, until=lambda: flight.state.phase is Phase.TAKEN_OVER)
        flight.run(Return(), seconds=20.0)
        assert flight.vehicle.mode_name == "BRAKE"
        assert flight.texts.count("should come down: who flies it may land it, or choose GUIDED") == 1
        flight.second.send(mode_command(4))
        flight.ended(Return())

    def test_a_link_lost_and_found_in_guided_flight_is_flown_on(self) -> None:
        flight = Flight().climbed().run(Fly((2.0, 0.0)), seconds=2.0)
        flight.cut_s = 8.0
        flight.run(Fly((2.0, 0.0)), seconds=7.0)
        assert flight.state.link_lost
        assert hypot(*flight.vehicle.truth.velocity_ned_m_s) < 0.3  # it has stopped by itself
        flight.run(Fly((2.0, 0.0)), seconds=5.0)
        assert flight.state.phase is Phase.FLYING
        assert hypot(*flight.vehicle.truth.velocity_ned_m_s) > 1.8

    def test_restarted_on_the_ground_it_is_checked_anew_and_flies(self) -> None:
        flight = Flight(vehicle=VehicleConfig(boot_s=20.0)).run(Prepare(), seconds=15.0).reboot()
        flight.climbed()
        assert flight.phases.count(Phase.TAKEOFF) == 1
        assert not [event for event in flight.events if event.level is Level.ERROR]

    @pytest.mark.parametrize("dark_s", [0.0, 3.0, 90.0])  # the last longer than it had been on
    def test_restarted_in_flight_it_takes_off_again(self, dark_s: float) -> None:
        flight = Flight().climbed().run(Fly((2.0, 0.0)), seconds=8.0)
        flight.cut_s = dark_s
        flight.reboot().run(Fly((2.0, 0.0)), seconds=dark_s)
        flight.run(Fly((2.0, 0.0)), seconds=20.0, until=lambda: flight.state.phase is Phase.PREFLIGHT)
        flight.run(Fly((2.0, 0.0)), seconds=60.0, until=lambda: flight.state.phase is Phase.FLYING)
        assert "the autopilot has restarted: it is checked anew" in flight.texts
        assert flight.vehicle.autopilot.parameters["RTL_ALT"] == pytest.approx(1600.0, abs=50.0)
        assert flight.state.position_m == pytest.approx(flight.truth_m, abs=0.6)
        flight.ended(Return())

    def test_restarting_over_and_over_it_is_given_up(self) -> None:
        flight = Flight().climbed()
        for _ in range(4):
            flight.reboot().run(Prepare(), seconds=25.0)
        assert flight.state.failure == "the autopilot has restarted 4 times"

    def test_the_same_seed_flies_the_same_flight(self) -> None:
        def track() -> list[Vec3]:
            return Flight().climbed().run(Fly((3.0, 1.0)), seconds=5.0).ended(Return()).track_m

        assert track() == track()


def mode_command(custom_mode: int, *, system_id: int = 4) -> dialect.MAVLink_command_long_message:
    """DO_SET_MODE, as a ground station sends it."""
    return dialect.MAVLink_command_long_message(system_id, 1, 176, 0, 1.0, float(custom_mode), 0.0, 0.0, 0.0, 0.0, 0.0)
