"""Every transport keeps the same promises: bytes arrive in order, peers come and go, nothing blocks or raises."""

from __future__ import annotations

import os
import termios
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from comms.transport import FORMS, Transport, TransportError, transport_of
from comms.transport.contract import MAX_PEERS, SOURCE_BYTES, WAITING_BYTES
from comms.transport.udp import PEER_SILENT_S
from tests.comms.test_mavlink import ATTITUDE, HEARTBEAT
from tests.patience import until

Pair = tuple[Transport, Transport]


def hear(end: Transport, size: int) -> bytes:
    """The next `size` bytes or more that come to `end`."""
    heard = b""

    def enough() -> bool:
        nonlocal heard
        heard += b"".join(end.read(time.monotonic()))
        return len(heard) >= size

    until(enough)
    return heard


def meet(first: Transport, second: Transport) -> None:
    """Both hear each other, and nothing of that is still under way."""
    heard: set[Transport] = set()

    def both() -> bool:
        for end, other in ((first, second), (second, first)):
            other.write(HEARTBEAT)
            if end.read(0.0):
                heard.add(end)
        return len(heard) == 2

    def all_is_read() -> bool:
        first.read(0.0), second.read(0.0)
        return (first.counts.received, second.counts.received) == (second.counts.sent, first.counts.sent)

    until(both)
    until(all_is_read)


@pytest.fixture(params=["udp", "tcp", "serial"])
def pair(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Pair]:
    """A transport that waits for peers, and one that goes to it; both open."""
    waiting = {"udp": "udpin:127.0.0.1:0", "tcp": "tcpin:127.0.0.1:0", "serial": f"pty:{tmp_path / 'port'}"}
    with ExitStack() as stack:
        first = stack.enter_context(transport_of(waiting[request.param]))
        going = {
            "udp": first.url.replace("udpin", "udpout"),
            "tcp": first.url.replace("tcpin", "tcp"),
            "serial": f"serial:{tmp_path / 'port'}:115200",
        }
        second = stack.enter_context(transport_of(going[request.param]))
        yield first, second


def test_frames_go_both_ways(pair: Pair) -> None:
    first, second = pair
    meet(first, second)
    assert first.connected
    assert second.connected
    first.write(ATTITUDE * 5)
    assert hear(second, 5 * len(ATTITUDE)) == ATTITUDE * 5
    second.write(ATTITUDE + HEARTBEAT)
    assert hear(first, len(ATTITUDE + HEARTBEAT)) == ATTITUDE + HEARTBEAT
    assert (first.counts.dropped_in, second.counts.dropped_in) == (0, 0)


def test_nobody_there_is_no_error(pair: Pair) -> None:
    first, second = pair
    second.close()
    until(lambda: (first.read(2.0 * PEER_SILENT_S), not first.connected)[-1])
    before = first.counts.sent
    first.write(HEARTBEAT)
    assert first.read(3.0 * PEER_SILENT_S) == []
    assert first.counts.sent == before
    first.close()
    first.close()


def test_a_flood_is_bounded(pair: Pair) -> None:
    first, second = pair
    meet(first, second)
    for _ in range(80):
        second.write(ATTITUDE * 400)  # 1.3 MB in all
        assert sum(map(len, first.read(0.0))) <= SOURCE_BYTES + 300
    assert second.counts.dropped_out + second.counts.sent >= 80 * 400 * len(ATTITUDE) - WAITING_BYTES


def test_a_peer_that_does_not_read_costs_only_itself(pair: Pair) -> None:
    first, second = pair
    meet(first, second)
    for _ in range(2000):
        first.write(ATTITUDE * 100)  # 8 MB in all; UDP loses it on the way
    sent, dropped = first.counts.sent, first.counts.dropped_out
    if "udp" not in first.url:
        assert dropped > 0
        assert sent + dropped >= 2000 * 100 * len(ATTITUDE) - WAITING_BYTES


def test_a_port_that_is_taken_is_told() -> None:
    for scheme in ("udpin", "tcpin"):
        with transport_of(f"{scheme}:127.0.0.1:0") as first:
            taken = transport_of(first.url)
            with pytest.raises(TransportError, match=r"127\.0\.0\.1:\d+: Address already in use"):
                taken.__enter__()


@pytest.mark.parametrize("url", ["serial:/dev/no-such-port:57600", "tcp:no.such.host.invalid:1", "pty:/no/such/dir/x"])
def test_what_is_not_there_is_told(url: str) -> None:
    with pytest.raises(TransportError, match=url.split(":")[1]):
        transport_of(url).__enter__()


@pytest.mark.parametrize(
    "url",
    [
        "", "tcp", "tcp:", "tcp::5760", "tcp:127.0.0.1", "tcp:127.0.0.1:", "tcp:127.0.0.1:0", "tcp:127.0.0.1:65536",
        "tcp:127.0.0.1:x", "tcp:127.0.0.1:-1", "tcp:127.0.0.1:²", "udp:127.0.0.1:14550", "udpin:14550",
        "udpout:127.0.0.1:0", "serial:/dev/ttyACM0", "serial::57600", "serial:/dev/ttyACM0:0",
        "serial:/dev/ttyACM0:fast", "TCP:127.0.0.1:5760", "/dev/ttyACM0",
    ],
)  # fmt: skip
def test_a_wrong_url_says_what_is_allowed(url: str) -> None:
    with pytest.raises(ValueError, match="allowed: ") as told:
        transport_of(url)
    assert f'got "{url}"' in str(told.value)


