"""The whole flight on a PX4, and what it asks for that an ArduCopter does not."""

from __future__ import annotations

from math import hypot
from typing import cast

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.status import Level
from swarm_agent.autopilot import Fly, Phase, Prepare, Return
from tests.swarm_agent.pilot_flight import Flight
from tests.swarm_agent.scripted_copter import HOME
from tests.swarm_agent.scripted_px4 import HOLD, OFFBOARD, RTL, ScriptedPx4

SETPOINT = dialect.MAVLink_set_position_target_local_ned_message
TAKEOFF = dialect.MAV_CMD_NAV_TAKEOFF
SET_MODE = dialect.MAV_CMD_DO_SET_MODE
POSITION_CONTROL = 3 << 16


def flown(**changes: object) -> tuple[Flight, ScriptedPx4]:
    flight = Flight(ScriptedPx4(**changes))  # type: ignore[arg-type]
    flight.run(Prepare(), until=lambda: flight.pilot.state.ready)
    return flight, cast(ScriptedPx4, flight.copter)


def test_goes_through_every_phase_in_order() -> None:
    flight, copter = flown(ready_at_s=3.0)
    flight.run(Fly((2.0, 1.0)), seconds=5.0)
    flight.until(Phase.DONE, Return())
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
    assert hypot(*copter.local_ned_m[:2]) < 1.0
    assert not [event for event in flight.events if event.level is not Level.INFO]


@pytest.mark.parametrize("hill_m", [0.0, 5.0])
def test_takeoff_counts_from_the_sea_and_return_from_the_ground(hill_m: float) -> None:
    flight, copter = flown(offset_m=(0.0, 40.0, hill_m))
    assert copter.commands(TAKEOFF)[0].param7 == pytest.approx(HOME.altitude_m + 16.0, abs=0.01)
    assert copter.parameters == {"RTL_RETURN_ALT": pytest.approx(16.0 - hill_m)}
    assert flight.run(Prepare(), seconds=3.0).copter.local_ned_m[2] == pytest.approx(hill_m - 16.0, abs=0.3)


def test_setpoints_flow_before_the_mode_that_needs_them_and_never_stop() -> None:
    flight, copter = flown()
    flight.run(Fly((1.0, 0.0)), seconds=10.0)
    assert copter.rejected == 0
    assert copter.mode == OFFBOARD
    asked = next(i for i, m in enumerate(copter.heard) if m in copter.commands(SET_MODE)[-1:])
    assert sum(isinstance(message, SETPOINT) for message in copter.heard[:asked]) >= 5
    assert [m.param2 for m in copter.commands(SET_MODE)] == [4.0, 6.0]  # HOLD, OFFBOARD


def test_control_can_be_given_back_because_setpoints_go_on() -> None:
    flight, copter = flown()
    copter.mode = POSITION_CONTROL
    flight.until(Phase.TAKEN_OVER, Fly((1.0, 0.0)), seconds=2.0)
    flight.run(Fly((1.0, 0.0)), seconds=20.0)
    assert copter.mode == POSITION_CONTROL  # nobody asked it to change
    assert copter._fresh
    copter.mode = OFFBOARD
    flight.until(Phase.FLYING, Fly((1.0, 0.0)), seconds=3.0)


def test_offboard_lost_with_the_link_is_asked_back() -> None:
    flight, copter = flown()
    copter.quiet = True
    copter.setpoint_at_s = float("-inf")
    copter.mode = HOLD
    flight.run(Fly((1.0, 0.0)), seconds=4.0)
    copter.quiet = False
    flight.run(Fly((1.0, 0.0)), seconds=10.0, until=lambda: copter.mode == OFFBOARD)
    flight.until(Phase.FLYING, Fly((1.0, 0.0)), seconds=3.0)


def test_a_failsafe_return_is_followed_down() -> None:
    flight, copter = flown()
    copter.say(2, "Failsafe activated")
    copter.mode = RTL
    flight.until(Phase.DONE, Fly((1.0, 0.0)), seconds=60.0)
    assert "in RTL without being asked (Failsafe activated): following it down" in flight.texts


def test_a_mode_nobody_knows_is_left_alone() -> None:
    flight, copter = flown()
    copter.mode = 99 << 16
    flight.until(Phase.TAKEN_OVER, Fly((1.0, 0.0)), seconds=2.0)
    assert flight.pilot.state.flight_mode == f"MODE {99 << 16}"
