"""A secured network: who may take part, what a stolen key is good for, and what those are told who stay outside."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

import pytest

from comms.access import Gate
from comms.credentials import OPERATOR, Credentials, agents_name, agents_named
from comms.keys import EVERYBODY_OF_ANY_MISSION, RECORDER, WORLD, Keys
from comms.session import BusError, Network, Question, open_client, open_router
from missions.cli import main
from missions.daemons import fleet
from tests.missions.daemons.swarm import SMALL, free_endpoint, swarm
from tests.patience import PATIENCE_S, until

pytest.importorskip("cryptography")

KEYS = Keys("tour")
EVERYTHING = ("swarm/@v1/tour/**", "swarm/@v1/tour/@sim/**", KEYS.truth, KEYS.cue(2), KEYS.rx(2), KEYS.every_tx)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("keys")
    assert main(["keys", str(folder), "--agents", "3"]) == 0
    return folder


@pytest.fixture(scope="module")
def foreign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("foreign")
    assert main(["keys", str(folder), "--agents", "3"]) == 0
    return folder


class Net:
    """A secured router, and clients of it by name."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.folder, self.endpoint = folder, free_endpoint().replace("tcp", "tls")
        self._stack = stack
        own = Credentials(folder, WORLD)
        gate = Gate(own, KEYS, tuple(own.known))
        self.router = stack.enter_context(open_router(self.endpoint, lossless=True, gate=gate))

    def client(self, name: str) -> Network:
        credentials = Credentials(self.folder, name)
        return self._stack.enter_context(
            open_client(self.endpoint, lossless=True, patience_s=PATIENCE_S, credentials=credentials)
        )


@pytest.fixture
def net(folder: Path) -> Iterator[Net]:
    with ExitStack() as stack:
        yield Net(folder, stack)


def answer_all(bus: Network, key_expression: str, text: bytes) -> None:
    questions: SimpleQueue[Question] = SimpleQueue()
    bus.answer(key_expression, questions.put)

    def run() -> None:
        while True:
            try:
                questions.get(timeout=PATIENCE_S).answer(text)
            except Empty:
                return

    Thread(target=run, daemon=True).start()


def test_a_stolen_key_does_not_speak_for_others(net: Net) -> None:
    heard: list[str] = []
    for key in (KEYS.every_tx, KEYS.every_done, KEYS.kept):
        net.router.subscribe(key, lambda key, payload: heard.append(key))
    there: list[str] = []
    for key in (KEYS.every_alive, KEYS.every_recorder):
        net.router.watch(key, lambda key, is_there: there.append(key))
    thief = net.client("agent-1")
    for token in (KEYS.alive(2), KEYS.alive(WORLD), KEYS.recorder(7), KEYS.alive(1)):
        thief.declare_alive(token)
    forbidden = [KEYS.tx(2), KEYS.done(2), KEYS.kept, KEYS.rx(2), KEYS.cue(2), KEYS.truth]
    puts = [thief.publisher(key) for key in (*forbidden, KEYS.done(1), KEYS.tx(1))]

    def speak() -> bool:
        for put in puts:
            put(b"it is me")
        return KEYS.tx(1) in heard  # what it may say comes last, so that the rest has had its chance

    until(speak)
    until(lambda: KEYS.alive(1) in there)
    assert set(heard) <= {KEYS.tx(1), KEYS.done(1)}
    assert there == [KEYS.alive(1)]


def test_a_stolen_key_hears_its_own_alone(net: Net) -> None:
    heard: list[tuple[str, bytes]] = []
    thief = net.client("agent-1")
    for key in (*EVERYTHING, KEYS.cue(1)):
        thief.subscribe(key, lambda key, payload: heard.append((key, payload)))
    said = (KEYS.truth, KEYS.cue(2), KEYS.rx(2), KEYS.tx(2), KEYS.cue(1))
    puts = [net.router.publisher(key) for key in said]

    def speak() -> bool:
        for put in puts:
            put(b"secret")
        return (KEYS.cue(1), b"secret") in heard

    until(speak)
    assert {key for key, _ in heard} == {KEYS.cue(1)}


