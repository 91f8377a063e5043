"""People and vehicles under way: every order has a result from every vehicle."""

from __future__ import annotations

import json
import subprocess
from argparse import Namespace
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from io import StringIO
from math import inf
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from time import monotonic

import pytest
from rich.console import Console

from comms.keys import WORLD, Keys
from comms.radio import ANYBODY
from comms.session import Network, Question, open_client, open_router
from comms.status import Activity, AgentStatus, Event, Level
from missions.cli import main
from missions.colors import ACTIVITY_INKS, hex_color
from missions.daemons import verbs
from missions.daemons.desk import MissionDesk, open_board
from missions.daemons.fleet import ANSWER_S, ATTEMPTS, FleetOptions, ask, status_table
from missions.daemons.options import ENDPOINT
from missions.daemons.orders import Answer, Orders, Report, Verb, decode_answer, encode_answer
from missions.daemons.wire import decode_done, encode
from missions.ending import Ending
from missions.observation import AgentTruth
from missions.options import Board
from missions.problems import InputError
from missions.sides.exchange import Cue, Done
from tests.missions.daemons.swarm import COMMAND, FOR_EVER_S, ROOT, SMALL, free_endpoint, swarm
from tests.patience import PATIENCE_S, until

CUE = Cue(tick=7, mission_tick=3)
DONE = Done(
    tick=7,
    status=AgentStatus(uid=0, activity=Activity.FOLLOW),
    truth=AgentTruth((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), 0.0),
    on_ground=False,
)
ON_DUTY = {Activity.EXPLORE, Activity.FOLLOW, Activity.CALLING, Activity.HELPING}


@pytest.mark.parametrize(
    ("verb", "activity", "obeyed", "text"),
    [
        ("status", Activity.LOST, True, ""),
        ("hold", Activity.FOLLOW, True, "holds"),
        ("resume", Activity.EXPLORE, True, "goes on"),
        ("return", Activity.HELPING, True, "comes home"),
        ("land", Activity.PREPARING, True, "lands"),
        ("stop", Activity.EXPLORE, True, "comes home"),
        ("hold", Activity.RETURNING, False, "is on its way down"),
        ("hold", Activity.LANDED, False, "is landed"),
        ("land", Activity.LANDED, True, "is landed"),
        ("return", Activity.LOST, False, "is lost"),
        ("stop", Activity.LANDED, True, "comes home"),
        ("loop", Activity.FOLLOW, False, "knows no loop"),
    ],
)
def test_what_a_vehicle_obeys(verb: str, activity: Activity, obeyed: bool, text: str) -> None:
    assert Orders().take(verb, activity) == (obeyed, text)


def test_orders_stand_and_the_way_down_is_not_taken_back() -> None:
    orders = Orders()
    assert orders.amend(CUE) is CUE
    orders.take("hold", Activity.FOLLOW)
    assert orders.amend(CUE).hold
    assert not orders.amend(CUE).come_home
    orders.take("resume", Activity.FOLLOW)
    assert orders.amend(CUE) is CUE
    orders.take("land", Activity.FOLLOW)
    orders.take("return", Activity.FOLLOW)
    assert orders.take("resume", Activity.FOLLOW) == (False, "is on its way down")
    assert orders.amend(CUE).land
    assert orders.amend(CUE).come_home


@pytest.mark.parametrize(
    "wire", [b"", b"\xc1", b"\x81\xa6obeyed\x03", encode_answer(Answer(obeyed=True, text="x"))[:-1]]
)
def test_an_answer_that_is_none_is_nothing(wire: bytes) -> None:
    assert decode_answer(wire) is None


def tell(*words: str) -> tuple[int, str]:
    done = subprocess.run((*COMMAND, *words), capture_output=True, text=True, timeout=PATIENCE_S, cwd=ROOT, check=False)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize("how", [("--processes", "--log-level", "info"), ()], ids=["processes", "one process"])
