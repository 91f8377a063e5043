"""AUTO: missions are flown as ArduCopter flies them, with its texts."""

from __future__ import annotations

from itertools import pairwise
from math import cos, dist, hypot, pi, radians

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from tests.vehicle_sim.autopilot.ground_station import AUTO, GUIDED, HOME, LOITER, GroundStation, flying, ready
from tests.vehicle_sim.autopilot.test_plans import upload
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.vehicle import VehicleConfig

ACCEPTED, DENIED, FAILED = 0, 2, 4
METERS = 111319.49079327357
HOME_ITEM = Item(16)


def at(north: float, east: float, height: float, command: int = 16, **fields: float) -> Item:
    """A command at a place in meters from home."""
    return Item(
        command, 3, **fields,
        x=round((HOME.latitude_deg + north / METERS) * 1e7),
        y=round((HOME.longitude_deg + east / METERS / cos(radians(HOME.latitude_deg))) * 1e7),
        z=height,
    )  # type: ignore[arg-type]  # fmt: skip


TAKEOFF = Item(22, 3, z=10.0)


def started(*items: Item, config: VehicleConfig | None = None) -> GroundStation:
    """Armed, and the mission started."""
    station = ready(config)
    assert upload(station, (HOME_ITEM, *items)) == ACCEPTED
    assert station.order(400, 1) == ACCEPTED
    assert station.order(300) == ACCEPTED
    return station


def place(station: GroundStation) -> tuple[float, float, float]:
    return station.vehicle.truth.position_ned_m


def until(station: GroundStation, text: str, *, longest_s: float = 120.0) -> float:
    """Wait for a text; the seconds it took."""
    began_s = station.now_s
    while text not in station.texts():
        assert station.now_s - began_s < longest_s, f"{text!r} never came; said: {station.texts()}"
        station.tick()
    return station.now_s - began_s


def test_a_whole_mission_with_its_texts() -> None:
    station = started(TAKEOFF, at(30, 0, 15), at(30, 20, 15, param1=3), Item(20))
    way = []
    while station.vehicle.truth.armed and station.now_s < 200.0:
        station.tick()
        way.append(place(station))
    said = [text for text in station.texts() if text.startswith(("Mission", "Reached", "Disarming"))]
    assert said == [
        "Mission: 1 Takeoff", "Mission: 2 WP", "Reached command #2", "Mission: 3 WP", "Reached command #3",
        "Mission: 4 RTL", "Disarming motors",
    ]  # fmt: skip
    assert [message.seq for _, message in station.all("MISSION_ITEM_REACHED")] == [1, 2, 3, 4]
    for corner in ((30.0, 0.0, -15.0), (30.0, 20.0, -15.0)):
        assert min(dist(spot, corner) for spot in way) < 2.1  # WPNAV_RADIUS
    assert place(station) == pytest.approx((0.0, 0.0, 0.0), abs=0.5)
    assert station.vehicle.mode_name == "AUTO"


def test_hold_time_counts_from_the_arrival() -> None:
    station = started(TAKEOFF, at(20, 0, 10, param1=7), Item(17))
    until(station, "Mission: 2 WP")
    while dist(place(station), (20.0, 0.0, -10.0)) > 2.0:
        station.tick()
    assert until(station, "Reached command #2") == pytest.approx(7.0, abs=0.3)
    assert place(station) == pytest.approx((20.0, 0.0, -10.0), abs=0.2)


def test_speed_changes_beside_the_way() -> None:
    station = started(TAKEOFF, Item(178, 0, 1.0, 3.0), at(60, 0, 10), Item(17))
    until(station, "Mission: 3 WP")
    station.tick(seconds=8.0)
    assert station.vehicle.truth.velocity_ned_m_s[0] == pytest.approx(3.0, abs=0.1)
    assert "Mission: 2 ChangeSpeed" in station.texts()


def test_straight_on_it_does_not_slow_down_and_round_a_corner_it_does() -> None:
    def slowest_near(corner: tuple[float, float], *ways: Item) -> float:
        station = started(TAKEOFF, *ways, Item(17))
        speeds = []
        while station.now_s < 45.0:
            station.tick()
            if dist(place(station)[:2], corner) < 4.0 and station.vehicle.autopilot.mission.current >= 2:
                speeds.append(hypot(*station.vehicle.truth.velocity_ned_m_s[:2]))
        return min(speeds)

    assert slowest_near((60.0, 0.0), at(60, 0, 10), at(160, 0, 10)) > 8.0
    assert slowest_near((60.0, 0.0), at(60, 0, 10), at(60, 80, 10)) < 4.0


