"""A mavutil script flies a PX4: `python -m tests.clients.mavutil_px4_session tcp:127.0.0.1:5760`."""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable
from math import nan

from tests.clients.mavutil_session import ACCEPTED, DENIED, FAILED, HEIGHT_M, UNSUPPORTED, VELOCITY_MASK, Session, fly
from tests.clients.steps import expect, wait_for

REJECTED = 1
OFFBOARD, HOLD, RTL, LAND = 0x00060000, 0x03040000, 0x05040000, 0x06040000
INT32 = 6
WATCHDOG_S = 1.0  # of the vehicle's time


class Px4Session(Session):
    """One PX4, by mavutil's own words for its modes."""

    identity = (2, 12)

    def refused(self) -> str:
        expect(self.command(400, 1) == REJECTED, "arming was not refused while it boots")
        return self.text("Preflight Fail: ")

    def bad_commands(self) -> str:
        expect(self.command(31_999) == UNSUPPORTED, "an unknown command")
        expect(self.command(511, 30, -7) == FAILED, "a negative interval")
        expect(self.command(176, 1, 99) == REJECTED, "an unknown mode")
        expect(self.command(300) == DENIED, "no mission")
        return "refused as PX4 refuses them"

    def rates(self) -> str:
        """They flow unasked; one is asked for faster."""
        wait_for("ATTITUDE", lambda: self.see("ATTITUDE"))
        expect(self.command(511, 32, 100_000) == ACCEPTED, "no rate for LOCAL_POSITION_NED")
        return "unasked"

    def ready(self) -> str:
        wait_for(
            "the PREARM bit", lambda: (s := self.see("SYS_STATUS")) and s.onboard_control_sensors_health & 0x10000000
        )
        return self.text("Ready for takeoff!")

    def parameters(self) -> str:
        self.link.mav.param_request_list_send(1, 1)
        first = self.next("PARAM_VALUE")
        expect(first.param_id == "_HASH_CHECK", f"not the hash, but {first.param_id}")
        got = set()
        while len(got) < first.param_count:
            got.add(self.next("PARAM_VALUE").param_index)
        wired = struct.unpack("<f", struct.pack("<i", 5))[0]
        self.link.mav.param_set_send(1, 1, b"COM_OBL_RC_ACT", wired, INT32)
        stored = self.next("PARAM_VALUE")
        value = struct.unpack("<i", struct.pack("<f", stored.param_value))[0]
        expect((stored.param_id, value, stored.param_type) == ("COM_OBL_RC_ACT", 5, INT32), f"stored {stored}")
        return f"{len(got)} parameters"

    def take_off(self) -> str:
        here = self.next("GPS_RAW_INT").alt / 1000.0
        expect(self.command(400, 1) == ACCEPTED, "arm")
        expect(self.command(22, 0, 0, 0, nan, nan, nan, here + HEIGHT_M) == ACCEPTED, "takeoff")
        wait_for("on its height", lambda: abs(self.height_m() - HEIGHT_M) < 0.5)
        wait_for("HOLD", lambda: self.see("HEARTBEAT").custom_mode == HOLD)
        return f"{self.height_m():.1f} m"

    def ask(self) -> None:
        self.link.mav.set_position_target_local_ned_send(
            0, 1, 1, 1, VELOCITY_MASK, nan, nan, nan, 3.0, 0.0, 0.0, nan, nan, nan, 0.0, 0.0
        )

    def fly_velocity(self) -> str:
        expect(self.command(176, 1, 6) == REJECTED, "OFFBOARD without setpoints")
        self.ask()
        self.link.set_mode("OFFBOARD")

        def speed() -> bool:
            self.ask()
            return abs(self.see("LOCAL_POSITION_NED").vx - 3.0) < 0.2

        wait_for("3 m/s to the north", speed)
        expect(self.see("HEARTBEAT").custom_mode == OFFBOARD, "not in OFFBOARD")
        return "3 m/s to the north"

    def watchdog(self) -> str:
        """Nobody speaks any more: after a second of its time it does what COM_OBL_RC_ACT says, and comes back."""
        began_s = self.see("LOCAL_POSITION_NED").time_boot_ms / 1000.0
        wait_for("HOLD", lambda: self.see("HEARTBEAT").custom_mode == HOLD)
        spent_s = self.see("LOCAL_POSITION_NED").time_boot_ms / 1000.0 - began_s
        expect(spent_s + 0.5 >= WATCHDOG_S, f"it left after {spent_s:.1f} s already")
        self.ask()
        wait_for("OFFBOARD", lambda: (self.ask(), self.see("HEARTBEAT").custom_mode == OFFBOARD)[1])
        return f"HOLD after {spent_s:.1f} s, and back"

    def disarm_refused(self) -> str:
        expect(self.command(400, 0) == REJECTED, "disarmed in the air")
        return "TEMPORARILY_REJECTED in the air"

    def come_home(self) -> str:
        self.link.set_mode("RTL")
        wait_for("RTL", lambda: self.see("HEARTBEAT").custom_mode == RTL)
        return "on its way"

    def land(self) -> str:
        self.link.set_mode("LAND")
        wait_for("LAND", lambda: self.see("HEARTBEAT").custom_mode == LAND)
        wait_for("disarmed", lambda: (self.see("HEARTBEAT"), not self.link.motors_armed())[1], timeout_s=90.0)
        return self.text("Disarmed by landing")

    def steps(self) -> tuple[tuple[str, Callable[[], object]], ...]:
        *most, land = super().steps()
        return (*most, ("return", self.come_home), land)


if __name__ == "__main__":
    fly(sys.argv[1], Px4Session)
