"""Agents without a world: their own clock, a detector on board, people who begin and end, and mates heard directly."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import Event, Thread
from time import time

import pytest
from pymavlink import mavutil

from comms.access import Gate, Place
from comms.credentials import OPERATOR, Credentials
from comms.keys import Keys
from comms.session import Network, open_client, open_router
from missions.cli import main
from missions.daemons.fleet import FleetOptions, ask
from missions.daemons.orders import Answer, Verb
from missions.tlog import log_of
from tests.missions.daemons.swarm import free_endpoint, swarm
from tests.patience import PATIENCE_S, until

KEYS = Keys("quickstart")
LOW = ("agents.count=2", "targets.count=3", "vehicle.boot_s=0.5", "agents.altitude.base_m=2", "radio.mode=field")


@contextmanager
def detector(bus: Network, uid: int, target: int) -> Iterator[None]:
    """A program that sees one target, which stands still, ten times a second."""
    put, over = bus.publisher(KEYS.sight(uid)), Event()

    def run() -> None:
        while not over.wait(0.1):
            put(json.dumps({"at_s": time(), "targets": [{"target": target, "east_m": 1.0, "north_m": 0.5}]}).encode())

    thread = Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def told(bus: Network, verb: Verb) -> Answer:
    """The answer of the only agent there."""
    [answer] = ask(bus, verb, FleetOptions(mission="quickstart")).values()
    assert answer is not None
    return answer


def test_two_agents_fly_a_mission_of_their_own(tmp_path: Path) -> None:
    radios = f"radio.endpoints=[{free_endpoint()}, {free_endpoint()}]"
    changes = [word for text in (*LOW, radios) for word in ("--set", text)]
    with ExitStack() as stack:
        agents, boards = [], []
        for uid in range(2):
            board = free_endpoint()
            words = ("agent", "quickstart", *changes, "--id", str(uid), "--alone", board, "--tlog", str(tmp_path))
            agents.append(stack.enter_context(swarm(*words)))
            agents[uid].wait_for("waits on the ground for resume")
            boards.append(stack.enter_context(open_client(board, lossless=True, patience_s=PATIENCE_S)))
        refused = told(boards[0], Verb.HOLD)
        assert not refused.obeyed
        assert refused.report is None  # it has not even spoken to its vehicle
        stack.enter_context(detector(boards[0], uid=0, target=1))
        for board in boards:
            assert told(board, Verb.RESUME).text == "begins"

        def follows_and_is_heard() -> bool:
            one, other = (told(board, Verb.STATUS).report for board in boards)
            return one is not None and other is not None and one.tags == (1,) and (one.mates, other.mates) == (1, 1)

        until(follows_and_is_heard)
        report = told(boards[0], Verb.STATUS).report
        assert report is not None
        assert abs(report.time_s - time()) < PATIENCE_S
        assert told(boards[0], Verb.LAND).obeyed
        assert told(boards[1], Verb.LAND).obeyed
        for agent in agents:
            assert agent.wait() == 0, agent.output
            assert "landed and disarmed" in agent.output
    for uid in range(2):
        log = mavutil.mavlink_connection(str(log_of(tmp_path, uid)))
        heard = log.recv_match(type="HEARTBEAT")
        assert abs(heard._timestamp - time()) < 3 * PATIENCE_S  # of the clock on the wall, as the mission is


@pytest.mark.parametrize("asked", ["before it has begun", "by a person"])
def test_who_is_to_end_before_it_has_begun_flies_nowhere(asked: str) -> None:
    changes = [word for text in LOW for word in ("--set", text)]
    board = free_endpoint()
    with swarm("agent", "quickstart", *changes, "--id", "0-1", "--alone", board) as agent:
        agent.wait_for("waits on the ground")
        if asked == "by a person":
            with open_client(board, lossless=True, patience_s=PATIENCE_S) as bus:
                answers = ask(bus, Verb.STOP, FleetOptions(mission="quickstart"))
            assert all(answer is not None and answer.obeyed for answer in answers.values())
        else:
            agent.process.terminate()
        assert agent.wait() == 0, agent.output
        assert "preparing" not in agent.output


def test_on_board_a_detector_speaks_of_its_own_sight_alone_and_an_operator_commands(tmp_path: Path) -> None:
    pytest.importorskip("cryptography")
    assert main(["keys", str(tmp_path / "keys"), "--agents", "2"]) == 0
    own = Credentials(tmp_path / "keys", "agent-0").of_radio
    endpoint, heard, asked = free_endpoint().replace("tcp", "tls"), [], []
    with ExitStack() as stack:
        gate = Gate(own, KEYS, tuple(own.known), Place.BOARD)
        router = stack.enter_context(open_router(endpoint, lossless=True, gate=gate))
        for key in ("swarm/@v1/quickstart/**", KEYS.sight(0), KEYS.sight(1), KEYS.done(0)):
            router.subscribe(key, lambda key, payload: heard.append(key))
        router.answer(KEYS.every_command(0), lambda question: asked.append(question.key))

        def client(name: str) -> Network:
            credentials = Credentials(own.folder, name)
            return stack.enter_context(
                open_client(endpoint, lossless=True, patience_s=PATIENCE_S, credentials=credentials)
            )

        detects, person = client("agent-0"), client(OPERATOR)
        forbidden = (KEYS.sight(1), KEYS.tx(0), KEYS.tx(1), KEYS.done(0))
        puts = [bus.publisher(key) for bus in (detects, person) for key in forbidden]
        puts += [person.publisher(KEYS.sight(0)), detects.publisher(KEYS.sight(0))]

        def speak() -> bool:
            for put in puts:
                put(b"look")
            return KEYS.sight(0) in heard

        until(speak)
        detects.ask(KEYS.command(0, "land"), timeout_s=0.5)
        assert asked == []
        until(lambda: person.ask(KEYS.command(0, "hold"), timeout_s=0.5) or asked)
    assert set(heard) == {KEYS.sight(0)}
    assert asked[0] == KEYS.command(0, "hold")


FIELD = ("--set", "radio.mode=field")
FAULT = ("--set", "faults=[{kind: kill, at_s: 1, agents: [0]}]")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--id", "0"), "radio.mode: got sim; allowed with --alone: field"),
        (("--id", "0", *FIELD), "radio.endpoints: got none; allowed with --alone: one for each agent"),
        (("--id", "0-9", *FIELD, *FAULT), "faults: got some; allowed with --alone: none"),
        (("--id", "0-9", *FIELD, "--speed", "2"), "--speed: got 2; allowed with --alone: 1"),
    ],
)
def test_what_cannot_be_without_a_world_is_refused(
    words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["agent", "narrow", *words, "--alone"]) == 2
    assert said in capsys.readouterr().err


def test_others_may_not_come_in_unasked(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["agent", "narrow", "--id", "0-9", *FIELD, "--alone", "tcp/0.0.0.0:7447"]) == 2
    assert "--alone: got tcp/0.0.0.0:7447, where other computers may come in" in capsys.readouterr().err