def test_a_swarm_is_held_resumed_landed_and_stopped(how: tuple[str, ...], tmp_path: Path) -> None:
    endpoint, file = free_endpoint(), tmp_path / "report.json"
    launch = ("launch", "quickstart", *SMALL, "--speed", "5", "--duration", str(FOR_EVER_S))
    with swarm(*launch, "--report", str(file), *how, "--listen", endpoint) as run:
        at = ("quickstart", "--connect", endpoint)
        with open_client(endpoint, lossless=True, patience_s=PATIENCE_S) as bus:
            until(lambda: (now := activities(bus)) and ON_DUTY.issuperset(now))
        code, text = tell("status", "--connect", endpoint)
        assert code == 0, text
        assert text.count("GUIDED") == 3
        code, text = tell("hold", *at)
        assert (code, text.count("holds")) == (0, 3), text
        code, text = tell("resume", *at, "--id", "1")
        assert (code, text.count("goes on")) == (0, 1), text
        code, text = tell("land", *at, "--id", "0")
        assert (code, text.count("lands")) == (0, 1), text
        with open_client(endpoint, lossless=True, patience_s=PATIENCE_S) as bus:
            until(lambda: activities(bus, 0) == [Activity.LANDED])
        code, text = tell("hold", *at)
        assert code == 1  # two hold, one has landed
        assert (text.count("holds"), text.count("is landed")) == (2, 1), text
        code, text = tell("return", *at, "--id", "7")
        assert code == 2
        assert "--id: got 7; allowed: a number from 0 to 2" in text
        code, text = tell("stop", *at)
        assert (code, text.count("everybody comes home")) == (0, 1), text
        assert run.wait() == 0, run.output
    report = json.loads(file.read_text())
    assert report["duration_s"] < FOR_EVER_S
    assert any("stopped after" in fault["what"] for fault in report["faults"])


def test_what_an_agent_was_told_before_a_mission_under_way_takes_it_in_stands() -> None:
    keys, endpoint = Keys("quickstart"), free_endpoint()
    heard: SimpleQueue[Done] = SimpleQueue()

    def hear(key: str, wire: bytes) -> None:
        if (done := decode_done(wire, 1, ANYBODY)) is not None:
            heard.put(done)

    with open_router(endpoint, lossless=True) as world:
        world.subscribe(keys.done(1), hear)
        with swarm("agent", "quickstart", "--id", "1", "--connect", endpoint):
            hello = heard.get(timeout=PATIENCE_S)
            code, text = tell(Verb.HOLD, "quickstart", "--id", "1", "--connect", endpoint)
            assert (code, text.count("holds")) == (0, 1), text
            world.publisher(keys.cue(1))(encode(Cue(tick=500, life=hello.life)))
            while (done := heard.get(timeout=PATIENCE_S)).tick != 500:
                assert done.tick == hello.tick
    assert Event(Level.INFO, "told to hold: holds") in done.status.events


@pytest.mark.parametrize("at", ["*", "**"])
def test_a_mission_is_stopped_by_name_alone(at: str) -> None:
    keys, endpoint, ending = Keys("quickstart"), free_endpoint(), Ending(lambda text: None)
    with (
        open_router(endpoint, lossless=False) as world,
        open_client(endpoint, lossless=False, patience_s=PATIENCE_S) as person,
        ThreadPoolExecutor(1) as pool,
    ):
        desk = MissionDesk(world, keys, ending)

        def answer_to(verb: str) -> Answer | None:
            asked = pool.submit(person.ask, keys.command(WORLD, verb), timeout_s=PATIENCE_S)
            until(lambda: (desk.is_closing(), asked.done())[1])
            [(_, wire)] = asked.result()
            return decode_answer(wire)

        assert answer_to(at) == Answer(obeyed=False, text=f"knows no {at}")
        assert not ending.asked
        assert answer_to(Verb.STOP) == Answer(obeyed=True, text="everybody comes home")
        assert ending.asked


def activities(bus: Network, *uids: int) -> list[Activity | None]:
    """What these agents do, or everybody; None of who has not said."""
    answers = ask(bus, Verb.STATUS, FleetOptions(mission="quickstart", uids=uids or None))
    reports = [None if answer is None else answer.report for answer in answers.values()]
    return [None if report is None else report.activity for report in reports]


