"""Signed links: only who has the key is heard, nobody else can get in the way, and old frames stay old."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Endpoint
from comms.signing import EPOCH_2015_S, MAX_STREAMS, TICKS_PER_S, KeyFileError, Signing, read_key
from tests.comms.test_mavlink import ATTITUDE, HEARTBEAT

KEY, OTHER_KEY = hashlib.sha256(b"swordfish").digest(), hashlib.sha256(b"trout").digest()
NOW_S = 1_800_000_000.0


class Clock:
    def __init__(self, now_s: float = NOW_S) -> None:
        self.now_s = now_s

    def __call__(self) -> float:
        return self.now_s


def party(system_id: int, *, key: bytes = KEY, clock: Clock | None = None, link_id: int = 0) -> Endpoint:
    return Endpoint(system_id=system_id, signing=Signing(key, unix_time=clock or Clock(), link_id=link_id))


def beat(end: Endpoint) -> bytes:
    end.send(dialect.MAVLink_heartbeat_message(2, 3, 217, 4, 4, 3))
    return end.take()


def heard(end: Endpoint, wire: bytes) -> int:
    return len(end.receive(wire))


def stamped(wire: bytes, stamp: int, key: bytes) -> bytes:
    """The same frame with another time stamp, signed with `key`."""
    body = wire[:-12] + stamp.to_bytes(6, "little")
    return body + hashlib.sha256(key + body).digest()[:6]


def pymavlink_party(key: bytes) -> Any:
    codec = dialect.MAVLink(None, srcSystem=255, srcComponent=190)
    codec.signing.secret_key = key
    codec.signing.timestamp = int((NOW_S - EPOCH_2015_S) * TICKS_PER_S)
    codec.signing.sign_outgoing = True
    return codec


def test_who_has_the_key_is_heard() -> None:
    vehicle, ground = party(1), party(255)
    assert [heard(vehicle, beat(ground)) for _ in range(5)] == [1] * 5
    assert [heard(ground, beat(vehicle)) for _ in range(5)] == [1] * 5
    assert vehicle.signing is not None
    assert (vehicle.signing.refused, vehicle.bad) == (0, 0)


def test_pymavlink_believes_us_and_we_believe_pymavlink() -> None:
    vehicle, theirs = party(1), pymavlink_party(KEY)
    assert theirs.decode(bytearray(beat(vehicle))).get_type() == "HEARTBEAT"
    assert theirs.signing.goodsig_count == 1
    assert heard(vehicle, dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(theirs)) == 1


def test_others_are_refused_and_counted() -> None:
    vehicle = party(1)
    old_protocol = bytes.fromhex("fe09e401010000000000020351030301f9")  # MAVLink 1: never heard
    assert heard(vehicle, HEARTBEAT + ATTITUDE + old_protocol + beat(party(255, key=OTHER_KEY))) == 0
    assert vehicle.signing is not None
    assert (vehicle.signing.unsigned, vehicle.signing.forged, vehicle.signing.stale) == (2, 1, 0)
    assert heard(vehicle, beat(party(255))) == 1


def test_a_forged_frame_from_the_far_future_locks_nobody_out() -> None:
    far = 2**48 - 2
    ground, vehicle = party(255), party(1)
    assert heard(vehicle, beat(ground)) == 1
    assert heard(vehicle, stamped(beat(ground), far, OTHER_KEY)) == 0
    assert heard(vehicle, beat(ground)) == 1
    # The same attack on pymavlink's own check does lock the genuine one out: why ours is our own.
    theirs = pymavlink_party(KEY)
    theirs.decode(bytearray(beat(ground)))
    with pytest.raises(dialect.MAVError):
        theirs.decode(bytearray(stamped(beat(ground), far, OTHER_KEY)))
    with pytest.raises(dialect.MAVError):
        theirs.decode(bytearray(beat(ground)))


@given(flipped=st.integers(0, 8 * (len(HEARTBEAT) + 13) - 1))
def test_no_flipped_bit_is_believed(flipped: int) -> None:
    ground, vehicle = party(255), party(1)
    wire = bytearray(beat(ground))
    wire[flipped // 8] ^= 1 << flipped % 8
    assert heard(vehicle, bytes(wire)) == 0
    vehicle.receive(bytes(600))  # whatever frame was open is now complete
    assert heard(vehicle, beat(ground)) == 1


def test_a_frame_is_heard_once() -> None:
    ground, vehicle = party(255), party(1)
    first, second = beat(ground), beat(ground)
    assert [heard(vehicle, wire) for wire in (second, second, first)] == [1, 0, 0]
    assert vehicle.signing is not None
    assert vehicle.signing.stale == 2


@pytest.mark.parametrize(("lag_s", "believed"), [(0.0, 1), (59.0, 1), (61.0, 0), (-3600.0, 1)])
def test_a_new_stream_may_lag_by_a_minute(lag_s: float, believed: int) -> None:
    vehicle = party(1)
    assert heard(vehicle, beat(party(255, clock=Clock(NOW_S - lag_s)))) == believed


def test_every_link_of_a_party_is_a_stream_of_its_own() -> None:
    vehicle, clock = party(1), Clock()
    assert heard(vehicle, beat(party(255, clock=clock))) == 1
    clock.now_s -= 30.0
    assert heard(vehicle, beat(party(255, clock=clock))) == 0
    assert heard(vehicle, beat(party(255, clock=clock, link_id=1))) == 1
    assert heard(vehicle, beat(party(254, clock=clock))) == 1


def test_a_vehicle_whose_clock_is_behind_catches_up() -> None:
    vehicle, ground = party(1, clock=Clock(EPOCH_2015_S)), party(255)
    assert heard(ground, beat(vehicle)) == 0
    assert heard(vehicle, beat(ground)) == 1
    assert heard(ground, beat(vehicle)) == 1


def test_streams_are_bounded() -> None:
    vehicle = party(1)
    parties = [party(1 + n % 255, link_id=n // 255) for n in range(MAX_STREAMS + 10)]
    assert sum(heard(vehicle, beat(end)) for end in parties) == MAX_STREAMS


def key_file(folder: Path, content: bytes, mode: int = 0o600) -> Path:
    path = folder / "key"
    path.write_bytes(content)
    path.chmod(mode)
    return path


@pytest.mark.parametrize("content", [b"swordfish", b"swordfish\n", b"swordfish\r\n"])
def test_a_passphrase_is_hashed_as_mavproxy_does(content: bytes, tmp_path: Path) -> None:
    assert read_key(key_file(tmp_path, content)) == KEY


def test_bytes_are_the_key_itself(tmp_path: Path) -> None:
    assert read_key(key_file(tmp_path, KEY, 0o400)) == KEY


@pytest.mark.parametrize("mode", [0o644, 0o640, 0o604, 0o660])
def test_a_key_that_others_may_read_is_refused(mode: int, tmp_path: Path) -> None:
    with pytest.raises(KeyFileError, match=rf"mode {mode:04o}; allowed: mode 0600"):
        read_key(key_file(tmp_path, KEY, mode))


@pytest.mark.parametrize("content", [b"", b"\n", KEY[:31], KEY + b"\x00", b"x" * 5000, "schlüssel".encode()])
def test_what_is_no_key_is_refused(content: bytes, tmp_path: Path) -> None:
    with pytest.raises(KeyFileError, match="allowed: 32 bytes, or a passphrase"):
        read_key(key_file(tmp_path, content))


def test_no_file_is_told(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none"):
        with pytest.raises(KeyFileError, match="ordinary file"):
            read_key(path)


def test_a_key_of_another_length_is_a_mistake_of_ours() -> None:
    with pytest.raises(ValueError, match="32 bytes"):
        Signing(b"short", unix_time=Clock())
