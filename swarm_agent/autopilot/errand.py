"""Getting something done by the vehicle, refusals and all: ask, wait for the effect, pause and ask again, give up.

    arming = Errand(arm(), limit_s=60.0, done=lambda telemetry: telemetry.armed)
    if arming.tick(cockpit, now_s) is Progress.GIVEN_UP: failure = arming.reason

An answer is a promise; where telemetry shows the effect, the effect counts. So a lost answer, or a late answer to an
earlier request of the same kind, does no harm.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum

from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.requests import Request
from swarm_agent.autopilot.telemetry import Telemetry
from swarm_agent.autopilot.transaction import Outcome, Transaction

PAUSE_S = 2.0  # between a refusal and the next try; the autopilot's reasons arrive meanwhile
EFFECT_S = 3.0  # heartbeats, which show most effects, come once a second


class Progress(Enum):
    """How an errand stands."""

    OPEN = "open"
    DONE = "done"
    GIVEN_UP = "given up"


class Errand:
    """One request, seen through.

    Args:
        request: what to ask for.
        limit_s: how long to go on after the first try. An unsupported request is given up at once.
        done: the effect in telemetry; None where the answer has to do.

    Attributes:
        reason: why it has not worked so far, in the autopilot's words where it gave any.
    """

    def __init__(self, request: Request, *, limit_s: float, done: Callable[[Telemetry], bool] | None = None) -> None:
        self._request = request
        self._limit_s = limit_s
        self._done = done
        self._transaction: Transaction | None = Transaction(request)
        self._started_at_s: float | None = None
        self._try_again_at_s = 0.0
        self._trouble = ""
        self._promised = False
        self._words: list[str] = []
        self._told = ""
        self.reason = ""

    def tick(self, cockpit: Cockpit, now_s: float) -> Progress:
        """Go on with it; what goes wrong is logged."""
        if self._done is not None and self._done(cockpit.telemetry):
            return Progress.DONE
        if self._started_at_s is None:
            self._started_at_s = now_s
        else:
            self._words += [text for text in cockpit.warnings if text not in self._words]
        if self._transaction is not None:
            return self._ask(self._transaction, cockpit, now_s)
        if now_s < self._try_again_at_s:
            return Progress.OPEN
        return self._review(cockpit, now_s)

    def _ask(self, transaction: Transaction, cockpit: Cockpit, now_s: float) -> Progress:
        outcome = transaction.tick(cockpit, now_s)
        if outcome is Outcome.OPEN:
            return Progress.OPEN
        if outcome is Outcome.ACCEPTED and self._done is None:
            return Progress.DONE
        self._promised = outcome is Outcome.ACCEPTED
        self._trouble = "accepted, but without effect" if self._promised else outcome.value
        self._transaction = None
        if outcome is Outcome.UNSUPPORTED:
            self._started_at_s = now_s - self._limit_s
            return self._review(cockpit, now_s)
        self._try_again_at_s = now_s + (EFFECT_S if self._promised else PAUSE_S)
        return Progress.OPEN

    def _review(self, cockpit: Cockpit, now_s: float) -> Progress:
        """The pause is over: say what went wrong, then try again or give up."""
        words = f" ({'; '.join(self._words)})" if self._words else ""
        self.reason = f"{self._request.name}: {self._trouble}{words}"
        assert self._started_at_s is not None
        if now_s - self._started_at_s >= self._limit_s:
            cockpit.say(Level.WARNING, f"{self.reason}; given up")
            return Progress.GIVEN_UP
        if self.reason != self._told:
            cockpit.say(Level.WARNING, f"{self.reason}; asking again")
            self._told = self.reason
        self._words.clear()
        self._transaction = Transaction(self._request)
        return self._ask(self._transaction, cockpit, now_s)