def test_an_order_stands_in_the_status_of_the_tick_in_which_it_first_holds_and_once() -> None:
    orders = Orders()
    orders.take("status", Activity.FOLLOW)
    assert orders.confirm(DONE) is DONE
    orders.take("hold", Activity.FOLLOW)
    orders.take("hold", Activity.FOLLOW)  # nothing new
    told = [Event(Level.INFO, "told to hold: holds")]
    assert list(orders.confirm(DONE).status.events) == told
    assert orders.confirm(DONE) is DONE
    orders.take("land", Activity.LANDED)  # is not obeyed
    assert orders.confirm(DONE) is DONE


def test_a_flight_that_cannot_listen_flies_unless_it_must_listen() -> None:
    endpoint, keys, said = free_endpoint(), Keys("quickstart"), []
    with open_board(None, keys, tell=said.append) as bus:
        assert (bus, said) == (None, [])
    with open_router(endpoint, lossless=False):
        with open_board(Board(endpoint=endpoint), keys, tell=said.append) as bus:
            assert bus is None
        [line] = said
        assert line.startswith(f"swarm status, hold, land ... do not reach this mission: cannot listen on {endpoint}")
        with (
            pytest.raises(InputError, match=f"--listen: cannot listen on {endpoint}"),
            open_board(Board(endpoint=endpoint, is_required=True), keys, tell=said.append),
        ):
            pass
    assert len(said) == 1


@pytest.mark.parametrize(
    ("listen", "speed", "at", "is_required"),
    [
        (None, inf, None, None),  # nobody can speak to what is over in a moment
        (None, 1.0, ENDPOINT, False),
        ("tcp/127.0.0.1:1", inf, "tcp/127.0.0.1:1", True),
        ("tcp/127.0.0.1:1", 5.0, "tcp/127.0.0.1:1", True),
    ],
)
def test_where_a_launch_is_spoken_to(
    listen: str | None, speed: float, at: str | None, is_required: bool | None
) -> None:
    board = verbs.board(Namespace(listen=listen, keys=None, insecure=False), speed=speed)
    assert (board and board.endpoint, board and board.is_required) == (at, is_required)


def answer_at_once(question: Question) -> None:
    question.answer(encode_answer(Answer(obeyed=True, text="")))


def test_others_may_not_speak_to_a_launch_unasked(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "narrow", "--speed", "1", "--listen", "tcp/0.0.0.0:7447"]) == 2
    assert "--listen: got tcp/0.0.0.0:7447, where other computers may come in" in capsys.readouterr().err


def test_the_status_of_a_vehicle_is_a_line_of_eighty_letters_in_the_color_of_what_it_does() -> None:
    report = Report(
        time_s=1234.5, activity=Activity.CALLING, flight_mode="OFFBOARD", battery=1.0, tags=(10, 11), mates=12,
        link=1.0, heard_ago_s=0.1, late_s=0.004, busy_s=0.0123,
    )  # fmt: skip
    answers = {("quickstart", "10"): Answer(obeyed=True, text="", report=report), ("quickstart", "11"): None}
    console = Console(file=StringIO(), width=80, record=True, force_terminal=True, color_system="truecolor")
    console.print(status_table(answers))
    page = console.export_html(clear=False)
    title, names, one, other = console.export_text().splitlines()
    assert title.strip() == "quickstart"
    assert names.split()[:3] == ["who", "time", "does"]
    assert "…" not in one
    assert one.rstrip().endswith("0.1 s 4 ms 12 ms")
    assert "does not answer" in other
    assert hex_color(ACTIVITY_INKS[Activity.CALLING]).lower() in page.lower()


