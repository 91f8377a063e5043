"""mavutil with and without the key of a signed vehicle: `python -m tests.clients.signed_session tcp:127.0.0.1:5760`."""

from __future__ import annotations

import hashlib
import os
import sys
from typing import Any

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

from tests.clients.steps import expect, step

PASSPHRASE = "correct horse battery staple"
HOME_POSITION = 410


class Session:
    """One connection to the vehicle."""

    def __init__(self, url: str) -> None:
        self.link: Any = mavutil.mavlink_connection(url, source_system=255)
        expect(self.link.wait_heartbeat(timeout=10.0) is not None, "no heartbeat within 10 s")

    def ask(self) -> Any:
        """The answer to a harmless command, if there is one."""
        self.link.mav.command_long_send(1, 1, HOME_POSITION, 0, 0, 0, 0, 0, 0, 0, 0)
        return self.link.recv_match(type="COMMAND_ACK", blocking=True, timeout=2.0)

    def unsigned(self) -> str:
        expect(self.ask() is None, "it answers to an unsigned frame")
        return "no answer"

    def another_key(self) -> str:
        self.link.setup_signing(hashlib.sha256(b"guess").digest(), allow_unsigned_callback=lambda link, number: True)
        expect(self.ask() is None, "it answers to a wrong key")
        return "no answer"

    def the_key(self) -> str:
        self.link.setup_signing(hashlib.sha256(PASSPHRASE.encode()).digest())
        heard = self.link.mav.signing
        heard.goodsig_count = heard.badsig_count = 0  # of the wrong key
        expect(self.ask() is not None, "no answer to the right key")
        expect(heard.goodsig_count > 0, "what came back was not signed")
        expect(heard.badsig_count == 0, "what came back was signed wrongly")
        return "answered, signed"


def main(url: str) -> None:
    found: list[Session] = []
    step("discovery", lambda: found.append(Session(url)))
    step("unsigned", found[0].unsigned)
    step("another key", found[0].another_key)
    step("the key", found[0].the_key)


if __name__ == "__main__":
    main(sys.argv[1])
