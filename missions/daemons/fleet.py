"""`swarm status`, `hold`, `resume`, `return`, `land` and `stop`: people speak to vehicles that are under way.

Each vehicle answers for itself. Who does not answer is asked again, and has failed in the end. Where a world is,
that is everybody of its mission, whether they are there or not; elsewhere those who are.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from time import sleep

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from comms.credentials import Credentials
from comms.keys import EVERYBODY_OF_ANY_MISSION, FLIGHT, WORLD, Keys, crew_size, somebody
from comms.session import BusError, Network, open_client
from comms.status import Activity
from missions.colors import ACTIVITY_INKS, hex_color
from missions.daemons.options import ENDPOINT
from missions.daemons.orders import Answer, Report, Verb, decode_answer
from missions.daemons.security import silence, why
from missions.exit_codes import DONE, FAILED
from missions.mission.agents import MOST_AGENTS
from missions.problems import InputError

REACHED = "A launch is reached that has --speed, --listen or --processes, and `swarm world`, and `swarm agent --alone`."
CONNECT_S = 3.0
ANSWER_S = 2.0
ATTEMPTS = 3
REFRESH_S = 0.5
_NEVER_WRAP = 1000
_RED = hex_color(ACTIVITY_INKS[Activity.LOST])


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetOptions:
    """Whom to tell, and where.

    Attributes:
        mission: its name; None: of all missions there. uids: these agents; None: everybody.
        credentials: the operator's, on a secured network.
    """

    endpoint: str = ENDPOINT
    mission: str | None = None
    uids: tuple[int, ...] | None = None
    credentials: Credentials | None = None


Who = tuple[str, str]  # mission, and uid or WORLD
Answers = dict[Who, Answer | None]


def tell(verb: Verb, options: FleetOptions) -> int:
    """Tell everybody, and say what came of it. Returns 1 if anybody failed."""
    console = Console(width=None if sys.stdout.isatty() else _NEVER_WRAP)
    try:
        with open_client(options.endpoint, lossless=True, patience_s=CONNECT_S, credentials=options.credentials) as bus:
            if verb is Verb.STATUS and console.is_terminal:
                return _watch(bus, options, console)
            answers = ask(bus, verb, options)
    except BusError as error:
        hint = f"does a mission run there? {REACHED}"
        sys.stderr.write(f"{why(error, options.credentials, otherwise=hint)}\n")
        return FAILED
    if not answers:
        sys.stderr.write(f"nobody of {options.mission or 'any mission'} is there{silence(options.credentials)}\n")
        return FAILED
    console.print(status_table(answers) if verb is Verb.STATUS else result_table(answers))
    return DONE if all(answer is not None and answer.obeyed for answer in answers.values()) else FAILED


def ask(bus: Network, verb: Verb, options: FleetOptions) -> Answers:
    """Everybody's answer; None of those who give none.

    All are told at the same time, so nobody waits for those who are silent; who has answered is not told again.
    """
    answers: Answers = dict.fromkeys(_addressed(bus, verb, options))
    for _ in range(ATTEMPTS):
        asked = {Keys(who[0]).command(who[1], verb): who for who, answer in answers.items() if answer is None}
        for key, wire in bus.ask(*asked, timeout_s=ANSWER_S):
            answer = decode_answer(wire)
            if answer is not None and key in asked:
                answers[asked[key]] = answer
    return answers


def _addressed(bus: Network, verb: Verb, options: FleetOptions) -> list[Who]:
    """Who is to answer: those who are there, those who belong to a world that is, and those who were named.

    All stop when their world does.

    Raises:
        InputError: who is named belongs to none of the worlds that are there.
    """
    there = [found for key in bus.alive(EVERYBODY_OF_ANY_MISSION) if (found := somebody(key)) is not None]
    named = [(keys.mission, who) for keys, who in there if options.mission in (None, keys.mission)]
    there_too = {(mission, int(who)) for mission, who in named if who.isdigit() and len(who) <= 9}
    crews = [(mission, size) for mission, who in named if (size := crew_size(who)) is not None]
    if options.uids is not None:
        missions = sorted({mission for mission, _ in named} | ({options.mission} if options.mission else set()))
        sizes = {mission: max(size for name, size in crews if name == mission) for mission, _ in crews}
        return _of_their_crews(missions, options.uids, sizes, there_too)
    whole = [(mission, WORLD) for mission, who in named if who in (WORLD, FLIGHT)]
    if verb is Verb.STOP and whole:
        return whole
    belong = {(mission, uid) for mission, size in crews for uid in range(min(size, MOST_AGENTS))}
    return [(mission, str(uid)) for mission, uid in sorted(there_too | belong)]


def _of_their_crews(
    missions: Sequence[str], uids: Sequence[int], sizes: Mapping[str, int], there_too: Set[tuple[str, int]]
) -> list[Who]:
    """These agents of each mission that has them. Where there is no world, nobody knows how many it has."""
    found = [
        (mission, uid)
        for mission in missions
        for uid in uids
        if mission not in sizes or uid < sizes[mission] or (mission, uid) in there_too
    ]
    strangers = sorted(set(uids) - {uid for _, uid in found}) if missions else []
    if strangers:
        most = max(sizes.values()) - 1
        raise InputError(f"--id: got {strangers[0]}; allowed: a number from 0 to {most}, or several, such as 0-{most}")
    return [(mission, str(uid)) for mission, uid in found]


def _watch(bus: Network, options: FleetOptions, console: Console) -> int:
    """The status as it changes, until Ctrl-C or until nobody is there any more."""
    answers: Answers = {}
    try:
        with Live(console=console, auto_refresh=False) as live:
            while now := ask(bus, Verb.STATUS, options):
                answers = now
                live.update(status_table(answers), refresh=True)
                sleep(REFRESH_S)
    except KeyboardInterrupt:
        pass
    return DONE if answers and all(answers.values()) else FAILED


def result_table(answers: Answers) -> Table:
    """What came of an order, by vehicle."""
    table = _table(("mission", "agent", "", "what"))
    for (mission, who), answer in answers.items():
        if answer is None:
            table.add_row(mission, who, "failed", "does not answer", style=_RED)
        else:
            table.add_row(mission, who, "ok" if answer.obeyed else "failed", _plain(answer.text))
    return table


def status_table(answers: Answers) -> Table:
    """How every vehicle is: its mission is named once, where there is one alone."""
    missions = {mission for mission, _ in answers}
    many = len(missions) > 1
    table = _table((*(["mission"] if many else []), "who", *_COLUMNS))
    table.title = None if many else next(iter(missions), None)
    table.title_justify, table.title_style = "left", "bold"
    for (mission, who), answer in answers.items():
        name = [mission] if many else []
        if answer is None:
            table.add_row(*name, f"A{who}", "", "does not answer", style=_RED)
        elif answer.report is None:
            table.add_row(*name, f"A{who}", "", answer.text)
        else:
            table.add_row(*name, f"A{who}", *_cells(answer.report))
    return table


_NUMBERS = frozenset({"time", "battery", "hears", "link", "heard", "late", "busy"})
_COLUMNS = ("time", "does", "mode", "battery", "follows", "hears", "link", "heard", "late", "busy")


def _cells(report: Report) -> Sequence[str | Text]:
    return (
        f"{report.time_s:.1f}",
        Text(report.activity.value, hex_color(ACTIVITY_INKS[report.activity])),
        _plain(report.flight_mode),
        "" if report.battery is None else f"{report.battery:.0%}",
        " ".join(f"T{target}" for target in report.tags),
        f"{report.mates}",
        "" if report.link is None else f"{report.link:.0%}",
        f"{report.heard_ago_s:.1f} s",
        f"{report.late_s * 1000:.0f} ms",
        f"{report.busy_s * 1000:.0f} ms",
    )


def _plain(text: str) -> Text:
    """What came over the network, as nothing but letters: no markup, and nothing that moves a cursor."""
    return Text("".join(letter if letter.isprintable() else "?" for letter in text))


def _table(columns: Sequence[str]) -> Table:
    # One blank between columns: a vehicle's status is a line of eighty letters.
    table = Table(box=None, pad_edge=False, padding=(0, 1), collapse_padding=True)
    for column in columns:
        table.add_column(column, no_wrap=True, justify="right" if column in _NUMBERS else "left")
    return table
