"""A mavutil script flies a vehicle: `python -m tests.clients.mavutil_session tcp:127.0.0.1:5760`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from math import hypot, nan
from typing import Any

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

from tests.clients.steps import expect, step, wait_for

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4
GUIDED, LAND = 4, 9
VELOCITY_MASK = 0xDC7
WATCHDOG_S = 3.0  # of the vehicle's time
HEIGHT_M = 10.0
STREAMS = (1, 24, 32, 33, 74, 193, 245)


class Session:
    """One vehicle on one link. `recv_match` fills `link.messages`, which remembers the newest of each type."""

    identity = (2, 3)  # MAV_TYPE and MAV_AUTOPILOT

    def __init__(self, url: str) -> None:
        self.link: Any = mavutil.mavlink_connection(url, source_system=255)
        self.texts: list[str] = []
        self.acks: list[tuple[int, int]] = []
        self.link.message_hooks.append(self._hear)
        beat = self.link.wait_heartbeat(timeout=10.0)
        expect(beat is not None, "no heartbeat within 10 s")
        expect((beat.type, beat.autopilot) == self.identity, f"another autopilot: {beat}")

    def _hear(self, link: Any, message: Any) -> None:
        if message.get_type() == "STATUSTEXT":
            self.texts.append(message.text)
        elif message.get_type() == "COMMAND_ACK":
            self.acks.append((message.command, message.result))

    def see(self, kind: str) -> Any:
        """The newest message of a kind, after taking in all that waits."""
        while self.link.recv_match(blocking=False) is not None:
            pass
        return self.link.messages.get(kind)

    def next(self, kind: str, timeout_s: float = 5.0) -> Any:
        message = self.link.recv_match(type=kind, blocking=True, timeout=timeout_s)
        expect(message is not None, f"no {kind} within {timeout_s:g} s")
        return message

    def command(self, number: int, *params: float) -> int:
        """The result of a command, or an error if none comes."""
        self.acks.clear()
        self.link.mav.command_long_send(1, 1, number, 0, *params, *[0.0] * (7 - len(params)))
        return wait_for(f"COMMAND_ACK of {number}", lambda: (self.see("COMMAND_ACK"), self.acks)[1] and self.acks[-1:])[
            0
        ][1]

    def text(self, beginning: str) -> str:
        def said() -> str:
            self.see("STATUSTEXT")
            return next((text for text in self.texts if text.startswith(beginning)), "")

        return wait_for(f'a text "{beginning}..."', said)

    def refused(self) -> str:
        expect(self.command(400, 1) == FAILED, "arming was not refused while it boots")
        return self.text("Arm: ")

    def bad_commands(self) -> str:
        expect(self.command(31_999) == UNSUPPORTED, "an unknown command")
        expect(self.command(22, 0, 0, 0, nan, 0, 0, 10) == FAILED, "takeoff though disarmed")
        expect(self.command(511, 30, -7) == DENIED, "a negative interval")
        expect(self.command(176, 1, 99) == FAILED, "an unknown mode")
        self.link.mav.command_long_send(77, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
        self.acks.clear()
        self.link.recv_match(type="COMMAND_ACK", blocking=True, timeout=1.0)
        expect(self.acks == [], "it answers for another system")
        return "refused as ArduCopter refuses them"

    def rates(self) -> str:
        for message_id in STREAMS:
            expect(self.command(511, message_id, 100_000) == ACCEPTED, f"no rate for {message_id}")
        return f"{len(STREAMS)} messages"

    def ready(self) -> str:
        wait_for(
            "the PREARM bit", lambda: (s := self.see("SYS_STATUS")) and s.onboard_control_sensors_health & 0x10000000
        )
        wait_for("LOCAL_POSITION_NED", lambda: self.see("LOCAL_POSITION_NED"))
        return self.text("EKF3 IMU0 is using GPS")

    def parameters(self) -> str:
        self.link.mav.param_request_list_send(1, 1)
        first = self.next("PARAM_VALUE")
        got = {first.param_index: first}
        while len(got) < first.param_count:
            message = self.next("PARAM_VALUE")
            got[message.param_index] = message
        self.link.mav.param_set_send(1, 1, b"RTL_ALT", 2000.0, 6)
        stored = self.next("PARAM_VALUE")
        expect((stored.param_id, stored.param_value, stored.param_type) == ("RTL_ALT", 2000.0, 6), f"stored {stored}")
        self.link.mav.param_request_read_send(1, 1, b"NO_SUCH_NAME", -1)
        expect(self.next("PARAM_ERROR").param_id == "NO_SUCH_NAME", "an unknown name")
        return f"{len(got)} parameters"

    def height_m(self) -> float:
        place = self.see("LOCAL_POSITION_NED")
        return 0.0 if place is None else -place.z

    def take_off(self) -> str:
        self.link.set_mode("GUIDED")
        wait_for("GUIDED", lambda: (b := self.see("HEARTBEAT")) and b.custom_mode == GUIDED)
        expect(self.command(400, 1) == ACCEPTED, "arm")
        expect(
            self.link.motors_armed() or wait_for("armed", lambda: (self.see("HEARTBEAT"), self.link.motors_armed())[1]),
            "",
        )
        expect(self.command(22, 0, 0, 0, nan, 0, 0, HEIGHT_M) == ACCEPTED, "takeoff")
        wait_for("on its height", lambda: abs(self.height_m() - HEIGHT_M) < 0.5)
        return f"{self.height_m():.1f} m"

    def fly_velocity(self) -> str:
        def speed() -> bool:
            self.link.mav.set_position_target_local_ned_send(
                0, 1, 1, 1, VELOCITY_MASK, nan, nan, nan, 3.0, 0.0, 0.0, nan, nan, nan, 0.0, 0.0
            )
            return abs(self.see("LOCAL_POSITION_NED").vx - 3.0) < 0.2

        wait_for("3 m/s to the north", speed)
        return "3 m/s to the north"

    def watchdog(self) -> str:
        """Nobody speaks any more: it goes on for three seconds of its time, brakes, and stays in GUIDED."""
        began_s = self.see("LOCAL_POSITION_NED").time_boot_ms / 1000.0
        wait_for("at rest", lambda: hypot((p := self.see("LOCAL_POSITION_NED")).vx, p.vy) < 0.1)
        spent_s = self.link.messages["LOCAL_POSITION_NED"].time_boot_ms / 1000.0 - began_s
        expect(spent_s + 0.5 >= WATCHDOG_S, f"at rest after {spent_s:.1f} s already")
        expect(self.link.messages["HEARTBEAT"].custom_mode == GUIDED, "it left GUIDED")
        return f"at rest after {spent_s:.1f} s"

    def disarm_refused(self) -> str:
        expect(self.command(400, 0) == FAILED, "disarmed in the air")
        return "FAILED in the air"

    def land(self) -> str:
        self.link.set_mode(LAND)
        wait_for("LAND", lambda: (b := self.see("HEARTBEAT")) and b.custom_mode == LAND)
        wait_for("disarmed", lambda: (self.see("HEARTBEAT"), not self.link.motors_armed())[1], timeout_s=90.0)
        return self.text("Disarming motors")

    def steps(self) -> tuple[tuple[str, Callable[[], object]], ...]:
        """A day out."""
        return (
            ("arm refusal", self.refused),
            ("rates", self.rates),
            ("parameters", self.parameters),
            ("ready", self.ready),
            ("bad commands", self.bad_commands),
            ("takeoff", self.take_off),
            ("velocity setpoints", self.fly_velocity),
            ("watchdog", self.watchdog),
            ("disarm refusal", self.disarm_refused),
            ("land", self.land),
        )


def fly(url: str, kind: type[Session] = Session) -> None:
    """Every step, in the order of a day out."""
    found: list[Session] = []
    step("discovery", lambda: found.append(kind(url)))
    for name, action in found[0].steps():
        step(name, action)


if __name__ == "__main__":
    fly(sys.argv[1])
