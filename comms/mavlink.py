"""One end of a MAVLink 2 link, sans-io: bytes in, messages out; messages in, bytes out.

    end = Endpoint(system_id=1)
    end.send(dialect.MAVLink_heartbeat_message(2, 3, 81, 0, 3, 3))
    wire = end.take()                    # every queued frame as one batch
    messages = other_end.receive(wire)   # never raises, whatever the bytes are

The framing is our own because pymavlink's parser loses up to seven good frames behind a stray start byte and lets its
buffer grow without limit, and so is packing (`packing`); checksums and message types are pymavlink's.
"""

from __future__ import annotations

import struct
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.framing import MAX_FRAME_BYTES, SIGNED_FLAG, START, frame_bytes
from comms.packing import packed
from comms.signing import Signing

# pymavlink reads this switch from the environment, where any text, "0" too, turns the checksum off.
dialect.MAVLINK_IGNORE_CRC = False

# Limits of one call, which is one tick. Some thousand frames in all; no source takes the room of the others, and no
# party says more than another hears out, its heartbeats included.
BYTES_IN = 65_536
BYTES_OF_A_SOURCE = 32_768
BYTES_OUT = BYTES_OF_A_SOURCE - 1024

Message = Any  # a pymavlink message object; its fields depend on its type


class Endpoint:
    """The bytes side of one MAVLink party (one vehicle or one ground-side client) on one link.

    With `signing` it signs what it sends, and hears only what is signed with the same key.

    Attributes:
        sent, received: frames packed and frames accepted so far.
        bad: rejected stretches of input (bad checksum, unknown message, rubbish between frames, MAVLink 1).
        dropped: frames that were too many: of one source in one call, or to send; input that was cut off counts as one.
    """

    def __init__(self, *, system_id: int, component_id: int = 1, signing: Signing | None = None) -> None:
        if not 1 <= system_id <= 255:
            raise ValueError(f"a MAVLink system id is 1 to 255, not {system_id}")
        self._codec = dialect.MAVLink(None, srcSystem=system_id, srcComponent=component_id)
        self._packer = self._codec if signing is None else _signing_codec(system_id, component_id, signing)
        self._inbound = bytearray()
        self._outbound: list[bytes] = []
        self.system_id = system_id
        self.component_id = component_id
        self.signing = signing
        self.sent = 0
        self.received = 0
        self.bad = 0
        self.dropped = 0
        self._waiting_bytes = 0

    def send(self, message: Message) -> None:
        """Queue one message; a field that does not fit its wire type is the caller's error and raises.

        What does not fit into BYTES_OUT is dropped. Heartbeats have some room of their own: without them a busy party
        would look lost.
        """
        if self.full and not self._is_vital(message):
            self.dropped += 1
            return
        codec = self._packer
        if self.signing is not None:
            codec.signing.timestamp = self.signing.next_stamp()
            frame = message.pack(codec)
        else:
            frame = packed(message, sequence=codec.seq, system_id=self.system_id, component_id=self.component_id)
        self._outbound.append(frame)
        self._waiting_bytes += len(frame)
        codec.seq = (codec.seq + 1) % 256
        self.sent += 1

    @property
    def full(self) -> bool:
        """Nothing more fits into this call's batch but a heartbeat: there is no use in asking for more answers."""
        return self._waiting_bytes > BYTES_OUT - MAX_FRAME_BYTES

    def take(self) -> bytes:
        """Everything queued since the last call, in order."""
        wire = b"".join(self._outbound)
        self._outbound.clear()
        self._waiting_bytes = 0
        return wire

    def receive(self, data: bytes) -> list[Message]:
        """The whole, checked messages that `data` completes. An unfinished frame waits for the next call."""
        if not data and not self._inbound:
            return []
        if len(data) > BYTES_IN:
            self.dropped += 1
            data = data[:BYTES_IN]
        buffer = self._inbound
        buffer += data
        messages: list[Message] = []
        position, end = 0, len(buffer)
        while True:
            start = buffer.find(START, position)
            if start != position and (start > position or position < end):
                self.bad += 1  # rubbish before the next start byte, or up to the end
            if start < 0:
                position = end
                break
            position = start
            size = frame_bytes(buffer, start)
            if size is None or end - start < size:
                break
            frame = buffer[start : start + size]
            message = self._decode(frame)
            if message is None:
                self.bad += 1
                position = start + 1  # that start byte was not one: look again right behind it
                continue
            position = start + size
            if self.signing is None or self.signing.accepts(frame):
                messages.append(message)
        del buffer[:position]
        if position > BYTES_OF_A_SOURCE:
            messages = self._fair(messages)
        self.received += len(messages)
        return messages

    def _is_vital(self, message: Message) -> bool:
        """A heartbeat for which the room of the heartbeats is left."""
        heartbeat = message.get_msgId() == dialect.MAVLINK_MSG_ID_HEARTBEAT
        return heartbeat and self._waiting_bytes <= BYTES_OF_A_SOURCE - MAX_FRAME_BYTES

    def _fair(self, messages: list[Message]) -> list[Message]:
        """The messages without those beyond what one source may send in one call."""
        spent: dict[tuple[int, int], int] = {}
        kept: list[Message] = []
        for message in messages:
            source = (message.get_srcSystem(), message.get_srcComponent())
            spent[source] = spent.get(source, 0) + len(message.get_msgbuf())
            if spent[source] <= BYTES_OF_A_SOURCE:
                kept.append(message)
        self.dropped += len(messages) - len(kept)
        return kept

    def _decode(self, frame: bytearray) -> Message | None:
        if frame[2] & ~SIGNED_FLAG:
            return None  # an incompatibility flag we do not know: the frame must be dropped (MAVLink 2 spec)
        try:
            message = self._codec.decode(frame)
        except (dialect.MAVError, ValueError, IndexError, UnicodeDecodeError):
            return None
        # pymavlink returns ids it does not know without having checked their checksum.
        return None if message.get_msgId() < 0 else message


