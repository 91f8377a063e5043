"""What stays true whatever arrives. Each law looks at one tick and raises `Broken`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import dist, hypot, isfinite
from typing import Any, NamedTuple

from comms.frames import Vec3
from comms.mavlink import BYTES_OF_A_SOURCE, Endpoint
from swarm_agent.autopilot import PilotConfig
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.flight import DRAG_1_M, DRAG_1_S, GRAVITY_M_S2, VERTICAL_ACCELERATION_M_S2, lean_max_m_s2
from vehicle_sim.vehicle import VehicleTruth

HEARTBEAT_ID = 0
HEARTBEAT_S = 1.0
OUT_OF_PLACE_M = 1e6
LARGEST_COLLECTION = 5_000  # items; the largest that is meant to be is a list of mission items
LARGEST_TEXT = 100_000  # bytes or characters
LARGEST_SUBJECT = 50_000  # objects in all
SLACK = 1e-6
LARGEST_NUMBER = 1e7
REST: Vec3 = (0.0, 0.0, 0.0)
SETPOINT, COMMAND, TAKEOFF = "SET_POSITION_TARGET_LOCAL_NED", "COMMAND_LONG", 22


class Broken(AssertionError):  # noqa: N818
    """A law that did not hold."""


class Tick(NamedTuple):
    """One tick of a vehicle: `now_s` is its end, `wind_m_s` the strongest wind of the episode so far, with gusts."""

    vehicle: SimulatedVehicle
    before: VehicleTruth
    after: VehicleTruth
    span_s: float
    now_s: float
    wire_out: bytes
    ideal: bool
    wind_m_s: float

    @property
    def gain_m_s2(self) -> float:
        """The greatest acceleration that lean and drag give: the air may move against the vehicle, and turn."""
        airspeed_m_s = max(hypot(*t.velocity_ned_m_s[:2]) for t in (self.before, self.after)) + 2.0 * self.wind_m_s
        drag_m_s2 = (DRAG_1_S + DRAG_1_M * airspeed_m_s) * airspeed_m_s
        return drag_m_s2 + lean_max_m_s2(self.vehicle.autopilot.airframe.limits)


def frame_ids(wire: bytes) -> Iterator[int]:
    """The message ids in a batch of whole, unsigned or signed MAVLink 2 frames."""
    at = 0
    while at < len(wire):
        if wire[at] != 0xFD:
            raise Broken(f"what was said is no frame at byte {at}")
        yield int.from_bytes(wire[at + 7 : at + 10], "little")
        at += 12 + wire[at + 1] + (13 if wire[at + 2] & 1 else 0)
    if at != len(wire):
        raise Broken("what was said ends within a frame")


def says_no_more_than_it_may(tick: Tick) -> None:
    if len(tick.wire_out) > BYTES_OF_A_SOURCE:
        raise Broken(f"said {len(tick.wire_out)} bytes in one tick")


def stays_finite(tick: Tick) -> None:
    truth = tick.after
    numbers = (*truth.position_ned_m, *truth.velocity_ned_m_s, truth.roll_rad, truth.pitch_rad, truth.yaw_rad)
    if not all(map(isfinite, numbers)) or max(map(abs, truth.position_ned_m)) > OUT_OF_PLACE_M:
        raise Broken(f"is nowhere: {truth}")
    if truth.position_ned_m[2] > SLACK:
        raise Broken(f"is below the ground: {truth}")


def moves_as_far_as_its_speed(tick: Tick) -> None:
    """A change of velocity within the tick counts half, but the bound gives all of it."""
    fastest_m_s = max(hypot(*tick.before.velocity_ned_m_s), hypot(*tick.after.velocity_ned_m_s))
    limits = tick.vehicle.autopilot.airframe.limits
    gain_m_s = (GRAVITY_M_S2 + tick.gain_m_s2) * tick.span_s
    if tick.ideal:
        gain_m_s += hypot(limits.speed_m_s + tick.wind_m_s, max(limits.climb_m_s, limits.descent_m_s))
    moved_m = dist(tick.before.position_ned_m, tick.after.position_ned_m)
    if moved_m > (fastest_m_s + gain_m_s) * tick.span_s + SLACK:
        raise Broken(f"moved {moved_m} m in {tick.span_s} s: {tick.before} -> {tick.after}")


def speeds_up_as_thrust_drag_and_gravity_can(tick: Tick) -> None:
    """From the velocity it had; or from rest, if it may have been on the ground within the tick."""
    (north, east, down), span_s = tick.before.velocity_ned_m_s, tick.span_s
    lowest_m = tick.before.position_ned_m[2] + (max(0.0, down) + GRAVITY_M_S2 * span_s) * span_s
    beginnings = [(north, east, down), REST] if lowest_m >= 0.0 else [(north, east, down)]
    if not tick.ideal and not any(_within_reach(tick, beginning) for beginning in beginnings):
        raise Broken(f"changed its velocity too much in {span_s} s: {tick.before} -> {tick.after}")


def _within_reach(tick: Tick, beginning: Vec3) -> bool:
    """Sideways by lean and drag; up by thrust, or by the drag of a fast fall; down by gravity, and drag if it rose."""
    (north, east, down), (n1, e1, d1) = beginning, tick.after.velocity_ned_m_s
    braking_m_s2 = DRAG_1_S * abs(down)
    slower_m_s2 = max(VERTICAL_ACCELERATION_M_S2, braking_m_s2 - GRAVITY_M_S2 if down > 0.0 else 0.0)
    faster_m_s2 = GRAVITY_M_S2 + (braking_m_s2 if down < 0.0 else 0.0)
    vertically = -slower_m_s2 * tick.span_s - SLACK <= d1 - down <= faster_m_s2 * tick.span_s + SLACK
    return vertically and hypot(n1 - north, e1 - east) <= tick.gain_m_s2 * tick.span_s + SLACK


VEHICLE_LAWS: tuple[Callable[[Tick], None], ...] = (
    says_no_more_than_it_may, stays_finite, moves_as_far_as_its_speed, speeds_up_as_thrust_drag_and_gravity_can,
)  # fmt: skip


def keeps_to_its_limits(wire_out: bytes, config: PilotConfig) -> None:
    """Every number that a pilot sends is finite and small; setpoints and takeoffs keep to its configuration."""
    receiver = Endpoint(system_id=config.system_id)
    for message in receiver.receive(wire_out):
        numbers = [value for value in message.to_dict().values() if isinstance(value, float)]
        if not all(isfinite(number) and abs(number) <= LARGEST_NUMBER for number in numbers):
            raise Broken(f"the pilot sent {message}")
        _keeps_to_its_limits(message, config)
    if receiver.bad:
        raise Broken("what the pilot sent is not all frames")


def _keeps_to_its_limits(message: Any, config: PilotConfig) -> None:
    kind, slack = message.get_type(), 1e-4
    if kind == SETPOINT:
        too_fast = hypot(message.vx, message.vy) > config.max_speed_m_s + slack
        if too_fast or abs(message.vz) > config.max_climb_m_s + slack:
            raise Broken(f"the pilot flies too fast: {message}")
    if kind == COMMAND and message.command == TAKEOFF and not 1.0 <= message.param7 <= 1000.0:
        raise Broken(f"the pilot takes off to {message.param7} m")


def is_small(subject: object) -> None:
    """Walk everything that belongs to `subject`: no collection and no text grows with what arrived."""
    seen: set[int] = set()
    waiting: list[object] = [subject]
    while waiting:
        thing = waiting.pop()
        if id(thing) in seen:
            continue
        seen.add(id(thing))
        if isinstance(thing, str | bytes | bytearray):
            if len(thing) > LARGEST_TEXT:
                raise Broken(f"{len(thing)} bytes or characters in one {type(thing).__name__}")
            continue
        waiting += _parts(thing)
        if len(seen) > LARGEST_SUBJECT:
            raise Broken(f"{type(subject).__name__} has more than {LARGEST_SUBJECT} parts")


def _parts(thing: object) -> list[object]:
    if isinstance(thing, dict):
        inside = [*thing.keys(), *thing.values()]
    elif isinstance(thing, list | tuple | set | frozenset) or type(thing).__name__ == "deque":
        inside = list(thing)
    elif isinstance(thing, type) or not (hasattr(thing, "__dict__") or hasattr(thing, "__slots__")):
        return []
    else:
        names = [
            *getattr(thing, "__dict__", ()),
            *(n for t in type(thing).__mro__ for n in getattr(t, "__slots__", ())),
        ]
        return [getattr(thing, name, None) for name in names]
    if len(inside) > LARGEST_COLLECTION:
        raise Broken(f"a {type(thing).__name__} of {len(inside)} items")
    return inside
