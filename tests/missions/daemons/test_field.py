"""Agents in processes of their own that hear each other directly: through the world, or from radio to radio."""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from comms.access import Gate, Place
from comms.codec import encode
from comms.credentials import Credentials, agents_name
from comms.field import FieldRadio
from comms.keys import Keys, sender
from comms.messages import Frame
from comms.radio import Roster
from comms.session import BusError, Network, open_client, open_peer, open_router
from missions.cli import main
from missions.sides.computer import HEARS_MORE
from tests.missions.daemons.swarm import SMALL, children, free_endpoint, kill, swarm
from tests.patience import PATIENCE_S, until

KEYS = Keys("tour")
FIELD = ("--set", "radio.mode=field")
UNEVEN = ("--set", "agents.count=3", "--set", "radio.endpoints=[tcp/127.0.0.1:1, tcp/127.0.0.1:2, tcp/127.0.0.1:2]")
FAULTS = "faults=[{kind: kill, at_s: 4, for_s: 5, agents: [1]}, {kind: freeze, at_s: 6, for_s: 4, agents: [2]}]"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("cryptography")
    folder = tmp_path_factory.mktemp("keys")
    assert main(["keys", str(folder), "--agents", "3"]) == 0
    return folder


def radios(n: int = 3) -> tuple[str, str]:
    return "--set", f"radio.endpoints=[{', '.join(free_endpoint() for _ in range(n))}]"


def reported(file: Path, *words: str) -> dict[str, Any]:
    with swarm("launch", "quickstart", *SMALL, *FIELD, *words, "--report", str(file)) as run:
        assert run.wait() == 0, run.output
    report: dict[str, Any] = json.loads(file.read_text())
    return {key: value for key, value in report.items() if key not in ("timing", "recording")}


@pytest.mark.parametrize("secured", [False, True], ids=["open", "secured"])
def test_many_processes_decide_what_one_does(tmp_path: Path, folder: Path, secured: bool) -> None:
    flown = ("--duration", "12", "--set", FAULTS)
    keys = ("--keys", str(folder)) if secured else ()
    one = reported(tmp_path / "one.json", *flown)
    assert reported(tmp_path / "many.json", *flown, "--processes", "--listen", free_endpoint(), *keys) == one
    assert one["radio"]["delivered"] > 0


def test_rubbish_on_a_mates_key_ends_no_flight_in_lockstep(tmp_path: Path) -> None:
    endpoint, file = free_endpoint(), tmp_path / "report.json"
    words = ("--processes", "--listen", endpoint, "--duration", "20", "--report", str(file), "--log-level", "info")
    with swarm("launch", "quickstart", *SMALL, *FIELD, *words) as run:
        with open_client(endpoint, lossless=True, patience_s=PATIENCE_S) as bus:
            put = bus.publisher(Keys("quickstart").tx(1))
            run.wait_for("setting its return altitude")
            for _ in range(100):
                put(b"rubbish")
        assert run.wait() == 0, run.output
    assert HEARS_MORE in run.output
    assert json.loads(file.read_text())["radio"]["refused"] > 0


def test_frames_go_from_radio_to_radio(tmp_path: Path, folder: Path) -> None:
    words = ("--processes", "--listen", free_endpoint(), "--speed", "10", "--duration", "8", "--keys", str(folder))
    radio = reported(tmp_path / "report.json", *words, *radios())["radio"]
    assert radio["sent"] > 0
    # The world's router lets no mate's frames through. On a slow computer many are stale when they are looked at.
    assert radio["delivered"] > 0


def test_mates_hear_each_other_while_the_world_stands_still() -> None:
    endpoints = [free_endpoint() for _ in range(3)]
    where = ("--set", f"radio.endpoints=[{', '.join(endpoints)}]", "--set", "agents.altitude.base_m=2")
    words = ("--processes", "--listen", free_endpoint(), "--speed", "4", "--duration", "600", "--log-level", "info")
    with swarm("launch", "quickstart", *SMALL, *FIELD, *where, *words) as run:
        run.wait_for("the mission begins")
        [world] = [pid for pid, words in children(run.process.pid).items() if " world " in words]
        kill(world, signal.SIGSTOP)
        run.wait_for("holds still")
        heard: set[int | None] = set()
        with open_peer(free_endpoint(), endpoints) as listener:
            listener.subscribe(Keys("quickstart").every_tx, lambda key, payload: heard.add(sender(key)))
            until(lambda: heard == {0, 1, 2})
        kill(world, signal.SIGCONT)
        run.wait_for("the world is back")