def test_everybody_of_a_world_is_told_at_once_and_who_is_silent_or_gone_has_failed() -> None:
    # Agents 0 to 2 stand still, 3 answers, 4 is not there: nobody who answers waits for those who do not.
    keys, endpoint = Keys("quickstart"), free_endpoint()
    asked: SimpleQueue[tuple[float, Question] | None] = SimpleQueue()
    frozen: list[str] = []
    kept: list[Question] = []  # a question that nobody holds is over
    obeyed_at_s: list[float] = []

    def obey() -> None:
        while (found := asked.get()) is not None:
            at_s, question = found
            obeyed_at_s.append(at_s)
            question.answer(encode_answer(Answer(obeyed=True, text="lands")))

    def stand_still(question: Question) -> None:
        frozen.append(question.key)
        kept.append(question)

    with ExitStack() as stack:
        world = stack.enter_context(open_router(endpoint, lossless=True))
        agents = stack.enter_context(open_client(endpoint, lossless=True, patience_s=PATIENCE_S))
        for uid in range(3):
            agents.answer(keys.every_command(uid), stand_still)
        agents.answer(keys.every_command(3), lambda question: asked.put((monotonic(), question)))
        for uid in range(4):
            agents.declare_alive(keys.alive(uid))
        disband = world.declare_alive(keys.crew(5))
        world.declare_alive(keys.alive(WORLD))
        person = stack.enter_context(open_client(endpoint, lossless=True, patience_s=PATIENCE_S))
        until(lambda: len(person.alive(keys.every_alive)) == 6)
        thread = Thread(target=obey, daemon=True)
        thread.start()
        began_s = monotonic()
        answers = ask(person, Verb.LAND, FleetOptions(mission="quickstart"))
        took_s = monotonic() - began_s
        disband()
        until(lambda: keys.crew(5) not in person.alive(keys.every_alive))
        asked.put(None)
        thread.join(PATIENCE_S)
    assert [uid for _, uid in answers] == ["0", "1", "2", "3", "4"]
    assert [answer and answer.text for answer in answers.values()] == [None, None, None, "lands", None]
    assert len(obeyed_at_s) == 1  # who has answered is not told again
    assert len(frozen) == 3 * ATTEMPTS
    assert obeyed_at_s[0] - began_s < took_s - ANSWER_S  # in the first attempt, while the others are still silent


def test_where_nobody_is_nobody_is_told() -> None:
    code, text = tell(Verb.LAND, "--connect", free_endpoint())
    assert code == 1
    assert "does a mission run there?" in text
    assert "Traceback" not in text
    code, text = tell(Verb.LAND, "quickstart", "--id", "10")
    assert (code, text) == (2, '--id: got "10"; allowed: a number from 0 to 9, or several, such as 0-9\n')


def test_without_a_mission_whoever_a_mission_may_have_can_be_named() -> None:
    assert verbs.whole_range("250-999") == tuple(range(250, 1000))
    with pytest.raises(InputError, match=r'--id: got "1000"; allowed: a number from 0 to 999'):
        verbs.whole_range("1000")


def test_who_is_in_no_crew_is_not_asked_and_that_is_said() -> None:
    few, many, endpoint = Keys("few"), Keys("many"), free_endpoint()
    with ExitStack() as stack:
        world = stack.enter_context(open_router(endpoint, lossless=True))
        agents = stack.enter_context(open_client(endpoint, lossless=True, patience_s=PATIENCE_S))
        agents.answer(many.every_command(3), answer_at_once)
        agents.answer(few.every_command(7), answer_at_once)
        person = stack.enter_context(open_client(endpoint, lossless=True, patience_s=PATIENCE_S))

        def told(*uids: int, mission: str | None = None) -> list[tuple[str, str]]:
            return list(ask(person, Verb.HOLD, FleetOptions(mission=mission, uids=uids)))

        world.declare_alive(few.crew(3))
        until(lambda: person.alive(few.every_alive) != [])
        with pytest.raises(InputError, match=r"^--id: got 99; allowed: a number from 0 to 2,"):
            told(99)
        world.declare_alive(many.crew(5))
        until(lambda: person.alive(many.every_alive) != [])
        assert told(3) == [("many", "3")]
        with pytest.raises(InputError, match=r"^--id: got 3; allowed: a number from 0 to 2,"):
            told(3, mission="few")
        with pytest.raises(InputError, match=r"^--id: got 5; allowed: a number from 0 to 4,"):
            told(3, 5)
        # Who is there is told, whatever the world says.
        agents.declare_alive(few.alive(7))
        until(lambda: few.alive(7) in person.alive(few.every_alive))
        assert told(7) == [("few", "7")]