def test_a_stolen_key_commands_nobody_and_answers_for_itself_alone(net: Net) -> None:
    victim, thief, person = net.client("agent-2"), net.client("agent-1"), net.client(OPERATOR)
    answer_all(victim, KEYS.every_command(2), b"victim")
    victim.declare_alive(KEYS.alive(2))
    until(lambda: person.ask(KEYS.command(2, "hold"), timeout_s=1.0) == [(KEYS.command(2, "hold"), b"victim")])
    assert thief.ask(KEYS.command(2, "land"), timeout_s=1.0) == []
    assert thief.alive(EVERYBODY_OF_ANY_MISSION) == []
    answer_all(thief, KEYS.every_command(2), b"thief")
    answer_all(thief, KEYS.every_command(1), b"thief")
    until(lambda: person.ask(KEYS.command(1, "hold"), timeout_s=1.0))
    answers: list[tuple[str, bytes]] = []
    until(lambda: answers.extend(person.ask(KEYS.command(2, "hold"), timeout_s=1.0)) or answers)
    assert answers == [(KEYS.command(2, "hold"), b"victim")]
    until(lambda: person.alive(EVERYBODY_OF_ANY_MISSION) == [KEYS.alive(2)])


def test_an_agent_whose_certificate_is_not_in_the_folder_of_the_world_is_a_stranger(folder: Path) -> None:
    heard: list[str] = []
    with ExitStack() as stack:
        gate = Gate(Credentials(folder, WORLD), KEYS, ("agent-0", OPERATOR))
        endpoint = free_endpoint().replace("tcp", "tls")
        router = stack.enter_context(open_router(endpoint, lossless=True, gate=gate))
        router.subscribe(KEYS.every_tx, lambda key, payload: heard.append(key))
        puts = []
        for uid in (1, 0):
            credentials = Credentials(folder, agents_name([uid]))
            client = open_client(endpoint, lossless=True, patience_s=PATIENCE_S, credentials=credentials)
            puts.append(stack.enter_context(client).publisher(KEYS.tx(uid)))

        def speak() -> bool:
            for put in puts:
                put(b"here")
            return len(heard) >= 3

        until(speak)
    assert set(heard) == {KEYS.tx(0)}


def test_an_agents_key_does_not_make_a_world(folder: Path) -> None:
    endpoint = free_endpoint().replace("tcp", "tls")
    with (
        open_router(endpoint, lossless=True, gate=Gate(Credentials(folder, "agent-1"), KEYS, ("agent-2",))),
        pytest.raises(BusError) as refused,
        open_client(endpoint, lossless=True, patience_s=1.0, credentials=Credentials(folder, "agent-2")),
    ):
        pytest.fail("it has been taken for a world")
    assert refused.value.refused


def test_who_has_no_credentials_or_those_of_others_gets_a_hint(
    net: Net, foreign: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fleet, "CONNECT_S", 0.5)
    endpoint = net.endpoint.replace("tls", "tcp")
    assert main(["status", "--connect", endpoint]) == 1
    said = capsys.readouterr().err
    assert f"who listens on {endpoint} has not let us in" in said
    assert "give --keys here, too" in said
    assert main(["land", "--connect", endpoint, "--keys", str(foreign)]) == 1
    assert "operator.pem and its key from the same `swarm keys`" in capsys.readouterr().err


