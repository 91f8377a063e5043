"""What can be read of a recording whose writer was killed, or whose disk is bad, as a file of its own.

A file is a header of 12 bytes, and messages: kind and length in 8 bytes each, and content. rerun's own tool passes over
most damage inside a message, but loses all that follows a bad length, and some contents make it crash. So only what is
a message is given to it, and one at which it crashes is found by halving, and left out.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from missions.recording.optimize import optimize

_HEADER_BYTES = 12
_MESSAGE = struct.Struct("<QQ")
_LAST_KIND = 3  # end, store, data, blueprint
_DATA = (2).to_bytes(8, "little")  # how nearly every message begins
_MOST_LEFT_OUT = 20  # each takes some seconds of a long file


def repair(source: Path, destination: Path) -> int:
    """Write what can be read of `source` to `destination`, and tell in how many places it is damaged.

    That the last message is not whole is no damage: its writer was killed.

    Raises:
        RuntimeError: rerun's tool is missing, or nothing can be read; with what the tool said.
    """
    content = source.read_bytes()
    found, damaged = _messages(content)
    header, messages = content[:_HEADER_BYTES], _of_known_stores(found)
    damaged += len(found) - len(messages)
    sound = destination.with_name(destination.name + ".sound")

    def write(some: Sequence[bytes]) -> None:
        sound.write_bytes(header + b"".join(some))
        optimize(sound, destination, "--continue-on-error")

    def can_write(some: Sequence[bytes]) -> bool:
        try:
            write(some)
        except RuntimeError:
            return False
        return True

    try:
        for _ in range(_MOST_LEFT_OUT):
            if can_write(messages):
                return damaged
            good, bad = 0, len(messages)  # the first so many can be written, and cannot
            while bad - good > 1:
                middle = (good + bad) // 2
                good, bad = (middle, bad) if can_write(messages[:middle]) else (good, middle)
            del messages[good:bad]
            damaged += 1
        write(messages[:good])
        return damaged
    finally:
        sound.unlink(missing_ok=True)


def _messages(content: bytes) -> tuple[list[bytes], int]:
    """All that are whole and followed by another one, and in how many places something else lies between them."""
    messages, gaps = [], 0
    start = expected = _HEADER_BYTES
    while 0 <= start < len(content):
        end = _end(content, start)
        if end is not None and end <= len(content) and (end == len(content) or _end(content, end) is not None):
            messages.append(content[start:end])
            gaps += start != expected
            start = expected = end
        else:
            start = content.find(_DATA, start + 1)
    return messages, gaps


def _of_known_stores(messages: Sequence[bytes]) -> list[bytes]:
    """Those of a recording or a blueprint: who is alone in its store has a bad byte in the store's name."""
    stores = [_store(message) for message in messages]
    members = Counter(stores)
    return [message for message, store in zip(messages, stores, strict=True) if store is None or members[store] > 1]


def _store(message: bytes) -> bytes | None:
    """What a data message is of: its first field, as protobuf has it."""
    content = message[_MESSAGE.size :]
    return content[: 2 + content[1]] if message.startswith(_DATA) and len(content) > 1 else None


def _end(content: bytes, start: int) -> int | None:
    """Where the message that begins there ends, or would in a longer file; None: it is none."""
    if start + _MESSAGE.size > len(content):
        return len(content) + 1
    kind, length = _MESSAGE.unpack_from(content, start)
    return start + _MESSAGE.size + length if kind <= _LAST_KIND else None
