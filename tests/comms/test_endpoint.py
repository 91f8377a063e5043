"""Endpoints, as zenoh writes them."""

from __future__ import annotations

import socket

import pytest

from comms.endpoint import is_local, place_of, round_trip_s


@pytest.mark.parametrize(
    ("endpoint", "local"),
    [
        ("tcp/127.0.0.1:7447", True),
        ("tls/127.0.0.1:7447", True),
        ("tcp/localhost:7447", True),
        ("tcp/[::1]:7447#so_sndbuf=65000", True),
        ("tcp/0.0.0.0:7447", False),
        ("tcp/[::]:7447", False),
        ("tcp/10.0.0.5:7447", False),
        ("tcp/localhost.example.org:7447", False),
        ("udp/127.0.0.1:7447", False),
        ("", False),
        ("tcp", False),
    ],
)
def test_what_stays_on_this_computer(endpoint: str, local: bool) -> None:
    assert is_local(endpoint) is local


def test_a_port_is_open_or_it_is_not() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        endpoint = f"tcp/127.0.0.1:{server.getsockname()[1]}"
        trip_s = round_trip_s(endpoint, timeout_s=5.0)
        assert trip_s is not None
        assert 0.0 < trip_s < 5.0
    assert round_trip_s(endpoint, timeout_s=5.0) is None


@pytest.mark.parametrize("endpoint", ["", "tcp", "tcp/:", "tcp/127.0.0.1:x", "tcp/127.0.0.1:99999", "tcp/127.0.0.1:-1"])
def test_what_is_no_address_is_not_open(endpoint: str) -> None:
    assert round_trip_s(endpoint, timeout_s=1.0) is None


@pytest.mark.parametrize(
    ("endpoint", "place"),
    [
        ("tcp/127.0.0.1:7447", ("127.0.0.1", 7447)),
        ("tls/10.0.0.5:1", ("10.0.0.5", 1)),
        ("tcp/[::1]:7447", ("::1", 7447)),
        ("tcp/drone-3.local:65535", ("drone-3.local", 65535)),
        ("foo", None),
        ("7447", None),
        ("10.0.0.5:7447", None),
        ("udp/127.0.0.1:7447", None),
        ("tcp/127.0.0.1:0", None),
        ("tcp/127.0.0.1:99999", None),
        ("tcp/127.0.0.1:7447#iface=eth0", None),
        ("tcp/[nobody]:7447", None),
        ("tcp/::1:7447", None),
        ("tcp/a b:7447", None),
        ("", None),
    ],
)
def test_an_endpoint_is_an_address_and_a_port(endpoint: str, place: tuple[str, int] | None) -> None:
    assert place_of(endpoint) == place
