"""Which messages the vehicle sends us, and how often: one table, asked for once and again when they fall silent."""

from __future__ import annotations

from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.requests import AUTOPILOT_COMPONENT_ID, stream
from swarm_agent.autopilot.transaction import Outcome, Transaction

SILENCE_S = 3.0
ASK_AGAIN_S = 10.0  # after having asked, before silence is judged again


@dataclass(frozen=True, slots=True)
class Rate:
    """One message at one rate; `group` is the MAV_DATA_STREAM that holds it, for autopilots that only know those."""

    message_id: int
    rate_hz: int
    group: int


RATES = (
    Rate(dialect.MAVLINK_MSG_ID_ATTITUDE, 10, dialect.MAV_DATA_STREAM_EXTRA1),
    Rate(dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 10, dialect.MAV_DATA_STREAM_POSITION),
    Rate(dialect.MAVLINK_MSG_ID_SYS_STATUS, 1, dialect.MAV_DATA_STREAM_EXTENDED_STATUS),
    Rate(dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE, 1, dialect.MAV_DATA_STREAM_EXTENDED_STATUS),
    Rate(dialect.MAVLINK_MSG_ID_GPS_RAW_INT, 1, dialect.MAV_DATA_STREAM_EXTENDED_STATUS),
    Rate(dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT, 1, dialect.MAV_DATA_STREAM_EXTRA3),
    Rate(dialect.MAVLINK_MSG_ID_BATTERY_STATUS, 1, dialect.MAV_DATA_STREAM_EXTRA3),
    Rate(dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, 1, dialect.MAV_DATA_STREAM_POSITION),
)


class Streams:
    """Asks for every rate in turn, and for all of them again when ATTITUDE falls silent on a living link."""

    def __init__(self) -> None:
        self._waiting: list[Rate] = []
        self._transaction: Transaction | None = None
        self._groups: dict[int, int] = {}
        self._asked_at_s: float | None = None

    def tick(self, cockpit: Cockpit, now_s: float) -> None:
        """Go on asking, or watch; `cockpit.rates_asked` tells when every rate is answered, or asked for as a group."""
        if self._waiting:
            self._ask(cockpit, now_s)
        elif self._silent(cockpit, now_s):
            if self._asked_at_s is not None:
                cockpit.say(Level.WARNING, "telemetry has fallen silent: asking for it again")
            self._asked_at_s = now_s
            self._waiting = list(RATES)
            self._groups = {}
            self._ask(cockpit, now_s)

    def _silent(self, cockpit: Cockpit, now_s: float) -> bool:
        if self._asked_at_s is None:
            return True
        if now_s - self._asked_at_s < ASK_AGAIN_S:
            return False
        heartbeat_at_s, attitude_at_s = cockpit.telemetry.heartbeat_at_s, cockpit.telemetry.attitude_at_s
        alive = heartbeat_at_s is not None and now_s - heartbeat_at_s < SILENCE_S
        return alive and (attitude_at_s is None or now_s - attitude_at_s > SILENCE_S)

    def _ask(self, cockpit: Cockpit, now_s: float) -> None:
        rate = self._waiting[0]
        if self._transaction is None:
            self._transaction = Transaction(stream(rate.message_id, rate.rate_hz))
        outcome = self._transaction.tick(cockpit, now_s)
        if outcome is Outcome.OPEN:
            return
        if outcome is not Outcome.ACCEPTED:
            self._ask_group(cockpit, rate)
        self._transaction = None
        del self._waiting[0]
        if self._waiting:
            self._ask(cockpit, now_s)
        else:
            cockpit.rates_asked = True

    def _ask_group(self, cockpit: Cockpit, rate: Rate) -> None:
        """REQUEST_DATA_STREAM, which is never answered; a group runs at the highest rate asked of it."""
        if self._groups.get(rate.group, 0) >= rate.rate_hz:
            return
        self._groups[rate.group] = rate.rate_hz
        cockpit.send(
            dialect.MAVLink_request_data_stream_message(
                cockpit.target, AUTOPILOT_COMPONENT_ID, rate.group, rate.rate_hz, 1
            )
        )
