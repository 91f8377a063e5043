"""Which messages flow, and when. Only HEARTBEAT does until somebody asks for more, as on a real ArduCopter link."""

from __future__ import annotations

from vehicle_sim.autopilot.steering import TIME_SLACK_S

HEARTBEAT_ID = 0
HEARTBEAT_PERIOD_S = 1.0

# REQUEST_DATA_STREAM: MAV_DATA_STREAM -> the messages it switches.
GROUPS: dict[int, tuple[int, ...]] = {
    2: (1, 24, 42),  # EXTENDED_STATUS: SYS_STATUS, GPS_RAW_INT, MISSION_CURRENT
    6: (32, 33),  # POSITION: LOCAL_POSITION_NED, GLOBAL_POSITION_INT
    10: (30,),  # EXTRA1: ATTITUDE
    11: (74,),  # EXTRA2: VFR_HUD
    12: (2, 147, 193),  # EXTRA3: SYSTEM_TIME, BATTERY_STATUS, EKF_STATUS_REPORT
}
ALL_GROUPS = 0


class Streams:
    """The rates one link asked for. A tick sends a message at most once, so the tick rate is the fastest."""

    def __init__(self, *, started_at_s: float) -> None:
        self._periods_s: dict[int, float] = {HEARTBEAT_ID: HEARTBEAT_PERIOD_S}
        self._due_s: dict[int, float] = {HEARTBEAT_ID: started_at_s}

    def set_period(self, message_id: int, period_s: float | None, now_s: float) -> None:
        """Send every `period_s` from now on; None: not at all. The heartbeat never slows down: it is a sign of life."""
        if message_id == HEARTBEAT_ID:
            period_s = min(period_s or HEARTBEAT_PERIOD_S, HEARTBEAT_PERIOD_S)
        if period_s is None:
            self._periods_s.pop(message_id, None)
            self._due_s.pop(message_id, None)
            return
        self._periods_s[message_id] = period_s
        self._due_s[message_id] = now_s

    def period_s(self, message_id: int) -> float | None:
        return self._periods_s.get(message_id)

    def due(self, now_s: float) -> list[int]:
        """The messages to send now. A late one is sent once and keeps its rhythm from here on."""
        due = [message_id for message_id, at_s in self._due_s.items() if at_s <= now_s + TIME_SLACK_S]
        for message_id in due:
            next_s = self._due_s[message_id] + self._periods_s[message_id]
            self._due_s[message_id] = next_s if next_s > now_s + TIME_SLACK_S else now_s + self._periods_s[message_id]
        return due
