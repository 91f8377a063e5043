"""What is different when the agent's pilot flies a PX4: its modes, its watchdog, and what a person does to it."""

from __future__ import annotations

from math import hypot

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from swarm_agent.autopilot import Fly, Land, Phase, Prepare, Return
from tests.missions.test_pilot_flies_vehicle import LAYER_M, Flight
from vehicle_sim.autopilot.px4.modes import Mode
from vehicle_sim.vehicle import VehicleConfig

EAST = Fly((2.0, 0.0))


def px4(boot_s: float = 2.0) -> Flight:
    return Flight(vehicle=VehicleConfig(flavor="px4", boot_s=boot_s))


def mode_command(mode: Mode) -> dialect.MAVLink_command_long_message:
    main, sub = float(mode >> 16 & 0xFF), float(mode >> 24)
    return dialect.MAVLink_command_long_message(4, 1, 176, 0, 1.0, main, sub, 0.0, 0.0, 0.0, 0.0)


def test_it_climbs_in_takeoff_flies_in_offboard_and_returns_at_its_layer() -> None:
    flight = px4().climbed().run(EAST, seconds=15.0)
    assert flight.vehicle.mode_name == "OFFBOARD"
    assert flight.vehicle.autopilot.parameters["RTL_RETURN_ALT"] == pytest.approx(LAYER_M, abs=0.1)
    begin = len(flight.track_m)
    flight.ended(Return())
    assert max(up for _, _, up in flight.track_m[begin:]) < LAYER_M + 0.5
    assert flight.texts.count("Armed by external command") == 1


def test_what_keeps_it_on_the_ground_is_shown() -> None:
    flight = px4(boot_s=20.0)
    flight.vehicle.autopilot.parameters.suffer("SIM_MAG1_FAIL", 1.0)
    flight.run(Prepare(), seconds=60.0)
    assert flight.state.phase is not Phase.TAKEOFF
    flight.vehicle.autopilot.parameters.suffer("SIM_MAG1_FAIL", 0.0)
    flight.climbed()


def test_another_stations_hold_is_respected_and_can_be_given_back() -> None:
    flight = px4().climbed().run(EAST, seconds=5.0)
    flight.second.send(mode_command(Mode.HOLD))
    flight.run(EAST, seconds=8.0)
    assert (flight.state.phase, flight.vehicle.mode_name) == (Phase.TAKEN_OVER, "HOLD")
    flight.second.send(mode_command(Mode.OFFBOARD))
    flight.run(EAST, seconds=5.0, until=lambda: flight.state.phase is Phase.FLYING)


def test_another_stations_return_is_followed_down() -> None:
    flight = px4().climbed().run(EAST, seconds=5.0)
    flight.second.send(mode_command(Mode.RTL))
    flight.ended(EAST)
    assert flight.truth_m == pytest.approx(flight.offset_m, abs=1.5)


def test_land_comes_down_where_it_is() -> None:
    flight = px4().climbed().run(Fly((4.0, 0.0)), seconds=10.0).ended(Land())
    assert flight.truth_m[0] > 70.0
    assert flight.truth_m[2] == pytest.approx(0.0, abs=0.3)


def test_while_the_link_is_lost_it_returns_and_when_it_is_back_it_flies_on() -> None:
    flight = px4().climbed().run(EAST, seconds=10.0)
    flight.cut_s = 5.0
    flight.run(EAST, seconds=4.5)
    assert flight.vehicle.mode_name == "RTL"
    flight.run(EAST, seconds=6.0)
    assert (flight.state.phase, flight.vehicle.mode_name) == (Phase.FLYING, "OFFBOARD")
    assert hypot(*flight.vehicle.truth.velocity_ned_m_s) > 1.8


@pytest.mark.parametrize("dark_s", [0.0, 3.0])
def test_restarted_in_flight_it_takes_off_again(dark_s: float) -> None:
    flight = px4().climbed().run(EAST, seconds=8.0)
    flight.cut_s = dark_s
    flight.reboot().run(EAST, seconds=dark_s)
    flight.run(EAST, seconds=20.0, until=lambda: flight.state.phase is Phase.PREFLIGHT)
    flight.run(EAST, seconds=60.0, until=lambda: flight.state.phase is Phase.FLYING)
    flight.ended(Return())
