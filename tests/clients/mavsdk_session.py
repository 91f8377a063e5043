"""MAVSDK 4 flies a vehicle: `python -m tests.clients.mavsdk_session tcpout://127.0.0.1:5760`."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from math import cos, hypot, radians

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError, ActionResult
from mavsdk.plugins.log_files import LogFiles
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.offboard import Offboard, PositionNedYaw, VelocityNedYaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode, LandedState, Telemetry

from tests.clients.steps import expect, step, wait_for

HEIGHT_M = 10.0
RALLY_NORTH_M = 11.0
DEGREE_M = 111_319.49  # of latitude
GLOBAL_RELATIVE_ALT, RELATIVE_ALT_INT, MISSION = 3, 6, 0
TAKEOFF, WAYPOINT, RETURN, POLYGON_INSIDE, RALLY = 22, 16, 20, 5001, 5100


class Session:
    """One drone, found by MAVSDK."""

    def __init__(self, sdk: Mavsdk) -> None:
        system = sdk.first_autopilot(10.0)
        expect(system, "no autopilot within 10 s")
        self.system = system
        self.action, self.telemetry, self.offboard = Action(system), Telemetry(system), Offboard(system)
        self.param, self.missions, self.logs = Param(system), MissionRaw(system), LogFiles(system)
        self.texts: list[str] = []
        self.telemetry.subscribe_status_text(lambda text, _: self.texts.append(text.text))

    def healthy(self) -> str:
        """Like a real ArduCopter it tells little until it is asked for rates."""
        telemetry = self.telemetry
        for name in ("position", "velocity_ned", "health", "landed_state", "in_air", "home"):
            getattr(telemetry, f"set_rate_{name}")(10.0)
        wait_for("health_all_ok", self.telemetry.health_all_ok)
        return "all"

    def refused(self) -> str:
        """It is still booting."""
        try:
            self.action.arm()
        except ActionError as error:
            expect(error.result is ActionResult.FAILED, f"refused with {error}")
            return wait_for("the reason", self.reason)
        raise AssertionError("armed while it boots")

    def reason(self) -> str:
        return next((text for text in self.texts if text.startswith(("Arm:", "PreArm:"))), "")

    def mode(self) -> FlightMode:
        return self.telemetry.flight_mode()

    def height_m(self) -> float:
        return float(self.telemetry.position().relative_altitude_m)

    def north_east_m(self) -> tuple[float, float]:
        here, home = self.telemetry.position(), self.telemetry.home()
        scale = DEGREE_M
        east = (here.longitude_deg - home.longitude_deg) * scale * cos(radians(home.latitude_deg))
        return (here.latitude_deg - home.latitude_deg) * scale, east

    def is_at(self, north_m: float, east_m: float, height_m: float, within_m: float = 1.5) -> bool:
        north, east = self.north_east_m()
        return hypot(north - north_m, east - east_m, self.height_m() - height_m) < within_m

    def take_off(self) -> str:
        self.action.set_takeoff_altitude(HEIGHT_M)
        self.action.arm()
        wait_for("armed", self.telemetry.armed)
        self.action.takeoff()
        wait_for("in the air", self.telemetry.in_air)
        wait_for("on its height", lambda: abs(self.height_m() - HEIGHT_M) < 1.0)
        wait_for("takeoff over", lambda: self.telemetry.landed_state() == LandedState.IN_AIR)
        return f"{self.height_m():.1f} m"

    def go_to(self) -> str:
        home = self.telemetry.home()
        self.action.goto_location(
            home.latitude_deg + 20.0 / DEGREE_M, home.longitude_deg, home.absolute_altitude_m + 12.0, 0.0
        )
        wait_for("20 m north, 12 m up", lambda: self.is_at(20.0, 0.0, 12.0))
        return "20 m north, 12 m up"

    def fly_velocity(self) -> str:
        self.offboard.set_velocity_ned(VelocityNedYaw(0.0, 3.0, 0.0, 90.0))
        self.offboard.start()
        wait_for("3 m/s to the east", lambda: abs(self.telemetry.velocity_ned().east_m_s - 3.0) < 0.3)
        return "3 m/s to the east"

    def stop(self) -> str:
        self.offboard.stop()
        velocity = self.telemetry.velocity_ned
        wait_for("at rest", lambda: hypot(velocity().north_m_s, velocity().east_m_s) < 0.2)
        return f"{self.mode().name}"

    def fly_position(self) -> str:
        self.offboard.set_position_ned(PositionNedYaw(-5.0, 5.0, -8.0, 0.0))
        self.offboard.start()
        wait_for("5 m south, 5 m east, 8 m up", lambda: self.is_at(-5.0, 5.0, 8.0))
        self.offboard.stop()
        return "5 m south, 5 m east, 8 m up"

    def hold(self) -> str:
        self.action.hold()
        wait_for("HOLD", lambda: self.mode() == FlightMode.HOLD)
        before = self.north_east_m()
        time.sleep(1.0)
        after = self.north_east_m()
        expect(hypot(after[0] - before[0], after[1] - before[1]) < 1.0, "it drifts")
        return "stays"

    def parameters(self) -> str:
        everything = self.param.get_all_params()
        count = len(everything.int_params) + len(everything.float_params)
        expect(count > 100, f"only {count} parameters")
        before = self.param.get_param_float("WPNAV_SPEED")
        self.param.set_param_float("WPNAV_SPEED", 700.0)
        expect(self.param.get_param_float("WPNAV_SPEED") == 700.0, "WPNAV_SPEED was not stored")
        self.param.set_param_float("WPNAV_SPEED", before)
        return f"{count} parameters"

    def items(self) -> list[MissionItem]:
        home = self.telemetry.home()

        def item(seq: int, command: int, north_m: float = 0.0, east_m: float = 0.0, up_m: float = 0.0) -> MissionItem:
            latitude = home.latitude_deg + north_m / DEGREE_M
            longitude = home.longitude_deg + east_m / (DEGREE_M * cos(radians(home.latitude_deg)))
            nowhere = command == RETURN
            return MissionItem(
                seq, RELATIVE_ALT_INT, command, int(seq == 0), 1, 0.0, 0.0, 0.0, 0.0,
                0 if nowhere else round(latitude * 1e7), 0 if nowhere else round(longitude * 1e7), up_m, MISSION,
            )  # fmt: skip

        return [
            item(0, WAYPOINT),  # ArduPilot: home
            item(1, TAKEOFF, up_m=8.0),
            item(2, WAYPOINT, 15.0, 0.0, 10.0),
            item(3, WAYPOINT, 15.0, 15.0, 10.0),
            item(4, RETURN),
        ]

    def upload(self) -> str:
        self.missions.upload_mission(self.items())
        return f"{len(self.items())} items"

    def download(self) -> str:
        got, sent = self.missions.download_mission(), self.items()
        expect(len(got) == len(sent), f"{len(got)} items came back of {len(sent)}")
        expect([(i.command, i.x, i.y) for i in got[1:]] == [(i.command, i.x, i.y) for i in sent[1:]], "other items")
        return f"{len(got)} items"

    def fly_mission(self) -> str:
        self.missions.start_mission()
        wait_for("MISSION", lambda: self.mode() == FlightMode.MISSION)
        wait_for("15 m north, 15 m east", lambda: self.is_at(15.0, 15.0, 10.0, within_m=3.0), timeout_s=60.0)
        return f"item {self.missions.mission_progress().current}"

    def come_home(self) -> str:
        """To the rally point, which is nearer than home."""
        self.action.return_to_launch()
        wait_for("RETURN_TO_LAUNCH", lambda: self.mode() == FlightMode.RETURN_TO_LAUNCH)

        def there() -> bool:
            north, east = self.north_east_m()
            return hypot(north - RALLY_NORTH_M, east) < 1.5

        wait_for("above the rally point", there, timeout_s=60.0)
        return "above the rally point"

    def land(self) -> str:
        self.action.land()
        wait_for("LAND", lambda: self.mode() == FlightMode.LAND)
        wait_for("on the ground", lambda: self.telemetry.landed_state() == LandedState.ON_GROUND, timeout_s=90.0)
        wait_for("disarmed", lambda: not self.telemetry.armed())
        return "and disarmed itself"

    def rally(self) -> str:
        home = self.telemetry.home()
        place = round((home.latitude_deg + RALLY_NORTH_M / DEGREE_M) * 1e7), round(home.longitude_deg * 1e7)
        self.missions.upload_rally_points(
            [MissionItem(0, GLOBAL_RELATIVE_ALT, RALLY, 0, 1, 0.0, 0.0, 0.0, 0.0, *place, 20.0, 2)]
        )
        got = self.missions.download_rallypoints()
        expect([(i.command, i.x, i.y) for i in got] == [(RALLY, *place)], f"other rally points: {got}")
        return "1 point"

    def fence(self) -> str:
        home = self.telemetry.home()
        x, y = round(home.latitude_deg * 1e7), round(home.longitude_deg * 1e7)
        corners = [(x + 9000, y + 9000), (x + 9000, y - 9000), (x - 9000, y - 9000), (x - 9000, y + 9000)]
        self.missions.upload_geofence(
            [MissionItem(n, 0, POLYGON_INSIDE, 0, 1, 4.0, 0.0, 0.0, 0.0, *at, 0.0, 1) for n, at in enumerate(corners)]
        )
        got = self.missions.download_geofence()
        expect([(i.command, i.x, i.y) for i in got] == [(POLYGON_INSIDE, *at) for at in corners], f"other fence: {got}")
        return "4 corners"

    def log_list(self) -> str:
        try:
            entries = self.logs.get_entries()
        except Exception as error:
            return error.result.name
        return f"{len(entries)} logs"

    def bad_command(self) -> str:
        """A relay it does not have: UNSUPPORTED, as ArduCopter says to what it does not know."""
        try:
            self.action.set_relay(0, 1)
        except ActionError as error:
            expect(error.result is ActionResult.UNSUPPORTED, f"refused with {error}")
            return error.result.name
        raise AssertionError("accepted")

    def steps(self) -> tuple[tuple[str, Callable[[], object]], ...]:
        """A day out."""
        return (
            ("arm refusal", self.refused),
            ("health_all_ok", self.healthy),
            ("parameters", self.parameters),
            ("bad command", self.bad_command),
            ("fence", self.fence),
            ("rally", self.rally),
            ("log list", self.log_list),
            ("takeoff", self.take_off),
            ("goto", self.go_to),
            ("velocity offboard", self.fly_velocity),
            ("offboard stopped", self.stop),
            ("position offboard", self.fly_position),
            ("hold", self.hold),
            ("mission up", self.upload),
            ("mission down", self.download),
            ("mission flown", self.fly_mission),
            ("return", self.come_home),
            ("land", self.land),
        )


def main(url: str) -> None:
    sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    sdk.add_any_connection(url)
    fly(sdk)


def fly(sdk: Mavsdk, kind: type[Session] = Session) -> None:
    """Every step, in the order of a day out."""
    drones: list[Session] = []
    step("discovery", lambda: drones.append(kind(sdk)))
    drone = drones[0]
    for name, action in drone.steps():
        step(name, action)


if __name__ == "__main__":
    main(sys.argv[1])