def _signing_codec(system_id: int, component_id: int, signing: Signing) -> Any:
    """A codec that signs what it packs. It must not decode: its own check of signatures can be locked out."""
    codec = dialect.MAVLink(None, srcSystem=system_id, srcComponent=component_id)
    codec.signing.secret_key = signing.key
    codec.signing.link_id = signing.link_id
    codec.signing.sign_outgoing = True
    return codec


class LogDecoder:
    """Decodes frames of MAVLink 1 or 2 out of a log, where they lie one by one."""

    def __init__(self) -> None:
        self._codec = dialect.MAVLink(None)

    def decoded(self, frame: bytes) -> Message | None:
        """The message of a whole frame; None if its checksum is wrong, or nobody knows what it says."""
        try:
            message = self._codec.decode(bytearray(frame))
        except (dialect.MAVError, ValueError, IndexError, UnicodeDecodeError, struct.error):
            return None
        return None if message.get_msgId() < 0 else message


# The modes of what ArduPilot drives, by MAV_TYPE: an enum of its dialect, and what each of its names begins with.
_MODES_OF_TYPE = {
    **dict.fromkeys((2, 3, 4, 13, 14, 15, 29, 35), "COPTER_MODE"),
    **dict.fromkeys((1, 19, 20, 21, 22, 23, 24, 25), "PLANE_MODE"),
    **dict.fromkeys((10, 11), "ROVER_MODE"),
    12: "SUB_MODE",
    5: "TRACKER_MODE",
}


def ardupilot_mode(vehicle_type: int, custom_mode: int) -> str | None:
    """The name of an ArduPilot's mode, by HEARTBEAT's `type` and `custom_mode`; None for one that nobody knows."""
    kind = _MODES_OF_TYPE.get(vehicle_type)
    known = dialect.enums[kind].get(custom_mode) if kind is not None else None
    return None if known is None or known.name.endswith("ENUM_END") else known.name.removeprefix(f"{kind}_")


def numbers_of(message: Message) -> dict[str, float]:
    """A message's numbers by the names of their fields, arrays flattened (`q[0]`); texts are left out."""
    numbers: dict[str, float] = {}
    for name in message.fieldnames:
        value = getattr(message, name)
        if isinstance(value, (int, float)):
            numbers[name] = float(value)
        elif isinstance(value, (list, tuple)):
            numbers |= {f"{name}[{place}]": float(part) for place, part in enumerate(value)}
    return numbers