def test_jumps_are_counted() -> None:
    station = started(TAKEOFF, at(15, 0, 10), at(0, 15, 10), Item(177, 0, 2.0, 2.0), Item(21))
    while station.vehicle.truth.armed and station.now_s < 200.0:
        station.tick()
    said = [text for text in station.texts() if text.startswith("Mission")]
    assert said[:-1] == ["Mission: 1 Takeoff", *["Mission: 2 WP", "Mission: 3 WP"] * 3, "Mission: 5 Land"]
    assert said[-1] == "Mission: 1 Takeoff"  # disarmed in AUTO, it is ready to begin again


def test_a_mission_of_jumps_alone_ends() -> None:
    station = ready()
    upload(station, (HOME_ITEM, TAKEOFF, Item(177, 0, 2.0, -1.0)))
    station.order(400, 1)
    assert station.order(300) == ACCEPTED
    station.tick(seconds=20.0)
    assert place(station)[2] == pytest.approx(-10.0, abs=0.2)  # taken off, and at the end of the mission it stays


def test_turns_go_round_a_place() -> None:
    station = started(TAKEOFF, at(30, 0, 10, 18, param1=2, param3=10), Item(17))
    until(station, "Mission: 2 LoitTurns")
    station.tick(seconds=8.0)
    bearings, distances = [], []
    while "Mission: 3 LoitUnlim" not in station.texts():
        station.tick()
        north, east, _ = place(station)
        distances.append(hypot(north - 30.0, east))
        bearings.append(east)
    assert all(abs(distance - 10.0) < 1.5 for distance in distances)
    turns = sum(a < 0.0 <= b for a, b in pairwise(bearings))
    assert turns == pytest.approx(2, abs=1)


def test_loiter_time_delay_and_height() -> None:
    station = started(
        TAKEOFF, at(10, 0, 10, 19, param1=4), Item(93, 0, 3.0), at(10, 0, 25, 31), Item(17)
    )  # fmt: skip
    until(station, "Mission: 3 Delay")
    assert station.texts()[-1] == "Delaying 3 sec"
    assert until(station, "Mission: 4 LoitAltitude") == pytest.approx(3.0, abs=0.2)
    until(station, "Mission: 5 LoitUnlim")
    assert place(station) == pytest.approx((10.0, 0.0, -25.0), abs=0.3)


def test_the_nose_points_ahead_and_where_it_is_told() -> None:
    station = started(TAKEOFF, at(0, 40, 10), Item(115, 0, 0.0), Item(17))
    until(station, "Mission: 2 WP")
    station.tick(seconds=5.0)
    assert station.vehicle.truth.yaw_rad == pytest.approx(pi / 2, abs=0.05)
    until(station, "Mission: 3 CondYaw")
    station.tick(seconds=5.0)
    assert station.vehicle.truth.yaw_rad == pytest.approx(0.0, abs=0.05)


def test_land_at_a_place_ends_the_mission() -> None:
    station = started(TAKEOFF, at(12, 5, 0, 21))
    while station.vehicle.truth.armed and station.now_s < 120.0:
        station.tick()
    assert place(station) == pytest.approx((12.0, 5.0, 0.0), abs=0.5)
    assert "Disarming motors" in station.texts()


def test_land_and_take_off_again() -> None:
    station = started(TAKEOFF, Item(21), TAKEOFF, Item(17))
    until(station, "Mission: 3 Takeoff")
    assert station.vehicle.truth.on_ground
    until(station, "Mission: 4 LoitUnlim")
    assert place(station)[2] == pytest.approx(-10.0, abs=0.2)


def test_auto_on_the_ground_waits_for_the_start() -> None:
    station = ready()
    upload(station, (HOME_ITEM, TAKEOFF))
    station.order(400, 1)
    assert station.order(176, 1, AUTO) == ACCEPTED
    station.tick(seconds=4.0)
    assert station.vehicle.truth.on_ground  # the throttle is down, nobody said to start
    assert station.order(300) == ACCEPTED
    station.tick(seconds=6.0)
    assert not station.vehicle.truth.on_ground


