"""The zenoh session behind the bus: the only file that knows zenoh.

    with open_local_bus() as bus:            # isolated: no scouting, no sockets, one process
        bus.subscribe("a/*", on_sample)
        put = bus.publisher("a/1")
        put(b"hello")                        # on_sample("a/1", b"hello") has run when put returns

Between processes: one `open_router`, and an `open_client` in each of the others; or an `open_peer` in each, with nobody
in the middle. With credentials both ends prove who they are (TLS, at a `tls/` endpoint), and a gate says who may do
what. Constructors touch nothing: the session opens and closes with the `with` block.

A link to another computer can be cut without either end being told. There a session whose other end is silent for
LEASE_S is closed, with all that waits in it, and the client calls again and again: what then comes is of now. On one
computer silence means that it is busy, and zenoh's own lease of 10 s holds.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from time import monotonic
from typing import Any, Protocol

import zenoh

from comms.access import Gate
from comms.credentials import Credentials
from comms.endpoint import is_local, round_trip_s

OnSample = Callable[[str, bytes], None]
Put = Callable[[bytes], None]


class Bus(Protocol):
    """Publish and subscribe by key. Callbacks must only enqueue: they may run inside somebody's `put`."""

    def publisher(self, key: str) -> Put: ...

    def subscribe(self, key_expression: str, on_sample: OnSample) -> None: ...


class Question(Protocol):
    """A question that waits for its answer: any thread may give it, once, but not the callback that brought it."""

    @property
    def key(self) -> str: ...

    def answer(self, payload: bytes) -> None: ...


class Network(Bus, Protocol):
    """A bus between processes, with who is there, and questions."""

    def declare_alive(self, key: str) -> Callable[[], None]: ...

    def watch(self, key_expression: str, on_change: Callable[[str, bool], None]) -> None: ...

    def alive(self, key_expression: str) -> list[str]: ...

    def answer(self, key_expression: str, on_question: Callable[[Question], None]) -> None: ...

    def ask(self, *key_expressions: str, timeout_s: float) -> list[tuple[str, bytes]]: ...


class BusError(Exception):
    """A session cannot be opened; the text says why.

    Attributes:
        refused: somebody is there, and does not let us in.
    """

    def __init__(self, text: str, *, refused: bool = False) -> None:
        super().__init__(text)
        self.refused = refused