class Radios:
    """Secured radios by name, each the session of a process; the later ones call the earlier ones."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._folder, self._stack = folder, stack
        self._names = tuple(agents_name([uid]) for uid in range(3))
        self._endpoints = sorted(free_endpoint().replace("tcp", "tls") for _ in self._names)

    def open(self, uid: int, *, name: str | None = None) -> Network:
        gate = Gate(Credentials(self._folder, name or agents_name([uid])).of_radio, KEYS, self._names, Place.RADIO)
        return self._stack.enter_context(open_peer(self._endpoints[uid], self._endpoints[:uid], gate=gate))


@pytest.fixture
def net(folder: Path) -> Iterator[Radios]:
    with ExitStack() as stack:
        yield Radios(folder, stack)


def frame(src: int, seq: int) -> bytes:
    return encode(Frame(src, seq, 0.0, 0.5, (0.0, 0.0, 10.0), (0.0, 0.0, 0.0)))


@pytest.mark.parametrize("thief", [0, 1, 2], ids=["who is called", "who calls and is called", "who calls"])
def test_a_stolen_key_does_not_speak_for_others_from_radio_to_radio(net: Radios, thief: int) -> None:
    buses = [net.open(uid) for uid in range(3)]
    victims = [uid for uid in range(3) if uid != thief]
    heard: list[tuple[int, str]] = []
    for uid in victims:
        buses[uid].subscribe("swarm/@v1/**", lambda key, payload, uid=uid: heard.append((uid, key)))  # type: ignore[misc]
        buses[uid].subscribe(KEYS.every_tx, lambda key, payload, uid=uid: heard.append((uid, key)))  # type: ignore[misc]
    others = [KEYS.tx(uid) for uid in victims]
    said = [buses[thief].publisher(key) for key in (*others, KEYS.cue(victims[0]), KEYS.tx(thief))]

    def speak() -> bool:
        for put in said:
            put(frame(thief, 1))
        return {uid for uid, _ in heard} == set(victims)

    until(speak)
    assert {key for _, key in heard} == {KEYS.tx(thief)}


def test_a_radios_key_does_not_make_a_world(folder: Path) -> None:
    endpoint, own = free_endpoint().replace("tcp", "tls"), Credentials(folder, agents_name([1])).of_radio
    with (
        open_router(endpoint, lossless=True, gate=Gate(own, KEYS, (agents_name([2]),))),
        pytest.raises(BusError) as refused,
        open_client(endpoint, lossless=True, patience_s=1.0, credentials=Credentials(folder, agents_name([2]))),
    ):
        pytest.fail("it has been taken for a world")
    assert refused.value.refused


def test_whose_frame_names_another_sender_is_not_believed(net: Radios) -> None:
    victim, thief = FieldRadio(net.open(0), keys=KEYS, uid=0, roster=Roster(n_agents=3)), net.open(1)
    put, seq = thief.publisher(KEYS.tx(1)), 0

    def speak() -> bool:
        nonlocal seq
        seq += 1
        put(frame(2, seq))
        return victim.waiting(0.1) > 0

    until(speak)
    assert victim.drain(0.1) == []
    assert victim.count.bad > 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("agent", "narrow", "--id", "0-1", *FIELD, *radios(10)), "--id: got 0-1; allowed: 0, which shares tcp/"),
        (("plan", "narrow", "--processes", "5", *FIELD, *radios(10)), "--processes: got 5; allowed: 1, as agents"),
        (("launch", "narrow", "--processes", *FIELD, *UNEVEN), "--processes: got 1; allowed: no number, but"),
        (("world", "narrow", "--speed", "max", *FIELD, *radios(10)), "--speed: got max; allowed: a number"),
        (
            ("agent", "narrow", "--id", "0", *FIELD, "--set", "radio.endpoints=[tcp/10.0.0.5:7448]"),
            "as many as agents.count",
        ),
        (
            ("agent", "narrow", "--id", "0", *FIELD, "--set", f"radio.endpoints={['tcp/10.0.0.5:7448'] * 10}"),
            "--id: got 0; allowed: 0-9, which shares",
        ),
        (
            ("agent", "narrow", "--id", "0-9", *FIELD, "--set", f"radio.endpoints={['tcp/10.0.0.5:7448'] * 10}"),
            "radio.endpoints: got tcp/10.0.0.5:7448, where other computers may come in; allowed: --keys DIR",
        ),
    ],
)
def test_a_radio_that_cannot_be_is_refused(
    words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words]) == 2
    assert said in capsys.readouterr().err
