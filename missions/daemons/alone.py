"""`swarm agent --alone`: agents without a world. Nobody tells them the time, or what they see.

The clock is the computer's own, in UTC: all computers of the swarm keep it by GPS or NTP, to well within half a second.
What is in sight a detector on board tells (`comms.sight`); people begin and end the mission with the fleet's verbs. All
come in at a place of the agent's own, and nothing flies before `swarm resume`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil
from time import sleep, time

from msgspec import structs

from comms.access import Gate, Place
from comms.clock import RealTime
from comms.credentials import agents_name
from comms.keys import Keys
from comms.session import BusError, Network, open_router
from comms.sight import Eyes
from comms.status import Activity
from missions import compose
from missions.daemons.airwaves import open_airwaves
from missions.daemons.attended import Attended
from missions.daemons.log import Log
from missions.daemons.options import DaemonOptions
from missions.daemons.orders import Answer, Orders, Verb
from missions.daemons.questions import Questions
from missions.ending import Ending
from missions.exit_codes import DONE, FAILED, STOPPED
from missions.links import open_transports
from missions.mission import Mission
from missions.observation import Phase
from missions.problems import InputError
from missions.sides.agent import AgentSide, agent_sides
from missions.sides.exchange import Cue
from missions.sides.phases import Phases
from missions.targets import n_targets
from missions.tlog import failures, tlogs

LOOK_S = 0.05
WAITING = "waits on the ground for resume"


def alone(mission: Mission, uids: Sequence[int], options: DaemonOptions) -> int:
    """Run these agents until their mission is over. Returns the exit code.

    Raises:
        InputError: it cannot listen there, or a link to a vehicle cannot be opened.
    """
    log, keys = Log(agents_name(uids), least=options.log_level), Keys(mission.name)
    ending, own = Ending(log.info), options.credentials
    gate = None if own is None else Gate(own.of_radio, keys, tuple(own.of_radio.known), Place.BOARD)
    with ending.listening(leash=options.leash), open_transports(mission, uids) as transports:
        try:
            with (
                open_router(options.endpoint, lossless=False, gate=gate) as board,
                open_airwaves(mission, uids, options, board) as airwaves,
                tlogs(options.tlog, uids, began_unix_s=0.0, adds=True) as logs,  # its clock is UTC
            ):
                count = n_targets(mission)
                radios = compose.radios(mission, airwaves, uids, count)
                eyes = {uid: Eyes(board, keys=keys, uid=uid, n_targets=count) for uid in uids}
                desk = _Desk(board, keys, uids, ending)
                log.info(f"listens on {options.endpoint}, and {WAITING}")
                if not desk.await_begin():
                    return STOPPED if ending.interrupted else DONE
                tick = ceil(time() / mission.tick_s)
                sides = agent_sides(mission, radios, n_targets=count, transports=transports, started_tick=tick)
                for side in sides if logs else ():
                    side.tap = logs[side.uid].pass_on
                code = _fly(mission, desk.seat(sides, tick_s=mission.tick_s), eyes, desk, tick, log=log)
            for failure in failures(logs.values()):
                log.error(failure)
            return STOPPED if ending.interrupted else code
        except BusError as error:
            raise InputError(f"--alone: {error}") from error
        except KeyboardInterrupt:
            log.error("ended at once, in the air or not")
    return STOPPED if ending.interrupted else FAILED


def _fly(
    mission: Mission, crew: Sequence[Attended], eyes: Mapping[int, Eyes], desk: _Desk, first: int, *, log: Log
) -> int:
    """Tick from `first` on, counted in UTC, until everybody has landed; the exit code."""
    tick_s = mission.tick_s
    phases, pace = Phases(tick_s=tick_s, duration_s=mission.duration_s), RealTime(tick_s=tick_s, speed=1.0)
    sleep(max(0.0, first * tick_s - time()))  # all computers begin their ticks at the same moments
    ahead = 0
    while phases.now is not Phase.DONE:
        late_s = pace.begin(ahead)
        log.time_s = (first + ahead) * tick_s
        log.events(phases.announcement(ahead), who="mission")
        cue = Cue(
            tick=first + ahead,
            mission_tick=phases.mission_tick(ahead),
            come_home=phases.now is Phase.RETURN,
            frames=None,
            late_s=late_s,
        )
        dones = [agent.tick(structs.replace(cue, sightings=eyes[agent.uid].see(log.time_s))) for agent in crew]
        for done in dones:
            log.events(done.status.events, who=agents_name([done.status.uid]))
        desk.answer()
        ahead += 1
        phases.turn(ahead, dones, stop=desk.is_closing)
    return DONE if phases.complete or desk.has_called_home else FAILED


class _Desk:
    """Where people come: what they told each agent, and how it is.

    Attributes:
        begun: somebody has said so.
    """

    def __init__(self, bus: Network, keys: Keys, uids: Sequence[int], ending: Ending) -> None:
        self.begun = False
        self._ending = ending
        self._orders = {uid: Orders() for uid in uids}
        self._crew: dict[int, Attended] = {}
        self._questions: Questions[int] = Questions()
        for uid in uids:
            bus.declare_alive(keys.alive(uid))
            self._questions.take_at(bus, keys.every_command(uid), uid)

    @property
    def is_closing(self) -> bool:
        """Whether the process is to end."""
        return self._ending.asked

    @property
    def has_called_home(self) -> bool:
        """Whether people have ended everybody's mission."""
        return self._ending.asked or all(orders.come_home for orders in self._orders.values())

    def await_begin(self) -> bool:
        """Wait for people to let the mission begin; False if they end it instead."""
        while not (self.begun or self.has_called_home):
            self.answer()
            sleep(LOOK_S)
        return not self.has_called_home

    def seat(self, sides: Sequence[AgentSide], *, tick_s: float) -> Sequence[Attended]:
        """The agents, switched on, under the orders that they have by now."""
        self._crew = {side.uid: Attended(side, tick_s=tick_s, orders=self._orders[side.uid]) for side in sides}
        return list(self._crew.values())

    def answer(self) -> None:
        """What people have asked and told since the last time."""
        self._questions.answer(self._obey)

    def _obey(self, uid: int, word: str) -> Answer:
        if uid in self._crew:
            return self._crew[uid].obey(word)
        if word == Verb.STOP:
            obeyed, text = self._orders[uid].take(word, Activity.PREPARING)
            return Answer(obeyed=obeyed, text=text)
        if word == Verb.RESUME:
            self.begun = True
            return Answer(obeyed=True, text="begins")
        return Answer(obeyed=word == Verb.STATUS, text=WAITING)
