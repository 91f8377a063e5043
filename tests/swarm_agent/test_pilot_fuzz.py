"""Whatever the wire says, the pilot never raises, and no number leaves it that a vehicle must not be sent."""

from __future__ import annotations

import re
import struct
from math import hypot, inf, isfinite, nan

from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Endpoint
from swarm_agent.autopilot import Fly, Intent, Land, Phase, Pilot, PilotConfig, Prepare, Return
from tests.swarm_agent.pilot_flight import Flight, config
from tests.swarm_agent.scripted_copter import ScriptedCopter

FLOATS = (nan, inf, -inf, 0.0, -1.0, 1.5, 1e9, -1e30, 3e38)
KINDS = sorted(dialect.mavlink_map.values(), key=lambda kind: int(kind.id))
NAMES = ("heartbeat", "command_ack", "param_value", "statustext", "local_position_ned", "attitude", "sys_status",
         "gps_global_origin", "global_position_int", "battery_status", "extended_sys_state", "ekf_status_report",
         "param_error")  # fmt: skip
LISTENED = [getattr(dialect, f"MAVLink_{name}_message") for name in NAMES]


@st.composite
def frames(draw: st.DrawFn) -> bytes:
    """A frame of the vehicle with a valid checksum: any type, half of the time one the pilot listens to; any fields."""
    kind = draw(st.one_of(st.sampled_from(LISTENED), st.sampled_from(KINDS)))
    payload = bytearray(draw(st.binary(min_size=kind.unpacker.size, max_size=kind.unpacker.size)))
    offset = 0
    for code in re.findall(r"\d*[a-zA-Z]", kind.unpacker.format.replace("<", "")):
        if code in ("f", "d") and draw(st.booleans()):
            struct.pack_into(f"<{code}", payload, offset, draw(st.sampled_from(FLOATS)))
        offset += struct.calcsize(f"<{code}")
    header = bytes((len(payload), 0, 0, draw(st.integers(0, 255)), 4, 1)) + int(kind.id).to_bytes(3, "little")
    checksum = dialect.x25crc(header + bytes(payload))
    checksum.accumulate(struct.pack("B", kind.crc_extra))
    return b"\xfd" + header + bytes(payload) + struct.pack("<H", checksum.crc)


def assert_sane(wire_out: bytes, limits: PilotConfig) -> None:
    """Every number that leaves is finite and small; setpoints keep to the limits."""
    receiver = Endpoint(system_id=limits.system_id)
    for message in receiver.receive(wire_out):
        numbers = [v for v in message.to_dict().values() if isinstance(v, float)]
        assert all(isfinite(number) and abs(number) <= 1e7 for number in numbers), message
        if isinstance(message, dialect.MAVLink_set_position_target_local_ned_message):
            assert hypot(message.vx, message.vy) <= limits.max_speed_m_s + 1e-4
            assert abs(message.vz) <= limits.max_climb_m_s + 1e-4
        if isinstance(message, dialect.MAVLink_command_long_message) and message.command == 22:
            assert 1.0 <= message.param7 <= 1000.0
    assert receiver.bad == 0


intents = st.one_of(
    st.builds(Prepare), st.builds(Return), st.builds(Land), st.tuples(st.floats(), st.floats()).map(Fly)
)


def test_the_fuzz_gets_past_the_checksum() -> None:
    seen: set[int] = set()

    @settings(max_examples=300, deadline=None, derandomize=True)
    @given(frame=frames())
    def collect(frame: bytes) -> None:
        receiver = Endpoint(system_id=255)
        seen.update(message.get_msgId() for message in receiver.receive(frame))
        assert receiver.bad == 0

    collect()
    assert len(seen) > 50


@settings(max_examples=150, deadline=None)
@given(burst=st.lists(frames(), max_size=12), intent=intents)
def test_any_messages_before_the_flight(burst: list[bytes], intent: Intent) -> None:
    pilot, vehicle = Pilot(config()), Endpoint(system_id=4)
    vehicle.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
    pilot.tick(0.0, vehicle.take(), intent)
    for k, frame in enumerate(burst):
        assert_sane(pilot.tick(k * 0.7, frame, intent), pilot.config)
    assert pilot.endpoint.bad == 0
    assert isinstance(pilot.state.phase, Phase)


@settings(max_examples=60, deadline=None)
@given(burst=st.lists(frames(), min_size=1, max_size=12), wish=st.tuples(st.floats(), st.floats()))
def test_any_messages_in_flight(burst: list[bytes], wish: tuple[float, float]) -> None:
    flight = Flight(ScriptedCopter(armed=True, mode=4, local_ned_m=[0.0, 0.0, -16.0]))
    flight.run(Prepare(), seconds=10.0, until=lambda: flight.pilot.state.ready)
    for k, frame in enumerate(burst):
        wire_out = flight.pilot.tick(flight.now_s + k * 0.1, frame, Fly(wish))
        assert_sane(wire_out, flight.pilot.config)
    assert isinstance(flight.pilot.state.phase, Phase)


@given(chunks=st.lists(st.binary(max_size=200), max_size=20))
def test_any_bytes(chunks: list[bytes]) -> None:
    pilot = Pilot(config())
    for k, chunk in enumerate(chunks):
        pilot.tick(k * 0.1, chunk, Prepare())
    assert pilot.state.phase is Phase.CONNECT


def test_reads_that_end_mid_frame_do_no_harm() -> None:
    copter, pilot, up, held = ScriptedCopter(), Pilot(config()), b"", b""
    for k in range(300):
        wire = held + copter.tick(k * 0.1, up)
        cut = len(wire) - k % 11  # the rest arrives with the next read
        held = wire[cut:]
        up = pilot.tick(k * 0.1, wire[:cut], Prepare())
    assert pilot.state.ready
    assert pilot.endpoint.bad == 0
