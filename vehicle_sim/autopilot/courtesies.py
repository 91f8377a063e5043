"""Small answers that clients wait for: time, ping, an empty log, and files that are not there.

Silence would cost them seconds: MAVProxy asks for the parameters as a file first, and falls back on a refusal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.core import Autopilot

# MAVFTP: a header of 12 bytes (sequence, session, opcode, size, the opcode that is answered, ...), then data.
FTP_BYTES = 251
FTP_ACK, FTP_NAK = 128, 129
FTP_HARMLESS = (0, 1, 2)  # nothing, terminate a session, reset all: done before it began
FTP_FILE_NOT_FOUND, FTP_UNKNOWN_COMMAND = 10, 7
FTP_ABOUT_FILES = range(3, 16)


def timesync(pilot: Autopilot, message: Any) -> list[Any]:
    """Our time for theirs, nanoseconds. What answers a question of ours we never asked is left alone."""
    if message.tc1 != 0:
        return []
    return [dialect.MAVLink_timesync_message(_since_boot_us(pilot) * 1000, message.ts1)]


def ping(pilot: Autopilot, message: Any) -> list[Any]:
    """A ping to everybody comes back to its sender; an answer to a ping does not."""
    if message.target_system != 0:
        return []
    source = message.get_srcSystem(), message.get_srcComponent()
    return [dialect.MAVLink_ping_message(message.time_usec, message.seq, *source)]


def log_list(pilot: Autopilot, message: Any) -> list[Any]:
    """No log is kept."""
    return [dialect.MAVLink_log_entry_message(0, 0, 0, 0, 0)]


def file_transfer(pilot: Autopilot, message: Any) -> list[Any]:
    """No file is kept."""
    asked = bytes(message.payload)
    sequence = (int.from_bytes(asked[:2], "little") + 1) & 0xFFFF
    session, opcode = asked[2], asked[3]
    if opcode in (FTP_ACK, FTP_NAK):
        return []
    answer, data = FTP_ACK, b""
    if opcode not in FTP_HARMLESS:
        answer = FTP_NAK
        data = bytes([FTP_FILE_NOT_FOUND if opcode in FTP_ABOUT_FILES else FTP_UNKNOWN_COMMAND])
    header = sequence.to_bytes(2, "little") + bytes([session, answer, len(data), opcode, 0, 0]) + bytes(4)
    payload = (header + data).ljust(FTP_BYTES, b"\0")
    return [
        dialect.MAVLink_file_transfer_protocol_message(
            0, message.get_srcSystem(), message.get_srcComponent(), list(payload)
        )
    ]


ANSWERS: dict[int, Callable[[Autopilot, Any], list[Any]]] = {
    dialect.MAVLINK_MSG_ID_PING: ping,
    dialect.MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL: file_transfer,
    dialect.MAVLINK_MSG_ID_TIMESYNC: timesync,
    dialect.MAVLINK_MSG_ID_LOG_REQUEST_LIST: log_list,
}


def _since_boot_us(pilot: Autopilot) -> int:
    return round((pilot.now_s - pilot.started_at_s) * 1e6)
