"""Waiting for everybody's message, bounded in memory and in time."""

from __future__ import annotations

import threading
from time import monotonic

from comms.mailbox import MOST_BYTES, MOST_WAITING, Mailbox

LONG_S = 30.0


def taken(mail: Mailbox) -> dict[int, list[bytes]]:
    return {sender: list(payloads) for sender, payloads in mail.take().items()}


def test_messages_of_each_are_kept_in_order_and_strangers_are_not_heard() -> None:
    mail = Mailbox([0, 1])
    for sender, payload in ((0, b"old"), (0, b"new"), (7, b"stranger"), (None, b"nobody")):
        mail.put(sender, payload)
    assert taken(mail) == {0: [b"old", b"new"]}
    assert taken(mail) == {}


def test_nobody_fills_the_memory_and_who_tries_pushes_out_its_own_messages_alone() -> None:
    mail = Mailbox(range(3))
    mail.put(0, b"mine")
    for number in range(5 * MOST_WAITING):
        mail.put(1, b"%d" % number)
        mail.put(2, bytes(MOST_BYTES // 3))
    mail.put(0, bytes(MOST_BYTES + 1))
    kept = taken(mail)
    assert kept[0] == [b"mine"]
    assert kept[1] == [b"%d" % number for number in range(4 * MOST_WAITING, 5 * MOST_WAITING)]
    assert len(kept[2]) == 3


def test_waiting_ends_with_the_last_message() -> None:
    mail = Mailbox(range(3))
    mail.put(0, b"early")
    threads = [threading.Timer(0.05 * uid, mail.put, (uid, b"late")) for uid in (1, 2)]
    for thread in threads:
        thread.start()
    began_s = monotonic()
    mail.wait(range(3), timeout_s=LONG_S)
    assert monotonic() - began_s < LONG_S / 2
    assert sorted(mail.take()) == [0, 1, 2]


def test_nobody_waits_for_one_who_is_given_up_nor_longer_than_agreed() -> None:
    mail = Mailbox(range(2))
    mail.put(0, b"here")
    threading.Timer(0.05, mail.give_up, (1,)).start()
    began_s = monotonic()
    mail.wait(range(2), timeout_s=LONG_S)
    assert monotonic() - began_s < LONG_S / 2
    mail.wait(range(2), timeout_s=0.0)
    assert taken(mail) == {0: [b"here"]}


def test_who_is_given_up_before_anybody_waits_is_not_waited_for() -> None:
    mail = Mailbox([1, 2])
    mail.give_up(1)
    mail.put(2, b"here")
    began_s = monotonic()
    mail.wait([1, 2], timeout_s=60.0)
    assert monotonic() - began_s < 30.0