def test_a_key_that_bears_a_wrong_name_gets_a_hint(
    net: Net, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fleet, "CONNECT_S", PATIENCE_S)
    stolen, pretended = Credentials(folder, "agent-1"), Credentials(tmp_path, OPERATOR)
    for mine, its in (
        (pretended.authority, stolen.authority),
        (pretended.certificate, stolen.certificate),
        (pretended.key, stolen.key),
    ):
        mine.write_bytes(its.read_bytes())
    net.client("agent-2").declare_alive(KEYS.alive(2))
    assert main(["land", "--connect", net.endpoint, "--keys", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert "nobody of any mission is there" in said
    assert f"{pretended.certificate} is not what its name says" in said


def test_a_secured_mission_of_many_processes_decides_what_one_does(folder: Path, tmp_path: Path) -> None:
    files = tmp_path / "one.json", tmp_path / "many.json"
    mission = ("launch", "quickstart", *SMALL, "--duration", "5")
    secured = ("--processes", "--listen", free_endpoint(), "--keys", str(folder))
    for file, words in zip(files, ((), secured), strict=True):
        with swarm(*mission, *words, "--report", str(file)) as run:
            assert run.wait() == 0, run.output
    one, many = (json.loads(file.read_text()) for file in files)
    for key in ("timing", "recording"):
        one.pop(key), many.pop(key)
    assert one == many
    assert one["radio"]["delivered"] > 0


def contents(folder: Path) -> dict[Path, bytes]:
    return {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def test_credentials_are_for_nobody_elses_eyes_and_are_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "new" / "keys"
    assert main(["keys", str(folder), "--agents", "5", "--per-process", "2"]) == 0
    assert folder.stat().st_mode & 0o777 == 0o700
    assert (folder / "radio").stat().st_mode & 0o777 == 0o700
    before = contents(folder)
    assert {file.stat().st_mode & 0o777 for file in before} == {0o600}
    names = ["agent-4", "agents-0-1", "agents-2-3", OPERATOR, RECORDER, WORLD]
    assert Credentials(folder, WORLD).known == sorted(names)
    assert not any(Credentials(folder, name).missing for name in names)
    assert not any(Credentials(folder, name).of_radio.missing for name in names[:3])

    assert main(["keys", str(folder), "--agents", "2"]) == 2
    assert "allowed: another folder, or --force" in capsys.readouterr().err
    assert contents(folder) == before
    (folder / "mine.pem").write_text("not of a swarm")
    assert main(["keys", str(folder), "--agents", "2", "--force"]) == 0
    assert Credentials(folder, WORLD).known == ["agent-0", "agent-1", "mine", OPERATOR, RECORDER, WORLD]
    assert Credentials(folder / "radio", "agent-0").known == ["agent-0", "agent-1", OPERATOR]
    assert (folder / "world.key").read_bytes() != before[folder / "world.key"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("world", "narrow", "--listen", "tcp/0.0.0.0:7447"), "allowed: --keys DIR"),
        (("world", "narrow", "--listen", "tcp/[::]:7447"), "or --insecure to let in everybody"),
        (("launch", "narrow", "--processes", "--listen", "tcp/10.0.0.5:7447"), "allowed: --keys DIR"),
        (("plan", "narrow", "--processes", "--listen", "tcp/swarm.example:7447"), "allowed: --keys DIR"),
        (("world", "narrow", "--listen", "tls/127.0.0.1:7447"), "got no keys; allowed: --keys DIR"),
        (("launch", "narrow", "--processes", "--listen", "tls/127.0.0.1:7447"), "got no keys; allowed: --keys DIR"),
        (("launch", "narrow", "--processes", "2", "--keys", "FOLDER"), "has no agents-0-1.pem, agents-0-1.key"),
        (("world", "narrow", "--keys", "FOLDER"), "no certificate of agent 3, 4"),
        (("agent", "narrow", "--id", "7", "--keys", "FOLDER"), "has no agent-7.pem, agent-7.key"),
        (("agent", "narrow", "--id", "0-1", "--keys", "FOLDER"), "has no agents-0-1.pem, agents-0-1.key"),
        (("status", "--keys", "/dev/null"), "allowed: a folder that `swarm keys` has made"),
        (("status", "--keys", "FOLDER", "--connect", "udp/127.0.0.1:7447"), "allowed: tcp/ADDRESS:PORT"),
    ],
)
def test_what_cannot_be_secured_is_said(
    folder: Path, words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(folder) if word == "FOLDER" else word for word in words]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("endpoint", ["foo", "7447", "10.0.0.5:7447", "tcp/127.0.0.1:99999"])
@pytest.mark.parametrize(
    "words",
    [
        ("status", "--connect"),
        ("stop", "narrow", "--connect"),
        ("agent", "narrow", "--id", "0", "--connect"),
        ("agent", "narrow", "--id", "0", "--alone"),
        ("record", "narrow", "--view", "--connect"),
        ("world", "narrow", "--listen"),
        ("launch", "narrow", "--listen"),
        ("launch", "narrow", "--processes", "--listen"),
        ("plan", "narrow", "--listen"),
    ],
    ids=" ".join,
)
def test_what_is_no_endpoint_is_refused_at_once(
    words: tuple[str, ...], endpoint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, endpoint]) == 2
    said = capsys.readouterr().err
    assert f"{words[-1]}: got {endpoint}; allowed: tcp/ADDRESS:PORT, such as tcp/127.0.0.1:7447\n" in said
    assert "--insecure to" not in said


@pytest.mark.parametrize(
    ("name", "uids"),
    [
        ("agent-3", [3]),
        ("agents-0-4", [0, 1, 2, 3, 4]),
        (WORLD, []),
        ("agent-", []),
        ("agent-1-2", []),
        ("agents-2", []),
    ],
)
def test_a_name_tells_which_agents_it_is_of(name: str, uids: list[int]) -> None:
    assert list(agents_named(name)) == uids
    if uids:
        assert agents_name(uids) == name
