"""Ten thousand frames of the storm, and what makes the storm worth something: it reaches every message type and every
state of flight, it repeats, and what it finds becomes small."""

from __future__ import annotations

from collections import Counter
from math import nan
from random import Random

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.mavlink import Endpoint
from tests.fuzz.__main__ import play_batch
from tests.fuzz.episode import GROUND, Episode, Shot, make_episode
from tests.fuzz.hostile import frame_of, storm_frame
from tests.fuzz.laws import VEHICLE_LAWS, Broken, Tick, frame_ids, is_small, keeps_to_its_limits
from tests.fuzz.layouts import LAYOUTS
from tests.fuzz.play import play, shrink
from tests.fuzz.sessions import SYSTEM, TAKEOFF, order, take_off
from tests.fuzz.subjects import PilotUnderFire, VehicleUnderFire
from vehicle_sim.autopilot.ardupilot import commands
from vehicle_sim.vehicle import VehicleTruth

SEED = 20
FRAMES = 10_000
DO_SET_ROI = 201
BY_NAME = {law.__name__: law for law in VEHICLE_LAWS}


def test_ten_thousand_frames_break_no_law_and_meet_vehicles_in_every_state() -> None:
    frames, states = 0, Counter[str]()
    for first in range(0, 10_000, 25):
        tally = play_batch(SEED, first)
        assert not tally.failures, f"seed {SEED}, episode {tally.failures[0][0]}: {tally.failures[0][1].trace}"
        frames += tally.frames
        states += tally.states
        if frames >= FRAMES:
            break
    assert frames >= FRAMES
    for state in (
        "GUIDED armed up",
        "RTL armed up",
        "LAND armed up",
        "STABILIZE safe down",
        "pilot flying",
        "OFFBOARD armed up",
        "HOLD armed up",
        "MISSION armed up",
        "HOLD safe down",
    ):
        assert states[state] > 10, states


def test_every_message_type_gets_past_the_checksum() -> None:
    rng = Random(SEED)
    for layout in LAYOUTS:
        receiver = Endpoint(system_id=SYSTEM)
        wires = [frame_of(rng, layout, GROUND) for _ in range(3)]
        assert [message.get_msgId() for message in receiver.receive(b"".join(wires))] == [layout.id] * 3, layout.name
        assert receiver.bad == 0


def test_some_of_the_storm_is_damaged() -> None:
    rng, receiver = Random(SEED), Endpoint(system_id=SYSTEM)
    for _ in range(500):
        receiver.receive(storm_frame(rng, GROUND))
    assert receiver.received > 400
    assert receiver.bad > 20


def test_a_seed_and_a_number_make_the_same_episode() -> None:
    assert make_episode(SEED, 7) == make_episode(SEED, 7)
    assert make_episode(SEED, 7) != make_episode(SEED, 8) != make_episode(SEED + 1, 8)


def test_a_failure_is_found_and_shrunk_to_the_frame_that_does_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def raises_in_the_air(request: commands.Request) -> commands.Result:
        assert request.pilot.airframe.on_ground
        return commands.Result.ACCEPTED

    monkeypatch.setitem(commands.COMMANDS, DO_SET_ROI, raises_in_the_air)
    station, shots = Endpoint(system_id=255), [Shot(1.0, (), 0.0)] * 3
    storm = [storm_frame(Random(k), GROUND) for k in range(40)]
    for turn in [*take_off(Random(SEED)), [order(DO_SET_ROI)], []]:
        for message in turn:
            station.send(message)
        shots.append(Shot(0.5, (*storm[len(shots) : len(shots) + 1], station.take()), 0.0))
    episode = Episode("vehicle", "ardupilot", "simulated", 2.0, tuple(shots))
    failure = play(episode)
    assert failure is not None
    assert "raises_in_the_air" in failure.what
    small, again = shrink(episode, failure)
    assert again.what == failure.what
    assert small.frames == 4  # GUIDED, arm, take off, and the one that hurts
    assert len(small.shots) < len(shots) / 2


STILL = VehicleTruth(
    position_ned_m=(0.0, 0.0, -5.0), velocity_ned_m_s=(0.0, 0.0, 0.0), roll_rad=0.0, pitch_rad=0.0, yaw_rad=0.0,
    on_ground=False, armed=True,
)  # fmt: skip


def _truth(position_ned_m: tuple[float, float, float], velocity_ned_m_s: tuple[float, float, float]) -> VehicleTruth:
    return VehicleTruth(
        position_ned_m=position_ned_m, velocity_ned_m_s=velocity_ned_m_s, roll_rad=0.0, pitch_rad=0.0, yaw_rad=0.0,
        on_ground=False, armed=True,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("law", "after", "wire_out"),
    [
        ("stays_finite", _truth((nan, 0.0, -5.0), (0.0, 0.0, 0.0)), b""),
        ("stays_finite", _truth((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), b""),
        ("moves_as_far_as_its_speed", _truth((3.0, 0.0, -5.0), (1.0, 0.0, 0.0)), b""),
        ("speeds_up_as_thrust_drag_and_gravity_can", _truth((0.0, 0.0, -5.0), (2.0, 0.0, 0.0)), b""),
        ("speeds_up_as_thrust_drag_and_gravity_can", _truth((0.0, 0.0, -5.0), (0.0, 0.0, 3.0)), b""),
        ("says_no_more_than_it_may", STILL, bytes(100_000)),
    ],
)
def test_a_law_can_fail(law: str, after: VehicleTruth, wire_out: bytes) -> None:
    vehicle = VehicleUnderFire(make_episode(SEED, 0)).vehicle
    with pytest.raises(Broken):
        BY_NAME[law](Tick(vehicle, STILL, after, 0.1, 1.0, wire_out, False, 0.0))
    for each in VEHICLE_LAWS:
        each(Tick(vehicle, STILL, STILL, 0.1, 1.0, b"", False, 0.0))


def test_the_laws_of_the_pilot_and_of_memory_can_fail() -> None:
    pilot = PilotUnderFire(make_episode(SEED, 0)).pilot
    sender = Endpoint(system_id=255)
    sender.send(order(TAKEOFF, 0, 0, 0, 0, 0, 0, 5000.0))
    with pytest.raises(Broken, match="takes off"):
        keeps_to_its_limits(sender.take(), pilot.config)
    sender.send(dialect.MAVLink_set_position_target_local_ned_message(0, 3, 1, 1, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0))
    with pytest.raises(Broken, match="too fast"):
        keeps_to_its_limits(sender.take(), pilot.config)
    is_small(pilot)
    pilot._cockpit.warnings += ["again"] * 6000
    with pytest.raises(Broken, match="6000 items"):
        is_small(pilot)
    with pytest.raises(Broken, match="no frame"):
        list(frame_ids(b"\xfe123456789012"))
