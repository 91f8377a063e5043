"""MAVLink over a serial line: a real one by pyserial, or a pseudo-terminal that looks like one to another program."""

from __future__ import annotations

import os
import select
import termios
import tty
from pathlib import Path
from typing import Any, Self

from comms.transport.backoff import Backoff
from comms.transport.contract import Closing, Counts, TransportError
from comms.transport.stream import Stream


class SerialLine(Closing):
    """`serial:DEVICE:BAUD`: eight data bits, no parity. A line that was pulled out is opened again when it is back."""

    def __init__(self, device: str, baud: int) -> None:
        self._device, self._baud = device, baud
        self._line: Any = None  # a serial.Serial
        self._stream: Stream | None = None
        self._backoff = Backoff()
        self.url = f"serial:{device}:{baud}"
        self.counts = Counts()

    @property
    def connected(self) -> bool:
        return self._stream is not None

    def __enter__(self) -> Self:
        try:
            self._plug_in()
        except OSError as error:
            raise TransportError(f"{self.url}: {error.strerror or error}") from error
        return self

    def close(self) -> None:
        self._stream = None
        if self._line is not None:
            self._line.close()
            self._line = None

    def read(self, now_s: float) -> list[bytes]:
        try:
            if self._stream is None:
                if not self._backoff.due(now_s):
                    return []
                self._stream = self._plug_in()
                self._backoff.succeeded()
            self._stream.flush()
            chunk = self._stream.read()
        except OSError:
            self._lose()
            return []
        return [chunk] if chunk else []

    def write(self, data: bytes) -> None:
        if self._stream is None:
            self.counts.dropped_out += len(data)
            return
        try:
            self._stream.write(data)
        except OSError:
            self._lose()

    def _plug_in(self) -> Stream:
        import serial

        try:
            self._line = serial.Serial(self._device, self._baud, timeout=0, write_timeout=0)
            _tell_empty_from_ended(self._line.fileno())
        except (OSError, ValueError, termios.error) as error:  # no such line, no such speed, gone again
            self.close()
            raise OSError(str(error)) from error
        self._stream = Stream(self._line.fileno(), self.counts)
        return self._stream

    def _lose(self) -> None:
        self.close()
        self._backoff.failed()


def _tell_empty_from_ended(descriptor: int) -> None:
    """With pyserial's VMIN of 0 an empty line reads as one that has ended; with 1 it reads as one that would block."""
    attributes = termios.tcgetattr(descriptor)
    attributes[6][termios.VMIN] = 1
    termios.tcsetattr(descriptor, termios.TCSANOW, attributes)


class PseudoTerminal(Closing):
    """`pty` or `pty:PATH`: a serial port without hardware. `url` names it once it is open; PATH becomes a link to it.

    While no program has it open, what is written is dropped, as from a cable that ends nowhere.
    """

    def __init__(self, link: str = "") -> None:
        self._link = Path(link) if link else None
        self._master: int | None = None
        self._stream: Stream | None = None
        self.url = f"pty:{link}" if link else "pty"
        self.counts = Counts()

    @property
    def connected(self) -> bool:
        if self._master is None:
            return False
        poll = select.poll()
        poll.register(self._master, 0)
        return not any(what & select.POLLHUP for _, what in poll.poll(0))

    def __enter__(self) -> Self:
        try:
            self._master, slave = os.openpty()
            tty.setraw(slave)
            name = os.ttyname(slave)
            os.close(slave)  # from now on the system tells whether another program has it open
            os.set_blocking(self._master, False)
            if self._link is not None:
                if self._link.is_symlink():  # of a run that was killed
                    self._link.unlink()
                self._link.symlink_to(name)
        except OSError as error:
            self.close()
            raise TransportError(f"{self.url}: {error.strerror or error}") from error
        self._stream = Stream(self._master, self.counts)
        self.url = f"pty:{self._link or name}"
        return self

    def close(self) -> None:
        if self._master is None:
            return
        os.close(self._master)
        self._master = self._stream = None
        if self._link is not None and self._link.is_symlink():
            self._link.unlink()

    def read(self, now_s: float) -> list[bytes]:
        if self._stream is None:
            raise ValueError(f"{self.url} is not open")
        try:
            chunk = self._stream.read()
        except OSError:  # nobody has it open
            self._stream.forget()
            return []
        return [chunk] if chunk else []

    def write(self, data: bytes) -> None:
        if self._stream is None:
            raise ValueError(f"{self.url} is not open")
        if self.connected:
            self._stream.write(data)
        else:
            self._stream.forget()
            self.counts.dropped_out += len(data)