@pytest.mark.parametrize("items", [(), (HOME_ITEM, at(10, 0, 10))])
def test_no_auto_without_a_takeoff(items: tuple[Item, ...]) -> None:
    station = ready()
    if items:
        upload(station, items)
    station.order(400, 1)
    assert station.order(300) == FAILED
    texts = [text for text in station.texts() if "Auto:" in text or "AUTO" in text]
    missing = ["Auto: Missing Takeoff Cmd"] if items else []
    assert texts == [*missing, "Mode change to AUTO failed: init failed"]


def test_left_and_entered_again_it_goes_on_where_it_was() -> None:
    station = started(TAKEOFF, at(40, 0, 10), at(40, 40, 10), Item(17))
    until(station, "Mission: 3 WP")
    station.order(176, 1, GUIDED)
    station.tick(seconds=2.0)
    station.order(512, 42)
    current = station.last("MISSION_CURRENT")
    assert (current.seq, current.total, current.mission_state, current.mission_mode) == (3, 4, 4, 0)
    station.order(176, 1, AUTO)
    until(station, "Mission: 4 LoitUnlim")
    assert place(station)[1] == pytest.approx(40.0, abs=3.0)
    station.order(512, 42)
    assert station.last("MISSION_CURRENT").mission_state == 3


def test_the_current_item_is_chosen() -> None:
    station = started(TAKEOFF, at(40, 0, 10), at(0, 40, 10), Item(17))
    until(station, "Mission: 2 WP")
    assert station.order(224, 9) == DENIED
    assert station.order(224, 3) == ACCEPTED
    assert station.last("MISSION_CURRENT").seq == 3
    until(station, "Mission: 4 LoitUnlim")
    assert place(station)[0] < 5.0
    station.tick(dialect.MAVLink_mission_set_current_message(3, 1, 2))
    until(station, "Reached command #2")


def test_a_mission_changed_in_flight_is_taken_up() -> None:
    station = started(TAKEOFF, at(80, 0, 10), Item(17))
    until(station, "Mission: 2 WP")
    assert upload(station, (HOME_ITEM, TAKEOFF, at(0, 30, 10), Item(17))) == ACCEPTED
    assert "Auto mission changed, restarted command" in station.texts()
    until(station, "Mission: 3 LoitUnlim")
    assert place(station)[:2] == pytest.approx((0.0, 30.0), abs=3.0)


def test_a_shorter_mission_in_flight_ends_and_it_stays() -> None:
    station = started(TAKEOFF, at(30, 0, 10), at(60, 0, 10), Item(17))
    until(station, "Mission: 3 WP")
    assert upload(station, (HOME_ITEM, TAKEOFF)) == ACCEPTED
    station.tick(seconds=8.0)
    here = place(station)
    station.tick(seconds=5.0)
    assert place(station) == pytest.approx(here, abs=0.5)
    assert station.vehicle.truth.armed


def test_a_running_mission_is_not_cleared() -> None:
    station = started(TAKEOFF, Item(17))
    station.tick(dialect.MAVLink_mission_clear_all_message(3, 1, 0))
    assert station.last("MISSION_ACK").type == 1
    station.tick(seconds=12.0)
    station.order(176, 1, LOITER)
    station.tick(dialect.MAVLink_mission_clear_all_message(3, 1, 0))
    assert station.last("MISSION_ACK").type == ACCEPTED


def test_an_old_guided_order_is_an_item() -> None:
    station = flying()
    item = at(10, 10, 15)
    station.tick(
        dialect.MAVLink_mission_item_message(
            3, 1, 0, 3, 16, 2, 1, 0, 0, 0, 0, item.latitude_deg, item.longitude_deg, 15
        )
    )
    assert station.last("MISSION_ACK").type == ACCEPTED
    station.tick(seconds=15.0)
    assert place(station) == pytest.approx((10.0, 10.0, -15.0), abs=0.5)


def test_ideal_vehicles_fly_missions_too() -> None:
    station = started(TAKEOFF, at(40, 0, 10), at(80, 0, 10), Item(20), config=VehicleConfig(kind="ideal"))
    while station.vehicle.truth.armed and station.now_s < 150.0:
        station.tick()
    assert place(station) == pytest.approx((0.0, 0.0, 0.0), abs=0.6)
    assert "Reached command #3" in station.texts()
