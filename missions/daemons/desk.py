"""Where people come to a mission, and to each of its agents; they are answered between ticks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager

from comms.access import Gate
from comms.keys import FLIGHT, WORLD, Keys
from comms.session import BusError, Network, open_router
from missions.daemons.attended import Attended
from missions.daemons.orders import Answer, Verb
from missions.daemons.questions import Questions
from missions.ending import Ending
from missions.observation import Observation
from missions.options import Board
from missions.problems import InputError


class MissionDesk:
    """Where people come to stop the mission."""

    def __init__(self, bus: Network, keys: Keys, ending: Ending) -> None:
        self._ending = ending
        self._questions: Questions[str] = Questions()
        self._questions.take_at(bus, keys.command(WORLD, Verb.STOP), WORLD)

    def is_closing(self) -> bool:
        """Whether anybody has asked for the end, in whatever way."""
        self._questions.answer(self._stop)
        return self._ending.asked

    def _stop(self, whom: str, word: str) -> Answer:
        if word != Verb.STOP:  # a question to several keys at once comes here, too
            return Answer(obeyed=False, text=f"knows no {word}")
        self._ending.ask()
        return Answer(obeyed=True, text="everybody comes home")


class CrewDesk:
    """Where people come to the agents of this process, all of which fly in one mission. An observer."""

    def __init__(self, bus: Network, keys: Keys, crew: Iterable[Attended]) -> None:
        self._crew = {agent.uid: agent for agent in crew}
        self._questions: Questions[int] = Questions()
        for uid in self._crew:
            bus.declare_alive(keys.alive(uid))
            self._questions.take_at(bus, keys.every_command(uid), uid)
        bus.declare_alive(keys.crew(len(self._crew)))
        bus.declare_alive(keys.alive(FLIGHT))

    def observe(self, observation: Observation) -> None:
        """After a tick: answer what was asked and told in it."""
        self._questions.answer(lambda uid, word: self._crew[uid].obey(word))


@contextmanager
def open_board(board: Board | None, keys: Keys, *, tell: Callable[[str], None]) -> Iterator[Network | None]:
    """The session that people reach a flight by; None if nobody is to, or another mission listens there.

    Args:
        tell: says which of these it is.

    Raises:
        InputError: it cannot listen where it must.
    """
    if board is None:
        yield None
        return
    own = board.credentials
    gate = None if own is None else Gate(own, keys, tuple(own.known))
    with ExitStack() as stack:
        bus: Network | None = None
        try:
            bus = stack.enter_context(open_router(board.endpoint, lossless=False, gate=gate, n_clients=1))
            tell(f"swarm status, hold, land ... reach this mission on {board.endpoint}")
        except BusError as error:
            if board.is_required:
                raise InputError(f"--listen: {error}") from error
            tell(f"swarm status, hold, land ... do not reach this mission: {error}")
        yield bus
