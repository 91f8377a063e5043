"""The zenoh session behind the bus: the only file that knows zenoh.

    with open_local_bus() as bus:            # isolated: no scouting, no sockets, one process
        bus.subscribe("a/*", on_sample)
        put = bus.publisher("a/1")
        put(b"hello")                        # on_sample("a/1", b"hello") has run when put returns

Constructors touch nothing: the session opens and closes with the `with` block.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

import zenoh

OnSample = Callable[[str, bytes], None]
Put = Callable[[bytes], None]


class Bus(Protocol):
    """Publish and subscribe by key. Callbacks must only enqueue: they may run inside somebody's `put`."""

    def publisher(self, key: str) -> Put: ...

    def subscribe(self, key_expression: str, on_sample: OnSample) -> None: ...


class ZenohBus:
    """A bus on an open zenoh session; see `open_local_bus`."""

    def __init__(self, session: Any) -> None:
        self._session = session

    def publisher(self, key: str) -> Put:
        """A declared publisher for frames: late ones are dropped rather than waited for, and they go first."""
        publisher = self._session.declare_publisher(
            key,
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )
        put: Put = publisher.put
        return put

    def subscribe(self, key_expression: str, on_sample: OnSample) -> None:
        """Call `on_sample(key, payload)` for every sample, directly in the thread that delivers it."""

        def forward(sample: Any) -> None:
            on_sample(str(sample.key_expr), sample.payload.to_bytes())

        self._session.declare_subscriber(key_expression, zenoh.handlers.Callback(forward, indirect=False))


@contextmanager
def open_local_bus() -> Iterator[ZenohBus]:
    """One isolated session for one process: real zenoh pub/sub, no network at all, deliveries in order."""
    zenoh.init_log_from_env_or("error")
    with zenoh.open(_isolated()) as session:
        yield ZenohBus(session)


def _isolated() -> Any:
    config = zenoh.Config()
    for key, value in {
        "mode": "peer",
        "listen/endpoints": [],
        "connect/endpoints": [],
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "transport/shared_memory/enabled": False,
    }.items():
        config.insert_json5(key, json.dumps(value))
    return config
