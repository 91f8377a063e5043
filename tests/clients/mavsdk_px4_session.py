"""MAVSDK 4 flies a PX4, whose own client it is: `python -m tests.clients.mavsdk_px4_session tcpout://127.0.0.1:5760`."""

from __future__ import annotations

import sys
from collections.abc import Callable

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import ActionError, ActionResult
from mavsdk.plugins.mission_raw import MissionItem
from mavsdk.plugins.offboard import OffboardError, OffboardResult, VelocityNedYaw
from mavsdk.plugins.telemetry import FlightMode

from tests.clients.mavsdk_session import Session, fly
from tests.clients.steps import expect, wait_for


class Px4Session(Session):
    """One PX4. What it is asked is the same; how it answers is not."""

    def healthy(self) -> str:
        """It tells unasked; only the fast ones are asked for faster."""
        for name in ("position", "velocity_ned"):
            getattr(self.telemetry, f"set_rate_{name}")(10.0)
        wait_for("health_all_ok", self.telemetry.health_all_ok)
        return "all"

    def refused(self) -> str:
        try:
            self.action.arm()
        except ActionError as error:
            expect(error.result is ActionResult.COMMAND_DENIED, f"refused with {error}")
            return wait_for("the reason", self.reason)
        raise AssertionError("armed while it boots")

    def reason(self) -> str:
        return next((text for text in self.texts if text.startswith("Preflight Fail:")), "")

    def parameters(self) -> str:
        everything = self.param.get_all_params()
        count = len(everything.int_params) + len(everything.float_params)
        expect(count > 70, f"only {count} parameters")
        before = self.param.get_param_float("MPC_XY_CRUISE")
        self.param.set_param_float("MPC_XY_CRUISE", 7.0)
        expect(self.param.get_param_float("MPC_XY_CRUISE") == 7.0, "MPC_XY_CRUISE was not stored")
        self.param.set_param_float("MPC_XY_CRUISE", before)
        self.param.set_param_int("NAV_DLL_ACT", 3)
        expect(self.param.get_param_int("NAV_DLL_ACT") == 3, "NAV_DLL_ACT was not stored")
        self.param.set_param_int("NAV_DLL_ACT", 0)
        return f"{count} parameters, integers as their bytes"

    def offboard_needs_setpoints(self) -> str:
        try:
            self.offboard.start()
        except OffboardError as error:
            expect(error.result is OffboardResult.NO_SETPOINT_SET, f"refused with {error}")
            return error.result.name
        raise AssertionError("OFFBOARD without a setpoint")

    def lose_setpoints(self) -> str:
        """MAVSDK streams on; the vehicle is told that no setpoint is young enough, and then that they are again."""
        self.param.set_param_int("COM_OBL_RC_ACT", 5)
        self.offboard.set_velocity_ned(VelocityNedYaw(0.0, 1.0, 0.0, 90.0))
        self.offboard.start()
        wait_for("OFFBOARD", lambda: self.mode() == FlightMode.OFFBOARD)
        self.param.set_param_float("COM_OF_LOSS_T", 0.0)
        wait_for("HOLD", lambda: self.mode() == FlightMode.HOLD)
        expect("Failsafe activated" in self.texts, f"it does not say so: {self.texts[-3:]}")
        self.param.set_param_float("COM_OF_LOSS_T", 1.0)
        wait_for("OFFBOARD again", lambda: self.mode() == FlightMode.OFFBOARD)
        self.offboard.stop()
        return "HOLD, and back with the setpoints"

    def items(self) -> list[MissionItem]:
        """Item 0 is a real one."""
        with_home = super().items()
        return [self._numbered(seq, item) for seq, item in enumerate(with_home[1:])]

    @staticmethod
    def _numbered(seq: int, item: MissionItem) -> MissionItem:
        return MissionItem(
            seq, item.frame, item.command, int(seq == 0), item.autocontinue, item.param1, item.param2, item.param3,
            item.param4, item.x, item.y, item.z, item.mission_type,
        )  # fmt: skip

    def steps(self) -> tuple[tuple[str, Callable[[], object]], ...]:
        steps = list(super().steps())
        at = [name for name, _ in steps].index("velocity offboard")
        steps.insert(at, ("offboard refused", self.offboard_needs_setpoints))
        steps.insert(at + 3, ("offboard lost", self.lose_setpoints))
        return tuple(steps)


def main(url: str) -> None:
    sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    sdk.add_any_connection(url)
    fly(sdk, Px4Session)


if __name__ == "__main__":
    main(sys.argv[1])
