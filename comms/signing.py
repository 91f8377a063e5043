"""MAVLink 2 message signing: who may speak on a link. Section "Message Signing" of the MAVLink guide.

A signed frame ends with link id (1 byte), time stamp (6 bytes, 10 us since 2015, little-endian) and the first 6 bytes
of SHA-256(key + the frame up to there). A frame holds if its signature does and its time stamp is newer than the last
of its stream (system id, component id, link id); a new stream may lag behind the newest time known by a minute.

The signature is checked before anything of the frame is remembered: pymavlink remembers first, so that one forged
frame from the far future locks every genuine one out.
"""

from __future__ import annotations

import hashlib
import hmac
import stat
from collections.abc import Callable
from pathlib import Path

from comms.framing import SIGNATURE_BYTES, SIGNED_FLAG

KEY_BYTES = 32
EPOCH_2015_S = 1_420_070_400
TICKS_PER_S = 100_000
NEW_STREAM_LAG = 60 * TICKS_PER_S
MAX_STREAMS = 256
_LONGEST_FILE_BYTES = 4096
_HASH_BYTES = 6
_LAST_STAMP = 2**48 - 1


class KeyFileError(ValueError):
    """A file that holds no usable key; the text says what is allowed."""


class Signing:
    """One end of a signed link: what it signs with, and whom it believes.

    Args:
        key: KEY_BYTES secret bytes. link_id: which of the party's links this is.
        unix_time: seconds since 1970, a clock that goes on while the process does not run.

    Attributes:
        unsigned, forged, stale: frames refused for want of a signature, for a wrong one, for an old time stamp.
    """

    def __init__(self, key: bytes, *, unix_time: Callable[[], float], link_id: int = 0) -> None:
        if len(key) != KEY_BYTES:
            raise ValueError(f"a signing key has {KEY_BYTES} bytes, not {len(key)}")
        self.key = key
        self.link_id = link_id
        self.unsigned = self.forged = self.stale = 0
        self._unix_time = unix_time
        self._newest = 0
        self._streams: dict[tuple[int, int, int], int] = {}

    @property
    def refused(self) -> int:
        """Frames refused so far, for whatever reason."""
        return self.unsigned + self.forged + self.stale

    def next_stamp(self) -> int:
        """The time stamp of the next frame to sign: newer than all before it, sent or believed."""
        self._newest = min(max(self._newest + 1, self._now()), _LAST_STAMP)
        return self._newest

    def accepts(self, frame: bytes | bytearray) -> bool:
        """Whether to believe a whole MAVLink 2 frame. Only one that is believed leaves a trace here."""
        if not frame[2] & SIGNED_FLAG:
            self.unsigned += 1
            return False
        expected = hashlib.sha256(self.key + frame[:-_HASH_BYTES]).digest()[:_HASH_BYTES]
        if not hmac.compare_digest(expected, bytes(frame[-_HASH_BYTES:])):
            self.forged += 1
            return False
        signature = frame[-SIGNATURE_BYTES:]
        stream, stamp = (frame[5], frame[6], signature[0]), int.from_bytes(signature[1:7], "little")
        if not self._fresh(stream, stamp):
            self.stale += 1
            return False
        self._streams[stream] = stamp
        self._newest = max(self._newest, stamp)
        return True

    def _fresh(self, stream: tuple[int, int, int], stamp: int) -> bool:
        last = self._streams.get(stream)
        if last is not None:
            return stamp > last
        return len(self._streams) < MAX_STREAMS and stamp + NEW_STREAM_LAG >= max(self._newest, self._now())

    def _now(self) -> int:
        return max(0, int((self._unix_time() - EPOCH_2015_S) * TICKS_PER_S))


def read_key(path: Path) -> bytes:
    """The key in a file that its owner alone may read: a text is a passphrase, anything else the KEY_BYTES themselves.

    A passphrase becomes a key as in MAVProxy and mavutil: SHA-256 of it, without the line's end.

    Raises:
        KeyFileError: no such file, one that others may read, or no key in it.
    """
    try:
        if not path.is_file():
            raise KeyFileError(f"got {path}; allowed: an ordinary file")
        mode = stat.S_IMODE(path.stat().st_mode)
        if mode & 0o077:
            raise KeyFileError(f"got {path}, mode {mode:04o}; allowed: mode 0600, nobody but its owner may read a key")
        with path.open("rb") as file:
            content = file.read(_LONGEST_FILE_BYTES + 1)
    except OSError as error:
        raise KeyFileError(f"got {path}; allowed: a file that can be read ({error.strerror})") from error
    text = content.rstrip(b"\r\n")
    if text and len(content) <= _LONGEST_FILE_BYTES and text.isascii() and text.decode("ascii").isprintable():
        return hashlib.sha256(text).digest()
    if len(content) == KEY_BYTES:
        return content
    raise KeyFileError(f"got {path}, {len(content)} bytes; allowed: {KEY_BYTES} bytes, or a passphrase in ASCII")