@pytest.mark.parametrize(
    "url", ["tcp:127.0.0.1:5760", "tcpin:[::1]:0", "udpin:0.0.0.0:14550", "udpout:localhost:14550",
            "serial:/dev/serial/by-id/usb-1:2:57600", "pty", "pty:/tmp/ttyVehicle"],
)  # fmt: skip
def test_a_transport_names_itself_as_it_was_named(url: str) -> None:
    assert transport_of(url).url == url


def test_every_kind_is_named_to_who_asks() -> None:
    for form in ("tcp:HOST:PORT", "tcpin:", "udpin:", "udpout:", "serial:DEVICE:BAUD", "pty"):
        assert form in FORMS


def test_tcp_serves_several_and_mixes_no_frames() -> None:
    with ExitStack() as stack:
        server = stack.enter_context(transport_of("tcpin:127.0.0.1:0"))
        url = server.url.replace("tcpin", "tcp")
        one, two = (stack.enter_context(transport_of(url)) for _ in range(2))
        until(lambda: (one.read(0.0), two.read(0.0), one.connected and two.connected)[-1])
        one.write(ATTITUDE[:20])
        two.write(HEARTBEAT)
        assert hear(server, len(HEARTBEAT)) == HEARTBEAT
        one.write(ATTITUDE[20:])
        assert hear(server, len(ATTITUDE)) == ATTITUDE
        server.write(HEARTBEAT)
        assert hear(one, 1) == hear(two, 1) == HEARTBEAT
        one.close()
        two.write(HEARTBEAT)
        assert hear(server, 1) == HEARTBEAT
        server.write(HEARTBEAT)
        assert hear(two, 1) == HEARTBEAT


def test_tcp_calls_again_when_it_was_cut_off() -> None:
    server = transport_of("tcpin:127.0.0.1:0").__enter__()
    with transport_of(server.url.replace("tcpin", "tcp")) as client:
        meet(server, client)
        server.close()
        until(lambda: (client.read(100.0), not client.connected)[-1])
        dropped = client.counts.dropped_out
        client.write(HEARTBEAT)
        assert client.counts.dropped_out == dropped + len(HEARTBEAT)
        with transport_of(server.url) as again:
            client.read(100.1)
            client.read(100.2)
            assert not client.connected  # it waits half a second before it calls again
            now_s = 100.0

            def met() -> bool:
                nonlocal now_s
                now_s += 0.1
                client.read(now_s)
                again.read(now_s)
                return client.connected

            until(met)
            assert now_s >= 100.5
            client.write(HEARTBEAT)
            assert hear(again, 1) == HEARTBEAT


def test_udp_has_room_for_so_many_and_forgets_the_silent() -> None:
    with ExitStack() as stack:
        server = stack.enter_context(transport_of("udpin:127.0.0.1:0"))
        url = server.url.replace("udpin", "udpout")
        peers = [stack.enter_context(transport_of(url)) for _ in range(MAX_PEERS + 1)]
        for peer in peers:
            peer.write(HEARTBEAT)
        hear(server, MAX_PEERS * len(HEARTBEAT))
        until(lambda: (server.read(0.0), server.counts.dropped_in > 0)[-1])
        assert server.counts.dropped_in == len(HEARTBEAT)
        server.read(time.monotonic() + PEER_SILENT_S + 1.0)
        assert not server.connected


def test_a_pseudo_terminal_leaves_no_link_behind(tmp_path: Path) -> None:
    path = tmp_path / "port"
    path.symlink_to("/dev/pts/99999")  # of a process that was killed
    with transport_of(f"pty:{path}") as port:
        assert not port.connected
        assert os.path.realpath(path).startswith("/dev/")
    assert not path.is_symlink()


def test_what_nobody_has_read_is_not_kept_for_who_comes_next() -> None:
    flood, times = HEARTBEAT * 1000, 10  # more than the system keeps
    with transport_of("pty") as port:
        descriptor = os.open(port.url.removeprefix("pty:"), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        for _ in range(times):
            port.write(flood)
        os.close(descriptor)
        until(lambda: not port.connected)
        assert port.read(0.0) == []
        assert port.counts.sent + port.counts.dropped_out == times * len(flood)


@pytest.mark.parametrize("trouble", [termios.error(5, "Input/output error"), ValueError("no such speed"), OSError(5)])
def test_a_line_that_cannot_be_set_up_is_one_that_is_not_there(
    trouble: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(descriptor: int) -> None:
        raise trouble

    with transport_of(f"pty:{tmp_path / 'port'}"):
        line = transport_of(f"serial:{tmp_path / 'port'}:57600")
        with line:
            monkeypatch.setattr("comms.transport.serial_line._tell_empty_from_ended", fail)
            line._lose()  # type: ignore[attr-defined]
            assert [line.read(now_s) for now_s in (0.0, 1.0)] == [[], []]
            assert not line.connected
        with pytest.raises(TransportError, match="57600"), line:
            pass


def test_what_is_not_open_cannot_be_used() -> None:
    for url in ("udpin:127.0.0.1:0", "udpout:127.0.0.1:1", "tcpin:127.0.0.1:0", "pty"):
        with pytest.raises(ValueError, match="is not open"):
            transport_of(url).read(0.0)