class ZenohBus:
    """A bus on an open zenoh session; see `open_local_bus`, `open_router`, `open_client` and `open_peer`.

    Args:
        lossless: wait rather than drop when a receiver is slow.
    """

    def __init__(self, session: Any, *, lossless: bool = False) -> None:
        self._session = session
        self._congestion = zenoh.CongestionControl.BLOCK if lossless else zenoh.CongestionControl.DROP
        self._kept: list[Any] = []  # what ends when nobody holds it

    def publisher(self, key: str) -> Put:
        """A declared publisher for frames: they go first, and unless the bus is lossless late ones are dropped."""
        publisher = self._session.declare_publisher(
            key,
            congestion_control=self._congestion,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )
        put: Put = publisher.put
        return put

    def subscribe(self, key_expression: str, on_sample: OnSample) -> None:
        """Call `on_sample(key, payload)` for every sample, directly in the thread that delivers it."""

        def forward(sample: Any) -> None:
            on_sample(str(sample.key_expr), sample.payload.to_bytes())

        self._session.declare_subscriber(key_expression, _direct(forward))

    def declare_alive(self, key: str) -> Callable[[], None]:
        """Be seen there until the session closes or its process dies, or what this returns is called."""
        token = self._session.liveliness().declare_token(key)
        self._kept.append(token)
        withdraw: Callable[[], None] = token.undeclare
        return withdraw

    def watch(self, key_expression: str, on_change: Callable[[str, bool], None]) -> None:
        """Call `on_change(key, is_there)` for all that is there already, comes or goes."""

        def forward(sample: Any) -> None:
            on_change(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        watching = self._session.liveliness().declare_subscriber(key_expression, _direct(forward), history=True)
        self._kept.append(watching)

    def alive(self, key_expression: str) -> list[str]:
        """Whose keys are there now."""
        replies = self._session.liveliness().get(key_expression, timeout=_LOOK_S)
        return sorted({str(reply.ok.key_expr) for reply in replies if reply.ok is not None})

    def answer(self, key_expression: str, on_question: Callable[[Question], None]) -> None:
        """Call `on_question` for every question asked there; it must only enqueue."""
        answering = self._session.declare_queryable(
            key_expression, _direct(lambda query: on_question(_ZenohQuestion(query)))
        )
        self._kept.append(answering)

    def ask(self, *key_expressions: str, timeout_s: float) -> list[tuple[str, bytes]]:
        """Ask everybody there, all at once; (key, payload) of each answer that comes in time."""
        asked = [
            self._session.get(
                key_expression,
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=timeout_s,
            )
            for key_expression in key_expressions
        ]
        found = [reply.ok for replies in asked for reply in replies]
        return [(str(sample.key_expr), sample.payload.to_bytes()) for sample in found if sample is not None]


class _ZenohQuestion:
    def __init__(self, query: Any) -> None:
        self._query = query
        self.key = str(query.key_expr)

    def answer(self, payload: bytes) -> None:
        with self._query as query:
            query.reply(self.key, payload)


def _direct(function: Callable[[Any], None]) -> Any:
    return zenoh.handlers.Callback(function, indirect=False)


def _keep_quiet(error: BusError) -> None:
    """Nobody wants to know."""


def _never() -> bool:
    """Nobody stops it."""
    return False


@contextmanager
def open_local_bus() -> Iterator[ZenohBus]:
    """One isolated session for one process: real zenoh pub/sub, no network at all, deliveries in order."""
    with _open({"mode": "peer"}) as session:
        yield ZenohBus(session)


@contextmanager
def open_router(endpoint: str, *, lossless: bool, gate: Gate | None = None, n_clients: int = 0) -> Iterator[ZenohBus]:
    """The session through which all others of a mission speak: it listens there (`tcp/127.0.0.1:7447`).

    Args:
        gate: whom to let in, and to what; without one, everybody to everything.
        n_clients: how many there will be, as far as that is known.

    Raises:
        BusError: it cannot listen there.
    """
    if not is_local(endpoint):
        _receive_from(n_clients)
    settings: dict[str, Any] = {"mode": "router", "listen/endpoints": [endpoint]} | _lease(endpoint)
    if gate is not None:
        settings |= _proofs(gate.credentials, "listen") | {"access_control": gate.access_control()}
    with _open_listening(settings, endpoint) as session:
        yield ZenohBus(session, lossless=lossless)


@contextmanager
def open_peer(endpoint: str, mates: Sequence[str], *, gate: Gate | None = None) -> Iterator[ZenohBus]:
    """A session that listens there and speaks to its mates directly, with nobody in the middle.

    Whoever is not there is called again and again, for as long as the session is open; nobody is waited for.

    Args:
        mates: whom it calls: where they listen. Of two peers one must call the other.
        gate: whom to let in, and to what; without one, everybody to everything.

    Raises:
        BusError: it cannot listen there.
    """
    _receive_from(len(mates))
    settings: dict[str, Any] = {
        "mode": "peer",
        "listen/endpoints": [endpoint],
        "connect/endpoints": list(mates),
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": _RETRY,
        # A mate that stands still, or is out of reach, is given up so soon, and nothing waits for it.
        "transport/link/tx/lease": round(LEASE_S * 1000),
        "transport/unicast/open_timeout": 1000,
        "transport/unicast/accept_timeout": 1000,
        "open/return_conditions/connect_scouted": False,
        "open/return_conditions/declares": False,
    }
    if gate is not None:
        settings |= _proofs(gate.credentials, "listen", "connect") | {"access_control": gate.access_control()}
    with _open_listening(settings, endpoint) as session:
        yield ZenohBus(session)


@contextmanager
def open_client(
    endpoint: str,
    *,
    lossless: bool,
    patience_s: float,
    credentials: Credentials | None = None,
    tell: Callable[[BusError], None] = _keep_quiet,
    stop: Callable[[], bool] = _never,
    n_peers: int = 0,
) -> Iterator[ZenohBus]:
    """A session behind the router that listens there; after an outage it connects again by itself.

    Args:
        tell: hears, once and while it is still tried, that somebody is there who does not let us in.
        stop: asked every few seconds; once true, it is not tried any longer.
        n_peers: how many peers this process will speak to besides, as far as that is known.

    Raises:
        BusError: nobody who lets us in listens there in `patience_s`, or until it is stopped.
    """
    if n_peers:
        _receive_from(n_peers)
    deadline_s, told, call_s = monotonic() + patience_s, False, _CALL_S
    with ExitStack() as stack:
        while True:
            try:
                session = stack.enter_context(_open(_calling(endpoint, credentials, deadline_s - monotonic(), call_s)))
                break
            except zenoh.ZError as error:
                refused = round_trip_s(endpoint, timeout_s=_LOOK_S) is not None
                tried_s = patience_s if monotonic() >= deadline_s else _ATTEMPT_S
                text = f"who listens on {endpoint} has not let us in for {tried_s:g} s"
                if not refused:
                    text = f"nobody has answered on {endpoint} for {tried_s:g} s ({_reason(error)})"
                failure = BusError(text, refused=refused)
                if monotonic() >= deadline_s or stop():
                    raise failure from error
                if refused:
                    # A router takes up no call by TLS for 100 ms after one that was broken off
                    # (eclipse-zenoh/zenoh#2685): a few of us that call anew all the time would never be let in.
                    call_s = _ATTEMPT_S
                    if not told:
                        told = True
                        tell(failure)
        yield ZenohBus(session, lossless=lossless)


def _calling(endpoint: str, credentials: Credentials | None, left_s: float, call_s: float) -> dict[str, Any]:
    """The settings of one attempt to reach a router, by calls of `call_s` each, or longer where the link is slow."""
    settings: dict[str, Any] = {
        "mode": "client",
        "connect/endpoints": [endpoint],
        "connect/timeout_ms": round(min(max(left_s, _LEAST_S), _ATTEMPT_S) * 1000),
        "connect/exit_on_failure": True,
        "connect/retry": _RETRY_SOON,
    }
    if not is_local(endpoint):
        # A call that is not answered must not wait for TCP, which asks again after 1, 3, 7 and 15 s.
        trip_s = round_trip_s(endpoint, timeout_s=_LOOK_S) or 0.0
        answer_s = min(max(call_s, _TRIPS_TO_OPEN * trip_s), _ATTEMPT_S)
        settings |= _lease(endpoint) | {"transport/unicast/open_timeout": round(answer_s * 1000)}
    return settings | ({} if credentials is None else _proofs(credentials, "connect"))


def _lease(endpoint: str) -> dict[str, Any]:
    return {} if is_local(endpoint) else {"transport/link/tx/lease": round(LEASE_S * 1000)}


@contextmanager
def _open_listening(settings: Mapping[str, Any], endpoint: str) -> Iterator[Any]:
    with ExitStack() as stack:
        try:
            session = stack.enter_context(_open(settings))
        except zenoh.ZError as error:
            raise BusError(
                f"cannot listen on {endpoint}: is it a free port of this machine? ({_reason(error)})"
            ) from error
        yield session


@contextmanager
def _open(settings: Mapping[str, Any]) -> Iterator[Any]:
    zenoh.init_log_from_env_or(_SAYS)
    config = zenoh.Config()
    for key, value in (_QUIET | dict(settings)).items():
        config.insert_json5(key, json.dumps(value))
    session: Any = zenoh.open(config)
    try:
        yield session
    finally:
        with suppress(zenoh.ZError):  # who stands still does not answer a farewell, and is not waited for
            session.close()


def _receive_from(n_links: int) -> None:
    """Have a thread to receive by for each of so many links that may be cut.

    zenoh closes a socket whose other end has gone in a thread that receives, where close(2) waits up to 10 s for what
    was still to be sent. It has two such threads for all links: two that are cut would silence the others. They are
    counted when the process opens its first session.
    """
    n_threads = _RECEIVERS + min(n_links, _MOST_RECEIVERS)
    os.environ.setdefault("ZENOH_RUNTIME", f"(rx: (worker_threads: {n_threads}))")


def _proofs(credentials: Credentials, *ends: str) -> dict[str, Any]:
    """Both ends show certificates. A router's is of another kind than a client's, so no address needs to be in it."""
    tls = "transport/link/tls"
    return {
        f"{tls}/root_ca_certificate": str(credentials.authority),
        f"{tls}/enable_mtls": True,
        f"{tls}/verify_name_on_connect": False,
        **{f"{tls}/{end}_certificate": str(credentials.certificate) for end in ends},
        **{f"{tls}/{end}_private_key": str(credentials.key) for end in ends},
    }


def _reason(error: Exception) -> str:
    """What zenoh says, without where in its source it says so."""
    return str(error).partition(" at /")[0]


LEASE_S = 1.0
_LOOK_S = 1.0
# A session says as an error that frames came from before its last sleep, one by one.
_SAYS = "error,zenoh::api::session=off"
_ATTEMPT_S = 3.0  # then it is asked whether anybody is there
_LEAST_S = 0.1
_RETRY = {"period_init_ms": 100, "period_max_ms": 300, "period_increase_factor": 1.5}
_RETRY_SOON = _RETRY | {"period_max_ms": 100}
_CALL_S = 0.25  # on a link that is quick; TCP, TLS and zenoh take some round trips
_TRIPS_TO_OPEN = 10
_RECEIVERS, _MOST_RECEIVERS = 2, 64
_MOST_BYTES = 16_777_216  # what a thousand agents tell a recorder in one tick is a quarter of it
_QUIET: dict[str, Any] = {
    "listen/endpoints": [],
    "connect/endpoints": [],
    "scouting/multicast/enabled": False,
    "scouting/gossip/enabled": False,
    "transport/shared_memory/enabled": False,
    # A message is whole in memory before any bound of ours is asked.
    "transport/link/rx/max_message_size": _MOST_BYTES,
}
