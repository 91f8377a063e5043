"""The endpoint: whole, byte by byte, with rubbish, with stray start bytes, with any bytes at all."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.framing import MAX_FRAME_BYTES
from comms.mavlink import BYTES_OF_A_SOURCE, BYTES_OUT, Endpoint
from tests.examples import MANY

# Frames of a recorded ArduCopter 4.5.5 SITL.
ATTITUDE = bytes.fromhex("fd1c0000e601011e0000f3ec00009c1b753bbb4cd1bcc9ec2d390015743adf5763bb95dca4ba8a79")
HEARTBEAT = bytes.fromhex("fd090000e40101000000040000000203d90403b9b7")
ARM_REFUSED = bytes.fromhex("fd1900000f0101fd00000241726d3a20416363656c7320696e636f6e73697374656e747515")


def receiver() -> Endpoint:
    return Endpoint(system_id=255, component_id=190)


def names(messages: list[object]) -> list[str]:
    return [message.get_type() for message in messages]  # type: ignore[attr-defined]


def test_recorded_frames_decode_to_what_was_recorded() -> None:
    attitude, heartbeat, text = receiver().receive(ATTITUDE + HEARTBEAT + ARM_REFUSED)
    assert (attitude.time_boot_ms, attitude.pitch) == (60659, pytest.approx(-0.025549283251166344))
    assert (heartbeat.base_mode, heartbeat.custom_mode, heartbeat.system_status) == (217, 4, 4)
    assert (text.severity, text.text) == (2, "Arm: Accels inconsistent")
    assert (text.get_srcSystem(), text.get_srcComponent()) == (1, 1)


def test_our_frame_of_a_recorded_message_is_the_recorded_frame() -> None:
    end = Endpoint(system_id=1)
    end._codec.seq = HEARTBEAT[4]
    end.send(dialect.MAVLink_heartbeat_message(2, 3, 217, 4, 4, 3))
    assert end.take() == HEARTBEAT
    assert end.take() == b""


@given(cuts=st.lists(st.integers(0, 3 * len(ATTITUDE)), max_size=8))
def test_any_cutting_of_a_stream_gives_the_same_messages(cuts: list[int]) -> None:
    stream = ATTITUDE * 3
    end, got = receiver(), []
    edges = [0, *sorted(cuts), len(stream)]
    for begin, stop in pairwise(edges):
        got += end.receive(stream[begin:stop])
    assert names(got) == ["ATTITUDE"] * 3
    assert (end.received, end.bad) == (3, 0)


def test_byte_by_byte() -> None:
    end = receiver()
    got = [message for byte in ATTITUDE + HEARTBEAT for message in end.receive(bytes([byte]))]
    assert names(got) == ["ATTITUDE", "HEARTBEAT"]


def test_trailing_rubbish_is_counted_and_forgotten() -> None:
    end = receiver()
    assert names(end.receive(HEARTBEAT + b"GET / HTTP/1.1\r\n")) == ["HEARTBEAT"]
    assert end.bad == 1
    assert names(end.receive(HEARTBEAT)) == ["HEARTBEAT"]
    assert end.bad == 1


def test_a_stray_start_byte_costs_none_of_the_frames_behind_it() -> None:
    end = receiver()
    got = end.receive(b"\xfd" + HEARTBEAT * 20)
    assert names(got) == ["HEARTBEAT"] * 20
    assert end.bad >= 1


def test_a_flipped_bit_drops_that_frame_alone() -> None:
    broken = bytearray(ATTITUDE)
    broken[-1] ^= 0x01
    assert names(receiver().receive(HEARTBEAT + bytes(broken) + HEARTBEAT)) == ["HEARTBEAT"] * 2


def test_the_environment_cannot_turn_the_checksum_off() -> None:
    assert dialect.MAVLINK_IGNORE_CRC is False


def test_unknown_ids_and_flags_are_dropped() -> None:
    unknown_id = bytearray(HEARTBEAT)
    unknown_id[7:10] = (9999).to_bytes(3, "little")
    unknown_flag = bytearray(HEARTBEAT)
    unknown_flag[2] = 0x40
    end = receiver()
    assert names(end.receive(bytes(unknown_id) + bytes(unknown_flag) + HEARTBEAT)) == ["HEARTBEAT"]
    assert end.bad >= 2


@MANY
@given(noise=st.lists(st.binary(max_size=400) | st.just(b"\xfd\xff"), max_size=6))
def test_no_bytes_raise_and_the_buffer_stays_small(noise: list[bytes]) -> None:
    end = receiver()
    for chunk in noise:
        end.receive(chunk)
        assert len(end._inbound) < MAX_FRAME_BYTES
    end.receive(bytes(2 * MAX_FRAME_BYTES))  # zeros: whatever frame was open is now complete
    assert names(end.receive(HEARTBEAT)) == ["HEARTBEAT"]


@given(noise=st.binary(max_size=60).filter(lambda noise: 0xFD not in noise))
def test_noise_between_frames_never_hides_one(noise: bytes) -> None:
    got = receiver().receive(HEARTBEAT + noise + ATTITUDE + noise + HEARTBEAT)
    assert names(got) == ["HEARTBEAT", "ATTITUDE", "HEARTBEAT"]


def test_a_system_id_is_one_byte_and_not_zero() -> None:
    for wrong in (0, 256):
        with pytest.raises(ValueError, match="1 to 255"):
            Endpoint(system_id=wrong)


def test_a_source_that_sends_too_much_is_not_heard_out_and_the_others_are() -> None:
    loud, quiet, end = Endpoint(system_id=7), Endpoint(system_id=8), receiver()
    for _ in range(BYTES_OUT // len(HEARTBEAT)):
        loud.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
    quiet.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
    flood = loud.take()
    heard = end.receive(flood + flood[:3000] + quiet.take())
    assert heard[-1].get_srcSystem() == 8
    assert len(heard) == BYTES_OF_A_SOURCE // len(HEARTBEAT) + 1
    assert end.dropped == (len(flood) + 3000) // len(HEARTBEAT) + 1 - len(heard)
    assert len(end.receive(flood)) == len(flood) // len(HEARTBEAT)  # the next tick is another


def test_more_than_fits_is_not_sent_but_heartbeats_are() -> None:
    end = Endpoint(system_id=1)
    for _ in range(3000):
        end.send(dialect.MAVLink_attitude_message(0, 1, 1, 1, 1, 1, 1))
    end.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
    wire = end.take()
    assert BYTES_OUT - MAX_FRAME_BYTES < len(wire) <= BYTES_OUT
    heard = receiver().receive(wire)
    assert names(heard[-1:]) == ["HEARTBEAT"]
    assert (end.sent, end.dropped) == (len(heard), 3001 - len(heard))
    end.send(dialect.MAVLink_attitude_message(0, 1, 1, 1, 1, 1, 1))
    assert end.take()
